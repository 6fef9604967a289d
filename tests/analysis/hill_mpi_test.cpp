// Hill's method on a mesh that is distributed over ranks: every rank also solves it alone.
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/analysis/constant_modes.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/turbine/turbine_system.hpp"

#include "../../src/analysis/hill_groups.hpp"
#include "../../src/analysis/hill_search.hpp"
#include "distributed.hpp"

using namespace samara;
using namespace samara::test;

namespace {

using Complex = std::complex<double>;
using Groups = std::vector<analysis::HillGroup>;

/// Relative to the exponent or the rotor speed.
constexpr double same = 1e-8;
constexpr int coarse = 1;
constexpr int fine = 3;
constexpr int wanted = 8;

/// The eigenpairs of a search, refined.
struct Found {
  Found(const turbine::TurbineSystem& system, const analysis::PeriodicSolution& solution,
        analysis::HillPencil& search_pencil, analysis::HillPencil& pencil)
      : search(search_pencil) {
    region = search.find(1.5 * pencil.speed(), wanted);
    std::vector<analysis::HillPair> inside;
    for (const analysis::HillPair& pair : region.pairs)
      if (pair.exponent.imag() < region.high && pair.exponent.imag() > region.low &&
          std::abs(pair.exponent) > 0.1 * pencil.speed())
        inside.push_back(pair);
    groups = analysis::groups_of(std::move(inside), pencil.speed());
    const analysis::Ranks alone(MPI_COMM_SELF);
    analysis::HillGroups(system, solution, pencil, alone).refine(groups, 1e-10);
    for (const analysis::HillPair& pair : region.pairs) found.push_back(pair.exponent);
  }

