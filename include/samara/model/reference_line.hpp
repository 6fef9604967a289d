// Reference line of an undeformed beam: straight along b1, or a spline over arc length.
#pragma once

#include <optional>

#include "samara/math/spline.hpp"
#include "samara/model/definition.hpp"

namespace samara::model {

class ReferenceLine {
 public:
  struct Station {
    Vector3 x = Vector3::Zero();         ///< components in a [m]
    Matrix3 C_ab = Matrix3::Identity();  ///< section basis: shortest rotation of a onto the
                                         ///< tangent, then twist about it
  };

  /// @throws InputError if the line turns back against b1 of its root.
  ReferenceLine(const std::string& name, const BeamDefinition& definition);

  /// Station at a fraction of the length, with a twist [rad] toward feather.
  Station at(double fraction, double twist = 0.0) const;

 private:
  double length_ = 0.0;
  std::optional<math::NaturalSpline> spline_;
};

}  // namespace samara::model
