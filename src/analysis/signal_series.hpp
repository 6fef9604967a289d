// The signals of all initial states over a sector. Each rank has some of the signals.
//
// Each rank integrates some of the initial states, but a mode combines all of them. During the
// integration every rank therefore sends each other rank the signals that this rank analyses, and
// receives its own signals of all states.
#pragma once

#include <array>
#include <vector>

#include "samara/analysis/harmonic_energy.hpp"

#include "ranks.hpp"

namespace samara::analysis {

class SignalSeries {
 public:
  /// `states`: number of initial states, which are distributed to the ranks in turn.
  SignalSeries(const system::PeriodicSystem& system, int sectors, long steps, Eigen::Index states,
               const Ranks& ranks);
  /// Does not wait: pending messages are cancelled where an analysis ends early.
  ~SignalSeries();
  SignalSeries(const SignalSeries&) = delete;
  SignalSeries& operator=(const SignalSeries&) = delete;

  /// Energy in the signals of this rank.
  HarmonicEnergy& energy() { return energies_[static_cast<std::size_t>(ranks_.rank)]; }

  /// Appends the states of this rank at the middle of the next step. Every rank calls it once per
  /// step.
  void append(const Eigen::MatrixXd& states);

  /// Signals of this rank, step after step, x all initial states; complete after the last step.
  const Eigen::MatrixXd& values() const { return values_; }

  /// Largest number of rows of values() of any rank; the same on every rank.
  Eigen::Index most_rows() const { return most_signals_ * steps_; }

 private:
  /// Messages of one block of steps.
  struct Block {
    std::vector<Eigen::MatrixXd> outgoing, incoming;  ///< to and from every rank
    std::vector<MPI_Request> requests;
    long first = 0;  ///< step of the series
    long steps = 0;
  };

  void send(Block& block) const;
  void receive(Block& block);
  Eigen::Index states_of(int rank) const {
    return (states_ - rank + ranks_.size - 1) / ranks_.size;
  }

  Ranks ranks_;
  Eigen::Index states_;
  long steps_;
  Eigen::Index most_signals_ = 0;         ///< largest number of a rank
  long block_;                            ///< steps that are sent together
  long taken_ = 0;                        ///< steps appended
  std::vector<HarmonicEnergy> energies_;  ///< of every rank
  std::array<Block, 2> blocks_;           ///< one is sent while the other is filled
  Eigen::MatrixXd values_;
};

}  // namespace samara::analysis
