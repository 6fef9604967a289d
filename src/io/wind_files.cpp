#include "samara/io/wind_files.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <sstream>
#include <system_error>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/base/number.hpp"
#include "samara/base/words.hpp"
#include "samara/io/whole_file.hpp"

namespace samara::io {
namespace {

constexpr std::size_t max_table_megabytes = 64;
constexpr std::size_t max_box_megabytes = 2048;
constexpr int most_points = 10000;  ///< of a box, across or up
constexpr double most_values = 5e8;

static_assert(std::endian::native == std::endian::little);

/// Numbers of a binary file, one after the other.
class BinaryFile {
 public:
  BinaryFile(std::string path, std::size_t megabytes)
      : path_(std::move(path)), bytes_(read_whole_file(path_, megabytes, "wind file")) {}

  template <class Number>
  Number next() {
    require(sizeof(Number));
    Number value{};
    std::memcpy(&value, bytes_.data() + at_, sizeof(Number));
    at_ += sizeof(Number);
    return value;
  }
  void skip(std::size_t size) {
    require(size);
    at_ += size;
  }
  std::size_t left() const { return bytes_.size() - at_; }
  [[noreturn]] void fail(const std::string& words) const { throw InputError(path_ + ": " + words); }

 private:
  void require(std::size_t size) const {
    if (left() < size)
      fail("the file ends too early, after " + std::to_string(bytes_.size()) +
           " bytes; hint: it was not written completely");
  }

