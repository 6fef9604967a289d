// The rigid bodies between tower and blades in a system (docs/theory.md, section 3): rows of their
// joints and of the tower top, and the motion of each blade's root.
#pragma once

#include <vector>

#include "samara/components/component.hpp"
#include "samara/elements/rigid_chain.hpp"
#include "samara/model/turbine.hpp"

namespace samara::components {

/// How a blade's axes a have turned about -b1 from those that C_Ha states.
template <class T>
struct BladePitch {
  bool moves = false;  ///< false: they have not, and do not
  T angle = T(0);      ///< [rad]
  T rate = T(0);       ///< [rad/s]

  /// Components in the axes that C_Ha states from those in the turned ones.
  Mat3<T> feather() const { return math::turn_about<T>(-Vector3::UnitX(), angle); }
};

/// Where the unknowns of the bodies and the ports of what they carry are.
struct PlacedBodies {
  int tower_top = -1;            ///< first unknown of the end of the tower; -1: none
  int joints = 0;                ///< q_y, U1, q_h, U2, q_s, U_s, q_g, U_g
  std::vector<int> blade_roots;  ///< first of F_hat_0, M_hat_0 of each blade
  std::vector<int> root_ports;   ///< of each blade
  int tower_port = -1;           ///< of the tower's foot; -1: none
  int hub_port = 0;              ///< of the motion of the apex and the gravity there, in H
  int load_port = 0;             ///< sum of the root loads: force and moment about the apex, in H
};

class RigidBodies final : public Stated<RigidBodies> {
 public:
  /// The turbine must live on.
  RigidBodies(const model::Turbine& turbine, const PlacedBodies& placed);

  template <class System>
  void state(System& system) const;

  /// What is asked of the bodies beside their rows. T: double or std::complex<double>.
  template <class T>
  elements::ChainReport<T> report(Residual<T>& residual) const;

 private:
  template <class System>
  void state_loads(System& system) const;
  template <class System>
  void state_roots(System& system) const;
  template <class T, class System, class Arguments>
  elements::ChainState<T> chain_state(const System& system, const Arguments& x) const;
  template <class T, class System>
  BladePitch<T> pitch_of(const System& system, std::size_t k) const;
  template <class System>
  const elements::RigidChain& chain_in(const System& system) const;

  const model::Turbine& turbine_;
  PlacedBodies placed_;
  elements::RigidChain chain_at_any_speed_;
  Connections chain_;
  Connections foot_;
  std::vector<Connections> loads_;  ///< of each blade
  std::vector<Connections> roots_;  ///< of each blade
};

extern template class Stated<RigidBodies>;

}  // namespace samara::components
