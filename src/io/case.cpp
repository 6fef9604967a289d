#include "samara/io/case.hpp"

#include <filesystem>
#include <system_error>

#include "samara/base/error.hpp"
#include "samara/io/whole_file.hpp"
#include "samara/io/yaml_tree.hpp"
#include "samara/model/validation.hpp"
#include "samara/simulation/scenario_fields.hpp"

#include "case_polars.hpp"
#include "case_version.hpp"
#include "field_reader.hpp"
#include "model_text.hpp"
#include "yaml_reader.hpp"
#include "yaml_settings.hpp"

namespace samara::io {
namespace {

constexpr std::size_t max_megabytes = 16;

void read_scenario(const YamlNode& root, Case& result, ErrorList& errors) {
  MapReader map(root, "", errors);
  map.find("samara");
  FieldReader fields(map);
  simulation::declare(fields, result);
  map.finish();
  errors.add(model::find_faults(result.turbine), root);
  errors.note(model::find_notes(result.turbine), root);
  if (errors.size() == 0) errors.add(model::complete(result.turbine), root);
}

/// Adds an error if `samara` is not the version that this program reads. Returns false for a newer
/// version: other errors would then be meaningless.
bool check_version(const YamlNode& root, ErrorList& errors) {
  if (root.kind != YamlNode::Kind::map) return true;
  const YamlNode* version = root.find("samara");
  const std::string current = std::to_string(case_version);
  if (version == nullptr) {
    errors.add(
        root.place, "",
        "missing key \"samara\" (the version of the case file: write `samara: " + current + "`)");
    return true;
  }
  const std::string& text = version->text;
  const bool is_number = version->kind == YamlNode::Kind::scalar && !version->quoted &&
                         !text.empty() && text.find_first_not_of("0123456789") == text.npos;
  if (is_number && text == current) return true;
  if (is_number && text.find_first_not_of('0') != text.npos) {
    errors.add(version->place, "samara",
               "version " + text + " of the case file is newer than this program, which reads " +
                   current + "; use a newer samara");
    return false;
  }
  errors.add(version->place, "samara",
             "expected the version of the case file, " + current + ", " + describe(*version));
  return true;
}

/// The lines above the text of a case.
std::string setting_lines(const Case& input) {
  std::string lines;
  for (const std::vector<std::string>* settings : {&input.settings, &input.polar_settings})
    for (const std::string& setting : *settings) lines += "# --set " + setting + "\n";
  return lines;
}

std::string read_file(const std::string& path) {
  std::error_code error;
  const std::string with_suffix = path + ".yaml";
  if (!std::filesystem::exists(path, error) && std::filesystem::exists(with_suffix, error))
    throw InputError(path + ": no such file; did you mean \"" + with_suffix + "\"?");
  return read_whole_file(path, max_megabytes, "case file");
}

}  // namespace

std::string Case::file_text() const { return text.substr(setting_lines(*this).size()); }

Case read_case(const std::string& path, const std::vector<std::string>& settings) {
  return parse_case(path, read_file(path), settings);
}

Case parse_case(const std::string& path, const std::string& text,
                const std::vector<std::string>& settings) {
  Case result;
  result.path = path;
  result.settings = settings;
  ErrorList errors(path, settings);
  YamlNode root;
  try {
    root = parse_yaml(text);
  } catch (const YamlError& error) {
    errors.add(error.place, "", error.what());
    errors.throw_if_any();
  }
  if (root.kind == YamlNode::Kind::empty) {
    throw InputError(path + ": the file is empty, expected a case (docs/case_file.md)");
  }
  if (root.kind == YamlNode::Kind::map) apply_settings(settings, root, errors);
  if (check_version(root, errors)) {
    result.polar_settings = embed_polars(path, root, errors);
    read_scenario(root, result, errors);
  }
  errors.throw_if_any();
  result.text = setting_lines(result) + text;
  result.model_text = model_text_of(root);
  result.notes = errors.notes();
  return result;
}

void require_valid(const Case& input, const std::vector<Fault>& faults) {
  if (faults.empty()) return;
  ErrorList errors(input.path, input.settings);
  YamlNode root = parse_yaml(input.file_text());
  apply_settings(input.settings, root, errors);
  errors.add(faults, root);
  errors.throw_if_any();
}

}  // namespace samara::io
