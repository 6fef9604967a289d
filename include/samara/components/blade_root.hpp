// The root of a blade on the hub: its pitch and its hinges, which have no mass (docs/theory.md,
// section 3.3). The motion of the root follows from the motion of the hub; the load on the hub
// follows from the load on the root. A free hinge has an angle q, its rate U and the balance of
// moments about its axis.
#pragma once

#include <vector>

#include "samara/components/component.hpp"
#include "samara/math/rotation.hpp"
#include "samara/model/turbine.hpp"

namespace samara::components {

/// Values of the port of the hub's pose: place of the apex, h1, h2; velocity of the apex; angular
/// velocity about h2. Components in the ground.
inline constexpr int hub_pose_values = 13;
/// Values of the port of a root's pose: its place, then b1 and b2 of the root. Components in the
/// ground.
inline constexpr int root_pose_values = 9;

template <class T>
elements::HubPose<T> hub_pose_of(const Eigen::Matrix<T, hub_pose_values, 1>& port) {
  elements::HubPose<T> hub;
  hub.place = port.template head<3>();
  hub.axis = port.template segment<3>(6);
  hub.velocity = port.template segment<3>(9);
  hub.speed = port(12);
  return hub;
}

template <class T>
elements::RootPose<T> root_pose_of(const Eigen::Matrix<T, root_pose_values, 1>& port) {
  elements::RootPose<T> root;
  root.place = port.template head<3>();
  root.axes.col(0) = port.template segment<3>(3);
  root.axes.col(1) = port.template segment<3>(6);
  root.axes.col(2) = math::cross(Vec3<T>(root.axes.col(0)), Vec3<T>(root.axes.col(1)));
  return root;
}

/// "flap hinge", "lag hinge", "pitch hinge"
const char* hinge_name(model::HingeAxis axis);

class BladeRoot {
 public:
  /// `k`: number of the blade, from 0. The turbine must outlive the component.
  BladeRoot(const model::Turbine& turbine, std::size_t k);

  void place(Registry& registry, int rank);
  /// `root`: first of the root's reactions. Ports: motion of the hub, load on the hub, motion of
  /// the root.
  void describe(Registry& registry, int root, int hub_port, int load_port, int root_port);
  /// Adds the port of the root's pose.
  void place_pose(Registry& registry) { pose_port_ = registry.add_port(root_pose_values); }
  int pose_port() const { return pose_port_; }
  /// `hub_port`: place of the apex, then h1 and h2.
  void connect_pose(int hub_port);
  bool is_conservative() const;

  /// First of q, U of each free hinge.
  int first() const { return first_; }
  /// Port of the angle and rate that an actuator or a controller adds to the blade's own pitch; -1:
  /// no port.
  int pitch_port() const { return pitch_port_; }
  /// Pitch without the angles of a hinge and a pitch link [rad]; valid after state_load.
  template <class T>
  T pitch(const Residual<T>& residual) const;

  /// States the load on the hub and the rows of the hinges.
  template <class System>
  void state_load(System& system) const;
  /// States the motion of the root.
  template <class System>
  void state_motion(System& system) const;
  /// States the pose of the root.
  template <class System>
  void state_pose(System& system) const;

 private:
  static constexpr int most_hinges = 3;
  /// Root load; pitch and its rate from a port; q, U, rate of q.
  static constexpr int load_arguments = 8 + 3 * most_hinges;
  static constexpr int load_values = 6 + 2 * most_hinges;  ///< load on the hub; rows
  /// Motion of the hub; pitch and its rate; q, U.
  static constexpr int motion_arguments = 11 + 2 * most_hinges;
  /// Pose and motion of the hub; pitch and its rate; q, U.
  static constexpr int pose_arguments = hub_pose_values + 2 + 2 * most_hinges;

  /// Rotation of a link.
  template <class T>
  struct Turn {
    bool moves = false;
    T angle = T(0);
    T rate = T(0);
  };
  /// Rotation of the pitch without hinge and pitch link; `added`: values of the pitch port.
  template <class T, class System>
  Turn<T> pitch_turn(const System& system, const Eigen::Matrix<T, 2, 1>& added) const;
  /// `angles`: pitch and its rate from the port, q, then U.
  template <class T, class System, class Angles>
  Turn<T> turn_of(const System& system, const model::RootLink& link, const Angles& angles) const;

