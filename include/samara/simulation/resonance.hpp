// Bands of instability between the points of a sweep at which no mode grows (docs/theory.md,
// section 5.12).
#pragma once

#include <complex>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "samara/simulation/campbell.hpp"

namespace samara::simulation {

/// Two modes at a place between two neighbouring points where the sum or the difference of their
/// frequencies is a multiple of the rotor speed: their multipliers meet there, and a band of
/// instability may begin. Both may be the same mode.
struct Resonance {
  double from = 0.0;  ///< values of the swept quantity at the points
  double to = 0.0;
  /// Exponents at both points, and the rotor speeds [rad/s]: of the copies that the lines follow,
  /// or with the frequencies in the fixed frame.
  std::complex<double> one_from, one_to, other_from, other_to;
  double speed_from = 0.0;
  double speed_to = 0.0;
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
/// modes grow, the most likely ones first: those of slow decays and low frequencies. `blades`: the
/// number of identical blades; from three on, multipliers meet only where the frequencies in the
/// fixed frame fit a multiple of `blades` times the rotor speed. 1: no symmetry of the rotor is
/// known.
std::vector<Resonance> find_resonances(const std::vector<CampbellPoint>& points,
                                       const std::vector<CampbellLine>& lines, int blades);

/// Finds the place where the frequencies of a resonance fit, by secants within the points, and
/// looks for more growing modes on the way.
/// @returns a place in a band; none where no mode begins to grow, or a point has no modes
std::optional<double> find_band(const Resonance& resonance,
                                const std::function<CampbellPoint(double)>& point_at);

}  // namespace samara::simulation
