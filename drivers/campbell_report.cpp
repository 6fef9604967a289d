#include "campbell_report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "samara/base/words.hpp"

#include "table.hpp"

namespace samara::drivers {
namespace {

using analysis::ModeTracker;
using analysis::TrackedMode;
using simulation::CampbellLine;
using simulation::CampbellMode;
using simulation::CampbellPoint;
using simulation::GrowthRange;
using simulation::StabilityEdge;

constexpr double to_hertz = 0.5 / std::numbers::pi;
constexpr double to_rpm = 30.0 / std::numbers::pi;
constexpr double to_degrees = 180.0 / std::numbers::pi;
constexpr int value_digits = 6;
constexpr int edge_digits = 5;  // of what edge_accuracy allows
constexpr std::size_t most_named = 4;

std::string hertz(double rate) { return fixed(std::abs(rate) * to_hertz, 4); }

/// A mode whose damping counts for a verdict.
bool is_known(const CampbellMode& mode) {
  return !mode.is_rough && (mode.motion == simulation::Motion::growing ||
                            mode.motion == simulation::Motion::decaying);
}

/// A mode on its line.
struct Placed {
  const CampbellLine* line = nullptr;
  const TrackedMode* tracked = nullptr;
};

/// The place of each mode of each point.
std::vector<std::vector<Placed>> places_of(const std::vector<CampbellPoint>& points,
                                           const std::vector<CampbellLine>& lines) {
  std::vector<std::vector<Placed>> places(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) places[p].resize(points[p].modes.size());
  for (const CampbellLine& line : lines)
    for (const TrackedMode& tracked : line.modes)
      places[tracked.point][tracked.mode] = {&line, &tracked};
  return places;
}

/// Damping ratio of the copy that the line follows.
double damping_of(const std::vector<CampbellPoint>& points, const TrackedMode& tracked) {
  const CampbellPoint& point = points[tracked.point];
  return tracked_damping(point.modes[tracked.mode].exponent, tracked, point.rotor_speed);
}

/// "6.5, 9 to 11": ranges in which a mode grows.
std::string growing_words(const std::vector<GrowthRange>& ranges) {
  std::string text;
  for (const GrowthRange& range : ranges)
    text += (text.empty() ? "" : ", ") + general(range.from, edge_digits) +
            (range.to == range.from ? "" : " to " + general(range.to, edge_digits));
  return text;
}

bool is_map(const std::vector<CampbellPoint>& points) {
  return !points.empty() && std::isfinite(points.front().place.second);
}

std::string place_words(const CampbellPoint& point) {
  return general(point.place.value, value_digits) +
         (std::isfinite(point.place.second) ? ", " + general(point.place.second, value_digits)
                                            : "");
}

/// "12 of 45 points"; empty where a mode grows nowhere.
std::string growing_part(const std::vector<CampbellPoint>& points, const CampbellLine& line) {
  const auto growing = std::ranges::count_if(line.modes, [&](const TrackedMode& tracked) {
    return is_growing(points[tracked.point].modes[tracked.mode]);
  });
  return growing == 0 ? ""
                      : std::to_string(growing) + " of " +
                            count(static_cast<int>(line.modes.size()), "point");
}

/// True if a mode has another frequency in the fixed frame than in the frame of its part.
bool has_fixed_frame(const std::vector<CampbellPoint>& points) {
  for (const CampbellPoint& point : points)
    for (const CampbellMode& mode : point.modes)
      if (std::isfinite(mode.fixed_frame_frequency) &&
          mode.fixed_frame_frequency != mode.exponent.imag())
        return true;
  return false;
}

}  // namespace

std::string words_of(const std::vector<io::SweptQuantity>& quantities,
                     const simulation::SweepPlace& place) {
  std::string text = quantities.front().key + "=" + general(place.value, value_digits);
  if (quantities.size() > 1)
    text += ", " + quantities.back().key + "=" + general(place.second, value_digits);
  return text;
}

std::string campbell_point_table(const std::vector<io::SweptQuantity>& quantities,
                                 const std::vector<CampbellPoint>& points,
                                 const std::vector<CampbellLine>& lines) {
  const std::vector<std::vector<Placed>> places = places_of(points, lines);
  const bool has_wind =
      quantities.front().key != "wind.speed" && quantities.back().key != "wind.speed" &&
      std::ranges::any_of(
          points, [](const CampbellPoint& point) { return std::isfinite(point.wind_speed); });
  Table table;
  for (const io::SweptQuantity& quantity : quantities)
    table.add_column(quantity.key, quantity.unit == "1" ? "" : quantity.unit);
  table.add_column("speed", "rpm");
  if (has_wind) table.add_column("wind", "m/s");
  table.add_column("pitch", "deg");
  table.add_column("modes", "");
  table.add_column("stability", "", Align::left);
  table.add_column("least damped", "%");
  table.add_column("", "", Align::left);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const CampbellPoint& point = points[p];
    const bool is_found = point.failure.empty();
    std::vector<std::string> row{general(point.place.value, value_digits)};
    if (quantities.size() > 1) row.push_back(general(point.place.second, value_digits));
    row.push_back(is_found ? fixed(point.rotor_speed * to_rpm, 3) : "-");
    if (has_wind)
      row.push_back(std::isfinite(point.wind_speed) ? general(point.wind_speed, 5) : "-");
    row.push_back(is_found ? fixed(point.pitch * to_degrees, 3) : "-");
    row.push_back(is_found ? std::to_string(point.modes.size()) : "-");
    row.push_back(is_found ? word_of(point.stability) : "failed");
    const Placed* least = nullptr;
    for (std::size_t m = 0; m < point.modes.size(); ++m) {
      const Placed& placed = places[p][m];
      if (is_known(point.modes[m]) && (least == nullptr || damping_of(points, *placed.tracked) <
                                                               damping_of(points, *least->tracked)))
        least = &placed;
    }
    row.push_back(least != nullptr ? fixed(100.0 * damping_of(points, *least->tracked), 3) : "-");
    row.push_back(least != nullptr ? least->line->name : point.failure);
    table.add_row(row);
  }
  return table.text();
}

