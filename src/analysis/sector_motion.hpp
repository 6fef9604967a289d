// Motions over a sector of a revolution, and their continuation (docs/theory.md, section 5.4).
#pragma once

#include <cmath>
#include <complex>

#include <Eigen/Core>

#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// The least multiple of the sectors that is not below a number of steps.
inline int whole_sectors(double steps, int sectors) {
  return static_cast<int>(std::ceil(steps / sectors)) * sectors;
}

/// P z of columns of all unknowns, P of system::RotorSymmetry.
Eigen::MatrixXd turned(const system::RotorSymmetry& symmetry, const Eigen::MatrixXd& z);

/// Real parts and imaginary parts of columns, one after the other.
Eigen::MatrixXd real_and_imaginary(const Eigen::MatrixXcd& columns);

/// A motion over the first sector, at equal distances in time.
struct SectorMotion {
  const double*
      values;  ///< unknowns x instants by column: all real parts, then all imaginary parts
  Eigen::Index unknowns;
  Eigen::Index instants;
  double first;     ///< time of the first instant [s]
  double distance;  ///< between instants [s]
};

/// Z(t) exp(-lambda t) over the whole period, unknowns x instants of all sectors, where
/// z(t + T/Q) = mu P^-1 z(t) and exp(-lambda T/Q) mu = 1.
Eigen::MatrixXcd shape_over_period(const system::RotorSymmetry& symmetry, int sectors,
                                   const SectorMotion& motion, std::complex<double> exponent);

}  // namespace samara::analysis
