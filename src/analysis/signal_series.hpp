// The signals of all initial states over a sector, of whose steps each rank has integrated some.
#pragma once

#include <vector>

#include "samara/analysis/harmonic_energy.hpp"

#include "ranks.hpp"

namespace samara::analysis {

class SignalSeries {
 public:
  /// `first`: number of the first sample of each rank, in the order of the ranks; the last entry is
  /// the number of all samples. `states`: number of initial states.
  SignalSeries(const system::PeriodicSystem& system, int sectors, std::vector<long> first,
               Eigen::Index states, const Ranks& ranks);

  /// Energy in the signals that this rank analyses.
  HarmonicEnergy& energy() { return energies_[static_cast<std::size_t>(ranks_.rank)]; }

  /// Appends the next sample of this rank: unknowns x initial states.
  void append(const Eigen::MatrixXd& states);

  /// The signals that this rank analyses, sample after sample of the whole sector, for combinations
  /// of the initial states. `weights`: initial states of the samples of this rank x combinations.
  /// Every rank calls it.
  Eigen::MatrixXd combine(const Eigen::MatrixXd& weights) const;

  /// Largest number of rows of combine() of any rank; the same on every rank.
  Eigen::Index most_rows() const { return most_signals_ * first_.back(); }

 private:
  long samples_of(int rank) const {
    const auto r = static_cast<std::size_t>(rank);
    return first_[r + 1] - first_[r];
  }

  Ranks ranks_;
  std::vector<long> first_;
  Eigen::Index most_signals_ = 0;         ///< largest number of a rank
  long taken_ = 0;                        ///< samples appended
  std::vector<HarmonicEnergy> energies_;  ///< of every rank
  std::vector<Eigen::MatrixXd> values_;   ///< for every rank: its signals of this rank's samples
};

}  // namespace samara::analysis
