// A beam cut into elements: the section data at every Gauss point and the test functions that all
// its elements share (docs/theory.md, section 2).
#pragma once

#include <string>
#include <vector>

#include "samara/elements/beam_point.hpp"
#include "samara/model/definition.hpp"
#include "samara/model/load.hpp"

namespace samara::model {

/// Test functions of an element of order s at its Gauss points, by local node 0..s.
struct TestFunctions {
  std::vector<double> weights;              ///< w_j, sum 1
  std::vector<std::vector<double>> value;   ///< N_a(xi_j), [a][j]
  std::vector<std::vector<double>> slope;   ///< N_a'(xi_j) per unit xi, [a][j]
};

struct Beam {
  std::string name;                           ///< "tower", "blade 1"
  int elements = 0;
  int order = 0;
  double element_length = 0.0;                ///< L [m]
  TestFunctions functions;
  std::vector<elements::BeamPoint> points;    ///< elements * order, root to tip
  std::vector<double> fractions;              ///< of the length, of each point
  Vector3 tip = Vector3::Zero();              ///< undeformed tip, components in a [m]
  double tip_mass = 0.0;                      ///< [kg]
  std::vector<BeamLoad> loads;

  int point_count() const { return elements * order; }

  /// What point p gives of its length to integrals over the beam [m].
  double point_length(int p) const {
    return element_length * functions.weights[static_cast<std::size_t>(p % order)];
  }
};

/// Cuts a beam. Mass and stiffness are multiplied by the factors (blades that differ).
Beam build_beam(const std::string& name, const BeamDefinition& definition,
                double mass_factor = 1.0, double stiffness_factor = 1.0);

/// S^-1 of (4) with zero rows and columns in the rigid strains.
Matrix6 compliance_of(const SectionDefinition& section);

}  // namespace samara::model
