#include "energy_shares.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "samara/analysis/harmonic_energy.hpp"

namespace samara::analysis {
namespace {

/// Least share in harmonics beyond reach, and least energy, of a mode that is described by
/// fewer samples. By mixtures the share is known to a third of itself, and a resolved mode has less
/// than 0.01.
constexpr double beyond_doubt = 0.3;
constexpr double least_energy = 1e-6;
/// Least number of these samples in a period.
constexpr long samples_of_fast_modes = 12;
/// Approximate number of values in the time series of the modes that are described together.
constexpr Eigen::Index batch_values = 1 << 24;

}  // namespace

EnergyShares::EnergyShares(SignalSeries& series, const Samples& samples, const Ranks& ranks)
    : series_(series),
      at_(samples),
      ranks_(ranks),
      count_(samples.steps * samples.of_step * samples.sectors) {}

Eigen::MatrixXd EnergyShares::describe(const Motions& motions, ModeSet& set) {
  motions_ = &motions;
  const auto count = static_cast<Index>(set.modes.size());
  set.participation.setZero(count, count_);
  sampled_.setZero(count, count_);
  const std::vector<signed char> is_fast = estimate();
  std::vector<Index> slow;
  std::vector<Index> fast;
  for (Index m = 0; m < count; ++m)
    (is_fast[static_cast<std::size_t>(m)] != 0 ? fast : slow).push_back(m);
  in_batches(slow, series_.most_rows(), [&](const auto& modes) { describe_slow(modes, set); });
  const long stride = stride_of_fast_modes();
  in_batches(fast, series_.most_rows() / stride,
             [&](const auto& modes) { describe_fast(modes, stride, set); });
  return sampled_;
}

/// `rows`: of the time series of a mode.
template <class Work>
void EnergyShares::in_batches(const std::vector<Index>& modes, Index rows, const Work& work) {
  const Index batch = std::max<Index>(1, batch_values / std::max<Index>(1, 2 * rows));
  const auto count = static_cast<Index>(modes.size());
  for (Index first = 0; first < count; first += batch)
    work(std::vector<Index>(modes.begin() + first, modes.begin() + std::min(first + batch, count)));
}

/// Calls work(place among `modes`, real part, imaginary part, factors of the instants) for time
/// series of the modes at every `stride`-th sample. The factors leave the periodic shape.
template <class Work>
void EnergyShares::for_each_shape(const std::vector<Index>& modes, const Eigen::MatrixXd& values,
                                  long stride, const Work& work) const {
  Eigen::VectorXcd factors((at_.steps * at_.of_step + stride - 1) / stride);
  for (Index i = 0; i < static_cast<Index>(modes.size()); ++i) {
    const Complex exponent =
        motions_->exponents[static_cast<std::size_t>(modes[static_cast<std::size_t>(i)])];
    for (Index k = 0; k < factors.size(); ++k)
      factors(k) =
          std::exp(-exponent * (static_cast<double>(k * stride) * at_.distance + at_.first));
    work(i, values.col(2 * i).data(), values.col(2 * i + 1).data(), factors);
  }
}

/// Estimates the shares by harmonic from mixtures of the signals. Returns 1 for each mode that is
/// too fast for the step beyond doubt. (First-order states are not in the mixtures.) Each rank does
/// so for some of the modes.
std::vector<signed char> EnergyShares::estimate() {
  std::vector<signed char> is_fast(motions_->exponents.size(), 0);
  std::vector<Index> all(is_fast.size());
  std::iota(all.begin(), all.end(), 0);
  HarmonicEnergy& energy = series_.energy_of_mixtures();
  in_batches(all, energy.signals() * count_, [&](const std::vector<Index>& modes) {
    const Eigen::MatrixXd values = series_.combine_mixtures(motions_->weights(modes));
    for_each_shape(
        modes, values, 1,
        [&](Index i, const double* re, const double* im, const Eigen::VectorXcd& factors) {
          const Index m = modes[static_cast<std::size_t>(i)];
          if (m % ranks_.size != ranks_.rank) return;
          const auto mode = static_cast<std::size_t>(m);
          Mode unused;
          Eigen::VectorXd shares;
          describe_energy(energy.energies(re, im, factors), energy.part_names(), -1, unused,
                          shares);
          sampled_.row(m) = shares;
          if (motions_->states[mode] < 0 && unused.kinetic_energy > least_energy &&
              motions_->fast_share(mode, shares) > beyond_doubt)
            is_fast[mode] = 1;
        });
  });
  ranks_.sum(sampled_);
  MPI_Allreduce(MPI_IN_PLACE, is_fast.data(), static_cast<int>(is_fast.size()), MPI_SIGNED_CHAR,
                MPI_MAX, ranks_.comm);
  return is_fast;
}

/// Every rank has the energies of some signals of each mode; the modes need the sum over all ranks.
void EnergyShares::describe_slow(const std::vector<Index>& modes, ModeSet& set) {
  HarmonicEnergy& energy = series_.energy();
  const Index parts = energy.columns();
  const Eigen::MatrixXd values = series_.combine(motions_->weights(modes), 1);
  Eigen::MatrixXd energies(count_, parts * static_cast<Index>(modes.size()));
  Eigen::MatrixXd of_ends(count_ / at_.of_step, energies.cols());
  for_each_shape(modes, values, 1,
                 [&](Index i, const double* re, const double* im, const Eigen::VectorXcd& factors) {
                   energies.middleCols(i * parts, parts) = energy.energies(re, im, factors);
                   of_ends.middleCols(i * parts, parts) = energy.energies_of_part(at_.of_step);
                 });
  ranks_.sum(energies);
  ranks_.sum(of_ends);
  Eigen::VectorXd shares;
  Eigen::VectorXd at_ends;
  for (Index i = 0; i < static_cast<Index>(modes.size()); ++i) {
    const Index m = modes[static_cast<std::size_t>(i)];
    const auto mode = static_cast<std::size_t>(m);
    describe_energy(energies.middleCols(i * parts, parts), energy.part_names(),
                    motions_->states[mode], set.modes[mode], shares);
    Mode unused;
    describe_energy(of_ends.middleCols(i * parts, parts), energy.part_names(),
                    motions_->states[mode], unused, at_ends);
    sampled_.row(m) = shares;
    set.participation.row(m) = spread(at_ends, shares);
  }
}

/// Distance of samples at the ends of steps, as few as still give mean values over the period.
long EnergyShares::stride_of_fast_modes() const {
  for (long steps = at_.steps; steps > 1; --steps)
    if (at_.steps % steps == 0 && at_.steps / steps * at_.sectors >= samples_of_fast_modes)
      return steps * at_.of_step;
  return at_.of_step;
}

/// Finds energies and parts at every `stride`-th sample. The estimate says which harmonics they
/// have.
void EnergyShares::describe_fast(const std::vector<Index>& modes, long stride, ModeSet& set) {
  HarmonicEnergy& energy = series_.energy();
  const Index parts = energy.columns();
  const Eigen::MatrixXd values = series_.combine(motions_->weights(modes), stride);
  Eigen::MatrixXd energies(count_ / stride, parts * static_cast<Index>(modes.size()));
  for_each_shape(modes, values, stride,
                 [&](Index i, const double* re, const double* im, const Eigen::VectorXcd& factors) {
                   energies.middleCols(i * parts, parts) = energy.energies(re, im, factors);
                 });
  ranks_.sum(energies);
  Eigen::VectorXd shares;
  for (Index i = 0; i < static_cast<Index>(modes.size()); ++i) {
    const Index m = modes[static_cast<std::size_t>(i)];
    Mode& mode = set.modes[static_cast<std::size_t>(m)];
    describe_energy(energies.middleCols(i * parts, parts), energy.part_names(), -1, mode, shares);
    const Eigen::VectorXd estimate = sampled_.row(m);
    mode.harmonic =
        static_cast<int>(likeliest_place(mode.harmonic, count_ / stride, estimate) - count_ / 2);
    set.participation.row(m) = spread(shares, estimate);
  }
}

/// Place of the harmonic with the largest share, among those that `count` samples do not
/// distinguish from the given one.
Eigen::Index EnergyShares::likeliest_place(Index harmonic, Index count,
                                           const Eigen::VectorXd& shares) const {
  Index place = (harmonic + count_ / 2) % count;
  if (place < 0) place += count;
  Index chosen = place;
  for (; place < count_; place += count)
    if (shares(place) > shares(chosen)) chosen = place;
  return chosen;
}

/// Shares of all harmonics from those at ends of steps, which have the order of the rule but do not
/// distinguish harmonics that differ by the number of these ends. `sampled`: shares at all samples,
/// which have the error of the polynomials in a step; they choose between such harmonics.
Eigen::VectorXd EnergyShares::spread(const Eigen::VectorXd& shares,
                                     const Eigen::VectorXd& sampled) const {
  const Index ends = shares.size();
  if (ends == count_) return shares;
  Eigen::VectorXd result = Eigen::VectorXd::Zero(count_);
  for (Index i = 0; i < ends; ++i) result(likeliest_place(i - ends / 2, ends, sampled)) = shares(i);
  return result;
}

}  // namespace samara::analysis
