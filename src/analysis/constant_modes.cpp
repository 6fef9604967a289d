#include "samara/analysis/constant_modes.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "samara/analysis/consistent_subspace.hpp"
#include "samara/analysis/identification.hpp"
#include "samara/analysis/linear_algebra.hpp"
#include "samara/base/error.hpp"

namespace samara::analysis {
namespace {

using Complex = std::complex<double>;

/// Relative change of a row of the tangents over a period beyond which they depend on time.
constexpr double constant_tolerance = 1e-9;

/// The second shift, relative to the first, and how far two shifts may differ in a mode, relative:
/// the stiffest strains of a fine mesh have frequencies beyond what double precision holds.
constexpr double check_shift = 5.0;
constexpr double largest_difference = 1e-6;

/// Below this, relative to the shift, an exponent is zero: a double zero in double precision.
constexpr double zero_to_shift = 1e-7;

/// The pair of consecutive images that stands for a state: see find_spectrum.
struct Spectrum {
  std::vector<Complex> exponents;
  Eigen::MatrixXcd shapes;  ///< size x modes
};

void require_constant(const system::PeriodicSystem& system, const PeriodicSolution& solution) {
  if (system.period() == 0.0) return;
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const petsc::Handle<Mat> jacobian = system.make_jacobian();
  const auto tangents = [&](double t) {
    solution.evaluate(t, z.get(), z_dot.get());
    system.tangents(t, z.get(), z_dot.get(), 1.0, jacobian.get(), nullptr);
    return to_sparse(jacobian.get());
  };
  const Eigen::SparseMatrix<double> first = tangents(0.0);
  const Eigen::VectorXd sizes = first.cwiseAbs() * Eigen::VectorXd::Ones(first.cols());
  for (const double part : {0.12, 0.31, 0.47, 0.78}) {
    const Eigen::SparseMatrix<double> change = tangents(part * system.period()) - first;
    const Eigen::VectorXd changes = change.cwiseAbs() * Eigen::VectorXd::Ones(first.cols());
    for (Eigen::Index i = 0; i < sizes.size(); ++i)
      if (changes(i) > constant_tolerance * std::max(sizes(i), 1.0))
        throw InputError("modes: the coefficients are periodic in the azimuth; hint: use samara floquet");
  }
}

/// B = (K + sigma M)^-1 M maps a consistent state with exponent lambda to itself times
/// 1 / (sigma - lambda), and a state is known by eta of itself and of its image.
Spectrum find_spectrum(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                       const ConsistentSubspace& subspace, double sigma) {
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const petsc::Handle<Mat> jacobian = system.make_jacobian();
  const petsc::Handle<Mat> mass = system.make_mass();
  solution.evaluate(0.0, z.get(), z_dot.get());
  system.tangents(0.0, z.get(), z_dot.get(), sigma, jacobian.get(), mass.get());
  const Eigen::SparseMatrix<double> M = to_sparse(mass.get());
  DirectSolver solver("modes_", [&system, sigma](Mat matrix) {
    return scale_by_role(system, matrix, sigma);
  });
  solver.factor(jacobian.get());
  const Eigen::Index d = subspace.degrees_of_freedom();
  Eigen::MatrixXd states = subspace.basis(0.0, 1e-3 / sigma);
  states.rightCols(d) *= sigma;
  Eigen::MatrixXd shapes;
  std::vector<Eigen::MatrixXd> eta{subspace.coordinates_of(states)};
  for (int image = 0; image < 2; ++image) {
    states = M * states;
    solver.solve(states);
    states *= sigma;
    if (image == 0) shapes = states;
    eta.push_back(subspace.coordinates_of(states));
  }
  Eigen::MatrixXd first(2 * d, 2 * d);
  Eigen::MatrixXd second(2 * d, 2 * d);
  first << eta[0], eta[1] - eta[0];
  second << eta[1], eta[2] - eta[1];
  const Eigen::MatrixXd map = first.partialPivLu().solve(second);
  const Eigenpairs pairs = dense_eigenpairs(map, "modes_");
  Spectrum spectrum;
  spectrum.shapes.resize(system.size(), 0);
  for (std::size_t i = 0; i < pairs.values.size(); ++i) {
    const Complex exponent = sigma * (1.0 - 1.0 / pairs.values[i]);
    if (exponent.imag() < 0.0) continue;
    spectrum.exponents.push_back(exponent);
    spectrum.shapes.conservativeResize(system.size(), spectrum.shapes.cols() + 1);
    spectrum.shapes.col(spectrum.shapes.cols() - 1) =
        shapes * pairs.vectors.col(static_cast<Eigen::Index>(i));
  }
  return spectrum;
}

/// Geometric mean of the exponents that are not zero: the shift that serves all best.
double middle_of(const Spectrum& spectrum, double fallback) {
  double sum = 0.0;
  int count = 0;
  for (const Complex& exponent : spectrum.exponents) {
    if (std::abs(exponent) < zero_exponent * fallback) continue;
    sum += std::log(std::abs(exponent));
    ++count;
  }
  return count > 0 ? std::exp(sum / count) : fallback;
}

/// Distance to the nearest exponent of another spectrum, relative to the larger of itself and
/// `zero`.
double distance(Complex exponent, const Spectrum& other, double zero) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Complex& candidate : other.exponents)
    nearest = std::min(nearest, std::abs(candidate - exponent));
  return nearest / std::max(std::abs(exponent), zero);
}

}  // namespace

