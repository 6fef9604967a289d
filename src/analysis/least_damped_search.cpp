#include "least_damped_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

#include <Eigen/QR>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/analysis/mode.hpp"
#include "samara/base/error.hpp"

#include "sector_motion.hpp"

namespace samara::analysis {
namespace {

using Complex = std::complex<double>;
using Index = Eigen::Index;

constexpr int order = 5;
/// Residual of a multiplier, relative. The motions are refined afterwards.
constexpr double tolerance = 1e-5;
/// Columns of a block: factor of the number of multipliers that are searched, and more.
constexpr double more_columns = 1.5;
constexpr int least_more = 16;
constexpr int most_passes = 40;
/// The space has this number of blocks at most.
constexpr Index most_blocks = 5;
/// Relative to the largest column: a smaller one is round-off.
constexpr double least_column = 1e-10;
/// Approximate memory of the factors and columns of a step, and the largest one of all steps.
constexpr double bytes_of_entry = 700.0;
constexpr double bytes_of_unknown = 5000.0;
constexpr double most_bytes = 2.0 * 1024 * 1024 * 1024;
/// Multipliers below this are round-off beside the largest ones.
constexpr double least_multiplier = 1e-6;
/// Frequencies at which the damping of the steps is taken.
constexpr int region_points = 200;
/// Error of the inverted damping of a step, relative to this damping.
constexpr double error_of_damping = 0.2;
/// Largest modulus of an exponent times the step, of a motion that the steps resolve.
constexpr double most_radians = 2.0;
/// Factors of the number of steps from one attempt to the next.
constexpr double step_margin = 1.1;
constexpr double least_increase = 1.2;
constexpr double most_increase = 3.0;
constexpr double usual_increase = 1.5;
/// Part of the damping of the steps in a decay for which more steps help.
constexpr double largest_damping = 0.2;

/// R(w), the factor of a step of Radau IIA with three stages for z' = (w / dt) z, and its
/// derivative.
std::pair<Complex, Complex> step_factor(Complex w) {
  const Complex above = 1.0 + w * (0.4 + w / 20.0);
  const Complex below = 1.0 + w * (-0.6 + w * (0.15 - w / 60.0));
  const Complex slope_above = 0.4 + w / 10.0;
  const Complex slope_below = -0.6 + w * (0.3 - w / 20.0);
  return {above / below, (slope_above * below - above * slope_below) / (below * below)};
}

Eigen::MatrixXd random_columns(Index rows, Index columns) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(generator); });
}

/// An orthonormal basis of the columns, those aside that are less than `least` away from the
/// others.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns, double least) {
  if (columns.cols() == 0) return columns;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::ArrayXd pivots = qr.matrixR().diagonal().array().abs();
  const Index rank = std::ranges::count_if(pivots, [&](double pivot) { return pivot > least; });
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), rank);
}

/// An orthonormal basis of what the columns add to an orthonormal one.
Eigen::MatrixXd orthonormal_to(const Eigen::MatrixXd& basis, Eigen::MatrixXd columns) {
  double least = least_column * columns.norm();
  for (int repeat = 0; repeat < 2; ++repeat) {
    columns -= multiply(basis, multiply(basis.transpose(), columns));
    columns = orthonormal(columns, least);
    // The columns have the length 1 now; what they have of the basis is round-off / least_column.
    least = 0.5;
  }
  return columns;
}

void append(const Eigen::MatrixXd& columns, Eigen::MatrixXd& to) {
  to.conservativeResize(columns.rows(), to.cols() + columns.cols());
  to.rightCols(columns.cols()) = columns;
}

}  // namespace

/// Eigenpairs of the map on a space with an orthonormal basis, by descending modulus.
struct LeastDampedSearch::Ritz {
  std::vector<Complex> values;
  Eigen::MatrixXcd vectors;  ///< in the basis
  int converged = 0;         ///< of the first ones
  bool is_exhausted = false;

