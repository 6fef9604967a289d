#include "samara/math/fourier.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include <boost/test/unit_test.hpp>

using namespace samara;

BOOST_AUTO_TEST_SUITE(fourier)

/// Even, odd, prime lengths and one sample: the coefficients of a signal of two harmonics are its
/// own, at k and at n + k for negative k.
BOOST_AUTO_TEST_CASE(coefficients_of_known_harmonics_are_found_at_any_length) {
  using Complex = std::complex<double>;
  const Complex a(0.7, -0.2);
  const Complex b(-1.3, 0.4);
  for (const int n : {1, 8, 9, 167, 500}) {
    const int k = n > 4 ? 3 : 0;
    const int minus = n > 4 ? n - 2 : 0;
    math::FourierTransform transform(2, n);
    Eigen::MatrixXcd& series = transform.input();
    for (int m = 0; m < n; ++m) {
      const double phase = 2.0 * std::numbers::pi * m / n;
      series(0, m) = a * std::polar(1.0, k * phase);
      series(1, m) = b * std::polar(1.0, -2.0 * phase);
    }
    const Eigen::MatrixXcd& spectrum = transform.run();
    BOOST_TEST(spectrum.rows() == n);
    BOOST_TEST(std::abs(spectrum(k, 0) - a) < 1e-13);
    BOOST_TEST(std::abs(spectrum(minus, 1) - b) < 1e-13);
    BOOST_TEST(std::abs(spectrum.col(0).squaredNorm() - std::norm(a)) < 1e-12);
    BOOST_TEST(std::abs(spectrum.col(1).squaredNorm() - std::norm(b)) < 1e-12);
  }
}

BOOST_AUTO_TEST_SUITE_END()
