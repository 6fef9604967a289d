// Bands of instability between the points of a sweep at which no mode grows (docs/theory.md,
// section 5.12).
#pragma once

#include <complex>
#include <functional>
#include <optional>
#include <vector>

#include "samara/simulation/campbell.hpp"

namespace samara::simulation {

/// Two modes at a point of a sweep.
struct ModePair {
  double place = 0.0;  ///< value of the swept quantity
  double rotor_speed = 0.0;
  /// Exponents of the copies that the lines follow, or with the frequencies in the fixed frame.
  std::complex<double> one, other;
};

/// Two modes at two neighbouring points, between which the sum or the difference of their
/// frequencies is a multiple of the rotor speed: their multipliers meet there, and a band of
/// instability may begin. Both modes may be the same.
struct Resonance {
  ModePair from, to;
  bool is_fixed_frame = false;
  int sign = 1;           ///< 1: sum of the frequencies, -1: difference
  int multiple = 0;       ///< of the rotor speed
  int growing = 0;        ///< growing modes at both points
  double priority = 0.0;  ///< small where both modes decay slowly and have low frequencies
};

/// Largest geometric mean of the decays of two modes, relative to the rotor speed, at which bands
/// are searched: a band begins where their coupling is above it.
inline constexpr double largest_decay_of_band = 0.05;

/// The resonances between neighbouring points of a sweep of one quantity at which equally many
/// modes grow, the most likely ones first: those of slow decays and low frequencies. With three or
/// more identical sectors of the rotor, multipliers meet only where the frequencies in the fixed
/// frame fit a multiple of that number times the rotor speed.
std::vector<Resonance> find_resonances(const std::vector<CampbellPoint>& points,
                                       const std::vector<CampbellLine>& lines);

/// Finds the place where the frequencies of a resonance fit, by secants within the points, and
/// looks for more growing modes on the way.
/// @returns a place in a band; none where no mode begins to grow, or a point has no modes
std::optional<double> find_band(const Resonance& resonance,
                                const std::function<CampbellPoint(double)>& point_at);

}  // namespace samara::simulation
