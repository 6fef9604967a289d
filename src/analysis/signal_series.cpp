#include "signal_series.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "samara/analysis/linear_algebra.hpp"

namespace samara::analysis {
namespace {

constexpr Eigen::Index mixture_count = 24;

}  // namespace

SignalSeries::SignalSeries(const system::PeriodicSystem& system, int sectors,
                           std::vector<long> first, Eigen::Index states, const Ranks& ranks)
    : ranks_(ranks),
      first_(std::move(first)),
      sectors_(sectors),
      energy_of_mixtures_(mixture_count, sectors),
      mixtures_(mixture_count * sectors * samples_of(ranks.rank), states) {
  for (int r = 0; r < ranks_.size; ++r) {
    energies_.emplace_back(system, sectors, r, ranks_.size);
    most_signals_ = std::max(most_signals_, energies_.back().signals());
    values_.emplace_back(energies_.back().signals() * samples_of(ranks_.rank), states);
    signs_.emplace_back(mixture_count, energies_.back().signals() / sectors);
    const double size = 1.0 / std::sqrt(static_cast<double>(mixture_count));
    for (Eigen::Index j = 0; j < signs_.back().cols(); ++j) {
      std::mt19937 random(energies_.back().number(j));  // the same for any number of ranks
      for (Eigen::Index i = 0; i < mixture_count; ++i) {
        const double sign = random() % 2 == 0 ? size : -size;
        signs_.back()(i, j) = energies_.back().is_kinetic(j) ? sign : 0.0;
      }
    }
  }
}

void SignalSeries::take(long sample, Eigen::Index first, const Eigen::MatrixXd& states) {
  const Eigen::Index all = mixture_count * sectors_;
  auto mixtures = mixtures_.block(sample * all, first, all, states.cols());
  mixtures.setZero();
  for (std::size_t r = 0; r < energies_.size(); ++r) {
    const Eigen::Index rows = energies_[r].signals();
    const Eigen::Index of_sector = rows / sectors_;
    auto signals = values_[r].block(sample * rows, first, rows, states.cols());
    energies_[r].take(states, signals);
    for (Eigen::Index q = 0; q < sectors_; ++q)
      mixtures.middleRows(q * mixture_count, mixture_count).noalias() +=
          signs_[r] * signals.middleRows(q * of_sector, of_sector);
  }
}

/// The samples of this rank, of the signals of a rank.
Eigen::MatrixXd SignalSeries::combine_own(std::size_t rank, const Eigen::MatrixXd& weights,
                                          long stride) const {
  if (stride == 1) return multiply(values_[rank], weights);
  const Eigen::Index signals = energies_[rank].signals();
  const long begin = first_[static_cast<std::size_t>(ranks_.rank)];
  Eigen::MatrixXd result(signals * samples_of(ranks_.rank, stride), weights.cols());
  Eigen::MatrixXd sample;
  for (Eigen::Index i = 0; i < samples_of(ranks_.rank, stride); ++i) {
    const long number = (count_before(begin, stride) + i) * stride - begin;
    multiply(values_[rank].middleRows(number * signals, signals), weights, sample);
    result.middleRows(i * signals, signals) = sample;
  }
  return result;
}

Eigen::MatrixXd SignalSeries::combine_mixtures(const Eigen::MatrixXd& weights) const {
  if (ranks_.size == 1) return multiply(mixtures_, weights);
  const Eigen::Index rows = mixture_count * sectors_;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(rows * first_.back(), weights.cols());
  all.middleRows(rows * first_[static_cast<std::size_t>(ranks_.rank)], mixtures_.rows()) =
      multiply(mixtures_, weights);
  ranks_.sum(all);
  return all;
}

Eigen::MatrixXd SignalSeries::combine(const Eigen::MatrixXd& weights, long stride) const {
  const auto own = static_cast<std::size_t>(ranks_.rank);
  if (ranks_.size == 1) return combine_own(own, weights, stride);
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
    incoming.emplace_back(signals * samples_of(r, stride), weights.cols());
    MPI_Irecv(incoming.back().data(), static_cast<int>(incoming.back().size()), MPI_DOUBLE, r, 0,
              ranks_.comm, add_request());
  }
  for (int r = 0; r < ranks_.size; ++r) {
    outgoing.push_back(combine_own(static_cast<std::size_t>(r), weights, stride));
    MPI_Isend(outgoing.back().data(), static_cast<int>(outgoing.back().size()), MPI_DOUBLE, r, 0,
              ranks_.comm, add_request());
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  Eigen::MatrixXd all(signals * count_before(first_.back(), stride), weights.cols());
  for (std::size_t r = 0; r < incoming.size(); ++r)
    all.middleRows(signals * count_before(first_[r], stride), incoming[r].rows()) = incoming[r];
  return all;
}

}  // namespace samara::analysis
