// Estimates of what step, mesh and round-off do to an exponent (docs/theory.md, section 5.9).
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "samara/analysis/mode.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Where nothing changes with time, a sequence of steps with the exponent `s` is that of the exact
/// exponent (2/dt) tanh(s dt/2): the inverse of the step's map (1 + lambda dt/2)/(1 - lambda dt/2).
std::complex<double> unwarped(std::complex<double> s, double step);

/// Change by the step of a mode whose energy is in several harmonics: each is warped by its own
/// frequency. `principal`: of the sequence of steps [rad/s]; `shares` of the kinetic energy by
/// harmonic from `first`; `harmonic`: the one whose warping is mapped back [rad/s, complex modulus
/// and real part].
struct WarpingSpread {
  double modulus = 0.0;
  double growth = 0.0;
};
WarpingSpread warping_spread(std::complex<double> principal, const Eigen::RowVectorXd& shares,
                             int first, int harmonic, double speed, double step);

/// Relative errors of the exponent by the mesh, of its modulus and of its real part: twice the
/// first term of the elements' errors. `shape`: size x samples; `energy_of_mode`: the larger of its
/// mean kinetic and strain energy, in the same scale: alike in vibrations, where rotation does not
/// stiffen, and the latter in overdamped motions.
Eigen::Vector2d find_mesh_error(const std::vector<system::MeshError>& elements,
                                const Eigen::MatrixXcd& shape, std::complex<double> exponent,
                                double energy_of_mode);

/// Error of the growth by step and round-off. `spread`: of the step; `principal`: the exponent
/// without multiples of the rotor speed, which the step must tell from zero.
void set_growth_error(Mode& mode, const WarpingSpread& spread, std::complex<double> principal);

/// Adds the relative error of the mesh to a mode, and to the error of its growth.
void add_mesh_error(Mode& mode, const Eigen::Vector2d& relative);

}  // namespace samara::analysis
