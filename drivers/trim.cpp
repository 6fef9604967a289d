// samara trim: the periodic steady state.
#include "samara/analysis/trim.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "samara/petsc/session.hpp"
#include "samara/simulation/steady_state.hpp"
#include "samara/turbine/turbine_system.hpp"

#include "commands.hpp"
#include "masses.hpp"
#include "progress.hpp"
#include "steady_state_groups.hpp"
#include "table.hpp"

namespace samara::drivers {
namespace {

using analysis::Trim;

constexpr int most_harmonics_shown = 5;
constexpr int instants = 180;

/// Relative to the size of the whole quantity. A smaller value is round-off.
constexpr double round_off = 1e-9;

/// A line of the table: an unknown of interest to the user.
struct Output {
  std::string name;
  std::string unit;
  int unknown = 0;
  double factor = 1.0;  ///< from SI to `unit`
  double zero = 0.0;    ///< a smaller value is round-off
};

/// Equal blades that turn differ only in azimuth.
bool has_one_blade_for_all(const turbine::TurbineSystem& system) {
  return system.symmetry().sectors > 1 && system.period() > 0.0;
}

std::vector<Output> outputs_of(const turbine::TurbineSystem& system, double load_level) {
  const model::Turbine& turbine = system.turbine();
  const turbine::TurbineLayout& layout = system.layout();
  const double small_load = round_off * std::max(load_level, 1.0);
  std::vector<Output> outputs;
  const auto add_three = [&outputs](const std::string& place, int first, const std::string& unit,
                                    double zero, const std::vector<std::string>& directions) {
    for (int i = 0; i < 3; ++i)
      outputs.push_back(
          {place + " " + directions[static_cast<std::size_t>(i)], unit, first + i, 1.0, zero});
  };
  const auto add_angle = [&outputs](const std::string& name, int unknown) {
    outputs.push_back({name, "deg", unknown, 180.0 / std::numbers::pi, round_off});
  };
  const int shown = has_one_blade_for_all(system) ? 1 : static_cast<int>(turbine.blades.size());
  for (int k = 0; k < shown; ++k) {
    const std::string blade = turbine.blades[static_cast<std::size_t>(k)].name;
    const int root = layout.blade_root(k);
    const double length = turbine.blades[static_cast<std::size_t>(k)].tip.norm();
    add_three(blade + " tip", layout.blade_tip(k), "m", round_off * length,
              {"along b1 (outward)", "along b2 (lead-lag)", "along b3 (flap)"});
    const std::vector<model::RootHinge>& hinges = turbine.roots[static_cast<std::size_t>(k)].hinges;
    for (std::size_t i = 0; i < hinges.size(); ++i)
      add_angle(blade + " " + components::hinge_name(hinges[i].axis),
                layout.hinge(k, static_cast<int>(i)));
    add_three(blade + " root force", root, "N", small_load, {"b1 (axial)", "b2", "b3"});
    add_three(blade + " root moment", root + 3, "N m", small_load,
              {"b1 (torsion)", "b2 (flap)", "b3 (lead-lag)"});
  }
  const auto moves = [](const elements::Hinge& hinge, const model::PrescribedMotion& motion) {
    return hinge.free || motion.angle != 0.0 || !motion.is_constant();
  };
  if (moves(turbine.chain.teeter, turbine.teeter_motion)) add_angle("teeter", layout.teeter());
  if (moves(turbine.chain.yaw, turbine.yaw_motion)) add_angle("yaw", layout.yaw());
  if (turbine.chain.torsion.free) add_angle("shaft torsion", layout.shaft_torsion());
  if (turbine.chain.generator.free) add_angle("generator", layout.generator());
  for (const auto& damper : system.equations().mass_dampers()) {
    if (damper->owner().instance > shown) continue;
    for (std::size_t i = 0; i < damper->definition().axes.size(); ++i)
      outputs.push_back({damper->owner().name() + " " + damper->direction(i), "m", damper->first(i),
                         1.0, round_off});
  }
  if (!turbine.has_tower) return outputs;
  add_three("tower top", layout.tower_tip(), "m", round_off * turbine.tower.tip.norm(),
            {"along n3 (up)", "along n1 (side-side)", "along n2 (downwind)"});
  add_three("tower root force", layout.tower_root(), "N", small_load,
            {"n3 (vertical)", "n1 (side-side)", "n2 (downwind)"});
  add_three("tower root moment", layout.tower_root() + 3, "N m", small_load,
            {"n3 (torsion)", "n1 (fore-aft)", "n2 (side-side)"});
  return outputs;
}

/// The value of largest modulus over a revolution; the first of several that differ by round-off.
double largest_value(const analysis::PeriodicSolution& solution, int unknown) {
  const Eigen::RowVectorXd row = solution.coefficients().row(unknown);
  if (solution.is_constant()) return row(0);
  double largest = 0.0;
  for (int i = 0; i < instants; ++i) {
    const double t = solution.period() * i / instants;
    const double value =
        row.dot(analysis::PeriodicSolution::basis(solution.harmonics(), solution.period(), t));
    if (std::abs(value) > (1.0 + round_off) * std::abs(largest)) largest = value;
  }
  return largest;
}

std::string output_table(const turbine::TurbineSystem& system, const Trim& trim) {
  const analysis::PeriodicSolution& solution = trim.solution;
  const int shown = std::min(solution.harmonics(), most_harmonics_shown);
  Table table;
  table.add_column("output", "", Align::left);
  table.add_column("unit", "", Align::left);
  table.add_column("mean", "");
  for (int k = 1; k <= shown; ++k) table.add_column(std::to_string(k) + "P", "");
  if (shown > 0) table.add_column("largest", "");
  for (const Output& output : outputs_of(system, trim.load_level)) {
    const Eigen::RowVectorXd row = solution.coefficients().row(output.unknown);
    const auto number = [&output](double value) {
      return std::abs(value) < output.zero ? "0" : general(value * output.factor, 4);
    };
    std::vector<std::string> words{output.name, output.unit, number(row(0))};
    for (Eigen::Index k = 1; k <= shown; ++k)
      words.push_back(number(std::hypot(row(2 * k - 1), row(2 * k))));
    if (shown > 0) words.push_back(number(largest_value(solution, output.unknown)));
    table.add_row(words);
  }
  std::string notes;
  if (shown > 0) notes += "kP: amplitude at k times the rotor speed";
  if (shown < solution.harmonics()) notes += "; higher ones are in the result";
  if (has_one_blade_for_all(system))
    notes +=
        std::string(notes.empty() ? "" : "; ") + "the other blades are equal, each at its azimuth";
  return table.text() + (notes.empty() ? "" : notes + "\n");
}

/// PETSc's reason for the end of the nonlinear solve, in words.
std::string explain(const std::string& reason) {
  if (reason == "CONVERGED_FNORM_ABS") return "the residual vanished (" + reason + ")";
  if (reason == "CONVERGED_FNORM_RELATIVE")
    return "the residual fell by trim.tolerance (" + reason + ")";
  if (reason == "CONVERGED_SNORM_RELATIVE") return "the steps became small (" + reason + ")";
  return reason;
}

/// Torque of a free generator that holds the mean speed: by its law, and a constant torque in
/// addition. The load of the solution acts at the shaft; the printed torque is that of the
/// generator.
std::string generator_words(const io::Case& input, double shaft_load, double shaft_zero) {
  const model::ShaftDefinition& shaft = input.turbine.shaft;
  const double law = shaft.generator.law.at(shaft.generator_speed()).torque;
  const double load = shaft_load / std::abs(shaft.gear_ratio);
  const double zero = shaft_zero / std::abs(shaft.gear_ratio);
  const auto number = [zero](double torque) {
    return std::abs(torque) < zero ? std::string("0") : general(torque, 4);
  };
  std::string text =
      "generator    " + number(law - load) + " N m against its turning hold the mean speed";
  if (law != 0.0) text += ": " + number(law) + " by its law and " + number(-load) + " in addition";
  return text + "\n";
}

/// Mean speed, torque and pitch of the controller over a revolution.
std::string controller_words(const turbine::TurbineSystem& system, const Trim& trim) {
  const std::vector<double> means =
      simulation::mean_channels(system, trim, {"GenSpeed", "GenTq", "BldPitch1"});
  return "controller   holds the generator at " + general(means[0], 6) + " rpm, with " +
         general(1e3 * means[1], 5) + " N m against its turning and a pitch of " +
         general(means[2], 5) + " deg\n";
}

/// Power and thrust of the air at the rotor, means over a revolution.
std::string air_words(const turbine::TurbineSystem& system, const Trim& trim) {
  const model::Air& air = *system.turbine().air;
  const std::vector<double> means =
      simulation::mean_channels(system, trim, {"RtAeroPwr", "RtAeroFxh"});
  std::string text = "air          ";
  if (system.turbine().speed > 0.0) text += "power " + general(1e-3 * means[0], 5) + " kW, ";
  text += "thrust " + general(1e-3 * means[1], 5) + " kN";
  const double wind = air.hub_wind;
  if (wind > 0.0 && system.turbine().speed > 0.0) {
    const double radius = air.rotor.tip_radius;
    const double load = 0.5 * air.rotor.density * wind * wind * std::numbers::pi * radius * radius;
    text += "; C_P " + general(means[0] / (load * wind), 4) + ", C_T " +
            general(means[1] / load, 4) + " with the wind at the hub, " + general(wind, 4) + " m/s";
  }
  return text + "\n";
}

std::string summary(const io::Case& input, const turbine::TurbineSystem& system, const Trim& trim) {
  const int harmonics = trim.solution.harmonics();
  std::string text = title_of(input) + "\n";
  text += "rotor speed  " + general(input.turbine.shaft.speed, 6) + " rad/s\n";
  text += "method       ";
  text += trim.method == analysis::TrimMethod::shooting ? "shooting" : "harmonic balance";
  text += harmonics > 0 ? ", " + count(harmonics, "harmonic") + " of the rotor speed\n"
                        : ": a constant, nothing changes with the azimuth\n";
  for (std::size_t i = 0; trim.attempts.size() > 1 && i < trim.attempts.size(); ++i)
    text += std::string(i == 0 ? "tried        " : "             ") +
            count(trim.attempts[i].first, "harmonic") + ": residual between the samples " +
            scientific(trim.attempts[i].second, 1) + "\n";
  text +=
      "Newton       " + count(trim.newton_steps, "step") + ", " + explain(trim.convergence) + "\n";
  if (!trim.linear_solver.empty()) text += "linear       " + trim.linear_solver + "\n";
  text += "residual     " + scientific(trim.residual, 1) + " at the samples, " +
          scientific(trim.residual_between, 1) + " between them [N, N m]; largest load " +
          general(trim.load_level, 4) + "\n";
  if (const std::string words = simulation::roughness(trim); !words.empty())
    text += "rough        " + words + "\n";
  for (const analysis::HeldCoordinate& held : trim.held) {
    const double zero = simulation::least_held_load(trim);
    if (held.unknown == system.layout().generator()) {
      const std::optional<model::ControllerDefinition>& controller = system.turbine().controller;
      text += controller && controller->has_integral() ? controller_words(system, trim)
                                                       : generator_words(input, held.load, zero);
      continue;
    }
    const bool is_zero = std::abs(held.load) < zero;
    text += "held         " + held.name + ", which nothing restores: mean 0, by " +
            (is_zero ? "0" : general(held.load, 4)) + " " + held.unit +
            (is_zero ? "" : " (not 0: no equilibrium there)") + "\n";
  }
  if (system.turbine().air) text += air_words(system, trim);
  return text + "\n";
}

}  // namespace

void run_trim(const Job& job) {
  const model::Turbine turbine = model::build_turbine(job.input.turbine);
  const turbine::TurbineSystem system(turbine, PETSC_COMM_SELF);
  const bool is_first = petsc::Session::rank() == 0;
  Progress progress(is_first);
  const Trim trim = simulation::solve_trim(job.input, system, simulation::trim_options(job.input),
                                           progress, PETSC_COMM_WORLD);
  simulation::require_wake_range(system, trim);
  progress.finish();
  if (!is_first) return;
  deliver(
      job, summary(job.input, system, trim) + output_table(system, trim),
      [&](io::ResultFile& file) {
        file.write_model(system);
        write_masses(file, model::compute_masses(job.input.turbine, turbine));
        write_steady_state(file, system, trim);
        file.write_geometry(system, trim);
      },
      [&](const std::string& path) { io::write_trim_table(path, system, trim); });
}

}  // namespace samara::drivers
