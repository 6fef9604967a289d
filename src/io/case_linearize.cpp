#include "case_linearize.hpp"

#include <algorithm>
#include <numbers>

#include "case_stations.hpp"
#include "yaml_lists.hpp"

namespace samara::io {
namespace {

constexpr int most_azimuths = 3600;
constexpr int most_harmonics = 200;
constexpr int most_order = 100000;
constexpr int most_steps = 100000;

void read_forms(MapReader& map, linear::LinearizeOptions& options) {
  std::vector<std::string> forms;
  read_words(map, "forms", forms);
  const std::vector<std::pair<std::string, bool*>> known{
      {"descriptor", &options.descriptor},
      {"state_space", &options.state_space},
      {"multiblade", &options.multiblade},
      {"average", &options.average},
      {"hill", &options.hill},
      {"lyapunov_floquet", &options.lyapunov_floquet}};
  if (!forms.empty()) options.state_space = false;
  for (const std::string& form : forms) {
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&form](const auto& one) { return one.first == form; });
    if (found != known.end())
      *found->second = true;
    else
      map.refuse(*map.node().find("forms"), "forms",
                 "expected descriptor, state_space, multiblade, average, hill or lyapunov_floquet, "
                 "got \"" +
                     form + "\"");
  }
}

}  // namespace

void read_linearize(const YamlNode& node, const model::TurbineDefinition& turbine,
                    simulation::LinearizeSetup& linearize, std::string& mat_path,
                    ErrorList& errors) {
  linear::LinearizeOptions& options = linearize.options;
  MapReader map(node, "linearize", errors);
  map.read("azimuths", options.azimuths, 1, most_azimuths);
  map.read("harmonics", options.harmonics, 0, most_harmonics);
  if (2 * options.harmonics + 1 > options.azimuths) {
    const YamlNode* given = node.find("harmonics");
    if (given != nullptr)
      map.refuse(*given, "harmonics",
                 "need at least " + std::to_string(2 * options.harmonics + 1) +
                     " linearize.azimuths, there are " + std::to_string(options.azimuths));
    options.harmonics = (options.azimuths - 1) / 2;
  }
  read_words(map, "inputs", linearize.inputs);
  read_words(map, "outputs", linearize.outputs);
  read_stations(map, turbine, linearize.stations);
  read_forms(map, options);
  map.read("hill_harmonics", options.hill_harmonics, 1, most_harmonics);
  map.read("lyapunov_floquet_steps", options.lyapunov_floquet_steps, 16, most_steps);
  map.read("lyapunov_floquet_states", options.lyapunov_floquet_states, 1, most_order);
  read_numbers(map, "at_deg", any_number, options.at);
  for (double& azimuth : options.at) azimuth *= std::numbers::pi / 180.0;
  if (const YamlNode* reduce = map.find("reduce")) {
    MapReader entry(*reduce, map.where("reduce"), errors);
    entry.require("order", "the number of states");
    entry.read("order", options.order, 1, most_order);
    entry.read("method", options.reduction,
               {{"balanced", linear::ReductionMethod::balanced},
                {"modal", linear::ReductionMethod::modal}});
    entry.finish();
  }
  if (const YamlNode* mat = map.find("mat")) {
    if (mat->kind != YamlNode::Kind::scalar || mat->text.empty())
      map.refuse(*mat, "mat", "expected the name of a file, " + describe(*mat));
    mat_path = mat->text;
  }
  map.finish();
}

}  // namespace samara::io
