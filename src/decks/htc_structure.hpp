// The bodies of a HAWC2 deck in their undeformed places: `new_htc_structure`.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "samara/math/types.hpp"

#include "htc_import.hpp"
#include "htc_section.hpp"

namespace samara::decks {

/// A mass at a node of a body.
struct HtcMass {
  std::string place;
  int node = 1;
  double mass = 0.0;
  Vector3 offset = Vector3::Zero();   ///< from the node, axes of the body [m]
  Matrix3 inertia = Matrix3::Zero();  ///< about its own centre, axes of the body
};

/// A main body: a beam along the half-chord line through its points.
struct HtcBody {
  std::string name;    ///< in lower case
  std::string label;   ///< as written
  std::string source;  ///< the body that has the commands: another one's of a copy
  std::string place;
  std::vector<Vector3> points;  ///< of the line, axes of the body [m]
  std::vector<double> twists;   ///< about z of the body [rad]
  StTable table;
  std::array<double, 6>
      damping{};              ///< factors of the mass, and of bending about x, about y, torsion
  std::string damping_place;  ///< empty: none
  std::vector<HtcMass> masses;
  int uniform_nodes = 0;  ///< 0: one node at each point

  /// Lengths of the chords from the first point on [m].
  std::vector<double> chords() const;
  double length() const { return chords().back(); }
  /// Numbers of nodes.
  int nodes() const;
  /// Place of a node from 1 on, and as a share of the line.
  Vector3 node(int number) const;
  double share(int number) const;

  // In space: global axes of HAWC2 (z down, y downwind).
  bool is_placed = false;
  Matrix3 axes = Matrix3::Identity();  ///< columns x, y, z of the body
  Vector3 origin = Vector3::Zero();
  std::string parent;  ///< name of the body on which it stands; empty: the ground
  std::string place_of_orientation;
  bool starts_at_origin = false;  ///< its origin, not its first node, is at the parent

  Vector3 global(const Vector3& point) const { return origin + axes * point; }
};

/// A joint between two bodies, or one and the ground.
struct HtcConstraint {
  std::string kind;  ///< "fix1", "bearing2", ...
  std::string name;
  std::string place;
  std::string first;   ///< body; empty: the ground
  std::string second;  ///< body
  const HtcBlock* block = nullptr;
};

struct HtcStructure {
  std::vector<HtcBody> bodies;
  std::vector<HtcConstraint> constraints;
  /// Initial rotation of a body: its name, the vector in its axes, the speed [rad/s].
  struct Rotation {
    std::string body;
    std::string place;
    Vector3 axis = Vector3::Zero();
    double speed = 0.0;
  };
  std::vector<Rotation> rotations;
  double gravity = 0.0;  ///< [m/s^2]

  const HtcBody* find(const std::string& name) const;
};

/// Reads bodies, orientations and constraints; faults are in `import.errors`.
HtcStructure read_htc_structure(HtcImport& import);

}  // namespace samara::decks
