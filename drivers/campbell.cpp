// samara campbell: the modes at the points of a sweep, joined to lines.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/analysis/ranks.hpp"
#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/base/words.hpp"
#include "samara/io/operation_table.hpp"
#include "samara/petsc/session.hpp"

#include "campbell_points.hpp"
#include "campbell_report.hpp"
#include "commands.hpp"
#include "interruption.hpp"
#include "progress.hpp"
#include "table.hpp"

namespace samara::drivers {
namespace {

using simulation::CampbellLine;
using simulation::CampbellPoint;
using simulation::StabilityEdge;

/// What the files contain: only on the first rank.
struct Diagram {
  std::vector<CampbellPoint> points;
  std::vector<std::size_t> numbers;  ///< of the points in the plan
  std::vector<CampbellLine> lines;
  std::string failures;  ///< whole lines
  int failed = 0;
  std::map<std::string, std::vector<std::string>> notes;  ///< places of each
};

Diagram read_diagram(const CampbellPlan& plan, const io::CampbellPointFiles& files) {
  Diagram diagram;
  analysis::ModeTracker tracker;
  for (std::size_t i = 0; i < plan.places.size(); ++i) {
    std::optional<CampbellPoint> read = files.read(i);
    if (!read) continue;
    CampbellPoint& point = *read;
    const std::string place = words_of(plan.quantities, point.place);
    for (const std::string& note : point.notes) diagram.notes[note].push_back(place);
    if (point.failure.empty()) {
      tracker.add(diagram.points.size(), std::move(point.signatures));
    } else {
      diagram.failures += place + ": " + point.failure + "\n";
      ++diagram.failed;
    }
    point.signatures = {};
    diagram.points.push_back(std::move(point));
    diagram.numbers.push_back(i);
  }
  diagram.lines = simulation::name_lines(diagram.points, tracker.lines());
  return diagram;
}

void report_notes(const Diagram& diagram, analysis::Observer& observer) {
  for (const auto& [note, places] : diagram.notes)
    observer.note(places.front() +
                  (places.size() > 1
                       ? " and " + count(static_cast<int>(places.size()) - 1, "other point")
                       : "") +
                  ": " + note);
}

/// The edges between the points of the first rank, found by all ranks; the result is on all of
/// them.
std::vector<StabilityEdge> search_together(const CampbellPlan& plan,
                                           const io::CampbellPointFiles& files,
                                           const Diagram& diagram, const analysis::Ranks& ranks,
                                           analysis::Observer& observer) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [first, second] : simulation::find_changes(diagram.points, diagram.lines))
    pairs.emplace_back(diagram.numbers[first], diagram.numbers[second]);
  ranks.share(0, pairs);
  std::vector<std::vector<StabilityEdge>> found;
  ranks.attempt([&] { found = search_edges(plan, files, pairs, ranks, observer); });
  std::vector<StabilityEdge> edges;
  for (std::size_t i = 0; i < found.size(); ++i) {
    ranks.share(rank_of(i, found.size(), ranks), found[i]);
    edges.insert(edges.end(), found[i].begin(), found[i].end());
  }
  return edges;
}

/// Relative distance of places in one band.
constexpr double same_place = 1e-5;
constexpr int place_digits = 6;

/// Crossings at which bands are searched where --bands is not given, at least, and the number of
/// points for each of more: a search takes two points or more.
constexpr int least_crossings = 4;
constexpr int points_of_crossing = 2;

/// What was searched between the points.
struct BandSearch {
  int searched = 0;  ///< crossings
  int left = 0;      ///< that were not searched
  std::vector<double> found = {};
};

/// Searches bands between the points of the first rank, at `most` crossings of frequencies, and
/// adds a point in each band to the plan, and one between two of them: they may be one band.
BandSearch add_bands(CampbellPlan& plan, const Diagram& diagram, int most,
                     const analysis::Ranks& ranks, analysis::Observer& observer) {
  std::vector<simulation::Resonance> resonances =
      simulation::find_resonances(diagram.points, diagram.lines);
  BandSearch search;
  search.searched = std::min(static_cast<int>(resonances.size()), most);
  search.left = static_cast<int>(resonances.size()) - search.searched;
  resonances.resize(static_cast<std::size_t>(search.searched));
  ranks.share(0, resonances);
  std::vector<double> found;
  ranks.attempt([&] { found = search_bands(plan, resonances, ranks, observer); });
  for (std::size_t i = 0; i < found.size(); ++i)
    ranks.share(rank_of(i, found.size(), ranks), found[i]);
  std::erase_if(found, [](double place) { return std::isnan(place); });
  std::ranges::sort(found);
  std::vector<double> places;
  for (const double place : found) {
    if (!places.empty()) {
      const double last = places.back();
      if (place - last <= same_place * std::abs(place)) continue;
      if (std::ranges::none_of(plan.places, [&](const simulation::SweepPlace& point) {
            return last < point.value && point.value < place;
          }))
        places.push_back(0.5 * (last + place));
    }
    places.push_back(place);
    search.found.push_back(place);
  }
  plan.insert(places);
  return search;
}

