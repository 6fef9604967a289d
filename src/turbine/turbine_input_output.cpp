#include "samara/turbine/turbine_input_output.hpp"

#include <algorithm>
#include <array>

#include "samara/base/error.hpp"
#include "samara/base/words.hpp"

namespace samara::turbine {
namespace {

using Complex = std::complex<double>;
using ComplexVector = Eigen::VectorXcd;

/// Size of a complex step. No difference is taken, therefore no digits are lost.
constexpr double tiny = 1e-30;

constexpr char pitch_name[] = "pitch";
constexpr char force_stem[] = "top_force_n";
constexpr char base_stem[] = "base_n";
constexpr char turn_stem[] = "base_rot_n";

struct WindInput {
  const char* name;
  const char* unit;
  const char* description;
};

/// Changes of the mean wind, in the order of `changes_of`.
constexpr std::array<WindInput, 5> wind_inputs{{
    {"wind_speed", "m/s", "speed of the wind at its reference height, with its profile"},
    {"wind_direction", "rad", "direction of the wind, counter-clockwise seen from above"},
    {"wind_upflow", "rad", "angle of the rising wind"},
    {"wind_shear_up", "1/s", "change of the speed of the wind with the height, 0 at the hub"},
    {"wind_shear_left", "1/s", "the same to the left of one who looks downwind"},
}};

template <class T>
std::array<T*, wind_inputs.size()> changes_of(elements::WindInputs<T>& wind) {
  return {&wind.speed, &wind.direction, &wind.upflow, &wind.shear_up, &wind.shear_left};
}

const std::vector<std::string>& ground_ways() {
  static const std::vector<std::string> ways{"side-side", "downwind", "up"};
  return ways;
}

/// The number behind the stem of a name; 0 for other names.
int number_of(const std::string& name, const std::string& stem) {
  if (!name.starts_with(stem) || name.size() == stem.size()) return 0;
  return std::stoi(name.substr(stem.size()));
}

/// The signal of a channel. The number of the blade is removed from the family: B1N2MLx, RootMyb1.
system::Signal signal_of(const Channel& channel) {
  system::Signal signal{channel.name, channel.unit, channel.frame, channel.description, "", 0,
                        false};
  const std::string stem = "blade ";
  const bool is_section = channel.name.size() > 2 && channel.name.front() == 'B' &&
                          channel.name.find('N') != std::string::npos &&
                          channel.frame.starts_with(stem) && channel.name[1] >= '0' &&
                          channel.name[1] <= '9';
  if (!channel.frame.starts_with(stem)) return signal;
  signal.blade = std::stoi(channel.frame.substr(stem.size()));
  const std::string number = std::to_string(signal.blade);
  signal.family = channel.name;
  if (is_section)
    signal.family.erase(1, number.size());
  else
    signal.family.erase(signal.family.size() - number.size());
  return signal;
}

}  // namespace

std::vector<system::Signal> TurbineInputOutput::available_inputs(const TurbineSystem& system) {
  const model::Turbine& turbine = system.turbine();
  std::vector<system::Signal> signals;
  if (turbine.chain.generator.free)
    signals.push_back(
        {"generator_torque", "N m", "shaft",
         "torque of the nacelle on the generator, behind the gear, against its turning", "", 0,
         false});
  if (turbine.chain.yaw.free)
    signals.push_back({"yaw_torque", "N m", "nacelle",
                       "torque of the tower top on the nacelle, about y3 (up)", "", 0, false});
  if (turbine.has_tower)
    for (int i = 0; i < 3; ++i)
      signals.push_back({force_stem + std::to_string(i + 1), "N", "ground",
                         "force on the tower top, " + ground_ways()[static_cast<std::size_t>(i)],
                         "", 0, false});
  if (!turbine.blades.empty())
    signals.push_back(
        {pitch_name, "rad", "blades", "pitch of all blades, toward feather", "", 0, true});
  for (std::size_t k = 1; k <= turbine.blades.size(); ++k)
    signals.push_back({pitch_name + ("_" + std::to_string(k)), "rad", "blade " + std::to_string(k),
                       "pitch toward feather", pitch_name, static_cast<int>(k), true});
  if (turbine.has_tower)
    for (int i = 0; i < 3; ++i)
      signals.push_back(
          {base_stem + std::to_string(i + 1), "m", "ground",
           "displacement of the tower's foot, " + ground_ways()[static_cast<std::size_t>(i)], "", 0,
           true});
  if (turbine.has_tower)
    for (int i = 0; i < 3; ++i)
      signals.push_back({turn_stem + std::to_string(i + 1), "rad", "ground",
                         "rotation of the tower's foot, about the axis that points " +
                             ground_ways()[static_cast<std::size_t>(i)],
                         "", 0, true});
  if (turbine.air)
    for (const WindInput& input : wind_inputs)
      signals.push_back({input.name, input.unit, "ground", input.description, "", 0, false});
  return signals;
}

TurbineInputOutput::TurbineInputOutput(const TurbineSystem& system,
                                       const std::vector<std::string>& inputs,
                                       const ChannelStations& stations,
                                       const std::vector<std::string>& channels)
    : system_(system), channels_(system, stations, channels) {
  const std::vector<system::Signal> known = available_inputs(system);
  if (inputs.empty()) inputs_ = known;
  for (const std::string& name : inputs) {
    const auto found = std::find_if(known.begin(), known.end(), [&name](const system::Signal& one) {
      return one.name == name;
    });
    if (found != known.end()) {
      inputs_.push_back(*found);
      continue;
    }
    std::vector<std::string> words;
    std::string all;
    for (const system::Signal& one : known) {
      words.push_back(one.name);
      all += (all.empty() ? "" : ", ") + one.name;
    }
    throw InputError("unknown input \"" + name + "\"" +
                     suggest(name, words, "; hint: this turbine has " + all));
  }
  for (const Channel& channel : channels_.channels()) outputs_.push_back(signal_of(channel));
}

template <class T>
TurbineInputs<T> TurbineInputOutput::collect(
    const Eigen::Matrix<T, Eigen::Dynamic, 1>& values,
    const Eigen::Matrix<T, Eigen::Dynamic, 1>& rates) const {
  TurbineInputs<T> all;
  all.pitch.assign(system_.turbine().blades.size(), T(0));
  all.pitch_rate = all.pitch;
  if (system_.turbine().air) all.wind.height = system_.turbine().air->hub_height;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const system::Signal& input = inputs_[i];
    const T& value = values(static_cast<Eigen::Index>(i));
    const T& rate = rates(static_cast<Eigen::Index>(i));
    for (std::size_t k = 0; k < all.pitch.size(); ++k) {
      if (input.name != pitch_name &&
          (input.family != pitch_name || input.blade != static_cast<int>(k) + 1))
        continue;
      all.pitch[k] += value;
      all.pitch_rate[k] += rate;
    }
    if (input.name == "generator_torque") all.generator_torque += value;
    if (input.name == "yaw_torque") all.yaw_torque += value;
    for (std::size_t k = 0; k < wind_inputs.size(); ++k)
      if (input.name == wind_inputs[k].name) *changes_of(all.wind)[k] += value;
    if (const int n = number_of(input.name, force_stem)) all.top_force(n - 1) += value;
    if (const int n = number_of(input.name, base_stem)) all.base_velocity(n - 1) += rate;
    if (const int n = number_of(input.name, turn_stem)) {
      all.base_turn(n - 1) += value;
      all.base_rate(n - 1) += rate;
    }
  }
  return all;
}