  Ritz() = default;
  Ritz(const Eigen::MatrixXd& basis, const Eigen::MatrixXd& images, int count) {
    const Eigen::MatrixXd small = multiply(basis.transpose(), images);
    const Eigenpairs pairs = dense_eigenpairs(small, "floquet_");
    std::vector<Index> order_of(pairs.values.size());
    std::iota(order_of.begin(), order_of.end(), 0);
    std::ranges::stable_sort(order_of, [&](Index a, Index b) {
      return std::abs(pairs.values[static_cast<std::size_t>(a)]) >
             std::abs(pairs.values[static_cast<std::size_t>(b)]);
    });
    for (const Index i : order_of) values.push_back(pairs.values[static_cast<std::size_t>(i)]);
    vectors = pairs.vectors(Eigen::all, order_of);
    const Index wanted = std::min<Index>(count + 1, vectors.cols());
    const Eigen::MatrixXcd first = vectors.leftCols(wanted);
    const Eigen::MatrixXd of_images = multiply(images, real_and_imaginary(first));
    const Eigen::MatrixXd of_basis = multiply(basis, real_and_imaginary(first));
    for (; converged < wanted; ++converged) {
      const Complex value = values[static_cast<std::size_t>(converged)];
      is_exhausted = std::abs(value) < least_multiplier * std::abs(values.front());
      if (is_exhausted) break;
      const Eigen::VectorXcd residual =
          part(of_images, converged) - value * part(of_basis, converged);
      if (residual.norm() > tolerance * std::abs(value)) break;
    }
    if (converged == vectors.cols()) is_exhausted = true;
    // Both of a pair.
    if (converged > 0 && converged < vectors.cols() &&
        std::abs(values[static_cast<std::size_t>(converged) - 1] -
                 std::conj(values[static_cast<std::size_t>(converged)])) == 0.0 &&
        values[static_cast<std::size_t>(converged)].imag() < 0.0)
      --converged;
  }

  static Eigen::VectorXcd part(const Eigen::MatrixXd& joined_columns, Index column) {
    return joined_columns.col(2 * column) + Complex(0.0, 1.0) * joined_columns.col(2 * column + 1);
  }

  /// An orthonormal basis of the first eigenvectors, at least `count` real columns.
  Eigen::MatrixXd leading(Index count) const {
    return orthonormal(real_and_imaginary(vectors.leftCols(std::min(count + 1, vectors.cols()))),
                       least_column);
  }
};

LeastDampedSearch::LeastDampedSearch(const system::PeriodicSystem& system,
                                     const PeriodicSolution& solution, int steps)
    : system_(system),
      sectors_(system.symmetry().sectors),
      steps_(steps / sectors_),
      dt_(system.period() / steps),
      speed_(2.0 * std::numbers::pi / system.period()),
      subspace_(system, solution) {
  find_weights();
  std::size_t entries = 0;
  for (const std::vector<PetscInt>& row : system.pattern()) entries += row.size();
  const double bytes = static_cast<double>(entries) * bytes_of_entry +
                       static_cast<double>(system.size()) * bytes_of_unknown;
  const long kept = static_cast<double>(steps_) * bytes < most_bytes ? steps_ : 1;
  for (long k = 0; k < kept; ++k)
    kept_.push_back(std::make_unique<CollocationStep>(system, solution, subspace_, order, dt_));
}

/// Diagonal approximation of the energy: the map of a system without damping is nearly orthogonal,
/// and its multipliers are not sensitive to round-off.
void LeastDampedSearch::find_weights() {
  const auto n = static_cast<std::size_t>(system_.size());
  std::vector<double> squares(n, 0.0);
  for (const system::EnergyGroup& group : system_.energy_groups())
    for (std::size_t i = 0; i < group.unknowns.size(); ++i)
      squares[static_cast<std::size_t>(group.unknowns[i])] +=
          std::abs(group.weight[i * (group.unknowns.size() + 1)]);
  for (const system::Motion& motion : system_.motions())
    for (std::size_t i = 0; i < motion.unknowns.size(); ++i)
      squares[static_cast<std::size_t>(motion.unknowns[i])] += speed_ * speed_ * motion.weight[i];
  // Unknowns without energy have the mean weight of their role.
  const auto role = [this](std::size_t i) {
    return static_cast<std::size_t>(system_.unknowns()[i].role);
  };
  std::vector<double> sums;
  std::vector<int> counts;
  for (std::size_t i = 0; i < n; ++i) {
    if (role(i) >= sums.size()) sums.resize(role(i) + 1, 0.0);
    counts.resize(sums.size(), 0);
    if (!(squares[i] > 0.0)) continue;
    const double scale = system_.unknowns()[i].scale;
    sums[role(i)] += std::log(squares[i] * scale * scale);
    ++counts[role(i)];
  }
  weights_.resize(system_.size());
  for (std::size_t i = 0; i < n; ++i) {
    const double scale = system_.unknowns()[i].scale;
    const double mean = counts[role(i)] > 0 ? std::exp(sums[role(i)] / counts[role(i)]) : 1.0;
    weights_(static_cast<Index>(i)) =
        !subspace_.carried()[i] ? 0.0
                                : std::sqrt(squares[i] > 0.0 ? squares[i] : mean / (scale * scale));
  }
  inverse_weights_ = (weights_ > 0.0).select(1.0 / weights_, Eigen::ArrayXd::Zero(weights_.size()));
}

