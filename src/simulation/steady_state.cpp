#include "samara/simulation/steady_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/turbine/turbine_channels.hpp"

namespace samara::simulation {
namespace {

/// Relative to the largest load. With a larger imbalance of loads a steady state is rough.
constexpr double rough_imbalance = 1e-4;
constexpr double round_off = 1e-9;

constexpr double degree = std::numbers::pi / 180.0;

/// Range of the pitch of the blades [rad], and the key that sets each bound.
struct PitchRange {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  std::string lowest_key;
  std::string highest_key;
};

PitchRange pitch_range(const model::TurbineDefinition& turbine, int blade) {
  PitchRange range;
  if (turbine.blades.actuator) {
    range = {turbine.blades.actuator->lowest, turbine.blades.actuator->highest,
             "blades.pitch_actuator.lowest_deg is ", "blades.pitch_actuator.highest_deg is "};
  }
  // The pitch of the schedule is ((4 schedule u + s^2)^(1/2) - s)/2 with s = schedule + own pitch;
  // its least value is -s/2.
  const auto found = turbine.blades.each.find(blade);
  const double difference = found == turbine.blades.each.end() ? 0.0 : found->second.pitch;
  const double schedule = turbine.controller->schedule;
  const double least = 0.5 * (turbine.blades.pitch - schedule) + difference;
  if (schedule > 0.0 && least > range.lowest) {
    range.lowest = least;
    range.lowest_key = "controller.pitch.gain_schedule_deg allows none below ";
  }
  return range;
}

/// Message on the bound of the pitch that the controller exceeds. It is found by a trim without
/// bounds. Empty: no bound is exceeded, or that trim fails as well.
std::string find_limit(const Scenario& scenario, const analysis::TrimOptions& options) {
  const model::TurbineDefinition& turbine = scenario.turbine;
  if (!turbine.controller || !turbine.controller->pitch) return "";
  if (!turbine.blades.actuator && turbine.controller->schedule == 0.0) return "";
  const double infinity = std::numeric_limits<double>::infinity();
  model::TurbineDefinition free = turbine;
  free.controller->schedule = 0.0;
  if (free.blades.actuator) {
    free.blades.actuator->lowest = -infinity;
    free.blades.actuator->highest = infinity;
  }
  try {
    const turbine::TurbineSystem system(model::build_turbine(free), PETSC_COMM_SELF);
    analysis::Observer silent;
    const analysis::Trim trim = analysis::find_trim(system, options, silent);
    std::vector<std::string> names;
    for (int k = 1; k <= turbine.blades.count; ++k) names.push_back("BldPitch" + std::to_string(k));
    const std::vector<double> pitches = mean_channels(system, trim, names);
    for (int k = 1; k <= turbine.blades.count; ++k) {
      const PitchRange range = pitch_range(turbine, k);
      const double pitch = pitches[static_cast<std::size_t>(k - 1)] * degree;
      const bool is_high = pitch > range.highest;
      if (!is_high && !(pitch < range.lowest)) continue;
      return "the controller needs a pitch of " + general(pitch / degree, 4) + " deg, but " +
             (is_high ? range.highest_key : range.lowest_key) +
             general((is_high ? range.highest : range.lowest) / degree, 4) +
             ": it cannot hold the speed at this limit; hint: other limits, or torques that "
             "balance at shaft.speed within them";
    }
  } catch (const ConvergenceError&) {
    return "";
  } catch (const DomainError&) {
    return "";
  }
  return "";
}

bool has_rotor_wake(const turbine::TurbineSystem& system) {
  return system.turbine().air && system.turbine().air->rotor.models.has_rotor_wake();
}

constexpr char wake_hint[] =
    "; the finite-state wake holds up to 0.41 of an axial wind, a thrust coefficient of 0.97; "
    "hint: aero.inflow: oye or equilibrium, or a smaller thrust";

/// Message where the finite-state wake has no steady state because the thrust is too large. The
/// thrust is that of the balance of momentum. Empty: another reason, or that trim fails as well.
std::string find_thrust_limit(const Scenario& scenario, const analysis::TrimOptions& options) {
  model::TurbineDefinition other = scenario.turbine;
  other.aero->inflow = model::Inflow::equilibrium;
  try {
    const turbine::TurbineSystem system(model::build_turbine(other), PETSC_COMM_SELF);
    analysis::Observer silent;
    const analysis::Trim trim = analysis::find_trim(system, options, silent);
    const double thrust = mean_channels(system, trim, {"RtAeroFxh"}).front();
    const model::Air& air = *system.turbine().air;
    const elements::AirRotor& rotor = air.rotor;
    const double axial = air.hub_wind_axial;
    const Vector3 wind(std::sqrt(std::max(air.hub_wind * air.hub_wind - axial * axial, 0.0)), 0.0,
                       axial);
    const double disk = std::numbers::pi * rotor.tip_radius * rotor.tip_radius;
    const double load = std::numbers::sqrt3 * thrust / (4.0 * rotor.density * disk);
    if (elements::find_steady_wake(wind, load, rotor.least_speed).is_in_range) return "";
    return "aero.inflow: peters_he: the rotor has a thrust coefficient of " +
           general(thrust / (0.5 * rotor.density * disk * air.hub_wind * air.hub_wind), 3) +
           " by the balance of momentum" + wake_hint;
  } catch (const ConvergenceError&) {
    return "";
  } catch (const DomainError&) {
    return "";
  }
}

}  // namespace

analysis::Trim solve_trim(const Scenario& scenario, const turbine::TurbineSystem& system,
                          const analysis::TrimOptions& options, analysis::Observer& observer,
                          MPI_Comm comm, const analysis::Trim* near) {
  const auto name_limit = [&] {
    std::string words = find_limit(scenario, options);
    if (words.empty() && has_rotor_wake(system)) words = find_thrust_limit(scenario, options);
    if (!words.empty()) throw ConvergenceError("trim: " + words);
  };
  try {
    return analysis::find_trim(system, options, observer, comm, near);
  } catch (const ConvergenceError&) {
    name_limit();
    throw;
  } catch (const DomainError&) {
    name_limit();
    throw;
  }
}

analysis::Trim find_trim(const Scenario& scenario, const turbine::TurbineSystem& system,
                         analysis::Observer& observer, MPI_Comm comm) {
  analysis::Trim trim = solve_trim(scenario, system, trim_options(scenario), observer, comm);
  require_wake_range(system, trim);
  note_doubts(system, trim, observer);
  return trim;
}

void require_wake_range(const turbine::TurbineSystem& system, const analysis::Trim& trim) {
  if (!has_rotor_wake(system)) return;
  const double least = system.turbine().air->rotor.least_speed;
  visit_instants(system, trim, [&](double t, Vec z, Vec z_dot) {
    const elements::DiskFlow<double> flow =
        system.equations().disk_flow(t, petsc::values_of(z), petsc::values_of(z_dot)).value();
    if (elements::is_in_range(flow, least)) return;
    throw ConvergenceError("trim: aero.inflow: peters_he: the mean induced velocity is " +
                           general(flow.mean, 3) + " m/s in a wind of " +
                           general(flow.through + flow.mean, 3) + " m/s along the shaft" +
                           wake_hint);
  });
}

int instants_of_means(const analysis::Trim& trim) {
  return trim.solution.is_constant() ? 1 : 6 * trim.solution.harmonics() + 1;
}

void visit_instants(const turbine::TurbineSystem& system, const analysis::Trim& trim,
                    const std::function<void(double t, Vec z, Vec z_dot)>& visit) {
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const int instants = instants_of_means(trim);
  for (int i = 0; i < instants; ++i) {
    const double t = system.period() * i / instants;
    trim.solution.evaluate(t, z.get(), z_dot.get());
    visit(t, z.get(), z_dot.get());
  }
}

std::vector<double> mean_channels(const turbine::TurbineSystem& system, const analysis::Trim& trim,
                                  const std::vector<std::string>& names) {
  const turbine::TurbineChannels channels(system, {}, names);
  const int instants = instants_of_means(trim);
  std::vector<double> means(names.size(), 0.0);
  std::vector<double> values(names.size());
  visit_instants(system, trim, [&](double t, Vec z, Vec z_dot) {
    channels.evaluate(t, z, z_dot, values);
    for (std::size_t j = 0; j < means.size(); ++j) means[j] += values[j] / instants;
  });
  return means;
}

std::string roughness(const analysis::Trim& trim) {
  if (trim.imbalance() <= rough_imbalance && trim.medium_residual > analysis::rough_medium)
    return "the air at a station is out of balance by " + general(trim.medium_residual, 2) +
           " of the terms of its equations (more than " + general(analysis::rough_medium, 1) +
           "); hint: more trim.harmonics";
  if (trim.imbalance() <= rough_imbalance) return "";
  const bool is_of_states = trim.state_residual >= trim.imbalance();
  const std::string part = is_of_states
                               ? general(trim.state_residual, 2) + " of the terms of its equations"
                               : general(trim.imbalance(), 2) + " of the largest load";
  const std::string bound = " (more than " + general(rough_imbalance, 1) + ")";
  const std::string what =
      is_of_states ? "a state or auxiliary is out of balance by " : "loads are out of balance by ";
  if (trim.method == analysis::TrimMethod::shooting)
    return what + part + bound + "; hint: more trim.steps";
  if (std::isnan(trim.harmonic_residual))
    return what + part + bound + "; hint: more trim.harmonics, or a smaller trim.tolerance";
  const bool is_newton = !is_of_states && trim.harmonic_residual >
                                              0.5 * std::max(trim.residual, trim.residual_between);
  return what + part + bound +
         (is_newton ? "; hint: a smaller trim.tolerance" : "; hint: more trim.harmonics");
}

double least_held_load(const analysis::Trim& trim) {
  return std::max(
      {round_off * std::max(trim.load_level, 1.0), trim.residual, trim.residual_between});
}

void note_doubts(const turbine::TurbineSystem& system, const analysis::Trim& trim,
                 analysis::Observer& observer, const std::string& source) {
  const std::string words = roughness(trim);
  if (!words.empty()) observer.note(source + ": the steady state is rough: " + words);
  for (const analysis::HeldCoordinate& held : trim.held)
    if (held.unknown != system.layout().generator() &&
        !(std::abs(held.load) < least_held_load(trim)))
      observer.note(source + ": no equilibrium: a constant load of " + general(held.load, 4) + " " +
                    held.unit + " holds " + held.name + ", which nothing restores, at a mean of 0");
}

}  // namespace samara::simulation
