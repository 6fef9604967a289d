#include "samara/turbine/turbine_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "turbine_pose.hpp"

namespace samara::turbine {
namespace {

/// Shares of the length: of a section of unknown size, and between which all sizes are.
constexpr double usual_size = 0.02;
constexpr double least_size = 0.002;
constexpr double largest_size = 0.1;

/// Nodes of the rigid bodies, after those of the tower.
enum Body { top_on_nacelle, bearing_on_nacelle, bearing_on_shaft, pin_on_shaft, pin_on_hub, apex };

/// Components x y z of a vector in n1 n2 n3.
template <class Vector>
auto ground_of(const Vector& n) {
  return Vector(n(1), -n(0), n(2));
}

Matrix3 ground_axes(const Matrix3& axes) {
  Matrix3 turned;
  for (int i = 0; i < 3; ++i) turned.col(i) = ground_of(Vector3(axes.col(i)));
  return turned;
}

/// The axes of a body that point as x y z of the ground do.
Matrix3 body_axes(const Matrix3& axes) {
  Matrix3 named;
  named << axes.col(1), -axes.col(0), axes.col(2);
  return ground_axes(named);
}

/// Width of a thin tube whose section has a squared radius of gyration; 0 if there is none.
double tube_width(double square) { return square > 0.0 ? 2.0 * std::sqrt(2.0 * square) : 0.0; }

/// `bending`: 1: about the second axis, 2: about the third.
double size_of(const model::Beam& beam, int p, int bending) {
  const elements::BeamPoint& point = beam.points[static_cast<std::size_t>(p)];
  const int at = 3 + bending;
  const auto ratio = [](double over, double under) { return under > 0.0 ? over / under : 0.0; };
  double size = tube_width(ratio(point.compliance(0, 0), point.compliance(at, at)));
  if (size == 0.0) size = tube_width(ratio(point.mass(at, at), point.mass(0, 0)));
  if (size == 0.0) size = usual_size * beam.length;
  return std::clamp(size, least_size * beam.length, largest_size * beam.length);
}

}  // namespace

TurbineGeometry::TurbineGeometry(const TurbineSystem& system) : system_(system) {
  const model::Turbine& turbine = system.turbine();
  if (turbine.has_tower) add_beam(turbine.blades.size(), turbine.tower);
  const int first = add_body("nacelle");
  add_body("nacelle");
  add_body("shaft");
  add_body("shaft");
  add_body("hub");
  add_body("hub");
  for (const int from : {top_on_nacelle, bearing_on_shaft, pin_on_hub})
    lines_.push_back({first + from, first + from + 1});
  for (std::size_t k = 0; k < turbine.blades.size(); ++k) {
    lines_.push_back({first + apex, static_cast<int>(nodes_.size())});
    add_beam(k, turbine.blades[k]);
  }
}

int TurbineGeometry::add_body(const std::string& part) {
  nodes_.push_back({part});
  places_.push_back({});
  return static_cast<int>(nodes_.size()) - 1;
}

/// Adds root, Gauss points and end of a beam with the lines between them.
void TurbineGeometry::add_beam(std::size_t beam, const model::Beam& definition) {
  const int points = definition.point_count();
  const int masses = static_cast<int>(definition.mass_nodes.size());
  const int root = definition.has_support ? points : -1;  // the first mass node
  const auto add = [&](int node, double station, int near) {
    const double air = width_of_air(beam, near);
    const double width = air > 0.0 ? air : size_of(definition, near, 2);
    nodes_.push_back(
        {definition.name, station, width, std::min(width, size_of(definition, near, 1))});
    const bool is_point = node >= 0 && node < points;
    const Matrix3& section = definition.points[static_cast<std::size_t>(near)].C_ab;
    places_.push_back({static_cast<int>(beam), node, is_point ? Matrix3::Identity() : section});
  };
  const int first = static_cast<int>(nodes_.size());
  add(root, 0.0, 0);
  for (int p = 0; p < points; ++p) add(p, definition.fractions[static_cast<std::size_t>(p)], p);
  add(points + masses, 1.0, points - 1);
  for (int i = first; i + 1 < static_cast<int>(nodes_.size()); ++i) lines_.push_back({i, i + 1});
}

/// The chord of a blade; 0 without air.
double TurbineGeometry::width_of_air(std::size_t beam, int point) const {
  const std::optional<model::Air>& air = system_.turbine().air;
  if (!air || beam >= air->stations.size()) return 0.0;
  return air->stations[beam][static_cast<std::size_t>(point)].chord;
}

namespace {

const BeamPose& beam_of(const TurbinePose& pose, int beam) {
  const auto at = static_cast<std::size_t>(beam);
  return at < pose.blades().size() ? pose.blades()[at] : pose.tower();
}

elements::Pose<double> body_pose(const TurbinePose& pose, int body) {
  switch (body) {
    case top_on_nacelle:
      return {pose.top(), pose.nacelle_axes()};
    case bearing_on_nacelle:
      return {pose.bearing(), pose.nacelle_axes()};
    case bearing_on_shaft:
      return {pose.bearing(), pose.shaft_axes()};
    case pin_on_shaft:
      return {pose.pin(), pose.shaft_axes()};
    case pin_on_hub:
      return {pose.pin(), pose.hub_axes()};
    default:
      return {pose.apex(), pose.hub_axes()};
  }
}

Twist body_twist(const TurbinePose& pose, const BodyTwists& twists, int body) {
  switch (body) {
    case top_on_nacelle:
      return twists.nacelle;
    case bearing_on_nacelle:
      return twists.nacelle.at(pose.bearing() - pose.top());
    case bearing_on_shaft:
      return twists.shaft;
    case pin_on_shaft:
      return twists.shaft.at(pose.pin() - pose.bearing());
    case pin_on_hub:
      return twists.hub;
    default:
      return twists.hub.at(pose.apex() - pose.pin());
  }
}

/// True if unknowns beside those of hinges turn the blades about their pitch axes.
bool pitch_moves(const model::Turbine& turbine) {
  return turbine.pitch_actuator || (turbine.controller && turbine.controller->pitch);
}

/// The change of each blade's pitch by actuators and the controller, for a change of the state.
Eigen::VectorXd pitch_change(const TurbineEquations& equations, double t,
                             const Eigen::VectorXd& steady, const Eigen::VectorXd& change) {
  constexpr double step = 1e-30;
  std::vector<std::complex<double>> z(static_cast<std::size_t>(steady.size()));
  for (std::size_t i = 0; i < z.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    z[i] = {steady(at), step * change(at)};
  }
  const std::vector<std::complex<double>> rates(z.size());
  const auto pitch = equations.report<std::complex<double>>(t, z, rates, {}).pitch;
  Eigen::VectorXd changes(static_cast<Eigen::Index>(pitch.size()));
  for (std::size_t k = 0; k < pitch.size(); ++k)
    changes(static_cast<Eigen::Index>(k)) = pitch[k].imag() / step;
  return changes;
}

}  // namespace

std::vector<elements::Pose<double>> TurbineGeometry::poses(double t,
                                                           const Eigen::VectorXd& z) const {
  const TurbinePose pose(system_.equations(), t, z);
  std::vector<elements::Pose<double>> poses;
  int body = 0;
  for (const Place& place : places_) {
    if (place.beam < 0) {
      const elements::Pose<double> own = body_pose(pose, body++);
      poses.push_back({ground_of(own.place), body_axes(own.axes)});
      continue;
    }
    const BeamPose& beam = beam_of(pose, place.beam);
    const bool is_fixed = place.node < 0;
    const auto node = static_cast<std::size_t>(std::max(place.node, 0));
    const Vector3& at = is_fixed ? beam.base : beam.nodes[node].place;
    const Matrix3& axes = is_fixed ? beam.base_axes : beam.nodes[node].axes;
    poses.push_back({ground_of(at), ground_axes(axes * place.section)});
  }
  return poses;
}

TurbineGeometry::Motions::Motions(const TurbineGeometry& geometry, double t,
                                  const Eigen::VectorXd& steady)
    : geometry_(geometry),
      t_(t),
      steady_(steady),
      pose_(std::make_unique<TurbinePose>(geometry.system_.equations(), t, steady)) {}

TurbineGeometry::Motions::Motions(Motions&&) noexcept = default;
TurbineGeometry::Motions::~Motions() = default;

Eigen::MatrixXcd TurbineGeometry::Motions::of(const Eigen::Ref<const Eigen::VectorXcd>& z) const {
  const TurbineEquations& equations = geometry_.system_.equations();
  const std::size_t blades = pose_->blades().size();
  const BodyTwists bodies = pose_->body_twists(z);
  std::vector<Twist> bases;
  for (std::size_t k = 0; k < blades; ++k) bases.push_back(pose_->base_twist(k, bodies.hub, z));
  if (pitch_moves(equations.turbine())) {
    const Eigen::VectorXd re = pitch_change(equations, t_, steady_, z.real());
    const Eigen::VectorXd im = pitch_change(equations, t_, steady_, z.imag());
    for (std::size_t k = 0; k < blades; ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      bases[k] = bases[k] + pose_->pitch(k) * std::complex<double>(re(at), im(at));
    }
  }
  bases.emplace_back();  // of the tower
  Eigen::MatrixXcd motions(6, static_cast<Eigen::Index>(geometry_.nodes_.size()));
  int body = 0;
  for (std::size_t i = 0; i < geometry_.places_.size(); ++i) {
    const Place& place = geometry_.places_[i];
    Twist twist;
    if (place.beam < 0) {
      twist = body_twist(*pose_, bodies, body++);
    } else {
      const BeamPose& beam = beam_of(*pose_, place.beam);
      const Twist& base = bases[static_cast<std::size_t>(place.beam)];
      if (place.node < 0) {
        twist = base;
      } else {
        const NodePose& node = beam.nodes[static_cast<std::size_t>(place.node)];
        twist = node.twist_of(z) + base.at(node.place - beam.base);
      }
    }
    motions.col(static_cast<Eigen::Index>(i)) << ground_of(twist.translation),
        ground_of(twist.rotation);
  }
  return motions;
}

}  // namespace samara::turbine
