#include "mode_report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <vector>

#include "samara/base/error.hpp"

#include "table.hpp"

namespace samara::drivers {
namespace {

using analysis::Mode;
using analysis::ModeSet;

constexpr double visible_share = 0.05;
constexpr std::size_t most_parts = 2;
constexpr std::size_t most_harmonics = 2;  // 1 beside an error
constexpr std::size_t most_names = 4;
/// Estimated errors beyond which a row is marked, and beyond which it counts for no verdict.
constexpr double marked_error = 0.01;
constexpr double largest_error = 0.1;
/// A verdict holds for the slowest modes, so many at the least.
constexpr std::size_t first_modes = 10;

double rate_scale(double rotor_speed) { return rotor_speed > 0.0 ? rotor_speed : 1.0; }

/// Whether the ground sees other frequencies than the rotor, and each of one mode.
bool has_fixed_frame(const ModeSet& set) { return set.rotor_speed > 0.0 && set.instances > 2; }

std::string percent(double share) { return fixed(100.0 * share, 0); }

std::string parts_of(const Mode& mode) {
  std::string text;
  std::size_t entries = 0;
  for (const analysis::PartShare& part : mode.parts) {
    if (part.share < visible_share || entries++ == most_parts) break;
    text += (text.empty() ? "" : " ") + part.part + " " + percent(part.share);
  }
  return text;
}

/// The harmonics beside the identified one, the largest first: "k-2:31% k+1:7%". Shares that print
/// alike are ordered by distance, so that rounding does not decide.
std::string other_harmonics(const ModeSet& set, std::size_t m, std::size_t most) {
  struct Entry {
    int offset;
    long percent;
  };
  std::vector<Entry> entries;
  const Eigen::RowVectorXd shares = set.participation.row(static_cast<Eigen::Index>(m));
  for (Eigen::Index i = 0; i < shares.size(); ++i) {
    const int offset = set.first_harmonic + static_cast<int>(i) - set.modes[m].harmonic;
    if (offset != 0 && shares(i) > visible_share)
      entries.push_back({offset, std::lround(100.0 * shares(i))});
  }
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tuple(-a.percent, std::abs(a.offset), a.offset) <
           std::tuple(-b.percent, std::abs(b.offset), b.offset);
  });
  std::string text;
  for (std::size_t i = 0; i < std::min(entries.size(), most); ++i)
    text += (text.empty() ? "k" : " k") + std::string(entries[i].offset > 0 ? "+" : "") +
            std::to_string(entries[i].offset) + ":" + std::to_string(entries[i].percent) + "%";
  return text;
}

/// Whether too little is known of a mode to say whether it grows.
bool is_rough(const Mode& mode) {
  return total_error(mode) > largest_error ||
         mode.growth_error >
             std::max(marked_error * std::abs(mode.exponent), std::abs(mode.exponent.real()));
}

std::string remark_on(const ModeSet& set, std::size_t m, Motion motion) {
  const Mode& mode = set.modes[m];
  if (!mode.resolved) return "unresolved*";
  if (motion == Motion::rigid_body) return "rigid-body";
  const bool is_marked = total_error(mode) > marked_error;
  std::string harmonics =
      set.participation.size() > 0 ? other_harmonics(set, m, is_marked ? 1 : most_harmonics) : "";
  if (!is_marked) return harmonics;
  const double percents = 100.0 * total_error(mode);
  return (percents < 100.0 ? "error " + general(percents, 2) + " %" : "error > 100 %") +
         (harmonics.empty() ? "" : "; " + harmonics);
}

/// Whether a mode decays as fast as this one grows, or grows as fast as it decays, in the same way.
/// In a conservative system every growth has its decay, exponents lambda and -lambda*, but for the
/// error of the mesh.
bool has_partner(const ModeSet& set, const Mode& mode) {
  constexpr double slack = 0.05;  // of the rate of growth
  const double apart = std::max(slack * std::abs(mode.exponent.real()),
                                analysis::zero_exponent * rate_scale(set.rotor_speed));
  const double rate = mode.exponent.real();
  return std::any_of(set.modes.begin(), set.modes.end(), [&](const Mode& other) {
    if (std::abs(other.exponent.real() + rate) > apart) return false;
    // A row stands for its conjugate, too, and each has a multiple of the rotor speed of its own.
    for (const double sign : {1.0, -1.0}) {
      double distance = sign * other.exponent.imag() - mode.exponent.imag();
      if (set.rotor_speed > 0.0) distance = std::remainder(distance, set.rotor_speed);
      if (std::abs(distance) < apart) return true;
    }
    return false;
  });
}

