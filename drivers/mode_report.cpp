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
using simulation::Doubt;
using simulation::largest_error;
using simulation::marked_error;
using simulation::Motion;
using simulation::Stability;
using simulation::StabilityAssessment;

constexpr double visible_share = 0.05;
constexpr std::size_t most_parts = 2;
constexpr std::size_t most_harmonics = 2;  // 1 if there is an error
constexpr std::size_t most_names = 4;
/// Ratio of two errors of which one stands for both.
constexpr double alike = 1.05;

/// True if the fixed frame has other frequencies than the rotor, one for each mode.
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

/// The harmonics except the identified one, the largest first: "k-2:31% k+1:7%". Shares that print
/// equal are ordered by distance, so that round-off has no influence on the order.
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

bool has_rate(Motion motion) { return motion == Motion::growing || motion == Motion::decaying; }

/// "error 2.3 %" of a relative error.
std::string error_words(double error) {
  constexpr double whole_percents = 0.1;
  if (error > 1.0) return "error > 100 %";
  return "error " + (error < whole_percents ? general(100.0 * error, 2) : percent(error)) + " %";
}

/// Error of the real part of the exponent, relative to this part.
double relative_growth_error(const Mode& mode) {
  return mode.growth_error / std::abs(mode.exponent.real());
}

/// " (error 2.3 %)" behind a number that follows from the real part of the exponent, where its
/// error shows in the digits.
std::string growth_error_words(const Mode& mode) {
  const double error = relative_growth_error(mode);
  return error > marked_error ? " (" + error_words(error) + ")" : "";
}

/// Errors that show in the digits, and other harmonics. The error of the growth stands where it is
/// larger than that of the exponent, which is relative to the modulus or the rotor speed.
std::string remark_on(const ModeSet& set, std::size_t m, Motion motion) {
  const Mode& mode = set.modes[m];
  if (!mode.resolved) return "unresolved*";
  if (motion == Motion::rigid_body) return "rigid-body";
  std::string errors;
  if (total_error(mode) > marked_error) errors = error_words(total_error(mode));
  const double of_growth = relative_growth_error(mode);
  if (has_rate(motion) && of_growth > std::max(marked_error, alike * total_error(mode)))
    errors += (errors.empty() ? "growth " : ", growth ") + error_words(of_growth);
  std::string harmonics =
      set.participation.size() > 0
          ? other_harmonics(set, m, errors.empty() ? most_harmonics : std::size_t{1})
          : "";
  return errors + (errors.empty() || harmonics.empty() ? "" : "; ") + harmonics;
}

std::vector<std::string> row_of(const ModeSet& set, const StabilityAssessment& assessment,
                                std::size_t m, const simulation::AirPart* air) {
  const Mode& mode = set.modes[m];
  const Motion motion = assessment.motions[m];
  const bool is_moving = has_rate(motion);
  const bool is_known = is_moving || motion == Motion::rigid_body || !simulation::is_rough(mode);
  // Round-off splits equal real exponents into pairs with a small frequency.
  constexpr double real_exponent = 1e-6;
  const bool is_real = mode.exponent.imag() < real_exponent * std::abs(mode.exponent);
  const double frequency = motion == Motion::rigid_body || is_real ? 0.0 : mode.exponent.imag();
  std::vector<std::string> row{std::to_string(m + 1), mode.label};
  if (set.rotor_speed > 0.0) row.push_back(fixed(frequency / set.rotor_speed, 4));
  row.push_back(fixed(frequency / (2.0 * std::numbers::pi), 4));
  if (has_fixed_frame(set))
    row.push_back(std::isfinite(mode.fixed_frame_frequency) && motion != Motion::rigid_body
                      ? fixed(mode.fixed_frame_frequency / (2.0 * std::numbers::pi), 4)
                      : "-");
  row.push_back(
      frequency == 0.0 || !is_known ? "-" : fixed(is_moving ? 100.0 * mode.damping_ratio : 0.0, 3));
  if (air != nullptr)
    row.push_back(frequency == 0.0 || !is_known || std::isnan(air->held_damping[m])
                      ? "-"
                      : fixed(100.0 * (mode.damping_ratio - air->held_damping[m]), 3));
  // Near 100 % the damping ratio does not determine the decrement, nor is the frequency known.
  constexpr double most_ratio = 0.999995;  // printed as 100.000 %
  row.push_back(frequency == 0.0 || !is_known || std::abs(mode.damping_ratio) >= most_ratio
                    ? "-"
                    : fixed(is_moving ? 100.0 * logarithmic_decrement(mode) : 0.0, 3));
  row.push_back(!is_moving
                    ? (is_known ? "0" : "-")
                    : (motion == Motion::growing ? "+" : "") + scientific(mode.exponent.real(), 2));
  if (set.participation.size() > 0) row.push_back(std::to_string(mode.harmonic));
  row.push_back(parts_of(mode));
  row.push_back(remark_on(set, m, motion));
  return row;
}

