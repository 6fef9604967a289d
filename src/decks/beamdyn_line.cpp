#include "beamdyn_line.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/QR>

#include "samara/math/quadrature.hpp"
#include "samara/math/spline.hpp"

#include "import_common.hpp"

namespace samara::decks {
namespace {

constexpr int most_degree = 6;

/// Relative to the length of the line through the key points.
constexpr double longest_line = 1.5;

/// Largest distance of a straight line from its axis [of its length].
constexpr double straight_tolerance = 1e-9;

/// Largest distance between the polynomials and the spline of the case [of the length].
constexpr double line_tolerance = 1e-7;

/// The same in the quarter of a member beside a kink, which the spline rounds off.
constexpr double kink_tolerance = 1e-5;
constexpr int least_intervals = 8;
constexpr int most_intervals = 128;

/// Largest difference between the twist and the straight line from station to station [deg].
constexpr double twist_tolerance = 2e-3;
constexpr int most_halvings = 8;

/// The same of BeamDyn's stations over the arc [of the length].
constexpr double station_tolerance = 1e-5;

constexpr int arc_points = 16;
constexpr double same_place = 1e-9;

/// P_0 to P_{n-1} and their derivatives.
void legendre(double x, Eigen::Index n, Eigen::VectorXd& p, Eigen::VectorXd& slope) {
  p = Eigen::VectorXd::Zero(n);
  slope = Eigen::VectorXd::Zero(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto d = static_cast<double>(k);
    p(k) = k == 0 ? 1.0 : k == 1 ? x : ((2.0 * d - 1.0) * x * p(k - 1) - (d - 1.0) * p(k - 2)) / d;
    if (k > 0) slope(k) = d * p(k - 1) + x * slope(k - 1);
  }
}

Eigen::Vector4d values_of(const KeyPoint& point) {
  return {point.position(0), point.position(1), point.position(2), point.twist_deg};
}

}  // namespace

Eigen::Vector4d BeamdynLine::Member::chord(double xi) const {
  return 0.5 * ((1.0 - xi) * first + (1.0 + xi) * last);
}

Eigen::Vector4d BeamdynLine::Member::value(double xi) const {
  Eigen::VectorXd p, slope;
  legendre(xi, series.rows(), p, slope);
  return chord(xi) + (1.0 - xi * xi) * series.transpose() * p;
}

Vector3 BeamdynLine::Member::slope(double xi) const {
  Eigen::VectorXd p, slope;
  legendre(xi, series.rows(), p, slope);
  const Eigen::VectorXd bubble = (1.0 - xi * xi) * slope - 2.0 * xi * p;
  return 0.5 * (last - first).head<3>() + series.leftCols<3>().transpose() * bubble;
}

double BeamdynLine::Member::arc_to(double xi) const {
  static const math::QuadratureRule rule = math::gauss_rule(arc_points);
  double sum = 0.0;
  for (std::size_t i = 0; i < rule.points.size(); ++i)
    sum += rule.weights[i] * (xi + 1.0) * slope((xi + 1.0) * rule.points[i] - 1.0).norm();
  return sum;
}

BeamdynLine::BeamdynLine(const std::vector<KeyPoint>& points, const std::vector<int>& members,
                         int order) {
  std::size_t start = 0;
  double across = 0.0;
  for (const int count : members) {
    const KeyPoint& front = points[start];
    const KeyPoint& back = points[start + static_cast<std::size_t>(count) - 1];
    Member member;
    member.first = values_of(front);
    member.last = values_of(back);
    const int degree = std::min({order, count - 1, most_degree});
    const auto terms = static_cast<Eigen::Index>(std::max(0, degree - 1));
    member.series.setZero(terms, 4);
    if (terms > 0) {
      Eigen::MatrixXd matrix(count, terms);
      Eigen::Matrix<double, Eigen::Dynamic, 4> rest(count, 4);
      for (int i = 0; i < count; ++i) {
        const KeyPoint& point = points[start + static_cast<std::size_t>(i)];
        const double rise = point.position(2) - front.position(2);
        const double xi = 2.0 * rise / (back.position(2) - front.position(2)) - 1.0;
        Eigen::VectorXd p, slope;
        legendre(xi, terms, p, slope);
        matrix.row(i) = (1.0 - xi * xi) * p.transpose();
        rest.row(i) = (values_of(point) - member.chord(xi)).transpose();
      }
      rest.col(2).setZero();  // z is xi itself
      member.series = matrix.colPivHouseholderQr().solve(rest);
    }
    member.arc = length_;
    member.length = member.arc_to(1.0);
    length_ += member.length;
    for (int i = 0; i < count; ++i) {
      const Vector3& position = points[start + static_cast<std::size_t>(i)].position;
      across = std::max(across, std::hypot(position(0), position(1)));
    }
    members_.push_back(std::move(member));
    start += static_cast<std::size_t>(count) - 1;
  }
  double chords = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    chords += (points[i].position - points[i - 1].position).norm();
  swings_out_ = !(length_ <= longest_line * chords);
  if (swings_out_) return;
  for (Member& member : members_) member.station = member.arc / length_;
  is_straight_ = across <= straight_tolerance * members_.back().last(2);
  if (is_straight_) {  // exactly
    length_ = members_.back().last(2);
    points_ = {Vector3::Zero(), Vector3(length_, 0.0, 0.0)};
    for (Member& member : members_) {
      member.arc = member.first(2);
      member.length = member.last(2) - member.first(2);
      member.station = member.arc / length_;
    }
    return;
  }
  for (int count = least_intervals; !sample(count) && count < most_intervals;) count *= 2;
  model::BeamDefinition definition;
  definition.reference_line = points_;
  definition.length = model::compute_arc_length(points_);
  case_line_.emplace("blades", definition);
}

/// Fills the points; true where their spline follows the line.
bool BeamdynLine::sample(int count) {
  points_ = {Vector3::Zero()};
  const std::vector<double> nodes = math::lobatto_nodes(count);
  for (const Member& member : members_)
    for (std::size_t i = 1; i < nodes.size(); ++i)
      points_.push_back(
          turn_to_section_axes(Vector3(member.value(2.0 * nodes[i] - 1.0).head<3>())));
  const math::NaturalSpline spline(points_);
  for (const Member& member : members_)
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      const double xi = nodes[i - 1] + nodes[i] - 1.0;
      const double part = (member.arc + member.arc_to(xi)) / length_;
      const Vector3 there = turn_to_section_axes(Vector3(member.value(xi).head<3>()));
      const std::size_t quarter = nodes.size() / 4;
      const bool is_at_kink = (i <= quarter && &member != &members_.front()) ||
                              (i + quarter >= nodes.size() && &member != &members_.back());
      const double limit = (is_at_kink ? kink_tolerance : line_tolerance) * length_;
      if ((spline.at(part * spline.length()).position - there).norm() > limit) return false;
    }
  return true;
}

