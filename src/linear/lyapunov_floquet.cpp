#include "samara/linear/lyapunov_floquet.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <sstream>

#include <Eigen/LU>
#include <unsupported/Eigen/MatrixFunctions>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/base/error.hpp"

#include "ordered_schur.hpp"

namespace samara::linear {
namespace {

/// Relative to the sum of squares of first-order states: a smaller motion is round-off.
constexpr double no_motion = 1e-20;

using analysis::exponential;
using analysis::multiply;
using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

constexpr double turn = 2.0 * std::numbers::pi;
constexpr Complex imaginary{0.0, 1.0};

/// Least multiplier. The monodromy matrix has too few digits for modes that decay to less.
constexpr double least_multiplier = 1e-4;
/// Relative; smaller differences are round-off.
constexpr double round_off = 1e-9;
/// Relative difference below which two multipliers stay in one block.
constexpr double same_multiplier = 1e-6;
/// The same for multipliers whose modes differ by less than different_mode: round-off has split a
/// double multiplier.
constexpr double close_multiplier = 1e-3;
constexpr double different_mode = 0.03;
/// Multipliers this close to one belong to motions that nothing restores. Round-off splits several
/// of them by more than same_multiplier; they stay in one block.
constexpr double neutral_multiplier = 1e-3;
/// Largest change of an exponent by half the steps, relative to the larger of exponent and rotor
/// speed.
constexpr double resolved = 1e-4;

MatrixXcd small_exponential(const MatrixXcd& matrix) {
  if (matrix.rows() == 1) return MatrixXcd::Constant(1, 1, std::exp(matrix(0, 0)));
  return matrix.exp();
}

MatrixXcd small_logarithm(const MatrixXcd& matrix) {
  if (matrix.rows() == 1) return MatrixXcd::Constant(1, 1, std::log(matrix(0, 0)));
  return matrix.log();
}

Complex mean_of(const MatrixXcd& matrix) {
  return matrix.trace() / static_cast<double>(matrix.rows());
}

bool are_close(Complex a, Complex b, double tolerance) {
  return std::abs(a - b) < tolerance * std::max(std::abs(a), std::abs(b));
}

/// True where the multipliers a and b of the diagonal belong together.
bool are_one(const Schur& whole, Complex a, Complex b) {
  if (are_close(a, b, same_multiplier)) return true;
  if (are_close(a, 1.0, neutral_multiplier) && are_close(b, 1.0, neutral_multiplier)) return true;
  if (!are_close(a, b, close_multiplier)) return false;
  Schur schur = whole;
  bring_forward(schur, [a, b](Complex value) {
    return are_close(value, a, round_off) || are_close(value, b, round_off);
  });
  // The second eigenvector of (t11 t12; 0 t22) is (t12/(t22 - t11), 1).
  return std::abs(schur.T(1, 1) - schur.T(0, 0)) < different_mode * std::abs(schur.T(0, 1));
}

/// Groups of multipliers that belong together, directly or through others of the group.
std::vector<std::vector<Complex>> group(const Schur& whole) {
  std::vector<std::vector<Complex>> groups;
  for (const Complex value : whole.T.diagonal()) {
    if (std::abs(value) < least_multiplier) continue;
    std::vector<Complex> joined{value};
    std::erase_if(groups, [&](const std::vector<Complex>& old) {
      const bool is_close = std::ranges::any_of(
          old, [&whole, value](Complex one) { return are_one(whole, one, value); });
      if (is_close) joined.insert(joined.end(), old.begin(), old.end());
      return is_close;
    });
    groups.push_back(joined);
  }
  return groups;
}

}  // namespace

double LyapunovFloquet::Block::modulus() const { return std::abs(mean_of(exponent)); }

int LyapunovFloquet::Block::states() const {
  return static_cast<int>(exponent.rows()) * (kind == Kind::positive ? 1 : 2);
}

LyapunovFloquet::LyapunovFloquet(const AzimuthSeries& series, double rotor_speed, int azimuths,
                                 int states, int steps, int first_order)
    : series_(series),
      speed_(rotor_speed),
      intervals_(std::max(azimuths, 1)),
      steps_(2 * ((steps / 2 + intervals_ - 1) / intervals_)),
      positions_((series.mean().A.rows() - first_order) / 2),
      scale_(series.mean().A.rows()) {
  // Rates of positions are divided by about the highest frequency: none is then much larger than
  // one.
  const double rate =
      std::sqrt(series.mean().A.block(positions_, 0, positions_, positions_).norm());
  scale_ << Eigen::VectorXd::Ones(positions_),
      Eigen::VectorXd::Constant(positions_, std::max(rate, speed_)),
      Eigen::VectorXd::Ones(first_order);
  MatrixXd monodromy = MatrixXd::Identity(scale_.size(), scale_.size());
  MatrixXd coarse = monodromy;
  for (int i = 0; i < intervals_; ++i) {
    const double from = turn * i / intervals_;
    const double to = turn * (i + 1) / intervals_;
    const MatrixXd phi = propagate(from, to, steps_);
    propagators_.push_back(unscaled(phi));
    monodromy = multiply(phi, monodromy);
    coarse = multiply(propagate(from, to, steps_ / 2), coarse);
  }
  find_blocks(monodromy, coarse);
  select(states);
  name_states();
}

/// Phi(to, from) in scaled states, by two exponentials a step: fourth order, and exact where A does
/// not change (S. Blanes and P. C. Moan, Appl. Numer. Math. 56 (2006), 1519-1537).
MatrixXd LyapunovFloquet::propagate(double from, double to, int count) const {
  const double place = std::sqrt(3.0) / 6.0;  // of the Gauss points from the middle
  const double near = 0.25 + place;
  const double far = 0.25 - place;
  const double width = (to - from) / count;
  MatrixXd phi = MatrixXd::Identity(scale_.size(), scale_.size());
  if (width == 0.0) return phi;
  const auto scaled = [this](double psi) {
    return MatrixXd(scale_.cwiseInverse().asDiagonal() * series_.state_matrix(psi) *
                    scale_.asDiagonal());
  };
  for (int i = 0; i < count; ++i) {
    const double middle = from + (i + 0.5) * width;
    const MatrixXd first = width / speed_ * scaled(middle - place * width);
    const MatrixXd second = width / speed_ * scaled(middle + place * width);
    const MatrixXd begin = exponential(near * first + far * second);
    const MatrixXd end = exponential(far * first + near * second);
    phi = multiply(end, multiply(begin, phi));
  }
  return phi;
}

MatrixXd LyapunovFloquet::unscaled(const MatrixXd& phi) const {
  return scale_.asDiagonal() * phi * scale_.cwiseInverse().asDiagonal();
}

void LyapunovFloquet::find_blocks(const MatrixXd& monodromy, const MatrixXd& coarse) {
  const Schur whole = schur_of(monodromy);
  const double period = turn / speed_;
  for (const std::vector<Complex>& values : group(whole)) {
    Complex mean = 0.0;
    for (const Complex value : values) mean += value / static_cast<double>(values.size());
    const bool is_real = std::abs(mean.imag()) < 0.5 * same_multiplier * std::abs(mean);
    if (!is_real && mean.imag() < 0.0) continue;  // contained in the block of its conjugate
    Schur schur = whole;
    const Index count = bring_forward(schur, [&values](Complex value) {
      return std::ranges::any_of(values,
                                 [value](Complex one) { return are_close(one, value, round_off); });
    });
    Block block;
    MatrixXcd V = schur.U.leftCols(count);
    MatrixXcd W =
        V.adjoint() - parting(schur.T, count) * schur.U.rightCols(schur.U.cols() - count).adjoint();
    if (is_real) V = real_basis(V).cast<Complex>();
    W = (W * V).partialPivLu().solve(W);
    if (is_real) W = W.real().cast<Complex>();
    const MatrixXcd multiplier = W * monodromy.cast<Complex>() * V;
    const MatrixXcd change = W * (monodromy - coarse).cast<Complex>() * V;
    if (is_real) {
      block.kind = mean.real() > 0.0 ? Block::Kind::positive : Block::Kind::negative;
      const double sign = mean.real() > 0.0 ? 1.0 : -1.0;
      block.exponent = small_logarithm(sign * multiplier) / period;
      if (sign < 0.0) block.exponent.diagonal().array() += 0.5 * imaginary * speed_;
    } else {
      block.exponent = small_logarithm(multiplier) / period;
    }
    block.V.push_back(scale_.asDiagonal() * V);
    block.W.push_back(W * scale_.cwiseInverse().asDiagonal());
    follow(block);
    if (block.kind == Block::Kind::pair) choose_branch(block);
    choose_scale(block);
    block.error = std::abs(mean_of(multiplier.partialPivLu().solve(change))) / period /
                  std::max(block.modulus(), speed_);
    blocks_.push_back(block);
  }
  std::ranges::stable_sort(blocks_, {}, &Block::modulus);
}

/// Integrates V forward and W backward over the revolution; both grow by round-off only.
void LyapunovFloquet::follow(Block& block) const {
  const MatrixXcd back = small_exponential(-turn / speed_ / intervals_ * block.exponent);
  for (const MatrixXd& phi : propagators_) block.V.push_back(phi * block.V.back() * back);
  block.W.resize(propagators_.size() + 1);
  block.W.back() = block.W.front();
  for (std::size_t i = propagators_.size(); i-- > 1;)
    block.W[i] = back * block.W[i + 1] * propagators_[i];
}

/// Exponents are known up to multiples of i Omega. The one nearest to the mean frequency of the
/// motion is taken: P then changes least.
void LyapunovFloquet::choose_branch(Block& block) const {
  double turning = 0.0;
  double size = 0.0;
  double states = 0.0;
  for (int i = 0; i < intervals_; ++i) {
    const MatrixXcd& V = block.V[static_cast<std::size_t>(i)];
    turning +=
        (V.topRows(positions_).conjugate().array() * V.middleRows(positions_, positions_).array())
            .sum()
            .imag();
    size += V.topRows(positions_).squaredNorm();
    states += V.bottomRows(V.rows() - 2 * positions_).squaredNorm();
  }
  // First-order states alone have no motion with a mean frequency.
  const double shift = size > no_motion * states
                           ? std::round((turning / size - mean_of(block.exponent).imag()) / speed_)
                           : 0.0;
  block.exponent.diagonal().array() += imaginary * shift * speed_;
  for (int i = 0; i <= intervals_; ++i) {
    const Complex phase = std::exp(-imaginary * shift * (turn * i / intervals_));
    block.V[static_cast<std::size_t>(i)] *= phase;
    block.W[static_cast<std::size_t>(i)] /= phase;
  }
  if (mean_of(block.exponent).imag() >= 0.0) return;
  block.exponent = block.exponent.conjugate().eval();
  for (MatrixXcd& V : block.V) V = V.conjugate().eval();
  for (MatrixXcd& W : block.W) W = W.conjugate().eval();
}

/// Scales V so that its largest entry over the revolution is one; rates do not count.
void LyapunovFloquet::choose_scale(Block& block) const {
  Complex largest = 0.0;
  for (const MatrixXcd& V : block.V)
    for (Index i = 0; i < V.rows(); ++i) {
      if (i >= positions_ && i < 2 * positions_) continue;
      for (const Complex entry : V.row(i))
        if (std::abs(entry) > std::abs(largest)) largest = entry;
    }
  if (block.kind == Block::Kind::positive) largest = largest.real();
  for (MatrixXcd& V : block.V) V /= largest;
  for (MatrixXcd& W : block.W) W *= largest;
}

/// Keeps the slowest of the resolved blocks.
void LyapunovFloquet::select(int states) {
  std::vector<Block> kept;
  int count = 0;
  int unresolved = 0;
  const Block* first = nullptr;  // the slowest of these
  const Block* next = nullptr;   // the slowest that exceeds `states`
  for (const Block& block : blocks_) {
    if (states > 0 && count + block.states() > states) {
      next = &block;
      break;
    }
    if (block.error < resolved) {
      count += block.states();
      kept.push_back(block);
    } else {
      first = first == nullptr ? &block : first;
      unresolved += block.states();
    }
  }
  std::ostringstream text;
  text << "lyapunov_floquet has " << count << " of " << scale_.size() << " states";
  if (first != nullptr)
    text << "; " << unresolved << " are not resolved, the slowest of them, at " << first->modulus()
         << " rad/s, has an error of " << first->error << " of its exponent; hint: more "
         << "linearize.lyapunov_floquet_steps";
  if (next == nullptr && count + unresolved < scale_.size())
    text << "; modes that decay to less than " << least_multiplier
         << " in a revolution are left out";
  if (count == 0 && next != nullptr)
    text << "; hint: the slowest motion has " << next->states() << " states";
  const bool is_short = next == nullptr && count + 1 < states;
  if (count == 0 || is_short) throw InputError("linearize.lyapunov_floquet_states: " + text.str());
  if (first != nullptr || (states == 0 && count < scale_.size())) remark_ = text.str();
  blocks_ = std::move(kept);
}

void LyapunovFloquet::name_states() {
  int all = 0;
  for (const Block& block : blocks_) all += block.states();
  exponents_ = MatrixXd::Zero(all, all);
  Index first = 0;
  int mode = 0;
  for (const Block& block : blocks_) {
    const Index m = block.exponent.rows();
    const bool is_real = block.kind == Block::Kind::positive;
    exponents_.block(first, first, m, m) = block.exponent.real();
    if (!is_real) {
      exponents_.block(first, first + m, m, m) = -block.exponent.imag();
      exponents_.block(first + m, first, m, m) = block.exponent.imag();
      exponents_.block(first + m, first + m, m, m) = block.exponent.real();
    }
    for (const char* part : {"", " imaginary"}) {
      if (is_real && *part != '\0') continue;
      for (Index i = 0; i < m; ++i)
        states_.push_back({"mode " + std::to_string(mode + 1 + static_cast<int>(i)) +
                               (is_real      ? ""
                                : *part == 0 ? " real"
                                             : part),
                           "1", 1.0});
    }
    first += block.states();
    mode += static_cast<int>(m);
  }
}

LyapunovFloquet::Frame LyapunovFloquet::frame_at(double psi) const {
  const double width = turn / intervals_;
  psi -= turn * std::floor(psi / turn);
  const double place = psi / width;
  const bool is_end = std::abs(place - std::round(place)) < round_off;
  const auto at = static_cast<std::size_t>(is_end ? std::fmod(std::round(place), intervals_)
                                                  : std::floor(place));
  const double from = is_end ? psi : width * static_cast<double>(at);
  const MatrixXd before = unscaled(propagate(from, psi, steps_));
  const MatrixXd behind =
      is_end ? propagators_[at] : unscaled(propagate(psi, from + width, steps_));
  std::vector<MatrixXcd> V;
  std::vector<MatrixXcd> W;
  for (const Block& block : blocks_) {
    V.push_back(before * block.V[at] * small_exponential(-(psi - from) / speed_ * block.exponent));
    W.push_back(small_exponential(-(from + width - psi) / speed_ * block.exponent) *
                block.W[at + 1] * behind);
  }
  orthogonalize(V, W);
  Frame frame{MatrixXd(scale_.size(), exponents_.rows()),
              MatrixXd(exponents_.rows(), scale_.size())};
  Index first = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    const Index m = block.exponent.rows();
    const double factor = block.kind == Block::Kind::pair ? 2.0 : 1.0;
    frame.P.middleCols(first, m) = factor * V[b].real();
    frame.Q.middleRows(first, m) = W[b].real();
    if (block.kind != Block::Kind::positive) {
      frame.P.middleCols(first + m, m) = -factor * V[b].imag();
      frame.Q.middleRows(first + m, m) = W[b].imag();
    }
    first += block.states();
  }
  return frame;
}

