#include "samara/simulation/resonance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace samara::simulation {
namespace {

using Complex = std::complex<double>;

/// Weight of the frequencies of two modes beside their decay, all relative to the rotor speed.
constexpr double weight_of_frequency = 1e-3;
/// Largest multiple of the rotor speed: bands of higher order are narrow and weak.
constexpr int largest_multiple = 4;
/// Distance from a resonance that is no distance, relative to the rotor speed or to the mean decay
/// of the modes, and the number of points in a search.
constexpr double on_resonance = 1e-5;
constexpr double part_of_decay = 0.1;
constexpr int most_points = 5;

/// Whether a resonance may be between these points.
bool are_neighbours(const CampbellPoint& a, const CampbellPoint& b) {
  return a.failure.empty() && b.failure.empty() && are_in_a_row(a.place, b.place) &&
         a.rotor_speed > 0.0 && b.rotor_speed > 0.0 && count_growing(a) == count_growing(b);
}

/// Exponent of a line at a point, if it is that of a mode whose damping is known.
std::optional<Complex> exponent_at(const std::vector<CampbellPoint>& points,
                                   const CampbellLine& line, std::size_t point,
                                   bool is_fixed_frame) {
  const auto found = std::ranges::find(line.modes, point, &analysis::TrackedMode::point);
  if (found == line.modes.end()) return std::nullopt;
  const CampbellMode& mode = points[point].modes[found->mode];
  if (mode.is_rough || mode.motion == Motion::growing) return std::nullopt;
  if (is_fixed_frame && !std::isfinite(mode.fixed_frame_frequency)) return std::nullopt;
  if (is_fixed_frame) return Complex(mode.exponent.real(), mode.fixed_frame_frequency);
  return analysis::tracked_exponent(mode.exponent, *found, points[point].rotor_speed);
}

/// Difference of the frequencies from the multiple, relative to the rotor speed.
double detuning(const Resonance& resonance, Complex one, Complex other, double speed) {
  return (one.imag() + resonance.sign * other.imag()) / speed - resonance.multiple;
}

/// Adds the resonances of two lines between two points.
void add_resonances(const Resonance& between, int blades, std::vector<Resonance>& all) {
  const double speed = std::max(between.speed_from, between.speed_to);
  const auto decay_of = [](Complex from, Complex to) {
    return std::max(-0.5 * (from + to).real(), 0.0);
  };
  const double decay = std::sqrt(decay_of(between.one_from, between.one_to) *
                                 decay_of(between.other_from, between.other_to)) /
                       speed;
  if (decay > largest_decay_of_band) return;
  const bool is_same = between.one_from == between.other_from && between.one_to == between.other_to;
  for (const int sign : {1, -1}) {
    if (is_same && sign < 0) continue;
    Resonance next = between;
    next.sign = sign;
    const double from = detuning(next, next.one_from, next.other_from, next.speed_from);
    const double to = detuning(next, next.one_to, next.other_to, next.speed_to);
    const auto [low, high] = std::minmax(from, to);
    for (double multiple = std::max(std::ceil(low), -1.0 * largest_multiple);
         multiple < high && multiple <= largest_multiple; ++multiple) {
      next.multiple = static_cast<int>(multiple);
      if (next.multiple % blades != 0) continue;
      next.priority =
          decay + weight_of_frequency *
                      (std::abs(next.one_from.imag()) + std::abs(next.other_from.imag())) / speed;
      all.push_back(next);
    }
  }
}

/// The mode of a point whose exponent, or a copy of it, is next to `expected`; that copy.
std::optional<Complex> nearest_copy(const CampbellPoint& point, Complex expected,
                                    bool is_fixed_frame) {
  std::optional<Complex> nearest;
  const auto take = [&](Complex copy) {
    if (!nearest || std::abs(copy - expected) < std::abs(*nearest - expected)) nearest = copy;
  };
  for (const CampbellMode& mode : point.modes) {
    if (is_fixed_frame) {
      if (std::isfinite(mode.fixed_frame_frequency))
        take({mode.exponent.real(), mode.fixed_frame_frequency});
      continue;
    }
    for (const Complex exponent : {mode.exponent, std::conj(mode.exponent)}) {
      const double copies = std::round((expected - exponent).imag() / point.rotor_speed);
      take(exponent + Complex(0.0, copies * point.rotor_speed));
    }
  }
  return nearest;
}

}  // namespace

