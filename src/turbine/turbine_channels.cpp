#include "samara/turbine/turbine_channels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <string_view>

#include "samara/base/error.hpp"
#include "samara/base/words.hpp"

#include "channel_catalogue.hpp"
#include "turning.hpp"

namespace samara::turbine {

using namespace slots;

namespace {

using PointSum = std::vector<std::pair<int, double>>;

/// Beam axes 1 2 3 to x y z. Blades: outward, leading edge, downwind; tower: up, side-side,
/// downwind.
template <class T>
Vec3<T> along_beam(const Vec3<T>& v) {
  return Vec3<T>(v(2), -v(1), v(0));
}

/// Axes 1 2 3 of the bodies (side-side, downwind, up) to x y z.
template <class T>
Vec3<T> of_body(const Vec3<T>& v) {
  return Vec3<T>(v(1), -v(0), v(2));
}

/// Weights of the polynomial through the element's points. For elements with one point: of the
/// straight line through the two nearest points.
PointSum interpolate(const model::Beam& beam, double fraction) {
  std::vector<int> points;
  if (beam.order == 1) {
    int next = 0;
    while (next < beam.point_count() && beam.fractions[static_cast<std::size_t>(next)] < fraction)
      ++next;
    const int first = std::clamp(next - 1, 0, std::max(beam.point_count() - 2, 0));
    for (int p = first; p < std::min(first + 2, beam.point_count()); ++p) points.push_back(p);
  } else {
    int e = 0;
    while (e + 1 < beam.elements && beam.ends[static_cast<std::size_t>(e) + 1] < fraction) ++e;
    for (int j = 0; j < beam.order; ++j) points.push_back(e * beam.order + j);
  }
  PointSum result;
  for (const int p : points) {
    double weight = 1.0;
    const double own = beam.fractions[static_cast<std::size_t>(p)];
    for (const int q : points)
      if (q != p) {
        const double other = beam.fractions[static_cast<std::size_t>(q)];
        weight *= (fraction - other) / (own - other);
      }
    result.emplace_back(p, weight);
  }
  return result;
}

}  // namespace

std::vector<Channel> TurbineChannels::available(const TurbineSystem& system,
                                                const ChannelStations& stations) {
  return ChannelCatalogue(system.equations(), stations).channels;
}

TurbineChannels::TurbineChannels(const TurbineSystem& system, const ChannelStations& stations,
                                 const std::vector<std::string>& names)
    : system_(system), stations_(stations) {
  const ChannelCatalogue catalogue(system.equations(), stations_);
  const auto take = [&](std::size_t i, const std::string& name) {
    channels_.push_back(catalogue.channels[i]);
    channels_.back().name = name;
    picks_.push_back(catalogue.picks[i]);
  };
  if (names.empty())
    for (std::size_t i = 0; i < catalogue.sections_from; ++i) take(i, catalogue.channels[i].name);
  std::vector<std::pair<std::string, std::size_t>> known = catalogue.aliases;
  for (std::size_t i = 0; i < catalogue.channels.size(); ++i)
    known.emplace_back(catalogue.channels[i].name, i);
  std::map<std::string_view, std::size_t> numbers;
  for (const auto& [name, i] : known) numbers.try_emplace(name, i);
  std::vector<std::string> unknown;
  for (const std::string& name : names) {
    const auto found = numbers.find(name);
    if (found == numbers.end())
      unknown.push_back(name);
    else
      take(found->second, name);
  }
  if (!unknown.empty()) {
    std::vector<std::string> words;
    for (const auto& one : known) words.push_back(one.first);
    throw InputError(
        (unknown.size() == 1 ? "unknown channel " : "unknown channels ") +
        list_unknown(unknown, words, "; hint: docs/channels.md lists the channels of a turbine"));
  }
  place_sections(catalogue);
}

void TurbineChannels::place_sections(const ChannelCatalogue& catalogue) {
  size_ = catalogue.section_slot(0, 0);
  has_air_ = std::any_of(picks_.begin(), picks_.end(), [&catalogue](const ChannelPick& pick) {
    return catalogue.is_of_air(pick.slot);
  });
  const std::vector<components::PlacedBeam>& beams = system_.equations().beams();
  for (std::size_t b = 0; b < beams.size(); ++b) {
    const model::Beam& beam = *beams[b].beam;
    const std::vector<double>& places = ChannelCatalogue::stations_of(
        beam, b < system_.turbine().blades.size() ? stations_.blade : stations_.tower);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const int slot = catalogue.section_slot(static_cast<int>(b), i);
      size_ = slot + section_slots;
      const bool is_wanted =
          std::any_of(picks_.begin(), picks_.end(), [slot](const ChannelPick& pick) {
            return pick.slot >= slot && pick.slot < slot + section_slots;
          });
      if (is_wanted) sections_.push_back({static_cast<int>(b), slot, interpolate(beam, places[i])});
    }
  }
}