/// BeamDyn's x axis has no component along y of the root before the twist turns it about the
/// tangent; that of a case follows from the root's by the smallest rotation.
double BeamdynLine::case_twist(const Member& member, double xi, double arc) const {
  const double twist = member.value(xi)(3);
  if (is_straight_) return twist;
  const Vector3 tangent = member.slope(xi).normalized();
  const Vector3 x =
      turn_to_section_axes(Vector3(Vector3(tangent(2), 0.0, -tangent(0)).normalized()));
  const Matrix3 axes = case_line_->at(arc).C_ab;
  const double turn = std::atan2(-x.dot(axes.col(1)), x.dot(axes.col(2)));  // about +b1
  return twist - turn * 180.0 / std::numbers::pi;
}

BeamdynLine::Place BeamdynLine::place(const Member& member, double xi) const {
  Place result;
  result.station = member.station + 0.5 * (xi + 1.0) * member.length / length_;
  result.arc = is_straight_ ? result.station : (member.arc + member.arc_to(xi)) / length_;
  result.twist_deg = case_twist(member, xi, result.arc);
  return result;
}

/// Adds the places needed between the last place, at xi, and `end`.
void BeamdynLine::refine(const Member& member, double xi, const Place& end, double xi_end,
                         int depth, std::vector<Place>& places) const {
  if (depth == 0) return;
  const Place begin = places.back();
  const double xi_middle = 0.5 * (xi + xi_end);
  const auto is_linear_at = [&](const Place& there) {
    const double part = (there.arc - begin.arc) / (end.arc - begin.arc);
    const double linear = begin.twist_deg + part * (end.twist_deg - begin.twist_deg);
    const double station = begin.station + part * (end.station - begin.station);
    return std::abs(there.twist_deg - linear) <= twist_tolerance &&
           std::abs(there.station - station) <= station_tolerance;
  };
  const Place middle = place(member, xi_middle);
  if (is_linear_at(middle) && is_linear_at(place(member, 0.5 * (xi + xi_middle))) &&
      is_linear_at(place(member, 0.5 * (xi_middle + xi_end))))
    return;
  refine(member, xi, middle, xi_middle, depth - 1, places);
  places.push_back(middle);
  refine(member, xi_middle, end, xi_end, depth - 1, places);
}

std::vector<BeamdynLine::Place> BeamdynLine::places(const std::vector<double>& stations) const {
  std::vector<Place> places;
  for (const Member& member : members_) {
    const double share = member.length / length_;
    std::vector<double> grid{-1.0};
    for (const double station : stations) {
      const double xi = 2.0 * (station - member.station) / share - 1.0;
      if (xi > grid.back() + same_place && xi < 1.0 - same_place) grid.push_back(xi);
    }
    grid.push_back(1.0);
    Place first = place(member, -1.0);
    const bool is_first = places.empty();
    if (is_first || std::abs(first.twist_deg - places.back().twist_deg) > twist_tolerance) {
      first.jumps = !is_first;
      places.push_back(first);
    }
    for (std::size_t i = 1; i < grid.size(); ++i) {
      const Place end = place(member, grid[i]);
      refine(member, grid[i - 1], end, grid[i], most_halvings, places);
      places.push_back(end);
    }
  }
  return places;
}

}  // namespace samara::decks
