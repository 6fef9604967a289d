#include "samara/simulation/operation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/simulation/start_predictor.hpp"
#include "samara/simulation/steady_state.hpp"
#include "samara/turbine/turbine_channels.hpp"

namespace samara::simulation {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double rpm = std::numbers::pi / 30.0;
constexpr double kilo = 1e3;

/// Relative error of the generator's torque at a point.
constexpr double torque_accuracy = 1e-5;
/// Tolerance of the steady states of a search, except the last ones.
constexpr double rough_tolerance = 1e-6;
/// Expected relative error of the torque below which steady states of a search are not rough.
constexpr double nearly_found = 1e-3;
/// Largest pitch, from the pitch of the case.
constexpr double pitch_range = 80.0 * degree;
/// Least speed where none is given, relative to the rated one.
constexpr double least_share = 0.05;

/// Means over a revolution by channels, each with its factor to SI.
struct Mean {
  const char* channel;
  double factor;
  double OperatingPoint::*value;
};

const std::vector<Mean>& means_of_rotor() {
  static const std::vector<Mean> means{{"RotTorq", kilo, &OperatingPoint::torque},
                                       {"RtAeroPwr", 1.0, &OperatingPoint::power},
                                       {"RtAeroFxh", 1.0, &OperatingPoint::thrust},
                                       {"TipDxc1", 1.0, &OperatingPoint::tip_out_of_plane},
                                       {"TipDyc1", 1.0, &OperatingPoint::tip_in_plane},
                                       {"TipRDzc1", -degree, &OperatingPoint::tip_twist},
                                       {"RootMyc1", kilo, &OperatingPoint::root_flap_moment}};
  return means;
}

void add_means(const turbine::TurbineSystem& system, const analysis::Trim& trim,
               OperatingPoint& point) {
  std::vector<Mean> means = means_of_rotor();
  if (system.turbine().has_tower)
    means.push_back({"TwrBsMyt", kilo, &OperatingPoint::tower_moment});
  std::vector<std::string> names;
  for (const Mean& mean : means) names.emplace_back(mean.channel);
  const std::vector<double> values = mean_channels(system, trim, names);
  for (std::size_t j = 0; j < means.size(); ++j)
    point.*means[j].value = values[j] * means[j].factor;
}

/// End of a search for the zero of a falling function.
enum class Found { zero, above_range, below_range };

struct Root {
  Found found = Found::zero;
  double x = 0.0;
  double slope = 0.0;  ///< at the zero; 0: not known
};

/// Range, start and width of a search.
struct SearchRange {
  double lowest, highest, start, step;
  double slope = 0.0;  ///< estimate; 0: none
};

/// Zero of a function that falls, by secants within the known signs. f(x, is_rough) is relative to
/// its scale; at the result it was not rough. above_range: f > 0 at the highest x.
template <class Function>
Root find_zero(const SearchRange& range, const Function& f) {
  constexpr int most_steps = 40;
  std::optional<double> positive, negative;  // x with f > 0, f < 0
  double x = std::clamp(range.start, range.lowest, range.highest);
  double slope = range.slope;
  double expected = 1.0;
  std::optional<std::pair<double, double>> last;
  for (int step = 0; step < most_steps; ++step) {
    const bool is_rough = expected > nearly_found;
    double value = f(x, is_rough);
    const bool is_end = std::abs(value) <= torque_accuracy || (value > 0.0 && x >= range.highest) ||
                        (value < 0.0 && x <= range.lowest);
    if (is_end && is_rough) value = f(x, false);
    if (last && last->first != x) slope = (value - last->second) / (x - last->first);
    if (std::abs(value) <= torque_accuracy) return {Found::zero, x, slope};
    if (value > 0.0 && x >= range.highest) return {Found::above_range, range.highest, slope};
    if (value < 0.0 && x <= range.lowest) return {Found::below_range, range.lowest, slope};
    (value > 0.0 ? positive : negative) = x;
    // A rough value next to zero may have had the wrong sign.
    if (positive && negative && *positive >= *negative) (value > 0.0 ? negative : positive).reset();
    last = {x, value};
    const double most = 4.0 * range.step;
    double change = slope < 0.0 ? -value / slope : std::copysign(range.step, value);
    if (!(positive && negative)) change = std::clamp(change, -most, most);
    double next = std::clamp(x + change, range.lowest, range.highest);
    // A secant divides the error by the change of the slope on the way.
    expected = std::abs(value) * (slope < 0.0 ? 0.1 : 1.0);
    const double left = positive.value_or(range.lowest);
    const double right = negative.value_or(range.highest);
    if (positive && negative && !(next > left && next < right)) next = 0.5 * (left + right);
    if (next == x) break;
    x = next;
  }
  throw ConvergenceError("no torque that balances the wind was found within 40 steady states");
}

}  // namespace

