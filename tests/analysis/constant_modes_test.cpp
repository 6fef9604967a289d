// Modes of constant tangents of systems with closed-form exponents.
#include "samara/analysis/constant_modes.hpp"

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"

#include "small_systems.hpp"

using namespace samara;
using namespace samara::test;
using Complex = std::complex<double>;

namespace {

/// Two masses on a line at rest, one of them held by an elastic strain: m1 p'' + F = k (q - p),
/// p = f F, m2 q'' = k (p - q).
class TwoMasses final : public SmallSystem {
 public:
  TwoMasses() {
    add("p", UnknownRole::position, RowRole::constraint);
    add("q", UnknownRole::position, RowRole::kinematic);
    add("p speed", UnknownRole::velocity, RowRole::kinematic);
    add("q speed", UnknownRole::velocity, RowRole::balance);
    add("F", UnknownRole::internal, RowRole::balance);
    add_kinetic("p", 2, 3.0);
    add_kinetic("q", 3, 2.0);
  }
  void tangents_at(double, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    const double k = 7.0;
    K(0, 0) = 1.0;  // p - F / 40
    K(0, 4) = -1.0 / 40.0;
    K(1, 3) = 1.0;  // q speed - q'
    M(1, 1) = -1.0;
    K(2, 2) = 1.0;
    M(2, 0) = -1.0;
    M(3, 3) = 2.0;  // 2 q'' + k (q - p)
    K(3, 1) = k;
    K(3, 0) = -k;
    M(4, 2) = 3.0;  // 3 p'' + F + k (p - q)
    K(4, 4) = 1.0;
    K(4, 0) = k;
    K(4, 1) = -k;
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(two_masses_have_the_frequencies_of_their_quadratic) {
  // det [47 - 3 L, -7; -7, 7 - 2 L] = 6 L^2 - 115 L + 280, L = w^2.
  const TwoMasses system;
  const analysis::ModeSet set = find_constant_modes(system, rest(system));
  BOOST_TEST(set.degrees_of_freedom == 2);
  BOOST_REQUIRE(set.modes.size() == 2U);
  const double root = std::sqrt(115.0 * 115.0 - 4.0 * 6.0 * 280.0);
  BOOST_TEST(set.modes[0].exponent.imag() == std::sqrt((115.0 - root) / 12.0),
             boost::test_tools::tolerance(1e-13));
  BOOST_TEST(set.modes[1].exponent.imag() == std::sqrt((115.0 + root) / 12.0),
             boost::test_tools::tolerance(1e-13));
  for (std::size_t m = 0; m < 2; ++m) {
    BOOST_TEST(std::abs(set.modes[m].exponent.real()) < 1e-12);
    BOOST_TEST(set.modes[m].resolved);
    const Complex L = -set.modes[m].exponent * set.modes[m].exponent;
    const Eigen::MatrixXcd& shape = set.shapes[m];
    BOOST_TEST(std::abs((47.0 - 3.0 * L) * shape(0, 0) - 7.0 * shape(1, 0)) < 1e-11);
    BOOST_TEST(std::abs(shape(4, 0) - 40.0 * shape(0, 0)) < 1e-11);
    BOOST_TEST(std::abs(shape(3, 0) - set.modes[m].exponent * shape(1, 0)) < 1e-11);
    BOOST_TEST(std::max(std::abs(shape(0, 0)), std::abs(shape(1, 0))) == 1.0,
               boost::test_tools::tolerance(1e-12));
  }
}

BOOST_AUTO_TEST_CASE(damped_whirl_in_turning_axes_is_shifted_by_the_speed) {
  constexpr double frequency = 5.3;
  constexpr double damping = 0.2;
  constexpr double speed = 2.0;
  const TurningMass system(frequency, damping, speed);
  const analysis::ModeSet set = find_constant_modes(system, rest(system));
  const double whirl = std::sqrt(frequency * frequency - 0.25 * damping * damping);
  BOOST_REQUIRE(set.modes.size() == 2U);
  BOOST_TEST(std::abs(set.modes[0].exponent - Complex(-0.5 * damping, whirl - speed)) < 1e-12);
  BOOST_TEST(std::abs(set.modes[1].exponent - Complex(-0.5 * damping, whirl + speed)) < 1e-12);
}

BOOST_AUTO_TEST_CASE(overdamped_mass_has_two_real_exponents_in_each_direction) {
  // l^2 + 8 l + 7 = 0: -1, -7, twice (both directions), seen turning at speed 2: l +- 2 i.
  const TurningMass system(std::sqrt(7.0), 8.0, 2.0);
  const analysis::ModeSet set = find_constant_modes(system, rest(system));
  BOOST_REQUIRE(set.modes.size() == 2U);
  for (const double wanted : {-1.0, -7.0}) {
    double distance = 1.0;
    for (const analysis::Mode& mode : set.modes)
      distance = std::min(distance, std::abs(mode.exponent - Complex(wanted, 2.0)));
    BOOST_TEST(distance < 1e-11);
  }
}

BOOST_AUTO_TEST_CASE(periodic_tangents_are_refused) {
  const Mathieu system(2.5, 1.0);
  BOOST_CHECK_THROW(find_constant_modes(system, rest(system)), InputError);
  const GroundResonance rotor(3);
  BOOST_CHECK_THROW(find_constant_modes(rotor, rest(rotor)), InputError);
}