/// What a mode does. Where nothing damps, a growth or decay without its partner is an error: a
/// small one of a mode that is undamped.
Motion motion_in(const ModeSet& set, const Mode& mode) {
  const Motion motion = motion_of(mode, set.rotor_speed);
  const bool has_rate = motion == Motion::growing || motion == Motion::decaying;
  const bool is_small =
      std::abs(mode.exponent.real()) <= marked_error * std::abs(mode.exponent.imag());
  return set.conservative && has_rate && is_small && !has_partner(set, mode) ? Motion::undamped
                                                                             : motion;
}

std::vector<std::string> row_of(const ModeSet& set, std::size_t m) {
  const Mode& mode = set.modes[m];
  const Motion motion = motion_in(set, mode);
  const bool has_rate = motion == Motion::growing || motion == Motion::decaying;
  const bool is_known = has_rate || motion == Motion::rigid_body || !is_rough(mode);
  const double frequency = motion == Motion::rigid_body ? 0.0 : mode.exponent.imag();
  std::vector<std::string> row{std::to_string(m + 1), mode.label};
  if (set.rotor_speed > 0.0) row.push_back(fixed(frequency / set.rotor_speed, 4));
  row.push_back(fixed(frequency / (2.0 * std::numbers::pi), 4));
  if (has_fixed_frame(set))
    row.push_back(std::isfinite(mode.fixed_frame_frequency) && motion != Motion::rigid_body
                      ? fixed(mode.fixed_frame_frequency / (2.0 * std::numbers::pi), 4)
                      : "-");
  row.push_back(
      frequency == 0.0 || !is_known ? "-" : fixed(has_rate ? 100.0 * mode.damping_ratio : 0.0, 3));
  row.push_back(frequency == 0.0 || !is_known
                    ? "-"
                    : fixed(has_rate ? 100.0 * logarithmic_decrement(mode) : 0.0, 3));
  row.push_back(!has_rate
                    ? (is_known ? "0" : "-")
                    : (motion == Motion::growing ? "+" : "") + scientific(mode.exponent.real(), 2));
  if (set.participation.size() > 0) row.push_back(std::to_string(mode.harmonic));
  row.push_back(parts_of(mode));
  row.push_back(remark_on(set, m, motion));
  return row;
}

std::string seconds(double time) { return general(time, 3) + " s"; }

/// "yaw 1 doubles in 2.5 s, ..." of the modes that grow fastest.
std::string name_growing(std::vector<const Mode*> growing) {
  std::stable_sort(growing.begin(), growing.end(), [](const Mode* a, const Mode* b) {
    return a->exponent.real() > b->exponent.real();
  });
  std::string text;
  for (std::size_t i = 0; i < std::min(growing.size(), most_names); ++i)
    text += (text.empty() ? "" : ", ") + growing[i]->label + " doubles in " +
            seconds(std::numbers::ln2 / growing[i]->exponent.real());
  if (growing.size() > most_names)
    text += " and " + std::to_string(growing.size() - most_names) + " more";
  return text;
}

struct Tally {
  std::vector<const Mode*> growing;
  std::vector<const Mode*> growing_alone;  ///< what the mesh makes of a conservative system
  std::vector<const Mode*> decaying;
  int undamped = 0;
  int rigid_body = 0;
  int rough = 0;  ///< resolved by the step, with a large error
  int unresolved = 0;
};

Tally tally(const ModeSet& set) {
  Tally result;
  for (const Mode& mode : set.modes) {
    const Motion motion = motion_in(set, mode);
    if (!mode.resolved)
      ++result.unresolved;
    else if (motion == Motion::rigid_body)
      ++result.rigid_body;
    else if (is_rough(mode))
      ++result.rough;
    else if (motion == Motion::growing && set.conservative && !has_partner(set, mode))
      result.growing_alone.push_back(&mode);
    else if (motion == Motion::growing)
      result.growing.push_back(&mode);
    else if (motion == Motion::decaying)
      result.decaying.push_back(&mode);
    else
      ++result.undamped;
  }
  return result;
}

