// Writes a case file with comments. Numbers read back as the same doubles.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "samara/math/types.hpp"

namespace samara::decks {

/// A section as the case file states it: section axes b1 b2 b3, twist in degrees.
struct DraftSection {
  double at = 0.0;
  Matrix6 stiffness = Matrix6::Zero();
  std::array<bool, 6> rigid{};
  Matrix6 mass = Matrix6::Zero();
  double twist_deg = 0.0;
};

/// Elements of a beam and Gauss points of each.
struct Mesh {
  int elements = 1;
  int order = 1;
};

/// Of imported beams: the first ten modes are within 0.5 % of converged ones (docs/import.md).
inline constexpr Mesh bending_blade_mesh{3, 4};  ///< of blades that do nothing but bend
inline constexpr Mesh blade_mesh{2, 4};          ///< of blades with all six strains
inline constexpr Mesh bending_tower_mesh{1, 5};  ///< of towers below the former
inline constexpr Mesh tower_mesh{1, 4};          ///< below the latter

struct DraftBeam {
  double length = 0.0;
  std::vector<Vector3> reference_line;  ///< in the axes of the file; empty: straight
  int elements = 4;
  int order = 2;
  std::vector<DraftSection> sections;
  Vector6 damping = Vector6::Zero();
  Vector3 mass_damping = Vector3::Zero();
  double tip_mass = 0.0;
};

inline void set_mesh(DraftBeam& beam, const Mesh& mesh) {
  beam.elements = mesh.elements;
  beam.order = mesh.order;
}

struct DraftDifference {
  double pitch_deg = 0.0;
  double mass_factor = 1.0;
  double stiffness_factor = 1.0;
};

/// A case in the units of its file.
struct CaseDraft {
  std::string title;
  std::vector<std::string> head;             ///< lines of the comment on top
  std::map<std::string, std::string> notes;  ///< comments behind keys, by their path

  double gravity = 9.80665;
  bool has_tower = false;
  bool has_rotor = true;  ///< false: nothing but the tower
  DraftBeam tower;
  double nacelle_mass = 0.0;
  Vector3 nacelle_center = Vector3::Zero();
  Vector3 nacelle_inertia = Vector3::Zero();
  bool yaw_free = false;
  double yaw_stiffness = 0.0;
  double yaw_damping = 0.0;
  double speed_rpm = 0.0;
  double overhang = 0.0;
  double tilt_deg = 0.0;
  double height = 0.0;
  double azimuth_deg = 0.0;
  double gear_ratio = 1.0;         ///< < 0: the generator turns the other way
  double generator_inertia = 0.0;  ///< about its own axis
  bool has_torsion = false;
  double torsion_stiffness = 0.0;
  double torsion_damping = 0.0;
  double hub_mass = 0.0;
  double hub_center = 0.0;
  Vector3 hub_inertia = Vector3::Zero();
  double hub_radius = 0.0;
  bool has_teeter = false;
  bool teeter_free = false;
  double teeter_stiffness = 0.0;
  double teeter_damping = 0.0;
  double undersling = 0.0;
  double delta3_deg = 0.0;
  int blades = 3;
  double precone_deg = 0.0;
  double pitch_deg = 0.0;
  DraftBeam blade;
  std::map<int, DraftDifference> each;
};

std::string write_case_text(const CaseDraft& draft);

/// The shortest decimal that reads back as the same double.
std::string exact(double value);

/// Few digits, for people.
std::string rounded(double value, int digits = 6);

}  // namespace samara::decks