/// Makes W V = 1 exact for all blocks together; the steps keep it up to their error only.
void LyapunovFloquet::orthogonalize(const std::vector<MatrixXcd>& V,
                                    std::vector<MatrixXcd>& W) const {
  Index count = 0;
  for (std::size_t b = 0; b < V.size(); ++b)
    count += V[b].cols() * (blocks_[b].kind == Block::Kind::pair ? 2 : 1);
  MatrixXcd columns(scale_.size(), count);
  MatrixXcd rows(count, scale_.size());
  Index at = 0;
  for (std::size_t b = 0; b < V.size(); ++b) {
    const Index m = V[b].cols();
    const bool is_pair = blocks_[b].kind == Block::Kind::pair;
    columns.middleCols(at, m) = V[b];
    rows.middleRows(at, m) = W[b];
    if (is_pair) {
      columns.middleCols(at + m, m) = V[b].conjugate();
      rows.middleRows(at + m, m) = W[b].conjugate();
    }
    at += is_pair ? 2 * m : m;
  }
  rows = (rows * columns).partialPivLu().solve(rows).eval();
  at = 0;
  for (std::size_t b = 0; b < V.size(); ++b) {
    const Index m = V[b].cols();
    W[b] = rows.middleRows(at, m);
    at += blocks_[b].kind == Block::Kind::pair ? 2 * m : m;
  }
}