/// Whether all of the first modes are known: none that is not resolved can be among them. Deflated
/// decays are known to decay.
bool knows_first_modes(const ModeSet& set) {
  std::size_t below = static_cast<std::size_t>(set.deflated) / 2;
  std::size_t others = 0;
  for (const Mode& mode : set.modes)
    ++(mode.resolved && std::abs(mode.exponent) <= set.reach ? below : others);
  return below >= first_modes || others == 0;
}

std::string decay_words(const Tally& result) {
  const auto least = std::min_element(
      result.decaying.begin(), result.decaying.end(),
      [](const Mode* a, const Mode* b) { return a->damping_ratio < b->damping_ratio; });
  const int decaying = static_cast<int>(result.decaying.size());
  return (decaying == 1 ? "the mode decays" : "all " + count(decaying, "mode") + " decay") +
         "; the least damped is " + (*least)->label + ", " +
         general(100.0 * (*least)->damping_ratio, 3) + " %";
}

/// What the modes do that do not grow, in words.
std::string rest_words(const Tally& result) {
  std::vector<std::string> rest;
  const int decaying = static_cast<int>(result.decaying.size());
  if (decaying > 0)
    rest.push_back(std::to_string(decaying) + (decaying == 1 ? " decays" : " decay"));
  if (result.rigid_body > 0)
    rest.push_back(std::to_string(result.rigid_body) + (result.rigid_body == 1 ? " is" : " are") +
                   " rigid-body");
  if (result.undamped > 0)
    rest.push_back(std::to_string(result.undamped) + (result.undamped == 1 ? " is" : " are") +
                   " undamped, neither growing nor decaying by more than the error");
  std::string text;
  for (const std::string& words : rest) text += (text.empty() ? "" : "; ") + words;
  return text;
}

std::string hertz(double rate) { return general(rate / (2.0 * std::numbers::pi), 3) + " Hz"; }

/// Below which frequency all modes are resolved, and below which their errors are small.
std::string resolved_words(const ModeSet& set, const std::string& hidden) {
  double accurate = std::numeric_limits<double>::infinity();
  for (const Mode& mode : set.modes)
    if (mode.resolved && total_error(mode) > marked_error &&
        motion_of(mode, set.rotor_speed) != Motion::rigid_body)
      accurate = std::min(accurate, std::abs(mode.exponent));
  std::string text = std::isfinite(set.reach)
                         ? "all modes below " + hertz(set.reach) + " are resolved"
                         : "all modes are resolved";
  text += hidden;
  const std::string percents = general(100.0 * marked_error, 2) + " %";
  if (accurate < set.reach)
    text += "; those below " + hertz(accurate) + " have errors below " + percents;
  else
    text += "; their errors are below " + percents;
  return text;
}

}  // namespace

Motion motion_of(const Mode& mode, double rotor_speed) {
  const double zero = analysis::zero_exponent * rate_scale(rotor_speed);
  // Of the error of a growth, what step and rounding make is about zero; the elements' is not.
  const double unsure = mode.growth_error - mode.mesh_growth_error;
  if (std::abs(mode.exponent) < zero ||
      (mode.exponent.imag() == 0.0 && std::abs(mode.exponent) < unsure))
    return Motion::rigid_body;
  if (std::abs(mode.exponent.real()) <= mode.growth_error) return Motion::undamped;
  return mode.exponent.real() > 0.0 ? Motion::growing : Motion::decaying;
}