class OperatingPointFinder::Search {
 public:
  Search(const Scenario& scenario, const std::vector<ScheduledPoint>& table)
      : scenario_(scenario), setup_(scenario.operation), table_(table) {
    // The torque is the result.
    scenario_.turbine.shaft.generator.law = {};
    scenario_.turbine.controller.reset();
  }

  OperatingPoint find_at(double wind, analysis::Observer& observer, MPI_Comm comm) {
    comm_ = comm;
    const std::string place = "operation at " + general(wind, 6) + " m/s: ";
    try {
      if (table_.empty()) note_law(observer);
      OperatingPoint point = table_.empty() ? search(wind) : follow_table(wind);
      note_doubts(*system_, *last_, observer, place + "trim");
      memory_.point = point;
      memory_.starts.finish_point();
      return point;
    } catch (const InputError& error) {
      throw InputError(place + error.what());
    } catch (const ConvergenceError& error) {
      throw ConvergenceError(place + error.what());
    } catch (const DomainError& error) {
      throw DomainError(place + error.what());
    }
  }

  const turbine::TurbineSystem& system() const { return *system_; }
  const analysis::Trim& trim() const { return *last_; }

  const OperationMemory& memory() const { return memory_; }
  void recall(const OperationMemory& memory) {
    memory_ = memory;
    present_ = memory.point;
    present_is_rough_ = false;
  }

 private:
  /// The steady state at a speed and a pitch.
  const OperatingPoint& evaluate(double wind, double speed, double pitch, bool is_rough = false) {
    if (present_ && present_->wind == wind && present_->speed == speed &&
        present_->pitch == pitch && (is_rough || !present_is_rough_))
      return *present_;
    Scenario scenario = scenario_;
    model::TurbineDefinition& turbine = scenario.turbine;
    turbine.wind->speed = wind;
    turbine.shaft.speed = speed;
    turbine.blades.pitch = pitch;
    auto built =
        std::make_unique<turbine::TurbineSystem>(model::build_turbine(turbine), PETSC_COMM_SELF);
    const turbine::TurbineSystem& system = *built;
    analysis::Observer silent;
    analysis::TrimOptions options = trim_options(scenario);
    options.is_draft = is_rough;
    if (is_rough) options.tolerance = std::max(options.tolerance, rough_tolerance);
    std::optional<analysis::Trim> near;
    if (auto start = memory_.starts.predict(wind, speed, pitch))
      near = analysis::Trim{.solution =
                                analysis::PeriodicSolution(std::move(*start), system.period())};
    last_ = solve_trim(scenario, system, options, silent, comm_, near ? &*near : nullptr);
    memory_.starts.add({wind, speed, pitch, last_->solution.coefficients()});
    system_ = std::move(built);
    if (!is_rough) require_wake_range(system, *last_);
    OperatingPoint point;
    point.wind = wind;
    point.speed = speed;
    point.pitch = pitch;
    add_means(system, *last_, point);
    point.torque /= std::abs(turbine.shaft.gear_ratio);
    const elements::AirRotor& rotor = system.turbine().air->rotor;
    const double pressure =
        0.5 * rotor.density * wind * wind * std::numbers::pi * rotor.tip_radius * rotor.tip_radius;
    point.power_coefficient = point.power / (pressure * wind);
    point.thrust_coefficient = point.thrust / pressure;
    point.tip_speed_ratio = speed * rotor.tip_radius / wind;
    point.time_constant = rotor.tau1;
    point.imbalance = last_->imbalance();
    memory_.tip_radius = rotor.tip_radius;
    memory_.density = rotor.density;
    present_ = point;
    present_is_rough_ = is_rough;
    return *present_;
  }

