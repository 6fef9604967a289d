#include "harmonic_preconditioner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "blas.hpp"

namespace samara::analysis {
namespace {

/// Largest border, as a part of all blocks.
constexpr double largest_border = 0.5;
/// Relative size of a border column that counts in a harmonic.
constexpr double least_coupling = 1e-4;
/// Columns of the border that are eliminated together.
constexpr std::size_t columns_at_once = 32;

/// Coefficients of exp(i k Omega t), k = -H ... H, from mean, cosines and sines by row.
Eigen::MatrixXcd to_series(const Eigen::Ref<const Eigen::MatrixXd>& coefficients) {
  using namespace std::complex_literals;
  const Eigen::Index harmonics = (coefficients.rows() - 1) / 2;
  Eigen::MatrixXcd series(coefficients.rows(), coefficients.cols());
  series.row(harmonics) = coefficients.row(0).cast<std::complex<double>>();
  for (Eigen::Index k = 1; k <= harmonics; ++k) {
    series.row(harmonics + k) = 0.5 * (coefficients.row(2 * k - 1) - 1i * coefficients.row(2 * k));
    series.row(harmonics - k) = series.row(harmonics + k).conjugate();
  }
  return series;
}

blas::Integer integer(Eigen::Index value) { return static_cast<blas::Integer>(value); }

}  // namespace

HarmonicPreconditioner::HarmonicPreconditioner(const HarmonicTangents& tangents)
    : tangents_(tangents), width_(tangents.width()), chains_(tangents) {
  find_border();
  if (is_useful()) list_places();
}

/// The border of a distributed mesh is small.
bool HarmonicPreconditioner::is_useful() const {
  if (tangents_.partition() != nullptr) return true;
  return tangents_.block_size() > 1 && !interior_.empty() &&
         static_cast<double>(border_.size()) <=
             largest_border * static_cast<double>(tangents_.size());
}

void HarmonicPreconditioner::find_border() {
  number_.resize(static_cast<std::size_t>(tangents_.size()));
  for (std::size_t i = 0; i < number_.size(); ++i) {
    std::vector<PetscInt>& group = tangents_.is_border(static_cast<Index>(i)) ? border_ : interior_;
    number_[i] = static_cast<Index>(group.size());
    group.push_back(static_cast<PetscInt>(i));
  }
}

void HarmonicPreconditioner::list_places() {
  rows_of_border_.resize(border_.size());
  columns_of_border_.resize(border_.size());
  const auto add = [](Couplings& couplings, const Place& place, Index interior) {
    couplings.places.push_back(place);
    couplings.interior.push_back(interior);
  };
  std::vector<Place> inner;
  for (const Place& place : tangents_.places()) {
    const bool is_row_border = tangents_.is_border(place.row);
    const bool is_column_border = tangents_.is_border(place.column);
    const Index row = number_[static_cast<std::size_t>(place.row)];
    const Index column = number_[static_cast<std::size_t>(place.column)];
    if (is_row_border && is_column_border)
      corner_.push_back(place);
    else if (is_row_border)
      add(rows_of_border_[static_cast<std::size_t>(row)], place, column);
    else if (is_column_border)
      add(columns_of_border_[static_cast<std::size_t>(column)], place, row);
    else
      inner.push_back(place);
  }
  std::vector<Index> coupled;
  for (Couplings& row : rows_of_border_) {
    row.blocks.resize(width_, row.count() * width_);
    coupled.insert(coupled.end(), row.interior.begin(), row.interior.end());
  }
  for (Couplings& column : columns_of_border_)
    column.blocks.resize(column.count() * width_, width_);
  chains_.set(interior_, number_, std::move(inner), std::move(coupled));
}

/// The border's coefficients that there are.
void HarmonicPreconditioner::find_present() {
  present_.clear();
  position_.assign(static_cast<std::size_t>(border_size() * width_), -1);
  for (Index j = 0; j < border_size(); ++j)
    for (int k = -tangents_.harmonics(); k <= tangents_.harmonics(); ++k) {
      if (!tangents_.has(border_[static_cast<std::size_t>(j)], k)) continue;
      const Index at = j * width_ + k + tangents_.harmonics();
      position_[static_cast<std::size_t>(at)] = static_cast<Index>(present_.size());
      present_.push_back(at);
    }
}

/// Rows and columns: coefficients of exp(i k Omega t), k = -H ... H.
// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the block
void HarmonicPreconditioner::write_block(const Place& place,
                                         Eigen::Ref<Eigen::MatrixXcd> block) const {
  const int harmonics = tangents_.harmonics();
  tangents_.coupling(place, shift_, block);
  block *=
      (*row_factors_)(place.row * width_) * (*column_factors_)(place.column * width_ + width_ - 1);
  if (tangents_.is_held(place.column)) {
    block.col(harmonics).setZero();
    if (tangents_.holds(place.row, place.column))
      block(harmonics, harmonics) =
          (*row_factors_)(place.row * width_) * (*column_factors_)(place.column * width_);
  }
}

/// The rows and columns of the border, and its corner in the place of the complement.
void HarmonicPreconditioner::write_border() {
  for (Couplings& row : rows_of_border_)
    for (std::size_t i = 0; i < row.places.size(); ++i)
      write_block(row.places[i], row.blocks.middleCols(static_cast<Index>(i) * width_, width_));
  for (Couplings& column : columns_of_border_)
    for (std::size_t i = 0; i < column.places.size(); ++i)
      write_block(column.places[i],
                  column.blocks.middleRows(static_cast<Index>(i) * width_, width_));
  const auto size = static_cast<Index>(present_.size());
  schur_.setZero(size, size);
  Eigen::MatrixXcd block(width_, width_);
  for (const Place& place : corner_) {
    write_block(place, block);
    const Index row = number_[static_cast<std::size_t>(place.row)];
    const Index column = number_[static_cast<std::size_t>(place.column)];
    for (Index c = 0; c < width_; ++c) add_to_complement(row, column * width_ + c, block.col(c));
  }
}

/// Adds the coefficients of one unknown of the border in a column of its complement. `column`
/// counts all coefficients; absent ones are left out.
void HarmonicPreconditioner::add_to_complement(Index border, Index column,
                                               const Eigen::Ref<const Eigen::VectorXcd>& values) {
  const Index to = position_[static_cast<std::size_t>(column)];
  if (to < 0) return;
  for (Index c = 0; c < width_; ++c)
    if (const Index row = position_[static_cast<std::size_t>(border * width_ + c)]; row >= 0)
      schur_(row, to) += values(c);
}

/// Subtracts R C^-1 B from the border's corner: C the chains, R and B the rows and columns that
/// couple them to the border.
void HarmonicPreconditioner::eliminate_chains() {
  const int harmonics = tangents_.harmonics();
  // The largest |coefficient|^2 of each border column in each harmonic, and its limit.
  std::vector<Eigen::MatrixXd> largest;
  std::vector<double> limits;
  for (const Couplings& column : columns_of_border_) {
    largest.emplace_back(Eigen::MatrixXd::Zero(width_, width_));
    for (Index i = 0; i < column.count(); ++i)
      largest.back() =
          largest.back().cwiseMax(column.blocks.middleRows(i * width_, width_).cwiseAbs2());
    limits.push_back(least_coupling * least_coupling * largest.back().maxCoeff());
  }
  Eigen::MatrixXcd right;
  for (int k = chains_.first_harmonic(); k <= harmonics; ++k) {
    std::vector<BorderColumn> kept;
    std::vector<Index> filled;
    for (Index border = 0; border < border_size(); ++border) {
      const Couplings& couplings = columns_of_border_[static_cast<std::size_t>(border)];
      const std::size_t known = kept.size();
      for (Index c = 0; c < width_; ++c)
        if (largest[static_cast<std::size_t>(border)](k + harmonics, c) >
            limits[static_cast<std::size_t>(border)])
          kept.push_back({border, c});
      if (kept.size() > known)
        filled.insert(filled.end(), couplings.interior.begin(), couplings.interior.end());
    }
    HarmonicChains::Columns solver(chains_, k, filled);
    if (solver.is_empty()) continue;
    for (std::size_t first = 0; first < kept.size(); first += columns_at_once) {
      const std::vector<BorderColumn> some(
          kept.begin() + static_cast<std::ptrdiff_t>(first),
          kept.begin() +
              static_cast<std::ptrdiff_t>(std::min(first + columns_at_once, kept.size())));
      solver.start(static_cast<Index>(some.size()), right);
      for (std::size_t n = 0; n < some.size(); ++n) {
        const Couplings& couplings = columns_of_border_[static_cast<std::size_t>(some[n].border)];
        for (Index i = 0; i < couplings.count(); ++i)
          if (const Index row = solver.row_of(couplings.interior[static_cast<std::size_t>(i)]);
              row >= 0)
            right(row, static_cast<Index>(n)) +=
                couplings.blocks(i * width_ + k + harmonics, some[n].number);
      }
      solver.solve(right);
      subtract_rows(solver, k, some, right);
    }
  }
}

/// Subtracts the products of the border's rows in a harmonic and `solved`, its columns after the
/// solution with the chains.
void HarmonicPreconditioner::subtract_rows(const HarmonicChains::Columns& solver, int k,
                                           const std::vector<BorderColumn>& columns,
                                           const Eigen::MatrixXcd& solved) {
  const int harmonics = tangents_.harmonics();
  const Index count = solved.cols();
  Eigen::MatrixXcd values;
  Eigen::MatrixXcd product(width_, count);
  for (Index border = 0; border < border_size(); ++border) {
    const Couplings& couplings = rows_of_border_[static_cast<std::size_t>(border)];
    if (couplings.count() == 0) continue;
    values.setZero(couplings.count(), count);
    for (Index i = 0; i < couplings.count(); ++i)
      if (const Index row = solver.row_of(couplings.interior[static_cast<std::size_t>(i)]);
          row >= 0)
        values.row(i) = solved.row(row);
    // One column of each block. `is_turned`: conjugate columns have the harmonics in reverse order.
    const auto subtract = [&](int harmonic, bool is_turned) {
      blas::multiply(integer(width_), integer(count), integer(couplings.count()), -1.0,
                     couplings.blocks.data() + (harmonic + harmonics) * width_,
                     integer(width_ * width_), values.data(), integer(couplings.count()), 0.0,
                     product.data(), integer(width_));
      blas::count_operations<Complex>(static_cast<double>(width_ * count * couplings.count()));
      for (Index n = 0; n < count; ++n) {
        const auto& [of, number] = columns[static_cast<std::size_t>(n)];
        add_to_complement(border, of * width_ + (is_turned ? width_ - 1 - number : number),
                          product.col(n));
      }
    };
    subtract(k, false);
    if (!is_real() || k == 0) continue;
    values = values.conjugate().eval();
    subtract(-k, true);
  }
}

bool HarmonicPreconditioner::factor(const Eigen::VectorXd& rows, const Eigen::VectorXd& columns,
                                    Complex shift) {
  row_factors_ = &rows;
  column_factors_ = &columns;
  shift_ = shift;
  bool is_regular = chains_.factor(rows, columns, shift);
  const MeshPartition* partition = tangents_.partition();
  if (partition != nullptr) is_regular = partition->ranks().all(is_regular);
  if (!is_regular) return false;
  find_present();  // samples say which harmonics the unknowns have
  write_border();
  if (present_.empty()) return true;
  eliminate_chains();
  if (partition != nullptr) partition->ranks().sum(schur_);
  is_regular = complement_factors_.factor(std::move(schur_));
  return partition != nullptr ? partition->ranks().all(is_regular) : is_regular;
}

void HarmonicPreconditioner::solve(const Eigen::Ref<const Eigen::MatrixXcd>& right,
                                   Eigen::Ref<Eigen::MatrixXcd> solution) {
  const Index unknowns = tangents_.size();
  const Index columns = right.cols() / unknowns;
  const auto interior = static_cast<Index>(interior_.size());
  Eigen::MatrixXcd between(width_, interior * columns);
  for (Index c = 0; c < columns; ++c)
    between.middleCols(c * interior, interior) =
        right.middleCols(c * unknowns, unknowns)(Eigen::all, interior_);
  if (border_size() > 0) {
    Eigen::MatrixXcd border = Eigen::MatrixXcd::Zero(width_, border_size() * columns);
    Eigen::MatrixXcd given = between;
    chains_.solve(between, true);
    if (is_real())
      for (int k = 1; k <= tangents_.harmonics(); ++k)
        between.row(tangents_.harmonics() - k) = between.row(tangents_.harmonics() + k).conjugate();
    Eigen::MatrixXcd part;
    for (Index j = 0; j < border_size(); ++j) {
      const Couplings& row = rows_of_border_[static_cast<std::size_t>(j)];
      if (row.count() == 0) continue;
      part.resize(width_, row.count() * columns);
      for (Index c = 0; c < columns; ++c)
        for (Index i = 0; i < row.count(); ++i)
          part.col(c * row.count() + i) =
              between.col(c * interior + row.interior[static_cast<std::size_t>(i)]);
      blas::subtract_product(integer(width_), integer(columns), integer(row.count() * width_),
                             row.blocks.data(), integer(width_), part.data(),
                             integer(row.count() * width_), border.col(j).data(),
                             integer(border_size() * width_));
    }
    if (tangents_.partition() != nullptr) tangents_.partition()->ranks().sum(border);
    for (Index c = 0; c < columns; ++c)
      border.middleCols(c * border_size(), border_size()) +=
          right.middleCols(c * unknowns, unknowns)(Eigen::all, border_);
    Eigen::MatrixXcd of_border = border.reshaped(border_size() * width_, columns);
    const Eigen::MatrixXcd unknown =
        present_.empty() ? Eigen::MatrixXcd(0, columns)
                         : complement_factors_.solve(of_border(present_, Eigen::all));
    of_border.setZero();
    of_border(present_, Eigen::all) = unknown;
    border = of_border.reshaped(width_, border_size() * columns);
    for (Index j = 0; j < border_size(); ++j) {
      const Couplings& column = columns_of_border_[static_cast<std::size_t>(j)];
      if (column.count() == 0) continue;
      part.setZero(width_, column.count() * columns);
      blas::subtract_product(integer(column.count() * width_), integer(columns), integer(width_),
                             column.blocks.data(), integer(column.count() * width_),
                             border.col(j).data(), integer(border_size() * width_), part.data(),
                             integer(column.count() * width_));
      for (Index c = 0; c < columns; ++c)
        for (Index i = 0; i < column.count(); ++i)
          given.col(c * interior + column.interior[static_cast<std::size_t>(i)]) +=
              part.col(c * column.count() + i);
    }
    for (Index c = 0; c < columns; ++c)
      solution.middleCols(c * unknowns, unknowns)(Eigen::all, border_) =
          border.middleCols(c * border_size(), border_size());
    between = std::move(given);
  }
  chains_.solve(between, false);
  for (Index c = 0; c < columns; ++c)
    solution.middleCols(c * unknowns, unknowns)(Eigen::all, interior_) =
        between.middleCols(c * interior, interior);
}

void HarmonicPreconditioner::solve(const double* right, double* solution) {
  const Eigen::Map<const Eigen::MatrixXd> in(right, width_, tangents_.size());
  Eigen::Map<Eigen::MatrixXd> out(solution, width_, tangents_.size());
  const Eigen::MatrixXcd series = to_series(in);
  Eigen::MatrixXcd result(width_, tangents_.size());
  solve(series, result);
  const Index harmonics = tangents_.harmonics();
  out.row(0) = result.row(harmonics).real();
  for (Index k = 1; k <= harmonics; ++k) {
    out.row(2 * k - 1) = 2.0 * result.row(harmonics + k).real();
    out.row(2 * k) = -2.0 * result.row(harmonics + k).imag();
  }
}

HarmonicPreconditioner::Complex HarmonicPreconditioner::log_determinant() const {
  Eigen::MatrixXcd sum = Eigen::MatrixXcd::Constant(1, 1, chains_.log_determinant());
  if (tangents_.partition() != nullptr) tangents_.partition()->ranks().sum(sum);
  return present_.empty() ? sum(0) : sum(0) + complement_factors_.log_determinant();
}

}  // namespace samara::analysis
