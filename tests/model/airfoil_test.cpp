#include "samara/model/airfoil.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <boost/test/unit_test.hpp>

namespace {

using namespace samara;
using elements::AirfoilCurves;
using elements::attached_angle;
using elements::inviscid_lift;
using model::AirfoilDefinition;
using model::PolarDefinition;
using std::numbers::pi;

constexpr double degree = pi / 180.0;
constexpr double round_off = 1e-13;

// A polar of Kirchhoff's kind: Cl = slope S(alpha - zero) k(|alpha - zero|), with k = 1 up to 12
// degrees, linear from there to 1/4 at 24 degrees, and zero from 28 degrees on.
constexpr double zero_lift = -4.0 * degree;
constexpr double lift_slope = 6.5;

double attached_share(double y) {
  return std::clamp(1.0 - 0.75 / 12.0 * (std::abs(y) / degree - 12.0), 0.0, 1.0);
}

double kirchhoff_lift(double angle) {
  const double y = std::remainder(angle - zero_lift, 2.0 * pi);
  return lift_slope * attached_angle(y).value * attached_share(y);
}

template <class Lift>
PolarDefinition polar_of(const Lift& lift, const std::vector<double>& angles) {
  PolarDefinition polar;
  polar.angles = angles;
  for (const double angle : angles) {
    polar.lift.push_back(lift(angle));
    polar.drag.push_back(0.01 + std::pow(std::sin(angle), 2));
    polar.moment.push_back(-0.2 * std::sin(angle));
  }
  polar.lift.back() = polar.lift.front();
  polar.moment.back() = polar.moment.front();
  return polar;
}

PolarDefinition kirchhoff_polar() { return polar_of(kirchhoff_lift, model::polar_grid()); }

PolarDefinition constant_polar(double reynolds, double lift) {
  return {reynolds, {-pi, 0.0, pi}, {lift, lift, lift}, {0.1, 0.1, 0.1}, {0.0, 0.0, 0.0}};
}

/// Polars of a file: rows of three or four numbers. With `NumAlf` a table begins, of so many rows.
std::vector<PolarDefinition> read_polars(const std::filesystem::path& file) {
  std::vector<PolarDefinition> polars;
  std::ifstream in(file);
  bool is_table = file.extension() == ".txt";
  if (is_table) polars.emplace_back();
  for (std::string line; std::getline(in, line);) {
    if (line.find("NumAlf") != std::string::npos) {
      is_table = true;
      polars.emplace_back();
    } else if (line.find("Re ") != std::string::npos && line.find('!') != std::string::npos) {
      is_table = is_table && file.extension() == ".txt";
    }
    std::istringstream row(line);
    double angle = 0.0;
    double lift = 0.0;
    double drag = 0.0;
    double moment = 0.0;
    if (!is_table || !(row >> angle >> lift >> drag)) continue;
    row >> moment;
    polars.back().angles.push_back(angle * degree);
    polars.back().lift.push_back(lift);
    polars.back().drag.push_back(drag);
    polars.back().moment.push_back(moment);
  }
  return polars;
}

/// The separation point before it is smoothed: at each point of the grid by Kirchhoff's formula
/// from the zero of the lift outward, zero from the first zero on.
std::vector<double> kirchhoff_points(const PolarDefinition& polar, const AirfoilCurves& curves) {
  const double d = curves.lift_slope * 1.5 * degree;
  const auto f_of = [&](std::size_t i) {
    const double lift = inviscid_lift(curves, polar.angles[i]);
    const double q = (polar.lift[i] * lift + d * d) / (lift * lift + d * d);
    return std::min(1.0, std::pow(2.0 * std::sqrt(std::max(q, 0.25)) - 1.0, 2));
  };
  std::vector<double> f(polar.angles.size(), 0.0);
  std::size_t start = 0;
  while (polar.angles[start] < curves.zero_lift) ++start;
  for (std::size_t i = start; i < f.size() && f_of(i) > 0.0; ++i) f[i] = f_of(i);
  for (std::size_t i = start; i-- > 0 && f_of(i) > 0.0;) f[i] = f_of(i);
  return f;
}

/// Angles of the grid [degrees] next to the zero of the lift at which that point is zero. The
/// smoothed one is zero from the next point on.
std::pair<double, double> separated_outside(const PolarDefinition& polar,
                                            const AirfoilCurves& curves) {
  const std::vector<double> f = kirchhoff_points(polar, curves);
  std::pair<double, double> outside{-180.0, 180.0};
  std::size_t last = f.size();
  for (std::size_t i = 0; i < f.size(); ++i) {
    if (f[i] > 0.0) continue;
    if (polar.angles[i] > curves.zero_lift) {
      outside.second = polar.angles[i] / degree;
      if (i + 1 < f.size()) BOOST_TEST(curves.separation.at(polar.angles[i + 1]).value < 1e-14);
      break;
    }
    outside.first = polar.angles[i] / degree;
    last = i;
  }
  if (last != f.size() && last > 0)
    BOOST_TEST(curves.separation.at(polar.angles[last - 1]).value < 1e-14);
  return outside;
}

/// The lift of attached flow at the grid and its regularization: d^2/(Cinv^2 + d^2).
struct Attached {
  double lift = 0.0;
  double regular = 0.0;
};
Attached attached_at(const AirfoilCurves& curves, double angle) {
  const double d = curves.lift_slope * 1.5 * degree;
  const double lift = inviscid_lift(curves, angle);
  return {lift, d * d / (lift * lift + d * d)};
}

/// f Cinv + (1 - f) Cl_fs = Cl + (f - f_st) dC with the lift of separated flow
/// Cl_fs = (Cl - f_st Cinv)/(1 - f_st), at all points of the grid where Kirchhoff's formula holds.
/// Both sides differ by the regularization of q, d^2/(Cinv^2 + d^2) of Cinv - Cl, times
/// (f - f_st)/(1 - f_st).
void check_identity(const PolarDefinition& polar, const AirfoilCurves& curves) {
  int points = 0;
  const std::vector<double> separation = kirchhoff_points(polar, curves);
  for (std::size_t i = 1; i + 1 < polar.angles.size(); ++i) {
    const double angle = polar.angles[i];
    const double lift = polar.lift[i];
    const double steady = separation[i];
    BOOST_TEST(std::abs(curves.separation.at(angle).value - steady) < 0.05);
    const auto [attached, regular] = attached_at(curves, angle);
    const double missing = attached - lift;
    if (steady > 0.999 || missing * attached < 0.0) continue;
    ++points;
    const double separated = (lift - steady * attached) / (1.0 - steady);
    for (const double f : {0.0, 0.3, 0.7, 1.0}) {
      const double mixed = f * attached + (1.0 - f) * separated;
      const double by_deficit = lift + (f - steady) * curves.deficit.at(angle).value;
      const double allowed = std::abs((f - steady) / (1.0 - steady) * missing) * regular;
      BOOST_TEST(std::abs(mixed - by_deficit) <= allowed + 1e-11);
    }
  }
  BOOST_TEST(points > 200);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(airfoil)

BOOST_AUTO_TEST_CASE(the_angle_of_attached_flow_is_exact_to_63_degrees_odd_and_periodic) {
  for (double y = -1.1; y <= 1.1; y += 0.05) {
    BOOST_TEST(attached_angle(y).value == y);
    BOOST_TEST(attached_angle(y).slope == 1.0);
  }
  for (double y = 0.0; y <= pi; y += 0.05) {
    BOOST_TEST(attached_angle(-y).value == -attached_angle(y).value);
    BOOST_TEST(std::abs(attached_angle(y + 2.0 * pi).value - attached_angle(y).value) < round_off);
  }
  BOOST_TEST(std::abs(attached_angle(pi).value) < round_off);
  // Half way between 1.1 and pi the step is 1/2.
  const double middle = 0.5 * (1.1 + pi);
  BOOST_TEST(std::abs(attached_angle(middle).value - 0.5 * middle) < round_off);
  constexpr double step = 1e-6;
  for (const double seam : {1.1, -1.1, pi, -pi}) {
    const double jump = attached_angle(seam + step).slope - 2.0 * attached_angle(seam).slope +
                        attached_angle(seam - step).slope;
    BOOST_TEST(std::abs(jump) < 1e-4 * step);  // the third derivative is less than 100
  }
  for (double y = -4.0; y < 4.0; y += 0.3) {
    const double difference =
        (attached_angle(y + step).value - attached_angle(y - step).value) / (2.0 * step);
    BOOST_TEST(std::abs(attached_angle(y).slope - difference) < 1e-8);
  }
}

BOOST_AUTO_TEST_CASE(the_grid_is_fine_where_flow_is_attached) {
  const std::vector<double>& grid = model::polar_grid();
  BOOST_TEST(grid.size() == 541U);
  BOOST_TEST(grid.front() == -pi);
  BOOST_TEST(grid.back() == pi);
  for (std::size_t i = 0; i + 1 < grid.size(); ++i) {
    const bool is_fine = std::abs(grid[i] + grid[i + 1]) < 2.0 * 30.0 * degree;
    BOOST_TEST(std::abs(grid[i + 1] - grid[i] - (is_fine ? 0.25 : 1.0) * degree) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(polars_reach_the_grid_by_lines_and_their_ends_by_the_mean) {
  PolarDefinition polar{0.0,
                        {-3.14, -0.5, 0.1, 3.1405},
                        {0.02, -1.0, 0.5, -0.01},
                        {0.1, 0.2, 0.3, 0.1},
                        {0.0, 0.0, 0.0, 0.0}};
  const PolarDefinition grid = model::on_grid(polar);
  for (std::size_t i = 1; i + 1 < grid.angles.size(); ++i) {
    const double x = grid.angles[i];
    double expected = -1.0 + (x + 0.5) / 0.6 * 1.5;
    if (x < -0.5) expected = x < -3.14 ? 0.02 : 0.02 - 1.02 * (x + 3.14) / 2.64;
    if (x > 0.1) expected = 0.5 - 0.51 * (std::min(x, 3.1405) - 0.1) / 3.0405;
    BOOST_TEST(std::abs(grid.lift[i] - expected) < round_off);
  }
  BOOST_TEST(std::abs(grid.lift.front() - 0.005) < round_off);
  BOOST_TEST(grid.lift.front() == grid.lift.back());
  BOOST_TEST((model::on_grid(grid) == grid));
}

BOOST_AUTO_TEST_CASE(zero_slope_and_separation_of_a_kirchhoff_polar_are_those_it_was_made_with) {
  const PolarDefinition polar = kirchhoff_polar();
  const AirfoilCurves curves = model::make_curves(polar);
  BOOST_TEST(curves.has_dynamics);
  BOOST_TEST(std::abs(curves.zero_lift - zero_lift) < 1e-9);  // the spline is not the line
  BOOST_TEST(std::abs(curves.lift_slope - lift_slope) < 1e-6);
  // q = (k Cinv^2 + d^2)/(Cinv^2 + d^2) is 1/4 where k = 1/4 - 3/4 (1.5/y)^2: at y = 24.047
  // degrees, that is at -28.047 and 20.047 degrees. f_st is zero at the next point of the grid.
  const auto [before, behind] = separated_outside(polar, curves);
  BOOST_TEST(std::abs(before + 28.25) < 1e-9);
  BOOST_TEST(std::abs(behind - 20.25) < 1e-9);
  const auto f_at = [&](double angle) {
    const double y = std::abs(angle - zero_lift) / degree;
    const double k = attached_share(angle - zero_lift);
    const double q = (k * y * y + 1.5 * 1.5) / (y * y + 1.5 * 1.5);
    return y < 24.1 ? std::pow(2.0 * std::sqrt(std::max(q, 0.25)) - 1.0, 2) : 0.0;
  };
  const double step = 0.25 * degree;
  for (const double angle : model::polar_grid()) {
    if (std::abs(angle) > 29.6 * degree) continue;  // equal distances on both sides
    const double f = (f_at(angle - step) + 4.0 * f_at(angle) + f_at(angle + step)) / 6.0;
    BOOST_TEST(std::abs(curves.separation.at(angle).value - f) < 1e-6);
    BOOST_TEST(std::abs(curves.separation.at(angle).value - f_at(angle)) < 6e-3);  // at the kink
  }
}

BOOST_AUTO_TEST_CASE(the_lift_is_a_mixture_of_attached_and_separated_flow) {
  const PolarDefinition polar = kirchhoff_polar();
  check_identity(polar, model::make_curves(polar));
}

BOOST_AUTO_TEST_CASE(the_deficit_has_the_values_of_its_formula) {
  const PolarDefinition polar = kirchhoff_polar();
  const AirfoilCurves curves = model::make_curves(polar);
  const std::vector<double> separation = kirchhoff_points(polar, curves);
  for (std::size_t i = 0; i < polar.angles.size(); ++i) {
    const double angle = polar.angles[i];
    const auto [attached, regular] = attached_at(curves, angle);
    const double q = (1.0 - regular) * (attached == 0.0 ? 1.0 : polar.lift[i] / attached) + regular;
    const double root = std::sqrt(q);
    const double expected =
        separation[i] > 0.0 ? attached * (1.0 + root) / (4.0 * root) : attached * (1.0 - q);
    BOOST_TEST(std::abs(curves.deficit.at(angle).value - expected) < 1e-12);
  }
  BOOST_TEST(std::abs(curves.deficit.at(curves.zero_lift).value) < 1e-4);
}

BOOST_AUTO_TEST_CASE(the_steady_state_gives_the_steady_polar) {
  const PolarDefinition polar = kirchhoff_polar();
  const AirfoilCurves curves = model::make_curves(polar);
  for (std::size_t i = 0; i < polar.angles.size(); ++i) {
    BOOST_TEST(std::abs(curves.lift_at(polar.angles[i]) - polar.lift[i]) < round_off);
    BOOST_TEST(std::abs(curves.drag_at(polar.angles[i]) - polar.drag[i]) < round_off);
    BOOST_TEST(std::abs(curves.moment_at(polar.angles[i]) - polar.moment[i]) < round_off);
  }
  for (double angle = -10.0; angle < 10.0; angle += 0.1) {
    const double f = curves.separation_at(angle);
    BOOST_TEST((f >= 0.0 && f <= 1.0 + round_off));
    BOOST_TEST(std::abs(curves.lift_at(angle) - curves.lift_at(angle + 2.0 * pi)) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(the_separation_point_is_constant_beyond_half_a_revolution) {
  // A flat plate without stall: attached at both ends.
  const PolarDefinition plate =
      polar_of([](double angle) { return 2.0 * pi * std::sin(angle); }, model::polar_grid());
  const AirfoilCurves curves = model::make_curves(plate);
  BOOST_TEST(curves.zero_lift == 0.0);
  // Least squares of sin(y)/y = 1 - y^2/6 over -2 to 7 degrees.
  BOOST_TEST(std::abs(curves.lift_slope / (2.0 * pi) - 1.0) < 0.0025);
  BOOST_TEST(curves.separation_at(pi) > 0.9);
  BOOST_TEST(curves.separation_at(pi) == curves.separation_at(4.5));
  BOOST_TEST(curves.separation_at(-pi) == curves.separation_at(-100.0));
  BOOST_TEST(curves.separation.at(4.5).slope == 0.0);
}

BOOST_AUTO_TEST_CASE(slopes_agree_for_all_scalars) {
  const AirfoilCurves curves = model::make_curves(kirchhoff_polar());
  constexpr double tiny = 1e-30;
  constexpr double step = 1e-6;
  const auto check = [&](const auto& f) {
    for (const double x : {-3.0, -0.41, -0.06, 0.02, 0.13, 0.33, 1.3, 2.9, 3.3}) {
      const math::Dual<1> dual = f(math::independent<1>(x, 0));
      const double slope = dual.derivatives()(0);
      BOOST_TEST(dual.value() == f(x));
      BOOST_TEST(std::abs(f(std::complex<double>(x, tiny)).imag() / tiny - slope) < 1e-12);
      BOOST_TEST(std::abs((f(x + step) - f(x - step)) / (2.0 * step) - slope) < 1e-5);
    }
    BOOST_TEST(f(math::Dependence::on(2)).quantities() == 4U);
  };
  check([&](const auto& x) { return curves.lift_at(x); });
  check([&](const auto& x) { return curves.drag_at(x); });
  check([&](const auto& x) { return curves.moment_at(x); });
  check([&](const auto& x) { return curves.deficit_at(x); });
  check([&](const auto& x) { return curves.separation_at(x); });
  check([&](const auto& x) { return inviscid_lift(curves, x); });
}

BOOST_AUTO_TEST_CASE(cylinders_have_no_dynamics) {
  const PolarDefinition cylinder = constant_polar(0.0, 0.0);
  const AirfoilCurves curves = model::make_curves(model::on_grid(cylinder));
  BOOST_TEST(!curves.has_dynamics);
  BOOST_TEST(curves.drag_at(0.7) == 0.1);
  BOOST_TEST(curves.deficit_at(0.7) == 0.0);
  BOOST_TEST(curves.separation_at(0.7) == 0.0);
  BOOST_TEST(model::find_polar_notes(cylinder).empty());
  const auto weak = [](double angle) { return 0.9 * std::sin(angle); };
  const PolarDefinition slow = polar_of(weak, model::polar_grid());
  BOOST_TEST(!model::make_curves(slow).has_dynamics);
  BOOST_TEST(model::make_curves(slow, 1.5).has_dynamics);
  BOOST_TEST(!model::make_curves(kirchhoff_polar(), 0.0).has_dynamics);
  BOOST_TEST(model::find_polar_notes(slow).size() == 1U);
}

BOOST_AUTO_TEST_CASE(a_given_slope_replaces_that_of_the_polar) {
  const AirfoilCurves curves = model::make_curves(kirchhoff_polar(), 7.0);
  BOOST_TEST(curves.lift_slope == 7.0);
  BOOST_TEST(std::abs(inviscid_lift(curves, curves.zero_lift + 0.1) - 0.7) < round_off);
  check_identity(kirchhoff_polar(), curves);
}

BOOST_AUTO_TEST_CASE(airfoils_are_blended_linearly_and_slopes_with_them) {
  AirfoilDefinition a;
  a.polars = {kirchhoff_polar()};
  AirfoilDefinition b;
  b.polars = {constant_polar(0.0, 0.0)};
  const AirfoilCurves half = model::make_curves(a, b, 0.5, 1e6);
  for (const double angle : {-3.0, -0.2, 0.0, 0.1, 2.0}) {
    BOOST_TEST(std::abs(half.lift_at(angle) - 0.5 * kirchhoff_lift(angle)) < 1e-3);
    BOOST_TEST(std::abs(half.drag_at(angle) - 0.055 - 0.5 * std::pow(std::sin(angle), 2)) < 1e-5);
  }
  BOOST_TEST(std::abs(half.lift_slope - 0.5 * lift_slope) < 1e-6);
  a.lift_slope = 7.0;
  BOOST_TEST(model::make_curves(a, b, 0.0, 1e6).lift_slope == 7.0);
  BOOST_TEST(std::abs(model::make_curves(a, b, 0.25, 1e6).lift_slope - 5.25) < round_off);
  BOOST_TEST(!model::make_curves(a, b, 0.9, 1e6).has_dynamics);
  BOOST_TEST(!model::make_curves(a, b, 1.0, 1e6).has_dynamics);
}

BOOST_AUTO_TEST_CASE(polars_are_interpolated_in_the_logarithm_of_the_reynolds_number) {
  AirfoilDefinition airfoil;
  airfoil.polars = {constant_polar(1e6, 3.0), constant_polar(0.0, 9.0), constant_polar(1e4, 1.0),
                    constant_polar(1e6, 8.0)};
  const auto lift = [&](double reynolds) { return model::polar_at(airfoil, reynolds).lift[100]; };
  for (const double reynolds : {-1.0, 0.0, 1.0, 1e4}) BOOST_TEST(lift(reynolds) == 1.0);
  BOOST_TEST(std::abs(lift(1e5) - 2.0) < round_off);
  BOOST_TEST(std::abs(lift(1e4 * std::sqrt(10.0)) - 1.5) < round_off);
  for (const double reynolds : {1e6, 1.1e6, 1e9}) BOOST_TEST(lift(reynolds) == 3.0);
  airfoil.polars = {constant_polar(0.0, 9.0), constant_polar(0.0, 4.0)};
  BOOST_TEST(lift(1e6) == 9.0);
}

BOOST_AUTO_TEST_CASE(faults_of_polars_are_named) {
  const auto fault = [](const auto& change) {
    PolarDefinition polar = constant_polar(1e6, 0.5);
    change(polar);
    return model::find_polar_fault(polar);
  };
  const auto has = [](const std::string& text, const std::string& part) {
    BOOST_TEST_INFO(text);
    BOOST_TEST(text.find(part) != std::string::npos);
  };
  constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
  BOOST_TEST(fault([](PolarDefinition&) {}).empty());
  has(fault([](PolarDefinition& p) { p.angles[1] = 4.0; }), "the angles do not rise");
  has(fault([](PolarDefinition& p) { p.angles[1] = p.angles[0]; }), "the angles do not rise");
  has(fault([](PolarDefinition& p) { p.angles[0] = -3.0; }), "do not span -180 to 180 degrees");
  has(fault([](PolarDefinition& p) { p.angles[2] = 6.0; }), "do not span -180 to 180 degrees");
  has(fault([](PolarDefinition& p) { p.lift[0] = 0.6; }), "lift coefficients at -180 and 180");
  has(fault([](PolarDefinition& p) { p.moment[2] = -0.06; }), "moment coefficients at -180");
  has(fault([=](PolarDefinition& p) { p.drag[1] = no_number; }), "a drag coefficient is not");
  has(fault([=](PolarDefinition& p) { p.angles[1] = no_number; }), "an angle is not");
  has(fault([](PolarDefinition& p) { p.drag.pop_back(); }), "3 angles and 2 drag coefficients");
  has(fault([](PolarDefinition& p) { p.reynolds = -1.0; }), "the Reynolds number");
  has(fault([](PolarDefinition& p) { p = {}; }), "at least two angles");
  BOOST_TEST(fault([](PolarDefinition& p) { p.lift[0] = 0.54; }).empty());
  BOOST_TEST(fault([](PolarDefinition& p) { p.angles[0] = -3.14; }).empty());
  BOOST_TEST(fault([](PolarDefinition& p) { p.drag[1] = -0.02; }).empty());
}

BOOST_AUTO_TEST_CASE(remarks_name_unequal_ends_negative_drag_and_splines_that_swing_out) {
  PolarDefinition polar = kirchhoff_polar();
  BOOST_TEST(model::find_polar_notes(polar).empty());
  polar.moment.back() += 0.01;
  polar.drag[300] = -0.02;
  polar.lift[150] += 1.0;  // a spike
  const std::vector<std::string> notes = model::find_polar_notes(polar);
  const auto has = [&notes](const std::string& part) {
    return std::ranges::any_of(
        notes, [&](const std::string& note) { return note.find(part) != std::string::npos; });
  };
  BOOST_TEST(has("the moment coefficients at -180 and 180 degrees"));
  BOOST_TEST(has("the drag coefficient is negative, -0.02 at 7.5 degrees"));
  BOOST_TEST(has("the spline of the lift coefficient leaves"));
}

BOOST_AUTO_TEST_CASE(airfoils_of_the_nrel_5_mw_turbine_have_known_zeros_slopes_and_separation) {
  struct Gate {
    const char* name;
    double zero, slope, before, behind;  // degrees, but for the slope
  };
  // Computed by a separate program from the same tables (aerodynamic specification, section 3).
  const std::vector<Gate> gates{
      {"DU21_A17", -4.12, 7.209, -32.00, 28.25}, {"NACA64_A17", -3.84, 6.590, -34.00, 29.50},
      {"DU25_A17", -3.37, 7.488, -31.00, 30.00}, {"DU30_A17", -2.12, 7.651, -27.75, 36.00},
      {"DU35_A17", -1.37, 7.942, -23.75, 43.00}, {"DU40_A17", -3.08, 4.660, -46.00, 61.00}};
  const std::filesystem::path folder =
      std::filesystem::path(SAMARA_SOURCE_DIR) / "inputs/nrel5mw/airfoils";
  for (const Gate& gate : gates) {
    BOOST_TEST_CONTEXT(gate.name) {
      const auto polars = read_polars(folder / (std::string(gate.name) + ".txt"));
      BOOST_REQUIRE(polars.size() == 1U);
      BOOST_REQUIRE(model::find_polar_fault(polars[0]).empty());
      BOOST_TEST(model::find_polar_notes(polars[0]).empty());
      const PolarDefinition grid = model::on_grid(polars[0]);
      const AirfoilCurves curves = model::make_curves(grid);
      BOOST_TEST(std::abs(curves.zero_lift / degree - gate.zero) < 0.0051);  // printed digits
      BOOST_TEST(std::abs(curves.lift_slope - gate.slope) < 0.00051);
      const auto [before, behind] = separated_outside(grid, curves);
      BOOST_TEST(std::abs(before - gate.before) < 1e-9);
      BOOST_TEST(std::abs(behind - gate.behind) < 1e-9);
      check_identity(grid, curves);
    }
  }
  for (const char* name : {"Cylinder1.txt", "Cylinder2.txt"})
    BOOST_TEST(!model::make_curves(model::on_grid(read_polars(folder / name).at(0))).has_dynamics);
}

BOOST_AUTO_TEST_CASE(polars_of_public_decks_have_no_faults) {
  const char* folder = std::getenv("SAMARA_PUBLIC_DECKS");
  if (folder == nullptr) {
    BOOST_TEST_MESSAGE("skipped: SAMARA_PUBLIC_DECKS does not name the folder of public decks");
    return;
  }
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".dat" ||
        entry.path().string().find("Airfoils") == std::string::npos)
      continue;
    for (const PolarDefinition& polar : read_polars(entry.path())) {
      BOOST_TEST_CONTEXT(entry.path().string()) {
        BOOST_REQUIRE(model::find_polar_fault(polar).empty());
        const PolarDefinition grid = model::on_grid(polar);
        const AirfoilCurves curves = model::make_curves(grid);
        for (std::size_t i = 0; i < grid.angles.size(); ++i)
          BOOST_TEST(std::abs(curves.lift_at(grid.angles[i]) - grid.lift[i]) < round_off);
        ++count;
      }
    }
  }
  BOOST_TEST(count > 50);
}

BOOST_AUTO_TEST_SUITE_END()