namespace {

template <class T>
using Block = Eigen::Matrix<T, turbine::TurbineLayout::block, 1>;

template <class T>
Block<T> block_at(const std::vector<T>& z, int first) {
  return Eigen::Map<const Block<T>>(z.data() + first);
}

/// The quantities of channel_catalogue.hpp.
template <class T>
class Quantities {
 public:
  Quantities(const TurbineSystem& system, const TurbineInputs<T>& inputs, int size)
      : inputs_(inputs),
        equations_(system.equations()),
        turbine_(system.turbine()),
        layout_(system.layout()),
        values_(static_cast<std::size_t>(size), T(0)) {}

  const T& operator[](int slot) const { return values_[static_cast<std::size_t>(slot)]; }

  /// Must be called first: the blades need its pitch.
  void add_chain(double t, const std::vector<T>& z, const std::vector<T>& z_dot) {
    const components::BodiesReport<T> chain = equations_.report<T>(t, z, z_dot, inputs_);
    pitch_ = chain.pitch;
    constexpr double turn = 2.0 * std::numbers::pi;
    put(azimuth_slot, chain.azimuth - T(turn * std::floor(real_of(chain.azimuth) / turn)));
    put(rotor_speed, chain.shaft_rate);
    put(generator_speed, chain.generator_rate);
    put(generator_torque, chain.generator_torque);
    put(brake_torque, chain.brake_torque);
    put(yaw_slot, chain.yaw);
    put(yaw_rate, chain.yaw_rate);
    put(teeter_slot, chain.teeter);
    put(teeter_rate, chain.teeter_rate);
    add_shaft(chain);
    if (turbine_.has_tower)
      add_tower(chain, z);
    else
      add_top(chain, of_body<T>(chain.top_load.template head<3>()),
              of_body<T>(chain.top_load.template tail<3>()));
  }

  void add_blade(int k, const std::vector<T>& z, const std::vector<T>& z_dot) {
    const int first = ChannelCatalogue::blade_slot(k);
    const T& pitch = pitch_[static_cast<std::size_t>(k)];
    const Mat3<T> to_cone = math::turn_about<T>(-Vector3::UnitX(), pitch);
    const Vec6<T> root = Eigen::Map<const Vec6<T>>(z.data() + layout_.blade_root(k));
    const Vec3<T> force = root.template head<3>();
    const Vec3<T> moment = root.template tail<3>();
    put(first + blade_pitch, pitch);
    put(first + root_force, along_beam<T>(force));
    put(first + root_moment, along_beam<T>(moment));
    put(first + coned_force, along_beam<T>(to_cone * force));
    put(first + coned_moment, along_beam<T>(to_cone * moment));
    const auto tip = block_at(z, layout_.blade_tip(k));
    const auto tip_dot = block_at(z_dot, layout_.blade_tip(k));
    const Vec3<T> u = tip.template segment<3>(0);
    const Vec3<T> V = tip.template segment<3>(6);
    const Vec3<T> Omega = tip.template segment<3>(9);
    const Vec3<T> swept = math::cross(Omega, V);
    const model::Beam& beam = turbine_.blades[static_cast<std::size_t>(k)];
    put(first + pitched_tip, along_beam<T>(u));
    put(first + coned_tip, along_beam<T>(to_cone * u));
    put(first + tip_turn, along_beam<T>(turned_by(beam, beam.elements - 1, tip)));
    put(first + tip_acceleration, along_beam<T>(Vec3<T>(tip_dot.template segment<3>(6)) + swept));
  }

