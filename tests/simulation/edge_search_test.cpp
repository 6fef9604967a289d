// Edges of instability between two points of a sweep.
#include "samara/simulation/edge_search.hpp"

#include <cmath>
#include <functional>
#include <vector>

#include <boost/test/unit_test.hpp>

namespace {

using namespace samara;
using boost::test_tools::tolerance;
using simulation::CampbellLine;
using simulation::CampbellMode;
using simulation::CampbellPoint;
using simulation::GrowthRange;
using simulation::StabilityEdge;

/// Growth rates of modes over the swept quantity. Each mode has a shape of its own.
using Rates = std::vector<std::function<double(double)>>;

CampbellPoint point_at(double x, const Rates& rates) {
  CampbellPoint point;
  point.place.value = x;
  point.rotor_speed = 1.0;
  point.signatures.rotor_speed = 1.0;
  const auto count = static_cast<Eigen::Index>(rates.size());
  for (Eigen::Index m = 0; m < count; ++m) {
    CampbellMode mode;
    const double rate = rates[static_cast<std::size_t>(m)](x);
    mode.exponent = {rate, 0.37 * static_cast<double>(m + 1)};
    mode.motion = rate > 0.0 ? simulation::Motion::growing : simulation::Motion::decaying;
    point.modes.push_back(mode);
    point.signatures.modes.push_back(static_cast<std::size_t>(m));
    point.signatures.exponents.push_back(mode.exponent);
    Eigen::MatrixXcf shape = Eigen::MatrixXcf::Zero(2 * count, 3);
    shape(2 * m, 1) = {0.8F, 0.0F};
    shape(2 * m + 1, 1) = {0.0F, 0.6F};
    point.signatures.shapes.push_back(shape);
  }
  return point;
}

struct Diagram {
  std::vector<CampbellPoint> points;
  std::vector<CampbellLine> lines;
  std::vector<StabilityEdge> edges;

  Diagram(const std::vector<double>& places, const Rates& rates) {
    analysis::ModeTracker tracker;
    for (const double x : places) {
      tracker.add(points.size(), point_at(x, rates).signatures);
      points.push_back(point_at(x, rates));
    }
    for (const auto& modes : tracker.lines()) lines.push_back({"", modes});
    for (const auto& [first, second] : simulation::find_changes(points, lines))
      for (const StabilityEdge& edge : simulation::find_edges(
               points[first], points[second], [&rates](double x) { return point_at(x, rates); }))
        edges.push_back(edge);
  }

  std::vector<GrowthRange> growth(std::size_t line) const {
    return simulation::find_growth(points, lines[line], edges);
  }
  void require_edge(std::size_t i, double place, int from, int to) const {
    BOOST_TEST_REQUIRE(i < edges.size());
    BOOST_TEST(0.5 * (edges[i].from + edges[i].to) == place, tolerance(1e-4));
    BOOST_TEST(edges[i].growing_from == from);
    BOOST_TEST(edges[i].growing_to == to);
  }
};

/// Grows before, or behind, a place.
std::function<double(double)> before(double place) {
  return [place](double x) { return 0.01 * (place - x); };
}
std::function<double(double)> behind(double place) {
  return [place](double x) { return 0.01 * (x - place); };
}
double decaying(double /*x*/) { return -0.02; }

}  // namespace

BOOST_AUTO_TEST_SUITE(edge_search)

BOOST_AUTO_TEST_CASE(one_mode_ceases_and_another_begins_between_two_points) {
  // One mode grows at both points; none, or both, between them.
  for (const auto& [cease, begin] : {std::pair(1.3, 1.7), {1.7, 1.3}}) {
    const Diagram diagram({1.0, 2.0}, {before(cease), decaying, behind(begin)});
    BOOST_TEST_REQUIRE(diagram.edges.size() == 2U);
    const int between = cease < begin ? 0 : 2;
    diagram.require_edge(0, 1.3, 1, between);
    diagram.require_edge(1, 1.7, between, 1);
    const auto first = diagram.growth(0);
    BOOST_TEST_REQUIRE(first.size() == 1U);
    BOOST_TEST(first[0].from == 1.0);
    BOOST_TEST(first[0].to == cease, tolerance(1e-4));
    const auto last = diagram.growth(2);
    BOOST_TEST_REQUIRE(last.size() == 1U);
    BOOST_TEST(last[0].from == begin, tolerance(1e-4));
    BOOST_TEST(last[0].to == 2.0);
    BOOST_TEST(diagram.growth(1).empty());
  }
}

