// A prescribed load as the elements of a beam take it (docs/theory.md, section 2.6).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "samara/model/definition.hpp"

namespace samara::model {

struct Beam;

/// Node a of element first_element + e collects sum_j weights[e](a, j) times the load as point j
/// turns it; a load at the tip goes to the last node as the tip turns it.
struct BeamLoad {
  int source = 0;                  ///< number of the load in the definition
  Vector6 load = Vector6::Zero();  ///< force, moment; components in a (dead) or in the section
  bool follower = false;
  bool at_tip = false;
  LoadVariation variation;
  Matrix3 tip_axes = Matrix3::Identity();  ///< C_ab of the tip, where the load is there
  int first_element = 0;
  std::vector<Eigen::MatrixXd> weights;  ///< 1 for a point load, [m] for a distributed one
};

/// Cuts a load on a beam that is cut already: the integrals over the elements are exact.
BeamLoad build_load(const LoadDefinition& load, const BeamDefinition& definition, const Beam& beam);

}  // namespace samara::model
