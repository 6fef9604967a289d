// The slowest decays of a linearized periodic system by integration (docs/theory.md, section 5.11).
#pragma once

#include <complex>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "samara/analysis/collocation_step.hpp"
#include "samara/analysis/consistent_subspace.hpp"
#include "samara/analysis/periodic_solution.hpp"
#include "samara/system/periodic_system.hpp"

#include "hill_search.hpp"

namespace samara::analysis {

/// Finds the multipliers of largest modulus of the map over a sector without forming the map: steps
/// of Radau IIA advance a block of columns. These steps damp motions that are too fast for them.
/// The space begins with a block of random columns, larger than the number of multipliers that are
/// searched: all of them have a part in each motion, also in several ones with equal exponents. The
/// factors of all steps are kept where there is room; else a step is factored for each block.
class LeastDampedSearch {
 public:
  /// `steps` a revolution, a multiple of the sectors.
  LeastDampedSearch(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                    int steps);

  /// Searches at least `count` multipliers; both of a pair count. Finds less where the others are
  /// round-off beside the largest one.
  /// @throws ConvergenceError from the linear solver and the dense eigenproblem (`floquet_`)
  void find(int count);

  /// Motions that were found, one of each conjugate pair.
  std::size_t count() const { return exponents_.size(); }
  /// Z(t) exp(-lambda t) of a motion, size x samples(), at equal distances over a revolution.
  Eigen::MatrixXcd shape(std::size_t number) const;
  /// The copy with the exponent lambda + i shift Omega, with some harmonics of its series. lambda
  /// is the exponent of the steps, up to multiples of i Q Omega.
  HillPair pair(std::size_t number, const Eigen::MatrixXcd& shape, int shift, int harmonics) const;

  /// Instants of shape().
  Eigen::Index samples() const { return samples_of_step * steps_ * sectors_; }

  /// A part of the spectrum, |Im lambda| <= high [rad/s], -Re lambda <= decay [1/s], in which all
  /// motions were found, except that the exponents of the steps have errors.
  struct Region {
    double high = 0.0;
    double decay = 0.0;  ///< not less than a growth: without damping it has a decay beside it
    std::vector<std::size_t> motions;  ///< those that may be in it, with the error of each
    int certain = 0;                   ///< number of those that are in it, also with their errors
    /// Factor of the number of steps, where more may find the wanted number, or slower decays of
    /// higher frequency; else 1.
    double more_steps = 1.0;
  };
  /// The part with at least the `wanted` motions of slowest decay, or with as many as possible.
  /// `exponents` of the steps, in the harmonic of each motion. A motion may contain frequencies
  /// that differ by `margin` [rad/s].
  Region region_of(const std::vector<std::complex<double>>& exponents, int wanted,
                   double margin) const;
  /// Whether all other multipliers are so small that they cannot be found.
  bool is_exhausted() const { return is_exhausted_; }

 private:
  using Complex = std::complex<double>;

  static constexpr long samples_of_step = 3;

  double time_of(Eigen::Index sample) const;
  Complex exact(Complex of_steps) const;
  double decay_of_steps(Complex exponent) const;
  double highest_frequency(double decay, double margin) const;
  void find_weights();
  void make_shapes(const Eigen::MatrixXd& vectors);
  Eigen::MatrixXd image_of(const Eigen::MatrixXd& columns);
  CollocationStep& step(long k) { return *kept_[static_cast<std::size_t>(k) % kept_.size()]; }
  struct Ritz;

  const system::PeriodicSystem& system_;
  int sectors_;
  long steps_;  ///< in a sector
  double dt_;
  double speed_;
  ConsistentSubspace subspace_;
  std::vector<std::unique_ptr<CollocationStep>> kept_;  ///< all steps, or one for all
  Eigen::ArrayXd weights_;  ///< 0 for unknowns that are not carried from step to step
  Eigen::ArrayXd inverse_weights_;
  std::vector<Complex> exponents_;
  /// Values at the instants of a sector: real and imaginary part of one motion after the other.
  Eigen::MatrixXd shapes_;
  /// All motions whose exponents of the steps decay slower were found [1/s].
  double decay_ = 0.0;
  bool is_exhausted_ = false;
};

}  // namespace samara::analysis