  OperatingPoint take(OperatingRegion region) const {
    OperatingPoint point = *present_;
    point.region = region;
    return point;
  }

  OperatingPoint follow_table(double wind) {
    if (wind < table_.front().wind || wind > table_.back().wind)
      throw InputError("operation.table has wind speeds from " + general(table_.front().wind, 6) +
                       " to " + general(table_.back().wind, 6) + " m/s only");
    const auto after = std::find_if(table_.begin(), table_.end(),
                                    [wind](const ScheduledPoint& row) { return row.wind >= wind; });
    const auto before = after == table_.begin() ? after : after - 1;
    const double span = after->wind - before->wind;
    const double share = span > 0.0 ? (wind - before->wind) / span : 0.0;
    const auto mix = [share](double a, double b) { return a + share * (b - a); };
    evaluate(wind, mix(before->speed, after->speed), mix(before->pitch, after->pitch));
    return take(OperatingRegion::given);
  }

  double gear() const { return std::abs(scenario_.turbine.shaft.gear_ratio); }
  double fine_pitch() const { return scenario_.turbine.blades.pitch; }
  double least_speed() const {
    return setup_.least_speed > 0.0 ? setup_.least_speed : least_share * setup_.rated_speed;
  }
  /// Of the generator.
  double rated_torque() const { return setup_.rated_power / (setup_.rated_speed * gear()); }

  double law_at(double speed) const {
    const double own = speed * gear();
    if (setup_.torque_table.empty()) return setup_.torque_gain * own * own;
    const auto& table = setup_.torque_table;
    const auto after = std::find_if(table.begin(), table.end(),
                                    [own](const auto& row) { return row.first >= own; });
    if (after == table.begin()) return table.front().second;
    if (after == table.end()) return table.back().second;
    const auto& [x0, y0] = *(after - 1);
    const auto& [x1, y1] = *after;
    return y0 + (y1 - y0) * (own - x0) / (x1 - x0);
  }

  /// Whether the law has a larger torque than the rated one at the rated speed.
  bool is_law_above_rated() const {
    return law_at(setup_.rated_speed) > rated_torque() * (1.0 + torque_accuracy);
  }

  void note_law(analysis::Observer& observer) {
    if (std::exchange(is_law_noted_, true) || !is_law_above_rated()) return;
    observer.note("operation: the law of the generator has " +
                  general(law_at(setup_.rated_speed), 4) +
                  " N m at the rated speed, more than rated_power / rated speed, " +
                  general(rated_torque(), 4) +
                  " N m: where it balances the wind at the least pitch, the power may be above the "
                  "rated one; hint: operation.torque_gain is per generator speed squared");
  }

  OperatingPoint search(double wind) {
    const bool is_above = is_above_rated(wind);
    // Above the rated wind the steady state at the least pitch may not exist, or a blade may strike
    // the tower there.
    std::exception_ptr failure;
    if (!is_above) {
      try {
        const OperatingPoint* point = search_speed(wind);
        if (point != nullptr) return *point;
      } catch (const ConvergenceError&) {
        failure = std::current_exception();
      } catch (const DomainError&) {
        failure = std::current_exception();
      }
    }
    try {
      if (const std::optional<OperatingPoint> point = search_pitch(wind)) return *point;
    } catch (...) {
      if (failure) std::rethrow_exception(failure);
      throw;
    }
    if (failure) std::rethrow_exception(failure);
    // The torque at the least pitch is below the rated one: the rotor stalls.
    const OperatingPoint* point = is_above ? search_speed(wind) : nullptr;
    if (point != nullptr) return *point;
    throw InputError("operation.rated_power is not reached at the least pitch of " +
                     general(fine_pitch() / degree, 4) + " deg and the rated speed: the torque " +
                     "there is " + general(present_->torque, 4) + " N m of " +
                     general(rated_torque(), 4) + " N m");
  }

