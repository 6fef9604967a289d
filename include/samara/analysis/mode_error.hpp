// Estimates of the errors of an exponent by step, mesh and round-off (docs/theory.md, section 5.9).
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "samara/analysis/mode.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// A rule of integration in time: Gauss collocation of order 2, 4 or 6 with a step [s].
struct TimeRule {
  int order = 2;
  double step = 0.0;

  /// |Im lambda| and |Re lambda| above which an exponent counts as unresolved [rad/s].
  double reach() const;
  /// Whether an exponent `s` of a sequence of steps may belong to an exponent below reach(). The
  /// map from lambda to s has an inverse there; beyond, several lambda have the same s.
  bool may_reach(std::complex<double> s) const;
};

/// Exact exponent lambda of a sequence of steps that has the exponent `s`, with constant
/// coefficients: exp(s dt) = R(lambda dt) with the diagonal Pade approximant R of exp. For order 2
/// it is (2/dt) tanh(s dt/2). For higher orders it is `s` itself where the rule does not reach.
std::complex<double> unwarped(std::complex<double> s, const TimeRule& rule);

/// Error by the step of the exponent of a mode with energy in several harmonics, in modulus and
/// real part [rad/s]: each harmonic is warped according to its own frequency. `principal`: exponent
/// of the sequence of steps [rad/s]; `shares`: of the kinetic energy, by harmonic from `first`;
/// `harmonic`: the one whose warping is mapped back.
struct WarpingSpread {
  double modulus = 0.0;
  double growth = 0.0;
};
WarpingSpread warping_spread(std::complex<double> principal, const Eigen::RowVectorXd& shares,
                             int first, int harmonic, double speed, const TimeRule& rule);

/// Relative errors of the exponent by the mesh, in its modulus and in its real part: twice the
/// first term of the elements' errors over the larger of its mean kinetic and strain energy.
/// `shape`: size x samples, in the scale of Mode::kinetic_energy. The two energies are equal in
/// vibrations without stiffening by rotation; in overdamped motions the strain energy is larger.
Eigen::Vector2d find_mesh_error(const system::PeriodicSystem& system,
                                const std::vector<system::MeshError>& elements, const Mode& mode,
                                const Eigen::MatrixXcd& shape);

/// Sets the error of the growth by step and round-off. `spread`: error by the step; `principal`:
/// the exponent without multiples of the rotor speed, to be distinguished from zero; `condition`:
/// of the multiplier in energy coordinates. It is 1 where left and right eigenvector are equal:
/// then each harmonic has a real share of the error by the step, which changes the frequency alone.
void set_growth_error(Mode& mode, const WarpingSpread& spread, std::complex<double> principal,
                      double condition = 1.0);

/// Unknowns of coordinates that nothing restores and that turn with the rotor (a free generator),
/// where nothing else depends on the time: a shift of one of them is a shift in time, and one
/// exponent is zero.
std::vector<PetscInt> find_shifts_in_time(const system::PeriodicSystem& system);

/// Where there is a shift in time, and no map in which to find its error: the smallest exponent
/// that was found is taken for its zero; its distance from zero, by the truncation of the steady
/// state, is an error of its growth, and of that of the exponents next to it.
void take_shift_in_time(const system::PeriodicSystem& system, ModeSet& set);

/// Adds the relative error of the mesh to a mode, and to the error of its growth.
void add_mesh_error(Mode& mode, const Eigen::Vector2d& relative);

}  // namespace samara::analysis
