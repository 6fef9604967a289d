#include "rotor_sector.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

namespace samara::analysis {
namespace {

/// Whether an unknown has no meaning but to fill up a block.
bool fills_up(const system::Unknown& unknown) { return unknown.quantity.empty(); }

}  // namespace

RotorSector::RotorSector(PetscInt size)
    : kept(static_cast<std::size_t>(size)), remainder(static_cast<std::size_t>(size), every) {
  std::iota(kept.begin(), kept.end(), 0);
  number = kept;
}

RotorSector::RotorSector(const system::PeriodicSystem& system, const TangentPattern& pattern,
                         PetscInt block_size)
    : RotorSector(system.size()) {
  const system::RotorSymmetry& symmetry = system.symmetry();
  if (symmetry.sectors < 2) return;
  const auto size = static_cast<PetscInt>(symmetry.source.size());
  std::vector<PetscInt> leader(symmetry.source.size());  // the same unknown of the first blade
  std::vector<char> moves(symmetry.source.size(), 0);
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
    moves[at] = length > 1 ? 1 : 0;
  }
  // What fills up the blocks of a blade goes with them.
  for (PetscInt first = 0; first < size; first += block_size) {
    int moved = 0;
    int own = 0;
    int filling = 0;
    for (PetscInt i = first; i < first + block_size; ++i) {
      const auto at = static_cast<std::size_t>(i);
      moved += moves[at];
      own += moves[at] && leader[at] == i ? 1 : 0;
      filling += fills_up(system.unknowns()[at]) ? 1 : 0;
    }
    if (moved + filling != block_size || (own != 0 && own != moved)) continue;
    for (PetscInt i = first; i < first + block_size; ++i)
      if (const auto at = static_cast<std::size_t>(i); !moves[at]) {
        moves[at] = 1;
        leader[at] = own > 0 ? i : -1;
      }
  }
  std::vector<PetscInt> of_first;
  std::vector<PetscInt> numbers(symmetry.source.size(), -1);
  std::vector<int> remainders;
  for (PetscInt i = 0; i < size; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (leader[at] != i) continue;
    numbers[at] = static_cast<PetscInt>(of_first.size());
    of_first.push_back(i);
    remainders.push_back(moves[at] ? every : (symmetry.sign[at] > 0.0 ? 0 : symmetry.sectors / 2));
  }
  for (std::size_t i = 0; i < of_first.size(); ++i)
    for (TangentPattern::InnerIterator it(pattern, of_first[i]); it && remainders[i] == every; ++it)
      if (numbers[static_cast<std::size_t>(it.col())] < 0 &&
          of_first[i] / block_size != it.col() / block_size)
        return;
  sectors = symmetry.sectors;
  kept = std::move(of_first);
  number = std::move(numbers);
  remainder = std::move(remainders);
}

void RotorSector::drop_absent(Eigen::Ref<Eigen::MatrixXd> coefficients) const {
  if (sectors == 1) return;
  const auto size = static_cast<Eigen::Index>(kept.size());
  const auto harmonics = static_cast<int>((coefficients.rows() - 1) / 2);
  for (Eigen::Index at = 0; at < coefficients.cols(); ++at) {
    const auto i = static_cast<PetscInt>(at % size);
    if (!has(i, 0)) coefficients(0, at) = 0.0;
    for (int k = 1; k <= harmonics; ++k)
      if (!has(i, k) && !has(i, -k)) coefficients.col(at).segment(2 * k - 1, 2).setZero();
  }
}

/// P Z_k = exp(-2 pi i k / Q) Z_k, where (P y)_i = sign_i y_source(i). `turn`: a column times that
/// factor.
template <class Matrix, class Turn>
Matrix RotorSector::spread(const system::RotorSymmetry& symmetry, const Matrix& own,
                           Turn turn) const {
  Matrix all = Matrix::Zero(own.rows(), static_cast<Eigen::Index>(number.size()));
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const PetscInt first = kept[i];
    all.col(first) = own.col(static_cast<Eigen::Index>(i));
    if (sectors == 1) continue;
    for (PetscInt j = first; symmetry.source[static_cast<std::size_t>(j)] != first;) {
      const PetscInt next = symmetry.source[static_cast<std::size_t>(j)];
      all.col(next) = symmetry.sign[static_cast<std::size_t>(j)] * turn(all.col(j));
      j = next;
    }
  }
  return all;
}

Eigen::MatrixXcd RotorSector::whole(const system::RotorSymmetry& symmetry,
                                    const Eigen::MatrixXcd& series) const {
  const Eigen::Index harmonics = (series.rows() - 1) / 2;
  Eigen::VectorXcd factors(series.rows());
  for (Eigen::Index k = -harmonics; k <= harmonics; ++k)
    factors(k + harmonics) =
        std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k % sectors) / sectors);
  return spread(symmetry, series, [&factors](const auto& column) -> Eigen::VectorXcd {
    return factors.cwiseProduct(column);
  });
}

Eigen::MatrixXd RotorSector::whole(const system::RotorSymmetry& symmetry,
                                   const Eigen::Ref<const Eigen::MatrixXd>& coefficients) const {
  const auto harmonics = static_cast<int>((coefficients.rows() - 1) / 2);
  const auto turn = [this, harmonics](const auto& column) {
    Eigen::VectorXd turned = column;
    for (int k = 1; k <= harmonics; ++k) {  // of (a - i b) / 2
      const double angle = 2.0 * std::numbers::pi * (k % sectors) / sectors;
      const double a = column(2 * k - 1);
      const double b = column(2 * k);
      turned(2 * k - 1) = a * std::cos(angle) - b * std::sin(angle);
      turned(2 * k) = b * std::cos(angle) + a * std::sin(angle);
    }
    return turned;
  };
  return spread(symmetry, Eigen::MatrixXd(coefficients), turn);
}

}  // namespace samara::analysis
