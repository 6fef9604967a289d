// Hill's method on a distributed mesh, against every rank alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "../../src/analysis/hill_groups.hpp"
#include "../../src/analysis/hill_search.hpp"
#include "distributed.hpp"

namespace samara::test {

using Complex = std::complex<double>;
using Groups = std::vector<analysis::HillGroup>;

/// Relative to the exponent or the rotor speed.
constexpr double same = 1e-8;
constexpr int wanted = 8;

/// The eigenpairs of a search, refined.
struct Found {
  Found(const system::PeriodicSystem& system, const analysis::PeriodicSolution& solution,
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

inline double distance(Complex exponent, const Groups& groups, double speed) {
  double least = std::numeric_limits<double>::infinity();
  for (const analysis::HillGroup& group : groups)
    for (const analysis::HillPair& pair : group.pairs)
      least = std::min(least, std::abs(pair.exponent - exponent));
  return least / std::max(std::abs(exponent), speed);
}

/// Both have the same pairs. @returns the number of them
inline int require_same_pairs(const Found& together, const Found& alone, double speed) {
  int count = 0;
  for (const analysis::HillGroup& group : together.groups) {
    BOOST_TEST(on_all_ranks(group.truncated_residual <= 1e-10));
    for (const analysis::HillPair& pair : group.pairs) {
      BOOST_TEST_INFO("exponent " << pair.exponent << ", distance "
                                  << distance(pair.exponent, alone.groups, speed));
      BOOST_TEST(on_all_ranks(distance(pair.exponent, alone.groups, speed) < same));
      ++count;
    }
  }
  for (const analysis::HillGroup& group : alone.groups)
    for (const analysis::HillPair& pair : group.pairs)
      BOOST_TEST(on_all_ranks(distance(pair.exponent, together.groups, speed) < same));
  BOOST_TEST(
      on_all_ranks(std::abs(together.region.high - alone.region.high) < 1e-4 * alone.region.high));
  return count;
}

}  // namespace samara::test
