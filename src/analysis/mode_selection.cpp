#include "mode_selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "samara/analysis/identification.hpp"
#include "samara/base/error.hpp"
#include "samara/base/format.hpp"

namespace samara::analysis {
namespace {

/// Parts of the largest modulus that the frequency and the decay of a range may have: 0.8^2 + 0.6^2
/// = 1. The decay of a range is no less than the third of these.
constexpr double farthest_part = 0.8;
constexpr double largest_decay = 0.6;
constexpr double least_decay = 0.1;
/// Factor of the resolved frequencies where fewer modes are resolved than are asked for.
constexpr double usual_increase = 1.5;
/// Relative to an exponent: a difference that is none.
constexpr double same_value = 1e-6;
/// Relative to an exponent: largest error of a decay up to which it may equal another one.
constexpr double largest_error = 1e-2;

using Numbers = std::vector<std::size_t>;

class Selection {
 public:
  Selection(const ModeSet& set, const FloquetOptions& options)
      : set_(set),
        by_decay_(options.least_damped > 0),
        centre_(2.0 * std::numbers::pi * options.near_hz.value_or(0.0)),
        wanted_(static_cast<std::size_t>(wanted_modes(options))),
        rate_(set.rotor_speed > 0.0 ? set.rotor_speed : 1.0) {
    for (std::size_t m = 0; m < set.modes.size(); ++m)
      if (set.modes[m].resolved && !is_of_medium(set.modes[m]) && modulus_of(m) < set.reach)
        known_.push_back(m);
    std::ranges::stable_sort(known_, {}, [this](std::size_t m) { return key_of(m); });
  }

  bool has_fewer() const { return known_.size() < wanted_; }
  bool is_empty() const { return known_.empty(); }

  /// Modulus up to which all modes are to be resolved, since modes beyond the reach may be among
  /// those that are wanted; 0 where they are not.
  double lacking_reach() const {
    if (centre_ > 0.0) {
      const double end = centre_ + key_of(known_[wanted_ - 1]);
      return end > farthest_part * set_.reach ? end / farthest_part : 0.0;
    }
    if (!by_decay_) return 0.0;
    double highest = 0.0;
    for (std::size_t i = 0; i < wanted_; ++i) highest = std::max(highest, modulus_of(known_[i]));
    return knows_slowest_decays(static_cast<double>(known_.size()), static_cast<int>(wanted_),
                                highest, set_.reach)
               ? 0.0
               : highest / part_of_slowest;
  }

  /// @throws ConvergenceError if the frequency next to which modes are wanted is beyond the reach
  void require_reach() const {
    if (centre_ <= set_.reach) return;
    throw ConvergenceError("floquet.near_hz: modes from " +
                           general(set_.reach / (2.0 * std::numbers::pi), 3) +
                           " Hz on are not resolved; hint: floquet.search: hill" +
                           (set_.step > 0.0 ? ", or more floquet.steps" : ""));
  }

  /// Those that are taken, with all whose keys are not known to be larger, and the key at which
  /// they end: between the last one and the next one. A decay as fast as a growth is taken: without
  /// damping both come in pairs.
  std::pair<Numbers, double> take() const {
    if (known_.size() <= wanted_) return {known_, set_.reach};
    double last = key_of(known_[wanted_ - 1]);
    if (by_decay_) last = std::max(last, -key_of(known_.front()));
    const double slack = same_value * modulus_of(known_[wanted_ - 1]) + 2.0 * zero_exponent * rate_;
    Numbers taken;
    double next = 2.0 * set_.reach;
    for (const std::size_t m : known_)
      if (key_of(m) - error_of(m) <= last + slack)
        taken.push_back(m);
      else
        next = std::min(next, key_of(m));
    return {taken, 0.5 * (last + next)};
  }

  /// A rectangle of exponents in which the modes are complete: within the disk of the known ones,
  /// or of those that are taken, up to a decay that is not deflated.
  SearchedRegion region(const Numbers& taken, double edge) const {
    double largest = 0.0;  // where no mode is beyond reach
    for (const Mode& mode : set_.modes) largest = std::max(largest, std::abs(mode.exponent));
    const bool is_slowest = !by_decay_ && centre_ == 0.0;
    const double radius =
        std::min({is_slowest ? edge : set_.reach, set_.reach, 2.0 * std::max(largest, rate_)});
    double decay = by_decay_ ? std::min(edge, radius) : least_decay * radius;
    if (!by_decay_)
      for (const std::size_t m : taken)
        decay = std::max(decay, std::abs(set_.modes[m].exponent.real()));
    decay = std::min({decay, largest_decay * radius, set_.deflated_rate});
    double high = std::sqrt(radius * radius - decay * decay);
    if (centre_ > 0.0) high = std::min(high, centre_ + edge);
    const double low =
        centre_ > 0.0 && known_.size() > wanted_ ? std::max(centre_ - edge, 0.0) : 0.0;
    return {low, high, decay, decay, true, static_cast<int>(wanted_), by_decay_, 1.0, true};
  }

 private:
  double modulus_of(std::size_t m) const { return std::abs(set_.modes[m].exponent); }
  double key_of(std::size_t m) const {
    if (by_decay_) return -set_.modes[m].exponent.real();
    return centre_ > 0.0 ? std::abs(set_.modes[m].exponent.imag() - centre_) : modulus_of(m);
  }

  /// Of the key, as far as it decides between modes: that of a decay. (A larger one says nothing.)
  double error_of(std::size_t m) const {
    return by_decay_ ? std::min(set_.modes[m].growth_error, largest_error * modulus_of(m)) : 0.0;
  }

  const ModeSet& set_;
  bool by_decay_;
  double centre_;  ///< frequency next to which modes are wanted [rad/s]
  std::size_t wanted_;
  double rate_;
  Numbers known_;  ///< resolved modes below the reach, ascending by the key
};

}  // namespace

std::optional<double> lacking_reach(const ModeSet& set, const FloquetOptions& options) {
  if (!asks_for_some(options) || !std::isfinite(set.reach)) return std::nullopt;
  const Selection selection(set, options);
  if (selection.has_fewer()) return usual_increase * set.reach;
  const double lacking = selection.lacking_reach();
  return lacking > 0.0 ? std::optional(lacking) : std::nullopt;
}

void leave_wanted(ModeSet& set, const FloquetOptions& options) {
  const Selection selection(set, options);
  if (selection.is_empty()) return;  // no mode is resolved: the whole set says so
  selection.require_reach();
  auto [taken, edge] = selection.take();
  SearchedRegion region = selection.region(taken, edge);
  const double zero = zero_exponent * (set.rotor_speed > 0.0 ? set.rotor_speed : 1.0);
  for (std::size_t m = 0; m < set.modes.size(); ++m) {
    const Mode& mode = set.modes[m];
    // Without damping, growth and decay of an instability come in pairs.
    const double rate = mode.exponent.real();
    if (mode.resolved &&
        (set.conservative ? std::abs(rate) : rate) > std::max(mode.growth_error, zero))
      taken.push_back(m);
  }
  std::ranges::sort(taken);
  taken.erase(std::unique(taken.begin(), taken.end()), taken.end());
  pick_modes(set, taken);
  set.states = 0;  // not of those that are left
  set.deflated = 0;
  set.deflated_rate = std::numeric_limits<double>::infinity();
  set.found = 0;
  for (const Mode& mode : set.modes) set.found += mode.exponent.imag() == 0.0 ? 1 : 2;
  set.searched = region;
}

}  // namespace samara::analysis
