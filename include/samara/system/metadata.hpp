// Metadata of the unknowns, rows, energies and motions of a system. Analyses decide by these; names
// are for people.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <petscsystypes.h>

namespace samara::system {

/// Role of an unknown in the mechanics of the system.
enum class UnknownRole {
  position,   ///< displacement, rotation, joint coordinate
  velocity,   ///< velocity, generalized speed
  internal,   ///< force, moment, reaction
  state,      ///< first order, with memory: of an actuator, a filter, a controller, an inflow
  auxiliary,  ///< without memory, with an algebraic row of its own
};

/// Role of a row.
enum class RowRole {
  constraint,  ///< position level, without rates: strain, curvature, a locked joint
  kinematic,   ///< velocity = rate of position
  balance,     ///< force and moment
  evolution,   ///< of a state, regular in its rate
  definition,  ///< of an auxiliary, without rates
};

/// "position", "velocity", ...
const char* word_of(UnknownRole role);
const char* word_of(RowRole role);

enum class Frame { fixed, rotating };

enum class PartKind {
  body,     ///< rigid: a nacelle, a hub, a mass
  beam,     ///< flexible
  joint,    ///< between two bodies
  support,  ///< elastic, between a body or the ground and what it carries
  law,      ///< an equation without mass: of an actuator, a controller
};

/// A part of the system, or one of several alike.
struct Owner {
  PartKind kind = PartKind::body;
  std::string part;  ///< "blade", "tower", "yaw"
  int instance = 0;  ///< from 1; 0 = the only one

  Owner() = default;
  Owner(PartKind kind_of_part, std::string part_name, int number = 0)
      : kind(kind_of_part), part(std::move(part_name)), instance(number) {}
  bool operator==(const Owner&) const = default;
  /// Whether this is the same part, or one of several alike.
  bool is_alike(const Owner& other) const { return kind == other.kind && part == other.part; }
  /// "blade 1", "tower"
  std::string name() const;
};

struct Unknown {
  Owner owner;
  std::string place;     ///< in its owner: "point 3", "root"; empty where the owner is a point
  std::string quantity;  ///< "u1", "angle", "M2"
  std::string unit;
  UnknownRole role = UnknownRole::position;
  Frame frame = Frame::fixed;  ///< that the owner moves with
  /// A position that constraints tie others to, free itself: that of a hinge. Its row, in the same
  /// place, is the load on a support that is not there.
  bool is_free = false;
  /// Usual size of a state, the unit of differences of states.
  double scale = 1.0;

  /// A position or a first-order state: what the error of a solution is measured by, each over its
  /// scale.
  bool is_coordinate() const { return role == UnknownRole::position || role == UnknownRole::state; }

  /// Unit of the load that works on a position.
  std::string load_unit() const { return unit == "rad" ? "N m" : "N"; }

  /// "blade 1 point 3 theta2"
  std::string name() const;
  /// Without the number of its owner: equal for the same unknown of every blade.
  std::string family() const;
};

/// Unknowns that belong together, with their share of an energy e = z^T weight z / 2. Kinetic:
/// inertial velocities, components in the part's own frame. Strain: internal loads.
struct EnergyGroup {
  enum class Kind { kinetic, strain };
  Kind kind = Kind::kinetic;
  Owner owner;
  std::string direction{};  ///< of a strain, that of the Motion which it restores
  Frame frame = Frame::fixed;
  std::vector<PetscInt> unknowns{};
  std::vector<double> weight{};  ///< row by row, unknowns x unknowns, symmetric
  double damping = 0.0;  ///< mu [s] of a strain: its load is the elastic one times 1 + mu d/dt
};

/// A way in which a system moves: a part deforms in a direction, or a joint or a support turns or
/// gives way. The motions together make any position of the system.
struct Motion {
  Owner owner;
  std::string direction{};  ///< "flap", "fore-aft", "flap hinge"; empty where the part says it all
  /// One of two directions in which a beam bends: where modes of both have equal exponents they mix
  /// at will.
  bool bends = false;
  /// Positions of one of several alike in this direction, in the order of every other one, and
  /// their masses or inertias.
  std::vector<PetscInt> unknowns{};
  std::vector<double> weight{};

  /// Whether this is the same motion of two parts alike, or the same one.
  bool is_alike(const Motion& other) const {
    return owner.part == other.owner.part && direction == other.direction;
  }
  /// "blade flap", "yaw": equal for motions that are alike, and that of the strain energy that
  /// restores it.
  std::string name() const;
};

/// Motion::name() of that which a strain energy restores.
std::string motion_name(const EnergyGroup& group);

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

/// A coordinate whose mean nothing restores, and the row of the load that would hold it. Where an
/// integral of its rate already gives this load, the row is the evolution row of the integral: the
/// mean of that row says nothing new, and the "load" is the offset of the rate that it leaves.
struct UnconstrainedCoordinate {
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

}  // namespace samara::system
