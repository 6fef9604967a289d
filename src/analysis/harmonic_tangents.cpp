#include "harmonic_tangents.hpp"

#include <algorithm>
#include <complex>
#include <numbers>
#include <numeric>
#include <string>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/base/error.hpp"

#include "matrix_entries.hpp"

namespace samara::analysis {
namespace {

constexpr int samples_at_once = 8;

HarmonicTangents::Pattern pattern_of(const system::PeriodicSystem& system,
                                     const HarmonicTangents::Coordinates& held) {
  std::vector<std::vector<PetscInt>> rows = system.pattern();
  if (rows.empty()) {  // the system does not declare a pattern
    std::vector<PetscInt> all(static_cast<std::size_t>(system.size()));
    std::iota(all.begin(), all.end(), PetscInt{0});
    rows.assign(all.size(), all);
  }
  std::vector<Eigen::Triplet<double, PetscInt>> places;
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (const PetscInt j : rows[i]) places.emplace_back(static_cast<PetscInt>(i), j, 1.0);
  // The load that holds a coordinate stands in the place of its mean.
  for (const system::UnconstrainedCoordinate& coordinate : held)
    places.emplace_back(coordinate.row, coordinate.unknown, 1.0);
  HarmonicTangents::Pattern pattern(system.size(), system.size());
  pattern.setFromTriplets(places.begin(), places.end());
  return pattern;
}

PetscInt block_size_of(Mat matrix) {
  PetscBool is_blocked = PETSC_FALSE;
  PetscInt size = 1;
  petsc::check(
      PetscObjectTypeCompare(reinterpret_cast<PetscObject>(matrix), MATSEQBAIJ, &is_blocked));
  if (is_blocked != PETSC_FALSE) petsc::check(MatGetBlockSize(matrix, &size));
  return size;
}

}  // namespace

int sample_count(int harmonics) { return 4 * harmonics + 2; }

Eigen::VectorXd fourier_weights(int harmonics, double period, double t) {
  Eigen::VectorXd weights = PeriodicSolution::basis(harmonics, period, t);
  weights *= 2.0 / sample_count(harmonics);
  weights(0) *= 0.5;
  return weights;
}

HarmonicTangents::HarmonicTangents(const system::PeriodicSystem& system, const Coordinates& held,
                                   int harmonics)
    : system_(system),
      held_(held),
      harmonics_(harmonics),
      width_(2 * harmonics + 1),
      size_(static_cast<Eigen::Index>(system.size())),
      block_size_(block_size_of(system.make_jacobian().get())),
      pattern_(pattern_of(system, held)) {
  const int samples = sample_count(harmonics);
  values_of_.resize(samples, width_);
  rates_of_.resize(samples, width_);
  projection_.resize(width_, samples);
  to_coefficients_.resize(2 * width_ - 1, samples);
  for (int k = 0; k < samples; ++k) {
    const double t = period() * k / samples;
    values_of_.row(k) = PeriodicSolution::basis(harmonics, period(), t);
    rates_of_.row(k) = PeriodicSolution::basis_rate(harmonics, period(), t);
    projection_.col(k) = fourier_weights(harmonics, period(), t);
    for (int m = 1 - width_; m < width_; ++m)
      to_coefficients_(m + width_ - 1, k) =
          std::polar(1.0 / samples, -2.0 * std::numbers::pi * m * k / samples);
  }
  sampled_.resize(2 * samples, pattern_.nonZeros());
  for (PetscInt i = 0; i < static_cast<PetscInt>(size_); ++i)
    for (PetscInt e = pattern_.outerIndexPtr()[i]; e < pattern_.outerIndexPtr()[i + 1]; ++e)
      places_.push_back({i, pattern_.innerIndexPtr()[e], e});
}

bool HarmonicTangents::is_held(PetscInt unknown) const {
  return std::any_of(held_.begin(), held_.end(),
                     [unknown](const auto& coordinate) { return coordinate.unknown == unknown; });
}

bool HarmonicTangents::holds(PetscInt row, PetscInt unknown) const {
  return std::any_of(held_.begin(), held_.end(), [row, unknown](const auto& coordinate) {
    return coordinate.unknown == unknown && coordinate.row == row;
  });
}

void HarmonicTangents::sample(const PeriodicSolution& solution) {
  const petsc::Handle<Vec> z = system_.make_state();
  const petsc::Handle<Vec> z_dot = system_.make_state();
  const petsc::Handle<Mat> jacobian = system_.make_jacobian();
  const petsc::Handle<Mat> mass = system_.make_mass();
  const int samples = sample_count(harmonics_);
  std::vector<PetscInt> jacobian_places;
  std::vector<PetscInt> mass_places;
  // The samples of a place are next to each other in memory: some at a time are written.
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(pattern_.nonZeros(), samples_at_once);
  Eigen::MatrixXd M = K;
  for (int first = 0; first < samples; first += samples_at_once) {
    const int count = std::min(samples_at_once, samples - first);
    for (int n = 0; n < count; ++n) {
      const double t = system_.period() * (first + n) / samples;
      solution.evaluate(t, z.get(), z_dot.get());
      system_.tangents(t, z.get(), z_dot.get(), 0.0, jacobian.get(), mass.get());
      if (jacobian_places.empty()) {
        jacobian_places = places_of(jacobian.get());
        mass_places = places_of(mass.get());
      }
      take_entries(jacobian.get(), jacobian_places, K.col(n));
      take_entries(mass.get(), mass_places, M.col(n));
    }
    sampled_.middleRows(first, count) = K.leftCols(count).transpose();
    sampled_.middleRows(samples + first, count) = M.leftCols(count).transpose();
  }
}

std::vector<PetscInt> HarmonicTangents::places_of(Mat tangent) const {
  std::vector<PetscInt> places;
  MatrixEntries(tangent).for_each([&](PetscInt i, PetscInt j, PetscScalar&) {
    const PetscInt* first = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[i];
    const PetscInt* last = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[i + 1];
    const PetscInt* found = std::lower_bound(first, last, j);
    const bool is_there = found != last && *found == j;
    places.push_back(is_there ? static_cast<PetscInt>(found - pattern_.innerIndexPtr()) : -1);
  });
  return places;
}

void HarmonicTangents::take_entries(Mat tangent, const std::vector<PetscInt>& places,
                                    Eigen::Ref<Eigen::VectorXd> sample) const {
  MatrixEntries entries(tangent);
  const PetscScalar* values = entries.values();
  for (std::size_t n = 0; n < places.size(); ++n)
    if (places[n] >= 0)
      sample(places[n]) = values[n];
    else if (values[n] != 0.0)
      entries.for_each([&](PetscInt i, PetscInt j, PetscScalar& value) {
        if (&value == values + n)
          throw InternalError("row " + std::to_string(i) +
                              " of the tangents has an entry in column " + std::to_string(j) +
                              ", outside their pattern");
      });
}

void HarmonicTangents::multiply(const std::vector<Place>& places, const double* x,
                                double* y) const {
  const Eigen::Index samples = values_of_.rows();
  Eigen::MatrixXd coefficients = Eigen::Map<const Eigen::MatrixXd>(x, width_, size_);
  for (const system::UnconstrainedCoordinate& coordinate : held_)
    coefficients(0, coordinate.unknown) = 0.0;
  const Eigen::MatrixXd values = values_of_ * coefficients;
  const Eigen::MatrixXd rates = rates_of_ * coefficients;
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(samples, size_);
  for (const Place& place : places) {
    const auto sampled = sampled_.col(place.number).array();
    sums.col(place.row).array() += sampled.head(samples) * values.col(place.column).array() +
                                   sampled.tail(samples) * rates.col(place.column).array();
  }
  Eigen::Map<Eigen::MatrixXd> result(y, width_, size_);
  result.noalias() = projection_ * sums;
  for (const system::UnconstrainedCoordinate& coordinate : held_)
    result(0, coordinate.row) += x[coordinate.unknown * width_];
}

void HarmonicTangents::multiply_mass(const double* x, double* y) const {
  const Eigen::Index samples = values_of_.rows();
  const Eigen::MatrixXd values =
      values_of_ * Eigen::Map<const Eigen::MatrixXd>(x, width_, size_);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(samples, size_);
  for (const Place& place : places_)
    sums.col(place.row).array() += sampled_.col(place.number).tail(samples).array() *
                                   values.col(place.column).array();
  Eigen::Map<Eigen::MatrixXd>(y, width_, size_).noalias() = projection_ * sums;
}

HarmonicTangents::Coefficients HarmonicTangents::coefficients(const Place& place) const {
  const Eigen::Index samples = values_of_.rows();
  const auto sampled = sampled_.col(place.number);
  return {to_coefficients_ * sampled.head(samples), to_coefficients_ * sampled.tail(samples)};
}

Eigen::MatrixXd HarmonicTangents::means() const {
  const Eigen::Index samples = values_of_.rows();
  Eigen::MatrixXd means(2, sampled_.cols());
  means.row(0) = sampled_.topRows(samples).colwise().mean();
  means.row(1) = sampled_.bottomRows(samples).colwise().mean();
  return means;
}

double HarmonicTangents::rate() const { return 2.0 * std::numbers::pi / period(); }

void HarmonicTangents::scale(double loads, Eigen::VectorXd& rows, Eigen::VectorXd& columns) const {
  const Eigen::Index samples = values_of_.rows();
  const double rate = harmonics_ > 0 ? 2.0 * std::numbers::pi * harmonics_ / period() : 1.0;
  Pattern sizes = pattern_;
  for (Eigen::Index e = 0; e < sizes.nonZeros(); ++e)
    sizes.valuePtr()[e] = sampled_.col(e).head(samples).lpNorm<Eigen::Infinity>() +
                          rate * sampled_.col(e).tail(samples).lpNorm<Eigen::Infinity>();
  const Equilibration scaling =
      scaling_by_role(system_, Eigen::SparseMatrix<double>(sizes), rate, loads);
  const petsc::ReadView row_factors(scaling.rows.get());
  const petsc::ReadView column_factors(scaling.columns.get());
  rows.resize(size_ * width_);
  columns.resize(size_ * width_);
  for (Eigen::Index i = 0; i < size_; ++i) {
    rows.segment(i * width_, width_).setConstant(row_factors[static_cast<PetscInt>(i)]);
    columns.segment(i * width_, width_).setConstant(column_factors[static_cast<PetscInt>(i)]);
  }
  for (const system::UnconstrainedCoordinate& coordinate : held_)
    columns(coordinate.unknown * width_) = 1.0 / rows(coordinate.row * width_);
}

petsc::Handle<Mat> HarmonicTangents::make_matrix() const {
  std::vector<PetscInt> begin{0};
  std::vector<PetscInt> columns;
  for (Eigen::Index i = 0; i < size_; ++i)
    for (int row = 0; row < width_; ++row) {
      for (Pattern::InnerIterator it(pattern_, i); it; ++it)
        for (int c = 0; c < width_; ++c)
          columns.push_back(static_cast<PetscInt>(it.col()) * width_ + c);
      begin.push_back(static_cast<PetscInt>(columns.size()));
    }
  const auto n = static_cast<PetscInt>(size_ * width_);
  petsc::Handle<Mat> matrix;
  petsc::check(MatCreate(PETSC_COMM_SELF, matrix.fill()));
  petsc::check(MatSetSizes(matrix.get(), n, n, n, n));
  petsc::check(MatSetType(matrix.get(), MATSEQAIJ));
  petsc::check(MatSeqAIJSetPreallocationCSR(matrix.get(), begin.data(), columns.data(), nullptr));
  return matrix;
}

void HarmonicTangents::fill(Mat matrix) const {
  const Eigen::Index samples = values_of_.rows();
  // From the samples of an entry of K and M to its block, row by row.
  Eigen::MatrixXd to_block(width_ * width_, 2 * samples);
  for (Eigen::Index k = 0; k < samples; ++k) {
    const Eigen::MatrixXd by_value = values_of_.row(k).transpose() * projection_.col(k).transpose();
    const Eigen::MatrixXd by_rate = rates_of_.row(k).transpose() * projection_.col(k).transpose();
    to_block.col(k) = Eigen::Map<const Eigen::VectorXd>(by_value.data(), by_value.size());
    to_block.col(samples + k) = Eigen::Map<const Eigen::VectorXd>(by_rate.data(), by_rate.size());
  }
  const Eigen::MatrixXd blocks = analysis::multiply(to_block, sampled_);
  PetscScalar* values = nullptr;
  petsc::check(MatSeqAIJGetArrayWrite(matrix, &values));
  PetscScalar* next = values;  // in the order of make_matrix
  for (Eigen::Index i = 0; i < size_; ++i) {
    const PetscInt first = pattern_.outerIndexPtr()[i];
    const PetscInt last = pattern_.outerIndexPtr()[i + 1];
    for (int row = 0; row < width_; ++row)
      for (PetscInt e = first; e < last; ++e) {
        const PetscInt unknown = pattern_.innerIndexPtr()[e];
        next = std::copy_n(&blocks(row * width_, e), width_, next);
        if (is_held(unknown))
          *(next - width_) = holds(static_cast<PetscInt>(i), unknown) && row == 0 ? 1.0 : 0.0;
      }
  }
  petsc::check(MatSeqAIJRestoreArrayWrite(matrix, &values));
  petsc::check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
}

}  // namespace samara::analysis