  /// `place`: first unknown of each Gauss point.
  void add_section(int first, const model::Beam& beam, const std::vector<int>& place,
                   const PointSum& station, const std::vector<T>& z, const std::vector<T>& z_dot) {
    Vec6<T> load = Vec6<T>::Zero();
    Vec3<T> move = Vec3<T>::Zero();
    Vec3<T> turn = Vec3<T>::Zero();
    for (const auto& [p, weight] : station) {
      const auto state = block_at(z, place[static_cast<std::size_t>(p)]);
      const auto rates = block_at(z_dot, place[static_cast<std::size_t>(p)]);
      const Vector6& damping = beam.points[static_cast<std::size_t>(p)].damping;
      for (int i = 0; i < 6; ++i) load(i) += (state(12 + i) + rates(12 + i) * damping(i)) * weight;
      move += Vec3<T>(state.template segment<3>(0)) * T(weight);
      turn += turned_by(beam, p / beam.order, state) * T(weight);
    }
    put(first + section_force, along_beam<T>(load.template head<3>()));
    put(first + section_moment, along_beam<T>(load.template tail<3>()));
    put(first + section_move, along_beam<T>(move));
    put(first + section_turn, along_beam<T>(turn));
  }

  using AirReport = std::vector<std::vector<components::AirPointReport<T>>>;

  void add_rotor_air(double t, const AirReport& air) {
    Vec6<T> load = Vec6<T>::Zero();
    T wind(0.0);
    T area(0.0);
    for (std::size_t k = 0; k < air.size(); ++k)
      for (std::size_t p = 0; p < air[k].size(); ++p) {
        const components::AirPointReport<T>& point = air[k][p];
        const double length = turbine_.blades[k].point_length(static_cast<int>(p));
        load += point.hub_load * T(length);
        wind += point.wind * point.radius * length;
        area += point.radius * length;
      }
    wind /= area;
    const elements::AirRotor& rotor = turbine_.air->rotor;
    const T& speed = air.front().front().hub_speed;
    const T power = load(4) * speed;
    const double disk = std::numbers::pi * rotor.tip_radius * rotor.tip_radius;
    const T square = wind * wind + T(rotor.least_speed * rotor.least_speed);
    const T pressure = square * (0.5 * rotor.density * disk);
    put(air_force, of_body<T>(load.template head<3>()));
    put(air_moment, of_body<T>(load.template tail<3>()));
    put(air_power, power);
    put(mean_wind, wind);
    put(power_coefficient, power * wind / (pressure * square));
    put(torque_coefficient, load(4) / (pressure * rotor.tip_radius));
    put(thrust_coefficient, load(1) / pressure);
    put(tip_speed_ratio, speed * wind * rotor.tip_radius / square);
    put(hub_wind,
        of_body<T>(rotor.wind.undisturbed_at<T>(air.front().front().hub_place, t, &inputs_.wind)));
  }

  /// `air`, `stations`: of the blade at its points.
  void add_section_air(int first, const std::vector<components::AirPointReport<T>>& air,
                       const std::vector<elements::AirStation>& stations, const PointSum& station) {
    for (const auto& [p, weight] : station) {
      const components::AirPointReport<T>& at = air[static_cast<std::size_t>(p)];
      const double chord = stations[static_cast<std::size_t>(p)].chord;
      const T per_chord = at.pressure * chord;
      const std::array<T, air_values> values{at.angle,
                                             at.inflow_angle,
                                             at.speed,
                                             at.pressure,
                                             at.axial,
                                             at.tangential,
                                             at.induced_n,
                                             -at.induced_t,
                                             at.lift,
                                             at.drag,
                                             at.moment,
                                             at.lift * per_chord,
                                             at.drag * per_chord,
                                             at.moment * per_chord * chord,
                                             at.normal,
                                             at.chordwise,
                                             at.thrust,
                                             at.driving};
      for (int i = 0; i < air_values; ++i)
        values_[static_cast<std::size_t>(first + section_air + i)] +=
            values[static_cast<std::size_t>(i)] * weight;
    }
  }

 private:
  void put(int slot, const T& value) { values_[static_cast<std::size_t>(slot)] = value; }
  void put(int slot, const Vec3<T>& v) {
    for (int i = 0; i < 3; ++i) put(slot + i, v(i));
  }

  /// The rotation vector at a place in element e, from the undeformed state.
  Vec3<T> turned_by(const model::Beam& beam, int e, const Block<T>& state) const {
    return turned_from<T>(beam.reference(e), Vec3<T>(state.template segment<3>(3)));
  }

