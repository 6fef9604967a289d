#include "samara/simulation/resonance.hpp"

#include <algorithm>
#include <cmath>

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

/// Exponent of a mode with its frequency in the fixed frame, if it has one.
std::optional<Complex> in_fixed_frame(const CampbellMode& mode) {
  if (!std::isfinite(mode.fixed_frame_frequency)) return std::nullopt;
  return Complex(mode.exponent.real(), mode.fixed_frame_frequency);
}

/// Exponent of a line at a point, if it is that of a mode whose damping is known.
std::optional<Complex> exponent_at(const std::vector<CampbellPoint>& points,
                                   const CampbellLine& line, std::size_t point,
                                   bool is_fixed_frame) {
  const auto found = std::ranges::find(line.modes, point, &analysis::TrackedMode::point);
  if (found == line.modes.end()) return std::nullopt;
  const CampbellMode& mode = points[point].modes[found->mode];
  if (mode.is_rough || mode.motion == Motion::growing) return std::nullopt;
  if (is_fixed_frame) return in_fixed_frame(mode);
  return analysis::tracked_exponent(mode.exponent, *found, points[point].rotor_speed);
}

/// Difference of the frequencies from the multiple, relative to the rotor speed.
double detuning(const Resonance& resonance, const ModePair& modes) {
  return (modes.one.imag() + resonance.sign * modes.other.imag()) / modes.rotor_speed -
         resonance.multiple;
}

/// Adds the resonances of two lines between two points, with multiples of `sectors`.
void add_resonances(const Resonance& between, int sectors, std::vector<Resonance>& all) {
  const ModePair& from = between.from;
  const ModePair& to = between.to;
  const double speed = std::max(from.rotor_speed, to.rotor_speed);
  const auto decay_of = [](Complex a, Complex b) { return std::max(-0.5 * (a + b).real(), 0.0); };
  const double decay =
      std::sqrt(decay_of(from.one, to.one) * decay_of(from.other, to.other)) / speed;
  if (decay > largest_decay_of_band) return;
  const bool is_same = from.one == from.other && to.one == to.other;
  for (const int sign : {1, -1}) {
    if (is_same && sign < 0) continue;
    Resonance next = between;
    next.sign = sign;
    next.priority = decay + weight_of_frequency *
                                (std::abs(from.one.imag()) + std::abs(from.other.imag())) / speed;
    const auto [low, high] = std::minmax({detuning(next, from), detuning(next, to)});
    for (int multiple = -largest_multiple; multiple <= largest_multiple; ++multiple) {
      if (multiple < low || multiple >= high || multiple % sectors != 0) continue;
      next.multiple = multiple;
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
      if (const std::optional<Complex> exponent = in_fixed_frame(mode)) take(*exponent);
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
                                       const std::vector<CampbellLine>& lines) {
  std::vector<Resonance> all;
  for (const auto& [first, second] : find_neighbours(points)) {
    const CampbellPoint& a = points[first];
    const CampbellPoint& b = points[second];
    if (count_growing(a) != count_growing(b)) continue;
    const bool is_fixed_frame = a.sectors > 2 && a.sectors == b.sectors;
    std::vector<std::pair<Complex, Complex>> modes;  // at both points
    for (const CampbellLine& line : lines) {
      const std::optional<Complex> from = exponent_at(points, line, first, is_fixed_frame);
      const std::optional<Complex> to = exponent_at(points, line, second, is_fixed_frame);
      if (from && to) modes.emplace_back(*from, *to);
    }
    for (std::size_t i = 0; i < modes.size(); ++i)
      for (std::size_t j = i; j < modes.size(); ++j) {
        Resonance between;
        between.from = {a.place.value, a.rotor_speed, modes[i].first, modes[j].first};
        between.to = {b.place.value, b.rotor_speed, modes[i].second, modes[j].second};
        between.is_fixed_frame = is_fixed_frame;
        between.growing = count_growing(a);
        add_resonances(between, is_fixed_frame ? a.sectors : 1, all);
      }
  }
  std::ranges::stable_sort(all, {}, &Resonance::priority);
  return all;
}

std::optional<double> find_band(const Resonance& resonance,
                                const std::function<CampbellPoint(double)>& point_at) {
  ModePair left = resonance.from;  // the ends of the present interval, and their detunings
  ModePair right = resonance.to;
  double of_left = detuning(resonance, left);
  double of_right = detuning(resonance, right);
  const ModePair* replaced = nullptr;
  for (int i = 0; i < most_points; ++i) {
    const double share = of_left == of_right ? 0.5 : of_left / (of_left - of_right);
    const auto mix = [share](auto a, auto b) { return a + share * (b - a); };
    const double place = mix(left.place, right.place);
    const CampbellPoint point = point_at(place);
    if (!point.failure.empty()) return std::nullopt;
    if (count_growing(point) > resonance.growing) return place;
    const std::optional<Complex> one =
        nearest_copy(point, mix(left.one, right.one), resonance.is_fixed_frame);
    const std::optional<Complex> other =
        nearest_copy(point, mix(left.other, right.other), resonance.is_fixed_frame);
    if (!one || !other) return std::nullopt;
    const ModePair middle{place, point.rotor_speed, *one, *other};
    const double here = detuning(resonance, middle);
    const double decay = -0.5 * (*one + *other).real() / point.rotor_speed;
    if (std::abs(here) < std::max(on_resonance, part_of_decay * decay) || share <= 0.0 ||
        share >= 1.0)
      return std::nullopt;
    const bool is_left = (here > 0.0) == (of_left > 0.0);
    ModePair& end = is_left ? left : right;
    // The Illinois method: an end that is kept twice counts half.
    if (replaced == &end) (is_left ? of_right : of_left) *= 0.5;
    (is_left ? of_left : of_right) = here;
    end = middle;
    replaced = &end;
  }
  return std::nullopt;
}

}  // namespace samara::simulation
