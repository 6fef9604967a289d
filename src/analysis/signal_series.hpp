// The signals of all initial states over a sector, dealt over the ranks by what they belong to.
//
// Ranks integrate some of the initial states each, but a mode combines all of them: while the steps
// go on, every rank sends the others the signals they are to analyse, and keeps its own share of
// all states.
#pragma once

#include <array>
#include <vector>

#include "samara/analysis/harmonic_energy.hpp"

#include "ranks.hpp"

namespace samara::analysis {

class SignalSeries {
 public:
  /// `states` initial states, dealt to the ranks in turn.
  SignalSeries(const system::PeriodicSystem& system, int sectors, long steps, Eigen::Index states,
               const Ranks& ranks);
  /// Waits for nothing: messages on their way are given up where an analysis ends early.
  ~SignalSeries();
  SignalSeries(const SignalSeries&) = delete;
  SignalSeries& operator=(const SignalSeries&) = delete;

  /// The share of this rank.
  HarmonicEnergy& energy() { return energies_[static_cast<std::size_t>(ranks_.rank)]; }

  /// The own states in the middle of the next step. Every rank calls it once a step.
  void append(const Eigen::MatrixXd& states);

  /// Signals of this rank, step after step, x all initial states; whole after the last step.
  const Eigen::MatrixXd& values() const { return values_; }

  /// Rows of the rank that has most; the same on every rank.
  Eigen::Index most_rows() const { return most_signals_ * steps_; }

 private:
  /// Messages of one block of steps.
  struct Block {
    std::vector<Eigen::MatrixXd> outgoing, incoming;  ///< to and from every rank
    std::vector<MPI_Request> requests;
    long first = 0;  ///< step
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
  Eigen::Index most_signals_ = 0;         ///< of a rank
  long block_;                            ///< steps that are sent together
  long taken_ = 0;                        ///< steps
  std::vector<HarmonicEnergy> energies_;  ///< of every rank
  std::array<Block, 2> blocks_;           ///< one on its way while the other is filled
  Eigen::MatrixXd values_;
};

}  // namespace samara::analysis
