#include "samara/model/airfoil.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "samara/base/format.hpp"

namespace samara::model {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double round_off = 1e-9;  // of angles [rad]

/// How far from -pi and pi a polar may end [rad], and the coefficients at its ends may differ.
constexpr double largest_gap = 2e-3;
constexpr double largest_jump = 0.05;
constexpr double least_jump = 1e-6;
/// By which a spline may leave the range of its neighbouring points without a note.
constexpr double largest_excess = 0.02;

constexpr double zero_lift_range = 15.0 * degree;
constexpr double slope_before = 2.0 * degree;  // of the zero of the lift
constexpr double slope_behind = 7.0 * degree;
constexpr double least_slope = 1.0;  // [1/rad]
/// Lift coefficient up to which a section is a cylinder, which needs no airfoil dynamics.
constexpr double lift_of_cylinder = 1e-3;

using Values = std::vector<double>;

struct Coefficient {
  const char* name;
  Values PolarDefinition::*values;
};
constexpr std::array<Coefficient, 3> coefficients{{{"lift", &PolarDefinition::lift},
                                                   {"drag", &PolarDefinition::drag},
                                                   {"moment", &PolarDefinition::moment}}};

std::string in_degrees(double angle) { return general(angle / degree, 5) + " degrees"; }

/// Linear interpolation; constant beyond the ends.
double interpolate(const Values& x, const Values& y, double at) {
  const auto next = std::lower_bound(x.begin(), x.end(), at);
  if (next == x.begin()) return y.front();
  if (next == x.end()) return y.back();
  const auto i = static_cast<std::size_t>(next - x.begin());
  const double weight = (at - x[i - 1]) / (x[i] - x[i - 1]);
  return (1.0 - weight) * y[i - 1] + weight * y[i];
}

/// Zero of the lift with positive slope that is nearest to the angle zero, within 15 degrees.
std::optional<double> find_zero_lift(const math::PeriodicSpline& lift) {
  constexpr int steps = 480;  // per side of the range: eight per interval of the grid
  constexpr int halvings = 60;
  const auto place = [](int i) { return zero_lift_range * i / steps; };
  std::optional<double> nearest;
  for (int i = -steps; i < steps; ++i) {
    double before = place(i);
    double behind = place(i + 1);
    if (!(lift.at(before).value <= 0.0 && lift.at(behind).value > 0.0)) continue;
    for (int k = 0; k < halvings; ++k) {
      const double middle = 0.5 * (before + behind);
      (lift.at(middle).value <= 0.0 ? before : behind) = middle;
    }
    if (lift.at(before).slope > 0.0 && (!nearest || std::abs(before) < std::abs(*nearest)))
      nearest = before;
  }
  return nearest;
}

/// Slope of the line through the zero of the lift with the least squares of differences to the
/// points of the grid from 2 degrees before to 7 degrees behind the zero.
double fit_lift_slope(const PolarDefinition& polar, double zero_lift) {
  double products = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < polar.angles.size(); ++i) {
    const double y = polar.angles[i] - zero_lift;
    if (y < -slope_before - round_off || y > slope_behind + round_off) continue;
    products += y * polar.lift[i];
    squares += y * y;
  }
  return products / squares;
}

/// The lift slope of attached flow; zero where the lift has no zero.
double find_lift_slope(const PolarDefinition& polar) {
  const auto zero = find_zero_lift({polar.angles, polar.lift});
  return zero ? fit_lift_slope(polar, *zero) : 0.0;
}

/// Ratio q of the lift to that of attached flow. The regular form is 1 where both are zero.
Values lift_ratio(const PolarDefinition& polar, const elements::AirfoilCurves& curves) {
  const double d = curves.lift_slope * 1.5 * degree;
  Values q;
  for (std::size_t i = 0; i < polar.angles.size(); ++i) {
    const double attached = elements::inviscid_lift(curves, polar.angles[i]);
    q.push_back((polar.lift[i] * attached + d * d) / (attached * attached + d * d));
  }
  return q;
}

/// The separation point of Kirchhoff's flow, Cl = Cinv ((1 + sqrt f)/2)^2, at the grid: from the
/// zero of the lift outward to the first point without attached flow on each side, and zero from
/// there on.
Values separation_points(const Values& angles, const Values& q, double zero_lift) {
  const auto point = [&q](std::size_t i) {
    const double root = 2.0 * std::sqrt(std::max(q[i], 0.25)) - 1.0;
    return std::min(1.0, root * root);
  };
  const auto start = static_cast<std::size_t>(
      std::lower_bound(angles.begin(), angles.end(), zero_lift) - angles.begin());
  Values f(angles.size(), 0.0);
  for (std::size_t i = start; i < f.size() && point(i) > 0.0; ++i) f[i] = point(i);
  for (std::size_t i = start; i-- > 0 && point(i) > 0.0;) f[i] = point(i);
  return f;
}

