// Turbines and beams of the verification cases, and the analyses in one call.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "samara/analysis/constant_modes.hpp"
#include "samara/analysis/floquet.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/base/error.hpp"
#include "samara/io/case.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace samara::test {

inline constexpr double pi = std::numbers::pi;

using Complex = std::complex<double>;

/// A case of inputs/lee2002 with keys replaced.
/// On the article's mesh and 500 steps, unless the settings say otherwise.
inline io::Case lee(const std::string& name, const std::vector<std::string>& settings) {
  std::vector<std::string> all{"blades.elements=4", "blades.order=1", "floquet.steps=500"};
  if (name != "rigid_tower") {
    all.emplace_back("tower.elements=4");
    all.emplace_back("tower.order=1");
  }
  all.insert(all.end(), settings.begin(), settings.end());
  return io::read_case(std::string(SAMARA_SOURCE_DIR) + "/inputs/lee2002/" + name + ".yaml", all);
}

/// An input without its air and on equal elements, for tests of the structure.
inline io::Case structure(const std::string& name, std::vector<std::string> settings = {}) {
  settings.emplace_back("aero=none");
  io::Case input =
      io::read_case(std::string(SAMARA_SOURCE_DIR) + "/inputs/" + name + ".yaml", settings);
  input.turbine.blades.beam.element_lengths.clear();
  return input;
}

/// The same mesh on all beams, where there is a tower.
inline std::vector<std::string> mesh(bool tower, int elements, int order) {
  std::vector<std::string> settings;
  for (const std::string& beam :
       tower ? std::vector<std::string>{"blades", "tower"} : std::vector<std::string>{"blades"}) {
    settings.push_back(beam + ".elements=" + std::to_string(elements));
    settings.push_back(beam + ".order=" + std::to_string(order));
  }
  return settings;
}

inline std::vector<std::string> with(std::vector<std::string> settings,
                                     const std::vector<std::string>& more) {
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}

inline analysis::ModeSet constant_modes_of(const model::TurbineDefinition& definition) {
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::Trim trim = analysis::find_trim(system, {}, observer);
  return analysis::find_constant_modes(system, trim.solution);
}

inline analysis::Floquet floquet_of(
    const model::TurbineDefinition& definition, int steps,
    analysis::FloquetPeriod period = analysis::FloquetPeriod::automatic,
    const analysis::TrimOptions& trim_options = {}, MPI_Comm comm = PETSC_COMM_SELF,
    int order = 2) {
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::Trim trim = analysis::find_trim(system, trim_options, observer);
  return analysis::find_floquet_modes(system, trim.solution, {steps, period, order, {}}, comm,
                                      observer);
}

/// With the options of the case.
inline analysis::Floquet floquet_of(const io::Case& input) {
  return floquet_of(input.turbine, input.floquet.steps, input.floquet.period, input.trim,
                    PETSC_COMM_SELF, input.floquet.order);
}

/// The errors of a case; empty where it has none.
inline std::string message_of(const std::string& text) {
  try {
    io::parse_case("test", text, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Frequencies of the modes whose names start with `name`, ascending [rad/s].
inline std::vector<double> frequencies(const analysis::ModeSet& set, const std::string& name = "") {
  std::vector<double> found;
  for (const analysis::Mode& mode : set.modes)
    if (mode.name.starts_with(name)) found.push_back(mode.exponent.imag());
  std::sort(found.begin(), found.end());
  return found;
}

/// The value of `found` nearest to `wanted`.
inline double nearest(const std::vector<double>& found, double wanted) {
  double best = std::numeric_limits<double>::infinity();
  for (const double value : found)
    if (std::abs(value - wanted) < std::abs(best - wanted)) best = value;
  return best;
}

/// (19) turns an exponent l into the multiplier mu of a step, mu = (1 + l dt/2) / (1 - l dt/2).
inline Complex step_map(Complex exponent, double dt) {
  return (1.0 + 0.5 * dt * exponent) / (1.0 - 0.5 * dt * exponent);
}

/// A uniform beam on a hub that turns about its first end: one blade, nothing else, no gravity.
struct BeamCase {
  double length = 1.0;
  double hub_radius = 0.0;
  double speed = 0.0;
  double mass = 1.0;
  Vector3 inertia = Vector3::Zero();  ///< about b1, b2, b3
  /// EA, GA2, GA3, GJ, EI2, EI3; 0: rigid
  Vector6 stiffness = (Vector6() << 0.0, 0.0, 0.0, 0.0, 1.0, 1.0).finished();
  Vector6 damping = Vector6::Zero();
  int elements = 8;
  int order = 3;
};

inline model::TurbineDefinition definition_of(const BeamCase& beam) {
  model::SectionDefinition section;
  for (int i = 0; i < 6; ++i) {
    section.stiffness(i, i) = beam.stiffness(i);
    section.rigid[static_cast<std::size_t>(i)] = beam.stiffness(i) == 0.0;
  }
  section.mass.diagonal() << beam.mass, beam.mass, beam.mass, beam.inertia;
  model::TurbineDefinition definition;
  definition.gravity = 0.0;
  definition.shaft.speed = beam.speed;
  definition.hub.radius = beam.hub_radius;
  definition.blades.count = 1;
  definition.blades.beam.length = beam.length;
  definition.blades.beam.elements = beam.elements;
  definition.blades.beam.order = beam.order;
  definition.blades.beam.sections = {section};
  definition.blades.beam.damping = beam.damping;
  return definition;
}

}  // namespace samara::test
