// The channels of a turbine, and the places of their values among the quantities that are computed
// together.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "samara/turbine/turbine_channels.hpp"

namespace samara::turbine {

namespace slots {

// Indices of quantities; vectors have three, along x y z of OpenFAST's frames unless noted.
// Channels of a blade:
inline constexpr int coned_force = 0;  // root load, axes of the cone
inline constexpr int coned_moment = 3;
inline constexpr int root_force = 6;  // root load, pitched axes
inline constexpr int root_moment = 9;
inline constexpr int coned_tip = 12;  // tip displacement
inline constexpr int pitched_tip = 15;
inline constexpr int tip_turn = 18;          // rotation vector of the tip, pitched axes
inline constexpr int tip_acceleration = 21;  // in the axes of the tip's section
inline constexpr int blade_pitch = 24;
inline constexpr int blade_slots = 25;
// Channels of the whole turbine:
inline constexpr int base_force = 0;  // tower base
inline constexpr int base_moment = 3;
inline constexpr int top_force = 6;  // tower top, axes p of the tower top
inline constexpr int top_moment = 9;
inline constexpr int yawed_force = 12;  // the same, axes n of the nacelle
inline constexpr int yawed_moment = 15;
inline constexpr int top_move = 18;  // axes t
inline constexpr int top_turn = 21;
inline constexpr int top_speed_up = 24;  // acceleration, axes p
inline constexpr int shaft_force = 27;   // axes a, turning with the shaft
inline constexpr int shaft_moment = 30;
inline constexpr int bearing_force = 33;  // axes s, not turning
inline constexpr int bearing_moment = 36;
inline constexpr int azimuth_slot = 39;
inline constexpr int rotor_speed = 40;
inline constexpr int generator_speed = 41;
inline constexpr int yaw_slot = 42;
inline constexpr int yaw_rate = 43;
inline constexpr int teeter_slot = 44;
inline constexpr int teeter_rate = 45;
inline constexpr int rotor_power = 46;
inline constexpr int generator_torque = 47;
inline constexpr int brake_torque = 48;
inline constexpr int air_force = 49;  // of the air on the blades, axes of the hub
inline constexpr int air_moment = 52;
inline constexpr int air_power = 55;
inline constexpr int mean_wind = 56;
inline constexpr int power_coefficient = 57;
inline constexpr int torque_coefficient = 58;
inline constexpr int thrust_coefficient = 59;
inline constexpr int tip_speed_ratio = 60;
inline constexpr int hub_wind = 61;  // downwind, left, up
inline constexpr int whole_slots = 64;
// Channels of a station:
inline constexpr int section_force = 0;  // axes of the section
inline constexpr int section_moment = 3;
inline constexpr int section_move = 6;  // axes of the root
inline constexpr int section_turn = 9;
inline constexpr int section_air = 12;  // in the order of air_channels
inline constexpr int air_values = 18;
inline constexpr int section_slots = section_air + air_values;

}  // namespace slots

/// All channels of a turbine.
class ChannelCatalogue {
 public:
  ChannelCatalogue(const TurbineEquations& equations, const ChannelStations& stations);

  std::vector<Channel> channels;
  std::vector<ChannelPick> picks;  ///< one per channel
  std::size_t sections_from = 0;   ///< number of the first channel of the stations
  /// Other names of channels, by number.
  std::vector<std::pair<std::string, std::size_t>> aliases;

  /// First quantity of a blade (0-based).
  static int blade_slot(int blade) { return slots::whole_slots + blade * slots::blade_slots; }
  int section_slot(int beam, std::size_t i) const;

  /// True if the value in a slot is one of the air.
  bool is_of_air(int slot) const;

  /// Places of the stations of a beam, fractions of its length.
  static const std::vector<double>& stations_of(const model::Beam& beam,
                                                const std::vector<double>& asked) {
    return asked.empty() ? beam.fractions : asked;
  }

 private:
  void add(const std::string& names, const std::string& unit, const std::string& frame,
           const std::string& description, int slot, double factor);
  void add_force(const std::string& names, const std::string& frame, const std::string& description,
                 int slot);
  void add_moment(const std::string& names, const std::string& frame,
                  const std::string& description, int slot);
  void add_rotation();
  void add_blade(int k);
  void add_shaft();
  void add_yaw_bearing();
  void add_tower();
  void add_air();
  void add_section_air(const std::string& before, const std::string& place, int slot);
  void add_section(const std::string& before, const std::string& after, const std::string& place,
                   const std::string& root, int slot);
  void add_blade_sections(int k);
  void add_tower_sections();

  const model::Turbine& turbine_;
  const ChannelStations& stations_;
};

}  // namespace samara::turbine
