// The count of exponents by Hill's method where some of those that were found are left out.
#pragma once

#include <complex>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "../../src/analysis/hill_search.hpp"

namespace samara::test {

/// Exponents next to a frequency, and the region that is counted.
struct HillCount {
  HillCount(analysis::HillPencil& pencil, double frequency, double contraction) : search(pencil) {
    region = search.find(frequency, 16);
    region.decay *= 0.8;
    for (const analysis::HillPair& pair : region.pairs) found.push_back(pair.exponent);
    const analysis::HillSearch::Missing none = search.count_missing(region, found, alone);
    BOOST_REQUIRE(none.eigenvalues);
    BOOST_TEST(*none.eigenvalues == 0);
    BOOST_TEST(none.contraction < contraction);
    points = none.points;
  }

  /// The count misses `count` exponents in a row, from a number on, where they are in the region.
  /// @returns how many it misses; both of a pair count in a region that includes the real axis
  int leave_out(std::size_t first, std::size_t count) {
    int expected = 0;
    for (std::size_t j = first; j < first + count; ++j)
      if (found[j].imag() >= region.low && found[j].imag() <= region.high &&
          std::abs(found[j].real()) <= region.decay)
        expected += found[j].imag() > 0.0 && region.low == 0.0 ? 2 : 1;
    std::vector<std::complex<double>> others = found;
    const auto begin = others.begin() + static_cast<std::ptrdiff_t>(first);
    others.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
    const analysis::HillSearch::Missing missing = search.count_missing(region, others, alone);
    BOOST_REQUIRE(missing.eigenvalues);
    BOOST_TEST(*missing.eigenvalues == expected, found[first]);
    return expected;
  }

  analysis::Ranks alone{MPI_COMM_SELF};
  analysis::HillSearch search;
  analysis::HillRegion region;
  std::vector<std::complex<double>> found;
  int points = 0;  ///< of the count with all exponents
};

}  // namespace samara::test
