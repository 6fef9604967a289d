// The places of all parts of a turbine in a state, and their small motions about it
// (docs/theory.md, sections 3.3 and 5.6). Components in the ground, n1 n2 n3.
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "samara/math/rotation.hpp"
#include "samara/turbine/turbine_equations.hpp"

namespace samara::turbine {

using Vector3c = Eigen::Matrix<std::complex<double>, 3, 1>;
using ShapeView = Eigen::Ref<const Eigen::VectorXcd>;

inline Vector3c cross(const Vector3& a, const Vector3c& b) { return math::skew<double>(a) * b; }

/// A small motion of a rigid body: translation of one of its points, and rotation.
struct Twist {
  Vector3c translation = Vector3c::Zero();
  Vector3c rotation = Vector3c::Zero();

  /// The motion of the point at `arm` from the present one.
  Twist at(const Vector3& arm) const { return {translation - cross(arm, rotation), rotation}; }
  Twist operator*(const std::complex<double>& size) const {
    return {translation * size, rotation * size};
  }
  Twist operator+(const Twist& other) const {
    return {translation + other.translation, rotation + other.rotation};
  }
  Twist operator-(const Twist& other) const {
    return {translation - other.translation, rotation - other.rotation};
  }
};

/// A Gauss point, mass node or end of a beam in a state.
struct NodePose {
  int first = 0;                       ///< unknown from which its block counts
  Matrix3 C = Matrix3::Identity();     ///< axes of the root
  Matrix3 turn = Matrix3::Zero();      ///< rotation per theta
  Vector3 place = Vector3::Zero();     ///< [m]
  Matrix3 axes = Matrix3::Identity();  ///< axes of its velocities, the deformed section, as columns
  /// The section, undeformed relative to the displaced root, as columns.
  Matrix3 section = Matrix3::Identity();

  /// Its motion relative to the root's base.
  Twist twist_of(const ShapeView& z) const {
    return {C * z.segment<3>(first), turn * z.segment<3>(first + 3)};
  }
};

/// A beam in a state.
struct BeamPose {
  std::vector<NodePose> nodes;  ///< Gauss points, mass nodes, end
  int gauss_points = 0;
  int support = -1;                         ///< the node of a root on springs; -1: none
  Vector3 base = Vector3::Zero();           ///< of the root, without its support's displacement
  Matrix3 base_axes = Matrix3::Identity();  ///< a, as columns
  Matrix3 root_axes = Matrix3::Identity();  ///< base_axes, turned by the support

  const NodePose& end() const { return nodes.back(); }
};

/// A free hinge of a blade's root in a state.
struct HingePose {
  int angle = 0;  ///< unknown
  model::HingeAxis axis = model::HingeAxis::flap;
  Twist twist;  ///< motion of the root's place per angle
};

/// The motions of the rigid bodies: tower top, nacelle (same point), shaft (bearing), hub (pin).
struct BodyTwists {
  Twist top, nacelle, shaft, hub;
};

/// A turbine in a state.
class TurbinePose {
 public:
  TurbinePose(const TurbineEquations& equations, double t, const Eigen::VectorXd& z);

  bool has_tower() const { return has_tower_; }
  const BeamPose& tower() const { return tower_; }
  const std::vector<BeamPose>& blades() const { return blades_; }
  const std::vector<HingePose>& hinges(std::size_t k) const { return hinges_[k]; }
  /// Motion of blade k's root per angle of its pitch.
  const Twist& pitch(std::size_t k) const { return pitch_twists_[k]; }

  const Vector3& top() const { return top_; }          ///< of the tower
  const Vector3& bearing() const { return bearing_; }  ///< on the yaw axis
  const Vector3& pin() const { return pin_; }          ///< of the teeter hinge
  const Vector3& apex() const { return apex_; }        ///< of the cone
  const Matrix3& nacelle_axes() const { return nacelle_axes_; }
  const Matrix3& shaft_axes() const { return shaft_axes_; }
  const Matrix3& hub_axes() const { return hub_axes_; }
  const Vector3& yaw_axis() const { return yaw_axis_; }
  const Vector3& shaft_axis() const { return shaft_axis_; }
  const Vector3& teeter_axis() const { return teeter_axis_; }

  BodyTwists body_twists(const ShapeView& z) const;
  /// Motion of the base of blade k's root by the bodies and its hinges, without the pitch.
  Twist base_twist(std::size_t k, const Twist& hub, const ShapeView& z) const;

 private:
  void place_tower(const Eigen::VectorXd& z, Matrix3& C);
  void place_blade(const model::Turbine& turbine, std::size_t k, double t, double pitch,
                   const Eigen::VectorXd& z);

  const TurbineLayout& layout_;
  bool has_tower_;
  BeamPose tower_;
  std::vector<BeamPose> blades_;
  std::vector<std::vector<HingePose>> hinges_;
  std::vector<Twist> pitch_twists_;
  Vector3 top_ = Vector3::Zero();
  Vector3 bearing_ = Vector3::Zero();
  Vector3 pin_ = Vector3::Zero();
  Vector3 apex_ = Vector3::Zero();
  Matrix3 nacelle_axes_ = Matrix3::Identity();
  Matrix3 shaft_axes_ = Matrix3::Identity();
  Matrix3 hub_axes_ = Matrix3::Identity();
  Vector3 yaw_axis_ = Vector3::UnitZ();
  Vector3 shaft_axis_ = Vector3::UnitY();
  Vector3 teeter_axis_ = Vector3::UnitX();
};

}  // namespace samara::turbine
