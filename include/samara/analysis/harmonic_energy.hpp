// Kinetic energy of a mode by part and harmonic (docs/theory.md, section 5; Lee, Hodges & Patil
// (2002), eq. (20), (21)).
//
// Every kinetic energy is written as half a sum of squares of signals that are linear in the state.
// A motion without energy (a rotation without inertia) has no signal. Under the rotor's symmetry
// every blade has the energy of the first blade over the whole period.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/SparseCore>

#include "samara/analysis/mode.hpp"
#include "samara/math/fourier.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

class HarmonicEnergy {
 public:
  /// For time series over one of `sectors` parts of the period. The signals are divided into
  /// `shares` groups of about equal size; this object has the group `share`. The energies of all
  /// groups add up to the whole.
  explicit HarmonicEnergy(const system::PeriodicSystem& system, int sectors = 1, int share = 0,
                          int shares = 1);

  /// For `mixtures` of signals, which have one part.
  HarmonicEnergy(Eigen::Index mixtures, int sectors);

  /// Names of the parts of the kinetic energy.
  const std::vector<std::string>& part_names() const { return parts_; }
  /// Columns of energies(): the parts of part_names(), then those of first-order states
  /// (find_state_parts), where half the sum of squares of the states stands in place of an energy.
  Eigen::Index columns() const { return columns_; }
  Eigen::Index signals() const { return static_cast<Eigen::Index>(part_of_.size()) * sectors_; }
  /// Number of a signal of a sector among those of all shares, which does not depend on their
  /// number.
  unsigned number(Eigen::Index signal) const { return numbers_[static_cast<std::size_t>(signal)]; }
  /// Whether a signal of a sector belongs to the kinetic energy; others are those of states.
  bool is_kinetic(Eigen::Index signal) const {
    return part_of_[static_cast<std::size_t>(signal)] < static_cast<Eigen::Index>(parts_.size());
  }

  /// Signals (signals x columns) of states (system size x columns).
  void take(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::MatrixXd> signals) const {
    signals.noalias() = signals_ * states;
  }

  /// Mean energy by harmonic (k = 0 ... floor((n - 1) / 2), then the negative ones) and column, of
  /// the signals (real + i imaginary) times `factors`. `real` and `imaginary`: the signals, one
  /// instant after the other; `factors`: one number per instant of the sector.
  const Eigen::MatrixXd& energies(const double* real, const double* imaginary,
                                  const Eigen::VectorXcd& factors);
  /// The same of every `stride`-th instant of the signals of the last call, from the first.
  Eigen::MatrixXd energies_of_part(int stride) const;

 private:
  std::vector<std::string> parts_;
  Eigen::Index columns_ = 0;
  int sectors_;
  std::vector<unsigned> numbers_;                         ///< of the signals of a sector
  Eigen::SparseMatrix<double, Eigen::RowMajor> signals_;  ///< sector after sector
  std::vector<Eigen::Index> part_of_;                     ///< column of each signal of one sector
  std::unique_ptr<math::FourierTransform> transform_;
  Eigen::MatrixXd energies_;
};

/// R with weight = R^T R of a group, without zero rows. R times the group's unknowns gives the
/// signals; half the sum of their squares is the energy.
Eigen::MatrixXd energy_root(const system::EnergyGroup& group);

/// Finds, from energies by harmonic and column, the mode's energy, the shares of its parts
/// (descending), the dominant harmonic of the part with most energy, and `participation`,
/// the share of every harmonic k = -floor(n/2) ... If `state` is not negative, the last two are
/// those of this part of first-order states.
void describe_energy(const Eigen::MatrixXd& energies, const std::vector<std::string>& parts,
                     int state, Mode& mode, Eigen::VectorXd& participation);

}  // namespace samara::analysis
