// Reads a case file (YAML, docs/case_file.md) into the turbine and the options of the analyses.
#pragma once

#include <string>
#include <vector>

#include "samara/base/fault.hpp"
#include "samara/simulation/scenario.hpp"

namespace samara::io {

/// A scenario as a file states it.
struct Case : simulation::Scenario {
  std::string path;
  std::string text;  ///< the file as read, with what --set changed stated in comment lines on top
  std::vector<std::string> settings;  ///< the --set arguments, as given
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

/// @throws InputError of all faults with their places in the file, if there are any
void require_valid(const Case& input, const std::vector<Fault>& faults);

}  // namespace samara::io
