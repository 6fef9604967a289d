#include "hill_bordered_solver.hpp"

#include <cmath>
#include <optional>

#include "samara/base/error.hpp"

namespace samara::analysis {
namespace {

using Complex = std::complex<double>;
using Index = Eigen::Index;
using Vector = Eigen::VectorXcd;
using Matrix = Eigen::MatrixXcd;

/// Distance of the shift from the exponents, and largest one at which factors are used again,
/// relative to the rotor speed.
constexpr double beside = 0.02;
constexpr double largest_distance = 0.1;

void take_shift(HillPencil& pencil, Complex exponent) {
  const double speed = pencil.speed();
  const std::optional<Complex> shift = pencil.shift();
  if (shift && std::abs(*shift - exponent) < largest_distance * speed) return;
  const double aside = exponent.imag() == 0.0 ? beside * speed : 0.0;
  if (!pencil.set_shift(exponent + Complex(beside * speed, aside)))
    throw ConvergenceError("floquet: Hill's method has no factors next to an exponent");
}

Matrix preconditioned(HillPencil& pencil, const Matrix& T, const Matrix& mass) {
  take_shift(pencil, T.diagonal().mean());
  Matrix Y(mass.rows(), mass.cols());
  pencil.precondition(mass, Y);
  return Y;
}

}  // namespace

HillBorderedSolver::HillBorderedSolver(HillPencil& pencil, const Matrix& X, const Matrix& T,
                                       const Matrix& mass, double accuracy)
    : pencil_(pencil),
      X_(X),
      T_(T),
      Y_(preconditioned(pencil, T, mass)),
      complement_(pencil.product(X, Y_)),
      solver_(make_solver(accuracy)) {}

/// A vector has C by column, then D, of which the first rank has all.
ComplexSolver HillBorderedSolver::make_solver(double accuracy) {
  const Index n = X_.rows();
  const Index m = X_.cols();
  const bool is_first = pencil_.ranks().rank == 0;
  const auto lower_part = [this, n, m, is_first](const Vector& x) {
    Matrix part;
    if (is_first) part = Eigen::Map<const Matrix>(x.data() + n * m, m, m);
    pencil_.ranks().share(0, part);
    return part;
  };
  const auto multiply = [this, n, m, is_first, lower_part](const Vector& x, Vector& y) {
    y.resize(x.size());
    const Eigen::Map<const Matrix> C(x.data(), n, m);
    const Matrix D = lower_part(x);
    pencil_.multiply(C, C * T_ + X_ * D, Eigen::Map<Matrix>(y.data(), n, m));
    const Matrix along = pencil_.product(X_, C);
    if (is_first) Eigen::Map<Matrix>(y.data() + n * m, m, m) = along;
  };
  const auto precondition = [this, n, m, is_first, lower_part](const Vector& x, Vector& y) {
    y.resize(x.size());
    Eigen::Map<Matrix> C(y.data(), n, m);
    pencil_.precondition(Eigen::Map<const Matrix>(x.data(), n, m), C);
    const Matrix D = complement_.solve(pencil_.product(X_, C) - lower_part(x));
    if (is_first) Eigen::Map<Matrix>(y.data() + n * m, m, m) = D;
    C -= Y_ * D;
  };
  const Index size = is_first ? n * m + m * m : n * m;
  return {size, multiply, precondition, accuracy, "hill_refine_", pencil_.ranks().comm};
}

HillBorderedSolver::Solution HillBorderedSolver::solve(const Matrix& right) {
  const Index n = X_.rows();
  const Index m = X_.cols();
  const bool is_first = pencil_.ranks().rank == 0;
  Vector whole = Vector::Zero(is_first ? n * m + m * m : n * m);
  Eigen::Map<Matrix>(whole.data(), n, m) = right;
  Vector solution;
  solver_.solve(whole, solution);
  Solution change{Eigen::Map<const Matrix>(solution.data(), n, m), {}};
  if (is_first) change.D = Eigen::Map<const Matrix>(solution.data() + n * m, m, m);
  pencil_.ranks().share(0, change.D);
  return change;
}

}  // namespace samara::analysis
