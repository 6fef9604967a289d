// The signals of all initial states over a sector, of whose steps each rank has integrated some.
#pragma once

#include <vector>

#include "samara/analysis/harmonic_energy.hpp"
#include "samara/analysis/ranks.hpp"

namespace samara::analysis {

class SignalSeries {
 public:
  /// `first`: number of the first sample of each rank, in the order of the ranks; the last entry is
  /// the number of all samples. `states`: number of initial states.
  SignalSeries(const system::PeriodicSystem& system, int sectors, std::vector<long> first,
               Eigen::Index states, const Ranks& ranks);

  /// Energy in the signals that this rank analyses.
  HarmonicEnergy& energy() { return energies_[static_cast<std::size_t>(ranks_.rank)]; }
  /// Energy in the mixtures.
  HarmonicEnergy& energy_of_mixtures() { return energy_of_mixtures_; }

  /// Takes a sample of this rank, of the initial states from `first` on: unknowns x states.
  /// `sample`: its number among those of this rank.
  void take(long sample, Eigen::Index first, const Eigen::MatrixXd& states);

  /// The signals that this rank analyses, at every `stride`-th sample of the whole sector from its
  /// first one, sample after sample, for combinations of the initial states. `weights`: initial
  /// states of the samples of this rank x combinations. Every rank calls it.
  Eigen::MatrixXd combine(const Eigen::MatrixXd& weights, long stride) const;
  /// The mixtures at all samples, in the same way; the same on every rank. Mixtures are sums of all
  /// signals of the kinetic energy with random signs, whose mean energy is the kinetic energy; with
  /// 24 of them the estimate has a standard deviation of at most 29 %.
  Eigen::MatrixXd combine_mixtures(const Eigen::MatrixXd& weights) const;

  /// Largest number of rows of combine() with stride 1 of any rank; the same on every rank.
  Eigen::Index most_rows() const { return most_signals_ * first_.back(); }

 private:
  long samples_of(int rank) const {
    const auto r = static_cast<std::size_t>(rank);
    return first_[r + 1] - first_[r];
  }
  /// Number of samples before a sample at multiples of a stride.
  static long count_before(long sample, long stride) { return (sample + stride - 1) / stride; }
  long samples_of(int rank, long stride) const {
    const auto r = static_cast<std::size_t>(rank);
    return count_before(first_[r + 1], stride) - count_before(first_[r], stride);
  }
  Eigen::MatrixXd combine_own(std::size_t rank, const Eigen::MatrixXd& weights, long stride) const;

  Ranks ranks_;
  std::vector<long> first_;
  Eigen::Index most_signals_ = 0;         ///< largest number of a rank
  std::vector<HarmonicEnergy> energies_;  ///< of every rank
  std::vector<Eigen::MatrixXd> values_;   ///< for every rank: its signals of this rank's samples
  int sectors_;
  HarmonicEnergy energy_of_mixtures_;
  std::vector<Eigen::MatrixXd> signs_;  ///< for every rank: mixtures x its signals of a sector
  Eigen::MatrixXd mixtures_;            ///< of this rank's samples
};

}  // namespace samara::analysis
