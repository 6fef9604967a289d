#include "hill_medium.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include <Eigen/Eigenvalues>

namespace samara::analysis {

using Index = Eigen::Index;

namespace {

/// Unknowns of a matrix whose eigenvalues are found.
constexpr Index largest_matrix = 100;
/// Relative to the largest: the inverse of a finite exponent.
constexpr double least_inverse = 1e-10;

Index leader_of(const std::vector<Index>& leaders, Index i) {
  while (leaders[static_cast<std::size_t>(i)] != i) i = leaders[static_cast<std::size_t>(i)];
  return i;
}

void join(std::vector<Index>& leaders, Index i, Index j) {
  const Index a = leader_of(leaders, i);
  const Index b = leader_of(leaders, j);
  leaders[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
}

}  // namespace

HillMedium::HillMedium(const HarmonicTangents& tangents, const Eigen::VectorXd& rows,
                       const Eigen::VectorXd& columns)
    : tangents_(tangents),
      rows_(rows),
      columns_(columns),
      ranks_(tangents.partition() != nullptr ? tangents.partition()->ranks()
                                             : Ranks(MPI_COMM_SELF)) {
  list_parts();
  is_empty_ = ranks_.all(parts_.empty() && border_.unknowns.empty());
}

void HillMedium::list_parts() {
  const auto size = static_cast<std::size_t>(tangents_.size());
  const auto is_between = [this](Index i) { return is_of_medium(i) && !tangents_.is_border(i); };
  // Unknowns that refer to each other are one part: the smallest number among them leads it.
  std::vector<Index> leaders(size);
  std::iota(leaders.begin(), leaders.end(), Index{0});
  for (const Place& place : tangents_.places())
    if (is_between(place.row) && is_between(place.column)) join(leaders, place.row, place.column);
  number_in_part_.assign(size, -1);
  std::vector<std::size_t> part_of(size, 0);
  for (Index i = 0; i < tangents_.size(); ++i) {
    if (!is_of_medium(i)) continue;
    Part* part = &border_;
    if (is_between(i)) {
      const Index leader = leader_of(leaders, i);
      if (leader == i) {
        part_of[static_cast<std::size_t>(i)] = parts_.size();
        parts_.emplace_back();
      }
      part_of[static_cast<std::size_t>(i)] = part_of[static_cast<std::size_t>(leader)];
      part = &parts_[part_of[static_cast<std::size_t>(i)]];
    }
    number_in_part_[static_cast<std::size_t>(i)] = static_cast<Index>(part->unknowns.size());
    part->unknowns.push_back(i);
  }
  for (const Place& place : tangents_.places()) {
    if (!is_of_medium(place.row) || !is_of_medium(place.column)) continue;
    const bool has_row = is_between(place.row);
    const bool has_column = is_between(place.column);
    if (!has_row && !has_column) {
      border_.places.push_back(place);
      continue;
    }
    Part& part = parts_[part_of[static_cast<std::size_t>(has_row ? place.row : place.column)]];
    (has_row && has_column ? part.places
     : has_row             ? part.to_border
                           : part.of_border)
        .push_back(place);
  }
}

double HillMedium::scale(const Place& place) const {
  return rows_(place.row * tangents_.width()) * columns_(place.column * tangents_.width());
}

/// Of all harmonics.
HillMedium::Matrix HillMedium::couplings(const Places& places, Complex s, Index rows,
                                         Index columns) const {
  const Index width = tangents_.width();
  Matrix block = Matrix::Zero(rows, columns);
  for (const Place& place : places) {
    auto at =
        block.block(number_in_part_[static_cast<std::size_t>(place.row)] * width,
                    number_in_part_[static_cast<std::size_t>(place.column)] * width, width, width);
    tangents_.coupling(place, s, at);
    at *= scale(place);
  }
  return block;
}

/// All harmonics, exact.
HillMedium::Matrix HillMedium::block_of(const Part& part, Complex s) const {
  const Index width = tangents_.width();
  Matrix block = couplings(part.places, s, rows_of(part), rows_of(part));
  for (Index i = 0; i < block.rows(); ++i)
    if (!tangents_.has(part.unknowns[static_cast<std::size_t>(i / width)],
                       static_cast<int>(i % width) - tangents_.harmonics()))
      block(i, i) = 1.0;
  return block;
}

/// Mean tangents in the harmonic k.
HillMedium::Matrix HillMedium::block_of_means(const Part& part, Complex s, int k) const {
  const auto size = static_cast<Index>(part.unknowns.size());
  const Complex rate = s + Complex(0.0, k * tangents_.rate());
  Matrix block = Matrix::Zero(size, size);
  for (const Place& place : part.places)
    if (tangents_.has(place.row, k) && tangents_.has(place.column, k)) {
      const auto means = tangents_.means().col(place.number);
      block(number_in_part_[static_cast<std::size_t>(place.row)],
            number_in_part_[static_cast<std::size_t>(place.column)]) =
          scale(place) * (means(0) + rate * means(1));
    }
  for (Index i = 0; i < size; ++i)
    if (!tangents_.has(part.unknowns[static_cast<std::size_t>(i)], k)) block(i, i) = 1.0;
  return block;
}

bool HillMedium::factor(Complex s) {
  bool is_regular = true;
  const auto take = [&is_regular](Part& part, const Matrix& block) {
    part.factors.compute(block);
    is_regular = is_regular && part.factors.matrixLU().diagonal().cwiseAbs().minCoeff() > 0.0;
  };
  const Index of_border = rows_of(border_);
  Matrix complement = block_of(border_, s);
  for (Part& part : parts_) {
    take(part, block_of(part, s));
    if (of_border == 0) continue;
    part.border_rows = couplings(part.of_border, s, of_border, rows_of(part));
    part.solved_columns =
        part.factors.solve(couplings(part.to_border, s, rows_of(part), of_border));
    complement.noalias() -= part.border_rows * part.solved_columns;
  }
  if (of_border > 0) take(border_, complement);
  return ranks_.all(is_regular);
}

void HillMedium::solve(Eigen::Ref<Matrix> x) const {
  const Index width = tangents_.width();
  const auto taken = [&](const Part& part) {
    Matrix values(rows_of(part), x.cols());
    for (std::size_t i = 0; i < part.unknowns.size(); ++i)
      values.middleRows(static_cast<Index>(i) * width, width) =
          x.middleRows(part.unknowns[i] * width, width);
    return values;
  };
  const auto give = [&](const Part& part, const Matrix& values) {
    for (std::size_t i = 0; i < part.unknowns.size(); ++i)
      x.middleRows(part.unknowns[i] * width, width) =
          values.middleRows(static_cast<Index>(i) * width, width);
  };
  Matrix of_border = taken(border_);
  for (const Part& part : parts_) {
    const Matrix values = part.factors.solve(taken(part));
    give(part, values);
    if (of_border.rows() > 0) of_border.noalias() -= part.border_rows * values;
  }
  if (of_border.rows() == 0) return;
  of_border = border_.factors.solve(of_border).eval();
  give(border_, of_border);
  for (const Part& part : parts_) give(part, taken(part) - part.solved_columns * of_border);
}

HillMedium::Complex HillMedium::log_determinant_of_means(Complex s) const {
  const Index width = tangents_.width();
  const Index of_border = rows_of(border_);
  Matrix sum = Matrix::Zero(1, 1);
  const auto add = [&sum](const Factors& factors) {
    sum(0) += factors.matrixLU().diagonal().array().log().sum() +
              std::log(Complex(static_cast<double>(factors.permutationP().determinant())));
  };
  Matrix complement = block_of(border_, s);
  for (const Part& part : parts_) {
    const Matrix rows = couplings(part.of_border, s, of_border, rows_of(part));
    const Matrix columns = couplings(part.to_border, s, rows_of(part), of_border);
    for (int k = -tangents_.harmonics(); k <= tangents_.harmonics(); ++k) {
      const Factors factors(block_of_means(part, s, k));
      add(factors);
      if (of_border == 0) continue;
      const auto of_harmonic = Eigen::seqN(k + tangents_.harmonics(), part.unknowns.size(), width);
      complement.noalias() -= Matrix(rows(Eigen::all, of_harmonic)) *
                              factors.solve(Matrix(columns(of_harmonic, Eigen::all)));
    }
  }
  if (of_border > 0) add(Factors(complement));
  ranks_.sum(sum);
  return sum(0);
}

/// Of parts with their mean tangents and the other parts at rest.
std::vector<HillMedium::Complex> HillMedium::exponents_of(
    const std::vector<const Part*>& parts) const {
  std::vector<Index> first;  // of each part
  Index size = 0;
  for (const Part* part : parts) {
    first.push_back(size);
    size += static_cast<Index>(part->unknowns.size());
  }
  if (size > largest_matrix) return {};
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(size, size);
  Eigen::MatrixXd mass = stiffness;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const auto add = [&](const Places& places, Index of_rows, Index of_columns) {
      for (const Place& place : places) {
        const Index row = of_rows + number_in_part_[static_cast<std::size_t>(place.row)];
        const Index column = of_columns + number_in_part_[static_cast<std::size_t>(place.column)];
        stiffness(row, column) = tangents_.means()(0, place.number);
        mass(row, column) = tangents_.means()(1, place.number);
      }
    };
    add(parts[p]->places, first[p], first[p]);
    add(parts[p]->to_border, first[p], first.back());
    add(parts[p]->of_border, first.back(), first[p]);
  }
  // 1 / lambda are the eigenvalues of -K^-1 M; those of auxiliaries are zero.
  const Eigen::PartialPivLU<Eigen::MatrixXd> factors(stiffness);
  const Eigen::MatrixXd product = -factors.solve(mass);
  if (!product.allFinite()) return {};
  const Eigen::VectorXcd inverses = product.eigenvalues();
  const double largest = inverses.cwiseAbs().maxCoeff();
  std::vector<Complex> exponents;
  for (const Complex inverse : inverses)
    if (std::abs(inverse) > least_inverse * largest) exponents.push_back(1.0 / inverse);
  return exponents;
}

/// All parts with the border are one matrix; where it is too large for dense eigenvalues, there are
/// none.
std::vector<HillMedium::Complex> HillMedium::exponents() const {
  std::vector<Complex> all;
  std::vector<const Part*> together;
  for (const Part& part : parts_)
    if (border_.unknowns.empty())
      std::ranges::copy(exponents_of({&part}), std::back_inserter(all));
    else
      together.push_back(&part);
  if (!border_.unknowns.empty()) {
    together.push_back(&border_);
    all = exponents_of(together);
  }
  ranks_.gather(all);
  return all;
}

}  // namespace samara::analysis
