#include "channel_catalogue.hpp"

#include <array>
#include <numbers>
#include <sstream>

namespace samara::turbine {

using namespace slots;

namespace {

constexpr double to_degrees = 180.0 / std::numbers::pi;
constexpr double to_rpm = 30.0 / std::numbers::pi;
constexpr double to_kilo = 1e-3;

std::vector<std::string> split_words(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

struct AirChannel {
  const char* name;
  const char* unit;
  const char* description;
  double factor = 1.0;
};

/// Channels of the air at a station, by the names of AeroDyn.
constexpr std::array<AirChannel, air_values> air_channels{
    {{"Alpha", "deg", "angle of attack at the aerodynamic centre", to_degrees},
     {"Phi", "deg", "angle of the relative wind to the plane of the rotor", to_degrees},
     {"VRel", "m/s", "relative wind in the plane of the section"},
     {"DynP", "Pa", "dynamic pressure"},
     {"AxInd", "-", "axial induction factor"},
     {"TnInd", "-", "tangential induction factor"},
     {"Vindx", "m/s", "induced velocity along the shaft, downwind"},
     {"Vindy", "m/s", "induced velocity against the turning of the rotor"},
     {"Cl", "-", "lift coefficient"},
     {"Cd", "-", "drag coefficient"},
     {"Cm", "-", "moment coefficient, nose up"},
     {"Fl", "N/m", "lift per length"},
     {"Fd", "N/m", "drag per length"},
     {"Mm", "N-m/m", "moment of the air about the aerodynamic centre per length, nose up"},
     {"Fn", "N/m", "force of the air per length, normal to the chord"},
     {"Ft", "N/m", "force of the air per length, along the chord to the leading edge"},
     {"Fx", "N/m", "force of the air per length, along the shaft"},
     {"Fy", "N/m", "force of the air per length, in the sense of the turning"}}};

}  // namespace

ChannelCatalogue::ChannelCatalogue(const TurbineEquations& equations,
                                   const ChannelStations& stations)
    : turbine_(equations.turbine()), stations_(stations) {
  add_rotation();
  for (std::size_t k = 0; k < turbine_.blades.size(); ++k) add_blade(static_cast<int>(k));
  add_shaft();
  add_yaw_bearing();
  if (turbine_.has_tower) add_tower();
  if (turbine_.air) add_air();
  for (const components::Channel& declared : equations.declarations().channels) {
    channels.push_back({declared.name, declared.unit, declared.frame, declared.description});
    picks.push_back({-1, declared.factor, declared.unknown});
  }
  sections_from = channels.size();
  for (std::size_t k = 0; k < turbine_.blades.size(); ++k) add_blade_sections(static_cast<int>(k));
  if (turbine_.has_tower) add_tower_sections();
}

int ChannelCatalogue::section_slot(int beam, std::size_t i) const {
  const std::size_t each =
      turbine_.blades.empty() ? 0 : stations_of(turbine_.blades.front(), stations_.blade).size();
  return blade_slot(static_cast<int>(turbine_.blades.size())) +
         static_cast<int>(static_cast<std::size_t>(beam) * each + i) * section_slots;
}

void ChannelCatalogue::add(const std::string& names, const std::string& unit,
                           const std::string& frame, const std::string& description, int slot,
                           double factor) {
  const std::vector<std::string> all = split_words(names);
  for (std::size_t i = 1; i < all.size(); ++i) aliases.emplace_back(all[i], channels.size());
  channels.push_back({all.front(), unit, frame, description});
  picks.push_back({slot, factor});
}

void ChannelCatalogue::add_force(const std::string& names, const std::string& frame,
                                 const std::string& description, int slot) {
  add(names, "kN", frame, description, slot, to_kilo);
}

void ChannelCatalogue::add_moment(const std::string& names, const std::string& frame,
                                  const std::string& description, int slot) {
  add(names, "kN-m", frame, description, slot, to_kilo);
}

void ChannelCatalogue::add_rotation() {
  add("Azimuth LSSTipPxa LSSTipPxs", "deg", "shaft", "rotor azimuth, blade 1 up at 0; 0 to 360",
      azimuth_slot, to_degrees);
  add("RotSpeed LSSTipVxa LSSTipVxs", "rpm", "shaft", "rotor speed relative to the nacelle",
      rotor_speed, to_rpm);
  add("GenSpeed HSShftV", "rpm", "shaft",
      "generator speed relative to the nacelle, behind the gear", generator_speed, to_rpm);
  add_moment("GenTq", "shaft", "torque on the generator against its turning, without the brake",
             generator_torque);
  add_moment("HSSBrTq", "shaft", "torque of the brake on the generator against its turning",
             brake_torque);
  add("NacYaw YawPzn NacYawP YawPos", "deg", "tower top", "nacelle yaw", yaw_slot, to_degrees);
  add("NacYawV YawVzn YawRate", "deg/s", "tower top", "nacelle yaw rate", yaw_rate, to_degrees);
  if (turbine_.blades.size() != 2) return;
  add("TeetDefl RotTeetP TeetPya", "deg", "shaft", "rotor teeter angle about ya", teeter_slot,
      -to_degrees);
  add("TeetVya RotTeetV", "deg/s", "shaft", "rotor teeter rate about ya", teeter_rate, -to_degrees);
}

void ChannelCatalogue::add_blade(int k) {
  const std::string n = std::to_string(k + 1);
  const int first = blade_slot(k);
  const std::string coned = "blade " + n + ", coned, not pitched";
  const std::string pitched = "blade " + n + ", coned and pitched";
  const std::string tip = "blade " + n + ", section at the tip";
  add("BldPitch" + n + " PtchPMzc" + n, "deg", pitched, "pitch", first + blade_pitch, to_degrees);
  add("TipDxc" + n + " OoPDefl" + n, "m", coned, "tip deflection, out of plane", first + coned_tip,
      1.0);
  add("TipDyc" + n + " IPDefl" + n, "m", coned, "tip deflection, in plane", first + coned_tip + 1,
      1.0);
  add("TipDzc" + n + " TipDzb" + n, "m", coned, "tip deflection, axial", first + coned_tip + 2,
      1.0);
  add("TipDxb" + n, "m", pitched, "tip deflection, flapwise", first + pitched_tip, 1.0);
  add("TipDyb" + n, "m", pitched, "tip deflection, edgewise", first + pitched_tip + 1, 1.0);
  add("TipRDxb" + n + " RollDefl" + n, "deg", pitched, "tip rotation vector, about xb",
      first + tip_turn, to_degrees);
  add("TipRDyb" + n + " PtchDefl" + n, "deg", pitched, "tip rotation vector, about yb",
      first + tip_turn + 1, to_degrees);
  add("TipRDzc" + n + " TipRDzb" + n + " TwstDefl" + n, "deg", pitched,
      "tip rotation vector, about zb", first + tip_turn + 2, to_degrees);
  const char* axes[] = {"x", "y", "z"};
  const char* ways[] = {"flapwise", "edgewise", "axial"};
  for (int i = 0; i < 3; ++i)
    add(std::string("TipAL") + axes[i] + "b" + n, "m/s^2", tip,
        std::string("inertial tip acceleration, ") + ways[i], first + tip_acceleration + i, 1.0);
  add_force("RootFxc" + n, coned, "root force, out of plane", first + coned_force);
  add_force("RootFyc" + n, coned, "root force, in plane", first + coned_force + 1);
  add_force("RootFzc" + n + " RootFzb" + n, coned, "root force, axial", first + coned_force + 2);
  add_moment("RootMxc" + n + " RootMIP" + n, coned, "root moment, in plane (edgewise)",
             first + coned_moment);
  add_moment("RootMyc" + n + " RootMOoP" + n, coned, "root moment, out of plane (flapwise)",
             first + coned_moment + 1);
  add_moment("RootMzc" + n + " RootMzb" + n, coned, "root moment, pitching",
             first + coned_moment + 2);
  add_force("RootFxb" + n, pitched, "root force, flapwise", first + root_force);
  add_force("RootFyb" + n, pitched, "root force, edgewise", first + root_force + 1);
  add_moment("RootMxb" + n + " RootMEdg" + n, pitched, "root moment, edgewise",
             first + root_moment);
  add_moment("RootMyb" + n + " RootMFlp" + n, pitched, "root moment, flapwise",
             first + root_moment + 1);
}

void ChannelCatalogue::add_shaft() {
  const std::string turning = "shaft, turning with it";
  const std::string still = "shaft, not turning";
  add_force("RotThrust LSShftFxa LSShftFxs LSSGagFxa LSSGagFxs", turning,
            "force of the rotor on the shaft, axial", shaft_force);
  add_force("LSShftFya LSSGagFya", turning, "force of the rotor on the shaft, y", shaft_force + 1);
  add_force("LSShftFza LSSGagFza", turning, "force of the rotor on the shaft, z", shaft_force + 2);
  add_force("LSShftFys LSSGagFys", still, "force of the rotor on the shaft, y", bearing_force + 1);
  add_force("LSShftFzs LSSGagFzs", still, "force of the rotor on the shaft, z", bearing_force + 2);
  add_moment("RotTorq LSShftTq LSShftMxa LSShftMxs LSSGagMxa LSSGagMxs", turning,
             "torque of the rotor on the shaft", shaft_moment);
  add_moment("LSSTipMya", turning, "moment on the shaft's tip, y", shaft_moment + 1);
  add_moment("LSSTipMza", turning, "moment on the shaft's tip, z", shaft_moment + 2);
  add_moment("LSSTipMys", still, "moment on the shaft's tip, y", bearing_moment + 1);
  add_moment("LSSTipMzs", still, "moment on the shaft's tip, z", bearing_moment + 2);
  add("RotPwr LSShftPwr", "kW", turning, "torque of the rotor times its speed", rotor_power,
      to_kilo);
}

void ChannelCatalogue::add_yaw_bearing() {
  const std::string top = "tower top";
  const std::string nacelle = "nacelle";
  add_force("YawBrFxp", top, "force on the tower top, fore-aft", top_force);
  add_force("YawBrFyp", top, "force on the tower top, side-side", top_force + 1);
  add_force("YawBrFzp YawBrFzn", top, "force on the tower top, vertical", top_force + 2);
  add_moment("YawBrMxp", top, "moment on the tower top, roll", top_moment);
  add_moment("YawBrMyp", top, "moment on the tower top, pitch", top_moment + 1);
  add_moment("YawBrMzp YawBrMzn YawMom", top, "moment on the tower top, yaw", top_moment + 2);
  add_force("YawBrFxn", nacelle, "force on the tower top, along the nacelle", yawed_force);
  add_force("YawBrFyn", nacelle, "force on the tower top, across the nacelle", yawed_force + 1);
  add_moment("YawBrMxn", nacelle, "moment on the tower top, roll", yawed_moment);
  add_moment("YawBrMyn", nacelle, "moment on the tower top, pitch", yawed_moment + 1);
}

void ChannelCatalogue::add_tower() {
  const std::string base = "tower base";
  const std::string top = "tower top";
  add("TTDspFA YawBrTDxt", "m", base, "tower-top deflection, fore-aft", top_move, 1.0);
  add("TTDspSS YawBrTDyt", "m", base, "tower-top deflection, side-side", top_move + 1, 1.0);
  add("TTDspAx YawBrTDzt", "m", base, "tower-top deflection, axial", top_move + 2, 1.0);
  add("TTDspRoll YawBrRDxt", "deg", base, "tower-top rotation vector, roll", top_turn, to_degrees);
  add("TTDspPtch YawBrRDyt", "deg", base, "tower-top rotation vector, pitch", top_turn + 1,
      to_degrees);
  add("TTDspTwst YawBrRDzt", "deg", base, "tower-top rotation vector, twist", top_turn + 2,
      to_degrees);
  add("YawBrTAxp", "m/s^2", top, "tower-top acceleration, fore-aft", top_speed_up, 1.0);
  add("YawBrTAyp", "m/s^2", top, "tower-top acceleration, side-side", top_speed_up + 1, 1.0);
  add("YawBrTAzp", "m/s^2", top, "tower-top acceleration, vertical", top_speed_up + 2, 1.0);
  add_force("TwrBsFxt", base, "tower-base force, fore-aft", base_force);
  add_force("TwrBsFyt", base, "tower-base force, side-side", base_force + 1);
  add_force("TwrBsFzt", base, "tower-base force, vertical", base_force + 2);
  add_moment("TwrBsMxt", base, "tower-base moment, side-side (roll)", base_moment);
  add_moment("TwrBsMyt", base, "tower-base moment, fore-aft (pitch)", base_moment + 1);
  add_moment("TwrBsMzt", base, "tower-base moment, torsion", base_moment + 2);
}

bool ChannelCatalogue::is_of_air(int slot) const {
  if (slot < 0) return false;
  if (slot < whole_slots) return slot >= air_force;
  const int first = section_slot(0, 0);
  return slot >= first && (slot - first) % section_slots >= section_air;
}

void ChannelCatalogue::add_air() {
  const std::string hub = "hub, turning with it";
  const char* axes[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i)
    add(std::string("RtAeroF") + axes[i] + "h", "N", hub,
        std::string("force of the air on the rotor, ") + axes[i], air_force + i, 1.0);
  for (int i = 0; i < 3; ++i)
    add(std::string("RtAeroM") + axes[i] + "h", "N-m", hub,
        std::string("moment of the air on the rotor about its apex, ") + axes[i], air_moment + i,
        1.0);
  add("RtAeroPwr", "W", hub, "torque of the air times the speed of the rotor", air_power, 1.0);
  add("RtVAvgxh", "m/s", hub, "undisturbed wind along the shaft, mean over the rotor", mean_wind,
      1.0);
  add("RtAeroCp", "-", hub, "power coefficient, of RtAeroPwr with RtVAvgxh", power_coefficient,
      1.0);
  add("RtAeroCq", "-", hub, "torque coefficient", torque_coefficient, 1.0);
  add("RtAeroCt", "-", hub, "thrust coefficient, of RtAeroFxh", thrust_coefficient, 1.0);
  add("RtTSR", "-", hub, "tip-speed ratio with RtVAvgxh", tip_speed_ratio, 1.0);
  const std::string ground = "ground";
  add("Wind1VelX", "m/s", ground, "undisturbed wind at the hub, along n2", hub_wind, 1.0);
  add("Wind1VelY", "m/s", ground, "the same to the left, against n1", hub_wind + 1, 1.0);
  add("Wind1VelZ", "m/s", ground, "the same up, along n3", hub_wind + 2, 1.0);
}

void ChannelCatalogue::add_section_air(const std::string& before, const std::string& place,
                                       int slot) {
  for (int i = 0; i < air_values; ++i) {
    const AirChannel& channel = air_channels[static_cast<std::size_t>(i)];
    add(before + channel.name, channel.unit, place, channel.description, slot + section_air + i,
        channel.factor);
  }
}

/// The channels of a station. Their names have `before` and `after` around the letters F, M, T, R
/// and the axis: "B1N1" and "", or "TwHt1" and "t".
void ChannelCatalogue::add_section(const std::string& before, const std::string& after,
                                   const std::string& place, const std::string& root, int slot) {
  const std::string section = place + ", axes of the section";
  const char* axes[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i)
    add_force(before + "FL" + axes[i] + after, section, std::string("section force, ") + axes[i],
              slot + section_force + i);
  for (int i = 0; i < 3; ++i)
    add_moment(before + "ML" + axes[i] + after, section, std::string("section moment, ") + axes[i],
               slot + section_moment + i);
  for (int i = 0; i < 3; ++i)
    add(before + "TD" + axes[i] + after, "m", root, std::string("deflection, ") + axes[i],
        slot + section_move + i, 1.0);
  for (int i = 0; i < 3; ++i)
    add(before + "RD" + axes[i] + after, "deg", root, std::string("rotation vector, ") + axes[i],
        slot + section_turn + i, to_degrees);
}

void ChannelCatalogue::add_blade_sections(int k) {
  const model::Beam& beam = turbine_.blades[static_cast<std::size_t>(k)];
  const std::string blade = "blade " + std::to_string(k + 1);
  const std::size_t count = stations_of(beam, stations_.blade).size();
  for (std::size_t i = 0; i < count; ++i)
    add_section("B" + std::to_string(k + 1) + "N" + std::to_string(i + 1), "",
                blade + ", station " + std::to_string(i + 1), blade + ", coned and pitched",
                section_slot(k, i));
  if (!turbine_.air) return;
  for (std::size_t i = 0; i < count; ++i)
    add_section_air("B" + std::to_string(k + 1) + "N" + std::to_string(i + 1),
                    blade + ", station " + std::to_string(i + 1), section_slot(k, i));
}

void ChannelCatalogue::add_tower_sections() {
  const std::size_t count = stations_of(turbine_.tower, stations_.tower).size();
  for (std::size_t i = 0; i < count; ++i)
    add_section("TwHt" + std::to_string(i + 1), "t", "tower, station " + std::to_string(i + 1),
                "tower base", section_slot(static_cast<int>(turbine_.blades.size()), i));
}

}  // namespace samara::turbine
