// The paper's turbine on several ranks gives the modes that one rank gives.
#include <boost/test/unit_test.hpp>

#include "cases.hpp"

using namespace samara;
using namespace samara::test;

BOOST_AUTO_TEST_CASE(ranks_do_not_change_the_exponents_of_the_baseline) {
  // Every rank also does the whole work alone. 1e-9 relative; the defective multiplier of the free
  // yaw, which round-off moves by its root, 1e-4.
  for (const char* gravity : {"gravity=0", "gravity=9.80665"}) {
    const model::TurbineDefinition definition = lee("baseline", {gravity}).turbine;
    const analysis::ModeSet alone = floquet_of(definition, 500).set;
    const analysis::ModeSet together =
        floquet_of(definition, 500, analysis::FloquetPeriod::automatic, {}, PETSC_COMM_WORLD).set;
    BOOST_REQUIRE(alone.modes.size() == together.modes.size());
    for (std::size_t m = 0; m < alone.modes.size(); ++m) {
      const analysis::Mode& mode = alone.modes[m];
      if (!mode.resolved) continue;
      if (std::abs(mode.exponent) < 1e-5 * alone.rotor_speed) {
        BOOST_TEST(std::abs(together.modes[m].multiplier - 1.0) < 1e-4);
        continue;
      }
      double nearest_one = std::numeric_limits<double>::infinity();
      for (const analysis::Mode& other : together.modes)
        nearest_one = std::min(nearest_one, std::abs(other.exponent - mode.exponent));
      BOOST_TEST(nearest_one < 1e-9 * std::abs(mode.exponent), gravity << " " << mode.label);
      BOOST_TEST(together.modes[m].label == mode.label);
      BOOST_TEST(together.modes[m].harmonic == mode.harmonic, mode.label);
    }
  }
}
