#include "samara/linear/azimuth_series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "samara/base/error.hpp"

namespace samara::linear {
namespace {

/// Places of the comparison, as fractions of a revolution; each is moved midway between two
/// azimuths.
constexpr std::array<double, AzimuthSeries::comparisons> places{0.05, 0.33, 0.58, 0.81};

void add(StateSpace& sum, double factor, const StateSpace& form) {
  for (const auto& [name, matrix, row, column] : state_space_parts) {
    Eigen::MatrixXd& target = sum.*matrix;
    if (target.size() == 0) target.setZero((form.*matrix).rows(), (form.*matrix).cols());
    target += factor * (form.*matrix);
  }
}

/// Relative to the largest entry of a column: a row that is smaller everywhere is round-off.
constexpr double least_row = 1e-6;
/// Relative to the largest entry of a matrix: entries smaller throughout row and column are
/// round-off.
constexpr double round_off = 1e-12;

/// Largest modulus of each entry over all azimuths.
StateSpace largest_of(const std::vector<StateSpace>& samples) {
  StateSpace largest = samples.front();
  for (const auto& [name, matrix, row, column] : state_space_parts) {
    Eigen::MatrixXd& target = largest.*matrix;
    for (const StateSpace& sample : samples)
      target = target.cwiseAbs().cwiseMax((sample.*matrix).cwiseAbs());
  }
  return largest;
}

/// Largest difference of two forms. The difference of an entry is relative to the geometric mean of
/// the largest entries of its row and of its column at any azimuth, so that units have no effect.
/// Entries of D (direct effect of inputs) count only above the round-off of the effect through the
/// states.
double compare(const StateSpace& found, const StateSpace& wanted, const StateSpace& largest) {
  double worst = 0.0;
  const double rate = std::sqrt(std::max(1.0, largest.A.size() > 0 ? largest.A.maxCoeff() : 0.0));
  for (const auto& [name, matrix, row, column] : state_space_parts) {
    const Eigen::MatrixXd& reference = wanted.*matrix;
    if (reference.size() == 0) continue;
    const Eigen::VectorXd rows = (largest.*matrix).rowwise().maxCoeff();
    const Eigen::RowVectorXd columns = (largest.*matrix).colwise().maxCoeff();
    const bool is_direct = matrix == &StateSpace::D && largest.A.size() > 0;
    for (Eigen::Index i = 0; i < reference.rows(); ++i)
      for (Eigen::Index j = 0; j < reference.cols(); ++j) {
        const double size = std::max(std::sqrt(rows(i) * columns(j)), least_row * columns(j));
        double least = round_off * rows.maxCoeff();
        if (is_direct)
          least = std::max(
              least, round_off * largest.C.row(i).maxCoeff() * largest.B.col(j).maxCoeff() / rate);
        const double difference = std::abs((found.*matrix)(i, j) - reference(i, j));
        if (size > least) worst = std::max(worst, difference / size);
      }
  }
  return worst;
}

}  // namespace

AzimuthSeries::AzimuthSeries(const std::function<StateSpace(double)>& form, int azimuths,
                             int harmonics) {
  if (harmonics < 0 || azimuths < 2 * harmonics + 1)
    throw InternalError("a series has more harmonics than its azimuths resolve");
  constexpr double turn = 2.0 * std::numbers::pi;
  for (int i = 0; i < azimuths; ++i) {
    azimuths_.push_back(turn * i / azimuths);
    samples_.push_back(form(azimuths_.back()));
  }
  coefficients_.resize(static_cast<std::size_t>(2 * harmonics + 1));
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    add(coefficients_[0], 1.0 / azimuths, samples_[i]);
    for (int k = 1; k <= harmonics; ++k) {
      const auto at = static_cast<std::size_t>(2 * k - 1);
      add(coefficients_[at], 2.0 / azimuths * std::cos(k * azimuths_[i]), samples_[i]);
      add(coefficients_[at + 1], 2.0 / azimuths * std::sin(k * azimuths_[i]), samples_[i]);
    }
  }
  const StateSpace largest = largest_of(samples_);
  for (const double place : places) {
    if (azimuths == 1 && harmonics == 0 && place != places.front()) break;
    const double psi = turn * (std::floor(place * azimuths) + 0.5) / azimuths;
    residual_ = std::max(residual_, compare(at(psi), form(psi), largest));
  }
}