/// The map, of columns times weights_.
Eigen::MatrixXd LeastDampedSearch::image_of(const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd z = columns.array().colwise() * inverse_weights_;
  for (long k = 0; k < steps_; ++k) step(k).advance(k, z);
  if (sectors_ > 1) z = turned(system_.symmetry(), z);
  return z.array().colwise() * weights_;
}

/// By Rayleigh and Ritz's method on a block Krylov space. Residuals extend the space, until it is
/// cut back to its leading part.
void LeastDampedSearch::find(int count) {
  const auto states = static_cast<int>(subspace_.size());
  const int block =
      std::min(states, std::max(static_cast<int>(more_columns * count), count + least_more));
  Eigen::MatrixXd next =
      random_columns(system_.size(), block).array().colwise() * (weights_ > 0.0).cast<double>();
  Eigen::MatrixXd basis(next.rows(), 0);
  next = orthonormal_to(basis, image_of(next));  // consistent states
  Eigen::MatrixXd images(next.rows(), 0);
  Ritz ritz;
  for (int pass = 1; next.cols() > 0; ++pass) {
    append(image_of(next), images);
    append(next, basis);
    ritz = Ritz(basis, images, count);
    if (ritz.converged >= count || ritz.is_exhausted || pass == most_passes) break;
    Eigen::MatrixXd leading = ritz.leading(block);
    if (basis.cols() + leading.cols() > most_blocks * block) {
      basis = multiply(basis, leading);
      images = multiply(images, leading);
      leading.setIdentity(basis.cols(), basis.cols());
    }
    next = orthonormal_to(basis, multiply(images, leading));
  }
  is_exhausted_ = ritz.is_exhausted || next.cols() == 0;
  exponents_.clear();
  if (ritz.converged == 0)
    throw ConvergenceError("floquet.least_damped: no multiplier converges; hint: floquet.modes");
  std::vector<Index> chosen;
  const double sector = system_.period() / sectors_;
  for (Index i = 0; i < ritz.converged; ++i) {
    const Complex value = ritz.values[static_cast<std::size_t>(i)];
    if (value.imag() < 0.0) continue;
    exponents_.push_back(std::log(value) / sector);
    chosen.push_back(i);
  }
  const double least = is_exhausted_
                           ? least_multiplier * std::abs(ritz.values.front())
                           : std::abs(ritz.values[static_cast<std::size_t>(ritz.converged) - 1]);
  decay_ = -std::log(least) / sector;
  make_shapes(multiply(basis, real_and_imaginary(ritz.vectors(Eigen::all, chosen))));
}

/// Motions at equal distances over a sector. Several instants of a step tell fast motions from slow
/// ones, which the ends of steps do not.
void LeastDampedSearch::make_shapes(const Eigen::MatrixXd& vectors) {
  Eigen::MatrixXd z = vectors.array().colwise() * inverse_weights_;
  const Index n = z.rows();
  shapes_.resize(n * steps_ * samples_of_step, z.cols());
  Eigen::MatrixXd values;
  Index row = 0;
  for (long k = 0; k < steps_; ++k) {
    step(k).advance(k, z);
    for (long i = 0; i < samples_of_step; ++i, row += n) {
      step(k).sample((static_cast<double>(i) + 0.5) / samples_of_step, values);
      shapes_.middleRows(row, n) = values;
    }
  }
}

double LeastDampedSearch::time_of(Index sample) const {
  return (static_cast<double>(sample) + 0.5) * dt_ / samples_of_step;
}

Eigen::MatrixXcd LeastDampedSearch::shape(std::size_t number) const {
  const SectorMotion motion{shapes_.col(static_cast<Index>(2 * number)).data(), system_.size(),
                            steps_ * samples_of_step, time_of(0), dt_ / samples_of_step};
  return shape_over_period(system_.symmetry(), sectors_, motion, exponents_[number]);
}

HillPair LeastDampedSearch::pair(std::size_t number, const Eigen::MatrixXcd& shape, int shift,
                                 int harmonics) const {
  Eigen::MatrixXcd waves(samples(), 2 * harmonics + 1);
  for (Index k = 0; k < samples(); ++k)
    for (int h = -harmonics; h <= harmonics; ++h)
      waves(k, h + harmonics) =
          std::polar(1.0 / static_cast<double>(samples()), -(h + shift) * speed_ * time_of(k));
  return {exponents_[number] + Complex(0.0, shift * speed_), waves.transpose() * shape.transpose()};
}

