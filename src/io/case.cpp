#include "samara/io/case.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <numbers>
#include <sstream>
#include <system_error>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/io/whole_file.hpp"
#include "samara/io/yaml_tree.hpp"
#include "samara/model/validation.hpp"

#include "case_beam.hpp"
#include "case_blades.hpp"
#include "case_controls.hpp"
#include "case_joint.hpp"
#include "case_linearize.hpp"
#include "case_mass_dampers.hpp"
#include "case_transient.hpp"
#include "yaml_reader.hpp"
#include "yaml_settings.hpp"

namespace samara::io {
namespace {

using model::JointKind;

constexpr int schema_version = 1;
constexpr std::size_t max_megabytes = 16;
constexpr int min_steps = 4;
constexpr int max_steps = 10000000;
constexpr int max_load_steps = 100000;

void read_tower(const YamlNode& node, model::TurbineDefinition& turbine, ErrorList& errors) {
  turbine.has_tower = true;
  // The file states the tower in n1 n2 n3, the beam's axes are a = (n3, n1, n2).
  Matrix3 to_a;
  to_a << 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
  MapReader map(node, "tower", errors);
  read_beam(map, to_a, tower_ratios, turbine.tower);
  map.finish();
}

void read_nacelle(const YamlNode& node, model::TurbineDefinition& turbine, ErrorList& errors) {
  turbine.has_nacelle = true;
  model::NacelleDefinition& nacelle = turbine.nacelle;
  MapReader map(node, "nacelle", errors);
  map.read("mass", nacelle.mass, non_negative);
  read_vector(map, "center_of_mass", nacelle.center_of_mass, any_number);
  read_vector(map, "inertia", nacelle.inertia, non_negative);
  if (const YamlNode* entry = map.find("yaw")) {
    MapReader yaw(*entry, map.where("yaw"), errors);
    yaw.require("joint", "free, locked or prescribed");
    read_joint(yaw, nacelle.yaw);
    yaw.finish();
  }
  map.finish();
}

void read_speed(MapReader& map, double& speed) {
  constexpr NumberRule rule = non_negative;
  const YamlNode* rpm = map.node().find("speed_rpm");
  double revolutions = 0.0;
  const bool has_speed = map.read("speed", speed, rule);
  const bool has_rpm = map.read("speed_rpm", revolutions, rule);
  if (has_rpm) speed = revolutions * 2.0 * std::numbers::pi / 60.0;
  if (has_speed && has_rpm) {
    map.refuse(*rpm, "speed_rpm", "given together with speed; leave one of them out");
  }
}

void read_torsion(const YamlNode& node, const std::string& where, model::JointDefinition& torsion,
                  ErrorList& errors) {
  MapReader map(node, where, errors);
  map.require("joint", "free or locked");
  map.read("stiffness", torsion.stiffness, non_negative);
  map.read("damping", torsion.damping, non_negative);
  map.read("joint", torsion.kind, {{"free", JointKind::free}, {"locked", JointKind::locked}});
  map.finish();
}

/// Reads the keys of a torque law. A law that does not act is read, and said to have no effect.
void read_torque(MapReader& map, double speed, bool acts, model::TorqueLaw& law) {
  map.read("torque", law.torque, any_number);
  map.read("torque_slope", law.slope, any_number);
  const YamlNode* table = map.find("torque_table");
  for (const char* key : {"torque", "torque_slope", "torque_table"})
    if (const YamlNode* entry = map.node().find(key); entry != nullptr && !acts)
      map.note(*entry, key, "without effect, the generator is locked");
  if (table == nullptr) return;
  for (const char* key : {"torque", "torque_slope"})
    if (const YamlNode* entry = map.node().find(key))
      map.refuse(*entry, key, "given together with torque_table; leave one of them out");
  const std::size_t errors_before = map.errors().size();
  read_pairs(map, "torque_table", *table, {"speed", "torque"}, law.table);
  if (map.errors().size() > errors_before)
    law.table.clear();
  else if (acts && !law.table.empty() && speed == 0.0 && !law.covers(speed))
    map.note(*table, "torque_table",
             "the table reaches from " + general(law.table.front().first, 6) + " to " +
                 general(law.table.back().first, 6) + " rad/s, the rotor is parked: no torque");
}

void read_generator(const YamlNode& node, const std::string& where, model::ShaftDefinition& shaft,
                    ErrorList& errors) {
  model::GeneratorDefinition& generator = shaft.generator;
  MapReader map(node, where, errors);
  map.require("joint", "free or locked");
  map.read("joint", generator.kind, {{"free", JointKind::free}, {"locked", JointKind::locked}});
  map.read("own_inertia", generator.inertia, non_negative);
  if (const YamlNode* old = map.find("inertia"))
    map.refuse(
        *old, "inertia",
        "was counted at the speed of the shaft, gears included, and is no longer read; hint: "
        "own_inertia, of the generator about its own axis, and shaft.gear_ratio (of an "
        "OpenFAST deck GenIner and GBRatio); without gears own_inertia is the same number");
  read_torque(map, shaft.generator_speed(), generator.kind == JointKind::free, generator.law);
  map.finish();
}

void read_shaft(const YamlNode& node, model::ShaftDefinition& shaft, ErrorList& errors) {
  MapReader map(node, "shaft", errors);
  read_speed(map, shaft.speed);
  map.read("overhang", shaft.overhang, any_number);
  read_angle(map, "tilt_deg", shaft.tilt, quarter_turn);
  map.read("height", shaft.height, any_number);
  read_angle(map, "azimuth_deg", shaft.azimuth, any_number);
  map.read("mass", shaft.mass, non_negative);
  map.read("center_of_mass", shaft.center_of_mass, any_number);
  if (const YamlNode* entry = map.find("inertia")) {
    MapReader inertia(*entry, map.where("inertia"), errors);
    inertia.read("axial", shaft.inertia_axial, non_negative);
    inertia.read("lateral", shaft.inertia_lateral, non_negative);
    inertia.finish();
  }
  if (const YamlNode* entry = map.find("torsion")) {
    read_torsion(*entry, map.where("torsion"), shaft.torsion, errors);
  }
  map.read("gear_ratio", shaft.gear_ratio, any_number);
  if (const YamlNode* entry = map.find("generator")) {
    read_generator(*entry, map.where("generator"), shaft, errors);
  }
  if (const YamlNode* entry = map.find("rotor")) {
    MapReader rotor(*entry, map.where("rotor"), errors);
    read_torque(rotor, shaft.speed, true, shaft.rotor);
    rotor.read("torque_pitch_slope", shaft.rotor_pitch_slope, any_number);
    rotor.finish();
  }
  map.finish();
}

void read_teeter(const YamlNode& node, const std::string& where, model::HubDefinition& hub,
                 ErrorList& errors) {
  MapReader map(node, where, errors);
  if (node.find("joint") == nullptr) hub.teeter.kind = JointKind::free;
  read_joint(map, hub.teeter);
  if (const YamlNode* entry = map.find("stops")) {
    MapReader stops(*entry, map.where("stops"), errors);
    for (const char* key : {"angle_deg", "stiffness"}) stops.require(key);
    read_angle(stops, "angle_deg", hub.teeter_stops.angle, positive);
    stops.read("stiffness", hub.teeter_stops.stiffness, positive);
    stops.read("damping", hub.teeter_stops.damping, non_negative);
    stops.finish();
  }
  map.read("undersling", hub.undersling, any_number);
  read_angle(map, "delta3_deg", hub.delta3, quarter_turn);
  map.finish();
}

void read_hub(const YamlNode& node, model::HubDefinition& hub, ErrorList& errors) {
  MapReader map(node, "hub", errors);
  map.read("mass", hub.mass, non_negative);
  map.read("center_of_mass", hub.center_of_mass, any_number);
  read_vector(map, "inertia", hub.inertia, non_negative);
  map.read("radius", hub.radius, non_negative);
  read_mass_list(map, hub.point_masses, [](MapReader&, model::HubMassDefinition&) {});
  if (const YamlNode* entry = map.find("teeter")) {
    read_teeter(*entry, map.where("teeter"), hub, errors);
  }
  map.finish();
}

/// A tower may stand alone: nothing turns about a shaft then.
void refuse_rotor(MapReader& map, model::TurbineDefinition& turbine) {
  turbine.blades.count = 0;
  // As `modes --parked` sets it.
  const auto stands_still = [](const YamlNode& node) {
    return node.kind == YamlNode::Kind::map && node.children.size() == 1 &&
           node.children[0].key == "speed" && node.children[0].text == "0";
  };
  for (const char* key : {"shaft", "hub"})
    if (const YamlNode* node = map.find(key); node != nullptr && !stands_still(*node))
      map.refuse(*node, key, "there are no blades; hint: what stands on the tower is the nacelle");
}

/// Reads `tower`, `blades` or `blade 2`.
void read_loaded_beam(MapReader& map, const model::TurbineDefinition& turbine,
                      model::LoadDefinition& load) {
  const YamlNode* entry = map.require("beam", "tower, blades or one of them: blade 1");
  if (entry == nullptr) return;
  const std::string& text = entry->text;
  load.on_tower = text == "tower";
  if (load.on_tower || text == "blades") return;
  for (int k = 1; k <= turbine.blades.count; ++k)
    if (text == "blade " + std::to_string(k)) load.blade = k;
  if (load.blade == 0)
    map.refuse(*entry, "beam",
               "expected tower, blades or a blade from 1 to " +
                   std::to_string(turbine.blades.count) + " (blade 1), " + describe(*entry));
}

/// Reads `at`, or `from` and `to`.
void read_loaded_place(MapReader& map, model::LoadDefinition& load) {
  const YamlNode* at = map.find("at");
  const YamlNode* from = map.find("from");
  const YamlNode* to = map.find("to");
  if (at != nullptr) {
    if (map.read("at", load.from, fraction_of_one)) load.to = load.from;
    for (const auto& [key, entry] : {std::pair("from", from), std::pair("to", to)})
      if (entry != nullptr)
        map.refuse(*entry, key, "given together with at; leave one of them out");
    return;
  }
  if (from == nullptr && to == nullptr) {
    map.require("at", "a point load, or \"from\" and \"to\"");
    return;
  }
  map.require("from", "beside \"to\"");
  map.require("to", "beside \"from\"");
  const bool has_from = map.read("from", load.from, fraction_of_one);
  const bool has_to = map.read("to", load.to, fraction_of_one);
  if (has_from && has_to && !(load.from < load.to))
    map.refuse(*to, "to", "expected more than from, " + describe(*to));
}

void read_harmonic(const YamlNode& node, const std::string& where, model::LoadHistory& history,
                   ErrorList& errors) {
  MapReader map(node, where, errors);
  history.mean = 0.0;
  history.amplitude = 1.0;
  read_frequency(map, history.per_rev, history.frequency);
  map.read("amplitude", history.amplitude, any_number);
  map.read("mean", history.mean, any_number);
  read_angle(map, "phase_deg", history.phase, any_number);
  map.finish();
}

model::LoadDefinition read_load(const YamlNode& node, const std::string& where,
                                const model::TurbineDefinition& turbine, ErrorList& errors) {
  model::LoadDefinition load;
  MapReader map(node, where, errors);
  read_loaded_beam(map, turbine, load);
  read_loaded_place(map, load);
  read_vector(map, "force", load.force, any_number);
  read_vector(map, "moment", load.moment, any_number);
  if (node.find("force") == nullptr && node.find("moment") == nullptr)
    map.require("force", "or \"moment\", or both");
  map.read("follower", load.follower, {{"true", true}, {"false", false}});
  const YamlNode* harmonic = map.find("harmonic");
  const YamlNode* table = map.find("table");
  if (harmonic != nullptr && table != nullptr)
    map.refuse(*table, "table", "given together with harmonic; leave one of them out");
  else if (harmonic != nullptr)
    read_harmonic(*harmonic, map.where("harmonic"), load.history, errors);
  else if (table != nullptr)
    read_pairs(map, "table", *table, {"t", "factor"}, load.history.table);
  map.finish();
  return load;
}

void read_loads(MapReader& map, const YamlNode& list, model::TurbineDefinition& turbine) {
  if (list.kind != YamlNode::Kind::list) {
    map.refuse(list, "loads",
               "expected a list of loads (each starts with \"- \"), " + describe(list));
    return;
  }
  for (std::size_t i = 0; i < list.children.size(); ++i)
    turbine.loads.push_back(
        read_load(list.children[i], join_path(map.where("loads"), i), turbine, map.errors()));
}

void read_static(const YamlNode& node, analysis::StaticOptions& statics, ErrorList& errors) {
  MapReader map(node, "static", errors);
  map.read("steps", statics.steps, 1, max_load_steps);
  map.read(
      "method", statics.method,
      {{"load", analysis::StaticMethod::load}, {"arc_length", analysis::StaticMethod::arc_length}});
  map.read("tolerance", statics.tolerance, tolerance);
  map.read("max_steps", statics.most_steps, 1, max_steps);
  map.finish();
}

void read_trim(const YamlNode& node, analysis::TrimOptions& trim, ErrorList& errors) {
  MapReader map(node, "trim", errors);
  map.read("method", trim.method,
           {{"harmonic_balance", analysis::TrimMethod::harmonic_balance},
            {"shooting", analysis::TrimMethod::shooting}});
  const YamlNode* harmonics = map.find("harmonics");
  if (harmonics != nullptr && harmonics->text == "auto") {
    trim.automatic = true;
  } else {
    map.read("harmonics", trim.harmonics, 0, max_harmonics);
  }
  map.read("tolerance", trim.tolerance, tolerance);
  map.read("auto_tolerance", trim.auto_tolerance, tolerance);
  map.read("steps", trim.steps, min_steps, max_steps);
  map.finish();
}

void read_floquet(const YamlNode& node, analysis::FloquetOptions& floquet, ErrorList& errors) {
  MapReader map(node, "floquet", errors);
  map.read("steps", floquet.steps, min_steps, max_steps);
  map.read("period", floquet.period,
           {{"auto", analysis::FloquetPeriod::automatic},
            {"full", analysis::FloquetPeriod::full},
            {"blade", analysis::FloquetPeriod::blade}});
  int time_order = 2;
  map.read("time_order", time_order, 1, max_order);
  if (time_order != 2) {
    const YamlNode& entry = *map.node().find("time_order");
    map.refuse(entry, "time_order", "only 2 is available, " + describe(entry));
  }
  map.finish();
}

void read_turbine(const YamlNode& root, Case& result, ErrorList& errors) {
  model::TurbineDefinition& turbine = result.turbine;
  MapReader map(root, "", errors);
  map.find("samara");
  if (const YamlNode* title = map.find("title")) {
    if (title->kind != YamlNode::Kind::scalar) {
      map.refuse(*title, "title", "expected a text, " + describe(*title));
    }
    turbine.title = title->text;
  }
  map.read("gravity", turbine.gravity, non_negative);
  if (const YamlNode* node = map.find("tower")) read_tower(*node, turbine, errors);
  if (const YamlNode* node = map.find("nacelle")) read_nacelle(*node, turbine, errors);
  if (const YamlNode* node = map.find("shaft")) read_shaft(*node, turbine.shaft, errors);
  if (const YamlNode* node = map.find("hub")) read_hub(*node, turbine.hub, errors);
  // A tower may stand alone.
  if (const YamlNode* node = turbine.has_tower ? map.find("blades") : map.require("blades"))
    read_blades(*node, turbine.blades, errors);
  else
    refuse_rotor(map, turbine);
  if (const YamlNode* node = map.find("loads")) read_loads(map, *node, turbine);
  read_mass_dampers(map, turbine);
  read_controller(map, turbine);
  if (const YamlNode* node = map.find("trim")) read_trim(*node, result.trim, errors);
  if (const YamlNode* node = map.find("floquet")) read_floquet(*node, result.floquet, errors);
  if (const YamlNode* node = map.find("static")) read_static(*node, result.statics, errors);
  if (const YamlNode* node = map.find("transient"))
    read_transient(*node, turbine, result.transient, errors);
  if (const YamlNode* node = map.find("linearize"))
    read_linearize(*node, turbine, result.linearize, result.mat_path, errors);
  map.finish();
  errors.add(model::find_faults(turbine), root);
  if (errors.size() == 0) errors.add(model::complete(turbine), root);
}

/// Adds an error where `samara` is not the version this program reads. False: a newer version, of
/// which no other error would mean anything.
bool check_version(const YamlNode& root, ErrorList& errors) {
  if (root.kind != YamlNode::Kind::map) return true;
  const YamlNode* version = root.find("samara");
  const std::string current = std::to_string(schema_version);
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

std::string setting_line(const std::string& setting) { return "# --set " + setting + "\n"; }

std::string read_file(const std::string& path) {
  std::error_code error;
  const std::string with_suffix = path + ".yaml";
  if (!std::filesystem::exists(path, error) && std::filesystem::exists(with_suffix, error))
    throw InputError(path + ": no such file; did you mean \"" + with_suffix + "\"?");
  return read_whole_file(path, max_megabytes, "case file");
}

}  // namespace

Case read_case(const std::string& path, const std::vector<std::string>& settings) {
  return parse_case(path, read_file(path), settings);
}

Case parse_case(const std::string& path, const std::string& text,
                const std::vector<std::string>& settings) {
  Case result;
  result.path = path;
  result.settings = settings;
  for (const std::string& setting : settings) result.text += setting_line(setting);
  result.text += text;

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
  if (check_version(root, errors)) read_turbine(root, result, errors);
  errors.throw_if_any();
  result.model_text = model_text_of(root);
  result.notes = errors.notes();
  return result;
}

void require_valid(const Case& input, const std::vector<Fault>& faults) {
  if (faults.empty()) return;
  // The text has the settings in lines of their own in front.
  std::size_t begin = 0;
  for (const std::string& setting : input.settings) begin += setting_line(setting).size();
  ErrorList errors(input.path, input.settings);
  YamlNode root = parse_yaml(input.text.substr(begin));
  apply_settings(input.settings, root, errors);
  errors.add(faults, root);
  errors.throw_if_any();
}

}  // namespace samara::io
