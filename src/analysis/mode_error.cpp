#include "samara/analysis/mode_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "samara/analysis/identification.hpp"

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
/// Relative to the rotor speed: a larger exponent is not the zero of a shift in time. And the
/// distance, relative to this exponent, of others that have its error.
constexpr double largest_shift = 0.05;
constexpr double next_to_shift = 30.0;
constexpr double beyond_zero = 1.01;
/// Largest |lambda| dt of a resolved mode, by stage.
constexpr double phase_of_a_stage = 1.4;
constexpr int most_steps = 30;
constexpr double settled = 1e-15;

/// Coefficients of the numerator of the diagonal Pade approximants of exp, by power.
using PadeNumerator = std::array<double, 4>;
constexpr std::array<PadeNumerator, 3> numerators{{{1.0, 1.0 / 2.0, 0.0, 0.0},
                                                   {1.0, 1.0 / 2.0, 1.0 / 12.0, 0.0},
                                                   {1.0, 1.0 / 2.0, 1.0 / 10.0, 1.0 / 120.0}}};

std::pair<std::complex<double>, std::complex<double>> value_and_slope(
    const PadeNumerator& coefficients, std::complex<double> x) {
  const auto& [c0, c1, c2, c3] = coefficients;
  return {c0 + x * (c1 + x * (c2 + x * c3)), c1 + x * (2.0 * c2 + x * 3.0 * c3)};
}

}  // namespace

double TimeRule::reach() const { return phase_of_a_stage * 0.5 * order / step; }

bool TimeRule::may_reach(std::complex<double> s) const {
  // R(i x) = N(i x) / N(-i x) has twice the phase of N(i x); R(x) grows with x up to there.
  const double x = reach() * step;
  const PadeNumerator& numerator = numerators[static_cast<std::size_t>(order / 2 - 1)];
  const double phase = 2.0 * std::arg(value_and_slope(numerator, {0.0, x}).first);
  const double decay = std::log(value_and_slope(numerator, x).first.real() /
                                std::abs(value_and_slope(numerator, -x).first.real()));
  return std::abs(s.imag()) * step <= (phase > 0.0 ? phase : phase + 2.0 * std::numbers::pi) &&
         std::abs(s.real()) * step <= decay;
}

std::complex<double> unwarped(std::complex<double> s, const TimeRule& rule) {
  const std::complex<double> w = rule.step * s;
  if (rule.order == 2) return 2.0 / rule.step * std::tanh(0.5 * w);
  if (!rule.may_reach(s)) return s;
  // N(x) = exp(w) N(-x) with the numerator N of R, times exp(-w/2); by Newton's method from x = w.
  const PadeNumerator& numerator = numerators[static_cast<std::size_t>(rule.order / 2 - 1)];
  const std::complex<double> root = std::exp(0.5 * w);
  std::complex<double> x = w;
  for (int step = 0; step < most_steps; ++step) {
    const auto [above, above_slope] = value_and_slope(numerator, x);
    const auto [below, below_slope] = value_and_slope(numerator, -x);
    const std::complex<double> change =
        (above / root - below * root) / (above_slope / root + below_slope * root);
    x -= change;
    if (std::abs(change) <= settled * std::abs(x)) break;
  }
  return x / rule.step;
}

WarpingSpread warping_spread(std::complex<double> principal, const Eigen::RowVectorXd& shares,
                             int first, int harmonic, double speed, const TimeRule& rule) {
  const auto change = [&](int k) {
    const std::complex<double> s = principal + std::complex<double>(0.0, k * speed);
    if (rule.order > 2 && !rule.may_reach(s)) return s;  // not resolved: wrong by its own size
    return unwarped(s, rule) - s;
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

Eigen::Vector2d find_mesh_error(const system::PeriodicSystem& system,
                                const std::vector<system::MeshError>& elements, const Mode& mode,
                                const Eigen::MatrixXcd& shape) {
  const double energy_of_mode = std::max(mode.kinetic_energy, strain_energy_of(system, shape));
  if (!(energy_of_mode > 0.0)) return Eigen::Vector2d::Zero();
  double energy = 0.0;
  double between = 0.0;
  for (const system::MeshError& element : elements) {
    const Eigen::MatrixXd signals = element.constant + std::abs(mode.exponent) * element.rate;
    const Eigen::MatrixXcd values = shape(element.unknowns, Eigen::all);
    energy += 0.5 * (signals * values).squaredNorm();
    between += 0.5 * values.conjugate().cwiseProduct(element.remainder * values).sum().real();
  }
  between = std::abs(between);
  return mesh_safety / (2.0 * energy_of_mode * static_cast<double>(shape.cols())) *
         Eigen::Vector2d(energy + between,
                         growing_part * energy + growing_part_of_tables * between);
}

void set_growth_error(Mode& mode, const WarpingSpread& spread, std::complex<double> principal,
                      double condition) {
  const double size = std::abs(mode.exponent);
  const double coupled = condition > 1.0 ? std::sqrt(1.0 - 1.0 / (condition * condition)) : 0.0;
  mode.growth_error = spread.growth + (growing_part + coupled) * spread.modulus +
                      size * std::max(mode.round_off_error, least_round_off);
  // A multiplier of one belongs to a motion that nothing restores, or to the same motion shifted in
  // time. The error by the step may split it in any direction.
  if (std::abs(principal) < several * spread.modulus)
    mode.growth_error = std::max(mode.growth_error, several * spread.modulus);
}

std::vector<PetscInt> find_shifts_in_time(const system::PeriodicSystem& system) {
  std::vector<PetscInt> unknowns;
  if (!system.constraints_are_autonomous()) return unknowns;
  for (const system::UnconstrainedCoordinate& coordinate : system.unconstrained_coordinates())
    if (system.unknowns()[static_cast<std::size_t>(coordinate.unknown)].frame ==
        system::Frame::rotating)
      unknowns.push_back(coordinate.unknown);
  return unknowns;
}

void take_shift_in_time(const system::PeriodicSystem& system, ModeSet& set) {
  if (find_shifts_in_time(system).empty() || !(set.rotor_speed > 0.0)) return;
  const auto size_of = [&set](const Mode& mode) {
    return std::hypot(mode.exponent.real(), std::remainder(mode.exponent.imag(), set.rotor_speed));
  };
  Mode* shift = nullptr;
  for (Mode& mode : set.modes)
    if (mode.resolved && !mode.state &&
        (shift == nullptr || std::abs(mode.exponent) < std::abs(shift->exponent)))
      shift = &mode;
  if (shift == nullptr || std::abs(shift->exponent) > largest_shift * set.rotor_speed) return;
  const double distance = std::abs(shift->exponent);
  for (Mode& mode : set.modes)
    if (&mode != shift && size_of(mode) < next_to_shift * distance) mode.growth_error += distance;
  shift->growth_error = std::max(shift->growth_error, beyond_zero * distance);
}

/// The elements of a mesh describe motions; the states of a medium have no such error.
void add_mesh_error(Mode& mode, const Eigen::Vector2d& relative) {
  if (is_of_medium(mode)) return;
  mode.mesh_error = relative(0);
  mode.mesh_growth_error = relative(1) * std::abs(mode.exponent);
  mode.growth_error += mode.mesh_growth_error;
}

}  // namespace samara::analysis
