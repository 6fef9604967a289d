#include "harmonic_tangents.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <string>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/base/error.hpp"

#include "matrix_entries.hpp"
#include "sample_products.hpp"

namespace samara::analysis {
namespace {

constexpr int samples_at_once = 8;
/// Difference of tangents that a rotation by a sector maps to each other, relative to the largest
/// entry of the row.
constexpr double same_tangent = 1e-6;

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
                                   bool by_sector, bool may_defer)
    : system_(system),
      harmonics_(harmonics),
      width_(2 * harmonics + 1),
      block_size_(block_size_of(system)),
      sector_(static_cast<PetscInt>(system.size())) {
  TangentPattern whole = find_pattern(system, {});
  if (by_sector) sector_ = RotorSector(system, whole, block_size_);
  repeats_ = may_defer && sector_.sectors > 1;
  mark_border(find_border(whole, block_size_, {}));
  make_map(whole);
}

HarmonicTangents::HarmonicTangents(const MeshPartition& partition, const Coordinates& held,
                                   int harmonics, bool may_defer)
    : system_(partition.system()),
      partition_(partition.is_distributed() ? &partition : nullptr),
      harmonics_(harmonics),
      width_(2 * harmonics + 1),
      block_size_(partition.block_size()),
      sector_(partition.sector()),
      repeats_(may_defer && sector_.sectors > 1) {
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
  size_ = static_cast<Eigen::Index>(sector_.kept.size());
  if (size_ == whole.rows()) {
    pattern_.swap(whole);
  } else {
    std::vector<Eigen::Triplet<double, PetscInt>> places;
    for (PetscInt i = 0; i < static_cast<PetscInt>(sector_.kept.size()); ++i)
      for (TangentPattern::InnerIterator it(whole, sector_.kept[static_cast<std::size_t>(i)]); it;
           ++it)
        if (const PetscInt j = sector_.number[static_cast<std::size_t>(it.col())]; j >= 0)
          places.emplace_back(i, j, 1.0);
    pattern_.resize(size_, size_);
    pattern_.setFromTriplets(places.begin(), places.end());
  }
  samples_ = sample_count(system_, harmonics_);
  set_instants(0.0);
  for (PetscInt i = 0; i < static_cast<PetscInt>(size_); ++i)
    for (PetscInt e = pattern_.outerIndexPtr()[i]; e < pattern_.outerIndexPtr()[i + 1]; ++e)
      places_.push_back({i, pattern_.innerIndexPtr()[e], e});
}

void HarmonicTangents::set_instants(double offset) {
  offset_ = offset;
  values_of_.resize(samples(), width_);
  projection_.resize(width_, samples());
  to_series_.resize(2 * width_, samples());
  for (int k = 0; k < samples(); ++k) {
    const double t = instant(k);
    values_of_.row(k) = PeriodicSolution::basis(harmonics_, period(), t);
    projection_.col(k) = fourier_weights(harmonics_, period(), t, samples());
    for (int m = 0; m < width_; ++m) {
      const double angle = 2.0 * std::numbers::pi * m * (k + offset) / samples();
      to_series_(m, k) = std::cos(angle) / samples();
      to_series_(width_ + m, k) = -std::sin(angle) / samples();
    }
  }
}

/// `blocks`: whether each block of the system belongs to the border. A block of which a part is
/// left out belongs to it as well.
void HarmonicTangents::mark_border(const std::vector<char>& blocks) {
  const PetscInt block = block_size_;
  for (const PetscInt i : sector_.kept) {
    const auto own = static_cast<std::size_t>(i / block);
    const auto first = sector_.number.begin() + static_cast<std::ptrdiff_t>(own) * block;
    is_border_.push_back(blocks[own] != 0 || std::count(first, first + block, -1) > 0 ? 1 : 0);
  }
}

Eigen::MatrixXcd HarmonicTangents::whole(const Eigen::MatrixXcd& series) const {
  return sector_.sectors == 1 ? series : sector_.whole(system_.symmetry(), series);
}

Eigen::MatrixXcd HarmonicTangents::part(const Eigen::MatrixXcd& whole) const {
  return whole(Eigen::all, sector_.kept);
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

void HarmonicTangents::sample(const PeriodicSolution& solution, double offset) {
  if (offset != offset_) set_instants(offset);
  sampled_.resize(2 * Eigen::Index{samples()}, pattern_.nonZeros());
  const auto take = [&](int turns) {
    Eigen::MatrixXd likeness = Eigen::MatrixXd::Zero(4, size_);
    const auto work = [&] { sample_all(solution, turns, likeness); };
    if (partition_ != nullptr)
      partition_->ranks().attempt(work);
    else
      work();
    if (sector_.sectors > 1) find_followers();
    return likeness;
  };
  const std::vector<Deferred> deferred = deferred_;
  const bool repeats = repeats_;
  try {
    if (!repeats_) {
      take(1);
    } else if (!defer(unlike_rows(take(sector_.sectors)))) {
      repeats_ = false;
      deferred_.clear();
      take(1);
    }
  } catch (...) {  // the samples before remain
    deferred_ = deferred;
    repeats_ = repeats;
    sampled_.resize(0, 0);
    throw;
  }
  keep_samples();
  list_entries();
  ++samplings_;
}

/// Those of entries that are not zero throughout, in the order of their use.
void HarmonicTangents::keep_samples() {
  const Eigen::Index count = samples();
  for (const std::size_t part : {0, 1}) {
    const auto all = sampled_.middleRows(static_cast<Eigen::Index>(part) * count, count);
    Samples& kept = kept_[part];
    kept.number.assign(places_.size(), -1);
    PetscInt next = 0;
    for (std::size_t i = 0; i < kept.number.size(); ++i)
      if (!all.col(static_cast<Eigen::Index>(i)).isZero(0.0)) kept.number[i] = next++;
    kept.values.resize(count, next);
    for (std::size_t i = 0; i < kept.number.size(); ++i)
      if (kept.number[i] >= 0)
        kept.values.col(kept.number[i]) = all.col(static_cast<Eigen::Index>(i));
  }
  sampled_.resize(0, 0);
}

/// From the samples: the entries that are not zero, the means, and the series of the border.
void HarmonicTangents::list_entries() {
  for (EntriesOfBoth* both : {&all_, &of_border_}) both->fill({{0}, {}, {}});
  interior_.clear();
  std::vector<Place> of_border;
  for (const Place& place : places_) {
    const bool is_of_border = is_border(place.row) || is_border(place.column);
    bool has_values = false;
    for (const std::size_t part : {0, 1}) {
      const PetscInt number = kept_[part].entry(place);
      has_values = has_values || number >= 0;
      all_[part].add(place, number);
      of_border_[part].add(place, is_of_border ? number : -1);
    }
    if (is_of_border && block_size_ > 1)
      of_border.push_back(place);
    else if (!is_of_border && has_values)
      interior_.push_back(place);
  }
  for (EntriesOfBoth* both : {&all_, &of_border_})
    for (Entries& entries : *both)
      entries.begin.resize(static_cast<std::size_t>(size_) + 1, entries.count());
  means_.resize(2, static_cast<Eigen::Index>(places_.size()));
  for (const Place& place : places_)
    for (const std::size_t part : {0, 1})
      means_(static_cast<Eigen::Index>(part), place.number) =
          kept_[part].has(place) ? kept_[part].of(place).mean() : 0.0;
  series_of_.assign(places_.size(), -1);
  series_.resize(2 * width_ - 1, 2 * static_cast<Eigen::Index>(of_border.size()));
  Eigen::Index next = 0;
  for (const Place& place : of_border) {
    series_.middleCols<2>(next) = find_series(place);
    series_of_[static_cast<std::size_t>(place.number)] = next;
    next += 2;
  }
}

/// Coefficients of exp(i m Omega t), m = -2 H ... 2 H, of K and of M at a place.
HarmonicTangents::Series HarmonicTangents::find_series(const Place& place) const {
  Series series = Series::Zero(2 * width_ - 1, 2);
  for (const std::size_t part : {0, 1}) {
    if (!kept_[part].has(place)) continue;
    const Eigen::VectorXd coefficients = to_series_ * kept_[part].of(place);
    auto column = series.col(static_cast<Eigen::Index>(part));
    auto upper = column.tail(width_);
    upper.real() = coefficients.head(width_);
    upper.imag() = coefficients.tail(width_);
    column.head(width_) = upper.reverse().conjugate().eval();
  }
  return series;
}

/// With several turns, all blades at the instants of a sector are the first blade at the instants
/// of a revolution. `likeness`: what one instant shows of this, see likeness_of(); K, then M.
void HarmonicTangents::sample_all(const PeriodicSolution& solution, int turns,
                                  Eigen::MatrixXd& likeness) {
  const petsc::Handle<Vec> z = system_.make_state();
  const petsc::Handle<Vec> z_dot = system_.make_state();
  const petsc::Handle<Mat> jacobian = system_.make_jacobian();
  const petsc::Handle<Mat> mass = system_.make_mass();
  const int evaluated = samples() / turns;
  const auto evaluate = [&](int sample) {
    const double t = system_.period() == 0.0 ? 0.0 : instant(sample);
    solution.evaluate(t, z.get(), z_dot.get());
    system_.tangents(t, z.get(), z_dot.get(), 0.0, jacobian.get(), mass.get());
  };
  // The samples of a place are next to each other in memory: some at a time are written.
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(pattern_.nonZeros(), turns * samples_at_once);
  Eigen::MatrixXd M = K;
  for (int first = 0; first < evaluated; first += samples_at_once) {
    const int count = std::min(samples_at_once, evaluated - first);
    for (int n = 0; n < count; ++n) {
      evaluate(first + n);
      for (int turn = 0; turn < turns; ++turn) {
        const auto at = static_cast<std::size_t>(turn);
        if (at == of_jacobian_.size()) {
          of_jacobian_.push_back(places_of(jacobian.get(), turn));
          of_mass_.push_back(places_of(mass.get(), turn));
        }
        take_entries(jacobian.get(), of_jacobian_[at], K.col(turn * samples_at_once + n));
        take_entries(mass.get(), of_mass_[at], M.col(turn * samples_at_once + n));
      }
      require_pattern(jacobian.get(), of_jacobian_.front());
      require_pattern(mass.get(), of_mass_.front());
    }
    if (turns > 1 && first == 0) {
      evaluate(evaluated);
      likeness << likeness_of(jacobian.get(), of_jacobian_, K.col(samples_at_once)),
          likeness_of(mass.get(), of_mass_, M.col(samples_at_once));
    }
    if (sector_.sectors > 1)
      for (const Place& place : places_)
        if (!sector_.is_moved(place.row) && sector_.is_moved(place.column)) {
          K.row(place.number) *= sector_.sectors;
          M.row(place.number) *= sector_.sectors;
        }
    for (int turn = 0; turn < turns; ++turn) {
      const int begin = turn * evaluated + first;
      const int from = turn * samples_at_once;
      sampled_.middleRows(begin, count) = K.middleCols(from, count).transpose();
      sampled_.middleRows(samples() + begin, count) = M.middleCols(from, count).transpose();
    }
  }
}

/// An unknown that is not moved and that no other row refers to, such as the component of a
/// velocity in axes of the rotor, only follows the others. It has all harmonics if its row has no
/// blade, and not its own rate.
void HarmonicTangents::find_followers() {
  Eigen::MatrixXd uses = Eigen::MatrixXd::Zero(1, size_);
  for (const Place& place : places_) {
    const auto sampled = sampled_.col(place.number);
    if (sampled.isZero(0.0)) continue;
    if (place.row != place.column || !sampled.tail(sampled.size() / 2).isZero(0.0))
      ++uses(place.column);
    if (sector_.is_moved(place.column)) ++uses(place.row);
  }
  if (partition_ != nullptr) partition_->sum_border(uses);
  is_follower_.resize(sector_.kept.size(), 0);
  for (std::size_t i = 0; i < is_follower_.size(); ++i) {
    if (uses(static_cast<Eigen::Index>(i)) > 0.0 || sector_.is_moved(static_cast<PetscInt>(i)))
      continue;
    is_follower_[i] = 1;
    sector_.remainder[i] = RotorSector::every;
  }
}

/// P K(t + T/Q) P^-1 = K(t), so that the entry (i, j) at t is that of their images under P at
/// t + T/Q, times their signs.
HarmonicTangents::EntryPlaces HarmonicTangents::places_of(Mat tangent, int turn) const {
  const system::RotorSymmetry& symmetry = system_.symmetry();
  std::vector<PetscInt> image(sector_.number.size());
  std::iota(image.begin(), image.end(), 0);
  std::vector<double> sign(image.size(), 1.0);
  for (int k = 0; k < turn; ++k)
    for (std::size_t i = 0; i < image.size(); ++i) {
      const auto at = static_cast<std::size_t>(image[i]);
      sign[i] *= symmetry.sign[at];
      image[i] = symmetry.source[at];
    }
  for (PetscInt& i : image) i = sector_.number[static_cast<std::size_t>(i)];
  EntryPlaces places;
  PetscInt entry = -1;
  MatrixEntries(tangent).for_each([&](PetscInt i, PetscInt j, PetscScalar&) {
    ++entry;
    const PetscInt row = image[static_cast<std::size_t>(i)];
    const PetscInt column = image[static_cast<std::size_t>(j)];
    if (row < 0 || column < 0) return;
    const PetscInt* first = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[row];
    const PetscInt* last = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[row + 1];
    const PetscInt* found = std::lower_bound(first, last, column);
    if (found == last || *found != column) {
      places.outside.push_back({entry, row, unknown(column).scale});
      return;
    }
    const double factor = sign[static_cast<std::size_t>(i)] * sign[static_cast<std::size_t>(j)];
    places.inside.push_back(
        {entry, static_cast<PetscInt>(found - pattern_.innerIndexPtr()), factor});
  });
  return places;
}

void HarmonicTangents::take_entries(Mat tangent, const EntryPlaces& places,
                                    Eigen::Ref<Eigen::VectorXd> sample) const {
  MatrixEntries entries(tangent);
  const PetscScalar* values = entries.values();
  for (const EntryPlaces::Inside& one : places.inside)
    sample(one.place) = one.factor * values[one.entry];
}

/// @throws InternalError if an entry outside the pattern is not zero
void HarmonicTangents::require_pattern(Mat tangent, const EntryPlaces& places) const {
  MatrixEntries entries(tangent);
  const PetscScalar* values = entries.values();
  for (const EntryPlaces::Outside& one : places.outside)
    if (values[one.entry] != 0.0)
      entries.for_each([&](PetscInt i, PetscInt j, PetscScalar& value) {
        if (&value == values + one.entry)
          throw InternalError("row " + std::to_string(i) +
                              " of the tangents has an entry in column " + std::to_string(j) +
                              ", outside their pattern");
      });
}

/// For each row of a tangent: the largest entry, and the largest difference from the turned entries
/// of a sector before.
Eigen::MatrixXd HarmonicTangents::likeness_of(
    Mat tangent, const std::vector<EntryPlaces>& places,
    const Eigen::Ref<const Eigen::VectorXd>& turned) const {
  Eigen::VectorXd direct = Eigen::VectorXd::Zero(turned.size());
  take_entries(tangent, places.front(), direct);
  Eigen::MatrixXd largest = Eigen::MatrixXd::Zero(2, size_);
  for (const Place& place : places_) {
    const double scale = unknown(place.column).scale;
    const auto number = static_cast<Eigen::Index>(place.number);
    auto row = largest.col(place.row);
    row(0) = std::max(row(0), scale * std::abs(direct(number)));
    row(1) = std::max(row(1), scale * std::abs(direct(number) - turned(number)));
  }
  // Entries of other blades whose images the pattern of the first one does not have.
  const MatrixEntries entries(tangent);
  for (const EntryPlaces& turn : places)
    for (const EntryPlaces::Outside& one : turn.outside)
      largest(1, one.row) =
          std::max(largest(1, one.row), one.scale * std::abs(entries.values()[one.entry]));
  return largest;
}

/// Rows that differ from those of a sector before, beyond round-off and the error of the solution.
std::vector<PetscInt> HarmonicTangents::unlike_rows(Eigen::MatrixXd likeness) const {
  if (partition_ != nullptr) partition_->sum_border(likeness);
  std::vector<PetscInt> unlike;
  for (PetscInt i = 0; i < static_cast<PetscInt>(size_); ++i)
    if (!(likeness(1, i) <= same_tangent * likeness(0, i)) ||
        !(likeness(3, i) <= same_tangent * likeness(2, i)))
      unlike.push_back(i);
  return unlike;
}

/// Takes the rows of followers out of the map, so that these have no other unknowns: as that of the
/// component of a velocity in axes of the rotor, which the axes of a sector before do not have.
/// @returns false where a row is not that of a follower with a constant factor
bool HarmonicTangents::defer(const std::vector<PetscInt>& rows) {
  const Eigen::Index samples = this->samples();
  for (const PetscInt row : rows)
    if (std::ranges::none_of(deferred_, [row](const Deferred& one) { return one.number == row; }))
      deferred_.push_back({row, 0.0});
  bool serves = true;
  Eigen::MatrixXd factors = Eigen::MatrixXd::Zero(1, size_);
  const auto diagonal_of = [this](PetscInt row) {
    for (PetscInt e = pattern_.outerIndexPtr()[row]; e < pattern_.outerIndexPtr()[row + 1]; ++e)
      if (pattern_.innerIndexPtr()[e] == row) return e;
    return PetscInt{-1};
  };
  // The ranks' parts of a row of the border add up; the first rank has the factor 1.
  const auto is_counted = [this](PetscInt row) {
    return partition_ == nullptr || partition_->is_first() || !is_border(row);
  };
  for (const Deferred& deferred : deferred_) {
    const PetscInt row = deferred.number;
    const PetscInt place = diagonal_of(row);
    serves = serves && is_follower_[static_cast<std::size_t>(row)] != 0 &&
             (place >= 0 || !is_counted(row));
    if (place < 0) continue;
    const auto sampled = sampled_.col(place).head(samples);
    factors(row) = sampled.mean();
    const double change = (sampled.array() - factors(row)).abs().maxCoeff();
    serves = serves && change <= same_tangent * std::abs(factors(row));
  }
  if (partition_ != nullptr) partition_->sum_border(factors);
  for (Deferred& deferred : deferred_) {
    deferred.factor = factors(deferred.number);
    serves = serves && deferred.factor != 0.0;
  }
  if (partition_ != nullptr) serves = partition_->ranks().all(serves);
  if (!serves) return false;
  for (const Deferred& deferred : deferred_) {
    const PetscInt row = deferred.number;
    for (PetscInt e = pattern_.outerIndexPtr()[row]; e < pattern_.outerIndexPtr()[row + 1]; ++e) {
      if (pattern_.innerIndexPtr()[e] != row)
        sampled_.col(e).setZero();
      else
        sampled_.col(e).head(samples).setConstant(is_counted(row) ? 1.0 : 0.0);
    }
  }
  return true;
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

/// Adds the products of K (`part` 0) or M (1) with values at the samples.
void HarmonicTangents::add_products(const EntriesOfBoth& both, int part,
                                    const Eigen::MatrixXd& values, Eigen::MatrixXd& sums) const {
  const Entries& entries = both[static_cast<std::size_t>(part)];
  const Samples& kept = kept_[static_cast<std::size_t>(part)];
  const Eigen::Index samples = this->samples();
  const Eigen::Index vectors = values.cols() / size_;
  const Eigen::Index distance = size_ * samples;
  for (Eigen::Index row = 0; row < size_; ++row) {
    const auto first = static_cast<std::size_t>(entries.begin[static_cast<std::size_t>(row)]);
    const auto last = static_cast<std::size_t>(entries.begin[static_cast<std::size_t>(row) + 1]);
    const SampledRow own{kept.values.data(), entries.numbers.data() + first,
                         entries.columns.data() + first, last - first, samples};
    analysis::add_products(own, values.data(), vectors, distance, sums.data() + row * samples);
  }
  const auto count = static_cast<double>(entries.count()) + static_cast<double>(size_ * width_);
  PetscLogFlops(2.0 * static_cast<double>(samples * vectors) * count);
}

/// Coefficients of values at the samples.
void HarmonicTangents::project(const Eigen::MatrixXd& values, Eigen::MatrixXd& y) const {
  analysis::multiply(projection_, values, y);
}

/// Coefficients of the products of some entries with x and w.
void HarmonicTangents::multiply(const EntriesOfBoth& entries, const Eigen::MatrixXd& x,
                                const Eigen::MatrixXd& w, Eigen::MatrixXd& y) const {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(samples(), x.cols());
  add_products(entries, 0, analysis::multiply(values_of_, x), sums);
  add_products(entries, 1, analysis::multiply(values_of_, w), sums);
  project(sums, y);
}

void HarmonicTangents::multiply(const Eigen::MatrixXd& x, const Eigen::MatrixXd& w,
                                Eigen::MatrixXd& y) const {
  multiply(all_, x, w, y);
  sector_.drop_absent(y);
}

void HarmonicTangents::multiply_mass(const Eigen::MatrixXd& w, Eigen::MatrixXd& y) const {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(samples(), w.cols());
  add_products(all_, 1, analysis::multiply(values_of_, w), sums);
  project(sums, y);
  sector_.drop_absent(y);
}

void HarmonicTangents::multiply_uncoupled(const Eigen::MatrixXd& x, const Eigen::MatrixXd& w,
                                          Eigen::MatrixXd& y) const {
  multiply(of_border_, x, w, y);
  for (const Place& place : interior_)
    for (Eigen::Index first = 0; first < x.cols(); first += size_)
      y.col(first + place.row) += means_(0, place.number) * x.col(first + place.column) +
                                  means_(1, place.number) * w.col(first + place.column);
  sector_.drop_absent(y);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the block
void HarmonicTangents::coupling(const Place& place, std::complex<double> shift,
                                Eigen::Ref<Eigen::MatrixXcd> block) const {
  const Eigen::Index known = series_of_[static_cast<std::size_t>(place.number)];
  const Series series = known >= 0 ? Series(series_.middleCols<2>(known)) : find_series(place);
  const bool has_mass = !series.col(1).isZero(0.0);
  for (int column = 0; column < width_; ++column) {
    const int k = column - harmonics_;
    auto of_column = block.col(column);
    if (!has(place.column, k)) {
      of_column.setZero();
      continue;
    }
    const Eigen::Index first = width_ - 1 - column;
    of_column = series.col(0).segment(first, width_);
    if (has_mass)
      of_column +=
          (shift + std::complex<double>(0.0, k * rate())) * series.col(1).segment(first, width_);
  }
  for (int k = -harmonics_; k <= harmonics_; ++k)
    if (!has(place.row, k)) block.row(k + harmonics_).setZero();
}

double HarmonicTangents::rate() const { return system::base_rate(system_); }

double HarmonicTangents::period() const { return 2.0 * std::numbers::pi / rate(); }

void HarmonicTangents::scale(double loads, double rate, Eigen::VectorXd& rows,
                             Eigen::VectorXd& columns) const {
  // Entries of all blades, from those of the first one.
  std::vector<Eigen::Triplet<double>> entries;
  const std::vector<PetscInt>& source = system_.symmetry().source;
  for (const Place& place : places_) {
    double entry = 0.0;
    for (const std::size_t part : {0, 1})
      if (kept_[part].has(place))
        entry += (part == 0 ? 1.0 : rate) * kept_[part].of(place).lpNorm<Eigen::Infinity>();
    PetscInt row = sector_.kept[static_cast<std::size_t>(place.row)];
    PetscInt column = sector_.kept[static_cast<std::size_t>(place.column)];
    if (sector_.sectors > 1 && !sector_.is_moved(place.row) && sector_.is_moved(place.column))
      entry /= sector_.sectors;
    for (int q = 0; q < sector_.sectors; ++q) {
      entries.emplace_back(row, column, entry);
      if (sector_.sectors == 1) break;
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
    const PetscInt unknown = sector_.kept[static_cast<std::size_t>(i)];
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
  const Eigen::Index samples = this->samples();
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
  Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(to_block.rows(), pattern_.nonZeros());
  for (const std::size_t part : {0, 1}) {
    const auto of_part = to_block.middleCols(static_cast<Eigen::Index>(part) * samples, samples);
    for (const Place& place : places_)
      if (kept_[part].has(place))
        blocks.col(place.number).noalias() += of_part * kept_[part].of(place);
  }
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