std::string seconds(double time) { return general(time, 3) + " s"; }

/// The first names of some modes; `words`: what stands behind the name of a mode.
template <class Words>
std::string names_of(const ModeSet& set, const std::vector<std::size_t>& modes,
                     const Words& words) {
  std::string text;
  for (std::size_t i = 0; i < std::min(modes.size(), most_names); ++i) {
    const Mode& mode = set.modes[modes[i]];
    text += (text.empty() ? "" : ", ") + mode.label + words(mode);
  }
  if (modes.size() > most_names)
    text += " and " + std::to_string(modes.size() - most_names) + " more";
  return text;
}

/// "yaw 1 doubles in 2.5 s, ..." for the growing modes, fastest growth first.
std::string name_growing(const ModeSet& set, const std::vector<std::size_t>& growing) {
  return names_of(set, growing, [](const Mode& mode) {
    return " doubles in " + seconds(std::numbers::ln2 / mode.exponent.real()) +
           growth_error_words(mode);
  });
}

std::string decay_words(const ModeSet& set, const StabilityAssessment& result) {
  const Mode& least = set.modes[*result.least_damped];
  const int decaying = static_cast<int>(result.decaying.size()) - result.of_medium;
  const std::string air =
      result.of_medium == 0 ? "" : count(result.of_medium, "exponent") + " of the air";
  const std::string modes = decaying == 1 ? "the mode" : "all " + count(decaying, "mode");
  std::string words = modes + (decaying == 1 && air.empty() ? " decays" : " decay");
  if (decaying > 0 && !air.empty()) words = modes + " and " + air + " decay";
  if (decaying == 0) words = "all " + air + " decay";
  return words + "; the least damped is " + least.label + ", " +
         general(100.0 * least.damping_ratio, 3) + " %" + growth_error_words(least);
}