  const model::BladeRoot& root() const { return turbine_.roots[k_]; }
  std::vector<Argument> hinge_arguments(bool with_rates) const;
  void describe_channel(Registry& registry, model::HingeAxis axis, int angle) const;
  bool is_unloaded() const;

  const model::Turbine& turbine_;
  std::size_t k_;
  int first_ = 0;
  int pitch_port_ = -1;
  int pose_port_ = -1;
  Connections load_;
  Connections motion_;
  Connections pose_;
};

/// Sum of the prescribed motion, the pitch, the hinge and the pitch link.
template <class T, class System, class Angles>
BladeRoot::Turn<T> BladeRoot::turn_of(const System& system, const model::RootLink& link,
                                      const Angles& angles) const {
  Turn<T> turn;
  if (link.is_pitch)
    turn = pitch_turn<T>(system, Eigen::Matrix<T, 2, 1>(angles.template head<2>()));
  const auto add = [&](int hinge, double ratio) {
    turn.moves = true;
    turn.angle += angles(2 + hinge) * ratio;
    turn.rate += angles(2 + most_hinges + hinge) * ratio;
  };
  if (link.hinge >= 0) add(link.hinge, 1.0);
  if (link.is_prescribed()) {
    const elements::JointMotion now = link.motion.at(system.time(), turbine_.speed);
    const bool varies = !link.motion.is_constant();
    turn.moves = true;
    turn.angle += T(varies ? system.varying(now.angle) : now.angle);
    turn.rate += T(varies ? system.varying(now.rate) : 0.0);
  }
  if (link.is_pitch && root().pitch_by_flap != 0.0) add(root().flap_hinge, root().pitch_by_flap);
  return turn;
}

/// An actuator includes curves and inputs in its own rows; they are not added here.
template <class T, class System>
BladeRoot::Turn<T> BladeRoot::pitch_turn(const System& system,
                                         const Eigen::Matrix<T, 2, 1>& added) const {
  Turn<T> turn;
  if (pitch_port_ >= 0) turn = {true, added(0), added(1)};
  if (turbine_.pitch_actuator) return turn;
  if (turbine_.has_pitch_curve(k_)) {
    const math::TimeCurve::Value now = turbine_.pitch_at(k_, system.time());
    turn.moves = true;
    turn.angle += T(system.varying(now.value - root().pitch));
    turn.rate += T(system.varying(now.rate));
  }
  if constexpr (System::has_inputs) {
    const TurbineInputs<T>& inputs = system.inputs();
    if (inputs.pitch.empty()) return turn;
    turn.moves = true;
    turn.angle += inputs.pitch[k_];
    turn.rate += inputs.pitch_rate[k_];
  }
  return turn;
}

template <class T>
T BladeRoot::pitch(const Residual<T>& residual) const {
  Eigen::Matrix<T, 2, 1> added = Eigen::Matrix<T, 2, 1>::Zero();
  if (pitch_port_ >= 0) added = residual.port(pitch_port_);
  return pitch_turn<T>(residual, added).angle + T(root().pitch);
}

template <class System>
void BladeRoot::state_load(System& system) const {
  const double pitch_slope =
      turbine_.rotor_pitch_slope / static_cast<double>(turbine_.blades.size());
  const auto rows_of = [&]<class T>(const Eigen::Matrix<T, load_arguments, 1>& x) {
    const Eigen::Matrix<T, 2 + 2 * most_hinges, 1> angles =
        x.template segment<2 + 2 * most_hinges>(6);
    const auto hinges = angles.template tail<2 * most_hinges>();
    T pitch(0.0);
    Vec3<T> force = x.template head<3>();
    Vec3<T> moment = x.template segment<3>(3);
    Eigen::Matrix<T, load_values, 1> y = Eigen::Matrix<T, load_values, 1>::Zero();
    for (auto link = root().links.rbegin(); link != root().links.rend(); ++link) {
      if (const Turn<T> turn = turn_of<T>(system, *link, angles); turn.moves) {
        if (link->is_pitch) pitch = turn.angle;
        const Vec3<T> axis = link->axis.template cast<T>();
        const T torque = math::dot(axis, moment);
        if (link->hinge >= 0) y(6 + link->hinge) += torque;
        if (link->is_pitch && root().pitch_by_flap != 0.0)
          y(6 + root().flap_hinge) += torque * root().pitch_by_flap;
        const Mat3<T> turned = math::turn_about<T>(link->axis, turn.angle);
        force = (turned * force).eval();
        moment = (turned * moment).eval();
      }
      if (!link->axes.isIdentity(0.0)) {
        const Mat3<T> axes = link->axes.template cast<T>();
        force = (axes * force).eval();
        moment = (axes * moment).eval();
      }
      if (!link->arm.isZero(0.0)) {
        const Vec3<T> arm = link->arm.template cast<T>();
        moment += math::cross(arm, force);
      }
    }
    y.template head<3>() = force;
    y.template segment<3>(3) = moment;
    // The torque of the rotor changes with the mean pitch of all blades.
    if (pitch_slope != 0.0) y(4) += (pitch + T(root().pitch - turbine_.pitch)) * pitch_slope;
    for (std::size_t i = 0; i < root().hinges.size(); ++i) {
      const model::RootHinge& hinge = root().hinges[i];
      const auto at = static_cast<Eigen::Index>(i);
      y(6 + at) -= hinges(at) * hinge.stiffness + hinges(most_hinges + at) * hinge.damping;
      y(6 + most_hinges + at) = x(8 + 2 * most_hinges + at) - hinges(most_hinges + at);
    }
    return y;
  };
  system.template add<load_arguments, load_values>(load_, rows_of);
}

template <class System>
void BladeRoot::state_motion(System& system) const {
  const auto motion_of = [&]<class T>(const Eigen::Matrix<T, motion_arguments, 1>& x) {
    const Eigen::Matrix<T, 2 + 2 * most_hinges, 1> angles = x.template tail<2 + 2 * most_hinges>();
    Vec3<T> velocity = x.template head<3>();
    Vec3<T> omega = x.template segment<3>(3);
    Vec3<T> gravity = x.template segment<3>(6);
    const auto turn_back = [&](const Mat3<T>& axes) {
      for (Vec3<T>* vector : {&velocity, &omega, &gravity})
        *vector = (axes.transpose() * *vector).eval();
    };
    for (const model::RootLink& link : root().links) {
      if (!link.arm.isZero(0.0)) {
        const Vec3<T> arm = link.arm.template cast<T>();
        velocity += math::cross(omega, arm);
      }
      if (!link.axes.isIdentity(0.0)) turn_back(link.axes.template cast<T>());
      if (const Turn<T> turn = turn_of<T>(system, link, angles); turn.moves) {
        turn_back(math::turn_about<T>(link.axis, turn.angle));
        for (int i = 0; i < 3; ++i)
          if (link.axis(i) != 0.0) omega(i) += turn.rate * link.axis(i);
      }
    }
    Eigen::Matrix<T, 9, 1> motion;
    motion << velocity, omega, gravity;
    return motion;
  };
  system.template add<motion_arguments, 9>(motion_, motion_of);
}

template <class System>
void BladeRoot::state_pose(System& system) const {
  const auto pose_of = [&]<class T>(const Eigen::Matrix<T, pose_arguments, 1>& x) {
    const Eigen::Matrix<T, 2 + 2 * most_hinges, 1> angles = x.template tail<2 + 2 * most_hinges>();
    Vec3<T> place = x.template head<3>();
    Mat3<T> axes;
    axes.col(0) = x.template segment<3>(3);
    axes.col(1) = x.template segment<3>(6);
    axes.col(2) = math::cross(Vec3<T>(axes.col(0)), Vec3<T>(axes.col(1)));
    for (const model::RootLink& link : root().links) {
      if (!link.arm.isZero(0.0)) place += axes * link.arm.template cast<T>();
      if (!link.axes.isIdentity(0.0)) axes = (axes * link.axes.template cast<T>()).eval();
      if (const Turn<T> turn = turn_of<T>(system, link, angles); turn.moves)
        axes = (axes * math::turn_about<T>(link.axis, turn.angle)).eval();
    }
    Eigen::Matrix<T, root_pose_values, 1> pose;
    pose << place, axes.col(0), axes.col(1);
    return pose;
  };
  system.template add<pose_arguments, root_pose_values>(pose_, pose_of);
}

}  // namespace samara::components
