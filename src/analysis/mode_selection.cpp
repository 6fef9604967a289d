#include "mode_selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace samara::analysis {
namespace {

/// The slowest decays are known where they have frequencies in this part of the resolved ones, or
/// where this many times as many modes are resolved.
constexpr double part_of_slowest = 0.6;
constexpr double most_of_slowest = 3.0;
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
        wanted_(static_cast<std::size_t>(std::max(options.modes, options.least_damped))),
        rate_(set.rotor_speed > 0.0 ? set.rotor_speed : 1.0) {
    for (std::size_t m = 0; m < set.modes.size(); ++m)
      if (set.modes[m].resolved && !is_of_medium(set.modes[m]) && modulus_of(m) < set.reach)
        known_.push_back(m);
    std::ranges::stable_sort(known_, {}, [this](std::size_t m) { return key_of(m); });
  }

  bool has_fewer() const { return known_.size() < wanted_; }
  bool is_empty() const { return known_.empty(); }
  bool is_by_decay() const { return by_decay_; }
  double centre() const { return centre_; }
  int wanted() const { return static_cast<int>(wanted_); }

  /// Modulus up to which all modes are to be resolved, since modes beyond the reach may be among
  /// those that are wanted; 0 where they are not.
  double lacking_reach() const {
    if (!by_decay_) {
      const double end = centre_ > 0.0 ? centre_ + key_of(known_[wanted_ - 1]) : 0.0;
      return end > set_.reach ? end : 0.0;
    }
    double highest = 0.0;
    for (std::size_t i = 0; i < wanted_; ++i) highest = std::max(highest, modulus_of(known_[i]));
    const bool has_many =
        static_cast<double>(known_.size()) >= most_of_slowest * static_cast<double>(wanted_);
    return has_many || highest <= part_of_slowest * set_.reach ? 0.0 : highest / part_of_slowest;
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

 private:
  double modulus_of(std::size_t m) const { return std::abs(set_.modes[m].exponent); }
  double key_of(std::size_t m) const {
    return by_decay_ ? -set_.modes[m].exponent.real() : std::abs(modulus_of(m) - centre_);
  }

  /// Of the key, as far as it decides between modes: that of a decay. (A larger one says nothing.)
  double error_of(std::size_t m) const {
    return by_decay_ ? std::min(set_.modes[m].growth_error, largest_error * modulus_of(m)) : 0.0;
  }

  const ModeSet& set_;
  bool by_decay_;
  double centre_;  ///< modulus next to which modes are wanted [rad/s]
  std::size_t wanted_;
  double rate_;
  Numbers known_;  ///< resolved modes below the reach, ascending by the key
};

/// Leaves modes of these numbers, ascending.
void keep(ModeSet& set, const Numbers& numbers) {
  std::vector<Mode> modes;
  std::vector<Eigen::MatrixXcd> shapes;
  std::vector<Eigen::Index> rows;
  for (const std::size_t m : numbers) {
    modes.push_back(std::move(set.modes[m]));
    if (!set.shapes.empty()) shapes.push_back(std::move(set.shapes[m]));
    rows.push_back(static_cast<Eigen::Index>(m));
  }
  set.modes = std::move(modes);
  set.shapes = std::move(shapes);
  if (set.participation.rows() > 0) set.participation = set.participation(rows, Eigen::all).eval();
}

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
  auto [taken, edge] = selection.take();
  const bool is_by_decay = selection.is_by_decay();
  // Without an end, all modes are taken.
  double largest = 0.0;
  for (const Mode& mode : set.modes) largest = std::max(largest, std::abs(mode.exponent));
  const double reach = std::min(set.reach, std::nextafter(largest, 2.0 * largest));
  const double high = is_by_decay ? reach : std::min(selection.centre() + edge, reach);
  const double low = selection.centre() > edge ? selection.centre() - edge : 0.0;
  const double decay = std::min({is_by_decay ? edge : high, high, set.deflated_rate});
  for (std::size_t m = 0; m < set.modes.size(); ++m) {
    const Mode& mode = set.modes[m];
    const double rate = mode.exponent.real();
    // Without damping, growth and decay of an instability come in pairs.
    if (mode.resolved && (set.conservative ? std::abs(rate) : rate) > mode.growth_error)
      taken.push_back(m);
  }
  std::ranges::sort(taken);
  taken.erase(std::ranges::unique(taken).begin(), taken.end());
  keep(set, taken);
  set.reach = high;
  set.states = 0;  // not of those that are left
  set.deflated = 0;
  set.deflated_rate = std::numeric_limits<double>::infinity();
  set.found = 0;
  for (const Mode& mode : set.modes) set.found += mode.exponent.imag() == 0.0 ? 1 : 2;
  set.searched =
      SearchedRegion{low, high, decay, high, true, selection.wanted(), is_by_decay, 1.0, true};
}

}  // namespace samara::analysis
