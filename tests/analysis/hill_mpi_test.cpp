// Hill's method on a mesh that is distributed over ranks: every rank also solves it alone.
#include <cmath>
#include <complex>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/analysis/constant_modes.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/turbine/turbine_system.hpp"

#include "distributed_hill.hpp"

using namespace samara;
using namespace samara::test;

namespace {

constexpr int coarse = 1;
constexpr int fine = 3;

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
  BOOST_TEST(on_all_ranks(require_same_pairs(together, alone, speed) >= 4));
  // The residual in time, to the change of the scales of rows at cuts.
  for (const analysis::HillGroup& group : alone.groups)
    for (const analysis::HillGroup& other : together.groups)
      if (group.pairs.size() == 1 && group.residuals[0] > 1e-8)
        for (std::size_t j = 0; j < other.pairs.size(); ++j)
          if (std::abs(other.pairs[j].exponent - group.pairs[0].exponent) < same * speed)
            BOOST_TEST(on_all_ranks(std::abs(std::log(other.residuals[j] / group.residuals[0])) <
                                    std::log(2.0)));

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
  options.search = analysis::ModeSearch::hill;
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