/// dC = (Cinv - Cl)/(1 - f) at the grid, without the division. The ends have their mean: only one
/// of the sides may have attached flow there, where Cinv is next to zero.
Values lift_deficits(const elements::AirfoilCurves& curves, const Values& angles, const Values& q,
                     const Values& f) {
  Values deficits;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double root = std::sqrt(std::max(q[i], 0.25));
    const double attached = elements::inviscid_lift(curves, angles[i]);
    deficits.push_back(attached * (f[i] > 0.0 ? (1.0 + root) / (4.0 * root) : 1.0 - q[i]));
  }
  deficits.front() = deficits.back() = 0.5 * (deficits.front() + deficits.back());
  return deficits;
}

/// Where a spline leaves the range of the two points around it farthest.
struct Excess {
  double angle = 0.0;
  double size = 0.0;
};

Excess find_excess(const math::PeriodicSpline& spline, const Values& angles, const Values& values) {
  constexpr int parts = 8;
  Excess worst;
  for (std::size_t i = 0; i + 1 < angles.size(); ++i) {
    const auto [least, largest] = std::minmax(values[i], values[i + 1]);
    for (int k = 1; k < parts; ++k) {
      const double angle = angles[i] + (angles[i + 1] - angles[i]) * k / parts;
      const double value = spline.at(angle).value;
      const double size = std::max(value - largest, least - value);
      if (size > worst.size) worst = {angle, size};
    }
  }
  return worst;
}

std::string find_angle_fault(const Values& angles) {
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (!(angles[i] > angles[i - 1]))
      return "the angles do not rise (" + in_degrees(angles[i - 1]) + ", then " +
             in_degrees(angles[i]) + ")";
  if (std::abs(angles.front() + std::numbers::pi) > largest_gap ||
      std::abs(angles.back() - std::numbers::pi) > largest_gap)
    return "the angles do not span -180 to 180 degrees (" + in_degrees(angles.front()) + " to " +
           in_degrees(angles.back()) + ")";
  return {};
}

bool is_finite(const Values& values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

std::string note_on_dynamics(const PolarDefinition& polar) {
  const double slope = find_lift_slope(polar);
  const auto is_small = [](double lift) { return std::abs(lift) <= lift_of_cylinder; };
  if (slope >= least_slope || std::ranges::all_of(polar.lift, is_small)) return {};
  if (slope == 0.0)
    return "the lift has no zero with positive slope within 15 degrees: no airfoil dynamics";
  return "the slope of the lift, " + general(slope, 3) + ", is less than 1: no airfoil dynamics";
}

}  // namespace

std::string find_polar_fault(const PolarDefinition& polar) {
  if (polar.angles.size() < 2) return "at least two angles are needed";
  if (!is_finite(polar.angles)) return "an angle is not a finite number";
  if (!std::isfinite(polar.reynolds) || polar.reynolds < 0.0)
    return "the Reynolds number is negative or not finite";
  for (const Coefficient& c : coefficients) {
    const Values& values = polar.*c.values;
    if (values.size() != polar.angles.size())
      return "there are " + std::to_string(polar.angles.size()) + " angles and " +
             std::to_string(values.size()) + " " + c.name + " coefficients";
    if (!is_finite(values))
      return std::string("a ") + c.name + " coefficient is not a finite number";
  }
  if (const std::string fault = find_angle_fault(polar.angles); !fault.empty()) return fault;
  for (const Coefficient& c : coefficients) {
    const Values& values = polar.*c.values;
    if (std::abs(values.back() - values.front()) > largest_jump)
      return std::string("the ") + c.name + " coefficients at -180 and 180 degrees differ (" +
             general(values.front(), 4) + ", " + general(values.back(), 4) + ")";
  }
  return {};
}

std::vector<std::string> find_polar_notes(const PolarDefinition& polar) {
  std::vector<std::string> notes;
  const PolarDefinition grid = on_grid(polar);
  for (const Coefficient& c : coefficients) {
    const Values& values = polar.*c.values;
    if (std::abs(values.back() - values.front()) > least_jump)
      notes.push_back(std::string("the ") + c.name + " coefficients at -180 and 180 degrees, " +
                      general(values.front(), 4) + " and " + general(values.back(), 4) +
                      ", are replaced by their mean");
    const Excess excess = find_excess({grid.angles, grid.*c.values}, grid.angles, grid.*c.values);
    if (excess.size > largest_excess)
      notes.push_back(std::string("the spline of the ") + c.name +
                      " coefficient leaves the range of its neighbouring points by " +
                      general(excess.size, 2) + " at " + in_degrees(excess.angle));
  }
  const auto least_drag = std::ranges::min_element(polar.drag);
  if (*least_drag < 0.0)
    notes.push_back(
        "the drag coefficient is negative, " + general(*least_drag, 3) + " at " +
        in_degrees(polar.angles[static_cast<std::size_t>(least_drag - polar.drag.begin())]));
  if (std::string note = note_on_dynamics(grid); !note.empty()) notes.push_back(std::move(note));
  return notes;
}

