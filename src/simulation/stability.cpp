#include "samara/simulation/stability.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace samara::simulation {
namespace {

using analysis::Mode;
using analysis::ModeSet;

/// A verdict refers to the slowest modes, at least this many.
constexpr std::size_t first_modes = 10;
/// Relative to the rotor speed: an exponent with a larger error is not known to be that of a motion
/// at rest.
constexpr double largest_unsure = 0.02;

double rate_scale(double rotor_speed) { return rotor_speed > 0.0 ? rotor_speed : 1.0; }

/// True if another mode decays as fast as this one grows (or grows as fast as it decays) with the
/// same frequency. In a conservative system growth and decay come in pairs, exponents lambda and
/// -lambda*, except for the error of the mesh.
bool has_partner(const ModeSet& set, const Mode& mode) {
  constexpr double slack = 0.05;  // relative to the rate of growth
  const double apart = std::max(slack * std::abs(mode.exponent.real()),
                                analysis::zero_exponent * rate_scale(set.rotor_speed));
  const double rate = mode.exponent.real();
  return std::any_of(set.modes.begin(), set.modes.end(), [&](const Mode& other) {
    if (std::abs(other.exponent.real() + rate) > apart) return false;
    // A row also represents its conjugate, and each is known up to a multiple of the rotor speed.
    for (const double sign : {1.0, -1.0}) {
      double distance = sign * other.exponent.imag() - mode.exponent.imag();
      if (set.rotor_speed > 0.0) distance = std::remainder(distance, set.rotor_speed);
      if (std::abs(distance) < apart) return true;
    }
    return false;
  });
}

/// In a conservative system a small growth or decay without its partner is an error of an undamped
/// mode.
Motion motion_in(const ModeSet& set, const Mode& mode) {
  const Motion motion = motion_of(mode, set.rotor_speed);
  const bool has_rate = motion == Motion::growing || motion == Motion::decaying;
  const bool is_small =
      std::abs(mode.exponent.real()) <= marked_error * std::abs(mode.exponent.imag());
  return set.conservative && has_rate && is_small && !has_partner(set, mode) ? Motion::undamped
                                                                             : motion;
}

void sort_modes(const ModeSet& set, StabilityAssessment& result) {
  for (std::size_t m = 0; m < set.modes.size(); ++m) {
    const Mode& mode = set.modes[m];
    const Motion motion = motion_in(set, mode);
    result.motions.push_back(motion);
    if (!mode.resolved)
      ++result.unresolved;
    else if (motion == Motion::rigid_body)
      ++result.rigid_body;
    else if (is_rough(mode)) {
      ++result.rough;
      if (motion == Motion::growing ||
          mode.exponent.real() > marked_error * std::abs(mode.exponent))
        result.may_grow.push_back(m);
    } else if (motion == Motion::growing && set.conservative && !has_partner(set, mode))
      result.growing_alone.push_back(m);
    else if (motion == Motion::growing)
      result.growing.push_back(m);
    else if (motion == Motion::decaying) {
      result.decaying.push_back(m);
      if (is_of_medium(mode)) ++result.of_medium;
    } else
      ++result.undamped;
  }
  const auto grows_faster = [&set](std::size_t a, std::size_t b) {
    return set.modes[a].exponent.real() > set.modes[b].exponent.real();
  };
  std::ranges::stable_sort(result.growing, grows_faster);
  std::ranges::stable_sort(result.growing_alone, grows_faster);
  std::ranges::stable_sort(result.may_grow, grows_faster);
  const auto least = std::ranges::min_element(
      result.decaying, {}, [&set](std::size_t m) { return set.modes[m].damping_ratio; });
  if (least != result.decaying.end()) result.least_damped = *least;
}

/// True if every mode in the part of the spectrum that was searched is resolved. Of modes taken
/// from all, those asked for or the first ones are to be there, unless there are no others.
bool result_of_search_is_known(const ModeSet& set) {
  const std::size_t least = std::min(first_modes, static_cast<std::size_t>(set.searched->wanted));
  if (set.searched->is_of_all && std::isfinite(set.reach) && set.modes.size() < least) return false;
  return std::all_of(set.modes.begin(), set.modes.end(),
                     [](const Mode& mode) { return mode.resolved; });
}

/// True if all of the first modes are known: no mode that is not resolved can be among them.
/// Deflated decays are known to decay; as many as a medium has states may be its own. Modes of a
/// medium, which may be hundreds of slow decays, do not count.
bool knows_first_modes(const ModeSet& set) {
  if (set.searched) return result_of_search_is_known(set);
  std::size_t below = static_cast<std::size_t>(std::max(set.deflated - set.medium_states, 0)) / 2;
  std::size_t others = 0;
  for (const Mode& mode : set.modes)
    if (!is_of_medium(mode))
      ++(mode.resolved && std::abs(mode.exponent) <= set.reach ? below : others);
  return below >= first_modes || others == 0;
}

/// Of the first modes, those with too large an error. Modes of a medium say nothing about others.
void count_first_modes(const ModeSet& set, StabilityAssessment& result) {
  std::vector<const Mode*> modes;
  for (const Mode& mode : set.modes)
    if (!is_of_medium(mode) && mode.resolved) modes.push_back(&mode);
  std::ranges::sort(modes, {}, [](const Mode* mode) { return std::abs(mode->exponent); });
  modes.resize(std::min(modes.size(), first_modes));
  result.first = static_cast<int>(modes.size());
  for (const Mode* mode : modes)
    if (motion_in(set, *mode) != Motion::rigid_body && is_rough(*mode)) ++result.first_rough;
}

/// True if no mode counts, or too few of the first ones in a medium.
bool knows_too_few(const ModeSet& set, const StabilityAssessment& result) {
  return (set.medium_states > 0 && 2 * result.first_rough > result.first) ||
         (result.undamped + result.rigid_body == 0 && result.decaying.empty());
}

}  // namespace

