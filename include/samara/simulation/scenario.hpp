// All that a run is made of: the turbine, what happens to it, and what is asked of the analyses.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "samara/analysis/options.hpp"
#include "samara/linear/linearization.hpp"
#include "samara/model/definition.hpp"
#include "samara/turbine/turbine_channels.hpp"
#include "samara/turbine/turbine_events.hpp"

namespace samara::simulation {

/// From where a transient starts.
enum class TransientOrigin {
  trim,        ///< on the periodic steady state
  undeformed,  ///< without strains, in its prescribed motion
  result,      ///< where another run ended, or on its steady state
};

/// A transient. Without a duration none is asked for.
struct TransientSetup {
  analysis::TransientOptions options;
  double checkpoint = 60.0;  ///< time between checkpoints [s]; 0: none
  TransientOrigin start = TransientOrigin::trim;
  std::string start_path;             ///< of the result that it starts from
  long output_steps = 1;              ///< between rows of the time series
  std::vector<std::string> channels;  ///< empty: all but those of stations
  turbine::ChannelStations stations;
  std::optional<math::TimeCurve> speed;   ///< of the generator [rad/s]
  std::optional<math::TimeCurve> pitch;   ///< of all blades [rad]
  std::optional<math::TimeCurve> yaw;     ///< [rad]
  std::optional<math::TimeCurve> teeter;  ///< [rad]
  std::vector<turbine::TurbineEvent> events;
};

struct LinearizeSetup {
  linear::LinearizeOptions options;
  std::vector<std::string> inputs;   ///< empty: all
  std::vector<std::string> outputs;  ///< channels; empty: all but those of stations
  turbine::ChannelStations stations;
  std::string mat_path;  ///< of a MAT-file with the same matrices; empty: none is wanted
};

/// Fields are named by the keys of a case file (docs/case_file.md) in messages.
struct Scenario {
  model::TurbineDefinition turbine;
  analysis::TrimOptions trim;
  analysis::FloquetOptions floquet;
  analysis::StaticOptions statics;
  TransientSetup transient;
  LinearizeSetup linearize;
};

/// The highest harmonic of the rotor speed among loads and prescribed motions: a trim of fewer
/// cannot follow them.
int highest_harmonic(const model::TurbineDefinition& turbine);

/// The trim's options with what the turbine asks of them.
analysis::TrimOptions trim_options(const Scenario& scenario);

/// The turbine with the motions that the transient prescribes in time.
/// @throws InputError as model::build_turbine
model::Turbine build_operated_turbine(const Scenario& scenario);

}  // namespace samara::simulation
