// Energies of the modes of a periodic motion by harmonic and part, from the signals of all initial
// states.
#pragma once

#include <complex>
#include <functional>
#include <vector>

#include <Eigen/Dense>

#include "samara/analysis/mode.hpp"

#include "signal_series.hpp"

namespace samara::analysis {

class EnergyShares {
 public:
  using Index = Eigen::Index;
  using Complex = std::complex<double>;

  /// Instants of the samples.
  struct Samples {
    double first;     ///< [s]
    double distance;  ///< [s]
    int of_step;      ///< first ones at the starts of steps, unless there is but one
    long steps;       ///< in a sector
    int sectors;      ///< in a period
  };

  /// The motions to describe.
  struct Motions {
    std::vector<Complex> exponents;  ///< principal [1/s]
    std::vector<int> states;         ///< leading parts of first-order states; -1: none
    /// Initial states of this rank (rows), for the real and imaginary parts of the given modes.
    std::function<Eigen::MatrixXd(const std::vector<Index>&)> weights;
    /// Share of a mode in harmonics that the step does not resolve, from its shares by harmonic.
    std::function<double(std::size_t, const Eigen::VectorXd&)> fast_share;
  };

  EnergyShares(SignalSeries& series, const Samples& samples, const Ranks& ranks);

  /// Sets energy, parts and harmonic of each mode of `set`, and its participations. Returns the
  /// shares by harmonic at all samples (modes x harmonics), which show motions that are too fast
  /// for the step: at the ends of steps these may look like slow ones.
  ///
  /// A mode that is too fast by a large margin, as random mixtures of its signals show, is
  /// described by fewer samples; its shares by harmonic are those of the mixtures. Every rank calls
  /// it.
  Eigen::MatrixXd describe(const Motions& motions, ModeSet& set);

 private:
  template <class Work>
  static void in_batches(const std::vector<Index>& modes, Index rows, const Work& work);
  template <class Work>
  void for_each_shape(const std::vector<Index>& modes, const Eigen::MatrixXd& values, long stride,
                      const Work& work) const;
  std::vector<signed char> estimate();
  void describe_slow(const std::vector<Index>& modes, ModeSet& set);
  void describe_fast(const std::vector<Index>& modes, long stride, ModeSet& set);
  long stride_of_fast_modes() const;
  Index likeliest_place(Index harmonic, Index count, const Eigen::VectorXd& shares) const;
  Eigen::VectorXd spread(const Eigen::VectorXd& shares, const Eigen::VectorXd& sampled) const;

  SignalSeries& series_;
  Samples at_;
  Ranks ranks_;
  Index count_;  ///< samples in a period, and harmonics
  const Motions* motions_ = nullptr;
  Eigen::MatrixXd sampled_;  ///< the result of describe()
};

}  // namespace samara::analysis
