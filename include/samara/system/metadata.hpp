// Metadata of the unknowns, rows, energies and motions of a system. Analyses decide by roles and
// kinds; the names are only for the user.
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
  state,      ///< first-order, with memory: actuator, filter, controller, inflow
  auxiliary,  ///< without memory, with an algebraic row of its own
};

/// Role of a row.
enum class RowRole {
  constraint,  ///< position level, without rates: strain, curvature, a locked joint
  kinematic,   ///< velocity = rate of position
  balance,     ///< force and moment
  evolution,   ///< row of a state, regular in its rate
  definition,  ///< row of an auxiliary, without rates
};

/// "position", "velocity", ...
const char* word_of(UnknownRole role);
const char* word_of(RowRole role);

enum class Frame { fixed, rotating };

enum class PartKind {
  body,     ///< rigid: a nacelle, a hub, a mass
  beam,     ///< flexible
  joint,    ///< between two bodies
  support,  ///< elastic, between a body or the ground and the part on it
  law,      ///< equation without mass: actuator, controller
  medium,   ///< the fluid around a part: its induced velocity, its flow around a section
};

/// A part of the system, or one of several equal parts.
struct Owner {
  PartKind kind = PartKind::body;
  std::string part;  ///< "blade", "tower", "yaw"
  int instance = 0;  ///< from 1; 0 = the only one

  Owner() = default;
  Owner(PartKind kind_of_part, std::string part_name, int number = 0)
      : kind(kind_of_part), part(std::move(part_name)), instance(number) {}
  bool operator==(const Owner&) const = default;
  /// True for the same part and for one of several equal parts.
  bool is_alike(const Owner& other) const { return kind == other.kind && part == other.part; }
  /// "blade 1", "tower"
  std::string name() const;
};

struct Unknown {
  Owner owner;
  std::string place;     ///< place in its owner: "point 3", "root"; empty if the owner is a point
  std::string quantity;  ///< "u1", "angle", "M2"
  std::string unit;
  UnknownRole role = UnknownRole::position;
  Frame frame = Frame::fixed;  ///< frame that the owner moves with
  /// A free position to which constraints tie other positions: that of a hinge. Its row, at the
  /// same index, is the load on a support that does not exist.
  bool is_free = false;
  /// Usual size of a state: the unit for differences of states.
  double scale = 1.0;

  /// True for a position or a first-order state. The error of a solution is measured by these, each
  /// divided by its scale.
  bool is_coordinate() const { return role == UnknownRole::position || role == UnknownRole::state; }

  bool is_of_medium() const { return owner.kind == PartKind::medium; }

  /// Unit of the load that is work-conjugate to a position.
  std::string load_unit() const { return unit == "rad" ? "N m" : "N"; }

  /// "blade 1 point 3 theta2"
  std::string name() const;
  /// Name without the number of the owner: equal for the same unknown of every blade.
  std::string family() const;
};

/// Whether a medium, such as the air, has unknowns.
bool has_medium(const std::vector<Unknown>& unknowns);

/// A group of unknowns with its share e = z^T weight z / 2 of an energy. Kinetic: inertial
/// velocities, components in the part's own frame. Strain: internal loads.
struct EnergyGroup {
  enum class Kind { kinetic, strain };
  Kind kind = Kind::kinetic;
  Owner owner;
  std::string direction{};  ///< strain: direction of the Motion that it restores
  Frame frame = Frame::fixed;
  std::vector<PetscInt> unknowns{};
  std::vector<double> weight{};  ///< row by row, unknowns x unknowns, symmetric
  double damping = 0.0;          ///< mu [s] of a strain: load = elastic load times 1 + mu d/dt
};

/// A way in which a system moves: a part deforms in a direction, or a joint or a support moves. The
/// motions together span all positions of the system.
struct Motion {
  Owner owner;
  std::string direction{};  ///< "flap", "fore-aft", "flap hinge"; empty if the part name is enough
  /// One of the two bending directions of a beam. Modes of both directions with equal exponents mix
  /// arbitrarily.
  bool bends = false;
  /// Positions of this motion, in the same order for all equal parts, and their masses or inertias.
  std::vector<PetscInt> unknowns{};
  std::vector<double> weight{};

  /// True for the same motion of two equal parts, and for one and the same motion.
  bool is_alike(const Motion& other) const {
    return owner.part == other.owner.part && direction == other.direction;
  }
  /// "blade flap", "yaw": the same name for equal motions and for the strain energy that
  /// restores them.
  std::string name() const;
};

/// Motion::name() of the motion that a strain energy restores.
std::string motion_name(const EnergyGroup& group);

/// Error of an element of a mesh. For the motion z exp(lambda t), half the sum of squares of the
/// signals (constant + |lambda| rate) z is the energy that the element's polynomials omit. This
/// energy divided by twice the kinetic energy of the whole motion is the relative error of lambda
/// (docs/theory.md, section 5.9).
struct MeshError {
  std::vector<PetscInt> unknowns;
  Eigen::MatrixXd constant;  ///< signals x unknowns
  Eigen::MatrixXd rate;      ///< signals x unknowns, times |lambda| [rad/s]
  /// unknowns x unknowns, symmetric. Half of z* remainder z is the energy of the section data
  /// between the element's points that the points omit; it may have either sign.
  Eigen::MatrixXd remainder;
};

/// A coordinate whose mean nothing restores, and the row of the load that would hold it. If an
/// integral of its rate already gives this load, the row is the evolution row of the integral: the
/// mean of this row adds no equation, and the "load" is the remaining offset of the rate.
struct UnconstrainedCoordinate {
  std::string name;  ///< "yaw"
  PetscInt unknown = 0;
  PetscInt row = 0;
  std::string unit;   ///< unit of the load: "N m"
  double mean = 0.0;  ///< at which it is held while others are found [as the unknown]
};

/// z~(t) = P z(t + T/Q): entry i of P z is sign[i] z[source[i]] (docs/theory.md, section 5).
struct RotorSymmetry {
  int sectors = 1;        ///< Q
  std::string broken_by;  ///< reason why several blades do not repeat; empty if they do
  std::vector<PetscInt> source;
  std::vector<double> sign;
};

}  // namespace samara::system
