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
  std::string text;  ///< the file as read; comment lines at its top list the --set arguments and
                     ///< `polar_settings`
  std::vector<std::string> settings;  ///< the --set arguments, as given
  /// Further --set arguments: the polars of the files that the case names.
  std::vector<std::string> polar_settings;
  std::string model_text;          ///< the keys that define the model; equal for equal models
  std::vector<std::string> notes;  ///< about keys without their apparent effect, with places

  /// `text` without the lines of settings.
  std::string file_text() const;
};

/// Reads and validates a case. `settings` are `key.path=value` pairs that replace or add keys
/// before validation (`blades.elements=8`, `blades.sections.0.mass=10`). Files that the case names
/// are found from its folder.
/// @throws InputError with all errors, one per line: `path:line:column: where: what`.
Case read_case(const std::string& path, const std::vector<std::string>& settings);

/// The same for a text; `path` is its name in errors.
Case parse_case(const std::string& path, const std::string& text,
                const std::vector<std::string>& settings);

/// @throws InputError with all faults and their places in the file, if there are any
void require_valid(const Case& input, const std::vector<Fault>& faults);

}  // namespace samara::io