template TurbineInputs<double> TurbineInputOutput::collect(const Eigen::VectorXd&,
                                                           const Eigen::VectorXd&) const;
template TurbineInputs<Complex> TurbineInputOutput::collect(const ComplexVector&,
                                                            const ComplexVector&) const;

std::vector<Complex> TurbineInputOutput::complex_of(Vec vector) const {
  const petsc::ReadView view(vector);
  return {view.data(), view.data() + system_.size()};
}

system::InputTangents TurbineInputOutput::input_tangents(double t, Vec z, Vec z_dot) const {
  const std::vector<Complex> state = complex_of(z);
  const std::vector<Complex> rate = complex_of(z_dot);
  const auto count = static_cast<Eigen::Index>(inputs_.size());
  std::vector<Complex> r(state.size());
  const auto derivative = [&](Eigen::Index i, bool by_rate) -> Eigen::VectorXd {
    ComplexVector values = ComplexVector::Zero(count);
    ComplexVector rates = ComplexVector::Zero(count);
    (by_rate ? rates : values)(i) = Complex(0.0, tiny);
    system_.equations().evaluate(t, state, rate, collect<Complex>(values, rates), r);
    return Eigen::Map<const ComplexVector>(r.data(), system_.size()).imag() / tiny;
  };
  system::InputTangents tangents;
  tangents.by_value.resize(system_.size(), count);
  tangents.by_rate.setZero(system_.size(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    tangents.by_value.col(i) = derivative(i, false);
    if (inputs_[static_cast<std::size_t>(i)].is_motion)
      tangents.by_rate.col(i) = derivative(i, true);
  }
  return tangents;
}

system::OutputTangents TurbineInputOutput::output_tangents(double t, Vec z, Vec z_dot) const {
  std::vector<Complex> state = complex_of(z);
  std::vector<Complex> rate = complex_of(z_dot);
  const auto outputs = static_cast<Eigen::Index>(outputs_.size());
  const auto count = static_cast<Eigen::Index>(inputs_.size());
  ComplexVector y(outputs);
  const std::span<Complex> values(y.data(), outputs_.size());
  system::OutputTangents tangents;
  const auto differentiate = [&](std::vector<Complex>& vector) {
    Eigen::MatrixXd slopes(outputs, system_.size());
    for (std::size_t j = 0; j < vector.size(); ++j) {
      vector[j] += Complex(0.0, tiny);
      channels_.evaluate<Complex>(t, state, rate, values);
      vector[j] = vector[j].real();
      slopes.col(static_cast<Eigen::Index>(j)) = y.imag() / tiny;
    }
    return slopes;
  };
  tangents.by_state = differentiate(state);
  tangents.by_rate = differentiate(rate);
  tangents.by_input.resize(outputs, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    ComplexVector inputs = ComplexVector::Zero(count);
    inputs(i) = Complex(0.0, tiny);
    channels_.evaluate<Complex>(t, state, rate, values,
                                collect<Complex>(inputs, ComplexVector::Zero(count)));
    tangents.by_input.col(i) = y.imag() / tiny;
  }
  return tangents;
}

Eigen::VectorXd TurbineInputOutput::output_values(double t, Vec z, Vec z_dot) const {
  Eigen::VectorXd y(static_cast<Eigen::Index>(outputs_.size()));
  channels_.evaluate(t, z, z_dot, std::span<double>(y.data(), outputs_.size()));
  return y;
}

}  // namespace samara::turbine
