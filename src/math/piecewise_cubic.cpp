#include "samara/math/piecewise_cubic.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace samara::math {
namespace {

/// The most buckets per interval. Knots that are spaced more unevenly need more steps of bisection.
constexpr std::size_t most_buckets = 8;

}  // namespace

void check_knots(const std::vector<double>& knots, const std::vector<double>& values) {
  if (knots.size() < 2 || values.size() != knots.size())
    throw std::invalid_argument("a curve needs at least two knots and a value at each");
  for (std::size_t i = 1; i < knots.size(); ++i)
    if (!(knots[i] > knots[i - 1])) throw std::invalid_argument("the knots of a curve do not rise");
}

PiecewiseCubic::PiecewiseCubic(std::vector<double> knots, const std::vector<double>& values,
                               const std::vector<double>& slopes)
    : knots_(std::move(knots)) {
  check_knots(knots_, values);
  check_knots(knots_, slopes);
  const std::size_t intervals = knots_.size() - 1;
  double shortest = last() - first();
  for (std::size_t i = 0; i < intervals; ++i) {
    const double h = knots_[i + 1] - knots_[i];
    const double chord = (values[i + 1] - values[i]) / h;
    coefficients_.push_back({values[i], slopes[i],
                             (3.0 * chord - 2.0 * slopes[i] - slopes[i + 1]) / h,
                             (slopes[i] + slopes[i + 1] - 2.0 * chord) / (h * h)});
    shortest = std::min(shortest, h);
  }
  const double length = last() - first();
  const double wanted = std::ceil(length / shortest);
  const auto most = static_cast<double>(most_buckets * intervals);
  const auto count = static_cast<std::size_t>(std::min(wanted, most));
  buckets_per_length_ = static_cast<double>(count) / length;
  std::size_t interval = 0;
  for (std::size_t b = 0; b < count; ++b) {
    const double start = first() + static_cast<double>(b) / buckets_per_length_;
    while (interval + 1 < intervals && knots_[interval + 1] <= start) ++interval;
    buckets_.push_back(static_cast<std::uint32_t>(interval));
  }
  buckets_.push_back(static_cast<std::uint32_t>(intervals - 1));
}

std::size_t PiecewiseCubic::interval_of(double x) const {
  const double place = std::clamp((x - first()) * buckets_per_length_, 0.0,
                                  static_cast<double>(buckets_.size() - 2));
  const auto bucket = static_cast<std::size_t>(place);
  // Round-off may put a place that is next to the border of two buckets in the other one.
  const std::size_t from = buckets_[bucket > 0 ? bucket - 1 : 0];
  const std::size_t to = buckets_[std::min(bucket + 2, buckets_.size() - 1)];
  const auto begin = knots_.begin() + static_cast<std::ptrdiff_t>(from) + 1;
  const auto end = knots_.begin() + static_cast<std::ptrdiff_t>(to) + 1;
  return static_cast<std::size_t>(std::upper_bound(begin, end, x) - knots_.begin()) - 1;
}

ValueAndSlope PiecewiseCubic::at(double x) const {
  if (std::isnan(x)) return {x, x};
  if (is_empty()) return {};
  const std::size_t interval = interval_of(x);
  const double t = x - knots_[interval];
  const auto& [c0, c1, c2, c3] = coefficients_[interval];
  return {c0 + t * (c1 + t * (c2 + t * c3)), c1 + t * (2.0 * c2 + t * 3.0 * c3)};
}

}  // namespace samara::math
