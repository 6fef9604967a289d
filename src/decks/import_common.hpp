// Common parts of the importers: the report, functions along a beam, section axes.
#pragma once

#include <string>
#include <vector>

#include "samara/base/format.hpp"
#include "samara/decks/import.hpp"
#include "samara/fields/field.hpp"
#include "samara/io/case_text.hpp"
#include "samara/math/types.hpp"
#include "samara/model/definition.hpp"

#include "deck_text.hpp"

namespace samara::decks {

/// Elements of a beam and Gauss points of each.
struct Mesh {
  int elements = 1;
  int order = 1;
};

/// Meshes of imported beams: the first ten modes of eight public turbines are within 0.4 % of those
/// on a mesh of 6 x 5 and 1 x 6 (docs/import.md).
inline constexpr Mesh bending_blade_mesh{3, 4};  ///< of blades that only bend
inline constexpr Mesh blade_mesh{2, 4};          ///< of blades with all six strains
inline constexpr Mesh bending_tower_mesh{1, 5};  ///< of towers below the former
inline constexpr Mesh tower_mesh{1, 4};          ///< below the latter

inline void set_mesh(model::BeamDefinition& beam, const Mesh& mesh) {
  beam.elements = mesh.elements;
  beam.order = mesh.order;
}

/// The mesh of a blade with aerodynamic sections: elements become short where the loads of the air
/// fall to zero at the tip. Of the 5 and 15 MW turbines the first ten damping ratios in the air are
/// then within 1 %, of public decks power and thrust within 0.4 % of those on 56 points
/// (docs/import.md). A blade with point masses keeps its mesh, whose ends follow the masses.
inline void set_air_mesh(model::BeamDefinition& beam) {
  if (!beam.point_masses.empty()) return;
  beam.element_lengths = {2.72, 3.4, 3.5, 3.2, 2.4, 1.2};
  beam.elements = static_cast<int>(beam.element_lengths.size());
  beam.order = 2;
}

/// A property along a beam, linear between its points. A place given twice is a jump.
struct Curve {
  std::vector<double> grid;  ///< 0 to 1, not falling
  std::vector<double> values;
};

/// A place on a beam where a property may jump: just before or just behind it.
struct Station {
  double place = 0.0;
  bool behind = false;  ///< of a jump
};

/// All places of the grids, from 0 to 1; a jump of any of them gives two stations. Where places of
/// several grids are the same to round-off, that of the first grid counts.
std::vector<Station> merge_grids(const std::vector<const std::vector<double>*>& grids);

/// Linear between the points, constant outside.
double interpolate(const Curve& curve, const Station& station);

/// `at` of a section: 1e-12 of the length behind the place for the section behind a jump.
double place_of(const Station& station);

/// From the axes of BeamDyn and windIO (x to the suction side, y to the trailing edge, z to the
/// tip; order shear x, shear y, axial, bending x, bending y, torsion) to b1 b2 b3.
Matrix6 turn_to_section_axes(const Matrix6& matrix);
Vector3 turn_to_section_axes(const Vector3& vector);
Vector6 turn_damping(const Vector6& mu);

/// Replaces a matrix that is symmetric but for round-off by its symmetric part. Returns its
/// asymmetry [of the diagonal]; 0 where it is symmetric, or too asymmetric to be corrected.
double symmetrize(Matrix6& matrix);

/// A section's mass matrix without offsets.
Matrix6 build_mass_matrix(double mass, const Vector3& inertia);

/// Couplings that are round-off beside the diagonal become 0.
void drop_round_off(Matrix6& matrix);

/// Adds the faults of the sections of a beam, each once, at the first place that has it.
void check_sections(const model::BeamDefinition& beam, const std::string& what,
                    const std::vector<std::string>& places, DeckErrors& errors);

/// Mass [kg] and first moment [kg m] of a beam along its line.
struct BeamMass {
  double mass = 0.0;
  double moment = 0.0;
};
BeamMass integrate_mass(const model::BeamDefinition& beam, double length);

/// Reads the case back: values of the deck may be invalid in a case.
/// @throws InputError
void check_import(const Import& import);

/// A number with few digits, for messages.
inline std::string rounded(double value, int digits = 6) { return general(value, digits); }

/// Texts of a deck may be in any encoding; the case is UTF-8.
std::string clean_text(const std::string& text);

}  // namespace samara::decks
