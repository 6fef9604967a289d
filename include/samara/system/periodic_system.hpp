// Interface between turbines and analyses: one implicit periodic system r(t, z, z_dot) = 0 with
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

  /// q* p / 2 of each motion [J]. q: rates of its coordinates in `z_dot`; p: their momenta in
  /// `whole`. If `z_dot` also has the rates of all positions, the sum is the kinetic energy.
  virtual Eigen::VectorXd of(const Eigen::Ref<const Eigen::VectorXcd>& z_dot,
                             const Eigen::Ref<const Eigen::VectorXcd>& whole) const = 0;

  /// The same sum, with the mean turn of all parts that a joint carries as the q of the joint: its
  /// own turn and that by the deformation of these parts, which is in series with its spring. The
  /// motions of these parts give up what they add to it.
  virtual Eigen::VectorXd of_mean_turns(const Eigen::Ref<const Eigen::VectorXcd>& z_dot,
                                        const Eigen::Ref<const Eigen::VectorXcd>& whole) const {
    return of(z_dot, whole);
  }
};

class PeriodicSystem {
 public:
  PeriodicSystem() = default;
  PeriodicSystem(const PeriodicSystem&) = delete;
  PeriodicSystem& operator=(const PeriodicSystem&) = delete;
  virtual ~PeriodicSystem() = default;

  virtual MPI_Comm comm() const = 0;
  virtual PetscInt size() const = 0;

  /// Period T [s]; 0 if nothing depends on time.
  virtual double period() const = 0;

  virtual const std::vector<Unknown>& unknowns() const = 0;
  virtual const std::vector<RowRole>& rows() const = 0;

  /// True if the unknown's rate appears in the residual: x of (11); false: y of (12).
  virtual const std::vector<bool>& differential() const = 0;

  /// True if the constraint rows depend on t only through z.
  virtual bool constraints_are_autonomous() const = 0;

  /// True if nothing dissipates or feeds energy, except the prescribed motion and loads that derive
  /// from a potential. Multipliers then come in pairs mu, 1/mu* (docs/theory.md, section 5.8).
  virtual bool is_conservative() const { return false; }

  virtual const RotorSymmetry& symmetry() const = 0;
  virtual const std::vector<EnergyGroup>& energy_groups() const = 0;
  virtual const std::vector<UnconstrainedCoordinate>& unconstrained_coordinates() const = 0;
  /// Coordinates whose means the start of a trim holds at zero, each with the row of the load that
  /// would hold it: hinges and free supports that only loads and inertia restore, the integral of a
  /// controller.
  virtual std::vector<UnconstrainedCoordinate> free_coordinates() const { return {}; }
  /// The motions of the system; empty if they are not defined.
  virtual std::vector<Motion> motions() const { return {}; }
  /// Energies in the order of motions(), about the state `steady` at t; null without motions.
  virtual std::unique_ptr<MotionEnergies> motion_energies(double, Vec) const { return nullptr; }
  /// Errors of all elements; empty if nothing is discretized in space.
  virtual std::vector<MeshError> mesh_errors() const { return {}; }

  /// The start of every trim: the undeformed system in its prescribed motion. It depends on t if
  /// constraints_are_autonomous() is false.
  virtual void reference_state(double t, Vec z) const = 0;

  /// Sets the unknowns of a medium to their steady values at the motion in `z`; the other unknowns
  /// stay. Without a medium nothing changes.
  virtual void settle(double /*t*/, Vec /*z*/) const {}

  /// For states that are solutions. Iterations may pass through states in which the equations are
  /// continued beyond their meaning. @throws DomainError if `z` is such a state
  virtual void require_admissible(double /*t*/, Vec /*z*/) const {}

  virtual petsc::Handle<Vec> make_state() const = 0;
  /// Preallocated for K + shift M.
  virtual petsc::Handle<Mat> make_jacobian() const = 0;
  /// Preallocated for M alone.
  virtual petsc::Handle<Mat> make_mass() const = 0;
  /// Columns of each row, ascending, in which K or M may have an entry. All other entries are zero
  /// at all states and times. Empty if the pattern is not known; the system then has no first-order
  /// states.
  virtual std::vector<std::vector<PetscInt>> pattern() const { return {}; }

  /// The same system without gravity and prescribed loads. Both residuals are linear in the loads:
  /// (1 - f) times this residual plus f times the loaded one is the residual for a load factor f.
  /// The Jacobians of both have entries in the same places.
  virtual std::unique_ptr<PeriodicSystem> unloaded() const {
    throw InternalError("this system has no version without loads");
  }

  /// The same system with large rotations counted from their values in `z`, which is rewritten for
  /// it; null if no rotation is large. In this way rotations can grow without a limit, step after
  /// step.
  virtual std::unique_ptr<PeriodicSystem> counted_from(Vec) const { return nullptr; }

  /// Rewrites `z` with rotations that count from the undeformed state. The parameters are infinite
  /// at 180 degrees; a larger rotation has the parameters of the same attitude.
  virtual void count_from_undeformed(Vec) const {}

  /// Owner of an unknown that all ranks of a distributed mesh have.
  static constexpr int shared = -1;
  /// Unknowns that must be shared in every distribution.
  virtual std::vector<PetscInt> common_unknowns() const { return {}; }
  /// Part of the same system that a rank of a distributed mesh evaluates. The residuals and
  /// tangents of all parts add up to those of this system. `owners[i]`: rank of unknown and row i,
  /// or `shared`. A rank has all terms in its rows, and in shared rows the terms of its unknowns;
  /// the first rank also has those of shared unknowns alone. Only the unknowns of the rank and
  /// shared ones are read from a state. Null if the terms cannot be divided in this way.
  virtual std::unique_ptr<PeriodicSystem> part_of(int /*rank*/,
                                                  const std::vector<int>& /*owners*/) const {
    return nullptr;
  }

  /// r(t, z, z_dot). @throws DomainError if a rotation is out of range.
  virtual void residual(double t, Vec z, Vec z_dot, Vec r) const = 0;

  /// K + shift M into `jacobian`, and M into `mass` where it is not null.
  virtual void tangents(double t, Vec z, Vec z_dot, double shift, Mat jacobian, Mat mass) const = 0;
};

/// The rotor speed 2 pi / period, or 1 where there is no period [rad/s]: slow motions are slower.
double base_rate(const PeriodicSystem& system);

/// Checks the unknowns and rows of a system against their roles (docs/theory.md, section 4): as
/// many velocities as kinematic rows; the evolution row of a state and the definition row of an
/// auxiliary at the index of the unknown. From the declared pattern, so that no state is lost:
/// - constraint rows contain positions and internal loads, and only those states whose evolution
///   row contains no velocity, internal load or auxiliary;
/// - kinematic rows contain no internal load and no auxiliary.
/// @throws InternalError with the names of the row and of the unknown
void require_roles(const PeriodicSystem& system);

}  // namespace samara::system