std::vector<Resonance> find_resonances(const std::vector<CampbellPoint>& points,
                                       const std::vector<CampbellLine>& lines, int blades) {
  const bool is_fixed_frame = blades > 2;
  std::vector<Resonance> all;
  for (std::size_t p = 0; p + 1 < points.size(); ++p) {
    const CampbellPoint& a = points[p];
    const CampbellPoint& b = points[p + 1];
    if (!are_neighbours(a, b)) continue;
    struct Side {
      Complex from, to;
    };
    std::vector<Side> modes;
    for (const CampbellLine& line : lines) {
      const std::optional<Complex> from = exponent_at(points, line, p, is_fixed_frame);
      const std::optional<Complex> to = exponent_at(points, line, p + 1, is_fixed_frame);
      if (from && to) modes.push_back({*from, *to});
    }
    for (std::size_t i = 0; i < modes.size(); ++i)
      for (std::size_t j = i; j < modes.size(); ++j) {
        Resonance between;
        between.from = a.place.value;
        between.to = b.place.value;
        between.one_from = modes[i].from;
        between.one_to = modes[i].to;
        between.other_from = modes[j].from;
        between.other_to = modes[j].to;
        between.speed_from = a.rotor_speed;
        between.speed_to = b.rotor_speed;
        between.is_fixed_frame = is_fixed_frame;
        between.growing = count_growing(a);
        add_resonances(between, is_fixed_frame ? blades : 1, all);
      }
  }
  std::ranges::stable_sort(all, {}, &Resonance::priority);
  return all;
}

std::optional<double> find_band(const Resonance& resonance,
                                const std::function<CampbellPoint(double)>& point_at) {
  Resonance left = resonance;  // of which the present interval is a part
  double from = detuning(left, left.one_from, left.other_from, left.speed_from);
  double to = detuning(left, left.one_to, left.other_to, left.speed_to);
  int kept = 0;  // 1: `to` at the step before, -1: `from`
  for (int i = 0; i < most_points; ++i) {
    const double share = from == to ? 0.5 : from / (from - to);
    const double place = left.from + share * (left.to - left.from);
    const CampbellPoint point = point_at(place);
    if (!point.failure.empty()) return std::nullopt;
    if (count_growing(point) > resonance.growing) return place;
    const auto mix = [share](Complex a, Complex b) { return a + share * (b - a); };
    const std::optional<Complex> one =
        nearest_copy(point, mix(left.one_from, left.one_to), left.is_fixed_frame);
    const std::optional<Complex> other =
        nearest_copy(point, mix(left.other_from, left.other_to), left.is_fixed_frame);
    if (!one || !other) return std::nullopt;
    const double here = detuning(left, *one, *other, point.rotor_speed);
    const double decay = -0.5 * (one->real() + other->real()) / point.rotor_speed;
    if (std::abs(here) < std::max(on_resonance, part_of_decay * decay) || share <= 0.0 ||
        share >= 1.0)
      return std::nullopt;
    if ((here > 0.0) == (from > 0.0)) {
      left.from = place;
      left.one_from = *one;
      left.other_from = *other;
      left.speed_from = point.rotor_speed;
      from = here;
      // The Illinois method: an end that is kept twice counts half.
      if (kept == 1) to *= 0.5;
      kept = 1;
    } else {
      left.to = place;
      left.one_to = *one;
      left.other_to = *other;
      left.speed_to = point.rotor_speed;
      to = here;
      if (kept == -1) from *= 0.5;
      kept = -1;
    }
  }
  return std::nullopt;
}

}  // namespace samara::simulation
