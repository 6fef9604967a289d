#include "harmonic_preconditioner.hpp"

#include <algorithm>
#include <map>
#include <numbers>

#include "blas.hpp"

namespace samara::analysis {
namespace {

/// A block belongs to the border if more blocks than this refer to it. (A node of a chain has two
/// neighbours, and is in the rows of joints and reactions.)
constexpr std::size_t most_neighbours = 8;
/// Largest border, as a part of all blocks.
constexpr double largest_border = 0.5;
/// Relative size of a border column that counts in a harmonic.
constexpr double least_coupling = 1e-4;
/// Smallest pivot of the border's complement, relative to its largest.
constexpr double least_pivot = 1e-14;

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

}  // namespace

HarmonicPreconditioner::HarmonicPreconditioner(const HarmonicTangents& tangents)
    : tangents_(tangents), width_(tangents.width()), block_(tangents.block_size()) {
  find_border();
  if (is_useful()) list_places();
}

bool HarmonicPreconditioner::is_useful() const {
  return block_ > 1 && !interior_.empty() &&
         static_cast<double>(border_.size()) <=
             largest_border * static_cast<double>(in_border_.size());
}

/// Blocks with a coordinate that is held belong to the border, too.
void HarmonicPreconditioner::find_border() {
  std::vector<char> is_border;
  for (const std::size_t users : tangents_.users())
    is_border.push_back(users > most_neighbours ? 1 : 0);
  const auto block = static_cast<std::size_t>(block_);
  for (const system::UnconstrainedCoordinate& held : tangents_.held())
    for (const PetscInt i : {held.unknown, held.row}) {
      const std::size_t first = static_cast<std::size_t>(i) / block * block;
      std::fill_n(is_border.begin() + static_cast<std::ptrdiff_t>(first), block_, char{1});
    }
  number_.resize(static_cast<std::size_t>(tangents_.size()));
  in_border_.resize(number_.size());
  for (std::size_t i = 0; i < number_.size(); ++i) {
    in_border_[i] = is_border[i];
    std::vector<PetscInt>& group = in_border_[i] ? border_ : interior_;
    number_[i] = static_cast<Index>(group.size());
    group.push_back(static_cast<PetscInt>(i));
  }
}

void HarmonicPreconditioner::list_places() {
  columns_of_border_.resize(border_.size());
  const Index blocks = static_cast<Index>(interior_.size()) / block_;
  std::vector<std::map<Index, Index>> rows(static_cast<std::size_t>(blocks));
  for (const Place& place : tangents_.places()) {
    const auto row = static_cast<std::size_t>(place.row);
    const auto column = static_cast<std::size_t>(place.column);
    if (in_border_[row] && in_border_[column]) {
      corner_.push_back(place);
    } else if (in_border_[row]) {
      rows_of_border_.push_back(place);
    } else if (in_border_[column]) {
      columns_of_border_[static_cast<std::size_t>(number_[column])].push_back(place);
    } else {
      inner_.push_back(place);
      rows[static_cast<std::size_t>(number_[row] / block_)][number_[column] / block_] = 0;
    }
  }
  begin_.push_back(0);
  for (std::map<Index, Index>& row : rows) {
    for (auto& [column, number] : row) {
      number = static_cast<Index>(columns_.size());
      columns_.push_back(static_cast<PetscInt>(column));
    }
    begin_.push_back(static_cast<PetscInt>(columns_.size()));
  }
  for (const Place& place : inner_)
    block_of_.push_back(
        rows[static_cast<std::size_t>(number_[static_cast<std::size_t>(place.row)] / block_)].at(
            number_[static_cast<std::size_t>(place.column)] / block_));
}

/// Rows and columns: coefficients of exp(i k Omega t), k = -H ... H.
Eigen::MatrixXcd HarmonicPreconditioner::scaled_block(const Place& place) const {
  const HarmonicTangents::Coefficients tangents = tangents_.coefficients(place);
  const int harmonics = tangents_.harmonics();
  Eigen::MatrixXcd block(width_, width_);
  for (int k = -harmonics; k <= harmonics; ++k) {
    const Complex rate = shift_ + Complex(0.0, k * tangents_.rate());
    block.col(k + harmonics) = tangents.stiffness.segment(harmonics - k, width_) +
                               rate * tangents.mass.segment(harmonics - k, width_);
  }
  block *=
      (*row_factors_)(place.row * width_) * (*column_factors_)(place.column * width_ + width_ - 1);
  for (int k = -harmonics; k <= harmonics; ++k) {
    if (!tangents_.has(place.row, k)) block.row(k + harmonics).setZero();
    if (!tangents_.has(place.column, k)) block.col(k + harmonics).setZero();
  }
  if (tangents_.is_held(place.column)) {
    block.col(harmonics).setZero();
    if (tangents_.holds(place.row, place.column))
      block(harmonics, harmonics) =
          (*row_factors_)(place.row * width_) * (*column_factors_)(place.column * width_);
  }
  return block;
}

BlockFactors<HarmonicPreconditioner::Complex>& HarmonicPreconditioner::factors_of(int harmonic) {
  return factors_[static_cast<std::size_t>(harmonic - first_harmonic())];
}

/// `means`: of K and M at all places.
bool HarmonicPreconditioner::factor_harmonic(int harmonic, const Eigen::MatrixXd& means) {
  const Index area = block_ * block_;
  Eigen::VectorXcd values = Eigen::VectorXcd::Zero(static_cast<Index>(columns_.size()) * area);
  const Complex rate = shift_ + Complex(0.0, harmonic * tangents_.rate());
  for (std::size_t n = 0; n < inner_.size(); ++n) {
    const Place& place = inner_[n];
    if (!tangents_.has(place.row, harmonic) || !tangents_.has(place.column, harmonic)) continue;
    const Index row = number_[static_cast<std::size_t>(place.row)] % block_;
    const Index column = number_[static_cast<std::size_t>(place.column)] % block_;
    values(block_of_[n] * area + column * block_ + row) =
        (*row_factors_)(place.row * width_) * (*column_factors_)(place.column * width_) *
        (means(0, place.number) + rate * means(1, place.number));
  }
  for (std::size_t n = 0; n < inner_.size(); ++n)  // absent unknowns are zero
    if (const Place& place = inner_[n];
        place.row == place.column && !tangents_.has(place.row, harmonic)) {
      const Index at = number_[static_cast<std::size_t>(place.row)] % block_;
      values(block_of_[n] * area + at * block_ + at) = 1.0;
    }
  const BlockMatrix<Complex> matrix{block_, static_cast<Index>(interior_.size()) / block_,
                                    begin_.data(), columns_.data(), values.data()};
  const auto number = static_cast<std::size_t>(harmonic - first_harmonic());
  if (factors_.size() <= number) factors_.emplace_back(matrix);
  return factors_[number].factor(matrix);
}

/// `coefficients`: width x interior unknowns; for a real shift only those of k >= 0 are found.
void HarmonicPreconditioner::solve_interior(Eigen::MatrixXcd& coefficients) {
  const int harmonics = tangents_.harmonics();
  for (int k = first_harmonic(); k <= harmonics; ++k) {
    Eigen::MatrixXcd right = coefficients.row(k + harmonics).transpose();
    factors_of(k).solve(right);
    coefficients.row(k + harmonics) = right.transpose();
  }
}

/// Subtracts R C^-1 B from the border's corner: C the chains, R and B the rows and columns that
/// couple them to the border.
void HarmonicPreconditioner::eliminate_chains(Eigen::MatrixXcd& schur) {
  const int harmonics = tangents_.harmonics();
  const auto block_of = [this](Index interior) { return interior / block_; };
  std::vector<Index> wanted;
  for (const Coupling& coupling : couplings_) wanted.push_back(block_of(coupling.interior));
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  std::map<Index, std::vector<const Coupling*>> of_border;
  for (const Coupling& coupling : couplings_back_) of_border[coupling.border].push_back(&coupling);
  Eigen::MatrixXcd right;
  for (const auto& [border, couplings] : of_border) {
    double largest = 0.0;
    std::vector<Index> filled;
    for (const Coupling* coupling : couplings) {
      largest = std::max(largest, coupling->block.cwiseAbs().maxCoeff());
      filled.push_back(block_of(coupling->interior));
    }
    for (int k = first_harmonic(); k <= harmonics; ++k) {
      std::vector<Index> kept;
      for (Index c = 0; c < width_; ++c)
        if (std::any_of(couplings.begin(), couplings.end(), [&](const Coupling* coupling) {
              return std::abs(coupling->block(k + harmonics, c)) > least_coupling * largest;
            }))
          kept.push_back(c);
      if (kept.empty()) continue;
      right.resize(static_cast<Index>(interior_.size()), static_cast<Index>(kept.size()));
      for (const Index i : filled) right.middleRows(i * block_, block_).setZero();
      for (const Coupling* coupling : couplings)
        right.row(coupling->interior) += coupling->block(k + harmonics, kept);
      factors_of(k).solve_part(right, filled, wanted);
      for (const Coupling& coupling : couplings_) {
        const auto values = right.row(coupling.interior);
        for (std::size_t c = 0; c < kept.size(); ++c) {
          const Complex value = values(static_cast<Index>(c));
          if (value == 0.0) continue;
          const Index column = border * width_ + kept[c];
          schur.block(coupling.border * width_, column, width_, 1) -=
              value * coupling.block.col(k + harmonics);
          if (is_real() && k > 0)
            schur.block(coupling.border * width_, border * width_ + width_ - 1 - kept[c], width_,
                        1) -= std::conj(value) * coupling.block.col(harmonics - k);
        }
      }
    }
  }
}

bool HarmonicPreconditioner::factor(const Eigen::VectorXd& rows, const Eigen::VectorXd& columns,
                                    Complex shift) {
  row_factors_ = &rows;
  column_factors_ = &columns;
  if ((shift.imag() == 0.0) != is_real()) factors_.clear();
  shift_ = shift;
  const Eigen::MatrixXd means = tangents_.means();
  for (int k = first_harmonic(); k <= tangents_.harmonics(); ++k)
    if (!factor_harmonic(k, means)) return false;
  couplings_.clear();
  for (const Place& place : rows_of_border_)
    couplings_.push_back({number_[static_cast<std::size_t>(place.row)],
                          number_[static_cast<std::size_t>(place.column)], scaled_block(place)});
  couplings_back_.clear();
  for (std::size_t j = 0; j < columns_of_border_.size(); ++j)
    for (const Place& place : columns_of_border_[j])
      couplings_back_.push_back({static_cast<Index>(j),
                                 number_[static_cast<std::size_t>(place.row)],
                                 scaled_block(place)});
  present_.clear();
  for (Index j = 0; j < border_size(); ++j)
    for (int k = -tangents_.harmonics(); k <= tangents_.harmonics(); ++k)
      if (tangents_.has(border_[static_cast<std::size_t>(j)], k))
        present_.push_back(j * width_ + k + tangents_.harmonics());
  const auto size = static_cast<Index>(present_.size());
  if (size == 0) return true;
  Eigen::MatrixXcd all = Eigen::MatrixXcd::Zero(border_size() * width_, border_size() * width_);
  for (const Place& place : corner_)
    all.block(number_[static_cast<std::size_t>(place.row)] * width_,
              number_[static_cast<std::size_t>(place.column)] * width_, width_, width_) =
        scaled_block(place);
  eliminate_chains(all);
  Eigen::MatrixXcd schur = all(present_, present_);
  // Entries of about one, so that small pivots mean that the matrix is singular.
  const auto inverse = [](double largest) { return largest > 0.0 ? 1.0 / largest : 1.0; };
  schur_rows_ = schur.cwiseAbs().rowwise().maxCoeff().unaryExpr(inverse);
  schur = schur_rows_.asDiagonal() * schur;
  schur_columns_ = schur.cwiseAbs().colwise().maxCoeff().transpose().unaryExpr(inverse);
  schur_ = schur * schur_columns_.asDiagonal();
  schur_interchanges_.resize(static_cast<std::size_t>(size));
  if (blas::factor(static_cast<blas::Integer>(size), schur_.data(), schur_interchanges_.data()) !=
      0)
    return false;
  const auto pivots = schur_.diagonal().cwiseAbs();
  return pivots.minCoeff() > least_pivot * pivots.maxCoeff();
}

void HarmonicPreconditioner::solve(const Eigen::MatrixXcd& right, Eigen::MatrixXcd& solution) {
  solution.resize(width_, tangents_.size());
  Eigen::MatrixXcd between = right(Eigen::all, interior_);
  if (border_size() > 0) {
    Eigen::MatrixXcd border = right(Eigen::all, border_);
    Eigen::MatrixXcd given = between;
    solve_interior(between);
    if (is_real())
      for (int k = 1; k <= tangents_.harmonics(); ++k)
        between.row(tangents_.harmonics() - k) = between.row(tangents_.harmonics() + k).conjugate();
    for (const Coupling& coupling : couplings_)
      border.col(coupling.border).noalias() -= coupling.block * between.col(coupling.interior);
    Eigen::VectorXcd unknown =
        schur_rows_.cwiseProduct(Eigen::VectorXcd(border.reshaped()(present_)));
    blas::solve(static_cast<blas::Integer>(unknown.size()), 1, schur_.data(),
                schur_interchanges_.data(), unknown.data());
    border.setZero();
    border.reshaped()(present_) = schur_columns_.cwiseProduct(unknown);
    for (const Coupling& coupling : couplings_back_)
      given.col(coupling.interior).noalias() -= coupling.block * border.col(coupling.border);
    solution(Eigen::all, border_) = border;
    between = std::move(given);
  }
  solve_interior(between);
  solution(Eigen::all, interior_) = between;
}

void HarmonicPreconditioner::solve(const double* right, double* solution) {
  const Eigen::Map<const Eigen::MatrixXd> in(right, width_, tangents_.size());
  Eigen::Map<Eigen::MatrixXd> out(solution, width_, tangents_.size());
  const Eigen::MatrixXcd series = to_series(in);
  Eigen::MatrixXcd result;
  solve(series, result);
  const Index harmonics = tangents_.harmonics();
  out.row(0) = result.row(harmonics).real();
  for (Index k = 1; k <= harmonics; ++k) {
    out.row(2 * k - 1) = 2.0 * result.row(harmonics + k).real();
    out.row(2 * k) = -2.0 * result.row(harmonics + k).imag();
  }
}

HarmonicPreconditioner::Complex HarmonicPreconditioner::log_determinant() const {
  Complex sum = 0.0;
  for (const BlockFactors<Complex>& factors : factors_) sum += factors.log_determinant();
  for (Index i = 0; i < schur_.rows(); ++i) {
    sum += std::log(schur_(i, i)) - std::log(schur_rows_(i)) - std::log(schur_columns_(i));
    if (schur_interchanges_[static_cast<std::size_t>(i)] != i + 1)
      sum += Complex(0.0, std::numbers::pi);
  }
  return sum;
}

}  // namespace samara::analysis
