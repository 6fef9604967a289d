// The rigid bodies between tower and blades in a system (docs/theory.md, section 3): rows of their
// joints and of the tower top, and the motion of each blade's root.
#pragma once

#include <string>
#include <vector>

#include "samara/components/beam.hpp"
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

/// What a turbine says of its bodies.
struct BodiesSetting {
  const Beam* tower = nullptr;  ///< null: the bodies stand on the ground
  std::vector<const Beam*> blades;
  int shared_rank = 0;  ///< of elimination
};

class RigidBodies final : public Stated<RigidBodies> {
 public:
  /// Turbine and beams must live on.
  RigidBodies(const model::Turbine& turbine, const BodiesSetting& setting);

  void place(Registry& registry) override;
  void describe(Registry& registry) override;
  bool is_conservative() const override;

  /// First of q_y, U1, q_h, U2, q_s, U_s, q_g, U_g.
  int joints() const { return joints_; }

  template <class System>
  void state(System& system) const;

  /// What is asked of the bodies beside their rows. T: double or std::complex<double>.
  template <class T>
  elements::ChainReport<T> report(Residual<T>& residual) const;

 private:
  int joint(int number) const;
  int tower_top() const;
  void describe_joint(Registry& registry, int number, const std::string& name, system::Frame frame,
                      bool free) const;
  Matrix3 bearing_axes() const;
  Matrix6 carried_mass() const;
  void describe_energies(Registry& registry) const;
  void describe_generator(Registry& registry) const;
  void describe_spring(Registry& registry, const elements::Hinge& hinge, const std::string& name,
                       system::Frame frame, int angle) const;
  bool axis_moves() const;
  bool hub_moves() const;
  void connect();

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
  BodiesSetting setting_;
  int joints_ = 0;
  int hub_port_ = 0;   ///< of the motion of the apex and the gravity there, in H
  int load_port_ = 0;  ///< sum of the root loads: force and moment about the apex, in H
  elements::RigidChain chain_at_any_speed_;
  Connections chain_;
  Connections foot_;
  std::vector<Connections> loads_;  ///< of each blade
  std::vector<Connections> roots_;  ///< of each blade
};

extern template class Stated<RigidBodies>;

}  // namespace samara::components
