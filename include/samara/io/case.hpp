// Reads a case file (YAML, docs/case_file.md) into the turbine and the options of the analyses.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "samara/analysis/options.hpp"
#include "samara/linear/linearization.hpp"
#include "samara/model/definition.hpp"
#include "samara/turbine/turbine_channels.hpp"
#include "samara/turbine/turbine_events.hpp"

namespace samara::io {

/// From where a transient starts.
enum class TransientOrigin {
  trim,        ///< on the periodic steady state
  undeformed,  ///< without strains, in its prescribed motion
  result,      ///< where another run ended, or on its steady state
};

/// Between restart points [s].
inline constexpr double default_checkpoint = 60.0;

struct TransientCase {
  bool is_given = false;
  analysis::TransientOptions options;
  TransientOrigin start = TransientOrigin::trim;
  std::string start_path;             ///< of that result
  long output_steps = 1;              ///< between rows of the history
  std::vector<std::string> channels;  ///< empty: all but those of stations
  turbine::ChannelStations stations;
  std::optional<math::TimeCurve> speed;   ///< of the generator [rad/s]
  std::optional<math::TimeCurve> pitch;   ///< of all blades [rad]
  std::optional<math::TimeCurve> yaw;     ///< [rad]
  std::optional<math::TimeCurve> teeter;  ///< [rad]
  std::vector<turbine::TurbineEvent> events;
};

struct LinearizeCase {
  bool is_given = false;
  linear::LinearizeOptions options;
  std::vector<std::string> inputs;   ///< empty: all
  std::vector<std::string> outputs;  ///< channels; empty: all but those of stations
  turbine::ChannelStations stations;
  std::string mat_path;  ///< empty: no MAT-file is wanted
};

struct Case {
  std::string path;
  std::string text;  ///< the file as read, with what --set changed stated in comment lines on top
  std::vector<std::string> settings;  ///< the --set arguments, as given
  model::TurbineDefinition turbine;
  analysis::TrimOptions trim;
  analysis::FloquetOptions floquet;
  analysis::StaticOptions statics;
  TransientCase transient;
  LinearizeCase linearize;
  std::string model_text;  ///< what makes the model, in one spelling: equal for equal models
  std::vector<std::string> notes;  ///< keys without the effect that they seem to have, by place
};

/// Reads and validates a case. `settings` are `key.path=value` pairs that replace or add keys
/// before validation (`blades.elements=8`, `blades.sections.0.mass=10`).
/// @throws InputError with every error found, one a line, `path:line:column: where: what`.
Case read_case(const std::string& path, const std::vector<std::string>& settings);

/// The same of a text; `path` is its name in errors.
Case parse_case(const std::string& path, const std::string& text,
                const std::vector<std::string>& settings);

}  // namespace samara::io
