#include "samara/io/campbell_file.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <locale>
#include <numbers>
#include <sstream>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/io/whole_file.hpp"

#include "axes.hpp"
#include "hdf5_file.hpp"
#include "hdf5_reader.hpp"

namespace samara::io {
namespace {

using analysis::TrackedMode;
using simulation::CampbellLine;
using simulation::CampbellMode;
using simulation::CampbellPoint;
using simulation::Stability;
using simulation::StabilityEdge;

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr double two_pi = 2.0 * std::numbers::pi;
constexpr std::size_t harmonics = 2 * simulation::campbell_harmonics + 1;

/// Names of the datasets of a point; its format is internal and has no attributes of a result.
constexpr char failure_name[] = "/point/failure";
constexpr char notes_name[] = "/point/notes";
constexpr char values_name[] = "/point/values";
constexpr char mode_values_name[] = "/point/mode_values";
constexpr char mode_names_name[] = "/point/mode_names";
constexpr char participation_name[] = "/point/participation";
constexpr char signals_name[] = "/point/signals";

constexpr std::size_t point_values = 7;
constexpr std::size_t mode_values = 8;

Meaning plain(const std::vector<std::string>& axes) { return {"1", "none", "internal", axes}; }

std::string lines_of(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += text + "\n";
  return all;
}

std::vector<std::string> texts_of(const std::string& lines) {
  std::vector<std::string> texts;
  std::istringstream stream(lines);
  for (std::string text; std::getline(stream, text);) texts.push_back(text);
  return texts;
}

/// The values of a mode on a line, for the copy that the line follows.
struct LineValues {
  std::complex<double> exponent{nothing, nothing};
  double fixed_frame_frequency = nothing;
  double damping_ratio = nothing;
  double error = nothing;
  double growth_error = nothing;
  double is_growing = nothing;
  double likeness = nothing;
  std::array<double, harmonics> participation{};
};

LineValues values_of(const CampbellPoint& point, const TrackedMode& tracked) {
  const CampbellMode& mode = point.modes[tracked.mode];
  LineValues values;
  values.exponent = tracked_exponent(mode.exponent, tracked, point.rotor_speed);
  values.fixed_frame_frequency = mode.fixed_frame_frequency;
  values.damping_ratio = tracked_damping(mode.exponent, tracked, point.rotor_speed);
  const double size = std::abs(values.exponent);
  values.error = size > 0.0 ? mode.error * std::abs(mode.exponent) / size : mode.error;
  values.growth_error = mode.growth_error;
  values.is_growing = simulation::is_growing(mode) ? 1.0 : 0.0;
  values.likeness = tracked.likeness;
  // Harmonic k of a line is at |Im| + k Omega of its copy, harmonic k of a mode at its exponent.
  const int direction = values.exponent.imag() < 0.0 ? -1 : 1;
  for (int k = -simulation::campbell_harmonics; k <= simulation::campbell_harmonics; ++k) {
    const int of_copy = direction * k + tracked.shift;
    const int own = tracked.is_conjugate ? -of_copy : of_copy;
    const int column = own + simulation::campbell_harmonics;
    if (column >= 0 && column < static_cast<int>(harmonics))
      values.participation[static_cast<std::size_t>(k + simulation::campbell_harmonics)] =
          mode.participation[static_cast<std::size_t>(column)];
  }
  return values;
}

void write_edges(ResultFile& file, const std::vector<SweptQuantity>& quantities,
                 const std::vector<StabilityEdge>& edges) {
  if (edges.empty()) return;
  const SweptQuantity& quantity = quantities.front();
  std::vector<double> places;
  std::vector<double> seconds;
  std::vector<double> growing;
  for (const StabilityEdge& edge : edges) {
    places.insert(places.end(), {edge.from, edge.to});
    seconds.push_back(edge.second);
    growing.insert(growing.end(),
                   {static_cast<double>(edge.growing_from), static_cast<double>(edge.growing_to)});
  }
  file.write_texts("/campbell/side", {"from", "to"},
                   {"", "none", "sides of an edge, in the order of the sweep", {"side"}});
  file.write_array(
      "/campbell/edge_value", places, {edges.size(), 2},
      {quantity.unit,
       "none",
       "values of " + quantity.key + " between which the number of growing modes changes",
       {"edge", "side"}});
  if (quantities.size() > 1)
    file.write_values(
        "/campbell/edge_second_value", seconds,
        {quantities.back().unit, "none", "value of " + quantities.back().key + " there", {"edge"}});
  file.write_array("/campbell/edge_growing", growing, {edges.size(), 2},
                   {"1", "none", "number of growing modes there", {"edge", "side"}});
}

}  // namespace

void CampbellPointFiles::write(std::size_t point, const CampbellPoint& content) const {
  Hdf5File file;
  file.write(failure_name, content.failure + "\n", plain({}));
  file.write(notes_name, lines_of(content.notes) + "\n", plain({}));
  const std::array<double, point_values> values{content.place.value,
                                                content.place.second,
                                                content.rotor_speed,
                                                content.wind_speed,
                                                content.pitch,
                                                static_cast<double>(content.stability),
                                                static_cast<double>(content.sectors)};
  file.write(values_name, values, {values.size()}, plain({"entry"}));
  const std::size_t count = content.modes.size();
  if (count > 0) {
    std::vector<double> numbers;
    std::vector<double> shares;
    std::vector<std::string> names;
    for (const CampbellMode& mode : content.modes) {
      numbers.insert(numbers.end(),
                     {mode.exponent.real(), mode.exponent.imag(), mode.fixed_frame_frequency,
                      mode.error, mode.growth_error, static_cast<double>(mode.motion),
                      mode.is_rough ? 1.0 : 0.0, static_cast<double>(mode.number)});
      shares.insert(shares.end(), mode.participation.begin(), mode.participation.end());
      names.push_back(mode.name);
    }
    file.write(mode_values_name, numbers, {count, mode_values},
               plain({mode_axis, "entry_of_mode"}));
    file.write(mode_names_name, lines_of(names), plain({}));
    file.write(participation_name, shares, {count, harmonics}, plain({mode_axis, "harmonic"}));
    const Eigen::MatrixXcf& first = content.signatures.shapes.front();
    const auto width = static_cast<std::size_t>(2 * first.size());
    const Hdf5Id dataset =
        file.make_slices(signals_name, {count, width}, plain({mode_axis, "entry_of_shape"}));
    for (std::size_t m = 0; m < count; ++m)
      file.write_slice(
          dataset, m, {reinterpret_cast<const float*>(content.signatures.shapes[m].data()), width});
    file.set_attribute("/point", "signals", static_cast<int>(first.rows()));
  }
  save(point, file);
}

std::optional<CampbellPoint> CampbellPointFiles::read(std::size_t point) const {
  const std::unique_ptr<Hdf5Reader> opened = open(point);
  if (!opened) return std::nullopt;
  const Hdf5Reader& file = *opened;
  CampbellPoint content;
  const std::vector<double> values = file.numbers(values_name);
  if (values.size() != point_values) refuse(point);
  content.place = {values[0], values[1]};
  content.rotor_speed = values[2];
  content.wind_speed = values[3];
  content.pitch = values[4];
  content.stability = static_cast<Stability>(static_cast<int>(values[5]));
  content.sectors = static_cast<int>(values[6]);
  content.failure = file.text(failure_name);
  while (content.failure.ends_with('\n')) content.failure.pop_back();
  for (const std::string& note : texts_of(file.text(notes_name)))
    if (!note.empty()) content.notes.push_back(note);
  if (!file.has(mode_values_name)) return content;
  hsize_t count = 0;
  hsize_t width = 0;
  const std::vector<double> numbers = file.table(mode_values_name, count, width);
  const std::vector<std::string> names = texts_of(file.text(mode_names_name));
  hsize_t rows = 0;
  hsize_t columns = 0;
  const std::vector<double> shares = file.table(participation_name, rows, columns);
  const std::vector<hsize_t> shape = file.shape(signals_name);
  const std::size_t signals = file.count_attribute("/point", "signals");
  if (width != mode_values || names.size() != count || rows != count || columns != harmonics ||
      shape.size() != 2 || shape[0] != count || signals == 0 || shape[1] % (2 * signals) != 0)
    refuse(point);
  content.signatures.rotor_speed = content.rotor_speed;
  for (std::size_t m = 0; m < count; ++m) {
    const double* own = &numbers[m * mode_values];
    CampbellMode mode;
    mode.exponent = {own[0], own[1]};
    mode.fixed_frame_frequency = own[2];
    mode.error = own[3];
    mode.growth_error = own[4];
    mode.motion = static_cast<simulation::Motion>(static_cast<int>(own[5]));
    mode.is_rough = own[6] != 0.0;
    mode.number = static_cast<int>(own[7]);
    mode.name = names[m];
    mode.participation.assign(shares.begin() + static_cast<long>(m * harmonics),
                              shares.begin() + static_cast<long>((m + 1) * harmonics));
    content.signatures.modes.push_back(m);
    content.signatures.exponents.push_back(mode.exponent);
    content.modes.push_back(std::move(mode));
    const std::vector<double> entries = file.slice(signals_name, m, 1, shape[1]);
    Eigen::MatrixXcf own_shape(static_cast<Eigen::Index>(signals),
                               static_cast<Eigen::Index>(shape[1] / (2 * signals)));
    for (Eigen::Index i = 0; i < own_shape.size(); ++i) {
      const auto at = static_cast<std::size_t>(2 * i);
      own_shape.data()[i] = {static_cast<float>(entries[at]), static_cast<float>(entries[at + 1])};
    }
    content.signatures.shapes.push_back(std::move(own_shape));
  }
  return content;
}

void write_campbell(ResultFile& file, const std::vector<SweptQuantity>& quantities,
                    const std::vector<CampbellPoint>& points,
                    const std::vector<CampbellLine>& lines, const std::vector<StabilityEdge>& edges,
                    bool is_complete) {
  const auto of_points = [&](const std::string& name, const Meaning& meaning, const auto& value) {
    std::vector<double> values;
    for (const CampbellPoint& point : points) values.push_back(value(point));
    file.write_values("/campbell/" + name, values, meaning);
  };
  const SweptQuantity& quantity = quantities.front();
  const bool is_map = quantities.size() > 1;
  // The axis of the points: their values, or their numbers in a map.
  const std::string axis = is_map ? "point" : "value";
  of_points("value", {quantity.unit, "none", "value of " + quantity.key, {axis}},
            [](const CampbellPoint& point) { return point.place.value; });
  if (is_map) {
    const SweptQuantity& second = quantities.back();
    of_points("second_value", {second.unit, "none", "value of " + second.key, {axis}},
              [](const CampbellPoint& point) { return point.place.second; });
    file.set_attribute("/campbell", "second_key", second.key);
  }
  of_points("rotor_speed", {"rad/s", "about +s2", "mean speed of the rotor", {axis}},
            [](const CampbellPoint& point) { return point.rotor_speed; });
  of_points("wind_speed", {"m/s", "none", "speed of the wind; not-a-number without air", {axis}},
            [](const CampbellPoint& point) { return point.wind_speed; });
  of_points("pitch", {"rad", "none", "pitch of the blades, toward feather", {axis}},
            [](const CampbellPoint& point) { return point.pitch; });
  std::vector<std::string> verdicts;
  for (const CampbellPoint& point : points)
    verdicts.push_back(point.failure.empty() ? word_of(point.stability)
                                             : "failed: " + point.failure);
  file.write_texts("/campbell/stability", verdicts,
                   {"",
                    "none",
                    "stable, neutral, unstable or no verdict; failed: and the reason where no "
                    "modes were found",
                    {axis}});
  file.set_attribute("/campbell", "key", quantity.key);
  file.set_attribute("/campbell", "status", is_complete ? "complete" : "interrupted");
  write_edges(file, quantities, edges);
  std::vector<std::string> names;
  for (const CampbellLine& line : lines) names.push_back(line.name);
  if (names.empty()) return;
  file.write_texts("/campbell/mode", names, {"", "none", "names of the modes", {"mode"}});
  std::vector<std::vector<LineValues>> values(lines.size(), std::vector<LineValues>(points.size()));
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (const TrackedMode& tracked : lines[i].modes)
      values[i][tracked.point] = values_of(points[tracked.point], tracked);
  const auto of_lines = [&](const std::string& name, const std::string& unit,
                            const std::string& description, const auto& value) {
    std::vector<double> all;
    for (const std::vector<LineValues>& line : values)
      for (const LineValues& entry : line) all.push_back(value(entry));
    file.write_array("/campbell/" + name, all, {lines.size(), points.size()},
                     {unit,
                      "none",
                      description + "; not-a-number where the mode was not found",
                      {"mode", axis}});
  };
  of_lines("growth_rate", "1/s", "real part of the exponent",
           [](const LineValues& entry) { return entry.exponent.real(); });
  of_lines("frequency_hz", "Hz",
           "frequency in the frame of each part, of one and the same copy of the mode",
           [](const LineValues& entry) { return std::abs(entry.exponent.imag()) / two_pi; });
  of_lines("fixed_frame_frequency_hz", "Hz",
           "frequency in the fixed frame; not-a-number also if it is not a single one",
           [](const LineValues& entry) { return entry.fixed_frame_frequency / two_pi; });
  of_lines("damping_ratio", "1", "- re / abs of the exponent of that copy",
           [](const LineValues& entry) { return entry.damping_ratio; });
  of_lines("error", "1", "estimated error of the exponent, relative to its modulus",
           [](const LineValues& entry) { return entry.error; });
  of_lines("error_growth", "1/s", "estimated error of the growth rate",
           [](const LineValues& entry) { return entry.growth_error; });
  of_lines("is_growing", "1", "1: grows by more than its error",
           [](const LineValues& entry) { return entry.is_growing; });
  of_lines("likeness", "1",
           "likeness to the mode at the point before: 1 for the same shape, unclear below 0.6",
           [](const LineValues& entry) { return entry.likeness; });
  std::vector<double> numbers;
  for (int k = -simulation::campbell_harmonics; k <= simulation::campbell_harmonics; ++k)
    numbers.push_back(k);
  file.write_values(
      "/campbell/harmonic", numbers,
      {"1", "none", "harmonics of the rotor speed, counted from frequency_hz", {"harmonic"}});
  std::vector<double> shares;
  for (const std::vector<LineValues>& line : values)
    for (const LineValues& entry : line)
      shares.insert(shares.end(), entry.participation.begin(), entry.participation.end());
  file.write_array("/campbell/participation", shares, {lines.size(), points.size(), harmonics},
                   {"1",
                    "none",
                    "share of the mean kinetic energy in each harmonic",
                    {"mode", axis, "harmonic"}});
}

void write_campbell_table(const std::string& path, const std::vector<CampbellPoint>& points,
                          const std::vector<CampbellLine>& lines) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(std::numeric_limits<double>::max_digits10);
  const bool is_map = !points.empty() && std::isfinite(points.front().place.second);
  text << campbell_table_start
       << "rotor_speed,frequency_hz,fixed_frame_frequency_hz,damping_ratio,growth_rate,error,"
          "error_growth,likeness"
       << (is_map ? ",second_value" : "") << '\n';
  for (const CampbellLine& line : lines)
    for (const TrackedMode& tracked : line.modes) {
      const CampbellPoint& point = points[tracked.point];
      const LineValues values = values_of(point, tracked);
      text << point.place.value << ',' << line.name << ',' << point.rotor_speed << ','
           << std::abs(values.exponent.imag()) / two_pi << ','
           << values.fixed_frame_frequency / two_pi << ',' << values.damping_ratio << ','
           << values.exponent.real() << ',' << values.error << ',' << values.growth_error << ','
           << values.likeness;
      if (is_map) text << ',' << point.place.second;
      text << '\n';
    }
  write_whole_file(path, text.str());
}

}  // namespace samara::io
