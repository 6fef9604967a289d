// Input of a run: the turbine, its operation and the options of the analyses.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "samara/analysis/options.hpp"
#include "samara/linear/linearization.hpp"
#include "samara/model/changing_wind.hpp"
#include "samara/model/definition.hpp"
#include "samara/model/operating_points.hpp"
#include "samara/simulation/stepped_controller.hpp"
#include "samara/turbine/turbine_channels.hpp"
#include "samara/turbine/turbine_events.hpp"

namespace samara::simulation {

/// Initial state of a transient.
enum class TransientOrigin {
  trim,        ///< on the periodic steady state
  undeformed,  ///< without strains, in its prescribed motion
  result,      ///< the end of another run, or its steady state
};

/// A transient. Without a duration there is none.
struct TransientSetup {
  analysis::TransientOptions options;
  double checkpoint = 60.0;  ///< time between checkpoints [s]; 0: none
  TransientOrigin start = TransientOrigin::trim;
  std::string start_path;             ///< path of the result that it starts from
  long output_steps = 1;              ///< steps between rows of the time series
  std::vector<std::string> channels;  ///< empty: all channels except those of stations
  turbine::ChannelStations stations;
  bool has_places = false;                ///< rows have the places of the turbine's nodes
  std::optional<math::TimeCurve> speed;   ///< speed of the generator [rad/s]
  std::optional<math::TimeCurve> pitch;   ///< pitch of all blades [rad]
  std::optional<math::TimeCurve> yaw;     ///< [rad]
  std::optional<math::TimeCurve> teeter;  ///< [rad]
  std::optional<model::WindChange> wind;  ///< instead of the mean wind
  std::vector<turbine::TurbineEvent> events;
  std::optional<ControllerSetup> controller;  ///< it sets pitch and torque of the generator
};

struct LinearizeSetup {
  linear::LinearizeOptions options;
  std::vector<std::string> inputs;   ///< empty: all
  std::vector<std::string> outputs;  ///< channels; empty: all channels except those of stations
  turbine::ChannelStations stations;
  std::string mat_path;  ///< path of a MAT-file with the same matrices; empty: none
};

/// The input of all analyses. Messages name fields by the keys of a case file (docs/case_file.md).
struct Scenario {
  model::TurbineDefinition turbine;
  analysis::TrimOptions trim;
  analysis::FloquetOptions floquet;
  analysis::StaticOptions statics;
  TransientSetup transient;
  LinearizeSetup linearize;
  model::OperatingPointsDefinition operation;
};

/// The highest harmonic of the rotor speed among loads and prescribed motions. A trim with fewer
/// harmonics cannot follow them.
int highest_harmonic(const model::TurbineDefinition& turbine);

/// The trim's options, with the harmonics that the turbine requires.
analysis::TrimOptions trim_options(const Scenario& scenario);

/// The turbine with the prescribed motions and the wind of the transient, whose files have been
/// read (io/wind_files.hpp).
/// @throws InputError as model::build_turbine, and for a box of turbulence that is smaller than the
/// rotor or too short
model::Turbine build_operated_turbine(const Scenario& scenario);

}  // namespace samara::simulation
