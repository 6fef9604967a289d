#include "samara/math/rotation.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include "samara/math/autodiff.hpp"

namespace {

using namespace samara;
using Complex = std::complex<double>;

/// Entries of order one after some ten operations.
constexpr double round_off = 1e-14;

/// Complex step: h^2 vanishes beside one, so the derivative has no truncation error.
constexpr double complex_step = 1e-30;

/// Step of the central difference with Richardson's extrapolation (error h^4), and what remains.
constexpr double difference_step = 2e-3;
constexpr double difference_tolerance = 1e-10;

Vector3 random_vector(std::minstd_rand& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  const double x = uniform(random);
  const double y = uniform(random);
  return Vector3(x, y, uniform(random));
}

/// A vector of the given length.
Vector3 random_direction(std::minstd_rand& random) {
  return random_vector(random, 1.0).normalized();
}

/// The matrix that turns vectors by theta, by Eigen: theta = 2 tan(phi / 2) n.
Matrix3 turning_matrix(const Vector3& theta) {
  const double phi = 2.0 * std::atan(0.5 * theta.norm());
  return Eigen::AngleAxisd(phi, theta.normalized()).toRotationMatrix();
}

/// Rotation parameters from small to 170 degrees.
std::vector<Vector3> all_sizes(std::minstd_rand& random) {
  std::vector<Vector3> thetas;
  for (const double phi_deg : {1e-6, 1e-2, 1.0, 30.0, 90.0, 120.0, 150.0, 169.9}) {
    const double phi = phi_deg * std::numbers::pi / 180.0;
    for (int i = 0; i < 5; ++i)
      thetas.push_back(2.0 * std::tan(0.5 * phi) * random_direction(random));
  }
  return thetas;
}

double largest(const Matrix3& difference) { return difference.cwiseAbs().maxCoeff(); }
double largest(const Vector3& difference) { return difference.cwiseAbs().maxCoeff(); }

Vec3<Complex> stepped(const Vector3& at, const Vector3& along) {
  Vec3<Complex> z;
  for (int i = 0; i < 3; ++i) z(i) = Complex(at(i), complex_step * along(i));
  return z;
}

Matrix3 rate_of(const Mat3<Complex>& value) { return value.imag() / complex_step; }

}  // namespace

BOOST_AUTO_TEST_SUITE(rotation)