/// Exponent from that of the steps, for constant coefficients. Not a number where there is none.
Complex LeastDampedSearch::exact(Complex of_steps) const {
  constexpr int most_corrections = 30;
  constexpr double accuracy = 1e-12;
  const Complex factor = std::exp(of_steps * dt_);
  Complex w = of_steps * dt_;
  for (int i = 0; i < most_corrections; ++i) {
    const auto [value, slope] = step_factor(w);
    const Complex change = (value - factor) / slope;
    w -= change;
    if (std::abs(change) < accuracy * (1.0 + std::abs(w))) return w / dt_;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// Decay of the steps of a motion with this exponent, for constant coefficients [1/s].
double LeastDampedSearch::decay_of_steps(Complex exponent) const {
  return -std::log(std::abs(step_factor(exponent * dt_).first)) / dt_;
}

/// Largest frequency [rad/s] up to which all motions with a decay of at most `decay` were found.
double LeastDampedSearch::highest_frequency(double decay, double margin) const {
  const double top = most_radians / dt_;
  double found = 0.0;
  for (int i = 0; i <= region_points; ++i) {
    const double frequency = top * i / region_points;
    if (decay_of_steps({-decay, frequency}) > decay_) break;
    found = frequency;
  }
  return found - margin;
}

LeastDampedSearch::Region LeastDampedSearch::region_of(const std::vector<Complex>& exponents,
                                                       int wanted, double margin) const {
  struct Estimate {
    std::size_t motion;
    Complex exponent;
    double error;    ///< of the decay
    double radians;  ///< modulus times the step
  };
  std::vector<Estimate> estimates;
  const double of_multiplier = tolerance * sectors_ / system_.period();
  for (std::size_t i = 0; i < exponents.size(); ++i) {
    const Complex exponent = exact(exponents[i]);
    if (!std::isfinite(exponent.real())) continue;
    const double damping = std::abs(exponents[i].real() - exponent.real());
    estimates.push_back({i, exponent, error_of_damping * damping + of_multiplier,
                         std::max(std::abs(exponent), std::abs(exponents[i])) * dt_});
  }
  std::ranges::stable_sort(estimates, {}, [](const Estimate& one) { return -one.exponent.real(); });
  Region region;
  double slowest = 0.0;  // decay of the last one, or the largest growth
  double last_decay = 0.0;
  double error = 0.0;
  bool is_too_fast = false;  // for the steps
  int taken = 0;
  for (const Estimate& last : estimates) {
    if (last.radians > most_radians) continue;
    ++taken;
    last_decay = -last.exponent.real();
    slowest = std::max(slowest, std::abs(last_decay));
    error = std::max(error, last.error);
    Region next;
    next.decay = slowest + 2.0 * error + zero_exponent * speed_;
    next.high = highest_frequency(next.decay + error, margin);
    for (const Estimate& one : estimates) {
      if (std::abs(one.exponent.imag()) > next.high) continue;
      if (-one.exponent.real() <= next.decay + one.error) next.motions.push_back(one.motion);
      if (-one.exponent.real() <= next.decay - one.error) ++next.certain;
    }
    if (next.certain > region.certain) region = next;
    const double damping = decay_of_steps({-next.decay, most_radians / dt_}) - next.decay;
    is_too_fast = next.high < most_radians / dt_ - margin && damping > largest_damping * decay_;
    if (region.certain >= wanted) break;
  }
  const bool is_complete = region.certain >= wanted;
  // Motions beyond the range that may be wanted. Without damping all of them may.
  const bool are_told_apart = last_decay > error;
  double longest = 0.0;
  for (const Estimate& one : estimates) {
    const double rate = one.exponent.real();
    const bool may_be_slower =
        (are_told_apart && -rate - one.error < last_decay) || rate > one.error + error;
    if (std::abs(one.exponent.imag()) > region.high &&
        (is_complete ? may_be_slower : taken < wanted))
      longest = std::max(longest, one.radians);
  }
  if (longest > 0.0)
    region.more_steps = std::clamp(step_margin * (longest + margin * dt_) / most_radians,
                                   least_increase, most_increase);
  else if (!is_complete && is_too_fast)
    region.more_steps = usual_increase;
  return region;
}

}  // namespace samara::analysis
