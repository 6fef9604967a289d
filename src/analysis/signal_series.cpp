#include "signal_series.hpp"

#include <algorithm>
#include <utility>

#include "samara/analysis/linear_algebra.hpp"

namespace samara::analysis {

SignalSeries::SignalSeries(const system::PeriodicSystem& system, int sectors,
                           std::vector<long> first, Eigen::Index states, const Ranks& ranks)
    : ranks_(ranks), first_(std::move(first)) {
  for (int r = 0; r < ranks_.size; ++r) {
    energies_.emplace_back(system, sectors, r, ranks_.size);
    most_signals_ = std::max(most_signals_, energies_.back().signals());
    values_.emplace_back(energies_.back().signals() * samples_of(ranks_.rank), states);
  }
}

void SignalSeries::append(const Eigen::MatrixXd& states) {
  for (std::size_t r = 0; r < energies_.size(); ++r) {
    const Eigen::Index rows = energies_[r].signals();
    energies_[r].take(states, values_[r].middleRows(taken_ * rows, rows));
  }
  ++taken_;
}

Eigen::MatrixXd SignalSeries::combine(const Eigen::MatrixXd& weights) const {
  const auto own = static_cast<std::size_t>(ranks_.rank);
  if (ranks_.size == 1) return multiply(values_[own], weights);
  const Eigen::Index signals = energies_[own].signals();
  std::vector<Eigen::MatrixXd> outgoing;
  std::vector<Eigen::MatrixXd> incoming;
  std::vector<MPI_Request> requests;
  const auto add_request = [&requests]() -> MPI_Request* {
    requests.push_back(MPI_REQUEST_NULL);
    return &requests.back();
  };
  requests.reserve(2 * energies_.size());
  for (int r = 0; r < ranks_.size; ++r) {
    incoming.emplace_back(signals * samples_of(r), weights.cols());
    MPI_Irecv(incoming.back().data(), static_cast<int>(incoming.back().size()), MPI_DOUBLE, r, 0,
              ranks_.comm, add_request());
  }
  for (int r = 0; r < ranks_.size; ++r) {
    outgoing.push_back(multiply(values_[static_cast<std::size_t>(r)], weights));
    MPI_Isend(outgoing.back().data(), static_cast<int>(outgoing.back().size()), MPI_DOUBLE, r, 0,
              ranks_.comm, add_request());
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  Eigen::MatrixXd all(signals * first_.back(), weights.cols());
  for (std::size_t r = 0; r < incoming.size(); ++r)
    all.middleRows(signals * first_[r], incoming[r].rows()) = incoming[r];
  return all;
}

}  // namespace samara::analysis
