// Derivatives of the exponents of modes with respect to a parameter of the system (docs/theory.md,
// section 5.13): direct differentiation of Hill's eigenproblem, the change of the steady state and
// of the rotor speed included.
#pragma once

#include <complex>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "samara/analysis/mode.hpp"
#include "samara/analysis/periodic_solution.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// The modes of a steady state and their derivatives. For r(p) = (A(p) + lambda B(p)) x with the
/// pencil of the system and steady state at the value p of a parameter, an eigenpair at p_0 changes
/// by (A + lambda B) x' + lambda' B x = - dr/dp.
class ExponentDerivatives {
 public:
  /// Finds the eigenpairs of the modes of `set`, by their shapes, in Hill's eigenproblem, with as
  /// many harmonics as their exponents need. Of a mode only the exponent and its harmonic are used.
  /// All arguments are kept by reference.
  ExponentDerivatives(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                      const ModeSet& set);
  ~ExponentDerivatives();
  ExponentDerivatives(const ExponentDerivatives&) = delete;
  ExponentDerivatives& operator=(const ExponentDerivatives&) = delete;

  /// r of all modes.
  struct Residuals {
    using Groups = std::vector<Eigen::MatrixXcd>;
    Groups groups;
    /// From every second sample of the tangents; empty without a medium, whose equations alone are
    /// no polynomials.
    Groups of_half;
    /// Of the eigenpairs with fewer harmonics.
    Groups before;
    double speed = 0.0;  ///< of the rotor [rad/s]
    bool by_sector = true;
  };
  /// r in another system with the same unknowns, about its own steady state. `by_sector`: in
  /// motions of one blade among identical ones; then the other system must have as many.
  Residuals residuals(const system::PeriodicSystem& other, const PeriodicSolution& solution,
                      bool by_sector);

  /// Derivatives of the modes' exponents [1/s per unit of p], with their identified harmonics, by
  /// mode; not-a-number for a mode whose eigenpair was not found, for one at rest, and for equal
  /// exponents.
  struct Derivatives {
    Eigen::VectorXcd values;
    /// How far they differ from those of fewer harmonics and of fewer samples, if `rates` have
    /// these.
    Eigen::VectorXd errors;
  };
  /// For each of `rates`, derivatives of the residuals.
  /// @throws ConvergenceError
  std::vector<Derivatives> derivatives(const std::vector<Residuals>& rates);

 private:
  class Basis;
  Basis& basis(bool by_sector);

  const system::PeriodicSystem& system_;
  const PeriodicSolution& solution_;
  const ModeSet& set_;
  std::unique_ptr<Basis> whole_, sector_;
};

/// a R + b S, of residuals from the same modes.
ExponentDerivatives::Residuals combine(double a, const ExponentDerivatives::Residuals& R, double b,
                                       const ExponentDerivatives::Residuals& S);

}  // namespace samara::analysis
