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
/// Place of an entry of rows or unknowns that are not in the map.
constexpr PetscInt left_out = -2;

/// Whether an unknown has no meaning but to fill up a block.
bool fills_up(const system::Unknown& unknown) { return unknown.quantity.empty(); }

}  // namespace

int sample_count(const system::PeriodicSystem& system, int harmonics) {
  const int least = system::has_medium(system.unknowns()) ? 6 * harmonics + 4 : 4 * harmonics + 2;
  const int sectors = system.symmetry().sectors;
  return (least + sectors - 1) / sectors * sectors;
}

Eigen::VectorXd fourier_weights(int harmonics, double period, double t, int samples) {
  Eigen::VectorXd weights = PeriodicSolution::basis(harmonics, period, t);
  weights *= 2.0 / samples;
  weights(0) *= 0.5;
  return weights;
}

HarmonicTangents::HarmonicTangents(const system::PeriodicSystem& system, int harmonics,
                                   bool by_sector)
    : system_(system),
      harmonics_(harmonics),
      width_(2 * harmonics + 1),
      size_(static_cast<Eigen::Index>(system.size())),
      block_size_(block_size_of(system)) {
  kept_.resize(static_cast<std::size_t>(size_));
  std::iota(kept_.begin(), kept_.end(), 0);
  number_ = kept_;
  remainder_.assign(kept_.size(), every);
  TangentPattern whole = find_pattern(system, {});
  if (by_sector) find_sectors(whole);
  mark_border(find_border(whole, block_size_, {}));
  make_map(whole);
}

HarmonicTangents::HarmonicTangents(const MeshPartition& partition, const Coordinates& held,
                                   int harmonics)
    : system_(partition.system()),
      partition_(partition.is_distributed() ? &partition : nullptr),
      harmonics_(harmonics),
      width_(2 * harmonics + 1),
      block_size_(partition.block_size()),
      kept_(partition.kept()) {
  remainder_.assign(kept_.size(), every);
  for (PetscInt i = 0; i < static_cast<PetscInt>(system_.size()); ++i)
    number_.push_back(partition.number_of(i));
  TangentPattern whole = find_pattern(system_, held);
  mark_border(partition.is_distributed() ? partition.border()
                                         : find_border(whole, block_size_, held));
  make_map(whole);
  for (const system::UnconstrainedCoordinate& coordinate : held) {
    held_.push_back(coordinate);
    held_.back().unknown = partition.number_of(coordinate.unknown);
    held_.back().row = partition.number_of(coordinate.row);
  }
}

/// Takes the places of the unknowns that are kept from the pattern of all, which has no meaning
/// afterwards.
void HarmonicTangents::make_map(TangentPattern& whole) {
  size_ = static_cast<Eigen::Index>(kept_.size());
  if (size_ == whole.rows()) {
    pattern_.swap(whole);
  } else {
    std::vector<Eigen::Triplet<double, PetscInt>> places;
    for (PetscInt i = 0; i < static_cast<PetscInt>(kept_.size()); ++i)
      for (TangentPattern::InnerIterator it(whole, kept_[static_cast<std::size_t>(i)]); it; ++it)
        if (const PetscInt j = number_[static_cast<std::size_t>(it.col())]; j >= 0)
          places.emplace_back(i, j, 1.0);
    pattern_.resize(size_, size_);
    pattern_.setFromTriplets(places.begin(), places.end());
  }
  const int samples = sample_count(system_, harmonics_);
  values_of_.resize(samples, width_);
  projection_.resize(width_, samples);
  to_series_.resize(2 * width_, samples);
  for (int k = 0; k < samples; ++k) {
    const double t = period() * k / samples;
    values_of_.row(k) = PeriodicSolution::basis(harmonics_, period(), t);
    projection_.col(k) = fourier_weights(harmonics_, period(), t, samples);
    for (int m = 0; m < width_; ++m) {
      const double angle = 2.0 * std::numbers::pi * m * k / samples;
      to_series_(m, k) = std::cos(angle) / samples;
      to_series_(width_ + m, k) = -std::sin(angle) / samples;
    }
  }
  sampled_.resize(2 * samples, pattern_.nonZeros());
  for (PetscInt i = 0; i < static_cast<PetscInt>(size_); ++i)
    for (PetscInt e = pattern_.outerIndexPtr()[i]; e < pattern_.outerIndexPtr()[i + 1]; ++e)
      places_.push_back({i, pattern_.innerIndexPtr()[e], e});
}