/// Text on the behaviour of the modes that do not grow.
std::string rest_words(const StabilityAssessment& result) {
  std::vector<std::string> rest;
  const int decaying = static_cast<int>(result.decaying.size()) - result.of_medium;
  if (decaying > 0)
    rest.push_back(std::to_string(decaying) + (decaying == 1 ? " decays" : " decay"));
  if (result.of_medium > 0)
    rest.push_back(count(result.of_medium, "exponent") + " of the air" +
                   (result.of_medium == 1 ? " decays" : " decay"));
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

bool is_of_slow_decays(const ModeSet& set) {
  return set.searched && set.searched->is_of_slow_decays;
}

bool is_periodic(const ModeSet& set) { return set.participation.size() > 0; }

/// True if more time steps resolve more.
bool has_steps(const ModeSet& set) {
  return is_periodic(set) && (!set.searched || set.searched->is_of_all);
}

/// Hint where a search has not led to a verdict.
std::string other_search(const ModeSet& set) {
  return is_of_slow_decays(set) ? "all modes, without floquet.least_damped"
                                : "another floquet.modes, or all modes without it";
}

/// Frequencies below which all modes are resolved, and below which their errors are small.
std::string resolved_words(const ModeSet& set, const StabilityAssessment& result,
                           const std::string& deflated) {
  const double reach = set.searched ? set.searched->high : result.reach;
  const bool has_all = is_of_slow_decays(set) ||
                       (set.searched && std::ranges::all_of(set.modes, [](const Mode& mode) {
                          return mode.resolved;
                        }));
  std::string text = has_all ? "all of these modes are resolved"
                     : std::isfinite(result.reach)
                         ? "all modes of natural frequency |lambda|/2 pi below " +
                               hertz(result.reach) + " are resolved"
                         : "all modes are resolved";
  text += deflated;
  const std::string percents = general(100.0 * marked_error, 2) + " %";
  if (result.accurate_reach < reach)
    text += "; those below " + hertz(result.accurate_reach) + " have errors below " + percents;
  else
    text += "; their errors are below " + percents;
  return text;
}

/// The part of the spectrum that was searched.
std::string searched_words(const ModeSet& set) {
  const analysis::SearchedRegion& region = *set.searched;
  return "searched: " +
         (region.low > 0.0 ? "from " + hertz(region.low) + " to " : std::string("up to ")) +
         hertz(region.high) + ", " +
         (region.growth == region.decay ? "growth" : "growth up to " + general(region.growth, 3)) +
         " and decay up to " + general(region.decay, 3) + " 1/s" +
         (!region.is_counted ? ""
          : region.largest_damping < 1.0
              ? "; none with a damping below " + percent(region.largest_damping) +
                    " % is missing there"
              : "; none is missing there") +
         (region.is_of_all ? "; other modes are not listed" : "; other modes are not known") +
         (set.medium_states > 0 ? "; exponents of the air are left out" : "") +
         (static_cast<std::size_t>(region.wanted) > set.modes.size()
              ? "\n" + std::to_string(region.wanted) + " modes were asked for; the others " +
                    (region.is_of_all           ? "are not resolved"
                     : region.is_of_slow_decays ? "decay too fast, or are too fast for the search"
                                                : "were not found")
              : "");
}

std::string deflated_words(const ModeSet& set) {
  if (set.deflated == 0) return "";
  return ", except for " + count(set.deflated, "exponent") + " of " + std::to_string(set.states) +
         (set.deflated == 1 ? " that decays" : " that decay") + " faster than " +
         general(set.deflated_rate, 3) + " 1/s";
}

/// That too few of the slowest modes are known.
std::string rough_words(const StabilityAssessment& result) {
  if (result.first_rough < result.first)
    return std::to_string(result.first_rough) + " of the " + std::to_string(result.first) +
           " slowest modes have too large an error";
  return result.first == 1 ? "the mode has too large an error"
                           : "the slowest modes have too large an error";
}

/// The first line of the verdict; for growing modes also a second line on the other modes.
std::string headline(const ModeSet& set, const StabilityAssessment& result) {
  const std::string rest = rest_words(result);
  const int growing = static_cast<int>(result.growing.size());
  switch (result.stability) {
    case Stability::unstable:
      return "unstable: " + count(growing, "mode") + (growing == 1 ? " grows: " : " grow: ") +
             name_growing(set, result.growing) + (rest.empty() ? "" : "\nother modes: " + rest);
    case Stability::neutral:
      return "neutral: no mode grows; " + rest;
    case Stability::stable:
      return "stable: " + decay_words(set, result);
    case Stability::unknown:
      break;
  }
  switch (result.doubt) {
    case Doubt::unresolved:
      return "no verdict: modes from " + hertz(set.reach) + " on are not resolved" +
             (has_steps(set) ? "; hint: more floquet.steps, or floquet.modes"
              : set.searched ? "; hint: " + other_search(set)
                             : "");
    case Doubt::incomplete:
      return "no verdict: modes may be missing in the range that was searched; hint: " +
             other_search(set);
    case Doubt::growing_alone:
      return "no verdict: the mesh is too coarse" + (rest.empty() ? "" : "; other modes: " + rest);
    case Doubt::may_grow:
      return "no verdict: " + count(static_cast<int>(result.may_grow.size()), "mode") +
             (result.may_grow.size() == 1 ? " may grow, but has" : " may grow, but have") +
             " too large an error: " +
             names_of(set, result.may_grow, [](const Mode&) { return ""; }) +
             "; hint: a higher order of blades and tower, more elements" +
             (is_periodic(set) ? ", more trim.harmonics" : "") +
             (has_steps(set) ? ", more floquet.steps" : "");
    default:
      return "no verdict: " + rough_words(result) +
             "; hint: a higher order of blades and tower, or more elements" +
             (has_steps(set) ? ", or more floquet.steps" : "");
  }
}

/// Modes that were left out of the verdict, one line each.
std::string doubtful_words(const ModeSet& set, const StabilityAssessment& result, bool all) {
  std::string text;
  const std::size_t alone = result.growing_alone.size();
  if (alone > 0)
    text += count(static_cast<int>(alone), "mode") +
            (alone == 1 ? " grows alone: " : " grow alone: ") +
            name_growing(set, result.growing_alone) +
            ";\nwithout damping, growth and decay come in pairs, so this is an error of the "
            "mesh\n(hint: a higher order of blades and tower, or more elements)\n";
  if (result.rough > 0)
    text += count(result.rough, "mode") + (result.rough == 1 ? " has" : " have") +
            " too large an error and " + (result.rough == 1 ? "does" : "do") +
            " not count for the verdict\n(hint: a higher order of blades and tower, more elements" +
            (has_steps(set) ? ", more floquet.steps" : "") + ")\n";
  if (result.unresolved > 0)
    text +=
        (all ? "* " : "") + std::to_string(result.unresolved) + " unresolved, " +
        (all ? "left out of the verdict: "
             : "not listed (--all lists them) and left out of the verdict:\n") +
        (has_steps(set)
             ? "too fast for the time step (hint: more floquet.steps), or a residual too large\n"
             : "a residual too large\n");
  if (result.of_medium > 0 && !all)
    text += count(result.of_medium, "exponent") + " of the air (inflow, shed wake, stall), " +
            (result.of_medium == 1 ? "a decay that is" : "decays that are") +
            " not listed (--all lists them)\n";
  return text;
}

/// Modes that are not resolved and decays of the air are listed by --all only.
bool is_listed(const ModeSet& set, const StabilityAssessment& assessment, std::size_t m) {
  return set.modes[m].resolved &&
         (!is_of_medium(set.modes[m]) || assessment.motions[m] == Motion::growing);
}

/// All modes that could be listed.
std::vector<std::size_t> rows_of(const ModeSet& set, const StabilityAssessment& assessment,
                                 bool all) {
  std::vector<std::size_t> rows;
  for (const bool resolved : {true, false})
    for (std::size_t m = 0; m < set.modes.size(); ++m)
      if (set.modes[m].resolved == resolved && (all || is_listed(set, assessment, m)))
        rows.push_back(m);
  return rows;
}

}  // namespace

