// A beam that is divided into elements: section data at every Gauss point, and the test functions
// of all its elements (docs/theory.md, section 2).
#pragma once

#include <string>
#include <vector>

#include "samara/elements/beam_point.hpp"
#include "samara/elements/beam_support.hpp"
#include "samara/model/definition.hpp"
#include "samara/model/load.hpp"

namespace samara::model {

/// Test functions of an element of order s at its Gauss points, by local node 0..s.
struct TestFunctions {
  std::vector<double> weights;             ///< w_j, sum 1
  std::vector<std::vector<double>> value;  ///< N_a(xi_j), [a][j]
  std::vector<std::vector<double>> slope;  ///< N_a'(xi_j) per unit xi, [a][j]
};

/// A mass at the common end of two elements, or at the root.
struct MassNode {
  int end = 0;  ///< number of the end: end of element `end` - 1, start of element `end`
  Vector3 x = Vector3::Zero();     ///< undeformed, components in a [m]
  Matrix6 mass = Matrix6::Zero();  ///< about x, momenta from velocities, axes a
};

/// Energy of the sections of an element that its points omit: sum_jk p_j^T R_jk p_k / 2. p_j: loads
/// or velocities at the points, in the axes of their sections, interpolated between the points.
struct SectionRemainder {
  Eigen::MatrixXd compliance;  ///< 6 s x 6 s
  Eigen::MatrixXd mass;        ///< 6 s x 6 s
};

struct Beam {
  std::string name;  ///< "tower", "blade 1"
  int elements = 0;
  int order = 0;
  double length = 0.0;       ///< arc length [m]
  std::vector<double> ends;  ///< ends of the elements, fractions of the length, from 0
  TestFunctions functions;
  std::vector<elements::BeamPoint> points;   ///< elements * order, root to tip
  std::vector<double> fractions;             ///< place of each point, fraction of the length
  std::vector<SectionRemainder> remainders;  ///< one per element
  Vector3 tip = Vector3::Zero();             ///< undeformed tip, components in a [m]
  Matrix6 tip_mass = Matrix6::Zero();        ///< at the tip, as MassNode::mass
  std::vector<MassNode> mass_nodes;          ///< root to tip, without the tip
  bool has_support = false;                  ///< the first mass node is the root, on springs
  bool has_drag = false;                     ///< some sections have mass-proportional damping
  elements::RootSupport support;
  elements::EndSupport end_support;
  std::vector<BeamLoad> loads;

  int point_count() const { return elements * order; }

  /// The reference of the rotations of element e, components in a.
  const Matrix3& reference(int e) const {
    return points[static_cast<std::size_t>(e * order)].reference;
  }

  /// The reference of the rotation before the start of element e, on the side of the root.
  Matrix3 reference_before(int e) const {
    return e == 0 ? Matrix3(Matrix3::Identity()) : reference(e - 1);
  }

  /// L of element e [m].
  double element_length(int e) const {
    const auto at = static_cast<std::size_t>(e);
    return (ends[at + 1] - ends[at]) * length;
  }

  /// Weight of point p in integrals over the length of the beam [m].
  double point_length(int p) const {
    return element_length(p / order) * functions.weights[static_cast<std::size_t>(p % order)];
  }
};

/// Divides a beam into elements. The factors multiply mass and stiffness (for blades that differ).
Beam build_beam(const std::string& name, const BeamDefinition& definition, double mass_factor = 1.0,
                double stiffness_factor = 1.0);

/// Matrix of the momenta of a rigid body about a point. It multiplies the velocity of the point and
/// the angular velocity.
Matrix6 rigid_mass(double mass, const Vector3& center, const Matrix3& inertia_about_center);

/// S^-1 of (4) with zero rows and columns in the rigid strains.
Matrix6 compliance_of(const SectionDefinition& section);

}  // namespace samara::model
