// A curve of cubic polynomials between knots.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "samara/math/linearized.hpp"

namespace samara::math {

/// Cubic Hermite polynomials between rising knots. Intervals are found through equal buckets, in a
/// time that hardly depends on their number.
class PiecewiseCubic {
 public:
  /// Zero everywhere.
  PiecewiseCubic() = default;
  /// One value and one slope per knot; at least two knots.
  /// @throws std::invalid_argument where the sizes differ or the knots do not rise
  PiecewiseCubic(std::vector<double> knots, const std::vector<double>& values,
                 const std::vector<double>& slopes);

  bool is_empty() const { return knots_.empty(); }
  double first() const { return knots_.front(); }
  double last() const { return knots_.back(); }
  const std::vector<double>& knots() const { return knots_; }

  /// For x from the first to the last knot.
  ValueAndSlope at(double x) const;

 private:
  std::size_t interval_of(double x) const;

  std::vector<double> knots_;
  std::vector<std::array<double, 4>> coefficients_;  ///< of powers of x - knot, per interval
  std::vector<std::uint32_t> buckets_;               ///< interval at the start of each bucket
  double buckets_per_length_ = 0.0;
};

/// Checks that there are at least two knots, that they rise, and that each has a value.
/// @throws std::invalid_argument otherwise
void check_knots(const std::vector<double>& knots, const std::vector<double>& values);

}  // namespace samara::math
