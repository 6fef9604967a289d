#include "samara/model/reference_line.hpp"

#include <Eigen/Geometry>

#include "samara/base/error.hpp"
#include "samara/math/rotation.hpp"

namespace samara::model {
namespace {

/// Cosine of 170 degrees. Beyond it the shortest rotation from b1 onto the tangent is not defined.
constexpr double least_cosine = -0.984807753012208;
constexpr int checks_a_point = 8;

/// Rotates e1 onto the unit vector `tangent` about their common normal.
Matrix3 shortest_turn(const Vector3& tangent) {
  const Vector3 e1 = Vector3::UnitX();
  const Matrix3 across = math::skew<double>(Vector3(e1.cross(tangent)));
  return Matrix3::Identity() + across + across * across / (1.0 + tangent.x());
}

}  // namespace

ReferenceLine::ReferenceLine(const std::string& name, const BeamDefinition& definition)
    : length_(definition.length) {
  if (definition.reference_line.empty()) return;
  spline_.emplace(definition.reference_line);
  const auto checks = static_cast<int>(definition.reference_line.size()) * checks_a_point;
  for (int i = 0; i <= checks; ++i)
    if (spline_->at(length_ * i / checks).tangent.x() < least_cosine)
      throw InputError(name + ".reference_line: turns back against b1 of the root, " +
                       std::to_string(length_ * i / checks) +
                       " m along it; hint: points run from the root to the tip");
}

ReferenceLine::Station ReferenceLine::at(double fraction, double twist) const {
  const Matrix3 twisted = math::turn_about<double>(-Vector3::UnitX(), twist);
  if (!spline_) return {Vector3(fraction * length_, 0.0, 0.0), twisted};
  const math::NaturalSpline::Place place = spline_->at(fraction * length_);
  return {place.position, shortest_turn(place.tangent) * twisted};
}

}  // namespace samara::model
