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
constexpr double largest_distance = 0.5;

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
      complement_(X.adjoint() * Y_),
      solver_(make_solver(accuracy)) {}

/// A vector has C by column, then D.
ComplexSolver HillBorderedSolver::make_solver(double accuracy) {
  const Index n = X_.rows();
  const Index m = X_.cols();
  const auto multiply = [this, n, m](const Vector& x, Vector& y) {
    y.resize(x.size());
    const Eigen::Map<const Matrix> C(x.data(), n, m);
    const Eigen::Map<const Matrix> D(x.data() + n * m, m, m);
    pencil_.multiply(C, C * T_ + X_ * D, Eigen::Map<Matrix>(y.data(), n, m));
    Eigen::Map<Matrix>(y.data() + n * m, m, m) = X_.adjoint() * C;
  };
  const auto precondition = [this, n, m](const Vector& x, Vector& y) {
    y.resize(x.size());
    Eigen::Map<Matrix> C(y.data(), n, m);
    Eigen::Map<Matrix> D(y.data() + n * m, m, m);
    pencil_.precondition(Eigen::Map<const Matrix>(x.data(), n, m), C);
    D = complement_.solve(X_.adjoint() * C - Eigen::Map<const Matrix>(x.data() + n * m, m, m));
    C -= Y_ * D;
  };
  return {n * m + m * m, multiply, precondition, accuracy, "hill_refine_"};
}

HillBorderedSolver::Solution HillBorderedSolver::solve(const Matrix& right) {
  const Index n = X_.rows();
  const Index m = X_.cols();
  Vector whole = Vector::Zero(n * m + m * m);
  Eigen::Map<Matrix>(whole.data(), n, m) = right;
  Vector solution;
  solver_.solve(whole, solution);
  return {Eigen::Map<const Matrix>(solution.data(), n, m),
          Eigen::Map<const Matrix>(solution.data() + n * m, m, m)};
}

}  // namespace samara::analysis