/// Keeps the unknowns of the first blade and those that P does not move. All blades stay in the map
/// where a row of the first blade refers to another blade.
void HarmonicTangents::find_sectors(const TangentPattern& whole) {
  const system::RotorSymmetry& symmetry = system_.symmetry();
  if (symmetry.sectors < 2) return;
  const auto size = static_cast<PetscInt>(symmetry.source.size());
  std::vector<PetscInt> leader(symmetry.source.size());  // the same unknown of the first blade
  std::vector<char> is_moved(symmetry.source.size(), 0);
  for (PetscInt i = 0; i < size; ++i) {
    const auto at = static_cast<std::size_t>(i);
    int length = 1;
    double sign = symmetry.sign[at];
    leader[at] = i;
    for (PetscInt j = symmetry.source[at]; j != i;
         j = symmetry.source[static_cast<std::size_t>(j)]) {
      ++length;
      leader[at] = std::min(leader[at], j);
      sign *= symmetry.sign[static_cast<std::size_t>(j)];
    }
    const bool is_known =
        length == symmetry.sectors || (length == 1 && (sign == 1.0 || symmetry.sectors % 2 == 0));
    if (!is_known || (length > 1 && sign != 1.0)) return;
    is_moved[at] = length > 1 ? 1 : 0;
  }
  // What fills up the blocks of a blade goes with them.
  for (PetscInt first = 0; first < size; first += block_size_) {
    int moved = 0;
    int kept = 0;
    int filling = 0;
    for (PetscInt i = first; i < first + block_size_; ++i) {
      const auto at = static_cast<std::size_t>(i);
      moved += is_moved[at];
      kept += is_moved[at] && leader[at] == i ? 1 : 0;
      filling += fills_up(system_.unknowns()[at]) ? 1 : 0;
    }
    if (moved + filling != block_size_ || (kept != 0 && kept != moved)) continue;
    for (PetscInt i = first; i < first + block_size_; ++i)
      if (const auto at = static_cast<std::size_t>(i); !is_moved[at]) {
        is_moved[at] = 1;
        leader[at] = kept > 0 ? i : -1;
      }
  }
  std::vector<PetscInt> kept;
  std::vector<PetscInt> number(symmetry.source.size(), -1);
  std::vector<int> remainder;
  for (PetscInt i = 0; i < size; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (leader[at] != i) continue;
    number[at] = static_cast<PetscInt>(kept.size());
    kept.push_back(i);
    remainder.push_back(is_moved[at] ? every
                                     : (symmetry.sign[at] > 0.0 ? 0 : symmetry.sectors / 2));
  }
  for (std::size_t i = 0; i < kept.size(); ++i)
    for (TangentPattern::InnerIterator it(whole, kept[i]); it && remainder[i] == every; ++it)
      if (number[static_cast<std::size_t>(it.col())] < 0 &&
          kept[i] / block_size_ != it.col() / block_size_)
        return;
  sectors_ = symmetry.sectors;
  kept_ = std::move(kept);
  number_ = std::move(number);
  remainder_ = std::move(remainder);
}

/// `blocks`: whether each block of the system belongs to the border. A block of which a part is
/// left out belongs to it as well.
void HarmonicTangents::mark_border(const std::vector<char>& blocks) {
  const PetscInt block = block_size_;
  for (const PetscInt i : kept_) {
    const auto own = static_cast<std::size_t>(i / block);
    const auto first = number_.begin() + static_cast<std::ptrdiff_t>(own) * block;
    is_border_.push_back(blocks[own] != 0 || std::count(first, first + block, -1) > 0 ? 1 : 0);
  }
}

