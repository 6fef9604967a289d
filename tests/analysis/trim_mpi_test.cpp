// The steady state of a mesh that is distributed over ranks: every rank also solves it alone.
#include <cmath>
#include <string>

#include <boost/test/unit_test.hpp>

#include "samara/analysis/trim.hpp"
#include "samara/base/error.hpp"
#include "samara/turbine/turbine_system.hpp"

#include "distributed.hpp"

using namespace samara;
using namespace samara::test;

namespace {

/// Relative to the largest coefficient of the same quantity. Both solutions have a residual of
/// 1e-10.
constexpr double same = 1e-9;

void require_same(const model::TurbineDefinition& definition, const analysis::TrimOptions& options,
                  bool is_distributed) {
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::Trim alone = analysis::find_trim(system, options, observer);
  const analysis::Trim together = analysis::find_trim(system, options, observer, PETSC_COMM_WORLD);
  const std::string words = "mesh on " + std::to_string(ranks()) + " ranks";
  const bool says_so = together.linear_solver.find(words) != std::string::npos;
  BOOST_TEST(on_all_ranks(says_so == (is_distributed && ranks() > 1)));
  BOOST_TEST(alone.linear_solver.find("mesh on") == std::string::npos);
  for (const system::UnknownRole role :
       {system::UnknownRole::position, system::UnknownRole::velocity,
        system::UnknownRole::internal})
    BOOST_TEST(on_all_ranks(difference(system, alone.solution.coefficients(),
                                       together.solution.coefficients(), role) < same));
  BOOST_TEST_REQUIRE(together.held.size() == alone.held.size());
  for (std::size_t i = 0; i < alone.held.size(); ++i)
    BOOST_TEST(on_all_ranks(std::abs(together.held[i].load - alone.held[i].load) <
                            same * alone.load_level));
  BOOST_TEST(
      on_all_ranks(std::abs(together.load_level - alone.load_level) < same * alone.load_level));
  for (const auto residual : {&analysis::Trim::residual, &analysis::Trim::residual_between,
                              &analysis::Trim::harmonic_residual})
    BOOST_TEST(
        on_all_ranks(std::abs(together.*residual - alone.*residual) < same * alone.load_level));
}

analysis::TrimOptions with_harmonics(int count) {
  analysis::TrimOptions options;
  options.automatic = false;
  options.harmonics = count;
  // One rank may take a step more than several: it has one of the blades in the place of all.
  options.tolerance = 1e-12;
  return options;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(trim)

// A tower, a free yaw that a load holds, a teeter hinge and two blades: the border is in the
// middle.
BOOST_AUTO_TEST_CASE(a_distributed_turbine_has_the_steady_state_of_one_rank) {
  require_same(lee_turbine({120, 1, 200, 1}, 9.81), with_harmonics(4), true);
}

// Some ranks have no piece: 3 ranks, and chains of 250 nodes.
BOOST_AUTO_TEST_CASE(more_ranks_than_pieces) {
  require_same(single_blade(250), with_harmonics(3), true);
}

BOOST_AUTO_TEST_CASE(elements_of_high_order_are_cut_as_well) {
  require_same(lee_turbine({20, 4, 30, 5}, 9.81), with_harmonics(2), true);
}

BOOST_AUTO_TEST_CASE(small_meshes_are_not_distributed) {
  require_same(lee_turbine({4, 1, 6, 2}, 9.81), with_harmonics(3), false);
}

// Loads that turn a blade by more than 170 degrees: one rank finds it, all ranks end.
BOOST_AUTO_TEST_CASE(a_failure_of_one_rank_ends_all) {
  model::TurbineDefinition definition = single_blade(220);
  definition.shaft.speed = 0.1;
  definition.blades.beam.sections = {stiff_section(1e2)};
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  analysis::Observer observer;
  bool has_failed = false;
  try {
    analysis::find_trim(system, with_harmonics(1), observer, PETSC_COMM_WORLD);
  } catch (const ConvergenceError&) {
    has_failed = true;
  } catch (const DomainError&) {
    has_failed = true;
  }
  BOOST_TEST(on_all_ranks(has_failed));
}

BOOST_AUTO_TEST_SUITE_END()
