#include "harmonic_chains.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace samara::analysis {
namespace {

/// Smallest pivot in a chain, relative to the entries of its row. In a chain of 10 000 nodes pivots
/// of 1e-13 are no round-off; where they are, the iterations that use the factors do not converge.
constexpr double least_chain_pivot = 1e-16;

/// Without the test for infinite results that the operator has.
std::complex<double> product(std::complex<double> a, std::complex<double> b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

}  // namespace

void HarmonicChains::set(const std::vector<PetscInt>& unknowns, const std::vector<Index>& number,
                         std::vector<Place> places, std::vector<Index> coupled) {
  block_ = tangents_.block_size();
  unknowns_ = unknowns;
  number_ = number;
  places_ = std::move(places);
  coupled_ = std::move(coupled);
}

bool HarmonicChains::factor(const Eigen::VectorXd& rows, const Eigen::VectorXd& columns,
                            Complex shift) {
  if ((shift.imag() == 0.0) != (shift_.imag() == 0.0)) factors_.clear();
  shift_ = shift;
  // Samples say which unknowns are local, and which harmonics the unknowns have.
  bool are_others = false;
  if (samplings_ != tangents_.samplings()) {
    samplings_ = tangents_.samplings();
    are_others = locals_.find(places_, number_, static_cast<Index>(unknowns_.size()), block_,
                              tangents_.means());
  }
  if (are_others || patterns_.empty() || remainders_ != tangents_.sector().remainder) {
    remainders_ = tangents_.sector().remainder;
    patterns_.clear();
    factors_.clear();
    for (int remainder = 0; remainder < tangents_.sectors(); ++remainder) find_pattern(remainder);
  }
  scale_entries(rows, columns);
  list_links();
  bool is_regular = true;
  for (int k = first_harmonic(); k <= tangents_.harmonics(); ++k)
    is_regular = is_regular && factor(k);
  return is_regular;
}

void HarmonicChains::scale_entries(const Eigen::VectorXd& rows, const Eigen::VectorXd& columns) {
  const Eigen::MatrixXd& means = tangents_.means();
  const Index width = tangents_.width();
  entries_.resize(2, static_cast<Index>(places_.size()));
  Index next = 0;
  for (const Place& place : places_)
    entries_.col(next++) =
        rows(place.row * width) * columns(place.column * width) * means.col(place.number);
}

/// For harmonics with this remainder.
void HarmonicChains::find_pattern(int remainder) {
  Pattern pattern;
  const auto blocks = static_cast<Index>(unknowns_.size()) / block_;
  pattern.local.assign(static_cast<std::size_t>(blocks), -1);
  for (Index i = 0; i < blocks; ++i) {
    const auto first = unknowns_.begin() + i * block_;
    if (std::none_of(first, first + block_,
                     [&](PetscInt unknown) { return tangents_.has(unknown, remainder); }))
      continue;
    pattern.local[static_cast<std::size_t>(i)] = static_cast<Index>(pattern.blocks.size());
    pattern.blocks.push_back(i);
  }
  const auto local_of = [&](PetscInt unknown) {
    return pattern
        .local[static_cast<std::size_t>(number_[static_cast<std::size_t>(unknown)] / block_)];
  };
  std::vector<std::map<Index, Index>> rows(pattern.blocks.size());
  const auto is_present = [&](const Place& place) {
    return local_of(place.row) >= 0 && local_of(place.column) >= 0;
  };
  for (const Place& place : places_)
    if (is_present(place))
      rows[static_cast<std::size_t>(local_of(place.row))][local_of(place.column)] = 0;
  pattern.begin.push_back(0);
  for (std::map<Index, Index>& row : rows) {
    for (auto& [column, number] : row) {
      number = static_cast<Index>(pattern.columns.size());
      pattern.columns.push_back(static_cast<PetscInt>(column));
    }
    pattern.begin.push_back(static_cast<PetscInt>(pattern.columns.size()));
  }
  for (const Place& place : places_)
    pattern.block_of.push_back(
        is_present(place)
            ? rows[static_cast<std::size_t>(local_of(place.row))].at(local_of(place.column))
            : -1);
  const Index size = locals_.block();
  for (std::size_t n = 0; n < places_.size(); ++n) {
    const Place& place = places_[n];
    const bool has_both =
        tangents_.has(place.row, remainder) && tangents_.has(place.column, remainder);
    const Index row = locals_.position(row_of(static_cast<Index>(n)));
    const Index column = locals_.position(column_of(static_cast<Index>(n)));
    pattern.has_both.push_back(has_both ? 1 : 0);
    pattern.target.push_back(has_both && row >= 0 && column >= 0
                                 ? (pattern.block_of[n] * size + column) * size + row
                                 : -1);
  }
  std::set<Index> coupled;
  for (const Index unknown : coupled_)
    if (const Index block = pattern.local[static_cast<std::size_t>(unknown / block_)]; block >= 0)
      coupled.insert(block);
  pattern.coupled.assign(coupled.begin(), coupled.end());
  patterns_.push_back(std::move(pattern));
}

const HarmonicChains::Pattern& HarmonicChains::pattern_of(int harmonic) const {
  const int sectors = tangents_.sectors();
  return patterns_[static_cast<std::size_t>((harmonic % sectors + sectors) % sectors)];
}

/// Whether two unknowns have the harmonic of a row of coefficients.
bool HarmonicChains::have_both(Index one, Index other, Index row) const {
  const int harmonic = static_cast<int>(row) - tangents_.harmonics();
  return tangents_.has(unknowns_[static_cast<std::size_t>(one)], harmonic) &&
         tangents_.has(unknowns_[static_cast<std::size_t>(other)], harmonic);
}

void HarmonicChains::list_links() {
  linked_.clear();
  row_links_.clear();
  column_links_.clear();
  for (const LocalUnknowns::Local& local : locals_.all()) {
    const double inverse = 1.0 / entries_(0, local.diagonal);
    const auto add = [&](std::vector<Link>& links, Index n, Index other) {
      const Place& place = places_[static_cast<std::size_t>(n)];
      links.push_back({n, other, locals_.position(other), inverse * entries_(0, n),
                       inverse * entries_(1, n), !has_all(place.row) || !has_all(place.column)});
    };
    for (const Index n : local.row) add(row_links_, n, column_of(n));
    for (const Index n : local.columns) add(column_links_, n, row_of(n));
    linked_.push_back({local.unknown, local.diagonal, inverse, std::ssize(row_links_),
                       std::ssize(column_links_)});
  }
}

/// The chains without local unknowns.
bool HarmonicChains::factor(int harmonic) {
  const Index size = locals_.block();
  const Index area = size * size;
  const Pattern& pattern = pattern_of(harmonic);
  Eigen::VectorXcd values =
      Eigen::VectorXcd::Zero(static_cast<Index>(pattern.columns.size()) * area);
  const Complex rate = rate_of(harmonic);
  for (std::size_t n = 0; n < places_.size(); ++n)
    if (const Index target = pattern.target[n]; target >= 0)
      values(target) = entry(static_cast<Index>(n), rate);
  condense(harmonic, values);
  for (std::size_t n = 0; n < places_.size(); ++n)  // absent unknowns are zero
    if (const Place& place = places_[n];
        place.row == place.column && pattern.block_of[n] >= 0 && pattern.has_both[n] == 0) {
      const Index at = locals_.position(number_[static_cast<std::size_t>(place.row)]);
      if (at >= 0) values(pattern.block_of[n] * area + at * size + at) = 1.0;
    }
  const BlockMatrix<Complex> matrix{size, static_cast<Index>(pattern.blocks.size()),
                                    pattern.begin.data(), pattern.columns.data(), values.data()};
  const auto number = static_cast<std::size_t>(harmonic - first_harmonic());
  if (factors_.size() <= number) factors_.emplace_back(matrix);
  return factors_[number].factor(matrix, least_chain_pivot);
}

/// Subtracts A_rl A_lc / A_ll of the local unknowns l from the blocks of the others.
void HarmonicChains::condense(int harmonic, Eigen::VectorXcd& values) const {
  const Index size = locals_.block();
  const Pattern& pattern = pattern_of(harmonic);
  const Complex rate = rate_of(harmonic);
  std::vector<std::pair<Index, Complex>> row;  // place in a block, A_lc
  auto row_link = row_links_.begin();
  auto link = column_links_.begin();
  for (const LinkedUnknown& local : linked_) {
    row.clear();
    for (const auto end = row_links_.begin() + local.row_end; row_link != end; ++row_link)
      if (pattern.has(row_link->place))
        row.emplace_back(row_link->position * size, row_link->at(rate) / local.inverse);
    const auto end = column_links_.begin() + local.column_end;
    if (!pattern.has(local.diagonal)) link = end;
    for (; link != end; ++link) {
      if (!pattern.has(link->place)) continue;
      const Complex factor = link->at(rate);
      Complex* block = values.data() + link->position +
                       pattern.block_of[static_cast<std::size_t>(link->place)] * size * size;
      for (const auto& [place, value] : row) block[place] -= product(factor, value);
    }
  }
}

/// s + i k Omega, k = -H ... H.
Eigen::VectorXcd HarmonicChains::rates() const {
  Eigen::VectorXcd rates(tangents_.width());
  for (Index at = 0; at < tangents_.width(); ++at)
    rates(at) = rate_of(static_cast<int>(at) - tangents_.harmonics());
  return rates;
}

/// Subtracts A_rl x_l / A_ll of the local unknowns l from the right-hand sides of the others.
void HarmonicChains::condense(Eigen::MatrixXcd& coefficients) const {
  const auto interior = static_cast<Index>(unknowns_.size());
  const Eigen::VectorXcd factors = rates();
  Eigen::VectorXcd rate(tangents_.width());
  for (Index first = 0; first < coefficients.cols(); first += interior) {
    auto link = column_links_.begin();
    for (const LinkedUnknown& local : linked_) {
      const auto value = coefficients.col(first + local.unknown);
      rate = factors.cwiseProduct(value);
      for (const auto end = column_links_.begin() + local.column_end; link != end; ++link) {
        auto other = coefficients.col(first + link->other);
        if (!link->is_partial)
          other -= link->value * value + link->rate * rate;
        else
          for (Index at = 0; at < tangents_.width(); ++at)
            if (have_both(local.unknown, link->other, at))
              other(at) -= link->value * value(at) + link->rate * rate(at);
      }
    }
  }
}

/// x_l = (right_l - A_lc x_c) / A_ll of the local unknowns l.
void HarmonicChains::recover(Eigen::MatrixXcd& coefficients) const {
  const auto interior = static_cast<Index>(unknowns_.size());
  const Eigen::VectorXcd factors = rates();
  Eigen::VectorXcd values(tangents_.width());
  Eigen::VectorXcd of_rates(tangents_.width());
  for (Index first = 0; first < coefficients.cols(); first += interior) {
    auto link = row_links_.begin();
    for (const LinkedUnknown& local : linked_) {
      auto own = coefficients.col(first + local.unknown);
      values.setZero();
      of_rates.setZero();
      for (const auto end = row_links_.begin() + local.row_end; link != end; ++link) {
        const auto other = coefficients.col(first + link->other);
        if (!link->is_partial) {
          values += link->value * other;
          of_rates += link->rate * other;
        } else {
          for (Index at = 0; at < tangents_.width(); ++at)
            if (have_both(local.unknown, link->other, at)) {
              values(at) += link->value * other(at);
              of_rates(at) += link->rate * other(at);
            }
        }
      }
      for (Index at = 0; at < tangents_.width(); ++at)
        if (have_both(local.unknown, local.unknown, at))
          own(at) = local.inverse * own(at) - values(at) - factors(at) * of_rates(at);
    }
  }
}

void HarmonicChains::solve(Eigen::MatrixXcd& coefficients, bool only_coupled) {
  const int harmonics = tangents_.harmonics();
  const auto unknowns = static_cast<Index>(unknowns_.size());
  if (unknowns == 0) return;  // of a rank without a piece of the mesh
  const Index columns = coefficients.cols() / unknowns;
  const Index size = locals_.block();
  condense(coefficients);
  Eigen::MatrixXcd right;
  for (int k = first_harmonic(); k <= harmonics; ++k) {
    const Pattern& pattern = pattern_of(k);
    const std::vector<Index>& blocks = pattern.blocks;
    right.resize(static_cast<Index>(blocks.size()) * size, columns);
    const auto each_row = [&](const auto& call) {
      for (Index c = 0; c < columns; ++c)
        for (std::size_t i = 0; i < blocks.size(); ++i)
          for (Index unknown = blocks[i] * block_; unknown < (blocks[i] + 1) * block_; ++unknown)
            if (const Index at = locals_.position(unknown); at >= 0)
              call(right(static_cast<Index>(i) * size + at, c),
                   coefficients(k + harmonics, c * unknowns + unknown));
    };
    each_row([](Complex& row, const Complex& coefficient) { row = coefficient; });
    if (only_coupled) {
      std::vector<Index> all(blocks.size());
      std::iota(all.begin(), all.end(), Index{0});
      factors_of(k).solve_part(right, all, pattern.coupled);
    } else {
      factors_of(k).solve(right);
    }
    each_row([](const Complex& row, Complex& coefficient) { coefficient = row; });
  }
  recover(coefficients);
}

HarmonicChains::Complex HarmonicChains::log_determinant() const {
  Complex sum = 0.0;
  for (const BlockFactors<Complex>& factors : factors_) sum += factors.log_determinant();
  return sum;
}

HarmonicChains::Columns::Columns(HarmonicChains& chains, int harmonic,
                                 const std::vector<Index>& filled)
    : all_(chains), harmonic_(harmonic) {
  const Pattern& pattern = all_.pattern_of(harmonic);
  std::set<Index> blocks;
  for (const Index unknown : filled)
    if (const Index block = pattern.local[static_cast<std::size_t>(unknown / all_.block_)];
        block >= 0)
      blocks.insert(block);
  filled_.assign(blocks.begin(), blocks.end());
  if (!filled_.empty()) list_transfers();
}

HarmonicChains::Columns::~Columns() { all_.factors_of(harmonic_).release(); }

HarmonicChains::Index HarmonicChains::Columns::row_of(Index unknown) const {
  const Index block =
      all_.pattern_of(harmonic_).local[static_cast<std::size_t>(unknown / all_.block_)];
  return block < 0 ? block : block * all_.block_ + unknown % all_.block_;
}

void HarmonicChains::Columns::start(Index count, Eigen::MatrixXcd& right) const {
  const Index size = all_.block_;
  right.resize(static_cast<Index>(all_.pattern_of(harmonic_).blocks.size()) * size, count);
  for (const Index block : filled_) right.middleRows(block * size, size).setZero();
}

/// Those of HarmonicChains::condense() and recover().
void HarmonicChains::Columns::list_transfers() {
  const Pattern& pattern = all_.pattern_of(harmonic_);
  const LocalUnknowns& locals = all_.locals_;
  const Complex rate = all_.rate_of(harmonic_);
  const Index size = locals.block();
  std::vector<char> is_filled(pattern.blocks.size(), 0);
  for (const Index block : filled_) is_filled[static_cast<std::size_t>(block)] = 1;
  std::vector<char> is_coupled(pattern.blocks.size(), 0);
  for (const Index block : pattern.coupled) is_coupled[static_cast<std::size_t>(block)] = 1;
  std::vector<char> is_reached = is_filled;
  for (std::size_t block = 0; block < pattern.blocks.size(); ++block)
    for (Index at = 0; at < all_.block_; ++at) {
      const Index left = locals.position(pattern.blocks[block] * all_.block_ + at);
      if (left < 0) continue;
      const auto number = static_cast<Index>(block);
      const Index own = number * all_.block_ + at;
      if (is_filled[block] != 0) condense_.push_back({own, number * size + left, 1.0});
      if (is_coupled[block] != 0) recover_.push_back({number * size + left, own, 1.0});
    }
  auto column_link = all_.column_links_.begin();
  auto row_link = all_.row_links_.begin();
  for (const LinkedUnknown& local : all_.linked_) {
    const auto column_end = all_.column_links_.begin() + local.column_end;
    const auto row_end = all_.row_links_.begin() + local.row_end;
    const Index own = row_of(local.unknown);
    const auto block = static_cast<std::size_t>(own / all_.block_);
    const bool is_present = pattern.has(local.diagonal);
    const bool fills = is_present && is_filled[block] != 0;
    if (!fills) column_link = column_end;
    for (; column_link != column_end; ++column_link) {
      if (!pattern.has(column_link->place)) continue;
      const Index to = row_of(column_link->other) / all_.block_;
      is_reached[static_cast<std::size_t>(to)] = 1;
      condense_.push_back({own, to * size + column_link->position, -column_link->at(rate)});
    }
    if (!is_present || is_coupled[block] == 0) {
      row_link = row_end;
      continue;
    }
    if (fills) recover_local_.push_back({own, own, local.inverse - 1.0});
    for (; row_link != row_end; ++row_link)
      if (pattern.has(row_link->place))
        recover_local_.push_back({row_of(row_link->other), own, -row_link->at(rate)});
  }
  for (std::size_t block = 0; block < is_reached.size(); ++block)
    if (is_reached[block] != 0) reached_.push_back(static_cast<Index>(block));
}

void HarmonicChains::Columns::add(const std::vector<Transfer>& transfers,
                                  const Eigen::MatrixXcd& from, Eigen::MatrixXcd& to) {
  for (Index c = 0; c < to.cols(); ++c) {
    const Complex* of_column = from.col(c).data();
    Complex* to_column = to.col(c).data();
    for (const Transfer& one : transfers)
      to_column[one.to] += product(one.factor, of_column[one.from]);
  }
}

void HarmonicChains::Columns::solve(Eigen::MatrixXcd& right) {
  const Pattern& pattern = all_.pattern_of(harmonic_);
  const Index size = all_.locals_.block();
  condensed_.resize(static_cast<Index>(pattern.blocks.size()) * size, right.cols());
  for (const Index block : reached_) condensed_.middleRows(block * size, size).setZero();
  add(condense_, right, condensed_);
  all_.factors_of(harmonic_).solve_part(condensed_, reached_, pattern.coupled);
  for (const Index block : pattern.coupled)
    if (!std::ranges::binary_search(filled_, block))
      right.middleRows(block * all_.block_, all_.block_).setZero();
  for (const Transfer& one : recover_) right.row(one.to).setZero();
  add(recover_, condensed_, right);
  add(recover_local_, right, right);
}

}  // namespace samara::analysis
