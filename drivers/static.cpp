// samara static: equilibrium at rest under gravity and loads, by load stepping.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "samara/analysis/static_path.hpp"
#include "samara/base/error.hpp"
#include "samara/petsc/session.hpp"
#include "samara/turbine/turbine_system.hpp"

#include "commands.hpp"
#include "masses.hpp"
#include "progress.hpp"
#include "table.hpp"

namespace samara::drivers {
namespace {

using analysis::StaticPath;
using analysis::StaticState;

constexpr std::size_t most_rows = 12;

/// Relative to the size of the whole quantity. A smaller value is round-off.
constexpr double round_off = 1e-9;

constexpr double to_degrees = 180.0 / std::numbers::pi;

/// The states to print: some at equal distances, the last one, and those next to limit points.
std::set<std::size_t> shown_states(const StaticPath& path) {
  std::set<std::size_t> shown;
  const std::size_t last = path.states.size() - 1;
  const std::size_t stride = last / most_rows + 1;
  for (std::size_t i = 0; i < last; i += stride) shown.insert(i);
  shown.insert(last);
  for (std::size_t i = 0; i < last; ++i)
    for (const double factor : path.limit_points)
      if (path.states[i].factor == factor) shown.insert(i);
  return shown;
}

/// End and root of one beam, one line per state.
std::string beam_table(const StaticPath& path, const model::Beam& beam, int tip, int root) {
  Table table;
  table.add_column("factor", "");
  for (const char* name : {"u b1", "u b2", "u b3"}) table.add_column(name, "m");
  table.add_column("turned", "deg");
  for (const char* name : {"F b1", "F b2", "F b3"}) table.add_column(name, "N");
  for (const char* name : {"M b1", "M b2", "M b3"}) table.add_column(name, "N m");
  const double small_length = round_off * beam.tip.norm();
  const double small_load = round_off * std::max(path.load_level, 1e-300);
  for (const std::size_t i : shown_states(path)) {
    const StaticState& state = path.states[i];
    std::vector<std::string> words{fixed(state.factor, 4)};
    const auto add = [&](double value, double zero) {
      words.push_back(std::abs(value) <= zero ? "0" : general(value, 5));
    };
    for (int j = 0; j < 3; ++j) add(state.z(tip + j), small_length);
    const double angle = 2.0 * std::atan(0.5 * state.z.segment<3>(tip + 3).norm());
    words.push_back(fixed(angle * to_degrees, 3));
    for (int j = 0; j < 6; ++j) add(state.z(root + j), small_load);
    table.add_row(words);
  }
  return beam.name + ": deflection and rotation of the end, loads on the root\n" + table.text() +
         "\n";
}

std::string summary(const io::Case& input, const turbine::TurbineSystem& system,
                    const StaticPath& path) {
  const model::TurbineDefinition& definition = input.turbine;
  const turbine::TurbineLayout& layout = system.layout();
  const StaticState& last = path.states.back();
  int newton_steps = 0;
  double residual = 0.0;
  for (const StaticState& state : path.states) {
    newton_steps += state.newton_steps;
    residual = std::max(residual, state.residual);
  }
  const bool by_arc = path.method == analysis::StaticMethod::arc_length;
  std::string text = title_of(input) + "\n";
  text += "loads        gravity " + general(definition.gravity, 6) + " m/s^2, " +
          count(static_cast<int>(definition.loads.size()), "prescribed load") +
          (system.turbine().air ? ", wind" : "") + "; all times the load factor\n";
  text += std::string("method       ") + (by_arc ? "arc length" : "prescribed load factors") +
          ", " + count(static_cast<int>(path.states.size()) - 1, "step") +
          (path.cuts > 0 ? ", cut " + count(path.cuts, "time") : "") + "\n";
  text += "Newton       " + count(newton_steps, "step") +
          " in total, the last one of each state below static.tolerance\n";
  text += "residual     " + scientific(residual, 1) + " [N, N m] at most; largest load " +
          general(path.load_level, 4) + "\n";
  for (const double factor : path.limit_points)
    text += "limit point  near load factor " + general(factor, 6) + "\n";
  for (const analysis::HeldCoordinate& held : path.held) {
    const bool is_zero = std::abs(held.load) <= round_off * std::max(path.load_level, 1.0);
    text += "held         " + held.name + ", which nothing restores: at 0, by " +
            (is_zero ? "0" : general(held.load, 4)) + " " + held.unit +
            (is_zero ? "" : " (not 0: no equilibrium there)") + "\n";
  }
  const auto joint = [&](const std::string& name, const elements::Hinge& hinge, int unknown) {
    if (hinge.free ? hinge.stiffness > 0.0 : last.z(unknown) != 0.0)
      text += name + std::string(13 - name.size(), ' ') + general(last.z(unknown) * to_degrees, 5) +
              " deg\n";
  };
  joint("yaw", system.turbine().chain.yaw, layout.yaw());
  joint("teeter", system.turbine().chain.teeter, layout.teeter());
  joint("shaft twist", system.turbine().chain.torsion, layout.shaft_torsion());
  return text + "\n";
}

std::string tables(const turbine::TurbineSystem& system, const StaticPath& path) {
  const model::Turbine& turbine = system.turbine();
  const turbine::TurbineLayout& layout = system.layout();
  std::string text;
  for (std::size_t k = 0; k < turbine.blades.size(); ++k)
    text += beam_table(path, turbine.blades[k], layout.blade_tip(static_cast<int>(k)),
                       layout.blade_root(static_cast<int>(k)));
  if (turbine.has_tower)
    text += beam_table(path, turbine.tower, layout.tower_tip(), layout.tower_root());
  text += "b1 b2 b3: axes of the beam's root";
  text += turbine.has_tower ? "; of the tower up, side-side (n1), downwind (n2)\n" : "\n";
  if (shown_states(path).size() < path.states.size()) text += "all states are in the result\n";
  return text;
}

}  // namespace

void run_static(const Job& job) {
  model::Turbine turbine = model::build_turbine(job.input.turbine);
  turbine.for_each_motion([](model::PrescribedMotion& motion) {
    const double angle = motion.at(0.0, 0.0).angle;
    motion = {};
    motion.angle = angle;  // at rest
  });
  const turbine::TurbineSystem system(turbine, PETSC_COMM_SELF);
  const bool is_first = petsc::Session::rank() == 0;
  Progress progress(is_first);
  const StaticPath path = analysis::find_static_path(system, job.input.statics, progress);
  progress.finish();
  if (!is_first) return;
  deliver(
      job, summary(job.input, system, path) + tables(system, path),
      [&](io::ResultFile& file) {
        file.write_model(system);
        write_masses(file, model::compute_masses(job.input.turbine, turbine));
        file.write_static(path);
        file.write_geometry(system, path);
      },
      [&](const std::string& name) { io::write_static_table(name, system, path); });
}

}  // namespace samara::drivers