/// P Z_k = exp(-2 pi i k / Q) Z_k, where (P y)_i = sign_i y_source(i).
Eigen::MatrixXcd HarmonicTangents::whole(const Eigen::MatrixXcd& series) const {
  if (sectors_ == 1) return series;
  const system::RotorSymmetry& symmetry = system_.symmetry();
  Eigen::MatrixXcd all =
      Eigen::MatrixXcd::Zero(series.rows(), static_cast<Eigen::Index>(number_.size()));
  Eigen::ArrayXcd turn(series.rows());
  const Eigen::Index harmonics = (series.rows() - 1) / 2;
  for (Eigen::Index k = -harmonics; k <= harmonics; ++k)
    turn(k + harmonics) =
        std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k % sectors_) / sectors_);
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    const PetscInt first = kept_[i];
    all.col(first) = series.col(static_cast<Eigen::Index>(i));
    for (PetscInt j = first; symmetry.source[static_cast<std::size_t>(j)] != first;) {
      const PetscInt next = symmetry.source[static_cast<std::size_t>(j)];
      all.col(next) = symmetry.sign[static_cast<std::size_t>(j)] * turn * all.col(j).array();
      j = next;
    }
  }
  return all;
}

Eigen::MatrixXcd HarmonicTangents::part(const Eigen::MatrixXcd& whole) const {
  return whole(Eigen::all, kept_);
}

bool HarmonicTangents::is_held(PetscInt unknown) const {
  return std::any_of(held_.begin(), held_.end(),
                     [unknown](const auto& coordinate) { return coordinate.unknown == unknown; });
}

bool HarmonicTangents::holds(PetscInt row, PetscInt unknown) const {
  if (partition_ != nullptr && !partition_->is_first()) return false;
  return std::any_of(held_.begin(), held_.end(), [row, unknown](const auto& coordinate) {
    return coordinate.unknown == unknown && coordinate.row == row;
  });
}

void HarmonicTangents::sample(const PeriodicSolution& solution) {
  const petsc::Handle<Vec> z = system_.make_state();
  const petsc::Handle<Vec> z_dot = system_.make_state();
  const petsc::Handle<Mat> jacobian = system_.make_jacobian();
  const petsc::Handle<Mat> mass = system_.make_mass();
  const int samples = sample_count(system_, harmonics_);
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
    if (sectors_ > 1)
      for (const Place& place : places_)
        if (!is_moved(place.row) && is_moved(place.column)) {
          K.row(place.number) *= sectors_;
          M.row(place.number) *= sectors_;
        }
    sampled_.middleRows(first, count) = K.leftCols(count).transpose();
    sampled_.middleRows(samples + first, count) = M.leftCols(count).transpose();
  }
  if (sectors_ > 1) find_followers();
}

/// An unknown that is not moved and that no other row refers to, such as the component of a
/// velocity in axes of the rotor, only follows the others. It has all harmonics if its row has no
/// blade, and not its own rate.
void HarmonicTangents::find_followers() {
  std::vector<char> is_used(kept_.size(), 0);
  for (const Place& place : places_) {
    const auto sampled = sampled_.col(place.number);
    if (sampled.isZero(0.0)) continue;
    if (place.row != place.column || !sampled.tail(sampled.size() / 2).isZero(0.0))
      is_used[static_cast<std::size_t>(place.column)] = 1;
    if (is_moved(place.column)) is_used[static_cast<std::size_t>(place.row)] = 1;
  }
  for (std::size_t i = 0; i < is_used.size(); ++i)
    if (!is_used[i]) remainder_[i] = every;
}

