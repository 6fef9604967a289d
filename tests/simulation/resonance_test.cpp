// Bands of instability between the points of a sweep.
#include "samara/simulation/resonance.hpp"

#include <cmath>
#include <limits>

#include <boost/test/unit_test.hpp>

namespace {

using namespace samara;
using simulation::CampbellLine;
using simulation::CampbellMode;
using simulation::CampbellPoint;
using simulation::Resonance;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double decay = 0.002;  // relative to the rotor speed
constexpr double growth = 0.005;

/// A blade mode that stiffens with the speed x, a tower mode, and a mode of strong damping.
double blade(double x) { return std::sqrt(2.0 + 0.3 * x * x); }
constexpr double tower = 1.1;

CampbellMode mode(double rate, double frequency, double fixed_frame) {
  CampbellMode result;
  result.exponent = {rate, frequency};
  result.fixed_frame_frequency = fixed_frame;
  result.motion = rate > 0.0 ? simulation::Motion::growing : simulation::Motion::decaying;
  return result;
}

/// The blade mode grows where blade + tower is next to `order` times the speed.
CampbellPoint point_at(double x, int order, double half_width) {
  CampbellPoint point;
  point.place.value = x;
  point.rotor_speed = x;
  const double distance = std::abs(blade(x) + tower - order * x) / x;
  const double rate = distance < half_width ? growth : -decay;
  point.modes = {mode(rate * x, blade(x), nan), mode(-decay * x, tower, tower),
                 mode(-5.0 * x, 1.7 * x, 1.7 * x)};
  return point;
}

struct Sweep {
  std::vector<CampbellPoint> points;
  std::vector<CampbellLine> lines;
};

Sweep sweep_of(const std::vector<double>& places, int order, double half_width) {
  Sweep sweep;
  for (const double x : places) sweep.points.push_back(point_at(x, order, half_width));
  for (std::size_t m = 0; m < 3; ++m) {
    CampbellLine line;
    for (std::size_t p = 0; p < places.size(); ++p) line.modes.push_back({p, m});
    sweep.lines.push_back(line);
  }
  return sweep;
}

/// Where blade + tower = order x, by bisection.
double crossing(int order, double low, double high) {
  const auto f = [order](double x) { return blade(x) + tower - order * x; };
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    ((f(low) > 0.0) == (f(middle) > 0.0) ? low : high) = middle;
  }
  return low;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(resonance)

BOOST_AUTO_TEST_CASE(narrow_bands_are_found) {
  for (const int order : {1, 2, 3}) {
    const std::vector<double> places =
        order == 1 ? std::vector<double>{3.0, 4.0} : std::vector<double>{0.7, 1.2, 2.0, 3.0};
    const double place = crossing(order, places.front(), places.back());
    const Sweep sweep = sweep_of(places, order, 3e-4);
    int found = 0;
    for (const Resonance& resonance : simulation::find_resonances(sweep.points, sweep.lines)) {
      BOOST_TEST(resonance.priority < 0.1);  // without the third mode
      const auto band =
          simulation::find_band(resonance, [&](double x) { return point_at(x, order, 3e-4); });
      if (!band) continue;
      ++found;
      BOOST_TEST(*band == place, boost::test_tools::tolerance(1e-3));
    }
    BOOST_TEST(found == 1);
  }
}

BOOST_AUTO_TEST_CASE(crossings_without_a_band_end) {
  const Sweep sweep = sweep_of({0.9, 1.2, 2.0, 3.0}, 2, 0.0);
  const auto resonances = simulation::find_resonances(sweep.points, sweep.lines);
  BOOST_TEST(!resonances.empty());
  for (const Resonance& resonance : resonances) {
    int points = 0;
    const auto band = simulation::find_band(resonance, [&](double x) {
      ++points;
      BOOST_TEST((resonance.from.place < x && x < resonance.to.place));
      return point_at(x, 2, 0.0);
    });
    BOOST_TEST(!band);
    BOOST_TEST(points <= 5);
  }
}

/// With three identical blades only multiples of 3 count, of frequencies in the fixed frame.
BOOST_AUTO_TEST_CASE(identical_blades_meet_at_fewer_places) {
  Sweep sweep = sweep_of({0.5, 0.7, 0.9, 1.2}, 2, 0.0);
  for (CampbellPoint& point : sweep.points) point.sectors = 3;
  for (const Resonance& resonance : simulation::find_resonances(sweep.points, sweep.lines)) {
    BOOST_TEST(resonance.multiple % 3 == 0);
    BOOST_TEST(resonance.from.one.imag() == tower);  // the blade mode has none
    BOOST_TEST(resonance.from.place < 2.0 * tower / 3.0);
    BOOST_TEST(2.0 * tower / 3.0 < resonance.to.place);
  }
  BOOST_TEST(simulation::find_resonances(sweep.points, sweep.lines).size() == 1U);
  // A blade that differs breaks the symmetry.
  sweep.points.back().sectors = sweep.points[2].sectors = 1;
  BOOST_TEST(simulation::find_resonances(sweep.points, sweep.lines).size() > 1U);
}

BOOST_AUTO_TEST_CASE(points_that_differ_have_edges_instead) {
  Sweep sweep = sweep_of({2.0, 3.0}, 2, 0.0);
  sweep.points.back().modes[1].motion = simulation::Motion::growing;
  BOOST_TEST(simulation::find_resonances(sweep.points, sweep.lines).empty());
  sweep = sweep_of({2.0, 3.0}, 2, 0.0);
  sweep.points.back().failure = "no steady state";
  BOOST_TEST(simulation::find_resonances(sweep.points, sweep.lines).empty());
}

BOOST_AUTO_TEST_SUITE_END()