  /// True where the pitch is expected to hold the power, so that the steady state at the least
  /// pitch is not needed: it may not exist. A law above the rated torque, as that of a rotor that
  /// is regulated by stall, may have a speed at any wind.
  bool is_above_rated(double wind) {
    if (is_law_above_rated()) return false;
    if (memory_.point)
      return memory_.point->region == OperatingRegion::rated_power && wind >= memory_.point->wind;
    const std::optional<double> rated = estimate_rated_wind();
    return rated && wind > 1.15 * *rated;
  }

  /// Wind speed of the rated power at a power coefficient of 0.4; none before the first steady
  /// state.
  std::optional<double> estimate_rated_wind() {
    constexpr double usual = 0.4;
    if (memory_.tip_radius == 0.0) {
      const model::Turbine turbine = model::build_turbine(scenario_.turbine);
      memory_.tip_radius = turbine.air->rotor.tip_radius;
      memory_.density = turbine.air->rotor.density;
    }
    const double disk = std::numbers::pi * memory_.tip_radius * memory_.tip_radius;
    return std::cbrt(setup_.rated_power / (0.5 * usual * memory_.density * disk));
  }

  /// The speed at the least pitch; null where the torque at the rated speed is above the rated one.
  const OperatingPoint* search_speed(double wind) {
    constexpr double usual_ratio = 8.0;
    estimate_rated_wind();  // for the radius
    const double torque = rated_torque();
    SearchRange range{least_speed(), setup_.rated_speed, usual_ratio * wind / memory_.tip_radius,
                      0.03 * setup_.rated_speed};
    // At an equal tip-speed ratio the torque grows with the square of the wind speed.
    if (memory_.point && memory_.point->region != OperatingRegion::rated_power) {
      range.start = memory_.point->speed * wind / memory_.point->wind;
      range.slope = memory_.speed_slope * wind / memory_.point->wind;
    }
    const Root root = find_zero(range, [&](double speed, bool is_rough) {
      return (evaluate(wind, speed, fine_pitch(), is_rough).torque - law_at(speed)) / torque;
    });
    if (root.found == Found::zero) {
      memory_.speed_slope = root.slope;
      return keep(OperatingRegion::torque_law);
    }
    if (root.found == Found::below_range) {
      if (!(present_->torque > 0.0))
        throw InputError("the wind does not drive the rotor at " + general(root.x / rpm, 4) +
                         " rpm" + (setup_.least_speed > 0.0 ? ", the least speed" : "") +
                         ": the torque of the generator would be " + general(present_->torque, 3) +
                         " N m; hint: higher operation.wind_speeds, or a lower "
                         "operation.least_speed_rpm");
      return keep(OperatingRegion::least_speed);
    }
    if (present_->torque <= torque) return keep(OperatingRegion::rated_speed);
    return nullptr;
  }

  const OperatingPoint* keep(OperatingRegion region) {
    present_->region = region;
    return &*present_;
  }

  /// The pitch at the rated speed and torque; none where the torque at the least pitch is below the
  /// rated one.
  std::optional<OperatingPoint> search_pitch(double wind) {
    const double torque = rated_torque();
    SearchRange range{fine_pitch(), fine_pitch() + pitch_range, start_pitch(wind), 1.0 * degree,
                      extrapolate(
                          wind, [](const PitchedPoint& point) { return point.slope; }, 2)
                          .value_or(0.0)};
    const Root root = find_zero(range, [&](double pitch, bool is_rough) {
      return (evaluate(wind, setup_.rated_speed, pitch, is_rough).torque - torque) / torque;
    });
    if (root.found == Found::above_range)
      throw InputError("no pitch up to " + general((fine_pitch() + pitch_range) / degree, 3) +
                       " deg limits the power to operation.rated_power");
    if (root.found == Found::below_range) return std::nullopt;
    memory_.pitched.push_back({wind, root.x, root.slope});
    return take(OperatingRegion::rated_power);
  }