std::vector<PetscInt> HarmonicTangents::places_of(Mat tangent) const {
  std::vector<PetscInt> places;
  MatrixEntries(tangent).for_each([&](PetscInt i, PetscInt j, PetscScalar&) {
    const PetscInt row = number_[static_cast<std::size_t>(i)];
    const PetscInt column = number_[static_cast<std::size_t>(j)];
    if (row < 0 || column < 0) {
      places.push_back(left_out);
      return;
    }
    const PetscInt* first = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[row];
    const PetscInt* last = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[row + 1];
    const PetscInt* found = std::lower_bound(first, last, column);
    const bool is_there = found != last && *found == column;
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
    else if (places[n] != left_out && values[n] != 0.0)
      entries.for_each([&](PetscInt i, PetscInt j, PetscScalar& value) {
        if (&value == values + n)
          throw InternalError("row " + std::to_string(i) +
                              " of the tangents has an entry in column " + std::to_string(j) +
                              ", outside their pattern");
      });
}

void HarmonicTangents::multiply(const double* x, double* y) const {
  Eigen::MatrixXd coefficients = Eigen::Map<const Eigen::MatrixXd>(x, width_, size_);
  for (const system::UnconstrainedCoordinate& coordinate : held_)
    coefficients(0, coordinate.unknown) = 0.0;
  Eigen::MatrixXd rates = Eigen::MatrixXd::Zero(width_, size_);
  for (int k = 1; k <= harmonics_; ++k) {
    rates.row(2 * k - 1) = k * rate() * coefficients.row(2 * k);
    rates.row(2 * k) = -k * rate() * coefficients.row(2 * k - 1);
  }
  Eigen::MatrixXd result;
  multiply(coefficients, rates, result);
  if (partition_ != nullptr) partition_->sum_border(result);
  for (const system::UnconstrainedCoordinate& coordinate : held_)
    result(0, coordinate.row) += x[coordinate.unknown * width_];
  Eigen::Map<Eigen::MatrixXd>(y, width_, size_) = result;
}

void HarmonicTangents::multiply(const Eigen::MatrixXd& x, const Eigen::MatrixXd& w,
                                Eigen::MatrixXd& y) const {
  const Eigen::Index samples = values_of_.rows();
  const Eigen::MatrixXd values = values_of_ * x;
  const Eigen::MatrixXd rates = values_of_ * w;
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(samples, x.cols());
  for (const Place& place : places_) {
    const auto sampled = sampled_.col(place.number).array();
    for (Eigen::Index first = 0; first < x.cols(); first += size_)
      sums.col(first + place.row).array() +=
          sampled.head(samples) * values.col(first + place.column).array() +
          sampled.tail(samples) * rates.col(first + place.column).array();
  }
  y.noalias() = projection_ * sums;
  count_operations(2, x.cols());
  drop_absent(y);
}

void HarmonicTangents::multiply_mass(const Eigen::MatrixXd& w, Eigen::MatrixXd& y) const {
  const Eigen::Index samples = values_of_.rows();
  const Eigen::MatrixXd rates = values_of_ * w;
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(samples, w.cols());
  for (const Place& place : places_) {
    const auto sampled = sampled_.col(place.number).tail(samples).array();
    for (Eigen::Index first = 0; first < w.cols(); first += size_)
      sums.col(first + place.row).array() += sampled * rates.col(first + place.column).array();
  }
  y.noalias() = projection_ * sums;
  count_operations(1, w.cols());
  drop_absent(y);
}

/// Of products with K and M (2 parts) or M alone, for so many columns of coefficients.
void HarmonicTangents::count_operations(int parts, Eigen::Index columns) const {
  const auto samples = static_cast<double>(values_of_.rows());
  const auto entries = static_cast<double>(places_.size()) / static_cast<double>(size_);
  PetscLogFlops(2.0 * samples * static_cast<double>(columns) *
                (parts * (entries + width_) + width_));
}

void HarmonicTangents::drop_absent(Eigen::MatrixXd& rows) const {
  if (sectors_ == 1) return;
  for (Eigen::Index at = 0; at < rows.cols(); ++at) {
    const Eigen::Index i = at % size_;
    if (!has(i, 0)) rows(0, at) = 0.0;
    for (int k = 1; k <= harmonics_; ++k)
      if (!has(i, k) && !has(i, -k)) rows.col(at).segment(2 * k - 1, 2).setZero();
  }
}

Eigen::MatrixXcd HarmonicTangents::coupling(const Place& place, std::complex<double> shift) const {
  const Eigen::Index samples = values_of_.rows();
  // Fourier coefficients m = 0 ... 2 H of K and M; those of -m are conjugate to those of m.
  const Eigen::MatrixXd half =
      to_series_ * Eigen::Map<const Eigen::MatrixXd>(sampled_.col(place.number).data(), samples, 2);
  Eigen::VectorXcd stiffness(2 * width_ - 1);
  Eigen::VectorXcd mass(2 * width_ - 1);
  for (int m = 0; m < width_; ++m) {
    stiffness(width_ - 1 + m) = {half(m, 0), half(width_ + m, 0)};
    stiffness(width_ - 1 - m) = {half(m, 0), -half(width_ + m, 0)};
    mass(width_ - 1 + m) = {half(m, 1), half(width_ + m, 1)};
    mass(width_ - 1 - m) = {half(m, 1), -half(width_ + m, 1)};
  }
  Eigen::MatrixXcd block(width_, width_);
  for (int k = -harmonics_; k <= harmonics_; ++k) {
    const std::complex<double> rate = shift + std::complex<double>(0.0, k * this->rate());
    block.col(k + harmonics_) =
        stiffness.segment(harmonics_ - k, width_) + rate * mass.segment(harmonics_ - k, width_);
  }
  for (int k = -harmonics_; k <= harmonics_; ++k) {
    if (!has(place.row, k)) block.row(k + harmonics_).setZero();
    if (!has(place.column, k)) block.col(k + harmonics_).setZero();
  }
  return block;
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
  // Entries of all blades, from those of the first one.
  std::vector<Eigen::Triplet<double>> entries;
  const std::vector<PetscInt>& source = system_.symmetry().source;
  for (const Place& place : places_) {
    const auto sampled = sampled_.col(place.number);
    double entry = sampled.head(samples).lpNorm<Eigen::Infinity>() +
                   rate * sampled.tail(samples).lpNorm<Eigen::Infinity>();
    PetscInt row = kept_[static_cast<std::size_t>(place.row)];
    PetscInt column = kept_[static_cast<std::size_t>(place.column)];
    if (sectors_ > 1 && !is_moved(place.row) && is_moved(place.column)) entry /= sectors_;
    for (int q = 0; q < sectors_; ++q) {
      entries.emplace_back(row, column, entry);
      if (sectors_ == 1) break;
      row = source[static_cast<std::size_t>(row)];
      column = source[static_cast<std::size_t>(column)];
    }
  }
  Eigen::SparseMatrix<double> sizes(system_.size(), system_.size());
  sizes.setFromTriplets(entries.begin(), entries.end(),
                        [](double a, double b) { return std::max(a, b); });
  const Equilibration scaling = scaling_by_role(
      system_, sizes, rate, loads, partition_ == nullptr ? nullptr : &partition_->ranks());
  const petsc::ReadView row_factors(scaling.rows.get());
  const petsc::ReadView column_factors(scaling.columns.get());
  rows.resize(size_ * width_);
  columns.resize(size_ * width_);
  for (Eigen::Index i = 0; i < size_; ++i) {
    const PetscInt unknown = kept_[static_cast<std::size_t>(i)];
    rows.segment(i * width_, width_).setConstant(row_factors[unknown]);
    columns.segment(i * width_, width_).setConstant(column_factors[unknown]);
  }
  for (const system::UnconstrainedCoordinate& coordinate : held_)
    columns(coordinate.unknown * width_) = 1.0 / rows(coordinate.row * width_);
}

petsc::Handle<Mat> HarmonicTangents::make_matrix() const {
  std::vector<PetscInt> begin{0};
  std::vector<PetscInt> columns;
  for (Eigen::Index i = 0; i < size_; ++i)
    for (int row = 0; row < width_; ++row) {
      for (TangentPattern::InnerIterator it(pattern_, i); it; ++it)
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
  Eigen::MatrixXd rates_of(samples, width_);
  for (Eigen::Index k = 0; k < samples; ++k)
    rates_of.row(k) = PeriodicSolution::basis_rate(
        harmonics_, period(), period() * static_cast<double>(k) / static_cast<double>(samples));
  // From the samples of an entry of K and M to its block, row by row.
  Eigen::MatrixXd to_block(width_ * width_, 2 * samples);
  for (Eigen::Index k = 0; k < samples; ++k) {
    const Eigen::MatrixXd by_value = values_of_.row(k).transpose() * projection_.col(k).transpose();
    const Eigen::MatrixXd by_rate = rates_of.row(k).transpose() * projection_.col(k).transpose();
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
