#include "bladed_records.hpp"

#include <algorithm>
#include <cmath>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"

namespace samara::io {
namespace {

using simulation::ControlDemand;
using simulation::ControlMeasurement;

// Numbers of records with more than one user here.
constexpr std::size_t contactor = 35;
constexpr std::size_t brake = 36;
constexpr std::size_t yaw_torque = 41;
constexpr std::size_t individual_pitch = 42;
constexpr std::size_t collective_pitch = 45;
constexpr std::size_t torque = 47;
constexpr std::size_t yaw_rate = 48;
constexpr std::size_t pitch_override = 55;
constexpr std::size_t torque_override = 56;

constexpr std::size_t most_blades = 3;
constexpr int most_logged = 300;            ///< values that may be returned for logging
constexpr std::size_t first_logged = 1100;  ///< behind the records of a platform

float single(double value) { return static_cast<float>(value); }

}  // namespace

void BladedRecords::write(const ControlMeasurement& m, const BladedTexts& texts,
                          std::span<float> records) const {
  const auto put = [&records](std::size_t number, double value) {
    records[number - 1] = single(value);
  };
  const std::size_t blades = std::min(m.pitch.size(), most_blades);
  if (m.call == ControlMeasurement::Call::first) {
    std::ranges::fill(records, 0.0F);
    put(contactor, 1.0);
    // The demands are those that hold the present state, for a library that does not set them yet.
    put(collective_pitch, m.pitch[0]);
    for (std::size_t k = 0; k < blades; ++k) put(individual_pitch + k, m.pitch[k]);
    put(torque, m.generator_torque);
  }
  put(1, m.call == ControlMeasurement::Call::first  ? 0.0
         : m.call == ControlMeasurement::Call::last ? -1.0
                                                    : 1.0);
  put(2, m.time);
  put(3, m.interval);
  const std::size_t pitch_of[] = {4, 33, 34};
  for (std::size_t k = 0; k < blades; ++k) {
    put(pitch_of[k], m.pitch[k]);
    put(30 + k, m.out_of_plane[k]);
    put(69 + k, m.in_plane[k]);
  }
  put(10, 0.0);  // the demand is an angle, not a rate
  put(11, records[collective_pitch - 1]);
  put(14, m.shaft_power);
  put(15, m.electrical_power);
  put(20, m.generator_speed);
  put(21, m.rotor_speed);
  put(23, m.generator_torque);
  put(24, m.yaw_error);
  put(27, m.wind_speed);
  put(28, is_individual_ ? 1.0 : 0.0);
  put(29, 0.0);  // the demand is a yaw rate
  put(37, m.yaw);
  put(49, static_cast<double>(texts.room));
  put(50, static_cast<double>(texts.input + 1));
  put(51, static_cast<double>(texts.output + 1));
  put(53, m.fore_aft_acceleration);
  put(54, m.side_side_acceleration);
  put(60, m.azimuth);
  put(61, static_cast<double>(m.pitch.size()));
  put(62, most_logged);
  put(63, static_cast<double>(first_logged));
  put(64, static_cast<double>(texts.room));
  put(73, m.turning_hub_moment[0]);
  put(74, m.turning_hub_moment[1]);
  put(75, m.hub_moment[0]);
  put(76, m.hub_moment[1]);
  put(77, m.yaw_bearing_moment[0]);
  put(78, m.yaw_bearing_moment[1]);
  for (std::size_t i = 0; i < 3; ++i) put(82 + i, m.nacelle_turning[i]);
  put(109, m.shaft_torque);
  put(110, m.thrust);
  put(111, m.shaft_force[0]);
  put(112, m.shaft_force[1]);
  put(129, static_cast<double>(records.size()));
}

ControlDemand BladedRecords::read(std::span<const float> records, std::size_t blades) {
  ControlDemand demand;
  const auto take = [&records](std::size_t number, const char* what) {
    const auto value = static_cast<double>(records[number - 1]);
    if (!std::isfinite(value))
      throw ConvergenceError("gives " + (std::isnan(value) ? "nan" : general(value, 6)) + " as " +
                             what + " (record " + std::to_string(number) + ")");
    return value;
  };
  const auto note = [&](std::size_t number, const std::string& text) {
    if (noted_.insert(static_cast<int>(number)).second)
      demand.notes.push_back(text + " (record " + std::to_string(number) + ")");
  };
  for (std::size_t k = 0; k < blades; ++k)
    demand.pitch.push_back(is_individual_ ? take(individual_pitch + k, "the pitch of a blade")
                                          : take(collective_pitch, "the pitch"));
  const double asked = take(torque, "the torque");
  const double state = take(contactor, "the state of the generator's contactor");
  demand.torque = state == 0.0 ? 0.0 : asked;
  if (state != 0.0 && state != 1.0)
    note(contactor, "asks for the generator's contactor in state " + general(state, 4) +
                        ", which counts as 1");
  const auto refuse = [&](std::size_t number, const std::string& what) {
    if (const double value = records[number - 1]; value != 0.0)
      note(number, what + " " + general(value, 6) + ", which is not followed");
  };
  refuse(brake, "asks for the brake, state");
  refuse(yaw_torque, "asks for a yaw torque of");
  refuse(yaw_rate, "asks for a yaw rate of");
  refuse(pitch_override, "asks for a built-in pitch control, override");
  refuse(torque_override, "asks for a built-in torque control, override");
  return demand;
}

}  // namespace samara::io
