#include "import_inflow.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <vector>

#include "samara/base/error.hpp"
#include "samara/io/wind_files.hpp"

#include "import_common.hpp"

namespace samara::decks {
namespace {

using io::UniformWindRow;
using model::WindDefinition;

constexpr double whole_turn = 360.0;
constexpr int turbsim = 3;

/// An angle in degrees as it is between -180 and 180, without the round-off of sums.
double wrap(double angle) {
  constexpr double per_degree = 1e9;
  return std::round(std::remainder(angle, whole_turn) * per_degree) / per_degree;
}

class InflowImporter {
 public:
  InflowImporter(OpenfastImport& import, const InflowSource& source)
      : import_(import), source_(source) {}

  std::optional<WindDefinition> read() {
    deck_ = import_.open(source_.path);
    if (!deck_) return {};
    const int type = deck_->integer("WindType", 0, 10);
    const std::size_t errors_before = import_.errors.size();
    if (type == 1)
      read_steady();
    else if (type == 2)
      read_uniform();
    else if (type != turbsim || !read_turbsim())
      leave_out(type);
    has_wind_ &= import_.errors.size() == errors_before;
    if (has_wind_) finish();
    import_.report_unused(*deck_);
    return has_wind_ ? std::optional<WindDefinition>(wind_) : std::nullopt;
  }

 private:
  void leave_out(int type) {
    const std::string words = std::to_string(type) + ": a file of turbulence is not read" +
                              (type == turbsim ? ", because it is missing" : "") +
                              "; the case has no wind";
    import_.say(*deck_, "WindType", Fate::ignored, words);
    import_.warn(deck_->place_of("WindType"),
                 "WindType: note: " + words + "; hint: wind.speed of the case states a steady one");
  }

  void derive(const std::string& key, const std::string& words) {
    if (deck_->has(key)) import_.say(*deck_, key, Fate::derived, words);
  }

  /// The speed counts at a height above the foot of the tower.
  void set_height(const std::string& key) {
    wind_.height = deck_->number(key) - source_.foot;
    derive(key, source_.foot == 0.0 ? "wind.height" : "wind.height = " + key + " - TowerBsHt");
    import_.note("wind.height", source_.foot == 0.0 ? key : key + " - TowerBsHt");
    import_.require(wind_.height > 0.0, *deck_, key, "expected a height above the tower's foot");
  }

  void set_power(double exponent, const std::string& key) {
    if (exponent == 0.0) return;
    wind_.profile = WindDefinition::Profile::power;
    wind_.exponent = exponent;
    import_.note("wind.shear.power", key);
    if (source_.foot != 0.0)
      import_.warn(deck_->place_of("WindType"),
                   "WindType: note: heights of wind.shear.power count from the foot of the tower, "
                   "at " +
                       rounded(source_.foot) + " m, those of " + key + " from the ground");
  }

  void read_steady() {
    import_.say(*deck_, "WindType", Fate::derived, "1: steady wind");
    wind_.speed = import_.take(*deck_, "HWindSpeed", "wind.speed");
    import_.require(wind_.speed >= 0.0, *deck_, "HWindSpeed", "expected a number >= 0");
    deck_->choose("RefHt", 0);
    set_height("RefHt");
    set_power(deck_->number("PLExp"), "PLExp");
    derive("PLExp", wind_.exponent == 0.0 ? "0: no shear" : "wind.shear.power");
    has_wind_ = true;
  }

  void read_uniform() {
    // Older files have the same names for steady, uniform and turbulent wind.
    deck_->choose("Filename", 0);
    deck_->choose("RefHt", 1);
    const std::string key = deck_->has("FileName_Uni") ? "FileName_Uni" : "Filename";
    const std::string path = deck_->file(key);
    if (path.empty()) return;
    import_.say(*deck_, "WindType", Fate::derived, "2: uniform wind");
    try {
      use(io::read_uniform_wind(path), path, key);
    } catch (const InputError& error) {
      import_.errors.add_message(error.what());
    }
  }

  /// The mean wind of a file of TurbSim: speed in the middle of the box, and the power law that
  /// fits the means of its rows. @returns false where there is no such file
  bool read_turbsim() {
    const std::string key = deck_->has("FileName_BTS") ? "FileName_BTS" : "Filename";
    deck_->choose("Filename", 1);
    const std::string path = deck_->find_file(key);
    if (path.empty()) return false;
    try {
      use(io::read_turbsim_box(path), path, key);
    } catch (const InputError& fault) {
      import_.errors.add_message(fault.what());
    }
    return true;
  }

