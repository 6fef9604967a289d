#include "samara/analysis/harmonic_energy.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "state_parts.hpp"

namespace samara::analysis {
namespace {

using system::EnergyGroup;

/// Relative difference below which energies count as equal.
constexpr double tie = 1e-6;
/// Relative to a group's largest pivot: a smaller pivot is round-off of a semi-definite weight.
constexpr double no_energy = 1e-13;

struct Image {
  PetscInt unknown;
  double sign;
};

/// Images of the unknowns under P^-1: (P^-1 y)_j = sign_i y_i where source_i = j.
std::vector<Image> images(const system::RotorSymmetry& symmetry) {
  std::vector<Image> before(symmetry.source.size());
  for (std::size_t i = 0; i < before.size(); ++i)
    before[static_cast<std::size_t>(symmetry.source[i])] = {static_cast<PetscInt>(i),
                                                            symmetry.sign[i]};
  return before;
}

/// The unknowns that take the place of those of a group, one sector after another.
std::vector<std::vector<Image>> sectors_of(const EnergyGroup& group, int sectors,
                                           const std::vector<Image>& before) {
  std::vector<std::vector<Image>> all(1);
  for (const PetscInt unknown : group.unknowns) all[0].push_back({unknown, 1.0});
  for (int q = 1; q < sectors; ++q) {
    all.push_back(all.back());
    for (Image& image : all.back()) {
      const Image& next = before[static_cast<std::size_t>(image.unknown)];
      image = {next.unknown, image.sign * next.sign};
    }
  }
  return all;
}

PetscInt first_unknown(const std::vector<Image>& images) {
  return std::min_element(images.begin(), images.end(),
                          [](const Image& a, const Image& b) { return a.unknown < b.unknown; })
      ->unknown;
}

/// Number of groups that the symmetry maps onto each other; 0 where another group represents them
/// all.
int count_alike(const std::vector<std::vector<Image>>& sectors) {
  const PetscInt own = first_unknown(sectors[0]);
  int alike = 1;
  for (std::size_t q = 1; q < sectors.size(); ++q) {
    const PetscInt other = first_unknown(sectors[q]);
    if (other < own) return 0;
    if (other > own) ++alike;
  }
  return alike;
}

}  // namespace

Eigen::MatrixXd energy_root(const EnergyGroup& group) {
  const auto n = static_cast<Eigen::Index>(group.unknowns.size());
  const Eigen::Map<const Eigen::MatrixXd> weight(group.weight.data(), n, n);
  const Eigen::LDLT<Eigen::MatrixXd> factors(weight);
  const Eigen::VectorXd pivots = factors.vectorD();
  const double least = no_energy * pivots.maxCoeff();
  // The permutation is formed from the left: from the right the transpositions would act in the
  // wrong order.
  const Eigen::MatrixXd permutation = factors.transpositionsP() * Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd upper = Eigen::MatrixXd(factors.matrixU()) * permutation;
  Eigen::MatrixXd root(n, n);
  Eigen::Index rows = 0;
  for (Eigen::Index i = 0; i < n; ++i)
    if (pivots(i) > least) root.row(rows++) = std::sqrt(pivots(i)) * upper.row(i);
  return root.topRows(rows);
}

HarmonicEnergy::HarmonicEnergy(const system::PeriodicSystem& system, int sectors, int share,
                               int shares)
    : sectors_(sectors) {
  std::vector<Image> before;
  if (sectors > 1) before = images(system.symmetry());
  struct Entry {
    Eigen::Index signal;
    int sector;
    PetscInt unknown;
    double value;
  };
  std::vector<Entry> entries;
  std::vector<std::size_t> loads(static_cast<std::size_t>(shares), 0);
  unsigned count = 0;  // signals of all shares
  const auto add = [&](const EnergyGroup& group, Eigen::Index column) {
    const std::vector<std::vector<Image>> images = sectors_of(group, sectors, before);
    const int alike = count_alike(images);
    if (alike == 0) return;
    const Eigen::MatrixXd root = std::sqrt(static_cast<double>(alike)) * energy_root(group);
    const auto least = std::min_element(loads.begin(), loads.end());
    *least += static_cast<std::size_t>(root.rows());
    const unsigned first = count;
    count += static_cast<unsigned>(root.rows());
    if (least - loads.begin() != share) return;
    for (Eigen::Index r = 0; r < root.rows(); ++r) {
      const auto signal = static_cast<Eigen::Index>(part_of_.size());
      part_of_.push_back(column);
      numbers_.push_back(first + static_cast<unsigned>(r));
      for (int q = 0; q < sectors; ++q)
        for (Eigen::Index c = 0; c < root.cols(); ++c) {
          const Image& image = images[static_cast<std::size_t>(q)][static_cast<std::size_t>(c)];
          if (root(r, c) != 0.0)
            entries.push_back({signal, q, image.unknown, root(r, c) * image.sign});
        }
    }
  };
  for (const EnergyGroup& group : system.energy_groups()) {
    if (group.kind != EnergyGroup::Kind::kinetic) continue;
    auto found = std::find(parts_.begin(), parts_.end(), group.owner.part);
    if (found == parts_.end()) found = parts_.insert(parts_.end(), group.owner.part);
    if (!group.unknowns.empty()) add(group, found - parts_.begin());
  }
  const StateParts states = find_state_parts(system);
  columns_ = static_cast<Eigen::Index>(parts_.size() + states.owners.size());
  std::size_t state = 0;
  for (std::size_t i = 0; i < system.unknowns().size() && !states.owners.empty(); ++i) {
    const system::Unknown& unknown = system.unknowns()[i];
    if (unknown.role != system::UnknownRole::state) continue;
    EnergyGroup group;
    group.unknowns = {static_cast<PetscInt>(i)};
    group.weight = {std::pow(unknown.scale, -2)};
    add(group, static_cast<Eigen::Index>(parts_.size() + states.part_of[state++]));
  }
  const auto rows = static_cast<Eigen::Index>(part_of_.size());
  std::vector<Eigen::Triplet<double>> triplets;
  for (const Entry& entry : entries)
    triplets.emplace_back(entry.sector * rows + entry.signal, entry.unknown, entry.value);
  signals_.resize(rows * sectors, system.size());
  signals_.setFromTriplets(triplets.begin(), triplets.end());
}

HarmonicEnergy::HarmonicEnergy(Eigen::Index mixtures, int sectors)
    : parts_{"mixtures"},
      columns_(1),
      sectors_(sectors),
      part_of_(static_cast<std::size_t>(mixtures), 0) {}

const Eigen::MatrixXd& HarmonicEnergy::energies(const double* real, const double* imaginary,
                                                const Eigen::VectorXcd& factors) {
  const auto rows = static_cast<Eigen::Index>(part_of_.size());
  const Eigen::Index instants = factors.size();
  const Eigen::Index samples = instants * sectors_;
  energies_.setZero(samples, columns_);
  if (rows == 0) return energies_;
  if (!transform_ || transform_->input().cols() != samples)
    transform_ =
        std::make_unique<math::FourierTransform>(static_cast<int>(rows), static_cast<int>(samples));
  Eigen::MatrixXcd& series = transform_->input();
  for (Eigen::Index k = 0; k < instants; ++k)
    for (int q = 0; q < sectors_; ++q) {
      const Eigen::Index first = (k * sectors_ + q) * rows;
      const Eigen::Map<const Eigen::ArrayXd> re(real + first, rows);
      const Eigen::Map<const Eigen::ArrayXd> im(imaginary + first, rows);
      const std::complex<double> factor = factors(k);
      auto column = series.col(q * instants + k);
      column.real() = factor.real() * re - factor.imag() * im;
      column.imag() = factor.imag() * re + factor.real() * im;
    }
  const Eigen::MatrixXcd& spectrum = transform_->run();
  for (Eigen::Index r = 0; r < rows; ++r)
    energies_.col(part_of_[static_cast<std::size_t>(r)]) += 0.5 * spectrum.col(r).cwiseAbs2();
  return energies_;
}

/// The spectrum of a part of the instants is the sum of the harmonics that they do not distinguish.
Eigen::MatrixXd HarmonicEnergy::energies_of_part(int stride) const {
  const Eigen::Index samples = energies_.rows() / stride;
  Eigen::MatrixXd energies = Eigen::MatrixXd::Zero(samples, columns_);
  if (part_of_.empty()) return energies;
  const Eigen::MatrixXcd& spectrum = transform_->output();
  for (Eigen::Index r = 0; r < spectrum.cols(); ++r) {
    const Eigen::MatrixXcd sum = spectrum.col(r).reshaped(samples, stride).rowwise().sum();
    energies.col(part_of_[static_cast<std::size_t>(r)]) += 0.5 * sum.cwiseAbs2();
  }
  return energies;
}

void describe_energy(const Eigen::MatrixXd& energies, const std::vector<std::string>& parts,
                     int state, Mode& mode, Eigen::VectorXd& participation) {
  const Eigen::Index samples = energies.rows();
  const auto count = static_cast<Eigen::Index>(parts.size());
  mode.kinetic_energy = energies.leftCols(count).sum();
  mode.harmonic = 0;
  mode.parts.clear();
  const double share = mode.kinetic_energy > 0.0 ? 1.0 / mode.kinetic_energy : 0.0;
  for (Eigen::Index p = 0; p < count; ++p)
    mode.parts.push_back({parts[static_cast<std::size_t>(p)], share * energies.col(p).sum()});
  std::stable_sort(mode.parts.begin(), mode.parts.end(),
                   [](const PartShare& a, const PartShare& b) { return a.share > b.share; });
  // The energies that name the mode.
  const auto leading = energies.middleCols(state < 0 ? 0 : count + state, state < 0 ? count : 1);
  const double total = leading.sum();
  const double scale = total > 0.0 ? 1.0 / total : 0.0;
  const Eigen::Index half = samples / 2;
  const Eigen::VectorXd by_harmonic = leading.rowwise().sum();
  participation.resize(samples);
  participation.head(half) = scale * by_harmonic.tail(half);
  participation.tail(samples - half) = scale * by_harmonic.head(samples - half);
  if (!(total > 0.0)) return;
  Eigen::Index dominant = 0;
  leading.colwise().sum().maxCoeff(&dominant);
  const auto energy_at = [&](Eigen::Index k) {
    return leading(k >= 0 ? k : k + samples, dominant);
  };
  const double least = leading.col(dominant).maxCoeff() * (1.0 - tie);
  // Among ties the smallest k >= 0, else the largest negative one.
  Eigen::Index chosen = samples;
  for (Eigen::Index k = 0; k < samples - half && chosen == samples; ++k)
    if (energy_at(k) >= least) chosen = k;
  for (Eigen::Index k = -1; k >= -half && chosen == samples; --k)
    if (energy_at(k) >= least) chosen = k;
  mode.harmonic = static_cast<int>(chosen);
}

}  // namespace samara::analysis
