// The air around a blade in a system (docs/theory.md, section 11): at each point of the blade's
// mesh the induced velocity, the airfoil dynamics and the load on the section.
#pragma once

#include <vector>

#include "samara/components/beam.hpp"
#include "samara/components/blade_root.hpp"
#include "samara/components/component.hpp"
#include "samara/elements/air_station.hpp"
#include "samara/model/turbine.hpp"

namespace samara::components {

/// The air at one point of a blade, beside its rows. Loads are per length of the blade, without the
/// inertia of the air.
template <class T>
struct AirPointReport {
  T angle;                 ///< of attack, at the aerodynamic centre [rad]
  T inflow_angle;          ///< between the relative wind and the plane of the rotor [rad]
  T speed;                 ///< of the relative wind [m/s]
  T pressure;              ///< dynamic pressure [Pa]
  T axial, tangential;     ///< induction factors a and a'
  T induced_n, induced_t;  ///< induced velocity [m/s]
  T lift, drag, moment;    ///< coefficients of the section
  T normal, chordwise;     ///< force toward the suction side and the leading edge [N/m]
  T thrust, driving;       ///< force along the rotor's axis and in the sense of its turning [N/m]
  T wind;                  ///< undisturbed wind against the apex, along the rotor's axis [m/s]
  T hub_speed;             ///< angular velocity of the rotor about its axis [rad/s]
  T radius;                ///< distance from the axis [m]
  Vec6<T> hub_load;        ///< force and moment about the apex in h1 h2 h3 [N/m, N]
  Vec3<T> place;           ///< components n1 n2 n3 [m]
  Vec3<T> force;           ///< the same [N/m]
  Vec3<T> couple;          ///< moment about the reference line, the same [N]
  Mat3<T> section_axes;    ///< B as columns, components n1 n2 n3
  Mat3<T> hub_axes;        ///< h1 h2 h3 as columns
  Vec3<T> hub_place;       ///< apex, components n1 n2 n3 [m]
};

/// Usual velocity of the flow that a rotor induces [m/s], the scale of such unknowns.
double usual_induced_velocity(const model::Turbine& turbine);

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

  /// The air at each point. `residual`: where the ports have been provided.
  template <class T>
  std::vector<AirPointReport<T>> report(const Residual<T>& residual) const;

  /// Sets the unknowns of the air in `values` to those of steady air around the blade in its
  /// present motion. `residual`: where the ports have been provided.
  void settle(const Residual<double>& residual, std::vector<double>& values) const;

  /// @throws DomainError if a point of the blade is inside the tower, whose flow has no meaning
  /// there. `residual`: where the ports have been provided.
  void require_admissible(const Residual<double>& residual) const;

 private:
  /// u, theta, V, Omega; unknowns of the air; rates of its states; poses of hub and root.
  static constexpr int at_air = 12;
  static constexpr int at_rates = at_air + elements::air::unknowns;
  static constexpr int rate_count = 10;
  static constexpr int at_hub = at_rates + rate_count;
  static constexpr int at_root = at_hub + hub_pose_values;
  static constexpr int arguments = at_root + root_pose_values;

  const model::Air& air() const { return *turbine_.air; }
  const elements::AirStation& station(int p) const {
    return stations_[static_cast<std::size_t>(p)];
  }
  void describe_point(Registry& registry, int p) const;
  void connect_point(int p);
  void connect_added_mass(int p);
  template <class T>
  elements::StationMotion<T> motion_at(int p, const Eigen::Matrix<T, arguments, 1>& x, double t,
                                       const elements::WindInputs<T>* change = nullptr) const;
  template <class T>
  AirPointReport<T> report_at(int p, const Eigen::Matrix<T, arguments, 1>& x, double t,
                              const elements::WindInputs<T>& change) const;

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
