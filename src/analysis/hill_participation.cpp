#include "hill_participation.hpp"

#include <cmath>
#include <complex>
#include <vector>

#include <Eigen/Core>

#include "hill_bordered_solver.hpp"

namespace samara::analysis {
namespace {

using Complex = std::complex<double>;
using Index = Eigen::Index;
using Matrix = Eigen::MatrixXcd;

/// Relative residual of the solutions, whose sizes are compared.
constexpr double accuracy = 1e-3;
/// Factor of all states below which that of no part can be larger than that of the motion.
constexpr double small_factor = 0.3;

}  // namespace

int leading_part(HillPencil& pencil, const system::PeriodicSystem& system, const StateParts& parts,
                 const HillPair& pair) {
  const Eigen::VectorXcd whole = pencil.vector_of(pair.series);
  const double size = pencil.ranks().norm(whole);
  const Matrix X = whole / size;
  const Matrix T = Matrix::Constant(1, 1, pair.exponent);
  Matrix mass(X.rows(), 1);
  pencil.multiply_mass(X, mass);
  HillBorderedSolver solver(pencil, X, T, mass, accuracy);
  // A X + B X T = 0 and the same with d/dt + epsilon for some states.
  std::vector<std::size_t> state_of(system.unknowns().size());  // its number, of each state
  std::size_t states = 0;
  for (std::size_t i = 0; i < state_of.size(); ++i)
    if (system.unknowns()[i].role == system::UnknownRole::state) state_of[i] = states++;
  const auto factor_of = [&](const auto& is_meant) {
    Matrix series = pair.series;
    for (Index column = 0; column < series.cols(); ++column) {
      const auto i = static_cast<std::size_t>(
          pencil.mesh() != nullptr ? pencil.unknown_of_system(column) : column);
      if (system.unknowns()[i].role != system::UnknownRole::state ||
          !is_meant(parts.part_of[state_of[i]]))
        series.col(column).setZero();
    }
    Matrix right(X.rows(), 1);
    pencil.multiply_mass(pencil.vector_of(series) / size, right);
    return Complex(-solver.solve(-right).D(0, 0));
  };
  const Complex of_states = factor_of([](std::size_t) { return true; });
  int leading = -1;
  double largest = std::abs(1.0 - of_states);
  for (std::size_t part = 0; part < parts.owners.size(); ++part) {
    if (std::abs(of_states) < small_factor) break;
    const double own = std::abs(factor_of([part](std::size_t other) { return other == part; }));
    if (own <= largest) continue;
    largest = own;
    leading = static_cast<int>(part);
  }
  return leading;
}

}  // namespace samara::analysis
