// Sections of a beam at its Gauss points: what the mesh keeps of a table.
#include "samara/model/beam.hpp"

#include <Eigen/Eigenvalues>
#include <boost/test/unit_test.hpp>

using namespace samara;
using namespace samara::model;

namespace {

SectionDefinition station(double at, double mass, double stiffness) {
  SectionDefinition section;
  section.at = at;
  section.stiffness = stiffness * Vector6(9, 4, 4, 1, 2, 3).asDiagonal().toDenseMatrix();
  section.mass = mass * Vector6(1, 1, 1, 0.3, 0.1, 0.2).asDiagonal().toDenseMatrix();
  return section;
}

/// Mass m(x), linear between stations, times x^power, over the length 1.
double exact_moment(const std::vector<SectionDefinition>& sections, int power) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < sections.size(); ++i) {
    const double a = sections[i].at;
    const double b = sections[i + 1].at;
    const double slope = (sections[i + 1].mass(0, 0) - sections[i].mass(0, 0)) / (b - a);
    const double start = sections[i].mass(0, 0) - slope * a;
    const auto part = [&](double x) {
      return start * std::pow(x, power + 1) / (power + 1) +
             slope * std::pow(x, power + 2) / (power + 2);
    };
    sum += part(b) - part(a);
  }
  return sum;
}

double meshed_moment(const Beam& beam, int power) {
  double sum = 0.0;
  for (int p = 0; p < beam.point_count(); ++p) {
    const auto at = static_cast<std::size_t>(p);
    sum += beam.point_length(p) * beam.points[at].mass(0, 0) * std::pow(beam.fractions[at], power);
  }
  return sum;
}

BeamDefinition table(int elements, int order) {
  BeamDefinition definition;
  definition.length = 1.0;
  definition.elements = elements;
  definition.order = order;
  definition.sections = {station(0.0, 5.0, 9.0),  station(0.07, 4.0, 8.0), station(0.1, 2.0, 3.0),
                         station(0.45, 1.8, 2.0), station(0.62, 1.5, 1.5), station(1.0, 0.6, 1.0)};
  return definition;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(meshed_sections)

BOOST_AUTO_TEST_CASE(moments_of_the_mass_up_to_the_order_survive_the_mesh) {
  for (const int elements : {1, 2, 3, 5})
    for (const int order : {1, 2, 3, 4}) {
      const BeamDefinition definition = table(elements, order);
      const Beam beam = build_beam("beam", definition);
      for (int power = 0; power < order; ++power)
        BOOST_TEST(meshed_moment(beam, power) == exact_moment(definition.sections, power),
                   boost::test_tools::tolerance(1e-13));
    }
}

BOOST_AUTO_TEST_CASE(points_between_two_stations_have_the_section_there) {
  const BeamDefinition definition = table(20, 2);
  const Beam beam = build_beam("beam", definition);
  const int p = 2 * 15;  // element 15: 0.75 to 0.8
  const SectionDefinition section =
      interpolate_section(definition, beam.fractions[static_cast<std::size_t>(p)]);
  BOOST_TEST((beam.points[p].mass - section.mass).norm() == 0.0);
  BOOST_TEST((beam.points[p].compliance - compliance_of(section)).norm() == 0.0);
}

BOOST_AUTO_TEST_CASE(elements_have_the_stated_lengths) {
  BeamDefinition definition = table(3, 2);
  definition.element_lengths = {1.0, 2.0, 0.5};
  const auto require = [&](const std::vector<double>& expected) {
    const Beam beam = build_beam("beam", definition);
    BOOST_REQUIRE(beam.ends.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
      BOOST_TEST(std::abs(beam.ends[i] - expected[i]) < 1e-14);
  };
  require({0.0, 2.0 / 7.0, 6.0 / 7.0, 1.0});
  // Twice as many halve each; two divide the path over the three in halves.
  definition.elements = 6;
  require({0.0, 1.0 / 7.0, 2.0 / 7.0, 4.0 / 7.0, 6.0 / 7.0, 13.0 / 14.0, 1.0});
  definition.elements = 2;
  require({0.0, 4.0 / 7.0, 1.0});
  definition.elements = 3;
  for (int power = 0; power < 2; ++power)
    BOOST_TEST(meshed_moment(build_beam("beam", definition), power) ==
                   exact_moment(definition.sections, power),
               boost::test_tools::tolerance(1e-13));
  // A point mass moves the nearest end.
  PointMassDefinition lump;
  lump.at = 0.8;
  lump.mass = 1.0;
  definition.point_masses = {lump};
  require({0.0, 2.0 / 7.0, 0.8, 1.0});
}

BOOST_AUTO_TEST_CASE(a_jump_leaves_possible_sections) {
  // A mass a hundred times the rest beside one end: the integrals would be negative elsewhere.
  BeamDefinition definition = table(1, 4);
  definition.sections = {station(0.0, 100.0, 1e-3), station(0.02, 100.0, 1e-3),
                         station(0.03, 1.0, 1.0), station(1.0, 1.0, 1.0)};
  const Beam beam = build_beam("beam", definition);
  for (const elements::BeamPoint& point : beam.points) {
    for (const Matrix6& matrix : {point.mass, point.compliance})
      BOOST_TEST(Eigen::SelfAdjointEigenSolver<Matrix6>(matrix).eigenvalues().minCoeff() > 0.0);
  }
}

BOOST_AUTO_TEST_SUITE_END()