/// "bands of instability between the points: searched at 3 crossings of frequencies, none found"
std::string words_of(const BandSearch& search) {
  if (search.searched + search.left == 0) return "";
  std::string text = "bands of instability between the points: ";
  if (search.searched > 0)
    text += "searched at " + count(search.searched, "crossing") + " of frequencies, " +
            (search.found.empty() ? "none found" : "found at ");
  for (std::size_t i = 0; i < search.found.size(); ++i)
    text += (i > 0 ? ", " : "") + general(search.found[i], place_digits);
  if (search.left > 0)
    text += (search.searched > 0 ? "; not searched at " : "not searched at ") +
            count(search.left, "crossing") +
            (search.searched > 0 ? " of faster decay or higher frequency" : " of frequencies") +
            " (hint: --bands " + std::to_string(search.searched + search.left) + ")";
  return text + "\n";
}

}  // namespace

void run_campbell(const Job& job) {
  analysis::require_whole_spectrum("floquet_");
  const model::OperatingPointsDefinition& setup = job.input.operation;
  const bool has_table = !job.sweep.is_given() && !setup.table_path.empty();
  const std::vector<simulation::ScheduledPoint> table =
      has_table ? io::read_opt_file(setup.table_path) : std::vector<simulation::ScheduledPoint>();
  const bool is_first = petsc::Session::rank() == 0;
  CampbellPlan plan = plan_campbell(job, table);
  io::CampbellPointFiles files(job.result_path, plan.origins);
  Progress progress(is_first);
  const Interruption interruption("samara: ends after the present point; again to end at once\n");
  const analysis::Ranks ranks(PETSC_COMM_WORLD);
  // A rank that fails waits for the others, which may work on their points for long.
  ranks.attempt([&] { find_points(plan, files, ranks, progress); });
  Diagram diagram;
  ranks.attempt([&] {
    if (is_first) diagram = read_diagram(plan, files);
  });
  BandSearch search;
  if (plan.quantities.size() == 1 && ranks.all(!Interruption::is_asked())) {
    const std::size_t before = plan.places.size();
    const int most = job.bands.value_or(
        std::max(static_cast<int>(before) / points_of_crossing, least_crossings));
    search = add_bands(plan, diagram, most, ranks, progress);
    if (plan.places.size() > before) {
      files = io::CampbellPointFiles(job.result_path, plan.origins);
      ranks.attempt([&] { find_points(plan, files, ranks, progress); });
      ranks.attempt([&] {
        if (is_first) diagram = read_diagram(plan, files);
      });
    }
  }
  report_notes(diagram, progress);
  const std::vector<StabilityEdge> edges = search_together(plan, files, diagram, ranks, progress);
  const bool is_interrupted = !ranks.all(!Interruption::is_asked());
  int found = static_cast<int>(diagram.points.size());
  ranks.share(0, found);
  const bool is_complete = found == static_cast<int>(plan.places.size()) && !is_interrupted;
  progress.finish();
  if (is_first && found > 0)
    deliver(
        job,
        title_of(job.input) + "\n\n" +
            campbell_point_table(plan.quantities, diagram.points, diagram.lines) + "\n" +
            campbell_line_table(diagram.points, diagram.lines, edges) +
            campbell_doubts(diagram.points, diagram.lines) + words_of(search),
        [&](io::ResultFile& file) {
          io::write_campbell(file, plan.quantities, diagram.points, diagram.lines, edges,
                             is_complete);
        },
        [&](const std::string& path) {
          io::write_campbell_table(path, diagram.points, diagram.lines);
        });
  // On all ranks: the signal may have come to any of them.
  if (!is_complete)
    throw Interrupted(found == static_cast<int>(plan.places.size())
                          ? "interrupted before the edges of instability were refined; hint: the "
                            "same command goes on from here"
                          : "interrupted after " + std::to_string(found) + " of " +
                                std::to_string(plan.places.size()) +
                                " points; hint: the same command goes on from here");
  if (!is_first) return;
  files.remove();
  if (diagram.failed > 0)
    throw ConvergenceError(diagram.failures + std::to_string(diagram.failed) + " of " +
                           std::to_string(diagram.points.size()) + " points have no modes");
}

}  // namespace samara::drivers