  /// Value at a wind speed of the polynomial through the last points, `most` at the most.
  template <class Value>
  std::optional<double> extrapolate(double wind, const Value& value, std::size_t most) const {
    if (memory_.pitched.empty()) return std::nullopt;
    const std::size_t first = memory_.pitched.size() - std::min(memory_.pitched.size(), most);
    double sum = 0.0;
    for (std::size_t i = first; i < memory_.pitched.size(); ++i) {
      double weight = 1.0;
      for (std::size_t j = first; j < memory_.pitched.size(); ++j)
        if (j != i)
          weight *= (wind - memory_.pitched[j].wind) /
                    (memory_.pitched[i].wind - memory_.pitched[j].wind);
      sum += weight * value(memory_.pitched[i]);
    }
    return sum;
  }

  /// From a usual schedule, 20 deg (V/V_rated - 1)^0.6, or from the last points: the power 1/0.6 of
  /// the pitch is nearly linear. After a single point it grows as that of the usual schedule.
  double start_pitch(double wind) {
    constexpr double exponent = 0.6;
    constexpr double usual = 20.0 * degree;
    const auto measure = [this](const PitchedPoint& point) {
      return std::pow(std::max(point.pitch - fine_pitch(), 0.0), 1.0 / exponent);
    };
    const double rated = *estimate_rated_wind();
    const double growth = std::pow(usual, 1.0 / exponent) / rated;
    double value = growth * rated * std::max(wind / rated - 1.0, 0.02);
    if (memory_.pitched.size() == 1)
      value = measure(memory_.pitched.front()) + growth * (wind - memory_.pitched.front().wind);
    else if (!memory_.pitched.empty())
      value = *extrapolate(wind, measure, 3);
    return fine_pitch() + std::pow(std::max(value, 0.0), exponent);
  }

  Scenario scenario_;
  const model::OperatingPointsDefinition& setup_;
  const std::vector<ScheduledPoint>& table_;
  std::optional<analysis::Trim> last_;
  std::unique_ptr<turbine::TurbineSystem> system_;  ///< of last_
  std::optional<OperatingPoint> present_;           ///< of last_
  bool present_is_rough_ = false;
  bool is_law_noted_ = false;
  OperationMemory memory_;
  MPI_Comm comm_ = MPI_COMM_SELF;  ///< ranks that share a large mesh
};

std::string region_name(OperatingRegion region) {
  switch (region) {
    case OperatingRegion::given:
      return "table";
    case OperatingRegion::least_speed:
      return "least speed";
    case OperatingRegion::torque_law:
      return "torque law";
    case OperatingRegion::rated_speed:
      return "rated speed";
    case OperatingRegion::rated_power:
      return "rated power";
  }
  return "";
}

OperatingPointFinder::OperatingPointFinder(const Scenario& scenario,
                                           const std::vector<ScheduledPoint>& table)
    : search_(std::make_unique<Search>(scenario, table)) {}

OperatingPointFinder::~OperatingPointFinder() = default;

OperatingPoint OperatingPointFinder::find_at(double wind, analysis::Observer& observer,
                                             MPI_Comm comm) {
  return search_->find_at(wind, observer, comm);
}

const OperationMemory& OperatingPointFinder::memory() const { return search_->memory(); }

void OperatingPointFinder::recall(const OperationMemory& memory) { search_->recall(memory); }

const turbine::TurbineSystem& OperatingPointFinder::system() const { return search_->system(); }

const analysis::Trim& OperatingPointFinder::trim() const { return search_->trim(); }

std::vector<double> operating_winds(const Scenario& scenario,
                                    const std::vector<ScheduledPoint>& table) {
  std::vector<double> winds = scenario.operation.wind_speeds;
  if (winds.empty())
    for (const ScheduledPoint& row : table) winds.push_back(row.wind);
  if (winds.empty()) winds.push_back(scenario.turbine.wind->speed);
  return winds;
}

std::vector<OperatingPoint> find_operation(const Scenario& scenario,
                                           const std::vector<ScheduledPoint>& table,
                                           analysis::Observer& observer) {
  OperatingPointFinder finder(scenario, table);
  const std::vector<double> winds = operating_winds(scenario, table);
  std::vector<OperatingPoint> points;
  for (const double wind : winds) {
    observer.progress("operation", static_cast<long>(points.size()),
                      static_cast<long>(winds.size()));
    points.push_back(finder.find_at(wind, observer));
  }
  return points;
}

}  // namespace samara::simulation
