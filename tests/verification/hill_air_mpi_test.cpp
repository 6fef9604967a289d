// Hill's method for a turbine in wind on a mesh that is distributed over ranks.
#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "../analysis/distributed_hill.hpp"
#include "air_case.hpp"

using namespace samara;
using namespace samara::test;

namespace {

/// With enough elements for a distribution over the ranks.
std::vector<std::string> fine_mesh(const std::string& setting, int order = 1) {
  const int count = (10 + 35 * ranks()) / order;  // a node of a blade has two blocks
  std::string lengths = "1";
  for (int i = 1; i < count; ++i) lengths += ", 1";
  const std::string elements = std::to_string(count);
  return {"blades.elements=" + elements,
          "blades.element_lengths=[" + lengths + "]",
          "blades.order=" + std::to_string(order),
          "tower.elements=" + elements,
          "tower.order=" + std::to_string(order),
          "trim={harmonics: 2}",
          setting};
}

analysis::MeshPartition divided(const turbine::TurbineSystem& system, bool keeps_medium = true) {
  analysis::MeshPartition::Limits limits;
  limits.keeps_medium = keeps_medium;
  return {system, {}, true, PETSC_COMM_WORLD, limits};
}

std::vector<Complex> sorted(std::vector<Complex> exponents) {
  std::ranges::sort(exponents, {}, [](Complex one) { return std::pair(one.real(), one.imag()); });
  return exponents;
}

/// Oye's wake and stall are states of stations.
void require_same(const std::string& setting, int order) {
  Steady turbine(io::read_case(input_path("nrel5mw/land"), fine_mesh(setting, order)));
  const analysis::PeriodicSolution& solution = turbine.trim.solution;
  const analysis::MeshPartition mesh = divided(turbine.system);
  BOOST_TEST_REQUIRE(on_all_ranks(mesh.is_distributed()));
  const int coarse = 1;
  const int fine = 3;
  analysis::HillPencil search_alone(turbine.system, solution, coarse);
  analysis::HillPencil refine_alone(turbine.system, solution, fine);
  Found alone(turbine.system, solution, search_alone, refine_alone);
  analysis::HillPencil search_together(mesh, solution, coarse);
  analysis::HillPencil refine_together(mesh, solution, fine);
  Found together(turbine.system, solution, search_together, refine_together);
  const double speed = refine_alone.speed();
  BOOST_TEST(on_all_ranks(require_same_pairs(together, alone, speed) >= 4));

  const std::vector<Complex> of_one = sorted(search_alone.exponents_of_medium());
  const std::vector<Complex> of_all = sorted(search_together.exponents_of_medium());
  BOOST_TEST_REQUIRE(on_all_ranks(of_one.size() == of_all.size() && of_one.size() > 100));
  for (std::size_t i = 0; i < of_one.size(); ++i)
    BOOST_TEST(on_all_ranks(std::abs(of_one[i].real() - of_all[i].real()) < 1e-6 * speed));

  // Counts, and the contraction of the preconditioner with the air eliminated.
  const analysis::Ranks one(MPI_COMM_SELF);
  analysis::HillRegion region = alone.region;
  region.decay = region.growth = std::min(region.decay, 0.3 * speed);
  std::vector<Complex> found = alone.found;
  for (int left = 0; left < 2; ++left) {
    const analysis::HillSearch::Missing expected = alone.search.count_missing(region, found, one);
    const analysis::HillSearch::Missing missing = together.search.count_missing(region, found, one);
    BOOST_TEST(on_all_ranks(expected.eigenvalues.has_value()));
    BOOST_TEST(on_all_ranks(missing.eigenvalues == expected.eigenvalues));
    BOOST_TEST(on_all_ranks(std::abs(missing.contraction - expected.contraction) < 0.1));
    found.erase(std::ranges::min_element(found, {}, [&](Complex exponent) {
      return std::abs(exponent - Complex(0.0, 2.0 * speed));
    }));
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_rotor_in_wind_has_the_eigenpairs_of_one_rank) {
  if (ranks() > 1) require_same("wind.shear.power=0.2", ranks() == 2 ? 3 : 1);
}

/// Wherever the cut falls within an element, stations stay in the pieces.
BOOST_AUTO_TEST_CASE(meshes_in_wind_are_divided) {
  if (ranks() == 1) return;
  for (const int order : {1, 2, 3, 5})
    for (int more = 0; more < order; ++more) {
      std::vector<std::string> settings = fine_mesh("wind.speed=9", order);
      const int tower = (10 + 35 * ranks()) / order + more;
      settings.push_back("tower.elements=" + std::to_string(tower));
      const io::Case input = io::read_case(input_path("nrel5mw/land"), settings);
      const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
      BOOST_TEST(on_all_ranks(divided(system).is_distributed()), order << " " << more);
    }
}

/// The states of the wake are those of the whole rotor, and stations in all pieces refer to them.
BOOST_AUTO_TEST_CASE(a_wake_of_the_whole_rotor_is_not_divided) {
  const io::Case input =
      io::read_case(input_path("nrel5mw/land"), fine_mesh("aero.inflow=peters_he"));
  const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
  BOOST_TEST(on_all_ranks(divided(system, false).is_distributed() == (ranks() > 1)));
  BOOST_TEST(on_all_ranks(!divided(system).is_distributed()));
}
