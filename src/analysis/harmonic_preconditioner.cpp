#include "harmonic_preconditioner.hpp"

#include <algorithm>
#include <map>
#include <set>

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
  const Index blocks = tangents_.size() / block_;
  std::vector<std::set<Index>> users(static_cast<std::size_t>(blocks));
  for (const Place& place : tangents_.places())
    users[static_cast<std::size_t>(place.column / block_)].insert(place.row / block_);
  std::vector<char> is_border(static_cast<std::size_t>(blocks), 0);
  for (std::size_t b = 0; b < users.size(); ++b)
    if (users[b].size() > most_neighbours) is_border[b] = 1;
  for (const system::UnconstrainedCoordinate& held : tangents_.held())
    for (const PetscInt i : {held.unknown, held.row})
      is_border[static_cast<std::size_t>(i / block_)] = 1;
  number_.resize(static_cast<std::size_t>(tangents_.size()));
  in_border_.resize(number_.size());
  for (std::size_t i = 0; i < number_.size(); ++i) {
    in_border_[i] = is_border[i / static_cast<std::size_t>(block_)];
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
      all_columns_of_border_.push_back(place);
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

Eigen::MatrixXd HarmonicPreconditioner::scaled_block(const Place& place) const {
  return row_factors_->segment(place.row * width_, width_).asDiagonal() * tangents_.block(place) *
         column_factors_->segment(place.column * width_, width_).asDiagonal();
}

/// A node block of harmonic j > 0 has its cosines, then its sines.
HarmonicPreconditioner::Index HarmonicPreconditioner::first_row(int harmonic,
                                                                Index interior) const {
  return harmonic == 0 ? interior : interior / block_ * 2 * block_ + interior % block_;
}

bool HarmonicPreconditioner::factor_harmonic(int harmonic) {
  const Index parts = harmonic == 0 ? 1 : 2;
  const Index size = parts * block_;
  const Eigen::MatrixXd entries = tangents_.harmonic_part(harmonic);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(static_cast<Index>(columns_.size()) * size * size);
  const Index first = harmonic == 0 ? 0 : 2 * harmonic - 1;
  for (std::size_t n = 0; n < inner_.size(); ++n) {
    const Place& place = inner_[n];
    double* block = values.data() + block_of_[n] * size * size;
    const Index row = number_[static_cast<std::size_t>(place.row)] % block_;
    const Index column = number_[static_cast<std::size_t>(place.column)] % block_;
    for (Index r = 0; r < parts; ++r)
      for (Index c = 0; c < parts; ++c)
        block[(c * block_ + column) * size + r * block_ + row] =
            (*row_factors_)(place.row * width_ + first + r) *
            (*column_factors_)(place.column * width_ + first + c) *
            entries(r * parts + c, place.number);
  }
  const BlockMatrix matrix{size, static_cast<Index>(interior_.size()) / block_, begin_.data(),
                           columns_.data(), values.data()};
  if (factors_.size() <= static_cast<std::size_t>(harmonic)) factors_.emplace_back(matrix);
  return factors_[static_cast<std::size_t>(harmonic)].factor(matrix);
}

void HarmonicPreconditioner::solve_harmonic(int harmonic, Eigen::MatrixXd& right) {
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(right.rows());
  BlockFactors& factors = factors_[static_cast<std::size_t>(harmonic)];
  factors.solve(right, ones);
  factors.copy(ones, right);
}

/// `coefficients`: width x interior unknowns.
void HarmonicPreconditioner::solve_interior(Eigen::MatrixXd& coefficients) {
  const auto n = static_cast<Index>(interior_.size());
  for (int harmonic = 0; harmonic <= tangents_.harmonics(); ++harmonic) {
    const Index parts = harmonic == 0 ? 1 : 2;
    const Index first = harmonic == 0 ? 0 : 2 * harmonic - 1;
    Eigen::MatrixXd right(parts * n, 1);
    for (Index i = 0; i < n; ++i)
      for (Index p = 0; p < parts; ++p)
        right(first_row(harmonic, i) + p * block_, 0) = coefficients(first + p, i);
    solve_harmonic(harmonic, right);
    for (Index i = 0; i < n; ++i)
      for (Index p = 0; p < parts; ++p)
        coefficients(first + p, i) = right(first_row(harmonic, i) + p * block_, 0);
  }
}

bool HarmonicPreconditioner::factor(const Eigen::VectorXd& rows, const Eigen::VectorXd& columns) {
  row_factors_ = &rows;
  column_factors_ = &columns;
  for (int harmonic = 0; harmonic <= tangents_.harmonics(); ++harmonic)
    if (!factor_harmonic(harmonic)) return false;
  couplings_.clear();
  for (const Place& place : rows_of_border_)
    couplings_.push_back({number_[static_cast<std::size_t>(place.row)],
                          number_[static_cast<std::size_t>(place.column)], scaled_block(place)});
  const Index size = border_size() * width_;
  Eigen::MatrixXd schur = Eigen::MatrixXd::Zero(size, size);
  for (const Place& place : corner_)
    schur.block(number_[static_cast<std::size_t>(place.row)] * width_,
                number_[static_cast<std::size_t>(place.column)] * width_, width_, width_) =
        scaled_block(place);
  const auto n = static_cast<Index>(interior_.size());
  for (std::size_t j = 0; j < columns_of_border_.size(); ++j) {
    const std::vector<Place>& places = columns_of_border_[j];
    if (places.empty()) continue;
    Eigen::MatrixXd column = Eigen::MatrixXd::Zero(n * width_, width_);
    for (const Place& place : places)
      column.middleRows(number_[static_cast<std::size_t>(place.row)] * width_, width_) =
          scaled_block(place);
    const double least = least_coupling * column.lpNorm<Eigen::Infinity>();
    for (int harmonic = 0; harmonic <= tangents_.harmonics(); ++harmonic) {
      const Index parts = harmonic == 0 ? 1 : 2;
      const Index first = harmonic == 0 ? 0 : 2 * harmonic - 1;
      Eigen::MatrixXd all(parts * n, width_);
      for (Index i = 0; i < n; ++i)
        for (Index p = 0; p < parts; ++p)
          all.row(first_row(harmonic, i) + p * block_) = column.row(i * width_ + first + p);
      std::vector<Index> kept;
      for (Index c = 0; c < width_; ++c)
        if (all.col(c).lpNorm<Eigen::Infinity>() > least) kept.push_back(c);
      if (kept.empty()) continue;
      Eigen::MatrixXd right = all(Eigen::all, kept);
      solve_harmonic(harmonic, right);
      for (const Coupling& coupling : couplings_)
        for (Index p = 0; p < parts; ++p)
          for (std::size_t c = 0; c < kept.size(); ++c)
            schur.block(coupling.border * width_, static_cast<Index>(j) * width_ + kept[c], width_,
                        1) -=
                coupling.block.col(first + p) *
                right(first_row(harmonic, coupling.interior) + p * block_, static_cast<Index>(c));
    }
  }
  if (size == 0) return true;
  // Entries of about one, so that small pivots mean that the matrix is singular.
  const auto inverse = [](double largest) { return largest > 0.0 ? 1.0 / largest : 1.0; };
  schur_rows_ = schur.cwiseAbs().rowwise().maxCoeff().unaryExpr(inverse);
  schur = schur_rows_.asDiagonal() * schur;
  schur_columns_ = schur.cwiseAbs().colwise().maxCoeff().transpose().unaryExpr(inverse);
  schur_.compute(schur * schur_columns_.asDiagonal());
  const auto pivots = schur_.matrixLU().diagonal().cwiseAbs();
  return pivots.minCoeff() > least_pivot * pivots.maxCoeff();
}

void HarmonicPreconditioner::solve(const double* right, double* solution) {
  const Eigen::Map<const Eigen::MatrixXd> in(right, width_, tangents_.size());
  Eigen::Map<Eigen::MatrixXd> out(solution, width_, tangents_.size());
  Eigen::MatrixXd between = in(Eigen::all, interior_);
  if (border_size() > 0) {
    Eigen::MatrixXd border = in(Eigen::all, border_);
    const Eigen::MatrixXd given = between;
    solve_interior(between);
    for (const Coupling& coupling : couplings_)
      border.col(coupling.border) -= coupling.block * between.col(coupling.interior);
    border = schur_columns_
                 .cwiseProduct(schur_.solve(schur_rows_.cwiseProduct(border.reshaped().matrix())))
                 .reshaped(width_, border_size());
    out(Eigen::all, border_) = border;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(width_ * tangents_.size());
    Eigen::VectorXd y(x.size());
    x.reshaped(width_, tangents_.size())(Eigen::all, border_) = border;
    x.array() *= column_factors_->array();
    tangents_.multiply(all_columns_of_border_, x.data(), y.data());
    y.array() *= row_factors_->array();
    between = given - y.reshaped(width_, tangents_.size())(Eigen::all, interior_);
  }
  solve_interior(between);
  out(Eigen::all, interior_) = between;
}

}  // namespace samara::analysis