BOOST_AUTO_TEST_CASE(skew_is_the_cross_product) {
  std::minstd_rand random(1);
  for (int i = 0; i < 10; ++i) {
    const Vector3 a = random_vector(random, 2.0);
    const Vector3 b = random_vector(random, 2.0);
    BOOST_TEST(largest(Vector3(math::skew<double>(a) * b - a.cross(b))) < round_off);
    BOOST_TEST(largest(Vector3(math::cross<double>(a, b) - a.cross(b))) < round_off);
    BOOST_TEST(std::abs(math::dot<double>(a, b) - a.dot(b)) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(the_product_has_no_conjugate) {
  const Vec3<Complex> i(Complex(0, 1), Complex(0, 0), Complex(0, 0));
  BOOST_TEST((math::dot<Complex>(i, i) == Complex(-1, 0)));
  const Vec3<Complex> j(Complex(0, 0), Complex(0, 1), Complex(0, 0));
  BOOST_TEST((math::cross<Complex>(i, j)(2) == Complex(-1, 0)));
}

BOOST_AUTO_TEST_CASE(direction_cosines_are_orthogonal_with_determinant_one) {
  std::minstd_rand random(2);
  for (const Vector3& theta : all_sizes(random)) {
    const Matrix3 C = math::direction_cosines(theta);
    BOOST_TEST(largest(Matrix3(C * C.transpose() - Matrix3::Identity())) < round_off);
    BOOST_TEST(std::abs(C.determinant() - 1.0) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(direction_cosines_map_unturned_components_to_turned_ones) {
  std::minstd_rand random(3);
  for (const Vector3& theta : all_sizes(random)) {
    const Matrix3 C = math::direction_cosines(theta);
    BOOST_TEST(largest(Matrix3(C.transpose() - turning_matrix(theta))) < 10.0 * round_off);
  }
  // A quarter turn about 3 takes axis 1 to axis 2, which then reads (0, 1, 0) in the old basis.
  const Matrix3 C = math::direction_cosines(Vector3(0.0, 0.0, 2.0));
  BOOST_TEST(largest(Vector3(C.transpose() * Vector3::UnitX() - Vector3::UnitY())) < round_off);
}

BOOST_AUTO_TEST_CASE(direction_cosines_are_those_of_equation_2) {
  std::minstd_rand random(4);
  for (const Vector3& theta : all_sizes(random)) {
    const double quarter = 0.25 * theta.squaredNorm();
    const Matrix3 printed = ((1.0 - quarter) * Matrix3::Identity() - math::skew<double>(theta) +
                             0.5 * theta * theta.transpose()) /
                            (1.0 + quarter);
    BOOST_TEST(largest(Matrix3(math::direction_cosines(theta) - printed)) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(two_turns_about_one_axis_add_their_angles) {
  std::minstd_rand random(5);
  const Vector3 n = random_direction(random);
  const auto parameters = [&n](double phi) { return Vector3(2.0 * std::tan(0.5 * phi) * n); };
  const Matrix3 both =
      math::direction_cosines(parameters(0.9)) * math::direction_cosines(parameters(1.3));
  BOOST_TEST(largest(Matrix3(both - math::direction_cosines(parameters(2.2)))) < round_off);
}

BOOST_AUTO_TEST_CASE(turns_compose_outer_after_inner) {
  // Rodrigues' composition of half-tangents: a after b turns by (a + b + a x b / 2) / (1 - a.b /
  // 4).
  std::minstd_rand random(6);
  for (int i = 0; i < 20; ++i) {
    const Vector3 a = random_vector(random, 1.0);
    const Vector3 b = random_vector(random, 1.0);
    const Vector3 both = (a + b + 0.5 * a.cross(b)) / (1.0 - 0.25 * a.dot(b));
    const Matrix3 turned =
        math::direction_cosines(a).transpose() * math::direction_cosines(b).transpose();
    BOOST_TEST(largest(Matrix3(math::direction_cosines(both).transpose() - turned)) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(the_opposite_parameters_turn_back) {
  std::minstd_rand random(7);
  for (const Vector3& theta : all_sizes(random)) {
    const Vector3 back = -theta;
    BOOST_TEST(largest(Matrix3(math::direction_cosines(back) -
                               math::direction_cosines(theta).transpose())) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(tangent_gives_the_angular_velocity_in_the_turned_basis) {
  // skew(omega) = -C_dot C^T with C_dot by differences.
  std::minstd_rand random(8);
  for (int i = 0; i < 20; ++i) {
    const Vector3 theta = random_vector(random, 2.0);
    const Vector3 theta_dot = random_vector(random, 1.0);
    const auto difference = [&](double h) {
      const Vector3 after = theta + h * theta_dot;
      const Vector3 before = theta - h * theta_dot;
      return Matrix3((math::direction_cosines(after) - math::direction_cosines(before)) /
                     (2.0 * h));
    };
    const Matrix3 C_dot =
        (4.0 * difference(0.5 * difference_step) - difference(difference_step)) / 3.0;
    const Matrix3 spin = -C_dot * math::direction_cosines(theta).transpose();
    const Vector3 omega = math::tangent_times(theta, theta_dot);
    BOOST_TEST(largest(Matrix3(spin - math::skew<double>(omega))) < difference_tolerance);
  }
}

BOOST_AUTO_TEST_CASE(tangent_gives_the_angular_velocity_up_to_170_degrees_by_complex_step) {
  std::minstd_rand random(9);
  for (const Vector3& theta : all_sizes(random)) {
    const Vector3 theta_dot = random_vector(random, 1.0);
    const Matrix3 C_dot = rate_of(math::direction_cosines(stepped(theta, theta_dot)));
    const Matrix3 spin = -C_dot * math::direction_cosines(theta).transpose();
    const Vector3 omega = math::tangent_times(theta, theta_dot);
    BOOST_TEST(largest(Matrix3(spin - math::skew<double>(omega))) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(tangent_is_the_matrix_of_the_theory_and_its_inverse_undoes_it) {
  std::minstd_rand random(10);
  for (const Vector3& theta : all_sizes(random)) {
    const Vector3 r = random_vector(random, 1.0);
    const double quarter = 0.25 * theta.squaredNorm();
    const Vector3 printed = (r - 0.5 * theta.cross(r)) / (1.0 + quarter);
    BOOST_TEST(largest(Vector3(math::tangent_times(theta, r) - printed)) < round_off);
    // Q^-1 grows with the square of theta; its product with Q loses that many digits.
    const double lost = 1.0 + quarter;
    const Vector3 there_and_back =
        math::inverse_tangent_times(theta, math::tangent_times(theta, r));
    BOOST_TEST(largest(Vector3(there_and_back - r)) < round_off * lost);
    const Vector3 back_and_there =
        math::tangent_times(theta, math::inverse_tangent_times(theta, r));
    BOOST_TEST(largest(Vector3(back_and_there - r)) < round_off * lost);
  }
}

BOOST_AUTO_TEST_CASE(small_turns_are_the_cross_product) {
  // C = I - skew(theta) + O(theta^2), Q = I + O(theta).
  std::minstd_rand random(11);
  for (const double size : {1e-3, 1e-5, 1e-7}) {
    const Vector3 theta = size * random_direction(random);
    const Vector3 r = random_direction(random);
    const Matrix3 linear = Matrix3::Identity() - math::skew<double>(theta);
    BOOST_TEST(largest(Matrix3(math::direction_cosines(theta) - linear)) < size * size + round_off);
    BOOST_TEST(largest(Vector3(math::tangent_times(theta, r) - r)) < size);
    BOOST_TEST(largest(Vector3(math::inverse_tangent_times(theta, r) - r)) < size);
  }
  const Vector3 zero = Vector3::Zero();
  BOOST_TEST(math::direction_cosines(zero).isIdentity(0.0));
}

BOOST_AUTO_TEST_CASE(turn_about_is_the_turn_of_vectors_by_eigen) {
  std::minstd_rand random(12);
  for (int i = 0; i < 20; ++i) {
    const Vector3 axis = random_direction(random);
    const double angle = 0.4 * (i - 10);
    const Matrix3 expected = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    BOOST_TEST(largest(Matrix3(math::turn_about<double>(axis, angle) - expected)) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(turn_about_and_direction_cosines_agree_on_the_sense) {
  std::minstd_rand random(13);
  const Vector3 axis = random_direction(random);
  const double angle = 1.1;
  const Vector3 theta = 2.0 * std::tan(0.5 * angle) * axis;
  BOOST_TEST(largest(Matrix3(math::turn_about<double>(axis, angle) -
                             math::direction_cosines(theta).transpose())) < round_off);
}

BOOST_AUTO_TEST_CASE(complex_step_goes_through_every_function) {
  std::minstd_rand random(14);
  for (int i = 0; i < 10; ++i) {
    const Vector3 theta = random_vector(random, 2.0);
    const Vector3 along = random_vector(random, 1.0);
    const Vector3 r = random_vector(random, 1.0);
    const Vec3<Complex> z = stepped(theta, along);
    const Vec3<Complex> rc = r.cast<Complex>();
    const double h = difference_step;
    const auto difference = [&](const auto& function) {
      const auto central = [&](double s) {
        const Vector3 after = theta + s * along;
        const Vector3 before = theta - s * along;
        return Vector3((function(after) - function(before)) / (2.0 * s));
      };
      return Vector3((4.0 * central(0.5 * h) - central(h)) / 3.0);
    };
    const Vector3 by_cosines = (math::direction_cosines(z) * rc).imag() / complex_step;
    BOOST_TEST(largest(Vector3(by_cosines - difference([&](const Vector3& x) {
                                 return Vector3(math::direction_cosines(x) * r);
                               }))) < difference_tolerance);
    const Vector3 by_tangent = math::tangent_times(z, rc).imag() / complex_step;
    BOOST_TEST(largest(Vector3(by_tangent - difference([&](const Vector3& x) {
                                 return math::tangent_times(x, r);
                               }))) < difference_tolerance);
    const Vector3 by_inverse = math::inverse_tangent_times(z, rc).imag() / complex_step;
    BOOST_TEST(largest(Vector3(by_inverse - difference([&](const Vector3& x) {
                                 return math::inverse_tangent_times(x, r);
                               }))) < difference_tolerance);
    const Vector3 axis = r.normalized();
    const Matrix3 by_angle = rate_of(math::turn_about<Complex>(axis, Complex(0.8, complex_step)));
    const Matrix3 expected = math::skew<double>(axis) * math::turn_about<double>(axis, 0.8);
    BOOST_TEST(largest(Matrix3(by_angle - expected)) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(automatic_differentiation_agrees_with_complex_step) {
  std::minstd_rand random(15);
  using Scalar = math::Dual<3>;
  for (int i = 0; i < 10; ++i) {
    const Vector3 theta = random_vector(random, 2.0);
    Vec3<Scalar> dual;
    for (int j = 0; j < 3; ++j) dual(j) = math::independent<3>(theta(j), j);
    const Mat3<Scalar> C = math::direction_cosines(dual);
    const Vec3<Scalar> Q = math::tangent_times(dual, dual);
    for (int j = 0; j < 3; ++j) {
      const Vec3<Complex> z = stepped(theta, Vector3::Unit(j));
      const Matrix3 rate = rate_of(math::direction_cosines(z));
      const Vector3 tangent_rate = math::tangent_times(z, z).imag() / complex_step;
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
          BOOST_TEST(std::abs(C(row, column).derivatives()(j) - rate(row, column)) < round_off);
        BOOST_TEST(std::abs(Q(row).derivatives()(j) - tangent_rate(row)) < round_off);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(composed_parameters_are_those_of_one_turn_after_the_other) {
  std::minstd_rand random(16);
  for (int i = 0; i < 20; ++i) {
    const Vector3 a = random_vector(random, 2.0);
    const Vector3 b = random_vector(random, 2.0);
    const Matrix3 first = math::direction_cosines<double>(b).transpose();
    const Matrix3 then = math::direction_cosines<double>(a).transpose();
    const Vector3 both = math::compose<double>(a, b);
    const Matrix3 found = math::direction_cosines<double>(both).transpose();
    BOOST_TEST(largest(Matrix3(found - then * first)) < round_off);
    BOOST_TEST(largest(Vector3(math::parameters_of(then * first) - both)) <
               round_off * (1.0 + both.squaredNorm()));
  }
}

BOOST_AUTO_TEST_CASE(the_range_of_rotations_ends_at_170_degrees) {
  const double length = 2.0 * std::tan(85.0 * std::numbers::pi / 180.0);
  BOOST_TEST(std::abs(math::largest_rodrigues_length / length - 1.0) < 1e-9);
}

BOOST_AUTO_TEST_SUITE_END()
