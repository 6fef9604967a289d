#include "samara/analysis/mode_error.hpp"

#include <algorithm>
#include <cmath>

namespace samara::analysis {
namespace {

/// Safety factors: an estimate is the first term of the error times its factor.
constexpr double step_safety = 2.5;
constexpr double mesh_safety = 2.0;
/// Part of an exponent's error that is growth. It is small, because step and elements keep, at
/// least nearly, the symmetries that exclude growth (docs/theory.md, section 5.8).
constexpr double growing_part = 0.01;
constexpr double growing_part_of_tables = 0.05;
/// An exponent smaller than this many times its error is not distinguished from zero.
constexpr double several = 10.0;
constexpr double least_round_off = 1e-10;

}  // namespace

std::complex<double> unwarped(std::complex<double> s, double step) {
  return 2.0 / step * std::tanh(0.5 * step * s);
}

WarpingSpread warping_spread(std::complex<double> principal, const Eigen::RowVectorXd& shares,
                             int first, int harmonic, double speed, double step) {
  const auto change = [&](int k) {
    const std::complex<double> s = principal + std::complex<double>(0.0, k * speed);
    return unwarped(s, step) - s;
  };
  const std::complex<double> mapped = change(harmonic);
  WarpingSpread spread;
  for (Eigen::Index i = 0; i < shares.size(); ++i) {
    if (shares(i) == 0.0) continue;
    const std::complex<double> other = shares(i) * (change(first + static_cast<int>(i)) - mapped);
    spread.modulus += step_safety * std::abs(other);
    spread.growth += step_safety * std::abs(other.real());
  }
  return spread;
}

Eigen::Vector2d find_mesh_error(const std::vector<system::MeshError>& elements,
                                const Eigen::MatrixXcd& shape, std::complex<double> exponent,
                                double energy_of_mode) {
  if (!(energy_of_mode > 0.0)) return Eigen::Vector2d::Zero();
  double energy = 0.0;
  double between = 0.0;
  for (const system::MeshError& element : elements) {
    const Eigen::MatrixXd signals = element.constant + std::abs(exponent) * element.rate;
    const Eigen::MatrixXcd values = shape(element.unknowns, Eigen::all);
    energy += 0.5 * (signals * values).squaredNorm();
    between += 0.5 * values.conjugate().cwiseProduct(element.remainder * values).sum().real();
  }
  between = std::abs(between);
  return mesh_safety / (2.0 * energy_of_mode * static_cast<double>(shape.cols())) *
         Eigen::Vector2d(energy + between,
                         growing_part * energy + growing_part_of_tables * between);
}

void set_growth_error(Mode& mode, const WarpingSpread& spread, std::complex<double> principal) {
  const double size = std::abs(mode.exponent);
  mode.growth_error = spread.growth + growing_part * spread.modulus +
                      size * std::max(mode.round_off_error, least_round_off);
  // A multiplier of one belongs to a motion that nothing restores, or to the same motion shifted in
  // time. The error by the step may split it in any direction.
  if (std::abs(principal) < several * spread.modulus)
    mode.growth_error = std::max(mode.growth_error, several * spread.modulus);
}

void add_mesh_error(Mode& mode, const Eigen::Vector2d& relative) {
  mode.mesh_error = relative(0);
  mode.mesh_growth_error = relative(1) * std::abs(mode.exponent);
  mode.growth_error += mode.mesh_growth_error;
}

}  // namespace samara::analysis
