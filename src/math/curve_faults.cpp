#include "samara/math/curve_faults.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace samara::math {
namespace {

constexpr double most_parts = 50000.0;
/// Places in a part at which the curve is evaluated. They are irregular, so that an oscillation
/// does not have the same phase at all of them.
constexpr std::array<double, 4> places{0.0, 0.27, 0.51, 0.78};
/// Halvings that narrow down a jump or a kink. A smooth change shrinks with the interval.
constexpr int jump_halvings = 24;
constexpr int kink_halvings = 12;
/// Least part of the change that remains after the halvings, at a jump and at a kink.
constexpr double kept_jump = 1e-3;
constexpr double kept_kink = 0.5;
/// Relative to the largest change, or rate: smaller ones are not examined.
constexpr double least_change = 1e-3;
constexpr double least_kink = 1e-2;
/// Relative to the size of the values: smaller differences are round-off.
constexpr double round_off = 1e-12;
/// Least part of a change that deviates from the change expected from the neighbours.
constexpr double least_surprise = 0.1;
/// Relative to the range: the steps do not resolve a motion that deviates more from the line.
constexpr double largest_deviation = 0.1;

/// A curve by its values at rising times.
struct Samples {
  std::vector<double> t;
  std::vector<double> y;
  double least = 0.0;
  double largest = 0.0;
  bool by_steps = true;  ///< a part is a step

  std::size_t intervals() const { return t.size() - 1; }
  double change(std::size_t i) const { return y[i + 1] - y[i]; }
  double slope(std::size_t i) const { return change(i) / (t[i + 1] - t[i]); }
  double range() const { return largest - least; }
  double round_off_error() const {
    return round_off * std::max(std::abs(least), std::abs(largest));
  }
};

Samples sample(const TimeCurve& curve, double until, double step) {
  Samples samples;
  const double steps = std::max(1.0, std::round(until / step));
  const double parts = std::min(steps, most_parts);
  samples.by_steps = steps <= most_parts;
  const double part = until / parts;
  for (double k = 0.0; k < parts; k += 1.0)
    for (const double place : places) samples.t.push_back((k + place) * part);
  samples.t.push_back(until);
  for (const double t : samples.t) samples.y.push_back(curve.at(t).value);
  const auto [least, largest] = std::minmax_element(samples.y.begin(), samples.y.end());
  samples.least = *least;
  samples.largest = *largest;
  return samples;
}

/// The place of the jump between a and b; none where the change vanishes as the interval is halved.
std::optional<double> narrow_jump(const TimeCurve& curve, double a, double b) {
  double from = curve.at(a).value;
  double to = curve.at(b).value;
  const double whole = std::abs(to - from);
  for (int i = 0; i < jump_halvings; ++i) {
    const double middle = 0.5 * (a + b);
    if (middle <= a || middle >= b) break;
    const double value = curve.at(middle).value;
    const bool is_first = std::abs(value - from) >= std::abs(to - value);
    (is_first ? b : a) = middle;
    (is_first ? to : from) = value;
  }
  if (std::abs(to - from) <= kept_jump * whole) return std::nullopt;
  return b;
}

/// The kink between a and b: place, and change of the rate over the shortest interval.
CurveFault narrow_kink(const TimeCurve& curve, double a, double b) {
  for (int i = 0; i < kink_halvings; ++i) {
    const double part = 0.25 * (b - a);
    std::array<double, 5> y{};
    for (std::size_t k = 0; k < y.size(); ++k)
      y[k] = curve.at(a + static_cast<double>(k) * part).value;
    std::size_t best = 0;
    double largest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double bend = std::abs(y[k + 2] - 2.0 * y[k + 1] + y[k]);
      if (bend > largest) best = k;
      largest = std::max(largest, bend);
    }
    a += static_cast<double>(best) * part;
    b = a + 2.0 * part;
  }
  const double beside = b - a;
  const double before = curve.at(a).value - curve.at(a - beside).value;
  const double behind = curve.at(b + beside).value - curve.at(b).value;
  return {CurveFault::Kind::kink, 0.5 * (a + b), (behind - before) / beside};
}

}  // namespace

std::optional<CurveFault> find_jump(const TimeCurve& curve, double until, double step) {
  const Samples samples = sample(curve, until, step);
  if (!std::isfinite(samples.range())) return std::nullopt;
  double largest = samples.round_off_error() / least_change;
  for (std::size_t i = 0; i < samples.intervals(); ++i)
    largest = std::max(largest, std::abs(samples.change(i)));
  for (std::size_t i = 0; i < samples.intervals(); ++i) {
    const double change = samples.change(i);
    if (std::abs(change) <= least_change * largest) continue;
    const double before = samples.slope(i > 0 ? i - 1 : std::min(i + 1, samples.intervals() - 1));
    const double behind = samples.slope(i + 1 < samples.intervals() ? i + 1 : i > 0 ? i - 1 : i);
    const double expected = 0.5 * (before + behind) * (samples.t[i + 1] - samples.t[i]);
    if (samples.intervals() > 1 && std::abs(change - expected) <= least_surprise * std::abs(change))
      continue;
    if (const auto time = narrow_jump(curve, samples.t[i], samples.t[i + 1]))
      return CurveFault{CurveFault::Kind::jump, *time, change};
  }
  if (!samples.by_steps) return std::nullopt;
  for (std::size_t i = 0; i + places.size() < samples.t.size(); i += places.size()) {
    const double rise = samples.y[i + places.size()] - samples.y[i];
    for (std::size_t k = 1; k < places.size(); ++k) {
      const double off = samples.y[i + k] - samples.y[i] - places[k] * rise;
      if (std::abs(off) > largest_deviation * samples.range() + samples.round_off_error())
        return CurveFault{CurveFault::Kind::fast, samples.t[i], std::abs(off)};
    }
  }
  return std::nullopt;
}

std::optional<CurveFault> find_kink(const TimeCurve& curve, double until, double step) {
  const Samples samples = sample(curve, until, step);
  double largest = 0.0;
  for (std::size_t i = 0; i < samples.intervals(); ++i)
    largest = std::max(largest, std::abs(samples.slope(i)));
  const double part = samples.t.back() / static_cast<double>(samples.intervals());
  const double least = std::max(least_kink * largest, samples.round_off_error() / part * 1e6);
  std::optional<CurveFault> worst;
  const auto bend = [&](std::size_t i) {
    return std::abs(samples.slope(i + 1) - samples.slope(i));
  };
  for (std::size_t i = 0; i + 1 < samples.intervals(); ++i) {
    if (bend(i) <= least) continue;
    if (i > 0 && bend(i - 1) > bend(i)) continue;
    if (i + 2 < samples.intervals() && bend(i + 1) > bend(i)) continue;
    const CurveFault kink = narrow_kink(curve, samples.t[i], samples.t[i + 2]);
    if (std::abs(kink.size) > kept_kink * bend(i) &&
        (!worst || std::abs(kink.size) > std::abs(worst->size)))
      worst = kink;
  }
  return worst;
}

}  // namespace samara::math
