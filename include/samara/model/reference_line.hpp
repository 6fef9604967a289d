// Where a beam runs before it deforms: straight along b1 or a spline, by arc length.
#pragma once

#include <optional>

#include "samara/math/spline.hpp"
#include "samara/model/definition.hpp"

namespace samara::model {

class ReferenceLine {
 public:
  struct Station {
    Vector3 x = Vector3::Zero();         ///< components in a [m]
    Matrix3 C_ab = Matrix3::Identity();  ///< section basis: a turned the shortest way onto the
                                         ///< tangent, then by the twist about it
  };

  /// @throws InputError where the line turns back against b1 of its root.
  ReferenceLine(const std::string& name, const BeamDefinition& definition);

  /// At a fraction of the length, with a twist [rad] toward feather.
  Station at(double fraction, double twist = 0.0) const;

 private:
  double length_ = 0.0;
  std::optional<math::NaturalSpline> spline_;
};

}  // namespace samara::model
