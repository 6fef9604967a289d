#include "signal_series.hpp"

namespace samara::analysis {
namespace {

/// Approximate number of values in a message to another rank.
constexpr Eigen::Index message_values = 1 << 18;

}  // namespace

SignalSeries::SignalSeries(const system::PeriodicSystem& system, int sectors, long steps,
                           Eigen::Index states, const Ranks& ranks)
    : ranks_(ranks), states_(states), steps_(steps) {
  for (int r = 0; r < ranks_.size; ++r) {
    energies_.emplace_back(system, sectors, r, ranks_.size);
    most_signals_ = std::max(most_signals_, energies_.back().signals());
  }
  const Eigen::Index most_values = std::max<Eigen::Index>(1, most_signals_ * states_of(0));
  block_ = std::clamp<long>(message_values / most_values, 1, steps);
  for (Block& block : blocks_) {
    block.outgoing.resize(energies_.size());
    block.incoming.resize(energies_.size());
  }
  values_.resize(energy().signals() * steps, states);
}

SignalSeries::~SignalSeries() {
  for (Block& block : blocks_)
    for (MPI_Request& request : block.requests) {
      if (request == MPI_REQUEST_NULL) continue;
      MPI_Cancel(&request);
      MPI_Request_free(&request);
    }
}

void SignalSeries::append(const Eigen::MatrixXd& states) {
  if (ranks_.size == 1) {
    energy().take(states, values_.middleRows(taken_ * energy().signals(), energy().signals()));
    ++taken_;
    return;
  }
  Block& block = blocks_[static_cast<std::size_t>(taken_ / block_ % 2)];
  const long place = taken_ % block_;
  if (place == 0) {
    receive(block);
    block.first = taken_;
    block.steps = std::min(block_, steps_ - taken_);
  }
  for (std::size_t r = 0; r < energies_.size(); ++r) {
    const Eigen::Index rows = energies_[r].signals();
    block.outgoing[r].resize(rows * block.steps, states.cols());
    energies_[r].take(states, block.outgoing[r].middleRows(place * rows, rows));
  }
  ++taken_;
  if (place + 1 == block.steps) send(block);
  if (taken_ == steps_)
    for (Block& last : blocks_) receive(last);
}

void SignalSeries::send(Block& block) const {
  const auto own = static_cast<std::size_t>(ranks_.rank);
  const Eigen::Index rows = block.outgoing[own].rows();
  for (int r = 0; r < ranks_.size; ++r) {
    if (r == ranks_.rank) continue;
    Eigen::MatrixXd& incoming = block.incoming[static_cast<std::size_t>(r)];
    const Eigen::MatrixXd& outgoing = block.outgoing[static_cast<std::size_t>(r)];
    incoming.resize(rows, states_of(r));
    block.requests.push_back(MPI_REQUEST_NULL);
    MPI_Irecv(incoming.data(), static_cast<int>(incoming.size()), MPI_DOUBLE, r, 0, ranks_.comm,
              &block.requests.back());
    block.requests.push_back(MPI_REQUEST_NULL);
    MPI_Isend(outgoing.data(), static_cast<int>(outgoing.size()), MPI_DOUBLE, r, 0, ranks_.comm,
              &block.requests.back());
  }
  std::swap(block.incoming[own], block.outgoing[own]);
}

void SignalSeries::receive(Block& block) {
  if (block.requests.empty()) return;
  MPI_Waitall(static_cast<int>(block.requests.size()), block.requests.data(), MPI_STATUSES_IGNORE);
  block.requests.clear();
  const Eigen::Index first = block.first * energy().signals();
  for (int r = 0; r < ranks_.size; ++r) {
    const Eigen::MatrixXd& incoming = block.incoming[static_cast<std::size_t>(r)];
    for (Eigen::Index j = 0; j < incoming.cols(); ++j)
      values_.block(first, r + j * ranks_.size, incoming.rows(), 1) = incoming.col(j);
  }
}

}  // namespace samara::analysis
