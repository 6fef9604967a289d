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

namespace samara::system {

/// What an unknown is in the mechanics of the system.
enum class UnknownRole {
  position,  ///< displacement, rotation, joint coordinate
  velocity,  ///< velocity, generalized speed
  internal,  ///< force, moment, reaction
};

/// What a row says.
enum class RowRole {
  constraint,  ///< position level, without rates: strain, curvature, a locked joint
  kinematic,   ///< velocity = rate of position
  balance,     ///< force and moment
};

enum class Frame { fixed, rotating };

struct Unknown {
  std::string name;  ///< "blade 1 point 3 theta2"
  std::string unit;
  UnknownRole role = UnknownRole::position;
  /// A position that constraints tie others to, free itself: that of a hinge. Its row, in the same
  /// place, is the load on a support that is not there.
  bool is_free = false;
};

/// Unknowns that belong together, with their share of an energy e = z^T weight z / 2. Kinetic:
/// inertial velocities, components in the part's own frame. Strain: internal loads.
struct EnergyGroup {
  enum class Kind { kinetic, strain };
  Kind kind = Kind::kinetic;
  std::string part;    ///< "tower", "nacelle", "hub", "blade"
  std::string motion;  ///< "fore-aft", "lateral", "torsion", "flap", "lead-lag", "yaw", ...
  int blade = 0;       ///< from 1; 0 = no blade
  Frame frame = Frame::fixed;
  std::vector<PetscInt> unknowns;
  std::vector<double> weight;  ///< row by row, unknowns x unknowns, symmetric
  double damping = 0.0;  ///< mu [s] of a strain: its load is the elastic one times 1 + mu d/dt
};

/// A way in which a system moves: a part deforms in a direction, or a joint or a support turns or
/// gives way. The motions together make any position of the system.
struct Motion {
  std::string part;  ///< "blade", "tower", or the motion's own where a joint moves
  std::string name;  ///< "flap", "fore-aft", "flap hinge"; empty where the part says it all
  int blade = 0;     ///< from 1; 0 = no blade
  /// Positions of a blade in this direction, in the order of every other blade, and their masses or
  /// inertias.
  std::vector<PetscInt> unknowns;
  std::vector<double> weight;
};

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

/// An element of a mesh. The motion z exp(lambda t) has half a sum of squares of the signals
/// (constant + |lambda| rate) z as the energy of what the element's polynomials leave out, of which
/// twice the kinetic energy of the whole motion is the relative error of lambda (docs/theory.md,
/// section 5.9).
struct MeshError {
  std::vector<PetscInt> unknowns;
  Eigen::MatrixXd constant;  ///< signals x unknowns
  Eigen::MatrixXd rate;      ///< signals x unknowns, times |lambda| [rad/s]
  /// unknowns x unknowns, symmetric: half of z* remainder z is the energy of sections between the
  /// element's points that these leave out, of either sign.
  Eigen::MatrixXd remainder;
};

/// A coordinate whose mean nothing restores, and the row of the load that would hold it.
struct NeutralCoordinate {
  std::string name;  ///< "yaw"
  PetscInt unknown = 0;
  PetscInt row = 0;
  std::string unit;  ///< of the load: "N m"
};

/// z~(t) = P z(t + T/Q): entry i of P z is sign[i] z[source[i]] (docs/theory.md, section 5).
struct RotorSymmetry {
  int sectors = 1;        ///< Q
  std::string broken_by;  ///< why a rotor of several blades does not repeat; empty if it does
  std::vector<PetscInt> source;
  std::vector<double> sign;
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
  virtual const std::vector<NeutralCoordinate>& neutral_coordinates() const = 0;
  /// None where a system does not know its motions.
  virtual std::vector<Motion> motions() const { return {}; }
  /// In the order of motions(), about the state `steady` at t; null where there are none.
  virtual std::unique_ptr<MotionEnergies> motion_energies(double, Vec) const { return nullptr; }
  /// Of every element that has an error; none where nothing is discretized in space.
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
  /// all states and times. All columns where a system does not know better.
  virtual std::vector<std::vector<PetscInt>> pattern() const;

  /// The same system without gravity and prescribed loads. Both residuals are linear in the loads:
  /// (1 - f) times this one's plus f times the loaded one's is that of a load factor f.
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

}  // namespace samara::system