ModeSet find_constant_modes(const system::PeriodicSystem& system,
                            const PeriodicSolution& solution) {
  require_constant(system, solution);
  const ConsistentSubspace subspace(system, solution);
  const double speed = system.period() > 0.0 ? 2.0 * std::numbers::pi / system.period() : 0.0;
  const double rate = speed > 0.0 ? speed : 1.0;
  const double sigma = middle_of(find_spectrum(system, solution, subspace, rate), rate);
  const Spectrum spectrum = find_spectrum(system, solution, subspace, sigma);
  const Spectrum check = find_spectrum(system, solution, subspace, check_shift * sigma);

  std::vector<std::size_t> order(spectrum.exponents.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return spectrum.exponents[a].imag() < spectrum.exponents[b].imag();
  });
  const std::vector<PetscInt> kinetic = kinetic_unknowns(system);
  const HarmonicEnergy energy(system, kinetic);
  ModeSet set;
  set.degrees_of_freedom = subspace.degrees_of_freedom();
  set.rotor_speed = speed;
  set.shape_times = {0.0};
  for (const std::size_t i : order) {
    Mode mode;
    const Eigen::MatrixXcd shape = spectrum.shapes.col(static_cast<Eigen::Index>(i));
    Eigen::MatrixXcd history(static_cast<Eigen::Index>(kinetic.size()), 1);
    for (std::size_t k = 0; k < kinetic.size(); ++k)
      history(static_cast<Eigen::Index>(k), 0) = shape(kinetic[k], 0);
    Eigen::VectorXd participation;
    energy.identify(history, mode, participation);
    std::stable_sort(mode.parts.begin(), mode.parts.end(),
                     [](const PartShare& a, const PartShare& b) { return a.share > b.share; });
    mode.exponent = spectrum.exponents[i];
    const double zero = std::max(zero_exponent * rate, zero_to_shift * sigma);
    if (std::abs(mode.exponent) < zero) mode.exponent = 0.0;
    mode.residual = mode.exponent == 0.0 ? 0.0 : distance(mode.exponent, check, zero);
    mode.resolved = mode.residual <= largest_difference;
    const double size = std::abs(mode.exponent);
    mode.damping_ratio = size > 0.0 ? -mode.exponent.real() / size : 0.0;
    set.modes.push_back(mode);
    set.shapes.push_back(shape);
  }
  label_modes(system, set);
  scale_shapes(system, set);
  return set;
}

}  // namespace samara::analysis
