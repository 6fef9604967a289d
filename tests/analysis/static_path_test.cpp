// Loads that grow: equilibrium at every step, limit points, and what is said where the path ends.
#include "samara/analysis/static_path.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"

#include "small_systems.hpp"

namespace {

using namespace samara;
using analysis::StaticMethod;
using analysis::StaticOptions;
using analysis::StaticPath;

/// Newton's last correction is 1e-9 of the solution or less, and the error it leaves its square.
constexpr double equilibrium_tolerance = 1e-12;

StaticPath follow(const system::PeriodicSystem& system, const StaticOptions& options) {
  analysis::Observer observer;
  return analysis::find_static_path(system, options, observer);
}

template <class Error>
std::string words_of(const system::PeriodicSystem& system, const StaticOptions& options) {
  try {
    follow(system, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The number behind "load factor ".
double factor_in(const std::string& words) {
  const std::string before = "load factor ";
  const std::size_t place = words.find(before);
  BOOST_TEST_REQUIRE(place != std::string::npos);
  return std::stod(words.substr(place + before.size()));
}

/// The root of k w (w - h) (w - 2 h) = 1 beyond 2 h.
double far_root() {
  double w = 2.5;
  const test::ShallowTruss truss(1.0);
  for (int i = 0; i < 50; ++i) w -= (truss.force(w) - 1.0) / truss.stiffness(w);
  return w;
}

const double limit_load = test::ShallowTruss::k * 2.0 / (3.0 * std::sqrt(3.0));

}  // namespace

BOOST_AUTO_TEST_SUITE(static_path)

BOOST_AUTO_TEST_CASE(factors_are_prescribed_from_0_to_1) {
  const test::ShallowTruss truss(0.5 * limit_load);
  const StaticPath path = follow(truss, {StaticMethod::load, 5, 1e-9, 1000});
  BOOST_TEST_REQUIRE(path.states.size() == 6u);
  BOOST_TEST(path.cuts == 0);
  BOOST_TEST(path.limit_points.empty());
  for (std::size_t i = 0; i < path.states.size(); ++i) {
    const analysis::StaticState& state = path.states[i];
    BOOST_TEST(std::abs(state.factor - 0.2 * static_cast<double>(i)) < 1e-15);
    const double load = state.factor * 0.5 * limit_load;
    BOOST_TEST(std::abs(truss.force(state.z(1)) - load) < equilibrium_tolerance);
    BOOST_TEST(std::abs(state.z(0) - load) < equilibrium_tolerance);
    BOOST_TEST(state.residual < equilibrium_tolerance);
    BOOST_TEST(state.z(1) < 1.0 - 1.0 / std::sqrt(3.0));  // the first branch
  }
  BOOST_TEST(path.load_level == 0.5 * limit_load);
}

BOOST_AUTO_TEST_CASE(states_stand_where_they_do_not_change) {
  constexpr double load = 3.0;
  const test::LaggingSupport system(load);
  for (const StaticMethod method : {StaticMethod::load, StaticMethod::arc_length}) {
    const StaticPath path = follow(system, {method, 4, 1e-9, 1000});
    BOOST_TEST(path.states.back().factor == 1.0);
    for (const analysis::StaticState& state : path.states) {
      const double x = test::LaggingSupport::state_under(state.factor * load);
      const double w = x + test::LaggingSupport::h * x * x * x;
      BOOST_TEST(std::abs(state.z(2) - x) < 1e-9 * std::max(x, 1e-3));
      BOOST_TEST(std::abs(state.z(1) - w) < 1e-9 * std::max(w, 1e-3));
      BOOST_TEST(std::abs(state.z(0) - test::LaggingSupport::k * w) < 1e-9);
    }
  }
}

BOOST_AUTO_TEST_CASE(arc_length_passes_both_limit_points_to_the_far_branch) {
  const test::ShallowTruss truss(1.0);
  for (const int steps : {5, 10, 40}) {
    const StaticPath path = follow(truss, {StaticMethod::arc_length, steps, 1e-9, 1000});
    double before = -1.0;
    double largest = 0.0;
    double smallest = 0.0;
    for (const analysis::StaticState& state : path.states) {
      BOOST_TEST(std::abs(truss.force(state.z(1)) - state.factor) < equilibrium_tolerance);
      BOOST_TEST(state.z(1) > before);  // every branch in its turn: nothing is jumped over
      before = state.z(1);
      if (state.z(1) < 1.5) largest = std::max(largest, state.factor);
      smallest = std::min(smallest, state.factor);
    }
    BOOST_TEST(path.states.back().factor == 1.0);
    BOOST_TEST(std::abs(path.states.back().z(1) - far_root()) < 1e-12);
    BOOST_TEST_REQUIRE(path.limit_points.size() == 2u);
    BOOST_TEST(path.limit_points[0] == largest);
    BOOST_TEST(path.limit_points[1] == smallest);
    // A state beside the limit is at most half a step from it, where the path is a parabola.
    const double part = 10.0 / steps;
    BOOST_TEST(std::abs(largest - limit_load) < 0.06 * part * part);
    BOOST_TEST(std::abs(smallest + limit_load) < 0.06 * part * part);
    BOOST_TEST(largest <= limit_load);
    BOOST_TEST(smallest >= -limit_load);
  }
}

BOOST_AUTO_TEST_CASE(arc_length_ends_at_the_whole_loads_where_there_is_no_limit_point) {
  const test::ShallowTruss truss(0.9 * limit_load);
  const StaticPath by_arc = follow(truss, {StaticMethod::arc_length, 10, 1e-9, 1000});
  const StaticPath by_load = follow(truss, {StaticMethod::load, 10, 1e-9, 1000});
  BOOST_TEST(by_arc.states.back().factor == 1.0);
  BOOST_TEST((by_arc.states.back().z - by_load.states.back().z).norm() < 1e-12);
  BOOST_TEST(by_arc.limit_points.empty());
}

BOOST_AUTO_TEST_CASE(where_the_load_can_rise_no_more_the_factor_reached_is_named) {
  const test::SofteningSpring spring(1.0, 1e9);
  const std::string words =
      words_of<ConvergenceError>(spring, {StaticMethod::load, 10, 1e-9, 1000});
  BOOST_TEST(std::abs(factor_in(words) - 0.25) < 1e-3);
  BOOST_TEST(factor_in(words) <= 0.25 + 1e-9);
  BOOST_TEST(words.find("hint: ") != std::string::npos);
  BOOST_TEST(words.find("arc_length") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_path_that_never_reaches_the_loads_is_given_up) {
  const test::SofteningSpring spring(1.0, 1e9);
  const std::string words =
      words_of<ConvergenceError>(spring, {StaticMethod::arc_length, 10, 1e-9, 60});
  BOOST_TEST(words.find("60 steps (static.max_steps)") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(what_leaves_its_range_is_named_with_the_factor_reached) {
  for (const StaticMethod method : {StaticMethod::load, StaticMethod::arc_length}) {
    const test::SofteningSpring spring(0.25, 0.4);
    const std::string words = words_of<DomainError>(spring, {method, 10, 1e-9, 1000});
    BOOST_TEST(std::abs(factor_in(words) - (0.4 - 0.16) / 0.25) < 1e-5);
    BOOST_TEST(words.find("the spring: too long") != std::string::npos);
  }
}

BOOST_AUTO_TEST_CASE(without_loads_nothing_moves) {
  for (const StaticMethod method : {StaticMethod::load, StaticMethod::arc_length}) {
    const StaticPath path = follow(test::ShallowTruss(0.0), {method, 2, 1e-9, 1000});
    BOOST_TEST(path.states.back().factor == 1.0);
    BOOST_TEST(path.states.back().z.norm() == 0.0);
  }
}

BOOST_AUTO_TEST_CASE(systems_that_know_no_loads_or_turn_are_refused) {
  BOOST_CHECK_THROW(follow(test::Duffing(), {}), InputError);
  BOOST_CHECK_THROW(follow(test::Mathieu(1.0, 1.0), {}), InputError);
}

BOOST_AUTO_TEST_SUITE_END()