  void add_shaft(const components::BodiesReport<T>& chain) {
    const Vec3<T> force = chain.rotor_load.template head<3>();
    const Vec3<T> moment = chain.rotor_load.template tail<3>();
    const Mat3<T> C_DS = math::turn_about<T>(Vector3::UnitY(), chain.azimuth);
    put(shaft_force, of_body<T>(force));
    put(shaft_moment, of_body<T>(moment));
    put(bearing_force, of_body<T>(C_DS * force));
    put(bearing_moment, of_body<T>(C_DS * moment));
    put(rotor_power, moment(1) * chain.shaft_rate);
  }

  void add_tower(const components::BodiesReport<T>& chain, const std::vector<T>& z) {
    const auto top = block_at(z, layout_.tower_tip());
    const Vec3<T> theta = top.template segment<3>(3);
    const Vec6<T> base = Eigen::Map<const Vec6<T>>(z.data() + layout_.tower_root());
    put(top_move, along_beam<T>(top.template head<3>()));
    put(top_turn, along_beam<T>(rotation_vector<T>(theta)));
    put(base_force, along_beam<T>(base.template head<3>()));
    put(base_moment, along_beam<T>(base.template tail<3>()));
    const Mat3<T> C_Ta = math::direction_cosines<T>(theta);
    add_top(chain, along_beam<T>(C_Ta * Vec3<T>(top.template segment<3>(12))),
            along_beam<T>(C_Ta * Vec3<T>(top.template segment<3>(15))));
  }

  /// Sets the loads of the tower top from the load in its axes p, x y z.
  void add_top(const components::BodiesReport<T>& chain, const Vec3<T>& force,
               const Vec3<T>& moment) {
    const Mat3<T> C_np = math::turn_about<T>(Vector3::UnitZ(), chain.yaw).transpose();
    put(top_force, force);
    put(top_moment, moment);
    put(yawed_force, Vec3<T>(C_np * force));
    put(yawed_moment, Vec3<T>(C_np * moment));
    put(top_speed_up, of_body<T>(chain.top_acceleration));
  }

  const TurbineInputs<T>& inputs_;
  const TurbineEquations& equations_;
  const model::Turbine& turbine_;
  const turbine::TurbineLayout& layout_;
  std::vector<T> values_;
  std::vector<T> pitch_;  ///< pitch of each blade
};

}  // namespace

template <class T>
void TurbineChannels::evaluate(double t, const std::vector<T>& z, const std::vector<T>& z_dot,
                               std::span<T> values, const TurbineInputs<T>& inputs) const {
  const model::Turbine& turbine = system_.turbine();
  const int blades = static_cast<int>(turbine.blades.size());
  Quantities<T> quantities(system_, inputs, size_);
  quantities.add_chain(t, z, z_dot);
  for (int k = 0; k < blades; ++k) quantities.add_blade(k, z, z_dot);
  for (const Section& section : sections_) {
    const components::PlacedBeam& placed =
        system_.equations().beams()[static_cast<std::size_t>(section.beam)];
    quantities.add_section(section.slot, *placed.beam, placed.points, section.place, z, z_dot);
  }
  if (has_air_) {
    const auto air = system_.equations().air_report<T>(t, z, z_dot, inputs);
    quantities.add_rotor_air(t, air);
    for (const Section& section : sections_) {
      const auto k = static_cast<std::size_t>(section.beam);
      if (k < air.size())
        quantities.add_section_air(section.slot, air[k], turbine.air->stations[k], section.place);
    }
  }
  for (std::size_t i = 0; i < picks_.size(); ++i)
    values[i] = (picks_[i].unknown < 0 ? quantities[picks_[i].slot]
                                       : z[static_cast<std::size_t>(picks_[i].unknown)]) *
                picks_[i].factor;
}

template void TurbineChannels::evaluate(double, const std::vector<double>&,
                                        const std::vector<double>&, std::span<double>,
                                        const TurbineInputs<double>&) const;
template void TurbineChannels::evaluate(double, const std::vector<std::complex<double>>&,
                                        const std::vector<std::complex<double>>&,
                                        std::span<std::complex<double>>,
                                        const TurbineInputs<std::complex<double>>&) const;

void TurbineChannels::evaluate(double t, Vec z, Vec z_dot, std::span<double> values) const {
  const auto plain = [this](Vec vector) {
    const petsc::ReadView view(vector);
    return std::vector<double>(view.data(), view.data() + system_.size());
  };
  evaluate<double>(t, plain(z), plain(z_dot), values);
}

}  // namespace samara::turbine