  std::string path_;
  std::string bytes_;
  std::size_t at_ = 0;
};

bool is_length(double value) { return std::isfinite(value) && value > 0.0; }

void require_shape(const model::WindBox& box, const std::string& path) {
  const auto fail = [&](const std::string& words) { throw InputError(path + ": " + words); };
  if (box.times < 2 || box.rows < 2 || box.columns < 2 || box.rows > most_points ||
      box.columns > most_points)
    fail("a box of " + std::to_string(box.times) + " instants, " + std::to_string(box.rows) +
         " rows and " + std::to_string(box.columns) +
         " columns; expected at least two of each, and at most " + std::to_string(most_points) +
         " rows and columns");
  if (3.0 * box.times * box.rows * box.columns > most_values)
    fail("the box has more than " + general(most_values, 3) + " numbers");
  if (!is_length(box.step) || !is_length(box.width) || !is_length(box.height) ||
      !is_length(box.speed) || !std::isfinite(box.bottom))
    fail("distances, time step and speed of the box must be finite and > 0");
}

std::size_t value_count(const model::WindBox& box) {
  return 3 * static_cast<std::size_t>(box.times) * static_cast<std::size_t>(box.rows) *
         static_cast<std::size_t>(box.columns);
}

}  // namespace

model::WindBox read_turbsim_box(const std::string& path) {
  constexpr std::int16_t once = 7;
  constexpr std::int16_t periodic = 8;
  BinaryFile file(path, max_box_megabytes);
  const auto id = file.next<std::int16_t>();
  if (id != once && id != periodic)
    file.fail("is no file of TurbSim: it begins with " + std::to_string(id) +
              ", expected 7 or 8 (periodic)");
  model::WindBox box;
  box.rows = file.next<std::int32_t>();
  box.columns = file.next<std::int32_t>();
  const auto tower_points = file.next<std::int32_t>();
  box.times = file.next<std::int32_t>();
  box.height = file.next<float>();
  box.width = file.next<float>();
  box.step = file.next<float>();
  box.speed = file.next<float>();
  file.next<float>();  // height of the hub
  box.bottom = file.next<float>();
  box.is_periodic = id == periodic;
  require_shape(box, path);
  if (tower_points < 0 || tower_points > most_points)
    file.fail(std::to_string(tower_points) + " points of the tower");
  box.front = box.is_periodic ? 0.0 : 0.5 * (box.columns - 1) * box.width;
  std::array<float, 3> slope{};
  std::array<float, 3> offset{};
  for (std::size_t c = 0; c < 3; ++c) {
    slope[c] = file.next<float>();
    offset[c] = file.next<float>();
    if (!std::isfinite(slope[c]) || slope[c] == 0.0F || !std::isfinite(offset[c]))
      file.fail("a scale of the velocities is zero or not finite");
  }
  const auto text = file.next<std::int32_t>();
  if (text < 0) file.fail("the length of its text is negative");
  file.skip(static_cast<std::size_t>(text));
  const std::size_t plane =
      3 * static_cast<std::size_t>(box.rows) * static_cast<std::size_t>(box.columns);
  const std::size_t tower = 3 * sizeof(std::int16_t) * static_cast<std::size_t>(tower_points);
  const std::size_t expected =
      static_cast<std::size_t>(box.times) * (plane * sizeof(std::int16_t) + tower);
  if (file.left() != expected)
    file.fail("has " + std::to_string(file.left()) + " bytes of velocities, expected " +
              std::to_string(expected) + "; hint: it was not written completely");
  box.values.reserve(value_count(box));
  for (int i = 0; i < box.times; ++i) {
    for (std::size_t n = 0; n < plane; ++n)
      box.values.push_back((static_cast<float>(file.next<std::int16_t>()) - offset[n % 3]) /
                           slope[n % 3]);
    file.skip(tower);
  }
  return box;
}

model::WindBox read_hawc_box(const std::array<std::string, 3>& paths, const model::WindBox& shape,
                             const std::array<double, 3>& scale) {
  model::WindBox box = shape;
  box.is_periodic = true;
  box.is_fluctuation = true;
  require_shape(box, paths[0]);
  box.values.resize(value_count(box));
  const auto rows = static_cast<std::size_t>(box.rows);
  const auto columns = static_cast<std::size_t>(box.columns);
  for (std::size_t c = 0; c < 3; ++c) {
    BinaryFile file(paths[c], max_box_megabytes);
    const std::size_t expected = value_count(box) / 3 * sizeof(float);
    if (file.left() != expected)
      file.fail("has " + std::to_string(file.left()) + " bytes, a box of " +
                std::to_string(box.times) + " x " + std::to_string(box.columns) + " x " +
                std::to_string(box.rows) + " points has " + std::to_string(expected));
    for (std::size_t i = 0; i < static_cast<std::size_t>(box.times); ++i)
      for (std::size_t k = 0; k < columns; ++k)   // from left to right
        for (std::size_t j = 0; j < rows; ++j) {  // up
          const auto value = file.next<float>();
          if (!std::isfinite(value)) file.fail("a velocity is not finite");
          box.values[((i * rows + j) * columns + (columns - 1 - k)) * 3 + c] =
              value * static_cast<float>(scale[c]);
        }
  }
  return box;
}

std::vector<UniformWindRow> read_uniform_wind(const std::string& path) {
  constexpr std::size_t least_columns = 8;
  const std::string text = read_whole_file(path, max_table_megabytes, "wind file");
  std::vector<UniformWindRow> rows;
  int number = 0;
  for (const std::string_view whole : split_lines(text)) {
    std::string line(whole.substr(0, whole.find('!')));
    std::ranges::replace(line, ',', ' ');
    const std::string place = path + ":" + std::to_string(++number);
    std::istringstream words(line);
    std::vector<double> values;
    for (std::string word; words >> word;) {
      const std::optional<double> value = parse_number(word);
      if (!value && values.size() >= least_columns) break;  // a remark
      if (!value)
        throw InputError(place + ": expected a number, got \"" + word +
                         "\"; hint: lines of text start with !");
      values.push_back(*value);
    }
    if (values.empty()) continue;
    if (values.size() < least_columns)
      throw InputError(place +
                       ": expected 8 or 9 columns (time, speed, direction, vertical "
                       "speed, horizontal shear, power law, linear shear, gust), got " +
                       std::to_string(values.size()));
    values.resize(least_columns + 1);
    if (!rows.empty() && !(values[0] > rows.back().time))
      throw InputError(place + ": the times do not rise");
    rows.push_back({values[0], values[1], values[2], values[3], values[4], values[5], values[6],
                    values[7], values[8]});
  }
  if (rows.empty()) throw InputError(path + ": has no line of numbers");
  return rows;
}

void read_wind_files(model::WindChange& change, const std::filesystem::path& folder,
                     const model::WindDefinition& mean) {
  constexpr double degree = std::numbers::pi / 180.0;
  const auto path_of = [&](const std::string& name) {
    const std::filesystem::path path = folder / name;
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored))
      throw InputError(path.string() +
                       ": no such file; hint: a relative path counts from the folder of the case");
    return path.string();
  };
  if (!change.table_path.empty()) {
    const std::vector<UniformWindRow> rows = read_uniform_wind(path_of(change.table_path));
    const auto take = [&rows](std::optional<math::TimeCurve>& curve, auto value) {
      if (curve) return;
      std::vector<math::TimeCurve::Point> points;
      for (const UniformWindRow& row : rows) points.emplace_back(row.time, value(row));
      if (points.size() == 1) points.emplace_back(points[0].first + 1.0, points[0].second);
      curve = math::TimeCurve::along(points);
    };
    // The vertical speed raises the whole wind.
    const auto rise = [](const UniformWindRow& row) {
      return std::atan2(row.vertical, row.speed + row.gust);
    };
    take(change.speed, [&](const auto& row) { return row.speed / std::cos(rise(row)); });
    take(change.gust, [&](const auto& row) { return row.gust / std::cos(rise(row)); });
    take(change.direction, [](const auto& row) { return -row.direction * degree; });
    take(change.upflow, [&](const auto& row) { return row.upflow * degree + rise(row); });
    const auto is_zero = [&rows](double UniformWindRow::*value) {
      return std::ranges::all_of(rows, [&](const auto& row) { return row.*value == 0.0; });
    };
    if (mean.profile == model::WindDefinition::Profile::power ||
        !is_zero(&UniformWindRow::exponent))
      take(change.exponent, [](const auto& row) { return row.exponent; });
    if (mean.shear_length > 0.0 || !is_zero(&UniformWindRow::shear_left))
      take(change.shear_left, [](const auto& row) { return row.shear_left; });
    if (mean.shear_length > 0.0 || !is_zero(&UniformWindRow::shear_up))
      take(change.shear_up, [](const auto& row) { return row.shear_up; });
  }
  if (change.box_path.empty()) return;
  if (change.box_path.size() == 1) {
    change.box =
        std::make_shared<const model::WindBox>(read_turbsim_box(path_of(change.box_path[0])));
    return;
  }
  model::WindBox shape = change.box_shape;
  shape.speed = mean.speed;
  shape.step = mean.speed > 0.0 ? change.box_shape.step / mean.speed : 0.0;
  change.box = std::make_shared<const model::WindBox>(read_hawc_box(
      {path_of(change.box_path[0]), path_of(change.box_path[1]), path_of(change.box_path[2])},
      shape, change.box_scale));
}

}  // namespace samara::io