std::vector<std::size_t> listed_modes(const ModeSet& set, const StabilityAssessment& assessment,
                                      const ModeListing& listing) {
  std::vector<std::size_t> rows = rows_of(set, assessment, listing.all);
  if (listing.first > 0)
    rows.resize(std::min(rows.size(), static_cast<std::size_t>(listing.first)));
  return rows;
}

std::string mode_table(const ModeSet& set, const StabilityAssessment& assessment,
                       const ModeListing& listing) {
  Table table;
  table.add_column("#", "");
  table.add_column("mode", "", Align::left);
  if (set.rotor_speed > 0.0) table.add_column("frequency", "per rev");
  table.add_column(set.rotor_speed > 0.0 ? "" : "frequency", "Hz");
  if (has_fixed_frame(set)) table.add_column("fixed frame", "Hz");
  table.add_column("damping", "%");
  if (listing.air != nullptr) table.add_column("of the air", "%");
  table.add_column("log decr", "%");
  table.add_column("growth", "1/s");
  if (set.participation.size() > 0) table.add_column("harmonic", "k");
  table.add_column("energy in", "%", Align::left);
  table.add_column(set.participation.size() > 0 ? "other k, remark" : "", "", Align::left);
  const std::size_t all = rows_of(set, assessment, listing.all).size();
  const std::vector<std::size_t> rows = listed_modes(set, assessment, listing);
  for (const std::size_t m : rows) table.add_row(row_of(set, assessment, m, listing.air));
  return table.text() + (rows.size() < all
                             ? "the first " + std::to_string(rows.size()) + " of " +
                                   count(static_cast<int>(all), "mode") + " (--first)\n"
                             : "");
}

void write_air_part(io::ResultFile& file, const std::string& group, const simulation::AirPart& part,
                    std::size_t blades) {
  file.write_values(group + "/held_air_damping", part.held_damping,
                    {"1",
                     "none",
                     "damping ratio of the same mode under the constant air loads of the steady "
                     "state; the part of the air is the difference to damping_ratio",
                     {"mode"}});
  file.write_values(group + "/held_air_likeness", part.likeness,
                    {"1", "none", "modal assurance criterion of both shapes", {"mode"}});
  const std::size_t stations = part.lengths.size() / blades;
  const auto count = static_cast<Eigen::Index>(part.lengths.size());
  std::vector<double> work;
  for (Eigen::Index m = 0; m < part.work.rows(); ++m)
    for (Eigen::Index i = 0; i < count; ++i) work.push_back(part.work(m, i));
  file.write_array(group + "/air_work", work,
                   {static_cast<std::size_t>(part.work.rows()), blades, stations},
                   {"J/m",
                    "none",
                    "work of the air per cycle and length of the blade, at the amplitude of the "
                    "mode's shape; positive where the air feeds the motion",
                    {"mode", "blade", "station"}});
  file.write_values(group + "/air_length",
                    {part.lengths.begin(), part.lengths.begin() + static_cast<long>(stations)},
                    {"m", "none", "length that each station stands for", {"station"}});
}

std::string verdict_text(const ModeSet& set, const StabilityAssessment& assessment, bool all) {
  std::string text = headline(set, assessment) + "\n";
  if (set.searched) text += searched_words(set) + "\n";
  if (assessment.stability != Stability::unknown)
    text += resolved_words(set, assessment, deflated_words(set)) + "\n";
  return text + doubtful_words(set, assessment, all);
}

void require_verdict(const ModeSet& set, const StabilityAssessment& assessment) {
  if (assessment.stability == Stability::unknown) throw ConvergenceError(headline(set, assessment));
}

}  // namespace samara::drivers