const char* word_of(Stability stability) {
  switch (stability) {
    case Stability::stable:
      return "stable";
    case Stability::neutral:
      return "neutral";
    case Stability::unstable:
      return "unstable";
    case Stability::unknown:
      break;
  }
  return "no verdict";
}

Motion motion_of(const Mode& mode, double rotor_speed) {
  const double zero = analysis::zero_exponent * rate_scale(rotor_speed);
  // Step and round-off cause an error of the growth of an exponent near zero; the elements do not.
  const double unsure = mode.growth_error - mode.mesh_growth_error;
  if (std::abs(mode.exponent) < zero ||
      (std::abs(mode.exponent) < unsure && unsure < largest_unsure * rate_scale(rotor_speed)))
    return Motion::rigid_body;
  if (std::abs(mode.exponent.real()) <= mode.growth_error) return Motion::undamped;
  return mode.exponent.real() > 0.0 ? Motion::growing : Motion::decaying;
}

bool is_rough(const Mode& mode) {
  return total_error(mode) > largest_error ||
         mode.growth_error >
             std::max(marked_error * std::abs(mode.exponent), std::abs(mode.exponent.real()));
}

StabilityAssessment assess_stability(const ModeSet& set) {
  StabilityAssessment result;
  sort_modes(set, result);
  count_first_modes(set, result);
  result.reach = set.reach;
  for (const Mode& mode : set.modes)
    if (mode.resolved && !is_of_medium(mode) && total_error(mode) > marked_error &&
        motion_of(mode, set.rotor_speed) != Motion::rigid_body)
      result.accurate_reach = std::min(result.accurate_reach, std::abs(mode.exponent));
  if (!result.growing.empty())  // one that is known suffices
    result.stability = Stability::unstable;
  else if (!knows_first_modes(set))
    result.doubt = Doubt::unresolved;
  else if (set.searched && !set.searched->is_counted)
    result.doubt = Doubt::incomplete;
  else if (!result.growing_alone.empty())
    result.doubt = Doubt::growing_alone;
  else if (!result.may_grow.empty())
    result.doubt = Doubt::may_grow;
  else if (knows_too_few(set, result))
    result.doubt = Doubt::rough;
  else
    result.stability =
        result.undamped + result.rigid_body > 0 ? Stability::neutral : Stability::stable;
  return result;
}

}  // namespace samara::simulation
