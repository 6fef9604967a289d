// A prescribed load on the elements of a beam (docs/theory.md, section 2.6).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "samara/model/definition.hpp"

namespace samara::model {

struct Beam;

/// Node a of element first_element + e receives sum_j weights[e](a, j) times the load with the
/// rotation of point j. A load at the tip acts on the last node with the rotation of the tip.
struct BeamLoad {
  int source = 0;                  ///< number of the load in the definition
  Vector6 load = Vector6::Zero();  ///< force, moment; components in a (dead) or in the section
  bool follower = false;
  bool at_tip = false;
  LoadVariation variation;
  Matrix3 tip_axes = Matrix3::Identity();  ///< C_ab of the tip, for a load at the tip
  int first_element = 0;
  std::vector<Eigen::MatrixXd> weights;  ///< 1 for a point load, [m] for a distributed one
};

/// Distributes a load to the elements of a beam. The integrals over the elements are exact.
BeamLoad build_load(const LoadDefinition& load, const BeamDefinition& definition, const Beam& beam);

}  // namespace samara::model