  analysis::HillSearch search;
  analysis::HillRegion region;
  std::vector<Complex> found;
  Groups groups;
};

double distance(Complex exponent, const Groups& groups, double speed) {
  double least = std::numeric_limits<double>::infinity();
  for (const analysis::HillGroup& group : groups)
    for (const analysis::HillPair& pair : group.pairs)
      least = std::min(least, std::abs(pair.exponent - exponent));
  return least / std::max(std::abs(exponent), speed);
}

void require_same(const model::TurbineDefinition& definition) {
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  analysis::Observer observer;
  analysis::TrimOptions options;
  options.automatic = false;
  options.harmonics = 2;
  const analysis::Trim trim = analysis::find_trim(system, options, observer);
  const analysis::MeshPartition mesh(system, {}, true, PETSC_COMM_WORLD);
  BOOST_TEST_REQUIRE(on_all_ranks(mesh.is_distributed() == (ranks() > 1)));
  if (!mesh.is_distributed()) return;
  analysis::HillPencil search_alone(system, trim.solution, coarse);
  analysis::HillPencil refine_alone(system, trim.solution, fine);
  Found alone(system, trim.solution, search_alone, refine_alone);
  analysis::HillPencil search_together(mesh, trim.solution, coarse);
  analysis::HillPencil refine_together(mesh, trim.solution, fine);
  Found together(system, trim.solution, search_together, refine_together);

  const double speed = refine_alone.speed();
  std::size_t count = 0;
  for (const analysis::HillGroup& group : together.groups) {
    BOOST_TEST(on_all_ranks(group.truncated_residual <= 1e-10));
    for (std::size_t i = 0; i < group.pairs.size(); ++i) {
      BOOST_TEST_INFO("exponent " << group.pairs[i].exponent << ", distance "
                                  << distance(group.pairs[i].exponent, alone.groups, speed));
      BOOST_TEST(on_all_ranks(distance(group.pairs[i].exponent, alone.groups, speed) < same));
      ++count;
    }
  }
  BOOST_TEST(on_all_ranks(count >= 4));
  BOOST_TEST(
      on_all_ranks(std::abs(together.region.high - alone.region.high) < 1e-4 * alone.region.high));
  for (const analysis::HillGroup& group : alone.groups)
    for (std::size_t i = 0; i < group.pairs.size(); ++i) {
      const Complex exponent = group.pairs[i].exponent;
      BOOST_TEST(on_all_ranks(distance(exponent, together.groups, speed) < same));
      // The residual in time, to the change of the scales of rows at cuts.
      for (const analysis::HillGroup& other : together.groups)
        for (std::size_t j = 0; j < other.pairs.size(); ++j)
          if (std::abs(other.pairs[j].exponent - exponent) < same * speed &&
              group.pairs.size() == 1 && group.residuals[i] > 1e-8)
            BOOST_TEST(on_all_ranks(std::abs(std::log(other.residuals[j] / group.residuals[i])) <
                                    std::log(2.0)));
    }

  const analysis::Ranks one(MPI_COMM_SELF);
  analysis::HillSearch::Missing missing =
      together.search.count_missing(together.region, together.found, one);
  BOOST_TEST_REQUIRE(on_all_ranks(missing.eigenvalues.has_value()));
  BOOST_TEST(on_all_ranks(*missing.eigenvalues == 0));
  BOOST_TEST(on_all_ranks(missing.contraction < 1.0));
  for (std::size_t i = 0; i < together.found.size(); ++i) {
    const Complex left = together.found[i];
    if (left.imag() > 0.9 * together.region.high || left.imag() < 0.1 * speed) continue;
    std::vector<Complex> others = together.found;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    missing = together.search.count_missing(together.region, others, one);
    BOOST_TEST(on_all_ranks(missing.eigenvalues.value_or(0) != 0));
    break;
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(distributed_hill)

/// A single blade: no sectors, the cut in the middle of a chain.
BOOST_AUTO_TEST_CASE(a_blade_has_the_eigenpairs_of_one_rank) {
  model::TurbineDefinition definition = single_blade(230);
  definition.blades.beam.damping.setConstant(0.002);
  require_same(definition);
}

/// One of two blades and the tower; the border has the yaw, the teeter hinge and the hub.
BOOST_AUTO_TEST_CASE(a_turbine_has_the_eigenpairs_of_one_rank) {
  require_same(lee_turbine({90, 1, 130, 1}, 9.81));
}

BOOST_AUTO_TEST_CASE(three_blades_have_the_eigenpairs_of_one_rank) {
  model::TurbineDefinition definition = lee_turbine({60, 2, 110, 1}, 9.81);
  definition.blades.count = 3;
  definition.hub.teeter.kind = model::JointKind::locked;
  definition.nacelle.yaw.kind = model::JointKind::locked;
  definition.blades.beam.damping.setConstant(0.001);
  require_same(definition);
}

/// The whole analysis at rest, with double zeros of free yaw and teeter.
BOOST_AUTO_TEST_CASE(constant_tangents_have_the_modes_of_one_rank) {
  model::TurbineDefinition definition = lee_turbine({60, 2, 60, 2});
  definition.shaft.speed = 0.0;
  definition.hub.teeter.kind = model::JointKind::locked;
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::Trim trim = analysis::find_trim(system, {}, observer);
  analysis::FloquetOptions options;
  options.modes = 12;
  const auto find = [&](MPI_Comm comm) {
    return analysis::find_constant_modes(system, trim.solution, options, comm, observer);
  };
  const analysis::ModeSet alone = find(PETSC_COMM_SELF);
  const analysis::ModeSet together = find(PETSC_COMM_WORLD);
  BOOST_TEST_REQUIRE(alone.searched.has_value());
  BOOST_TEST_REQUIRE(on_all_ranks(together.searched.has_value()));
  BOOST_TEST(on_all_ranks(together.searched->is_counted));
  BOOST_TEST_REQUIRE(on_all_ranks(together.modes.size() == alone.modes.size()));
  for (std::size_t m = 0; m < alone.modes.size(); ++m) {
    const Complex exponent = alone.modes[m].exponent;
    BOOST_TEST(on_all_ranks(std::abs(together.modes[m].exponent - exponent) <=
                            same * std::max(1.0, std::abs(exponent))));
    BOOST_TEST(on_all_ranks(together.modes[m].label == alone.modes[m].label));
    BOOST_TEST(on_all_ranks(together.modes[m].parts.size() == alone.modes[m].parts.size()));
  }
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  BOOST_TEST(on_all_ranks(together.shapes.size() == (rank == 0 ? together.modes.size() : 0)));
}

BOOST_AUTO_TEST_SUITE_END()
