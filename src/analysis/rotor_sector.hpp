// One of identical blades in the place of all (docs/theory.md, sections 4.2 and 5.4).
#pragma once

#include <vector>

#include <Eigen/Core>
#include <petscsystypes.h>

#include "samara/system/periodic_system.hpp"

#include "tangent_pattern.hpp"

namespace samara::analysis {

/// Unknowns of a system that stand for all. Among Q identical blades, a motion with
/// P Z(t + T/Q) = Z(t), P of system::RotorSymmetry, is that of the first blade and of the unknowns
/// that P does not move: each blade has the motion of the first one, T/Q later or earlier, and
/// unknowns that P does not move have the harmonics k = 0, Q, -Q, ... only (k = Q/2, -Q/2, ...
/// where P changes their sign).
struct RotorSector {
  /// All harmonics, in `remainder`.
  static constexpr int every = -1;

  int sectors = 1;               ///< Q; 1: all unknowns of the system are kept
  std::vector<PetscInt> kept;    ///< unknowns of the system, ascending
  std::vector<PetscInt> number;  ///< of each unknown of the system among those kept; -1: none
  std::vector<int> remainder;    ///< k mod Q of the harmonics of each unknown that is kept

  /// All unknowns.
  explicit RotorSector(PetscInt size);
  /// Those of the first blade and those that P does not move; all of them where the system has no
  /// identical blades, or where a row of the first blade refers to another blade.
  RotorSector(const system::PeriodicSystem& system, const TangentPattern& pattern,
              PetscInt block_size);

  bool is_moved(PetscInt kept_unknown) const {
    return remainder[static_cast<std::size_t>(kept_unknown)] == every;
  }
  bool has(PetscInt kept_unknown, int harmonic) const {
    const int own = remainder[static_cast<std::size_t>(kept_unknown)];
    return own == every || (harmonic - own) % sectors == 0;
  }
  /// Sets the coefficients of harmonics that an unknown does not have to zero: mean, cosine and
  /// sine of each harmonic by row; one or several times the kept unknowns by column.
  void drop_absent(Eigen::Ref<Eigen::MatrixXd> coefficients) const;
  /// From a series of the kept unknowns, k = -H ... H by row, to all unknowns of the system.
  Eigen::MatrixXcd whole(const system::RotorSymmetry& symmetry,
                         const Eigen::MatrixXcd& series) const;
  /// The same for mean, cosine and sine of each harmonic.
  Eigen::MatrixXd whole(const system::RotorSymmetry& symmetry,
                        const Eigen::Ref<const Eigen::MatrixXd>& coefficients) const;

 private:
  template <class Matrix, class Turn>
  Matrix spread(const system::RotorSymmetry& symmetry, const Matrix& own, Turn turn) const;
};

}  // namespace samara::analysis
