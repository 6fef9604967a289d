// The verdict, of modes whose exponents and errors are given here.
#include "samara/simulation/stability.hpp"

#include <complex>
#include <vector>

#include <boost/test/unit_test.hpp>

using namespace samara;
using namespace samara::simulation;

namespace {

analysis::Mode mode(std::complex<double> exponent, double error = 1e-6) {
  analysis::Mode result;
  result.exponent = exponent;
  result.damping_ratio = -exponent.real() / std::abs(exponent);
  result.mesh_error = error;
  result.growth_error = error * std::abs(exponent);
  result.mesh_growth_error = result.growth_error;
  return result;
}

analysis::ModeSet set_of(const std::vector<std::complex<double>>& exponents) {
  analysis::ModeSet set;
  for (const std::complex<double>& exponent : exponents) set.modes.push_back(mode(exponent));
  set.rotor_speed = 1.0;
  return set;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(stability)

BOOST_AUTO_TEST_CASE(all_decay) {
  const StabilityAssessment result = assess_stability(set_of({{-0.1, 2.0}, {-0.2, 20.0}}));
  BOOST_TEST((result.stability == Stability::stable));
  BOOST_TEST((result.doubt == Doubt::none));
  BOOST_TEST(result.decaying.size() == 2U);
  BOOST_TEST(*result.least_damped == 1U);  // 1 % is less than 5 %
}

BOOST_AUTO_TEST_CASE(the_fastest_growth_stands_first) {
  const StabilityAssessment result =
      assess_stability(set_of({{0.1, 2.0}, {-0.2, 3.0}, {0.3, 4.0}}));
  BOOST_TEST((result.stability == Stability::unstable));
  BOOST_TEST(result.growing == (std::vector<std::size_t>{2, 0}), boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(rates_below_their_error_are_none) {
  analysis::ModeSet set = set_of({{-0.1, 2.0}, {1e-7, 3.0}, {0.0, 0.0}});
  const StabilityAssessment result = assess_stability(set);
  BOOST_TEST((result.stability == Stability::neutral));
  BOOST_TEST(result.undamped == 1);
  BOOST_TEST(result.rigid_body == 1);
  BOOST_TEST((result.motions ==
              std::vector<Motion>{Motion::decaying, Motion::undamped, Motion::rigid_body}));
}

BOOST_AUTO_TEST_CASE(rough_modes_do_not_count) {
  analysis::ModeSet set = set_of({{-0.1, 2.0}});
  set.modes.push_back(mode({0.2, 30.0}, 0.2));
  StabilityAssessment result = assess_stability(set);
  BOOST_TEST((result.stability == Stability::stable));
  BOOST_TEST(result.rough == 1);
  BOOST_TEST(result.accurate_reach == std::abs(set.modes[1].exponent));
  set.modes.erase(set.modes.begin());
  result = assess_stability(set);
  BOOST_TEST((result.stability == Stability::unknown));
  BOOST_TEST((result.doubt == Doubt::rough));
}

BOOST_AUTO_TEST_CASE(a_growing_mode_with_a_large_error_allows_no_verdict) {
  analysis::ModeSet set = set_of({{-0.1, 2.0}, {0.05, 3.0}});
  set.modes[1].mesh_error = 0.5;
  const StabilityAssessment result = assess_stability(set);
  BOOST_TEST((result.stability == Stability::unknown));
  BOOST_TEST((result.doubt == Doubt::may_grow));
  BOOST_TEST(result.may_grow == std::vector<std::size_t>{1}, boost::test_tools::per_element());
  // Undamped motions have growths of the size of round-off, below their errors.
  set.modes[1].exponent.real(1e-4);
  set.modes[1].growth_error = 1e-3;
  BOOST_TEST((assess_stability(set).stability == Stability::stable));
  set.modes[1].growth_error = 0.8e-4;
  BOOST_TEST((assess_stability(set).doubt == Doubt::may_grow));
  // One that grows beyond doubt is enough.
  set = set_of({{0.1, 2.0}, {0.05, 3.0}});
  set.modes[1].mesh_error = 0.5;
  BOOST_TEST((assess_stability(set).stability == Stability::unstable));
}

BOOST_AUTO_TEST_CASE(half_of_the_slowest_modes_in_a_medium_count) {
  analysis::ModeSet set;
  for (int i = 0; i < 12; ++i) set.modes.push_back(mode({-0.1, 1.0 + i}, i < 5 ? 0.2 : 1e-6));
  set.medium_states = 1;
  BOOST_TEST((assess_stability(set).stability == Stability::stable));
  set.modes[5].mesh_error = 0.2;
  const StabilityAssessment result = assess_stability(set);
  BOOST_TEST((result.doubt == Doubt::rough));
  BOOST_TEST(result.first == 10);
  BOOST_TEST(result.first_rough == 6);
  set.medium_states = 0;
  BOOST_TEST((assess_stability(set).stability == Stability::stable));
}

BOOST_AUTO_TEST_CASE(exponents_of_a_medium_say_nothing_about_the_others) {
  analysis::ModeSet set;
  set.modes.push_back(mode({-0.1, 2.0}, 0.2));
  for (int i = 0; i < 20; ++i) {
    set.modes.push_back(mode({-0.5, 0.0}));
    set.modes.back().state.emplace().kind = system::PartKind::medium;
  }
  set.medium_states = 20;
  BOOST_TEST((assess_stability(set).doubt == Doubt::rough));
}

BOOST_AUTO_TEST_CASE(one_mode_that_grows_suffices) {
  analysis::ModeSet set = set_of({{0.1, 2.0}, {-0.1, 30.0}});
  set.modes[1].resolved = false;
  set.reach = 10.0;
  BOOST_TEST((assess_stability(set).stability == Stability::unstable));
  set.modes[0].exponent.real(-0.1);
  BOOST_TEST((assess_stability(set).doubt == Doubt::unresolved));
}

BOOST_AUTO_TEST_CASE(a_real_exponent_with_a_large_error_is_none_at_rest) {
  analysis::ModeSet set = set_of({{-0.1, 2.0}, {0.01, 0.0}});
  set.modes[1].mesh_growth_error = 0.0;
  set.modes[1].growth_error = 0.015;
  BOOST_TEST((assess_stability(set).motions[1] == Motion::rigid_body));
  set.modes[1].growth_error = 0.1;
  BOOST_TEST((assess_stability(set).motions[1] != Motion::rigid_body));
  BOOST_TEST((assess_stability(set).doubt == Doubt::may_grow));
}

BOOST_AUTO_TEST_CASE(the_first_ten_must_be_resolved) {
  analysis::ModeSet set;
  for (int i = 0; i < 10; ++i) set.modes.push_back(mode({-0.1, 1.0 + i}));
  set.modes.push_back(mode({1.0, 50.0}));
  set.modes.back().resolved = false;
  set.reach = 10.5;
  BOOST_TEST((assess_stability(set).stability == Stability::stable));
  BOOST_TEST(assess_stability(set).unresolved == 1);
  set.reach = 9.5;  // the tenth is beyond
  BOOST_TEST((assess_stability(set).doubt == Doubt::unresolved));
  set.deflated = 2;  // a pair of exponents that decay is one mode more
  BOOST_TEST((assess_stability(set).stability == Stability::stable));
}

BOOST_AUTO_TEST_CASE(a_conservative_system_grows_in_pairs) {
  analysis::ModeSet set = set_of({{0.1, 2.0}, {0.0, 3.0}});
  set.conservative = true;
  BOOST_TEST((assess_stability(set).doubt == Doubt::growing_alone));
  set.modes.push_back(mode({-0.1, 3.0}));  // the same modulo the rotor speed
  const StabilityAssessment result = assess_stability(set);
  BOOST_TEST((result.stability == Stability::unstable));
  BOOST_TEST(result.growing_alone.empty());
}

BOOST_AUTO_TEST_SUITE_END()