const std::vector<double>& polar_grid() {
  static const Values angles = [] {
    Values grid;
    for (int quarter = -720; quarter <= 720; quarter += quarter >= -120 && quarter < 120 ? 1 : 4)
      grid.push_back(0.25 * quarter * degree);
    grid.front() = -std::numbers::pi;
    grid.back() = std::numbers::pi;
    return grid;
  }();
  return angles;
}

PolarDefinition on_grid(const PolarDefinition& polar) {
  PolarDefinition grid;
  grid.reynolds = polar.reynolds;
  grid.angles = polar_grid();
  for (const Coefficient& c : coefficients) {
    const Values& values = polar.*c.values;
    Values& result = grid.*c.values;
    for (const double angle : grid.angles)
      result.push_back(interpolate(polar.angles, values, angle));
    result.front() = result.back() = 0.5 * (values.front() + values.back());
  }
  return grid;
}

PolarDefinition blend(const PolarDefinition& a, const PolarDefinition& b, double weight) {
  PolarDefinition sum;
  sum.angles = a.angles;
  for (const Coefficient& c : coefficients)
    for (std::size_t i = 0; i < a.angles.size(); ++i)
      (sum.*c.values).push_back((1.0 - weight) * (a.*c.values)[i] + weight * (b.*c.values)[i]);
  return sum;
}

PolarDefinition polar_at(const AirfoilDefinition& airfoil, double reynolds) {
  std::vector<const PolarDefinition*> polars;
  for (const PolarDefinition& polar : airfoil.polars)
    if (polar.reynolds > 0.0) polars.push_back(&polar);
  if (polars.empty()) return on_grid(airfoil.polars.at(0));
  const auto number = [](const PolarDefinition* polar) { return polar->reynolds; };
  std::ranges::stable_sort(polars, {}, number);
  // The first polar with a larger Reynolds number, or the last polars' number.
  const auto behind = std::ranges::upper_bound(polars, reynolds, {}, number);
  const auto first_of = [&](double r) { return *std::ranges::lower_bound(polars, r, {}, number); };
  if (behind == polars.begin()) return on_grid(*polars.front());
  const PolarDefinition& before = *first_of(number(*(behind - 1)));
  if (behind == polars.end() || before.reynolds == reynolds) return on_grid(before);
  const double weight =
      std::log(reynolds / before.reynolds) / std::log((*behind)->reynolds / before.reynolds);
  PolarDefinition polar = blend(on_grid(before), on_grid(**behind), weight);
  polar.reynolds = reynolds;
  return polar;
}

std::vector<std::pair<double, std::string>> sort_by_thickness(
    const std::map<std::string, AirfoilDefinition>& airfoils) {
  std::vector<std::pair<double, std::string>> sorted;
  for (const auto& [name, airfoil] : airfoils)
    if (airfoil.thickness) sorted.emplace_back(*airfoil.thickness, name);
  std::ranges::sort(sorted);
  return sorted;
}

elements::AirfoilCurves make_curves(const PolarDefinition& polar,
                                    std::optional<double> lift_slope) {
  elements::AirfoilCurves curves;
  curves.lift = {polar.angles, polar.lift};
  curves.drag = {polar.angles, polar.drag};
  curves.moment = {polar.angles, polar.moment};
  const auto zero = find_zero_lift(curves.lift);
  if (!zero) return curves;
  const double slope = lift_slope ? *lift_slope : fit_lift_slope(polar, *zero);
  if (!(slope >= least_slope)) return curves;
  curves.zero_lift = *zero;
  curves.lift_slope = slope;
  curves.has_dynamics = true;
  const Values q = lift_ratio(polar, curves);
  const Values f = separation_points(polar.angles, q, *zero);
  curves.separation = {polar.angles, f};
  curves.deficit = {polar.angles, lift_deficits(curves, polar.angles, q, f)};
  return curves;
}

elements::AirfoilCurves make_curves(const AirfoilDefinition& a, const AirfoilDefinition& b,
                                    double weight, double reynolds) {
  if (weight == 0.0) return make_curves(polar_at(a, reynolds), a.lift_slope);
  if (weight == 1.0) return make_curves(polar_at(b, reynolds), b.lift_slope);
  const PolarDefinition polar_a = polar_at(a, reynolds);
  const PolarDefinition polar_b = polar_at(b, reynolds);
  std::optional<double> slope;
  if (a.lift_slope || b.lift_slope)
    slope = (1.0 - weight) * (a.lift_slope ? *a.lift_slope : find_lift_slope(polar_a)) +
            weight * (b.lift_slope ? *b.lift_slope : find_lift_slope(polar_b));
  return make_curves(blend(polar_a, polar_b, weight), slope);
}

}  // namespace samara::model
