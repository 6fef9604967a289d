// The rigid bodies between tower and blades in a system (docs/theory.md, section 3): rows of their
// joints and of the tower top, and the motion of each blade's root.
#pragma once

#include <string>
#include <vector>

#include "samara/components/beam.hpp"
#include "samara/components/blade_root.hpp"
#include "samara/components/component.hpp"
#include "samara/elements/rigid_chain.hpp"
#include "samara/model/turbine.hpp"

namespace samara::components {

/// Data of the bodies of a turbine.
struct BodiesSetting {
  const Beam* tower = nullptr;  ///< null: the bodies stand on the ground
  std::vector<const Beam*> blades;
  int shared_rank = 0;  ///< elimination rank
  int hinge_rank = 0;   ///< rank of the hinges of blades, behind that of the roots' reactions
};

/// Motions and loads of the bodies beside their rows. They exist only within the range of torque
/// tables.
template <class T>
struct BodiesReport {
  T azimuth;           ///< azimuth of S relative to the bearing [rad]
  T yaw, teeter;       ///< angles [rad]
  T yaw_rate;          ///< [rad/s]
  T generator_rate;    ///< speed of the generator relative to the nacelle, positive in its sense of
                       ///< rotation [rad/s]
  T generator_torque;  ///< torque of the nacelle on the generator against its rotation, without the
                       ///< brake [N m]
  T brake_torque;      ///< with the same sign [N m]
  T shaft_rate;        ///< speed of S relative to the nacelle [rad/s]
  T teeter_rate;       ///< [rad/s]
  Vec6<T> rotor_load;  ///< load of the hub on the shaft at the teeter pin, in S [N, N m]
  Vec6<T> top_load;    ///< load of the nacelle on T at the tower top, in t1 t2 t3 [N, N m]
  Vec3<T> top_acceleration;  ///< acceleration of T, in t1 t2 t3 [m/s^2]
  std::vector<T> pitch;      ///< pitch of each blade, without hinges and pitch links [rad]
};

class RigidBodies final : public Stated<RigidBodies> {
 public:
  /// Turbine and beams must outlive the component.
  RigidBodies(const model::Turbine& turbine, const BodiesSetting& setting);

  void place(Registry& registry) override;
  void describe(Registry& registry) override;
  bool is_conservative() const override;
  bool has_autonomous_constraints() const override;
  /// @throws DomainError where the teeter angle of state `z` is beyond 170 degrees
  void require_admissible(const std::vector<double>& z) const;

  /// First of q_y, U1, q_h, U2, q_s, U_s, q_g, U_g.
  int joints() const { return joints_; }
  const std::vector<BladeRoot>& roots() const { return roots_; }
  /// Sets the integral of a controller. Its evolution row then fixes the mean of the generator's
  /// angle. -1: no integral.
  void set_integral(int integral) { integral_ = integral; }
  /// Port of the hub's pose (blade_root.hpp); -1: without air.
  int pose_port() const { return pose_port_; }

  template <class System>
  void state(System& system) const;

  /// Motions and loads of the bodies beside their rows. T: double or std::complex<double>.
  template <class T>
  BodiesReport<T> report(Residual<T>& residual) const;

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

  /// theta, V, Omega of the tower top; the joints; V_dot, Omega_dot; rates of the joints; F_hat,
  /// M_hat of the tower top; load on the hub about the apex.
  static constexpr int chain_arguments = 43;
  template <class T>
  using ChainArguments = Eigen::Matrix<T, chain_arguments, 1>;
  template <class T>
  struct Walk {
    Mat3<T> C_top;  ///< components in T from those in the tower's axes
    elements::FrameMotion<T> top;
    elements::RigidTree::Results<T> nodes;
    elements::Wrench<T> on_top;
  };
  template <class T, class System>
  void set_joints(const System& system, const ChainArguments<T>& x,
                  elements::RigidTree::States<T>& states) const;
  template <class T, class System>
  elements::FrameMotion<T> base_motion(const System& system, const ChainArguments<T>& x,
                                       const Mat3<T>& C_top) const;
  template <class T, class System>
  Walk<T> walk(const System& system, const ChainArguments<T>& x) const;
  /// u, theta of the tower top; the joints; motion of the apex.
  static constexpr int pose_arguments = 23;
  template <class System>
  void state_poses(System& system) const;

  const model::Turbine& turbine_;
  BodiesSetting setting_;
  int joints_ = 0;
  int integral_ = -1;
  int hub_port_ = 0;   ///< motion of the apex and gravity there, in H
  int load_port_ = 0;  ///< sum of the root loads: force and moment about the apex, in H
  int pose_port_ = -1;
  elements::RigidTree tree_;
  Connections chain_;
  Connections foot_;
  Connections pose_;
  std::vector<BladeRoot> roots_;
};

extern template class Stated<RigidBodies>;

}  // namespace samara::components
