// Constant state-space forms with fewer states (docs/theory.md, section 10.7; A. J. Laub et al.,
// IEEE Trans. Autom. Control 32 (1987), 115-122; K. Glover, Int. J. Control 39 (1984), 1115-1193).
#pragma once

#include <Eigen/Core>

#include "samara/linear/linear_model.hpp"

namespace samara::linear {

enum class ReductionMethod {
  balanced,  ///< balanced truncation of the stable part
  modal,     ///< the slowest modes, and the static response of the others
};

struct ReducedForm {
  StateSpace form;
  int kept = 0;            ///< neutral and unstable states, all of which are kept
  Eigen::VectorXd hankel;  ///< Hankel singular values of the stable part, falling; balanced only
  /// Bound of the largest singular value of the difference of both transfer functions at any
  /// frequency, in units of outputs over inputs; balanced only.
  double error_bound = 0.0;
};

/// `order`: number of states. A pair of modes is not split, so that the result may have one less.
/// @throws InputError where neutral and unstable states alone are more than `order`
ReducedForm reduce(const StateSpace& form, int order, ReductionMethod method);

}  // namespace samara::linear
