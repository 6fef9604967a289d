// Kinetic energy of a mode by part and harmonic (docs/theory.md, section 5; Lee, Hodges & Patil
// (2002), eq. (20), (21)).
//
// Every kinetic energy is written as half a sum of squares of signals, linear in the state: what
// carries no energy (a rotation without inertia) makes no signal. Under the rotor's symmetry all
// blades have the energy of the first, seen over the whole period.
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
  /// For time series over one of `sectors` parts of the period; `share` of `shares`, about alike,
  /// of the energy: the sum over all shares is the whole.
  explicit HarmonicEnergy(const system::PeriodicSystem& system, int sectors = 1, int share = 0,
                          int shares = 1);

  /// Names of the parts of the kinetic energy.
  const std::vector<std::string>& part_names() const { return parts_; }
  /// Columns of energies(): these parts, and behind them those of first-order states
  /// (find_state_parts), which have half the sum of their squares in the place of an energy.
  Eigen::Index columns() const { return columns_; }
  Eigen::Index signals() const { return signals_.rows(); }

  /// Signals (signals x columns) of states (system size x columns).
  void take(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::MatrixXd> signals) const {
    signals.noalias() = signals_ * states;
  }

  /// Mean energy by harmonic (k = 0 ... floor((n - 1) / 2), then the negative ones) and column of
  /// (real + i imaginary) factors, where real and imaginary are the signals of an instant after
  /// those of the one before, and `factors` one number an instant of the sector.
  const Eigen::MatrixXd& energies(const double* real, const double* imaginary,
                                  const Eigen::VectorXcd& factors);

 private:
  std::vector<std::string> parts_;
  Eigen::Index columns_ = 0;
  int sectors_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> signals_;  ///< sector after sector
  std::vector<Eigen::Index> part_of_;                     ///< of a signal of one sector
  std::unique_ptr<math::FourierTransform> transform_;
  Eigen::MatrixXd energies_;
};

/// R with weight = R^T R of a group, without rows of nothing: R times the group's unknowns are the
/// signals of which half the sum of squares is the energy.
Eigen::MatrixXd energy_root(const system::EnergyGroup& group);

/// From energies by harmonic and column to the mode's energy, its parts' shares (in the order of
/// the names), the dominant harmonic of the part with most energy and `participation`, the share of
/// every harmonic k = -floor(n/2) ... The last two are those of the state part `state` where that
/// is not negative.
void describe_energy(const Eigen::MatrixXd& energies, const std::vector<std::string>& parts,
                     int state, Mode& mode, Eigen::VectorXd& participation);

}  // namespace samara::analysis