  void use(const model::WindBox& box, const std::string& path, const std::string& key) {
    std::vector<double> means;  // by row
    for (int row = 0; row < box.rows; ++row) {
      double sum = 0.0;
      for (int i = 0; i < box.times; ++i)
        for (int column = 0; column < box.columns; ++column)
          sum += box.values[static_cast<std::size_t>(
              3 * ((i * static_cast<std::ptrdiff_t>(box.rows) + row) * box.columns + column))];
      means.push_back(sum / (static_cast<double>(box.times) * box.columns));
    }
    const double middle = 0.5 * (box.rows - 1);
    const auto below = static_cast<std::size_t>(middle);
    const double speed = 0.5 * (means[below] + means[static_cast<std::size_t>(std::ceil(middle))]);
    const double height = box.bottom + middle * box.height;
    if (!(speed > 0.0 && height > 0.0))
      throw InputError(path + ": the mean wind in the middle of the box is not downwind");
    double products = 0.0;
    double squares = 0.0;
    for (std::size_t row = 0; row < means.size(); ++row) {
      const double place = box.bottom + static_cast<double>(row) * box.height;
      if (!(place > 0.0 && means[row] > 0.0)) continue;
      const double x = std::log(place / height);
      products += x * std::log(means[row] / speed);
      squares += x * x;
    }
    wind_.speed = speed;
    wind_.height = height - source_.foot;
    const std::string source = "the mean of the file in the middle of its box";
    import_.note("wind.speed", source);
    import_.note("wind.height", "the middle of the box");
    constexpr double least_exponent = 1e-3;
    const double exponent = squares > 0.0 ? products / squares : 0.0;
    if (std::abs(exponent) > least_exponent) set_power(exponent, "the means of the rows");
    import_.say(*deck_, "WindType", Fate::derived, "3: the mean wind of a file of TurbSim");
    import_.say(*deck_, key, Fate::derived, "wind: " + source);
    import_.warn(path,
                 "note: the case has the mean wind of the file, " + rounded(speed) +
                     " m/s; hint: transient.wind: {box: {file: ...}} of the case names this file");
    has_wind_ = true;
  }

  static UniformWindRow at_start(const std::vector<UniformWindRow>& rows) {
    const auto next = std::ranges::lower_bound(rows, 0.0, {}, &UniformWindRow::time);
    if (next == rows.begin()) return rows.front();
    if (next == rows.end()) return rows.back();
    const UniformWindRow& before = *(next - 1);
    const double part = -before.time / (next->time - before.time);
    UniformWindRow row;
    for (double UniformWindRow::*value :
         {&UniformWindRow::speed, &UniformWindRow::direction, &UniformWindRow::vertical,
          &UniformWindRow::shear_left, &UniformWindRow::exponent, &UniformWindRow::shear_up,
          &UniformWindRow::gust, &UniformWindRow::upflow})
      row.*value = before.*value + part * ((*next).*value - before.*value);
    return row;
  }

  static bool is_same_wind(UniformWindRow a, const UniformWindRow& b) {
    a.time = b.time;
    return a == b;
  }

  void use(const std::vector<UniformWindRow>& rows, const std::string& path,
           const std::string& key) {
    const bool is_steady = std::ranges::all_of(
        rows, [&](const UniformWindRow& row) { return is_same_wind(row, rows.front()); });
    const UniformWindRow row = at_start(rows);
    const std::string source = is_steady ? "the wind of the file" : "the wind of the file at 0 s";
    import_.say(*deck_, key, Fate::derived, "wind: " + source);
    if (!is_steady)
      import_.warn(path,
                   "note: the wind changes with time: the case has that of 0 s; hint: "
                   "transient.wind.table of the case names this file");
    const double ahead = row.speed + row.gust;
    wind_.speed = std::hypot(ahead, row.vertical);
    if (row.gust != 0.0 || row.vertical != 0.0)
      import_.warn(path,
                   "note: gust and vertical speed are part of wind.speed and wind.upflow_deg, with "
                   "the shear of the wind");
    if (ahead < 0.0) throw InputError(path + ": a speed below 0");
    rise_ = row.upflow + fields::deg.from_si(std::atan2(row.vertical, ahead));
    turned_ = row.direction;
    import_.note("wind.speed", source);
    const std::string height = deck_->has("RefHt_Uni") ? "RefHt_Uni" : "RefHt";
    set_height(height);
    set_power(row.exponent, "the file");
    wind_.shear_left = row.shear_left;
    wind_.shear_up = row.shear_up;
    if (wind_.shear_left != 0.0 || wind_.shear_up != 0.0) {
      wind_.shear_length = deck_->number("RefLength");
      import_.say(*deck_, "RefLength", Fate::taken, "wind.shear.length");
      import_.require(wind_.shear_length > 0.0, *deck_, "RefLength", "expected a number > 0");
    }
    has_wind_ = true;
  }

  /// Directions turn clockwise in OpenFAST. The nacelle of a case faces along the shaft at rest, so
  /// its yaw turns the wind instead.
  void finish() {
    const double propagation = deck_->number("PropagationDir");
    const double yaw = fields::deg.from_si(source_.yaw);
    const double angle = wrap(-propagation - turned_ - yaw);
    wind_.direction = fields::deg.to_si(angle);
    const std::string words = std::string("wind.direction_deg = -PropagationDir") +
                              (turned_ != 0.0 ? " - the file's" : "") +
                              (yaw != 0.0 ? " - NacYaw" : "");
    derive("PropagationDir", words);
    if (angle != 0.0) import_.note("wind.direction_deg", words.substr(words.find('=') + 2));
    const bool has_upflow = deck_->has("VFlowAng") || deck_->has("VelInterpCubic");
    if (has_upflow) rise_ += deck_->number("VFlowAng");
    wind_.upflow = fields::deg.to_si(rise_);
    derive("VFlowAng", "wind.upflow_deg");
    import_.require(std::abs(rise_) < 90.0, *deck_, "VFlowAng",
                    "expected an angle between -90 and 90 degrees");
    wind_.density = source_.density;
    import_.note("wind.density", source_.density_key);
  }

  OpenfastImport& import_;
  const InflowSource& source_;
  std::unique_ptr<Deck> deck_;
  WindDefinition wind_;
  double turned_ = 0.0;  ///< direction of a file, clockwise [deg]
  double rise_ = 0.0;    ///< upflow [deg]
  bool has_wind_ = false;
};

}  // namespace

std::optional<WindDefinition> read_inflow(OpenfastImport& import, const InflowSource& source) {
  return InflowImporter(import, source).read();
}

}  // namespace samara::decks