StateSpace LyapunovFloquet::transformation(double psi) const {
  const Frame frame = frame_at(psi);
  return {exponents_, frame.Q, frame.P, MatrixXd::Zero(scale_.size(), scale_.size())};
}

/// Omitted modes respond quasi-statically, with A at this azimuth: 0 = A x + B u in their space.
StateSpace LyapunovFloquet::form(double psi, const StateSpace& map) const {
  const MatrixXd& Q = map.B;
  const MatrixXd& P = map.C;
  const StateSpace form = series_.at(psi);
  const MatrixXd kept = multiply(P, Q);
  MatrixXd direct = form.D;
  const bool is_whole = kept.trace() > static_cast<double>(kept.rows()) - 0.5;
  if (!is_whole) {
    const MatrixXd rest = MatrixXd::Identity(kept.rows(), kept.cols()) - kept;
    const Eigen::VectorXd units = scale_.cwiseInverse();
    const MatrixXd A = multiply(rest, multiply(form.A, rest)) + speed_ * kept;
    const MatrixXd scaled = units.asDiagonal() * A * scale_.asDiagonal();
    const MatrixXd input = units.asDiagonal() * multiply(rest, form.B);
    direct -= form.C * multiply(rest, scale_.asDiagonal() * scaled.partialPivLu().solve(input));
  }
  return {exponents_, Q * form.B, form.C * P, direct};
}

}  // namespace samara::linear
