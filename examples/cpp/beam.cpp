// The first bending frequencies of a uniform cantilever beam: a tower without a nacelle.
#include <cmath>
#include <cstdio>
#include <numbers>

#include <samara/analysis/constant_modes.hpp>
#include <samara/petsc/session.hpp>
#include <samara/simulation/steady_state.hpp>
#include <samara/simulation/validation.hpp>

using namespace samara;

int main() {
  const petsc::Session session({});
  const double length = 20.0;    // [m]
  const double mass = 50.0;      // [kg/m]
  const double stiffness = 1e8;  // EI [N m^2]

  simulation::Scenario scenario;
  scenario.turbine.gravity = 0.0;
  scenario.turbine.has_tower = true;
  scenario.turbine.blades.count = 0;
  model::BeamDefinition& tower = scenario.turbine.tower;
  tower.length = length;
  tower.elements = 8;
  tower.order = 2;
  model::SectionDefinition section;
  section.rigid = {true, true, true, false, false, false};  // no stretch and no shear
  section.stiffness.diagonal() << 0.0, 0.0, 0.0, 1e8, stiffness, 4.0 * stiffness;
  section.mass.diagonal() << mass, mass, mass, 2.0, 1e-3, 1e-3;
  tower.sections = {section};
  require_none(simulation::validate(scenario, simulation::Analysis::modes), "beam");

  const turbine::TurbineSystem system(model::build_turbine(scenario.turbine), PETSC_COMM_SELF);
  analysis::Observer silent;
  const analysis::Trim trim = simulation::find_trim(scenario, system, silent);
  const analysis::ModeSet set = analysis::find_constant_modes(system, trim.solution);
  // Euler and Bernoulli: omega = (beta l)^2 sqrt(EI / (m l^4)), (beta l)^2 = 3.51602, 22.03449.
  const double unit = std::sqrt(stiffness / mass) / (length * length);
  for (std::size_t m = 0; m < 4; ++m)
    std::printf("%-16s %10.4f Hz  %9.5f\n", set.modes[m].label.c_str(),
                set.modes[m].exponent.imag() / (2.0 * std::numbers::pi),
                set.modes[m].exponent.imag() / unit);
  return 0;
}