BOOST_AUTO_TEST_CASE(modes_that_begin_at_two_places_have_two_edges) {
  const Diagram diagram({1.0, 2.0, 3.0}, {behind(1.72), behind(1.3), before(2.2)});
  BOOST_TEST_REQUIRE(diagram.edges.size() == 3U);
  diagram.require_edge(0, 1.3, 1, 2);
  diagram.require_edge(1, 1.72, 2, 3);
  diagram.require_edge(2, 2.2, 3, 2);
  BOOST_TEST(diagram.growth(0).at(0).from == 1.72, tolerance(1e-4));
  BOOST_TEST(diagram.growth(1).at(0).from == 1.3, tolerance(1e-4));
  BOOST_TEST(diagram.growth(2).at(0).to == 2.2, tolerance(1e-4));
}

BOOST_AUTO_TEST_CASE(modes_that_begin_together_have_one_edge) {
  const Diagram diagram({-1.0, -2.0}, {before(-1.4), before(-1.4)});
  BOOST_TEST_REQUIRE(diagram.edges.size() == 1U);
  diagram.require_edge(0, -1.4, 0, 2);
  for (const std::size_t line : {0U, 1U})
    BOOST_TEST(diagram.growth(line).at(0).from == -1.4, tolerance(1e-4));
}

BOOST_AUTO_TEST_CASE(nothing_is_searched_without_a_change) {
  const Rates rates{[](double) { return 0.01; }, decaying};
  const Diagram diagram({1.0, 2.0}, rates);
  BOOST_TEST(diagram.edges.empty());
  BOOST_TEST(simulation::find_changes(diagram.points, diagram.lines).empty());
  // Growth that another mode takes over at one place changes no number.
  const Diagram exchange({1.0, 2.0}, {before(1.47), behind(1.47)});
  BOOST_TEST(exchange.edges.empty());
}

BOOST_AUTO_TEST_CASE(an_edge_stays_wide_where_a_point_has_no_modes) {
  const Rates rates{behind(1.3), decaying};
  const CampbellPoint from = point_at(1.0, rates);
  const CampbellPoint to = point_at(2.0, rates);
  const auto edges = simulation::find_edges(from, to, [&rates](double x) {
    CampbellPoint point = point_at(x, rates);
    if (x < 1.5) point.failure = "no steady state";
    return point;
  });
  BOOST_TEST_REQUIRE(edges.size() == 1U);
  BOOST_TEST(edges[0].from == 1.0);
  BOOST_TEST(edges[0].to == 1.5);
  const CampbellLine line{"", {{0, 0}, {1, 0}}};
  BOOST_TEST(simulation::find_growth({from, to}, line, edges).at(0).from == 2.0);
}

BOOST_AUTO_TEST_CASE(growth_ends_at_the_edge_where_the_line_of_the_mode_ends) {
  // Two modes of one frequency, one of which grows, become one that does not: its line goes on.
  const Rates rates{before(2.3), decaying};
  Diagram diagram({1.0, 2.0, 3.0}, rates);
  const CampbellLine line{"", {{0, 0}, {1, 0}}};
  const auto found = simulation::find_growth(diagram.points, line, diagram.edges);
  BOOST_TEST_REQUIRE(found.size() == 1U);
  BOOST_TEST(found[0].to == 2.3, tolerance(1e-4));
  const CampbellLine later{"", {{1, 0}}};  // begins at a point, where another one ended
  BOOST_TEST(simulation::find_growth(diagram.points, later, diagram.edges).at(0).from == 2.0);
}

BOOST_AUTO_TEST_SUITE_END()
