// The reference line and the twist that BeamDyn (OpenFAST 3 and later) makes of key points: a
// polynomial over z in each member, fitted by least squares and exact at both ends.
#pragma once

#include <optional>
#include <vector>

#include "samara/math/types.hpp"
#include "samara/model/reference_line.hpp"

namespace samara::decks {

/// A key point in BeamDyn's axes: x to the suction side, y to the trailing edge, z to the tip [m],
/// and the twist [deg].
struct KeyPoint {
  Vector3 position = Vector3::Zero();
  double twist_deg = 0.0;
};

class BeamdynLine {
 public:
  /// `members`: numbers of key points; neighbouring members share one. z rises from point to point.
  /// `order` is that of BeamDyn's elements; the degree is min(order, key points - 1, 6).
  BeamdynLine(const std::vector<KeyPoint>& points, const std::vector<int>& members, int order);

  bool is_straight() const { return is_straight_; }
  double length() const { return length_; }  ///< of the arc [m]
  /// The line is far longer than the path through the key points: no blade has this shape, and only
  /// the length is known.
  bool swings_out() const { return swings_out_; }

  /// Points of a natural spline that follows the line, in b1 b2 b3 of the root; two for a straight
  /// one.
  const std::vector<Vector3>& points() const { return points_; }

  /// A place on the beam as BeamDyn counts its stations and as a case does.
  struct Place {
    double station = 0.0;    ///< members by their arcs, within a member by z
    double arc = 0.0;        ///< fraction of the length
    double twist_deg = 0.0;  ///< of the case's section axes
    bool jumps = false;      ///< behind a kink between members, where the twist jumps
  };

  /// The stations, the ends of members, and enough places between them to make the twist linear.
  std::vector<Place> places(const std::vector<double>& stations) const;

 private:
  /// A polynomial of xi in [-1, 1]: its values at the ends and (1 - xi^2) times a Legendre series.
  struct Member {
    double station = 0.0;         ///< at its beginning
    double arc = 0.0;             ///< the same [m]
    double length = 0.0;          ///< of its arc [m]
    Eigen::Vector4d first, last;  ///< x, y, z, twist
    Eigen::Matrix<double, Eigen::Dynamic, 4> series;

    Eigen::Vector4d chord(double xi) const;
    Eigen::Vector4d value(double xi) const;
    Vector3 slope(double xi) const;
    double arc_to(double xi) const;
  };

  /// Place on a member, at xi.
  Place place(const Member& member, double xi) const;
  void refine(const Member& member, double xi, const Place& end, double xi_end, int depth,
              std::vector<Place>& places) const;
  bool sample(int count);
  double case_twist(const Member& member, double xi, double arc) const;

  std::vector<Member> members_;
  std::vector<Vector3> points_;
  std::optional<model::ReferenceLine> case_line_;  ///< of a line that is not straight
  double length_ = 0.0;
  bool is_straight_ = false;
  bool swings_out_ = false;
};

}  // namespace samara::decks
