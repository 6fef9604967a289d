#include "sweep.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/base/number.hpp"
#include "samara/model/turbine.hpp"
#include "samara/simulation/validation.hpp"

#include "command_line.hpp"

namespace samara::drivers {
namespace {

constexpr std::size_t most_values = 10000;
/// Digits of a value of a range, and the part of a step that counts as zero: multiples of the step
/// are free of round-off.
constexpr int range_digits = 12;
constexpr double range_slack = 1e-9;

constexpr char form[] =
    "expected KEY=FROM:TO:STEP or KEY=V1,V2,..., e.g. --sweep shaft.speed_rpm=0:14:0.5";

std::vector<double> numbers_of(const std::string& text, char between) {
  std::vector<double> numbers;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, between);) {
    const std::optional<double> number = parse_number(word);
    if (!number) throw InputError("--sweep: \"" + word + "\" is no number; " + form);
    numbers.push_back(*number);
  }
  if (text.ends_with(between)) throw InputError(std::string("--sweep: ") + form);
  return numbers;
}

std::vector<double> range_of(const std::vector<double>& limits) {
  if (limits.size() != 3) throw InputError(std::string("--sweep: ") + form);
  const double span = limits[1] - limits[0];
  const double step = limits[2];
  if (!(span / step >= 0.0) || !std::isfinite(span / step))
    throw InputError("--sweep: the step " + general(step, 6) + " does not lead from " +
                     general(limits[0], 6) + " to " + general(limits[1], 6) +
                     "; hint: a step of the other sign, not 0");
  const double last = std::floor(span / step * (1.0 + range_slack) + range_slack);
  if (last >= static_cast<double>(most_values))
    throw InputError("--sweep: " + general(last + 1.0, 6) + " values; hint: at most " +
                     std::to_string(most_values));
  std::vector<double> values;
  for (int i = 0; i <= static_cast<int>(last); ++i) {
    const double value = std::stod(general(limits[0] + i * step, range_digits));
    values.push_back(std::abs(value) < range_slack * std::abs(step) ? 0.0 : value);
  }
  return values;
}

/// A key and its values.
struct Axis {
  std::string key;
  std::vector<double> values;
};

Axis read_axis(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw InputError(std::string("--sweep: ") + form);
  const std::string values = text.substr(equals + 1);
  Axis axis{text.substr(0, equals), values.find(':') != std::string::npos
                                        ? range_of(numbers_of(values, ':'))
                                        : numbers_of(values, ',')};
  std::vector<double> sorted = axis.values;
  std::ranges::sort(sorted);
  const auto twice = std::ranges::adjacent_find(sorted);
  if (twice != sorted.end())
    throw InputError("--sweep: " + general(*twice, 6) + " is given twice; leave one of them out");
  return axis;
}

std::vector<simulation::SweepPlace> places_of(const std::vector<Axis>& axes) {
  std::vector<simulation::SweepPlace> places;
  std::vector<double> row = axes.front().values;
  if (axes.size() == 1) {
    for (const double value : row) places.push_back({value});
    return places;
  }
  for (const double second : axes.back().values) {
    for (const double value : row) places.push_back({value, second});
    std::ranges::reverse(row);
  }
  return places;
}

}  // namespace

Sweep::Sweep(const std::vector<std::string>& texts, std::string path,
             std::vector<std::string> settings)
    : path_(std::move(path)), settings_(std::move(settings)) {
  if (texts.size() > 2)
    throw InputError("--sweep is given " + std::to_string(texts.size()) +
                     " times; hint: one key, or two for a map");
  std::vector<Axis> axes;
  for (const std::string& text : texts) {
    axes.push_back(read_axis(text));
    keys_.push_back(axes.back().key);
  }
  if (keys_.size() == 2 && keys_.front() == keys_.back())
    throw InputError("--sweep: " + keys_.front() + " is given twice; hint: two keys for a map");
  std::size_t count = 1;
  for (const Axis& axis : axes) count *= axis.values.size();
  if (count > most_values)
    throw InputError("--sweep: " + std::to_string(count) + " points; hint: at most " +
                     std::to_string(most_values));
  places_ = places_of(axes);
  std::optional<int> freedom;
  for (const simulation::SweepPlace& place : places_) {
    const io::Case input = case_at(place);
    case_texts_.push_back(input.text);
    const int own = model::build_turbine(input.turbine).degrees_of_freedom;
    if (freedom.value_or(own) != own)
      throw InputError("--sweep " + join(keys_, ", ") +
                       ": modes of different meshes cannot be compared; hint: a key that keeps "
                       "the parts and the elements");
    freedom = own;
  }
}

io::Case Sweep::case_at(const simulation::SweepPlace& place) const {
  std::vector<std::string> own = settings_;
  own.push_back(keys_.front() + "=" + shortest(place.value));
  if (keys_.size() > 1) own.push_back(keys_.back() + "=" + shortest(place.second));
  io::Case input = io::read_case(path_, own);
  io::require_valid(input, simulation::validate(input, input.turbine.shaft.speed == 0.0
                                                           ? simulation::Analysis::modes
                                                           : simulation::Analysis::floquet));
  return input;
}

}  // namespace samara::drivers
