// Sections of HAWC2's tables (.st) as matrices of a case, and rigid bodies made of them.
#pragma once

#include "samara/math/types.hpp"

#include "htc_tables.hpp"

namespace samara::decks {

/// Matrices about the half-chord point. The axes b1 b2 b3 of a case are z, x, y of HAWC2's section:
/// along the line, toward the leading edge, toward the suction side.
struct StSection {
  Matrix6 stiffness = Matrix6::Zero();
  Matrix6 mass = Matrix6::Zero();
};

/// The section at a place along the line [m]: the columns are linear between the rows, constant
/// before the first and behind the last one. Of two rows at one place `behind` takes the second.
StSection interpolate_st(const StTable& table, double r, bool behind = false);

/// A value of a column at a place along the line.
double interpolate_column(const StTable& table, std::size_t column, double r, bool behind = false);

/// The same section in axes turned by 180 degrees about b1.
void turn_half(Matrix6& matrix);

/// Mass, centre and inertia of a body that is put together from parts.
class RigidBody {
 public:
  /// `inertia` about the centre of the part, in the axes of the body.
  void add(double mass, const Vector3& center, const Matrix3& inertia);
  void add(const RigidBody& other);

  bool is_empty() const { return mass_ == 0.0 && moments_.isZero(0.0); }
  double mass() const { return mass_; }
  Vector3 center() const;   ///< 0 without mass
  Matrix3 inertia() const;  ///< about the centre

 private:
  double mass_ = 0.0;
  Vector3 first_ = Vector3::Zero();    ///< mass times centre
  Matrix3 moments_ = Matrix3::Zero();  ///< inertia about the origin
};

/// Largest product of inertia [kg m^2].
double largest_product(const Matrix3& inertia);

}  // namespace samara::decks
