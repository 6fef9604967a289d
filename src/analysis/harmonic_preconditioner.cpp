#include "harmonic_preconditioner.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

#include "blas.hpp"

namespace samara::analysis {
namespace {

/// Largest border, as a part of all blocks.
constexpr double largest_border = 0.5;
/// Relative size of a border column that counts in a harmonic.
constexpr double least_coupling = 1e-4;
/// Columns of the border that are eliminated together.
constexpr std::size_t columns_at_once = 32;
/// Smallest pivot in a chain, relative to the entries of its row. In a chain of 10 000 nodes pivots
/// of 1e-13 are no round-off; where they are, the iterations that use the factors do not converge.
constexpr double least_chain_pivot = 1e-16;

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
    : tangents_(tangents), width_(tangents.width()), block_(tangents.block_size()) {
  find_border();
  if (is_useful()) list_places();
}

/// The border of a distributed mesh is small.
bool HarmonicPreconditioner::is_useful() const {
  if (tangents_.partition() != nullptr) return true;
  return block_ > 1 && !interior_.empty() &&
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
      inner_.push_back(place);
  }
  for (Couplings& row : rows_of_border_) row.blocks.resize(width_, row.count() * width_);
  for (Couplings& column : columns_of_border_)
    column.blocks.resize(column.count() * width_, width_);
}

/// For harmonics with this remainder. A block is absent if all its unknowns are.
void HarmonicPreconditioner::find_chains(int remainder) {
  Chains chains;
  const auto blocks = static_cast<Index>(interior_.size()) / block_;
  chains.local.assign(static_cast<std::size_t>(blocks), -1);
  for (Index i = 0; i < blocks; ++i) {
    const auto first = interior_.begin() + i * block_;
    if (std::none_of(first, first + block_,
                     [&](PetscInt unknown) { return tangents_.has(unknown, remainder); }))
      continue;
    chains.local[static_cast<std::size_t>(i)] = static_cast<Index>(chains.blocks.size());
    chains.blocks.push_back(i);
  }
  const auto local_of = [&](PetscInt unknown) {
    return chains
        .local[static_cast<std::size_t>(number_[static_cast<std::size_t>(unknown)] / block_)];
  };
  std::vector<std::map<Index, Index>> rows(chains.blocks.size());
  const auto is_present = [&](const Place& place) {
    return local_of(place.row) >= 0 && local_of(place.column) >= 0;
  };
  for (const Place& place : inner_)
    if (is_present(place))
      rows[static_cast<std::size_t>(local_of(place.row))][local_of(place.column)] = 0;
  chains.begin.push_back(0);
  for (std::map<Index, Index>& row : rows) {
    for (auto& [column, number] : row) {
      number = static_cast<Index>(chains.columns.size());
      chains.columns.push_back(static_cast<PetscInt>(column));
    }
    chains.begin.push_back(static_cast<PetscInt>(chains.columns.size()));
  }
  for (const Place& place : inner_)
    chains.block_of.push_back(
        is_present(place)
            ? rows[static_cast<std::size_t>(local_of(place.row))].at(local_of(place.column))
            : -1);
  std::set<Index> coupled;
  for (const Couplings& row : rows_of_border_)
    for (const Place& place : row.places)
      if (const Index block = local_of(place.column); block >= 0) coupled.insert(block);
  chains.coupled.assign(coupled.begin(), coupled.end());
  chains_.push_back(std::move(chains));
}

const HarmonicPreconditioner::Chains& HarmonicPreconditioner::chains_of(int harmonic) const {
  const int sectors = tangents_.sectors();
  return chains_[static_cast<std::size_t>((harmonic % sectors + sectors) % sectors)];
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

BlockFactors<HarmonicPreconditioner::Complex>& HarmonicPreconditioner::factors_of(int harmonic) {
  return factors_[static_cast<std::size_t>(harmonic - first_harmonic())];
}

bool HarmonicPreconditioner::factor_harmonic(int harmonic) {
  const Eigen::MatrixXd& means = tangents_.means();
  const Index area = block_ * block_;
  const Chains& chains = chains_of(harmonic);
  Eigen::VectorXcd values =
      Eigen::VectorXcd::Zero(static_cast<Index>(chains.columns.size()) * area);
  const Complex rate = shift_ + Complex(0.0, harmonic * tangents_.rate());
  for (std::size_t n = 0; n < inner_.size(); ++n) {
    const Place& place = inner_[n];
    if (!tangents_.has(place.row, harmonic) || !tangents_.has(place.column, harmonic)) continue;
    const Index row = number_[static_cast<std::size_t>(place.row)] % block_;
    const Index column = number_[static_cast<std::size_t>(place.column)] % block_;
    values(chains.block_of[n] * area + column * block_ + row) =
        (*row_factors_)(place.row * width_) * (*column_factors_)(place.column * width_) *
        (means(0, place.number) + rate * means(1, place.number));
  }
  for (std::size_t n = 0; n < inner_.size(); ++n)  // absent unknowns are zero
    if (const Place& place = inner_[n]; place.row == place.column && chains.block_of[n] >= 0 &&
                                        !tangents_.has(place.row, harmonic)) {
      const Index at = number_[static_cast<std::size_t>(place.row)] % block_;
      values(chains.block_of[n] * area + at * block_ + at) = 1.0;
    }
  const BlockMatrix<Complex> matrix{block_, static_cast<Index>(chains.blocks.size()),
                                    chains.begin.data(), chains.columns.data(), values.data()};
  const auto number = static_cast<std::size_t>(harmonic - first_harmonic());
  if (factors_.size() <= number) factors_.emplace_back(matrix);
  return factors_[number].factor(matrix, least_chain_pivot);
}

/// `coefficients`: width x interior unknowns of each right-hand side; for a real shift only those
/// of k >= 0 are found, for `only_coupled` those in blocks that rows of the border refer to. Absent
/// coefficients stay as they are.
void HarmonicPreconditioner::solve_interior(Eigen::MatrixXcd& coefficients, bool only_coupled) {
  const int harmonics = tangents_.harmonics();
  const auto interior = static_cast<Index>(interior_.size());
  if (interior == 0) return;  // of a rank without a piece of the mesh
  const Index columns = coefficients.cols() / interior;
  Eigen::MatrixXcd right;
  for (int k = first_harmonic(); k <= harmonics; ++k) {
    const Chains& chains = chains_of(k);
    const std::vector<Index>& blocks = chains.blocks;
    right.resize(static_cast<Index>(blocks.size()) * block_, columns);
    const auto each_row = [&](const auto& call) {
      for (Index c = 0; c < columns; ++c)
        for (std::size_t i = 0; i < blocks.size(); ++i)
          for (Index at = 0; at < block_; ++at)
            call(right(static_cast<Index>(i) * block_ + at, c),
                 coefficients(k + harmonics, c * interior + blocks[i] * block_ + at));
    };
    each_row([](Complex& row, const Complex& coefficient) { row = coefficient; });
    if (only_coupled) {
      std::vector<Index> all(blocks.size());
      std::iota(all.begin(), all.end(), Index{0});
      factors_of(k).solve_part(right, all, chains.coupled);
    } else {
      factors_of(k).solve(right);
    }
    each_row([](const Complex& row, Complex& coefficient) { coefficient = row; });
  }
}

/// Row of an unknown of the interior among those that have a harmonic; -1: absent.
HarmonicPreconditioner::Index HarmonicPreconditioner::row_in(const Chains& chains,
                                                             Index interior) const {
  const Index at = chains.local[static_cast<std::size_t>(interior / block_)];
  return at < 0 ? at : at * block_ + interior % block_;
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
  for (int k = first_harmonic(); k <= harmonics; ++k) {
    const Chains& chains = chains_of(k);
    std::vector<BorderColumn> kept;
    std::set<Index> filled;
    for (Index border = 0; border < border_size(); ++border) {
      const Couplings& couplings = columns_of_border_[static_cast<std::size_t>(border)];
      const std::size_t known = kept.size();
      for (Index c = 0; c < width_; ++c)
        if (largest[static_cast<std::size_t>(border)](k + harmonics, c) >
            limits[static_cast<std::size_t>(border)])
          kept.push_back({border, c});
      if (kept.size() > known)
        for (const Index interior : couplings.interior)
          if (const Index row = row_in(chains, interior); row >= 0) filled.insert(row / block_);
    }
    if (filled.empty()) continue;
    const std::vector<Index> filled_rows(filled.begin(), filled.end());
    for (std::size_t first = 0; first < kept.size(); first += columns_at_once) {
      const std::vector<BorderColumn> some(
          kept.begin() + static_cast<std::ptrdiff_t>(first),
          kept.begin() +
              static_cast<std::ptrdiff_t>(std::min(first + columns_at_once, kept.size())));
      right.resize(static_cast<Index>(chains.blocks.size()) * block_,
                   static_cast<Index>(some.size()));
      for (const Index i : filled_rows) right.middleRows(i * block_, block_).setZero();
      for (std::size_t n = 0; n < some.size(); ++n) {
        const Couplings& couplings = columns_of_border_[static_cast<std::size_t>(some[n].border)];
        for (Index i = 0; i < couplings.count(); ++i)
          if (const Index row = row_in(chains, couplings.interior[static_cast<std::size_t>(i)]);
              row >= 0)
            right(row, static_cast<Index>(n)) +=
                couplings.blocks(i * width_ + k + harmonics, some[n].number);
      }
      factors_of(k).solve_part(right, filled_rows, chains.coupled);
      subtract_rows(k, some, right);
    }
    factors_of(k).release();
  }
}

/// Subtracts the products of the border's rows in a harmonic and `solved`, its columns after the
/// solution with the chains.
void HarmonicPreconditioner::subtract_rows(int k, const std::vector<BorderColumn>& columns,
                                           const Eigen::MatrixXcd& solved) {
  const int harmonics = tangents_.harmonics();
  const Chains& chains = chains_of(k);
  const Index count = solved.cols();
  Eigen::MatrixXcd values;
  Eigen::MatrixXcd product(width_, count);
  for (Index border = 0; border < border_size(); ++border) {
    const Couplings& couplings = rows_of_border_[static_cast<std::size_t>(border)];
    if (couplings.count() == 0) continue;
    values.setZero(couplings.count(), count);
    for (Index i = 0; i < couplings.count(); ++i)
      if (const Index row = row_in(chains, couplings.interior[static_cast<std::size_t>(i)]);
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
  if ((shift.imag() == 0.0) != is_real()) factors_.clear();
  shift_ = shift;
  // Samples say which harmonics the unknowns have.
  if (chains_.empty() || remainders_ != tangents_.sector().remainder) {
    remainders_ = tangents_.sector().remainder;
    chains_.clear();
    factors_.clear();
    for (int remainder = 0; remainder < tangents_.sectors(); ++remainder) find_chains(remainder);
    find_present();
  }
  bool is_regular = true;
  for (int k = first_harmonic(); k <= tangents_.harmonics(); ++k)
    is_regular = is_regular && factor_harmonic(k);
  const MeshPartition* partition = tangents_.partition();
  if (partition != nullptr) is_regular = partition->ranks().all(is_regular);
  if (!is_regular) return false;
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
    solve_interior(between, true);
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
  solve_interior(between, false);
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
  Eigen::MatrixXcd sum = Eigen::MatrixXcd::Zero(1, 1);
  for (const BlockFactors<Complex>& factors : factors_) sum(0) += factors.log_determinant();
  if (tangents_.partition() != nullptr) tangents_.partition()->ranks().sum(sum);
  return present_.empty() ? sum(0) : sum(0) + complement_factors_.log_determinant();
}

}  // namespace samara::analysis
