#include "samara/linear/hill.hpp"

#include <vector>

namespace samara::linear {
namespace {

/// A term of the product of two of the functions 1, cos psi, sin psi, cos 2 psi, ... The product is
/// a sum of at most two of these functions, each with its number and its weight.
struct Term {
  int function;
  double weight;
};

int harmonic_of(int function) { return (function + 1) / 2; }
bool is_sine(int function) { return function > 0 && function % 2 == 0; }

std::vector<Term> product(int factor, int column) {
  if (factor == 0) return {{column, 1.0}};
  if (column == 0) return {{factor, 1.0}};
  const int k = harmonic_of(factor);
  const int j = harmonic_of(column);
  const int difference = k - j;  // of the arguments
  const int low = difference < 0 ? -difference : difference;
  const auto cosine = [](int n) { return n == 0 ? 0 : 2 * n - 1; };
  const auto sine = [](int n) { return 2 * n; };
  if (is_sine(factor) == is_sine(column))  // cos cos, sin sin
    return {{cosine(low), 0.5}, {cosine(k + j), is_sine(factor) ? -0.5 : 0.5}};
  // sin a cos b = (sin(a + b) + sin(a - b)) / 2
  std::vector<Term> terms{{sine(k + j), 0.5}};
  const int a_minus_b = is_sine(factor) ? difference : -difference;
  if (a_minus_b != 0) terms.push_back({sine(low), a_minus_b > 0 ? 0.5 : -0.5});
  return terms;
}

/// The matrix of the series that maps coefficients of functions to coefficients.
Eigen::MatrixXd lift(const AzimuthSeries& series, Eigen::MatrixXd StateSpace::*matrix,
                     int harmonics) {
  const int functions = 2 * harmonics + 1;
  const Eigen::Index rows = (series.mean().*matrix).rows();
  const Eigen::Index columns = (series.mean().*matrix).cols();
  Eigen::MatrixXd lifted = Eigen::MatrixXd::Zero(rows * functions, columns * functions);
  for (std::size_t f = 0; f < series.coefficients().size(); ++f)
    for (int j = 0; j < functions; ++j)
      for (const Term& term : product(static_cast<int>(f), j))
        if (term.function < functions)
          lifted.block(term.function * rows, j * columns, rows, columns) +=
              term.weight * (series.coefficients()[f].*matrix);
  return lifted;
}

}  // namespace

Eigen::MatrixXd hill_matrix(const AzimuthSeries& series, double rotor_speed, int harmonics) {
  Eigen::MatrixXd A = lift(series, &StateSpace::A, harmonics);
  const Eigen::Index n = series.mean().A.rows();
  for (int j = 1; j <= harmonics; ++j) {
    // Coefficients of x_dot: xc_dot + j Omega xs of the cosine, xs_dot - j Omega xc of the sine.
    const Eigen::Index cosine = (2 * j - 1) * n;
    const Eigen::Index sine = cosine + n;
    A.block(cosine, sine, n, n).diagonal().array() -= j * rotor_speed;
    A.block(sine, cosine, n, n).diagonal().array() += j * rotor_speed;
  }
  return A;
}

StateSpace hill_form(const AzimuthSeries& series, double rotor_speed, int harmonics) {
  return {hill_matrix(series, rotor_speed, harmonics), lift(series, &StateSpace::B, harmonics),
          lift(series, &StateSpace::C, harmonics), lift(series, &StateSpace::D, harmonics)};
}

}  // namespace samara::linear
