// How loads are cut into the elements of a beam, and how they change with time.
#include "samara/model/load.hpp"

#include <cmath>
#include <cstddef>

#include <boost/test/unit_test.hpp>

#include "samara/math/quadrature.hpp"
#include "samara/model/beam.hpp"

namespace {

using namespace samara;

/// Sums of some dozen products of about one.
constexpr double round_off = 1e-13;

constexpr double length = 4.0;
constexpr double pi = 3.14159265358979324;

model::BeamDefinition beam_of(int elements, int order) {
  model::BeamDefinition beam;
  beam.length = length;
  beam.elements = elements;
  beam.order = order;
  model::SectionDefinition section;
  section.stiffness.setIdentity();
  section.mass.setIdentity();
  section.twist = 0.4;
  beam.sections = {section};
  return beam;
}

model::BeamLoad cut(const model::BeamDefinition& beam, double from, double to) {
  model::LoadDefinition load;
  load.from = from;
  load.to = to;
  return model::build_load(load, beam, model::build_beam("beam", beam));
}

/// Sum over nodes a and points j of the weights times x_a^p y_j^q.
double sum_of(const model::BeamDefinition& beam, const model::BeamLoad& load, int p, int q) {
  const std::vector<double> nodes = math::lobatto_nodes(beam.order);
  const math::QuadratureRule rule = math::gauss_rule(beam.order);
  double sum = 0.0;
  for (std::size_t e = 0; e < load.weights.size(); ++e) {
    const double start = load.first_element + static_cast<double>(e);
    const double size = beam.length / beam.elements;
    for (int a = 0; a <= beam.order; ++a)
      for (int j = 0; j < beam.order; ++j)
        sum += load.weights[e](a, j) *
               std::pow((start + nodes[static_cast<std::size_t>(a)]) * size, p) *
               std::pow((start + rule.points[static_cast<std::size_t>(j)]) * size, q);
  }
  return sum;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(load)

BOOST_AUTO_TEST_CASE(distributed_loads_are_integrated_exactly_over_any_part) {
  // Test functions hold x^p up to p = s, the turning of the points x^q up to q = s - 1.
  for (int order = 1; order <= 5; ++order) {
    const model::BeamDefinition beam = beam_of(3, order);
    for (const auto& [from, to] : {std::pair(0.0, 1.0), std::pair(0.13, 0.77), std::pair(0.4, 0.5),
                                   std::pair(1.0 / 3.0, 0.9)}) {
      const model::BeamLoad load = cut(beam, from, to);
      BOOST_TEST(!load.at_tip);
      const int p = order;
      const int q = order - 1;
      const auto power = [&](double fraction) { return std::pow(fraction * length, p + q + 1); };
      const double expected = (power(to) - power(from)) / (p + q + 1);
      BOOST_TEST(std::abs(sum_of(beam, load, p, q) - expected) < round_off * power(1.0));
      BOOST_TEST(std::abs(sum_of(beam, load, 0, 0) - (to - from) * length) < round_off);
    }
  }
}

BOOST_AUTO_TEST_CASE(point_loads_act_at_their_place) {
  for (int order = 1; order <= 5; ++order) {
    const model::BeamDefinition beam = beam_of(4, order);
    for (const double at : {0.0, 0.25, 0.3, 0.99}) {
      const model::BeamLoad load = cut(beam, at, at);
      BOOST_TEST(load.weights.size() == 1u);
      const double expected = std::pow(at * length, 2 * order - 1);
      BOOST_TEST(std::abs(sum_of(beam, load, order, order - 1) - expected) <
                 round_off * std::pow(length, 2 * order - 1));
      BOOST_TEST(std::abs(sum_of(beam, load, 0, 0) - 1.0) < round_off);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_load_at_the_end_is_the_tips_and_knows_its_twist) {
  const model::BeamLoad load = cut(beam_of(4, 2), 1.0, 1.0);
  BOOST_TEST(load.at_tip);
  BOOST_TEST(load.weights.empty());
  // Twist turns b2 toward -b3.
  BOOST_TEST((load.tip_axes.col(1) - Vector3(0.0, std::cos(0.4), -std::sin(0.4))).norm() <
             round_off);
}

BOOST_AUTO_TEST_CASE(factors_are_constant_harmonic_or_tabulated) {
  model::LoadVariation series;
  BOOST_TEST(series.is_constant());
  BOOST_TEST(series.factor(7.0, 3.0) == 1.0);
  series.mean = 2.0;
  series.amplitude = 0.5;
  series.phase = pi / 3.0;
  series.frequency = 5.0;
  BOOST_TEST(!series.is_constant());
  BOOST_TEST(std::abs(series.factor(0.3, 9.0) - (2.0 + 0.5 * std::cos(1.5 + pi / 3.0))) <
             round_off);
  series.per_rev = 2;  // of 9 rad/s
  BOOST_TEST(std::abs(series.factor(0.3, 9.0) - (2.0 + 0.5 * std::cos(5.4 + pi / 3.0))) <
             round_off);
  series.table = {{1.0, 4.0}, {2.0, 6.0}, {4.0, 0.0}};
  for (const auto& [t, factor] : {std::pair(-1.0, 4.0), std::pair(1.0, 4.0), std::pair(1.5, 5.0),
                                  std::pair(2.0, 6.0), std::pair(3.0, 3.0), std::pair(9.0, 0.0)})
    BOOST_TEST(std::abs(series.factor(t, 9.0) - factor) < round_off);
}

BOOST_AUTO_TEST_SUITE_END()