std::string campbell_line_table(const std::vector<CampbellPoint>& points,
                                const std::vector<CampbellLine>& lines,
                                const std::vector<StabilityEdge>& edges) {
  const bool has_frame = has_fixed_frame(points);
  Table table;
  table.add_column("mode", "", Align::left);
  for (const char* end : {"from", "to"}) {
    table.add_column(end, "");
    table.add_column("frequency", "Hz");
    if (has_frame) table.add_column("fixed frame", "Hz");
  }
  table.add_column("least damping", "%");
  table.add_column("at", "");
  table.add_column("grows at", "", Align::left);
  table.add_column("remark", "", Align::left);
  int short_lines = 0;
  for (const CampbellLine& line : lines) {
    if (points.size() > 1 && line.modes.size() == 1) {
      ++short_lines;
      continue;
    }
    std::vector<std::string> row{line.name};
    for (const TrackedMode* end : {&line.modes.front(), &line.modes.back()}) {
      const CampbellPoint& point = points[end->point];
      const CampbellMode& mode = point.modes[end->mode];
      row.push_back(place_words(point));
      row.push_back(hertz(tracked_exponent(mode.exponent, *end, point.rotor_speed).imag()));
      if (has_frame)
        row.push_back(std::isfinite(mode.fixed_frame_frequency) ? hertz(mode.fixed_frame_frequency)
                                                                : "-");
    }
    const TrackedMode* least = nullptr;
    for (const TrackedMode& tracked : line.modes)
      if (is_known(points[tracked.point].modes[tracked.mode]) &&
          (least == nullptr || damping_of(points, tracked) < damping_of(points, *least)))
        least = &tracked;
    row.push_back(least != nullptr ? fixed(100.0 * damping_of(points, *least), 3) : "-");
    row.push_back(least != nullptr ? place_words(points[least->point]) : "-");
    row.push_back(is_map(points) ? growing_part(points, line)
                                 : growing_words(find_growth(points, line, edges)));
    double error = 0.0;
    for (const TrackedMode& tracked : line.modes)
      error = std::max(error, points[tracked.point].modes[tracked.mode].error);
    row.push_back(error > simulation::marked_error
                      ? "error up to " + general(100.0 * std::min(error, 1.0), 2) + " %"
                      : "");
    table.add_row(row);
  }
  return table.text() + (short_lines == 0 ? ""
                                          : count(short_lines, "mode") +
                                                " found at one point only: in the result\n");
}

std::string campbell_doubts(const std::vector<CampbellPoint>& points,
                            const std::vector<CampbellLine>& lines) {
  std::string names;
  std::size_t unclear = 0;
  std::size_t all = 0;
  for (const CampbellLine& line : lines)
    for (std::size_t i = 1; i < line.modes.size(); ++i) {
      ++all;
      if (line.modes[i].likeness >= ModeTracker::clear_likeness) continue;
      if (unclear++ < most_named)
        names += (names.empty() ? "" : ", ") + line.name + " at " +
                 place_words(points[line.modes[i].point]);
    }
  if (unclear == 0) return "";
  return "unclear, with a likeness below " + general(ModeTracker::clear_likeness, 2) + ", at " +
         std::to_string(unclear) + " of " + std::to_string(all) +
         " steps along the lines: " + names + (unclear > most_named ? ", ..." : "") +
         "\n(hint: a finer sweep there)\n";
}

}  // namespace samara::drivers
