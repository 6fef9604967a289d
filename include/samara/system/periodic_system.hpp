// The line between turbines and analyses: one implicit periodic system r(t, z, z_dot) = 0 with
// separate tangents K = dr/dz and M = dr/dz_dot (docs/theory.md, section 4; Lee, Hodges & Patil
// (2002), eq. (10)-(12), (17)).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "samara/base/error.hpp"
#include "samara/petsc/handle.hpp"
#include "samara/system/metadata.hpp"

namespace samara::system {

/// Kinetic energy by motion, about one state (docs/theory.md, section 5.6).
class MotionEnergies {
 public:
  MotionEnergies() = default;
  MotionEnergies(const MotionEnergies&) = delete;
  MotionEnergies& operator=(const MotionEnergies&) = delete;
  virtual ~MotionEnergies() = default;

  /// q* p / 2 of each motion [J], q the rates of its coordinates in `z_dot` and p their momenta in
  /// `whole`: with `z_dot` the rates of all positions as well, the sum is the kinetic energy.
  virtual Eigen::VectorXd of(const Eigen::Ref<const Eigen::VectorXcd>& z_dot,
                             const Eigen::Ref<const Eigen::VectorXcd>& whole) const = 0;
};

class PeriodicSystem {
 public:
  PeriodicSystem() = default;
  PeriodicSystem(const PeriodicSystem&) = delete;
  PeriodicSystem& operator=(const PeriodicSystem&) = delete;
  virtual ~PeriodicSystem() = default;

  virtual MPI_Comm comm() const = 0;
  virtual PetscInt size() const = 0;

  /// T [s]; 0 where nothing depends on time.
  virtual double period() const = 0;

  virtual const std::vector<Unknown>& unknowns() const = 0;
  virtual const std::vector<RowRole>& rows() const = 0;

  /// True where an unknown's rate appears in the residual: x of (11); false: y of (12).
  virtual const std::vector<bool>& differential() const = 0;

  /// True where the constraint rows do not depend on t other than through z.
  virtual bool constraints_are_autonomous() const = 0;

  /// True where nothing dissipates or feeds energy but the prescribed motion and loads that derive
  /// from a potential: multipliers then come in pairs mu, 1/mu* (docs/theory.md, section 5.8).
  virtual bool is_conservative() const { return false; }

  virtual const RotorSymmetry& symmetry() const = 0;
  virtual const std::vector<EnergyGroup>& energy_groups() const = 0;
  virtual const std::vector<UnconstrainedCoordinate>& unconstrained_coordinates() const = 0;
  /// Coordinates that only loads and inertia restore, of hinges and of supports that give way, each
  /// with the row of the load that would hold it.
  virtual std::vector<UnconstrainedCoordinate> free_coordinates() const { return {}; }
  /// None where a system does not know its motions.
  virtual std::vector<Motion> motions() const { return {}; }
  /// In the order of motions(), about the state `steady` at t; null where there are none.
  virtual std::unique_ptr<MotionEnergies> motion_energies(double, Vec) const { return nullptr; }
  /// Errors of all elements that have one; none where nothing is discretized in space.
  virtual std::vector<MeshError> mesh_errors() const { return {}; }

  /// The start of every trim: the undeformed system in its prescribed motion. It depends on t where
  /// constraints_are_autonomous() does not hold.
  virtual void reference_state(double t, Vec z) const = 0;

  virtual petsc::Handle<Vec> make_state() const = 0;
  /// Preallocated for K + shift M.
  virtual petsc::Handle<Mat> make_jacobian() const = 0;
  /// Preallocated for M alone.
  virtual petsc::Handle<Mat> make_mass() const = 0;
  /// Columns of each row, ascending, in which K or M may have an entry: elsewhere both are zero at
  /// all states and times. Empty where a system does not know: it has no first-order states then.
  virtual std::vector<std::vector<PetscInt>> pattern() const { return {}; }

  /// The same system without gravity and prescribed loads. Both residuals are linear in the loads:
  /// (1 - f) times this one's plus f times the loaded one's is that of a load factor f. The
  /// Jacobians of both have entries in the same places.
  virtual std::unique_ptr<PeriodicSystem> unloaded() const {
    throw InternalError("this system does not know its loads");
  }

  /// The same system with large rotations counted from their values in `z`, which is rewritten for
  /// it; null where none is large. So rotations grow without a limit, step after step.
  virtual std::unique_ptr<PeriodicSystem> counted_from(Vec) const { return nullptr; }

  /// Rewrites `z` with rotations that count from the undeformed state. They are infinite at 180
  /// degrees, and those of a turn by more are those of the same attitude.
  virtual void count_from_undeformed(Vec) const {}

  /// r(t, z, z_dot). @throws DomainError where a rotation is out of range.
  virtual void residual(double t, Vec z, Vec z_dot, Vec r) const = 0;

  /// K + shift M into `jacobian`, and M into `mass` where it is not null.
  virtual void tangents(double t, Vec z, Vec z_dot, double shift, Mat jacobian, Mat mass) const = 0;
};

/// Whether the unknowns and rows of a system are what their roles say (docs/theory.md, section 4):
/// as many velocities as kinematic rows; a state's evolution row and an auxiliary's definition row
/// in its own place; and from the declared pattern, so that no state is ever lost,
/// - constraint rows contain positions, internal loads, and of the rest only states whose own
///   evolution row contains no velocity, internal load or auxiliary;
/// - kinematic rows contain no internal load and no auxiliary.
/// @throws InternalError with the names of the row and of the unknown
void require_roles(const PeriodicSystem& system);

}  // namespace samara::system
