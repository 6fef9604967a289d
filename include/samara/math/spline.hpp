// The natural cubic spline through points in space. Its parameter is the chord length; places on it
// are given by the arc length.
#pragma once

#include <vector>

#include "samara/math/types.hpp"

namespace samara::math {

class NaturalSpline {
 public:
  struct Place {
    Vector3 position;
    Vector3 tangent;  ///< of length one
  };

  /// At least two points, no two neighbours of which coincide.
  explicit NaturalSpline(std::vector<Vector3> points);

  double length() const { return arc_.back(); }

  /// The place at the arc length `arc`. The polynomials of the end intervals continue before the
  /// first and behind the last point.
  Place at(double arc) const;

 private:
  Vector3 position(std::size_t interval, double fraction) const;
  Vector3 slope(std::size_t interval, double fraction) const;  ///< by the parameter
  double arc_within(std::size_t interval, double fraction) const;
  double span(std::size_t interval) const { return knots_[interval + 1] - knots_[interval]; }

  std::vector<Vector3> points_;
  std::vector<Vector3> curvatures_;  ///< second derivatives at the points
  std::vector<double> knots_;        ///< chord length at the points
  std::vector<double> arc_;          ///< arc length at the points
};

}  // namespace samara::math
