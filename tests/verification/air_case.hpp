// Turbines in wind for the verification: the steady state of a case, and the NREL 5 MW rotor
// without parts that make a comparison hard.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/analysis/constant_modes.hpp"
#include "samara/analysis/floquet.hpp"
#include "samara/io/case.hpp"
#include "samara/simulation/held_air.hpp"
#include "samara/simulation/steady_state.hpp"
#include "samara/turbine/turbine_channels.hpp"

namespace samara::test {

inline std::string input_path(const std::string& name) {
  return std::string(SAMARA_SOURCE_DIR) + "/inputs/" + name + ".yaml";
}

/// A turbine with its steady state.
struct Steady {
  explicit Steady(const io::Case& given)
      : input(given),
        system(model::build_turbine(input.turbine), PETSC_COMM_SELF),
        trim(analysis::find_trim(system, input.trim, observer)) {}

  analysis::ModeSet constant_modes() const {
    return analysis::find_constant_modes(system, trim.solution);
  }
  analysis::ModeSet floquet(const analysis::FloquetOptions& options) {
    const auto held = simulation::hold_wake(system);
    return analysis::find_floquet_modes(held ? *held : system, trim.solution, options,
                                        PETSC_COMM_SELF, observer)
        .set;
  }
  /// Values of channels at t = 0.
  std::vector<double> channels(const std::vector<std::string>& names) const {
    const turbine::TurbineChannels channels(system, {}, names);
    const petsc::Handle<Vec> z = system.make_state();
    const petsc::Handle<Vec> z_dot = system.make_state();
    trim.solution.evaluate(0.0, z.get(), z_dot.get());
    std::vector<double> values(names.size());
    channels.evaluate(0.0, z.get(), z_dot.get(), values);
    return values;
  }

  analysis::Observer observer;
  io::Case input;
  turbine::TurbineSystem system;
  analysis::Trim trim;
};

/// Without any deformation.
inline void make_rigid(model::BeamDefinition& beam) {
  beam.damping.setZero();
  for (model::SectionDefinition& section : beam.sections) {
    section.rigid.fill(true);
    section.stiffness.setZero();
  }
}

/// The rotor on the ground, rigid, without cone, tilt and gravity, in axial wind.
inline io::Case rigid_rotor(const std::vector<std::string>& settings) {
  std::vector<std::string> all{"gravity=0",
                               "shaft.tilt_deg=0",
                               "blades.precone_deg=0",
                               "shaft.torsion.joint=locked",
                               "shaft.torsion.stiffness=0",
                               "shaft.torsion.damping=0",
                               "aero.airfoil_dynamics=static",
                               "aero.thrust=buhl_f"};
  all.insert(all.end(), settings.begin(), settings.end());
  io::Case input = io::read_case(input_path("nrel5mw/land"), all);
  input.turbine.has_tower = false;
  make_rigid(input.turbine.blades.beam);
  return input;
}

/// The elastic rotor on the ground in axial wind, without gravity and tilt: constant tangents.
inline io::Case rotor_in_axial_wind(const std::vector<std::string>& settings) {
  std::vector<std::string> all{"gravity=0", "shaft.tilt_deg=0", "wind.speed=10", "blades.order=2",
                               "shaft.speed_rpm=11.444"};
  all.insert(all.end(), settings.begin(), settings.end());
  io::Case input = io::read_case(input_path("nrel5mw/land"), all);
  input.turbine.has_tower = false;
  return input;
}

/// Each resolved mode of `some` that is not one of the air has an exponent among `all`, up to
/// multiples of the rotor speed and to the round-off that both estimate: a multiplier over a
/// revolution may be as small as 1e-11.
inline void require_same_exponents(const analysis::ModeSet& some, const analysis::ModeSet& all,
                                   double relative) {
  int compared = 0;
  for (const analysis::Mode& mode : some.modes) {
    if (!mode.resolved || is_of_medium(mode)) continue;
    double best = 1e300;
    double round_off = 0.0;
    for (const analysis::Mode& other : all.modes)
      for (const double sign : {1.0, -1.0}) {
        const double apart =
            std::remainder(sign * other.exponent.imag() - mode.exponent.imag(), some.rotor_speed);
        const double distance = std::hypot(other.exponent.real() - mode.exponent.real(), apart);
        if (distance >= best) continue;
        best = distance;
        round_off = std::max(mode.round_off_error, other.round_off_error);
      }
    const double size = std::abs(mode.exponent);
    BOOST_TEST_CONTEXT(mode.label << " " << mode.exponent << ", round-off " << round_off)
    BOOST_TEST(best < relative * std::max(size, some.rotor_speed) + round_off * size);
    if (round_off < relative) ++compared;
  }
  BOOST_TEST(compared >= 8);
}

}  // namespace samara::test