namespace {

constexpr int first_azimuths = 12;
/// A residual below the first value that twice as many azimuths do not reduce by the second one is
/// round-off of the matrices. From the third value on, a residual that two doublings in turn have
/// not reduced is final; fewer azimuths may miss a short change.
constexpr double largest_round_off = 1e-7;
constexpr double least_reduction = 0.5;
constexpr int seeing_azimuths = 96;
/// Part of the tolerance that harmonics may take which are left out.
constexpr double part_of_tail = 0.1;

}  // namespace

AzimuthSeries AzimuthSeries::resolve(const std::function<StateSpace(double)>& form,
                                     const SeriesResolution& resolution,
                                     const std::function<void(int)>& begin) {
  const bool all = resolution.automatic_harmonics;
  int azimuths = resolution.azimuths;
  if (resolution.automatic_azimuths) {
    azimuths = first_azimuths;
    while (!all && azimuths < 2 * resolution.harmonics + 1) azimuths *= 2;
  }
  bool was_reduced = true;
  for (double before = std::numeric_limits<double>::infinity();; azimuths *= 2) {
    begin(azimuths);
    const int resolved = (azimuths - 1) / 2;
    AzimuthSeries series(form, azimuths, all ? resolved : std::min(resolved, resolution.harmonics));
    const double residual = series.residual();
    const bool is_reduced = !(residual > least_reduction * before);
    const bool is_least = !is_reduced && (residual <= largest_round_off ||
                                          (!was_reduced && azimuths >= seeing_azimuths));
    was_reduced = is_reduced;
    before = residual;
    const bool is_enough = !resolution.automatic_azimuths || residual <= resolution.tolerance ||
                           is_least || 2 * azimuths > most_azimuths;
    if (!is_enough) continue;
    const int harmonics =
        all ? series.harmonics_above(part_of_tail * resolution.tolerance) : series.harmonics();
    if (harmonics < series.harmonics()) return {form, azimuths, harmonics};
    return series;
  }
}

int AzimuthSeries::harmonics_above(double limit) const {
  const StateSpace largest = largest_of(samples_);
  StateSpace zero;
  add(zero, 0.0, largest);
  int harmonics = this->harmonics();
  for (double sum = 0.0; harmonics > 0; --harmonics) {
    const auto cosine = static_cast<std::size_t>(2 * harmonics - 1);
    sum += compare(coefficients_[cosine], zero, largest) +
           compare(coefficients_[cosine + 1], zero, largest);
    if (sum > limit) break;
  }
  return harmonics;
}

StateSpace AzimuthSeries::at(double psi) const {
  StateSpace sum = coefficients_.front();
  for (int k = 1; k <= harmonics(); ++k) {
    const auto i = static_cast<std::size_t>(2 * k - 1);
    add(sum, std::cos(k * psi), coefficients_[i]);
    add(sum, std::sin(k * psi), coefficients_[i + 1]);
  }
  return sum;
}

Eigen::MatrixXd AzimuthSeries::state_matrix(double psi) const {
  Eigen::MatrixXd sum = mean().A;
  for (int k = 1; k <= harmonics(); ++k) {
    const auto i = static_cast<std::size_t>(2 * k - 1);
    sum += std::cos(k * psi) * coefficients_[i].A + std::sin(k * psi) * coefficients_[i + 1].A;
  }
  return sum;
}

double AzimuthSeries::variation() const {
  double worst = 0.0;
  if (samples_.empty()) return worst;
  const StateSpace largest = largest_of(samples_);
  for (const StateSpace& sample : samples_)
    worst = std::max(worst, compare(mean(), sample, largest));
  return worst;
}

}  // namespace samara::linear
