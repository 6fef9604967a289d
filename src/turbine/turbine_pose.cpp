#include "turbine_pose.hpp"

namespace samara::turbine {
namespace {

BeamPose pose_of(const components::PlacedBeam& where, const Vector3& base, const Matrix3& C,
                 const Eigen::VectorXd& z) {
  const model::Beam& beam = *where.beam;
  BeamPose pose;
  pose.base = base;
  pose.base_axes = C;
  pose.root_axes = C;
  pose.gauss_points = beam.point_count();
  if (beam.has_support)
    pose.root_axes *=
        math::direction_cosines<double>(Vector3(z.segment<3>(where.masses[0] + 3))).transpose();
  const auto put = [&](int first, const Vector3& x, const Matrix3& turned, const Matrix3& section) {
    const Vector3 theta = z.segment<3>(first + 3);
    const Matrix3 back = math::direction_cosines<double>(theta).transpose();
    Matrix3 Q;
    for (int i = 0; i < 3; ++i) Q.col(i) = math::tangent_times<double>(theta, Vector3::Unit(i));
    pose.nodes.push_back({first, C, C * back * Q, base + C * (x + z.segment<3>(first)),
                          C * back * turned, pose.root_axes * section});
  };
  for (int p = 0; p < beam.point_count(); ++p) {
    const auto at = static_cast<std::size_t>(p);
    const elements::BeamPoint& point = beam.points[at];
    put(where.points[at], point.x, point.reference * point.C_ab, point.C_ab);
  }
  for (std::size_t m = 0; m < beam.mass_nodes.size(); ++m) {
    const model::MassNode& node = beam.mass_nodes[m];
    const auto next = static_cast<std::size_t>(node.end * beam.order);  // index of the next point
    if (node.end == 0) pose.support = static_cast<int>(pose.nodes.size());
    put(where.masses[m], node.x, beam.reference_before(node.end), beam.points[next].C_ab);
  }
  put(where.tip, beam.tip, beam.reference(beam.elements - 1), beam.points.back().C_ab);
  return pose;
}

}  // namespace

TurbinePose::TurbinePose(const TurbineEquations& equations, double t, const Eigen::VectorXd& z)
    : layout_(equations.layout()), has_tower_(equations.turbine().has_tower) {
  const model::Turbine& turbine = equations.turbine();
  const elements::RigidChain& chain = turbine.chain;
  const std::vector<double> plain(z.begin(), z.end());
  const std::vector<double> pitch =
      equations.report<double>(t, plain, std::vector<double>(plain.size()), {}).pitch;
  Matrix3 C = Matrix3::Identity();  // axes of T
  if (has_tower_) place_tower(z, C);
  yaw_axis_ = C.col(2);
  C *= math::turn_about<double>(Vector3::UnitZ(), z(layout_.yaw()));
  nacelle_axes_ = C;
  bearing_ = top_ + C * Vector3(0.0, 0.0, chain.height);
  C *= math::turn_about<double>(Vector3::UnitX(), chain.tilt);
  shaft_axis_ = C.col(1);
  pin_ = bearing_ + chain.overhang * shaft_axis_;
  C *= math::turn_about<double>(
      Vector3::UnitY(),
      turbine.turning_at(t).value + z(layout_.generator()) + z(layout_.shaft_torsion()));
  shaft_axes_ = C;
  teeter_axis_ = C * chain.teeter_axis;
  C *= math::turn_about<double>(chain.teeter_axis, z(layout_.teeter()));
  hub_axes_ = C;
  apex_ = pin_ + chain.undersling * C.col(1);
  for (std::size_t k = 0; k < turbine.blades.size(); ++k) place_blade(turbine, k, t, pitch[k], z);
}

/// Places the tower. C becomes the axes of the tower top: ground components of t1 t2 t3.
void TurbinePose::place_tower(const Eigen::VectorXd& z, Matrix3& C) {
  Matrix3 upright;  // a = (n3, n1, n2)
  upright << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  tower_ = pose_of(layout_.beams().back(), Vector3::Zero(), upright, z);
  top_ = tower_.end().place;
  const Vector3 theta = z.segment<3>(layout_.tower_tip() + 3);
  C = upright * math::direction_cosines<double>(theta).transpose() * upright.transpose();
}

/// Places a blade behind its hinges, at the apex.
void TurbinePose::place_blade(const model::Turbine& turbine, std::size_t k, double t, double pitch,
                              const Eigen::VectorXd& z) {
  const model::BladeRoot& root = turbine.roots[k];
  const int blade = static_cast<int>(k);
  const auto angle_of = [&](int hinge) { return z(layout_.hinge(blade, hinge)); };
  std::vector<HingePose> hinges(root.hinges.size());
  std::vector<Vector3> points(root.hinges.size());
  Vector3 place_of_pitch = apex_;
  Twist pitch_twist;
  Vector3 at = apex_;
  Matrix3 axes = hub_axes_;
  for (const model::RootLink& link : root.links) {
    at += axes * link.arm;
    axes = (axes * link.axes).eval();
    const Vector3 axis = axes * link.axis;
    double angle = link.motion.at(t, turbine.speed).angle;
    if (link.is_pitch) {
      place_of_pitch = at;
      pitch_twist.rotation = axis.cast<std::complex<double>>();
      angle += pitch - root.pitch;
    }
    if (link.hinge >= 0) {
      const auto i = static_cast<std::size_t>(link.hinge);
      points[i] = at;
      hinges[i] = {layout_.hinge(blade, link.hinge), root.hinges[i].axis, {}};
      hinges[i].twist.rotation = axis.cast<std::complex<double>>();
      angle += angle_of(link.hinge);
    }
    if (link.is_pitch && root.flap_hinge >= 0)
      angle += root.pitch_by_flap * angle_of(root.flap_hinge);
    axes = (axes * math::turn_about<double>(link.axis, angle)).eval();
  }
  // Twists of the root's place: a hinge turns it about the hinge's point, the pitch link about
  // the point of the pitch.
  for (std::size_t i = 0; i < hinges.size(); ++i)
    hinges[i].twist = hinges[i].twist.at(at - points[i]);
  pitch_twist = pitch_twist.at(at - place_of_pitch);
  if (root.flap_hinge >= 0 && root.pitch_by_flap != 0.0) {
    Twist& flap = hinges[static_cast<std::size_t>(root.flap_hinge)].twist;
    flap = flap + pitch_twist * root.pitch_by_flap;
  }
  hinges_.push_back(hinges);
  pitch_twists_.push_back(pitch_twist);
  blades_.push_back(pose_of(layout_.beams()[k], at, axes, z));
}

BodyTwists TurbinePose::body_twists(const ShapeView& z) const {
  const std::complex<double> turning = z(layout_.generator()) + z(layout_.shaft_torsion());
  BodyTwists twists;
  if (has_tower_) twists.top = tower_.end().twist_of(z);
  twists.nacelle = {twists.top.translation, twists.top.rotation + yaw_axis_ * z(layout_.yaw())};
  twists.shaft = {twists.nacelle.at(bearing_ - top_).translation,
                  twists.nacelle.rotation + shaft_axis_ * turning};
  twists.hub = {twists.shaft.at(pin_ - bearing_).translation,
                twists.shaft.rotation + teeter_axis_ * z(layout_.teeter())};
  return twists;
}

Twist TurbinePose::base_twist(std::size_t k, const Twist& hub, const ShapeView& z) const {
  Twist base = hub.at(blades_[k].base - pin_);
  for (const HingePose& hinge : hinges_[k]) base = base + hinge.twist * z(hinge.angle);
  return base;
}

}  // namespace samara::turbine
