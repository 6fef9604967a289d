#include "samara/model/definition.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"

namespace {

using namespace samara;
using namespace samara::model;

constexpr double round_off = 1e-14;

SectionDefinition make_section() {
  SectionDefinition section;
  section.stiffness = Vector6(1e9, 1e8, 1e8, 1e6, 2e6, 3e6).asDiagonal();
  section.mass = Vector6(10, 10, 10, 3, 1, 2).asDiagonal();
  return section;
}

void make_rigid(SectionDefinition& section, int strain) {
  section.rigid[static_cast<std::size_t>(strain)] = true;
  section.stiffness.row(strain).setZero();
  section.stiffness.col(strain).setZero();
}

bool fault_holds(const SectionDefinition& section, const std::string& words) {
  const std::string fault = find_section_fault(section);
  BOOST_TEST_INFO("fault: " << fault);
  return fault.find(words) != std::string::npos;
}

/// I6 of a point mass m at (0, c2, c3), with nothing about its own centre.
Matrix6 make_point_mass(double mass, double c2, double c3) {
  Matrix3 skew;
  skew << 0, -c3, c2, c3, 0, 0, -c2, 0, 0;
  Matrix6 matrix;
  matrix << mass * Matrix3::Identity(), -mass * skew, mass * skew, -mass * skew * skew;
  return matrix;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(section_fault)

BOOST_AUTO_TEST_CASE(a_sound_section_has_none) {
  BOOST_TEST(find_section_fault(make_section()) == "");
}

BOOST_AUTO_TEST_CASE(coupled_positive_definite_stiffness_has_none) {
  SectionDefinition section = make_section();
  section.stiffness(3, 4) = section.stiffness(4, 3) = 0.9 * std::sqrt(1e6 * 2e6);
  BOOST_TEST(find_section_fault(section) == "");
}

BOOST_AUTO_TEST_CASE(all_strains_rigid_is_a_legal_section) {
  SectionDefinition section = make_section();
  for (int i = 0; i < 6; ++i) make_rigid(section, i);
  BOOST_TEST(find_section_fault(section) == "");
}

BOOST_AUTO_TEST_CASE(nonsymmetric_matrices_are_refused) {
  SectionDefinition section = make_section();
  section.stiffness(4, 3) = 1e5;
  BOOST_TEST(fault_holds(section, "stiffness matrix is not symmetric"));
  section = make_section();
  section.mass(4, 3) = 0.1;
  BOOST_TEST(fault_holds(section, "mass matrix is not symmetric"));
}

BOOST_AUTO_TEST_CASE(asymmetry_of_printing_is_accepted) {
  SectionDefinition section = make_section();
  section.stiffness(4, 3) = 1.0000001e5;
  section.stiffness(3, 4) = 1.0000002e5;
  BOOST_TEST(find_section_fault(section) == "");
}

BOOST_AUTO_TEST_CASE(values_that_are_not_finite_are_refused) {
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    SectionDefinition section = make_section();
    section.stiffness(2, 2) = value;
    BOOST_TEST(fault_holds(section, "not finite"));
    section = make_section();
    section.mass(5, 5) = value;
    BOOST_TEST(fault_holds(section, "not finite"));
    section = make_section();
    section.twist = value;
    BOOST_TEST(fault_holds(section, "twist"));
  }
}

BOOST_AUTO_TEST_CASE(indefinite_stiffness_is_refused) {
  SectionDefinition section = make_section();
  section.stiffness(3, 4) = section.stiffness(4, 3) = 1.1 * std::sqrt(1e6 * 2e6);
  BOOST_TEST(fault_holds(section, "not positive definite"));
  section = make_section();
  section.stiffness(3, 3) = 0;
  BOOST_TEST(fault_holds(section, "(4, 4) must be > 0"));
}

BOOST_AUTO_TEST_CASE(the_row_of_a_rigid_strain_must_be_zero) {
  SectionDefinition section = make_section();
  make_rigid(section, 1);
  BOOST_TEST(find_section_fault(section) == "");
  section.stiffness(1, 3) = section.stiffness(3, 1) = 1.0;
  BOOST_TEST(fault_holds(section, "rigid strain must be 0"));
}

BOOST_AUTO_TEST_CASE(mass_per_length_must_be_positive) {
  for (const double mass : {0.0, -1.0}) {
    for (int i = 0; i < 3; ++i) {
      SectionDefinition section = make_section();
      section.mass(i, i) = mass;
      BOOST_TEST(fault_holds(section, "no mass per length"));
    }
  }
}

BOOST_AUTO_TEST_CASE(indefinite_mass_is_refused) {
  SectionDefinition section = make_section();
  section.mass(4, 4) = -1e-3;
  BOOST_TEST(fault_holds(section, "not positive semi-definite"));
  section = make_section();
  section.mass(4, 4) = 0.0;
  section.mass(4, 5) = section.mass(5, 4) = 0.1;
  BOOST_TEST(fault_holds(section, "not positive semi-definite"));
  section = make_section();
  section.mass.topRightCorner<3, 3>() = make_point_mass(10, 1, 0).topRightCorner<3, 3>();
  section.mass.bottomLeftCorner<3, 3>() = make_point_mass(10, 1, 0).bottomLeftCorner<3, 3>();
  BOOST_TEST(fault_holds(section, "offset of the mass centre"));
}

BOOST_AUTO_TEST_CASE(a_rotation_without_inertia_needs_the_rigid_strain_that_ties_it) {
  struct Tie {
    int rotation;
    int strain;
    const char* stiffness;
  };
  for (const Tie& tie : {Tie{3, 3, "GJ"}, Tie{4, 2, "GA3"}, Tie{5, 1, "GA2"}}) {
    SectionDefinition section = make_section();
    section.mass(tie.rotation, tie.rotation) = 0.0;
    BOOST_TEST(fault_holds(section, tie.stiffness));
    make_rigid(section, tie.strain);
    BOOST_TEST(find_section_fault(section) == "");
  }
}

BOOST_AUTO_TEST_CASE(a_massless_direction_between_two_axes_needs_both_ties) {
  SectionDefinition section = make_section();
  section.mass(4, 4) = section.mass(5, 5) = 1.0;
  section.mass(4, 5) = section.mass(5, 4) = 1.0;  // none about b2 - b3
  BOOST_TEST(fault_holds(section, "GA3"));
  make_rigid(section, 2);
  BOOST_TEST(fault_holds(section, "GA2"));
  make_rigid(section, 1);
  BOOST_TEST(find_section_fault(section) == "");
}

BOOST_AUTO_TEST_CASE(a_point_mass_beside_the_reference_line_is_refused) {
  SectionDefinition section = make_section();
  for (int i = 0; i < 6; ++i) make_rigid(section, i);
  section.mass = make_point_mass(10, 0.3, 0.1);
  BOOST_TEST(fault_holds(section, "point mass"));
  section.mass.bottomRightCorner<3, 3>() += 0.1 * Matrix3::Identity();
  BOOST_TEST(find_section_fault(section) == "");
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(interpolation)

BOOST_AUTO_TEST_CASE(one_section_is_uniform) {
  BeamDefinition beam;
  beam.sections = {make_section()};
  beam.sections[0].at = 0.4;
  for (const double fraction : {0.0, 0.3, 1.0}) {
    const SectionDefinition section = interpolate_section(beam, fraction);
    BOOST_TEST((section.stiffness == beam.sections[0].stiffness));
    BOOST_TEST((section.mass == beam.sections[0].mass));
    BOOST_TEST(section.at == fraction);
  }
}

BOOST_AUTO_TEST_CASE(it_is_linear_between_stations_and_constant_outside) {
  BeamDefinition beam;
  beam.sections = {make_section(), make_section(), make_section()};
  beam.sections[0].at = 0.1;
  beam.sections[1].at = 0.5;
  beam.sections[1].stiffness *= 3.0;
  beam.sections[1].mass *= 2.0;
  beam.sections[1].twist = 0.2;
  beam.sections[2].at = 0.9;
  beam.sections[2].stiffness *= 7.0;

  const Matrix6 unit = make_section().stiffness;
  const auto factor_at = [&](double fraction) {
    const SectionDefinition section = interpolate_section(beam, fraction);
    const double factor = section.stiffness(3, 3) / unit(3, 3);
    BOOST_TEST((section.stiffness - factor * unit).norm() <= round_off * section.stiffness.norm());
    return factor;
  };
  const auto near = boost::test_tools::tolerance(round_off);
  BOOST_TEST(factor_at(0.0) == 1.0);
  BOOST_TEST(factor_at(0.1) == 1.0);
  BOOST_TEST(factor_at(0.2) == 1.5, near);
  BOOST_TEST(factor_at(0.5) == 3.0);
  BOOST_TEST(factor_at(0.7) == 5.0, near);
  BOOST_TEST(factor_at(0.9) == 7.0);
  BOOST_TEST(factor_at(1.0) == 7.0);
  BOOST_TEST(interpolate_section(beam, 0.2).twist == 0.05, near);
  BOOST_TEST(interpolate_section(beam, 0.2).mass(0, 0) == 12.5, near);
}

BOOST_AUTO_TEST_CASE(a_rigid_strain_stays_rigid_between_stations) {
  BeamDefinition beam;
  beam.sections = {make_section(), make_section()};
  beam.sections[1].at = 1.0;
  for (SectionDefinition& section : beam.sections) make_rigid(section, 2);
  const SectionDefinition section = interpolate_section(beam, 0.5);
  BOOST_TEST(section.rigid[2]);
  BOOST_TEST(!section.rigid[1]);
  BOOST_TEST(find_section_fault(section) == "");
}

BOOST_AUTO_TEST_CASE(a_beam_without_sections_is_a_defect) {
  BOOST_CHECK_THROW(interpolate_section(BeamDefinition(), 0.5), InternalError);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(arc_length)

BOOST_AUTO_TEST_CASE(points_on_a_straight_line_give_their_distance) {
  const Vector3 direction(1, 2, -2);  // of length 3
  BOOST_TEST(compute_arc_length({Vector3::Zero(), direction}) == 3.0,
             boost::test_tools::tolerance(round_off));
  BOOST_TEST(
      compute_arc_length({Vector3::Zero(), 0.1 * direction, 0.7 * direction, direction}) == 3.0,
      boost::test_tools::tolerance(round_off));
}

BOOST_AUTO_TEST_CASE(points_on_an_arc_converge_to_its_length) {
  // The natural ends of the spline limit the order to about 3 (in the length): factor 8 a doubling.
  const auto compute_error = [](int intervals) {
    std::vector<Vector3> points;
    for (int i = 0; i <= intervals; ++i) {
      const double angle = 0.25 * std::numbers::pi * i / intervals;
      points.emplace_back(100 * std::sin(angle), 100 - 100 * std::cos(angle), 0);
    }
    return std::abs(compute_arc_length(points) / (25 * std::numbers::pi) - 1);
  };
  const double coarse = compute_error(8);
  const double fine = compute_error(16);
  BOOST_TEST(coarse < 1e-4);
  BOOST_TEST(fine < coarse / 6);
}

BOOST_AUTO_TEST_CASE(points_that_coincide_have_none) {
  BOOST_TEST(std::isnan(compute_arc_length({Vector3::Zero(), Vector3::UnitX(), Vector3::UnitX()})));
  BOOST_TEST(compute_arc_length({Vector3::Zero()}) == 0.0);
}

BOOST_AUTO_TEST_SUITE_END()
