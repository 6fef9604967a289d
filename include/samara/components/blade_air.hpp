// The air around a blade in a system (docs/theory.md, section 11): at each point of the blade's
// mesh the induced velocity, the airfoil dynamics and the load on the section.
#pragma once

#include <vector>

#include "samara/components/beam.hpp"
#include "samara/components/component.hpp"
#include "samara/elements/air_station.hpp"
#include "samara/model/turbine.hpp"

namespace samara::components {

class BladeAir final : public Stated<BladeAir> {
 public:
  /// `k`: number of the blade, from 0. `blade`: its beam, with blocks for the air. Both must
  /// outlive the component.
  BladeAir(const model::Turbine& turbine, std::size_t k, const Beam& blade);

  /// Ports of the poses of the hub and of the blade's root.
  void tie(int hub_port, int root_port);

  void place(Registry&) override {}  // the blade has the places
  void describe(Registry& registry) override;
  bool is_conservative() const override { return false; }

  template <class System>
  void state(System& system) const;

  /// Sets the unknowns of the air in `values` to those of steady air around the blade in its
  /// present motion. `residual`: where the ports have been provided.
  void settle(const Residual<double>& residual, std::vector<double>& values) const;

 private:
  /// u, theta, V, Omega; unknowns of the air; rates of its states; poses of hub and root.
  static constexpr int at_air = 12;
  static constexpr int at_rates = at_air + elements::air::unknowns;
  static constexpr int rate_count = 10;
  static constexpr int at_hub = at_rates + rate_count;
  static constexpr int hub_values = 13;
  static constexpr int at_root = at_hub + hub_values;
  static constexpr int arguments = at_root + 9;

  const model::Air& air() const { return *turbine_.air; }
  const elements::AirStation& station(int p) const {
    return stations_[static_cast<std::size_t>(p)];
  }
  void describe_point(Registry& registry, int p) const;
  void connect_point(int p);
  void connect_added_mass(int p);
  template <class T>
  elements::StationMotion<T> motion_at(int p, const Eigen::Matrix<T, arguments, 1>& x) const;

  const model::Turbine& turbine_;
  std::size_t k_;
  const Beam& blade_;
  std::vector<elements::AirStation> stations_;
  int hub_port_ = -1;
  int root_port_ = -1;
  std::vector<Connections> points_;
  std::vector<Connections> inertias_;  ///< of the added mass
  std::vector<LinearShare> linear_;
};

extern template class Stated<BladeAir>;

}  // namespace samara::components