std::string mode_table(const ModeSet& set, const ModeListing& listing) {
  Table table;
  table.add_column("#", "");
  table.add_column("mode", "", Align::left);
  if (set.rotor_speed > 0.0) table.add_column("frequency", "per rev");
  table.add_column(set.rotor_speed > 0.0 ? "" : "frequency", "Hz");
  if (has_fixed_frame(set)) table.add_column("fixed frame", "Hz");
  table.add_column("damping", "%");
  table.add_column("log decr", "%");
  table.add_column("growth", "1/s");
  if (set.participation.size() > 0) table.add_column("harmonic", "k");
  table.add_column("energy in", "%", Align::left);
  table.add_column(set.participation.size() > 0 ? "other k, remark" : "", "", Align::left);
  std::vector<std::size_t> rows;
  for (const bool resolved : {true, false})
    for (std::size_t m = 0; m < set.modes.size(); ++m)
      if (set.modes[m].resolved == resolved && (resolved || listing.all)) rows.push_back(m);
  const std::size_t shown = listing.first > 0
                                ? std::min(rows.size(), static_cast<std::size_t>(listing.first))
                                : rows.size();
  for (std::size_t i = 0; i < shown; ++i) table.add_row(row_of(set, rows[i]));
  return table.text() + (shown < rows.size()
                             ? "the first " + std::to_string(shown) + " of " +
                                   count(static_cast<int>(rows.size()), "mode") + " (--first)\n"
                             : "");
}

Verdict find_verdict(const ModeSet& set, bool all) {
  const Tally result = tally(set);
  const std::string rest = rest_words(result);
  const bool is_periodic = set.participation.size() > 0;
  Verdict verdict;
  std::string& text = verdict.text;
  if (!knows_first_modes(set)) {
    verdict.is_given = false;
    text = "no verdict: modes from " + hertz(set.reach) + " on are not resolved" +
           (is_periodic ? "; hint: more floquet.steps" : "");
  } else if (!result.growing.empty()) {
    const int growing = static_cast<int>(result.growing.size());
    text = "unstable: " + count(growing, "mode") + (growing == 1 ? " grows: " : " grow: ") +
           name_growing(result.growing) + (rest.empty() ? "" : "\nof the others " + rest);
  } else if (!result.growing_alone.empty()) {
    verdict.is_given = false;
    text = "no verdict: the mesh is too coarse" + (rest.empty() ? "" : "; of the others " + rest);
  } else if (result.undamped + result.rigid_body > 0) {
    text = "neutral: no mode grows; " + rest;
  } else if (!result.decaying.empty()) {
    text = "stable: " + decay_words(result);
  } else {
    verdict.is_given = false;
    text = "no verdict: every mode has an error above " + general(100.0 * largest_error, 2) +
           " %; hint: a higher order of blades and tower, or more elements" +
           (is_periodic ? ", or more floquet.steps" : "");
  }
  text += "\n";
  const std::string hidden = set.deflated == 0
                                 ? ""
                                 : ", but for " + count(set.deflated, "exponent") + " of " +
                                       std::to_string(set.states) +
                                       (set.deflated == 1 ? " that decays" : " that decay") +
                                       " faster than " + general(set.deflated_rate, 3) + " 1/s";
  if (verdict.is_given) text += resolved_words(set, hidden) + "\n";
  if (!result.growing_alone.empty())
    text +=
        count(static_cast<int>(result.growing_alone.size()), "mode") +
        (result.growing_alone.size() == 1 ? " grows alone: " : " grow alone: ") +
        name_growing(result.growing_alone) +
        ";\nwhere nothing damps, growth and decay come in pairs, so this is an error of the mesh\n"
        "(hint: a higher order of blades and tower, or more elements)\n";
  if (result.rough > 0)
    text += count(result.rough, "mode") + (result.rough == 1 ? " has" : " have") +
            " too large an error and " + (result.rough == 1 ? "counts" : "count") +
            " for no verdict\n(hint: a higher order of blades and tower, more elements" +
            (is_periodic ? ", more floquet.steps" : "") + ")\n";
  if (result.unresolved > 0)
    text +=
        (all ? "* " : "") + std::to_string(result.unresolved) + " unresolved, " +
        (all ? "left out of the verdict: "
             : "not listed (--all lists them) and left out of the verdict:\n") +
        (is_periodic
             ? "too fast for the time step (hint: more floquet.steps), or a residual too large\n"
             : "a residual too large\n");
  return verdict;
}

void require_verdict(const Verdict& verdict) {
  if (!verdict.is_given) throw ConvergenceError(verdict.text.substr(0, verdict.text.find('\n')));
}

}  // namespace samara::drivers
