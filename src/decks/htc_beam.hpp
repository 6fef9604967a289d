// Bodies of HAWC2 as beams of a case and as rigid bodies.
#pragma once

#include <string>

#include "htc_structure.hpp"
#include "import_common.hpp"

namespace samara::decks {

/// Global axes of HAWC2 (x, y downwind, z down) to n1 n2 n3 of a case; x is to the left of one who
/// looks downwind.
inline Vector3 to_ground_axes(const Vector3& v) { return {-v(0), v(1), -v(2)}; }
Matrix3 to_ground_axes(const Matrix3& columns);

/// Fills line, sections, damping and masses of a beam, but for the masses at its first node.
/// `to_root` turns components in axes of the body to b1 b2 b3 of the root. `key` is that of the
/// case. Returns the twist at the points of the line [rad].
Curve build_beam(HtcImport& import, const HtcBody& body, const Matrix3& to_root,
                 const std::string& key, model::BeamDefinition& beam);

/// Chooses as many elements as the places of the masses need; masses that are too near to each
/// other become one.
void set_htc_mesh(HtcImport& import, model::BeamDefinition& beam, const Mesh& mesh);

/// Directions of a section of a body: along the line, along its x (the chord, to the leading edge),
/// and their normal, as columns in axes of the body. `twist` is the angle of x about z of the body,
/// seen along z.
Matrix3 section_axes(const Vector3& tangent, double twist);

/// Sums over the line of a body that is rigid in the case.
struct RigidBeam {
  RigidBody body;         ///< in n1 n2 n3 from the origin of the ground
  double bending = 0.0;   ///< integral of 1/EI, the larger one [1/(N m)]
  double twisting = 0.0;  ///< integral of 1/GJ [rad/(N m)]
};
RigidBeam integrate_body(const HtcBody& body);

/// A mass of a body, in the same axes.
void add_mass(const HtcBody& body, const HtcMass& mass, RigidBody& sum);

}  // namespace samara::decks
