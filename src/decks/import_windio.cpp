#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "samara/base/error.hpp"
#include "samara/base/number.hpp"
#include "samara/io/whole_file.hpp"
#include "samara/io/yaml_tree.hpp"
#include "samara/model/airfoil.hpp"
#include "samara/model/definition.hpp"

#include "import_air.hpp"
#include "import_common.hpp"

namespace samara::decks {
namespace {

constexpr double straight_tolerance = 1e-9;

/// Coordinates up to this size are round-off [of the length].
constexpr double no_distance = 1e-14;

/// More mass per length [kg/m] than any tower or monopile of steel has.
constexpr double most_mass = 1e5;

/// Largest difference of the stated and the derived height of the hub [m].
constexpr double height_tolerance = 1e-3;

constexpr double degrees = 180.0 / std::numbers::pi;

constexpr std::size_t max_megabytes = 64;

struct Material {
  double density = 0.0;
  double young = 0.0;
  double shear = 0.0;
};

std::string read_text(const std::string& path) {
  std::string text = io::read_whole_file(path, max_megabytes, "deck");
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  return text;
}

io::YamlNode parse_deck(const std::string& path) {
  try {
    return io::parse_yaml(read_text(path));
  } catch (const io::YamlError& error) {
    const std::string line =
        error.place.line > 0 ? ":" + std::to_string(error.place.line) : std::string();
    throw InputError(path + line + ": " + error.what());
  }
}

/// YAML 1.1 has "15.e+6" and "+1."; from_chars reads all but the sign.
std::optional<double> number_of(const io::YamlNode& node) {
  if (node.kind != io::YamlNode::Kind::scalar || node.quoted) return {};
  return parse_number(node.text);
}

class Importer {
 public:
  Importer(std::string path, const ImportOptions& options)
      : path_(std::move(path)), options_(options), root_(parse_deck(path_)) {}

  Import run() {
    if (root_.find("components") == nullptr)
      throw InputError(path_ + ": missing key \"components\": not a turbine of windIO");
    refuse_duplicates(root_, "");
    read_version();
    refuse_layups();
    read_top();
    read_supports();
    const bool has_rotor = find("components.blade") != nullptr;
    turbine_.has_nacelle = has_rotor;
    if (!has_rotor) turbine_.blades.count = 0;
    if (has_rotor) {
      read_rotor();
      read_nacelle();
      read_hub();
    } else if (find("components.tower") == nullptr) {
      errors_.add(path_, "missing keys \"components.blade\" and \"components.tower\"");
    } else {
      warn(path_, "note: no components.blade: the case is the tower alone, without anything on it");
      for (const auto& [key, numbers] : options_.stated)
        errors_.add(path_, key +
                               ": the deck has no blade, the case is a tower without anything on "
                               "it; hint: leave out the quantities that the command line states");
    }
    if (has_rotor || find("components.tower") != nullptr) read_tower();
    if (has_rotor) read_blade();
    if (has_rotor && errors_.empty()) read_air();
    errors_.throw_if_any();
    warn_of_left_out();
    report_rest(root_, "");
    Import result;
    comments_.head = {
        "Imported by samara from windIO " + std::string(is_first_ ? "1.0" : "2.0") + ", " +
            clean_text(std::filesystem::path(path_).filename().string()) + ".",
        "Every key is explained in docs/case_file.md, the import in docs/import.md. SI units."};
    const BeamMass tower = integrate_mass(turbine_.tower, turbine_.tower.length);
    const BeamMass blade = integrate_mass(turbine_.blades.beam, turbine_.blades.beam.length);
    comments_.head.push_back("Masses [kg]: tower " + rounded(tower.mass) +
                             (has_rotor ? ", each blade " + rounded(blade.mass) + ", hub " +
                                              rounded(turbine_.hub.mass) + ", nacelle " +
                                              rounded(turbine_.nacelle.mass)
                                        : std::string()) +
                             ".");
    comments_.head.insert(comments_.head.end(), head_.begin(), head_.end());
    result.text = io::write_case_text(turbine_, comments_);
    result.report = std::move(report_);
    result.warnings = std::move(warnings_);
    check_import(result);
    return result;
  }

 private:
  // ---- the tree

  using Paths = std::vector<std::string>;

  const io::YamlNode* find(const std::string& path) const {
    const io::YamlNode* node = &root_;
    std::size_t start = 0;
    while (node != nullptr && start <= path.size()) {
      const std::size_t end = std::min(path.find('.', start), path.size());
      node = node->find(path.substr(start, end - start));
      start = end + 1;
    }
    return node;
  }

  /// The first of several spellings; empty where the deck has none of them.
  std::string choose(const Paths& paths) const {
    for (const std::string& path : paths)
      if (const io::YamlNode* node = find(path);
          node != nullptr && node->kind != io::YamlNode::Kind::empty)
        return path;
    return "";
  }

  std::string place(const io::YamlNode& node) const {
    return path_ + (node.place.line > 0 ? ":" + std::to_string(node.place.line) : std::string());
  }

  void refuse(const std::string& path, const std::string& what) {
    const io::YamlNode* node = find(path);
    errors_.add(node == nullptr ? path_ : place(*node), path + ": " + what);
  }

  /// The first spelling that is there. If there is none, an error names all of them.
  std::string require(const Paths& paths) {
    std::string path = choose(paths);
    if (path.empty()) {
      std::string words;
      for (const std::string& candidate : paths)
        words += (words.empty() ? "\"" : " or \"") + candidate + "\"";
      errors_.add(path_, "missing key " + words);
    }
    return path;
  }

  void say(const std::string& path, Fate fate, const std::string& words) {
    const io::YamlNode* node = find(path);
    if (node == nullptr) return;
    used_.insert(path);
    report_.push_back({place(*node), path, fate, words});
  }

  void note(const std::string& key, const std::string& words) { comments_.keys[key] = words; }

  /// Refuses keys that are given twice: only one of the values would be read.
  void refuse_duplicates(const io::YamlNode& node, const std::string& path) {
    for (const io::YamlNode& child : node.children) {
      const std::string below =
          child.key.empty() ? path : (path.empty() ? child.key : path + "." + child.key);
      if (node.kind == io::YamlNode::Kind::map && node.find(child.key) != &child)
        errors_.add(place(child), below + ": given twice, first in line " +
                                      std::to_string(node.find(child.key)->place.line));
      refuse_duplicates(child, below);
    }
  }

  /// The place of the comment behind a key of the case.
  static std::string comment_place(const std::string& key) {
    return key == "shaft.generator.own_inertia" ? "shaft.generator" : key;
  }

  /// A value that a deck may leave out is 0 in the case, with a note.
  void missing(const std::string& what, const std::string& key) {
    note(comment_place(key), "not in the deck");
    report_.push_back({path_, what, Fate::ignored, "not in the deck: " + key + " is 0"});
    std::string hint;
    for (const StatedQuantity& quantity : stated_quantities())
      if (key == quantity.key) hint = std::string("; hint: --") + quantity.option + " states it";
    warn(path_, "warning: " + what + " is not in the deck: " + key + " is 0" + hint);
  }

  void warn(const std::string& place, const std::string& words) {
    warnings_.push_back(place + ": " + words);
  }

  /// A value of the command line replaces that of the deck.
  template <class Value>
  void apply_stated(const std::string& key, Value& value) {
    const auto found = options_.stated.find(key);
    if (found == options_.stated.end()) return;
    if constexpr (std::is_same_v<Value, double>)
      value = found->second[0];
    else
      value = Eigen::Map<const Value>(found->second.data());
    note(comment_place(key), "from the command line");
  }
  bool is_stated(const std::string& key) const { return options_.stated.contains(key); }

  double number_at(const std::string& path, const io::YamlNode& node) {
    const std::optional<double> value = number_of(node);
    if (!value)
      errors_.add(place(node),
                  path + ": expected a number" +
                      (node.kind == io::YamlNode::Kind::scalar ? ", got \"" + node.text + "\""
                                                               : std::string()));
    return value.value_or(0.0);
  }

  double number(const Paths& paths, Fate fate, const std::string& words) {
    const std::string path = require(paths);
    if (path.empty()) return 0.0;
    const double value = number_at(path, *find(path));
    say(path, fate, words);
    return value;
  }

  std::vector<double> numbers_at(const std::string& path, const io::YamlNode& node) {
    std::vector<double> values;
    if (node.kind != io::YamlNode::Kind::list) {
      errors_.add(place(node), path + ": expected a list of numbers");
      return values;
    }
    for (const io::YamlNode& child : node.children) values.push_back(number_at(path, child));
    return values;
  }

  /// `grid` and a list of the same size.
  Curve curve(const std::string& path, const std::string& values_key = "values") {
    Curve result;
    const io::YamlNode* node = find(path);
    const io::YamlNode* grid = node == nullptr ? nullptr : node->find("grid");
    const io::YamlNode* values = node == nullptr ? nullptr : node->find(values_key);
    if (grid == nullptr || values == nullptr) {
      errors_.add(node == nullptr ? path_ : place(*node),
                  path + ": missing key \"" + (grid == nullptr ? "grid" : values_key) + "\"");
      return {{0.0, 1.0}, {0.0, 0.0}};
    }
    result.grid = numbers_at(path + ".grid", *grid);
    result.values = numbers_at(path + "." + values_key, *values);
    if (result.grid.size() != result.values.size() || result.grid.empty()) {
      errors_.add(place(*values), path + ": grid has " + std::to_string(result.grid.size()) +
                                      " places, " + values_key + " " +
                                      std::to_string(result.values.size()));
      return {{0.0, 1.0}, {0.0, 0.0}};
    }
    for (std::size_t i = 0; i < result.grid.size(); ++i)
      if (result.grid[i] < 0.0 || result.grid[i] > 1.0 ||
          (i > 0 && result.grid[i] < result.grid[i - 1])) {
        errors_.add(place(*grid), path +
                                      ".grid: expected places from 0 to 1 that do not "
                                      "decrease, got " +
                                      rounded(result.grid[i]));
        return {{0.0, 1.0}, {0.0, 0.0}};
      }
    return result;
  }

  // ---- the top

  /// Comes first: other corrections of such a deck would not help.
  void refuse_layups() {
    const io::YamlNode* blade = find("components.blade");
    if (blade == nullptr || !choose(blade_matrices()).empty()) return;
    const std::string key = is_first_ ? "components.blade.elastic_properties_mb.six_x_six"
                                      : "components.blade.structure.elastic_properties";
    const bool has_layers = !choose({"components.blade.structure.layers",
                                     "components.blade.internal_structure_2d_fem.layers"})
                                 .empty();
    throw InputError(place(*blade) + ": missing key \"" + key + "\"" +
                     (has_layers ? ": the deck states the lay-up of the blade alone, from which "
                                   "sections are not computed"
                                 : ""));
  }

  void read_version() {
    const io::YamlNode* version = root_.find("windIO_version");
    is_first_ = version == nullptr || version->text.starts_with("1");
    if (!is_first_ && !version->text.starts_with("2"))
      errors_.add(place(*version),
                  "windIO_version: 1.0 and 2.0 can be read, got \"" + version->text + "\"");
    if (version != nullptr)
      say("windIO_version", Fate::derived,
          is_first_ ? "angles are in radians" : "angles are in degrees");
  }

  double to_degrees(double angle) const { return is_first_ ? angle * degrees : angle; }

  void read_top() {
    if (const io::YamlNode* name = root_.find("name")) {
      turbine_.title = clean_text(name->text);
      say("name", Fate::taken, "title");
    }
    if (find("environment.gravity") != nullptr) {
      turbine_.gravity = number({"environment.gravity"}, Fate::taken, "gravity");
      note("gravity", "environment.gravity");
    } else {
      note("gravity", "not in the deck");
    }
    if (find("components.blade") == nullptr) return;
    const std::string orientation = require({"assembly.rotor_orientation"});
    if (orientation.empty()) return;
    std::string word = find(orientation)->text;
    std::transform(word.begin(), word.end(), word.begin(),
                   [](char c) { return static_cast<char>(std::tolower(c)); });
    if (word != "upwind" && word != "downwind")
      refuse(orientation, "expected Upwind or Downwind, got \"" + find(orientation)->text + "\"");
    is_upwind_ = word != "downwind";
    say(orientation, Fate::derived,
        is_upwind_ ? "overhang, tilt and precone are negative"
                   : "overhang, tilt, precone positive");
  }

  /// The structure below the tower cannot be imported.
  void read_supports() {
    for (const char* name : {"monopile", "jacket", "floating_platform"}) {
      const std::string path = std::string("components.") + name;
      if (find(path) == nullptr) continue;
      if (options_.tower_only) {
        say(path, Fate::ignored, "--tower-only: the tower is clamped at its foot");
        warn(place(*find(path)), path + ": note: left out, the tower is clamped at its foot; " +
                                     "tower.support of the case can state a foundation");
        continue;
      }
      refuse(path, "a foundation cannot be imported" + implausible(path) +
                       "; hint: --tower-only leaves it out and clamps the tower at its foot");
    }
  }

  /// Text about a mass per length that no foundation has; empty if there is no such mass.
  std::string implausible(const std::string& path) {
    const std::string inertia = choose({path + ".structure.elastic_properties.inertia_matrix.mass",
                                        path + ".elastic_properties.inertia_matrix.mass"});
    if (inertia.empty()) return "";
    double most = 0.0;
    for (const io::YamlNode& value : find(inertia)->children)
      most = std::max(most, std::abs(number_of(value).value_or(0.0)));
    return most > most_mass ? " (its mass of up to " + rounded(most) + " kg/m is implausible, too)"
                            : "";
  }

  // ---- bodies

  /// The speed of the rotor at the greatest tip speed [rev/min]; empty where the deck has none.
  std::optional<double> speed_of_tip(const std::string& use) {
    if (choose({"control.supervisory.maxTS"}).empty() ||
        choose({"assembly.rotor_diameter"}).empty())
      return {};
    const double tip_speed = number({"control.supervisory.maxTS"}, Fate::derived, use);
    const double diameter = number({"assembly.rotor_diameter"}, Fate::derived, use);
    if (diameter > 0.0) return 60.0 * tip_speed / (std::numbers::pi * diameter);
    refuse("assembly.rotor_diameter", "expected a number > 0");
    return 0.0;
  }

  /// The greatest tip speed may be reached below the greatest speed of the controller. A small
  /// difference is the rounding of the diameter.
  void limit_to_tip_speed(double& rpm) {
    constexpr double rounding = 0.98;
    const std::optional<double> limit =
        speed_of_tip("limits shaft.speed_rpm to maxTS/(rotor_diameter/2)");
    if (!limit || !(*limit > 0.0 && *limit < rounding * rpm)) return;
    rpm = *limit;
    note("shaft.speed_rpm",
         "from the greatest tip speed, control.supervisory.maxTS; VS_maxspd is beyond it");
  }

  void read_rotor() {
    double rpm = 0.0;  // [rev/min]
    const std::string count = require({"assembly.number_of_blades"});
    if (!count.empty()) {
      const double value = number_at(count, *find(count));
      if (!(value >= 1.0 && value <= 100.0 && value == std::floor(value)))
        refuse(count, "expected an integer from 1 to 100");
      else
        turbine_.blades.count = static_cast<int>(value);
      say(count, Fate::taken, "blades.count");
      note("blades.count", "assembly.number_of_blades");
    }
    if (const std::string speed = choose({"control.rated_rotor_speed"}); !speed.empty()) {
      rpm = number({speed}, Fate::taken, "shaft.speed_rpm, the rated one");
      note("shaft.speed_rpm", "control.rated_rotor_speed");
    } else if (const std::string torque = choose({"control.torque.VS_maxspd"}); !torque.empty()) {
      const double value = number({torque}, is_first_ ? Fate::derived : Fate::taken,
                                  is_first_ ? "shaft.speed_rpm, from rad/s" : "shaft.speed_rpm");
      rpm = is_first_ ? value * 30.0 / std::numbers::pi : value;
      note("shaft.speed_rpm",
           is_first_ ? "control.torque.VS_maxspd, from rad/s" : "control.torque.VS_maxspd");
      limit_to_tip_speed(rpm);
    } else if (const std::optional<double> limit =
                   speed_of_tip("shaft.speed_rpm = maxTS/(rotor_diameter/2)")) {
      rpm = *limit;
      note("shaft.speed_rpm", "from the greatest tip speed, control.supervisory.maxTS");
    } else if (!is_stated("shaft.speed_rpm")) {
      missing("the rated rotor speed", "shaft.speed_rpm");
    }
    apply_stated("shaft.speed_rpm", rpm);
    turbine_.shaft.speed = fields::rpm.to_si(rpm);
    const double sign = is_upwind_ ? -1.0 : 1.0;
    const double tilt = to_degrees(number(
        {"components.drivetrain.outer_shape.uptilt", "components.drivetrain.outer_shape_bem.uptilt",
         "components.nacelle.drivetrain.uptilt", "components.nacelle.drivetrain.uptilt_angle",
         "components.nacelle.outer_shape_bem.uptilt_angle",
         "components.nacelle.outer_shape_bem.uptilt"},
        Fate::derived, "shaft.tilt_deg, < 0 upwind"));
    const double overhang = number(
        {"components.drivetrain.outer_shape.overhang",
         "components.drivetrain.outer_shape_bem.overhang", "components.nacelle.drivetrain.overhang",
         "components.nacelle.outer_shape_bem.overhang"},
        Fate::derived, "shaft.overhang = overhang/cos(uptilt), < 0 upwind");
    const double rise =
        number({"components.drivetrain.outer_shape.distance_tt_hub",
                "components.drivetrain.outer_shape_bem.distance_tt_hub",
                "components.nacelle.drivetrain.distance_tt_hub",
                "components.nacelle.outer_shape_bem.distance_tt_hub"},
               Fate::derived, "shaft.height = distance_tt_hub - overhang tan(uptilt)");
    if (std::abs(tilt) >= 90.0) {
      errors_.add(path_,
                  "uptilt: expected an angle between -90 and 90 degrees, got " + rounded(tilt));
      return;
    }
    turbine_.shaft.tilt = fields::deg.to_si(sign * tilt);
    turbine_.shaft.overhang = sign * overhang / std::cos(tilt / degrees);
    turbine_.shaft.height = rise - overhang * std::tan(tilt / degrees);
    note("shaft.tilt_deg", "uptilt");
    note("shaft.overhang", "overhang/cos(uptilt)");
    note("shaft.height", "distance_tt_hub - overhang tan(uptilt)");
    note("shaft.azimuth_deg", "not in the deck");
    note("shaft.torsion", "the rotor turns at constant speed");
    for (const char* key : {"spring_constant", "damping_coefficient"})
      for (const char* block : {"components.drivetrain.elastic_properties.",
                                "components.nacelle.elastic_properties_mb."})
        say(std::string(block) + key, Fate::ignored, "shaft torsion is locked");
  }

  /// The moments of inertia Ixx, Iyy, Izz of a body; products are reported as left out.
  Vector3 inertia_of(const std::string& path, const std::string& words) {
    Vector3 inertia = Vector3::Zero();
    if (path.empty()) return inertia;
    const std::vector<double> values = numbers_at(path, *find(path));
    if (values.size() != 3 && values.size() != 6) {
      refuse(path, "expected 3 or 6 numbers");
      return inertia;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      inertia(static_cast<Eigen::Index>(i)) = values[i];
      if (values[i] < 0.0) refuse(path, "expected moments of inertia >= 0");
    }
    double products = 0.0;
    for (std::size_t i = 3; i < values.size(); ++i)
      products = std::max(products, std::abs(values[i]));
    say(path, Fate::derived,
        words + (products > 0.0 ? "; the products of inertia, up to " + rounded(products) +
                                      " kg m^2, are left out: a case has none"
                                : ""));
    return inertia;
  }

  Vector3 point_of(const std::string& path, const std::string& words) {
    Vector3 point = Vector3::Zero();
    if (path.empty()) return point;
    const io::YamlNode& node = *find(path);
    const std::vector<double> values = node.kind == io::YamlNode::Kind::scalar
                                           ? std::vector<double>{number_at(path, node)}
                                           : numbers_at(path, node);
    if (values.empty() || values.size() > 3) refuse(path, "expected up to 3 numbers");
    for (std::size_t i = 0; i < std::min<std::size_t>(values.size(), 3); ++i)
      point(static_cast<Eigen::Index>(i)) = values[i];
    say(path, Fate::derived, words);
    return point;
  }

  /// The path of a key of a block by either of its names; empty where `block` is empty.
  std::string choose_in(const std::string& block, const char* key, const char* other) {
    return block.empty() ? std::string() : choose({block + key, block + other});
  }

  /// Mass, centre and inertia of the nacelle, each from the deck or from the command line.
  void read_nacelle_body() {
    const std::string block = choose({"components.drivetrain.elastic_properties",
                                      "components.drivetrain.elastic_properties_mb",
                                      "components.nacelle.elastic_properties_mb"});
    const std::string mass = choose_in(block, ".mass", ".system_mass");
    if (!mass.empty()) {
      turbine_.nacelle.mass = number({mass}, Fate::taken, "nacelle.mass");
      note("nacelle.mass", "without the yaw bearing");
    } else if (!is_stated("nacelle.mass")) {
      missing("the mass of the nacelle (components.drivetrain.elastic_properties)", "nacelle.mass");
    }
    apply_stated("nacelle.mass", turbine_.nacelle.mass);
    if (turbine_.nacelle.mass < 0.0)
      errors_.add(path_,
                  "nacelle.mass: expected a number >= 0, got " + rounded(turbine_.nacelle.mass));

    const std::string location = choose_in(block, ".location", ".system_center_mass");
    const bool has_body = !mass.empty() || is_stated("nacelle.mass");
    const Vector3 center =
        point_of(location, "nacelle.center_of_mass = [-y, x, z] (y is to the left)");
    turbine_.nacelle.center_of_mass = {-center(1), center(0), center(2)};
    if (!location.empty())
      note("nacelle.center_of_mass", "-y, x, z of windIO");
    else if (has_body && !is_stated("nacelle.center_of_mass"))
      missing("the centre of mass of the nacelle", "nacelle.center_of_mass");
    apply_stated("nacelle.center_of_mass", turbine_.nacelle.center_of_mass);

    const std::string own = choose_in(block, ".inertia", ".system_inertia");
    const std::string about_top = choose_in(block, ".inertia_tt", ".system_inertia_tt");
    if (!own.empty()) {
      const Vector3 inertia =
          inertia_of(own, "nacelle.inertia = [Iyy, Ixx, Izz], about its own centre");
      turbine_.nacelle.inertia = {inertia(1), inertia(0), inertia(2)};
      say(about_top, Fate::ignored, "the same body about the tower top");
      note("nacelle.inertia", "Iyy, Ixx, Izz, about its own centre");
    } else if (!about_top.empty() && !is_stated("nacelle.inertia")) {
      const Vector3 inertia =
          inertia_of(about_top,
                     "nacelle.inertia, moved from the tower top to its own centre, about which it "
                     "is not in the deck");
      const Vector3& arm = turbine_.nacelle.center_of_mass;
      turbine_.nacelle.inertia =
          Vector3(inertia(1), inertia(0), inertia(2)) -
          turbine_.nacelle.mass * (Vector3::Constant(arm.squaredNorm()) - arm.cwiseProduct(arm));
      if (turbine_.nacelle.inertia.minCoeff() < 0.0)
        refuse(about_top, "less than the mass times its squared distance, which no body has");
      note("nacelle.inertia", "Iyy, Ixx, Izz, moved from the tower top to its own centre");
    } else if (has_body && !is_stated("nacelle.inertia")) {
      missing("the inertia of the nacelle", "nacelle.inertia");
    }
    apply_stated("nacelle.inertia", turbine_.nacelle.inertia);
    require_inertia("nacelle.inertia", turbine_.nacelle.inertia);
  }

  void require_inertia(const std::string& key, const Vector3& inertia) {
    if (is_stated(key) && inertia.minCoeff() < 0.0)
      errors_.add(path_, key + ": expected moments of inertia >= 0");
  }

  void read_nacelle() {
    read_nacelle_body();
    note("nacelle.yaw", "the yaw drive is not in the deck");
    const std::string yaw = choose({"components.yaw.elastic_properties.mass",
                                    "components.nacelle.elastic_properties_mb.yaw_mass"});
    if (!yaw.empty()) {
      turbine_.tower.tip_mass = number({yaw}, Fate::taken, "tower.tip_mass");
      note("tower.tip_mass", yaw.substr(yaw.find('.') + 1));
    } else if (!is_stated("tower.tip_mass")) {
      missing("the mass of the yaw bearing", "tower.tip_mass");
    }
    apply_stated("tower.tip_mass", turbine_.tower.tip_mass);
    const std::string generator =
        choose({"components.drivetrain.generator.elastic_properties.inertia",
                "components.drivetrain.generator.elastic_properties_mb.rotor_inertia",
                "components.nacelle.generator.elastic_properties_mb.rotor_inertia"});
    const std::string gear = choose(
        {"components.drivetrain.gearbox.gear_ratio", "components.nacelle.drivetrain.gear_ratio"});
    if (!gear.empty() || !generator.empty()) {
      const std::size_t errors_before = errors_.size();
      turbine_.shaft.gear_ratio = number(
          {"components.drivetrain.gearbox.gear_ratio", "components.nacelle.drivetrain.gear_ratio"},
          Fate::taken, "shaft.gear_ratio");
      if (turbine_.shaft.gear_ratio == 0.0 && errors_.size() == errors_before)
        refuse(gear, "expected a number other than 0");
      note("shaft.gear_ratio", "gear_ratio");
    }
    if (!generator.empty()) {
      const Vector3 inertia =
          inertia_of(generator, "shaft.generator.own_inertia = Ixx; its mass is the nacelle's");
      turbine_.shaft.generator.inertia = inertia(0);
      note("shaft.generator", "generator Ixx");
    } else if (!is_stated("shaft.generator.own_inertia")) {
      missing("the inertia of the generator", "shaft.generator.own_inertia");
    }
    apply_stated("shaft.generator.own_inertia", turbine_.shaft.generator.inertia);
  }

  void read_hub() {
    const double cone = to_degrees(
        number({"components.hub.cone_angle"}, Fate::derived, "blades.precone_deg, < 0 upwind"));
    if (std::abs(cone) >= 90.0)
      refuse("components.hub.cone_angle", "expected an angle between -90 and 90 degrees");
    turbine_.blades.precone = fields::deg.to_si(is_upwind_ ? -cone : cone);
    note("blades.precone_deg", "hub.cone_angle");
    note("blades.pitch_deg", "not in the deck");
    turbine_.hub.radius =
        0.5 * number({"components.hub.diameter"}, Fate::derived, "hub.radius, half of it");
    note("hub.radius", "half of hub.diameter");
    read_hub_body();
  }

  /// Mass, centre and inertia of the hub, each from the deck or from the command line.
  void read_hub_body() {
    const std::string block =
        choose({"components.hub.elastic_properties", "components.hub.elastic_properties_mb"});
    const std::string mass = choose_in(block, ".mass", ".system_mass");
    if (!mass.empty())
      turbine_.hub.mass = number({mass}, Fate::taken, "hub.mass");
    else if (!is_stated("hub.mass"))
      missing("the mass of the hub (components.hub.elastic_properties)", "hub.mass");
    apply_stated("hub.mass", turbine_.hub.mass);
    if (turbine_.hub.mass < 0.0)
      errors_.add(path_, "hub.mass: expected a number >= 0, got " + rounded(turbine_.hub.mass));

    const bool has_body = !mass.empty() || is_stated("hub.mass");
    const std::string location = choose_in(block, ".location", ".system_center_mass");
    const Vector3 center =
        point_of(location, "hub.center_of_mass (x from the apex toward the nacelle)");
    if (center(1) != 0.0 || center(2) != 0.0)
      refuse(location, "the centre of mass is off the shaft, which a case cannot state");
    turbine_.hub.center_of_mass = is_upwind_ ? center(0) : -center(0);
    if (!location.empty())
      note("hub.center_of_mass", "from the apex");
    else if (has_body && !is_stated("hub.center_of_mass"))
      missing("the hub's centre of mass", "hub.center_of_mass");
    apply_stated("hub.center_of_mass", turbine_.hub.center_of_mass);

    const std::string path = choose_in(block, ".inertia", ".system_inertia");
    if (!path.empty() && !is_stated("hub.inertia")) {
      const Vector3 inertia =
          inertia_of(path,
                     "hub.inertia = [Iyy, Ixx, Izz] - mass x^2 across the shaft: from the apex to "
                     "its own centre");
      const double shift =
          turbine_.hub.mass * turbine_.hub.center_of_mass * turbine_.hub.center_of_mass;
      turbine_.hub.inertia = {inertia(1) - shift, inertia(0), inertia(2) - shift};
      if (inertia(1) < shift || inertia(2) < shift)
        refuse(path, "the inertia across the shaft is less than mass x^2 = " + rounded(shift) +
                         ", which no body has");
      note("hub.inertia", "Iyy, Ixx, Izz, moved from the apex to its own centre");
    } else if (path.empty() && has_body && !is_stated("hub.inertia")) {
      missing("the inertia of the hub", "hub.inertia");
    }
    apply_stated("hub.inertia", turbine_.hub.inertia);
    require_inertia("hub.inertia", turbine_.hub.inertia);
  }

  // ---- beams

  /// Points [x, y, z] of windIO on the union of the three grids.
  std::vector<Vector3> read_axis(const std::string& path) {
    const Curve x = curve(path + ".x");
    const Curve y = curve(path + ".y");
    const Curve z = curve(path + ".z");
    std::vector<Vector3> line;
    for (const Station& station : merge_grids({&z.grid, &x.grid, &y.grid})) {
      const Vector3 point(interpolate(x, station), interpolate(y, station),
                          interpolate(z, station));
      if (!station.behind) line.push_back(point);
    }
    return line;
  }

  /// Fills length or reference_line from points whose last component runs along the beam;
  /// `turn` gives the axes of the case.
  template <class Turn>
  void set_line(const std::string& path, const std::vector<Vector3>& points, const Turn& turn,
                model::BeamDefinition& beam) {
    if (points.size() < 2) {
      refuse(path, "expected at least two points");
      return;
    }
    double across = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      across = std::max(across, std::hypot(points[i](0), points[i](1)));
      if (i > 0 && !(points[i](2) > points[i - 1](2))) {
        refuse(path, "z must rise from point to point");
        return;
      }
    }
    std::vector<Vector3> line;
    line.reserve(points.size());
    for (const Vector3& point : points) line.push_back(turn(point));
    if (across <= straight_tolerance * points.back()(2)) {
      beam.length = points.back()(2);
      return;
    }
    beam.reference_line = line;
    beam.length = model::compute_arc_length(line);
  }

  /// True where the deck's matrices have a shear stiffness.
  bool states_shear(const std::string& elastic) const {
    const auto is_positive = [](const io::YamlNode& value) {
      return number_of(value).value_or(0.0) > 0.0;
    };
    for (const char* key : {".stiffness_matrix.K11", ".stiffness_matrix.K22"})
      if (const io::YamlNode* values = find(elastic + key);
          values != nullptr &&
          std::any_of(values->children.begin(), values->children.end(), is_positive))
        return true;
    const std::string rows =
        choose({elastic + ".stiffness_matrix.values", elastic + ".stiff_matrix.values",
                elastic + ".six_x_six.stiff_matrix.values"});
    if (rows.empty()) return false;
    const io::YamlNode& list = *find(rows);  // K11 is the first of each row
    return std::any_of(list.children.begin(), list.children.end(), [&](const io::YamlNode& row) {
      return !row.children.empty() && is_positive(row.children.front());
    });
  }

  /// `shear_is_rigid`: the deck's matrices have no shear stiffness.
  void read_damping(const std::string& path, model::BeamDefinition& beam, const std::string& key,
                    bool shear_is_rigid) {
    if (path.empty()) {
      missing("structural_damping", key);
      return;
    }
    const io::YamlNode* node = find(path);
    const io::YamlNode* list = node->find("mu") != nullptr ? node->find("mu") : node;
    const std::size_t errors_before = errors_.size();
    const std::vector<double> mu = numbers_at(path, *list);
    if (errors_.size() > errors_before) return;
    if (mu.size() != 6 || *std::min_element(mu.begin(), mu.end()) < 0.0) {
      refuse(path, "expected 6 numbers >= 0");
      return;
    }
    Vector6 coefficients = Eigen::Map<const Vector6>(mu.data());
    // HAWC2's x is chordwise on a blade and side-side on a tower: windIO's y.
    const bool may_be_hawc2 =
        !coefficients.head<3>().isZero(0.0) && coefficients.tail<3>().isZero(0.0);
    const bool has_pattern =
        may_be_hawc2 && coefficients.head<3>().minCoeff() > 0.0 && shear_is_rigid;
    const bool is_hawc2 = (options_.mu_order == MuOrder::hawc2 && may_be_hawc2) ||
                          (options_.mu_order == MuOrder::automatic && has_pattern);
    if (is_hawc2) {
      const Vector3 k = coefficients.head<3>();
      coefficients << 0.0, 0.0, 0.0, k(1), k(0), k(2);
      warn(place(*node), path +
                             ": note: read as HAWC2's Kx, Ky, Kz (flap or fore-aft, edge or "
                             "side-side, torsion)" +
                             (options_.mu_order == MuOrder::automatic
                                  ? ", for the last three are 0 and the deck states no shear "
                                    "stiffness; hint: --mu-order beamdyn takes them as they stand"
                                  : ""));
    } else if (options_.mu_order == MuOrder::hawc2 && !coefficients.isZero(0.0)) {
      warn(place(*node), path + ": note: the last three are not 0: read in BeamDyn's order");
    } else if (may_be_hawc2) {
      warn(place(*node), path + ": note: damps extension and shear alone, which hardly move");
    }
    beam.damping = turn_damping(coefficients);
    say(path, is_hawc2 ? Fate::derived : Fate::taken,
        key + (is_hawc2 ? ", as HAWC2's Kx, Ky, Kz" : "") + ", turned to b1 = z, b2 = -y, b3 = x");
    note(key, std::string("structural_damping.mu") + (is_hawc2 ? " as HAWC2's Kx, Ky, Kz" : "") +
                  ", in the order of a case");
    if (coefficients.isZero(0.0))
      warn(place(*node), path + ": note: all 0: " + key.substr(0, key.find('.')) + " undamped");
  }

  std::optional<Material> find_material(const std::string& name, const std::string& user) {
    const io::YamlNode* list = root_.find("materials");
    if (list == nullptr) {
      errors_.add(path_, "missing key \"materials\"");
      return {};
    }
    for (const io::YamlNode& node : list->children) {
      const io::YamlNode* own = node.find("name");
      if (own == nullptr || own->text != name) continue;
      Material material;
      double poisson = 0.0;
      const bool has_shear = node.find("G") != nullptr;  // else it follows from nu
      for (const auto& [key, value] :
           {std::pair<const char*, double*>{"rho", &material.density},
            {"E", &material.young},
            {has_shear ? "G" : "nu", has_shear ? &material.shear : &poisson}}) {
        const io::YamlNode* entry = node.find(key);
        const std::string where = "materials." + name + "." + key;
        if (entry == nullptr) {
          errors_.add(place(node), where + ": missing, " + user + " needs it");
          continue;
        }
        *value = number_at(where, *entry);
        if (!(*value > 0.0)) errors_.add(place(*entry), where + ": expected a number > 0");
        report_.push_back({place(*entry), where, Fate::derived, "sections of the tower"});
      }
      if (!has_shear) material.shear = material.young / (2.0 * (1.0 + poisson));
      return material;
    }
    refuse(user, "there is no material \"" + name + "\" in materials");
    return {};
  }

  void read_tower() {
    const std::string axis =
        require({"components.tower.reference_axis", "components.tower.outer_shape.reference_axis",
                 "components.tower.outer_shape_bem.reference_axis"});
    const std::string diameter_path = require({"components.tower.outer_shape.outer_diameter",
                                               "components.tower.outer_shape_bem.outer_diameter"});
    const std::string structure =
        require({"components.tower.structure", "components.tower.internal_structure_2d_fem"});
    if (axis.empty() || diameter_path.empty() || structure.empty()) return;
    turbine_.has_tower = true;
    std::vector<Vector3> points = read_axis(axis);
    const Vector3 foot = points.empty() ? Vector3::Zero() : points[0];
    for (Vector3& point : points) point -= foot;
    set_line(
        axis, points, [](const Vector3& p) { return Vector3(p(2), -p(1), p(0)); }, turbine_.tower);
    say(axis, Fate::derived,
        "tower, from its foot at z = " + rounded(foot(2)) + " m, where it is clamped");
    note("tower.length", "reference_axis, from its foot at z = " + rounded(foot(2)));
    note("tower.reference_line", "reference_axis from its foot, [-y, x, z]");

    if (turbine_.blades.count > 0) compare_height(foot(2) + turbine_.tower.length);
    const Curve diameter = curve(diameter_path);
    say(diameter_path, Fate::derived, "tower.sections");
    const std::string outfitting = structure + ".outfitting_factor";
    if (choose({outfitting}).empty())
      report_.push_back({place(*find(structure)), outfitting, Fate::derived,
                         "not in the deck: 1, as the schema has it"});
    const double factor =
        choose({outfitting}).empty()
            ? 1.0
            : number({outfitting}, Fate::derived, "multiplies mass and inertia of all sections");
    if (!(factor > 0.0)) refuse(outfitting, "expected a number > 0");
    const io::YamlNode* layers = find(structure + ".layers");
    if (layers == nullptr || layers->kind != io::YamlNode::Kind::list || layers->children.empty()) {
      errors_.add(path_, "missing key \"" + structure + ".layers\", a list");
      return;
    }
    read_layers(structure + ".layers", *layers, diameter, factor);
    const std::string elastic =
        choose({structure + ".elastic_properties", "components.tower.elastic_properties",
                "components.tower.elastic_properties_mb"});
    read_damping(elastic.empty() ? "" : choose({elastic + ".structural_damping"}), turbine_.tower,
                 "tower.damping", elastic.empty() || !states_shear(elastic));
    if (!elastic.empty()) compare_tower(elastic);
    set_mesh(turbine_.tower, tower_mesh);
    note("tower.elements", "chosen by the importer");
    note("tower.sections",
         "rings of the layers of the wall; mass and inertia times "
         "outfitting_factor");
  }

  /// The deck states the height of the hub twice; the sum of the parts counts.
  void compare_height(double top) {
    const std::string path = choose({"assembly.hub_height"});
    if (path.empty()) return;
    const double stated = number_at(path, *find(path));
    const double hub =
        top + turbine_.shaft.height + turbine_.shaft.overhang * std::sin(turbine_.shaft.tilt);
    say(path, Fate::ignored,
        "the parts give a hub height of " + rounded(hub) + " m" +
            (std::abs(hub - stated) > height_tolerance
                 ? ", which differs by " + rounded(hub - stated, 3) + " m"
                 : ", as stated"));
  }

  /// Rings one inside the other, the first layer outside.
  void read_layers(const std::string& path, const io::YamlNode& layers, const Curve& diameter,
                   double factor) {
    std::vector<Curve> thickness;
    std::vector<Material> materials;
    std::vector<const std::vector<double>*> grids{&diameter.grid};
    for (const io::YamlNode& layer : layers.children) {
      const io::YamlNode* material = layer.find("material");
      const io::YamlNode* thick = layer.find("thickness");
      if (material == nullptr || thick == nullptr || thick->find("grid") == nullptr ||
          thick->find("values") == nullptr) {
        errors_.add(place(layer), path +
                                      ": a layer needs material, thickness.grid and "
                                      "thickness.values");
        return;
      }
      Curve values{numbers_at(path, *thick->find("grid")),
                   numbers_at(path, *thick->find("values"))};
      if (values.grid.size() != values.values.size() || values.grid.empty() ||
          !std::is_sorted(values.grid.begin(), values.grid.end()) || values.grid.front() < 0.0 ||
          values.grid.back() > 1.0) {
        errors_.add(place(*thick), path +
                                       ".thickness: grid and values must be of one size, the "
                                       "grid rising from 0 to 1");
        return;
      }
      thickness.push_back(std::move(values));
      const std::optional<Material> found = find_material(material->text, path);
      if (!found) return;
      materials.push_back(*found);
    }
    if (!errors_.empty()) return;
    for (const Curve& values : thickness) grids.push_back(&values.grid);
    say(path, Fate::derived, "tower.sections, exact rings");
    for (const Station& station : divide_stations(merge_grids(grids), diameter, thickness)) {
      double outer = interpolate(diameter, station);
      model::SectionDefinition section;
      section.at = place_of(station);
      Vector6 stiffness = Vector6::Zero();
      double mass = 0.0;
      double inertia = 0.0;
      for (std::size_t i = 0; i < thickness.size(); ++i) {
        const double inner = outer - 2.0 * interpolate(thickness[i], station);
        if (!(inner >= 0.0 && inner < outer)) {
          refuse(path, "at " + rounded(station.place) + " of the length the wall, " +
                           rounded(0.5 * (outer - inner)) + " m, does not fit into the diameter " +
                           rounded(outer));
          return;
        }
        add_ring(outer, inner, materials[i], stiffness, mass, inertia);
        outer = inner;
      }
      mass *= factor;
      inertia *= factor;
      if (mass > most_mass)
        refuse(path, rounded(mass) + " kg/m at " + rounded(station.place) +
                         " of the tower is implausible (more than " + rounded(most_mass) +
                         "); hint: diameters and thickness are in m, rho in kg/m^3");
      section.stiffness.diagonal() = stiffness;
      section.mass = build_mass_matrix(mass, Vector3(2.0 * inertia, inertia, inertia));
      turbine_.tower.sections.push_back(section);
    }
  }

  /// Adds stations between those of the deck: diameter and wall are linear there, but mass and
  /// stiffness, which the case has linear between its sections, are not.
  static std::vector<Station> divide_stations(const std::vector<Station>& stations,
                                              const Curve& diameter,
                                              const std::vector<Curve>& thickness) {
    constexpr double largest_change = 0.03;  // of a logarithm: errors of EI below 0.1 %
    constexpr double most_parts = 40.0;
    std::vector<Station> all;
    for (std::size_t i = 0; i < stations.size(); ++i) {
      all.push_back(stations[i]);
      if (i + 1 == stations.size() || stations[i + 1].behind) continue;
      const auto change_of = [&](const Curve& curve) {
        const double first = interpolate(curve, stations[i]);
        const double last = interpolate(curve, stations[i + 1]);
        return first > 0.0 && last > 0.0 ? std::abs(std::log(last / first)) : 0.0;
      };
      double change = change_of(diameter);
      for (const Curve& layer : thickness) change = std::max(change, change_of(layer));
      const double parts = std::min(most_parts, std::ceil(change / largest_change));
      for (double part = 1.0; part < parts; part += 1.0)
        all.push_back(
            {stations[i].place + (stations[i + 1].place - stations[i].place) * part / parts});
    }
    return all;
  }

  static void add_ring(double outer, double inner, const Material& material, Vector6& stiffness,
                       double& mass, double& inertia) {
    const double area = 0.25 * std::numbers::pi * (outer * outer - inner * inner);
    const double second = std::numbers::pi / 64.0 * (std::pow(outer, 4) - std::pow(inner, 4));
    // Cowper (1966), hollow circle.
    const double poisson = 0.5 * material.young / material.shear - 1.0;
    const double m2 = (inner / outer) * (inner / outer);
    const double k =
        6.0 * (1.0 + poisson) * (1.0 + m2) * (1.0 + m2) /
        ((7.0 + 6.0 * poisson) * (1.0 + m2) * (1.0 + m2) + (20.0 + 12.0 * poisson) * m2);
    Vector6 ring;
    ring << material.young * area, k * material.shear * area, k * material.shear * area,
        2.0 * material.shear * second, material.young * second, material.young * second;
    stiffness += ring;
    mass += material.density * area;
    inertia += material.density * second;
  }

  /// Reports the difference between the rings and the sections that the deck may state as well.
  void compare_tower(const std::string& elastic) {
    const std::string inertia = elastic + ".inertia_matrix";
    if (find(inertia + ".mass") == nullptr || !errors_.empty()) return;
    const Curve mass = curve(inertia, "mass");
    double furthest = 0.0;
    for (std::size_t i = 0; i < mass.grid.size(); ++i) {
      const auto& sections = turbine_.tower.sections;
      const auto near = std::find_if(sections.begin(), sections.end(), [&](const auto& section) {
        return std::abs(section.at - mass.grid[i]) < straight_tolerance;
      });
      if (near != sections.end() && mass.values[i] > 0.0)
        furthest = std::max(furthest, std::abs(near->mass(0, 0) / mass.values[i] - 1.0));
    }
    const std::string words =
        "the sections follow from the layers; mass per length differs by up "
        "to " +
        rounded(100.0 * furthest, 3) + " %";
    say(inertia, Fate::ignored, words);
    say(elastic + ".stiffness_matrix", Fate::ignored, "the sections follow from the layers");
  }

  /// Keys under which a deck may state the blade's matrices.
  static Paths blade_matrices() {
    const std::string blade = "components.blade";
    return {blade + ".structure.elastic_properties", blade + ".elastic_properties",
            blade + ".elastic_properties_mb.six_x_six", blade + ".elastic_properties_mb"};
  }

  void read_blade() {
    const std::string blade = "components.blade";
    const std::string elastic = choose(blade_matrices());
    const std::string axis =
        require({elastic + ".reference_axis", blade + ".reference_axis",
                 blade + ".outer_shape.reference_axis", blade + ".outer_shape_bem.reference_axis"});
    const std::string twist_path = require(
        {elastic + ".twist", blade + ".outer_shape.twist", blade + ".outer_shape_bem.twist"});
    if (elastic.empty() || axis.empty() || twist_path.empty()) return;
    std::vector<Vector3> points = read_axis(axis);
    for (Vector3& point : points)
      for (double& component : point)
        if (std::abs(component) <= no_distance * points.back().norm()) component = 0.0;
    if (!points.empty() && points[0].norm() > straight_tolerance * points.back().norm())
      refuse(axis, "the first point must be 0, 0, 0, the root of the blade");
    else
      set_line(
          axis, points, [](const Vector3& p) { return turn_to_section_axes(p); },
          turbine_.blades.beam);
    say(axis, Fate::taken,
        turbine_.blades.beam.reference_line.empty() ? "blades.length"
                                                    : "blades.reference_line, [z, -y, x]");
    note("blades.length", "reference_axis");
    note("blades.reference_line", "reference_axis, [z, -y, x]");
    Curve twist = curve(twist_path);
    say(twist_path, is_first_ ? Fate::derived : Fate::taken,
        std::string("twist_deg of the sections") + (is_first_ ? ", from radians" : ""));
    for (double& angle : twist.values) {
      angle = to_degrees(angle);
      if (std::abs(angle) > 180.0) {
        refuse(twist_path, rounded(angle) +
                               " degrees is implausible; hint: radians without "
                               "windIO_version or in 1.0, degrees in 2.0");
        break;
      }
    }
    read_blade_sections(elastic, twist);
    read_damping(choose({elastic + ".structural_damping"}), turbine_.blades.beam, "blades.damping",
                 blade_shear_is_rigid_);
    set_mesh(turbine_.blades.beam, blade_mesh);
    note("blades.elements", "chosen by the importer");
    note("blades.sections", "matrices of windIO, turned to b1 = z, b2 = -y, b3 = x");
  }

  /// One curve for each of the 21 entries of a symmetric matrix, by rows.
  using Entries = std::array<Curve, 21>;

  void read_blade_sections(const std::string& elastic, const Curve& twist) {
    Entries stiffness;
    Entries mass;
    const std::string new_stiffness = choose({elastic + ".stiffness_matrix"});
    if (!new_stiffness.empty()) {
      stiffness = read_entries(new_stiffness);
      say(new_stiffness, Fate::taken, "stiffness_matrix of blades.sections");
    } else {
      const std::string path = require({elastic + ".stiffness_matrix", elastic + ".stiff_matrix"});
      if (path.empty()) return;
      stiffness = read_rows(path);
      say(path, Fate::taken, "stiffness_matrix of blades.sections");
    }
    const std::string inertia = require({elastic + ".inertia_matrix"});
    if (inertia.empty()) return;
    if (find(inertia + ".mass") != nullptr)
      mass = read_inertia(inertia);
    else
      mass = read_rows(inertia);
    say(inertia, Fate::taken, "mass_matrix of blades.sections");
    if (!errors_.empty()) return;
    const std::array<bool, 6> rigid = find_rigid(stiffness);
    std::vector<std::string> places;
    for (const Station& station : merge_grids({&mass[0].grid, &stiffness[0].grid, &twist.grid})) {
      model::SectionDefinition section;
      section.at = place_of(station);
      section.rigid = rigid;
      section.stiffness = turn_to_section_axes(assemble(stiffness, station));
      section.mass = turn_to_section_axes(assemble(mass, station));
      drop_round_off(section.stiffness);
      drop_round_off(section.mass);
      section.twist = fields::deg.to_si(interpolate(twist, station));
      turbine_.blades.beam.sections.push_back(section);
    }
    places.push_back(place(*find(inertia)));
    check_sections(turbine_.blades.beam, "blade", places, errors_);
  }

  /// windIO 2.0: a list for each entry. A matrix without entries off the diagonal is diagonal; K11
  /// and K22 may be missing, which means that shear is rigid.
  Entries read_entries(const std::string& path) {
    Entries entries;
    const io::YamlNode& node = *find(path);
    const io::YamlNode* grid = node.find("grid");
    const auto name_of = [](int i, int j) { return "K" + std::to_string(i) + std::to_string(j); };
    bool is_diagonal = grid != nullptr;
    for (int i = 1; i <= 6; ++i)
      for (int j = i + 1; j <= 6; ++j)
        if (node.find(name_of(i, j)) != nullptr) is_diagonal = false;
    std::size_t entry = 0;
    for (int i = 1; i <= 6; ++i)
      for (int j = i; j <= 6; ++j, ++entry) {
        const std::string name = name_of(i, j);
        const bool may_be_absent = i != j ? is_diagonal : i <= 2 && grid != nullptr;
        entries[entry] = node.find(name) == nullptr && may_be_absent
                             ? Curve{numbers_at(path + ".grid", *grid),
                                     std::vector<double>(grid->children.size(), 0.0)}
                             : curve(path, name);
      }
    if (is_diagonal)
      warn(place(node), path + ": note: no entry off the diagonal: there are no couplings");
    return entries;
  }

  /// Shear stiffness that is 0 at all places is rigid, in the order of a case.
  std::array<bool, 6> find_rigid(const Entries& stiffness) {
    std::array<bool, 6> rigid{};
    std::string names;
    const std::array<std::size_t, 2> diagonal{0, 6};  // K11, K22
    for (std::size_t k = 0; k < diagonal.size(); ++k) {
      const std::vector<double>& values = stiffness[diagonal[k]].values;
      if (std::any_of(values.begin(), values.end(), [](double value) { return value != 0.0; }))
        continue;
      rigid[2 - k] = true;  // x is b3, y is -b2
      names += std::string(names.empty() ? "" : " and ") + (k == 0 ? "K11" : "K22");
    }
    blade_shear_is_rigid_ = rigid[1] && rigid[2];
    if (!names.empty())
      warn(path_, "note: the blade's shear stiffness " + names +
                      " is 0 or not in the deck: shear is rigid");
    return rigid;
  }

  static Matrix6 assemble(const Entries& entries, const Station& station) {
    Matrix6 matrix;
    std::size_t entry = 0;
    for (Eigen::Index i = 0; i < 6; ++i)
      for (Eigen::Index j = i; j < 6; ++j)
        matrix(i, j) = matrix(j, i) = interpolate(entries[entry++], station);
    return matrix;
  }

  /// windIO 1.0: a list of 21 numbers at each place.
  Entries read_rows(const std::string& path) {
    Entries entries;
    const io::YamlNode* grid = find(path + ".grid");
    const io::YamlNode* values = find(path + ".values");
    if (grid == nullptr || values == nullptr) {
      refuse(path, std::string("missing key \"") + (grid == nullptr ? "grid" : "values") + "\"");
      return entries;
    }
    const std::vector<double> places = numbers_at(path + ".grid", *grid);
    if (places.size() != values->children.size() || places.empty() ||
        !std::is_sorted(places.begin(), places.end()) || places.front() < 0.0 ||
        places.back() > 1.0) {
      errors_.add(place(*values), path +
                                      ": grid and values must be of one size, the grid rising "
                                      "from 0 to 1");
      return entries;
    }
    for (std::size_t row = 0; row < places.size(); ++row) {
      const std::vector<double> numbers = numbers_at(path + ".values", values->children[row]);
      if (numbers.size() != entries.size()) {
        errors_.add(place(values->children[row]),
                    path + ".values: expected 21 numbers, got " + std::to_string(numbers.size()));
        return entries;
      }
      for (std::size_t k = 0; k < entries.size(); ++k) {
        entries[k].grid.push_back(places[row]);
        entries[k].values.push_back(numbers[k]);
      }
    }
    return entries;
  }

  /// Some files have i_flap = 0 and -i_edge in the place of i_cp. For a thin section i_plr is the
  /// sum of the two others.
  void derive_flap_inertia(const std::string& path, const Curve& edge, const Curve& polar,
                           Curve& flap, Curve& cross) {
    const std::size_t count = flap.values.size();
    if (edge.values.size() != count || polar.values.size() != count) return;
    for (std::size_t i = 0; i < count; ++i)
      if (flap.values[i] != 0.0 || !(polar.values[i] > edge.values[i]) || !(edge.values[i] > 0.0))
        return;
    for (std::size_t i = 0; i < count; ++i) flap.values[i] = polar.values[i] - edge.values[i];
    const bool is_shifted =
        cross.values.size() == count &&
        std::equal(cross.values.begin(), cross.values.end(), edge.values.begin(),
                   [](double a, double b) { return a == -b; });
    if (is_shifted) std::fill(cross.values.begin(), cross.values.end(), 0.0);
    warn(place(*find(path)),
         path +
             ": warning: i_flap is 0 at all stations, which no section has: i_plr - i_edge "
             "is taken" +
             (is_shifted ? ", and 0 for i_cp, where the deck has -i_edge" : ""));
  }

  /// windIO 2.0: mass, centre and moments. Entries of the matrix as in its 1.0 form.
  Entries read_inertia(const std::string& path) {
    const Curve mass = curve(path, "mass");
    std::string absent;
    const auto or_zero = [&](const char* key) {
      if (find(path + "." + key) != nullptr) return curve(path, key);
      absent += (absent.empty() ? "" : ", ") + std::string(key);
      return Curve{mass.grid, std::vector<double>(mass.grid.size(), 0.0)};
    };
    const Curve x = or_zero("cm_x");
    const Curve y = or_zero("cm_y");
    const Curve edge = curve(path, "i_edge");
    Curve flap = curve(path, "i_flap");
    const Curve polar = curve(path, "i_plr");
    Curve cross = or_zero("i_cp");
    if (!absent.empty())
      warn(place(*find(path)), path + ": note: " + absent + " not in the deck: 0");
    derive_flap_inertia(path, edge, polar, flap, cross);
    Entries entries;
    for (Curve& entry : entries) entry = {mass.grid, std::vector<double>(mass.grid.size(), 0.0)};
    for (const Curve* other :
         std::initializer_list<const Curve*>{&x, &y, &edge, &flap, &polar, &cross})
      if (other->grid.size() != mass.grid.size()) return entries;
    for (std::size_t i = 0; i < mass.grid.size(); ++i) {
      const double m = mass.values[i];
      for (const std::size_t k : {0u, 6u, 11u}) entries[k].values[i] = m;
      entries[5].values[i] = -m * y.values[i];
      entries[10].values[i] = m * x.values[i];
      entries[12].values[i] = m * y.values[i];
      entries[13].values[i] = -m * x.values[i];
      entries[15].values[i] = edge.values[i];
      entries[16].values[i] = -cross.values[i];
      entries[18].values[i] = flap.values[i];
      entries[20].values[i] = polar.values[i];
    }
    return entries;
  }

  // ---- the air

  /// An airfoil at a place of the blade.
  struct AirfoilPlace {
    double at = 0.0;
    std::string name;  ///< in the case
    std::string own;   ///< in the deck
  };

  void read_air() {
    const std::string outer =
        choose({"components.blade.outer_shape", "components.blade.outer_shape_bem"});
    const std::string listed = choose({outer + ".airfoils", outer + ".airfoil_position"});
    if (outer.empty() || listed.empty() || find("airfoils") == nullptr) {
      warn(path_, "note: the deck has no airfoils of the blade: the case has no air");
      return;
    }
    const std::string chord_path = require({outer + ".chord"});
    const std::string twist_path = require({outer + ".twist"});
    const std::string offset_path = require({outer + ".section_offset_y", outer + ".pitch_axis"});
    if (chord_path.empty() || twist_path.empty() || offset_path.empty()) return;
    const std::vector<AirfoilPlace> places = read_airfoil_places(listed);
    const Curve chord = curve(chord_path);
    const Curve twist = curve(twist_path);
    const Curve offset = curve(offset_path);
    const std::string thickness_path = choose({outer + ".rthick"});
    const Curve thickness = thickness_path.empty() ? Curve{} : curve(thickness_path);
    for (std::size_t i = 0; i < chord.values.size(); ++i)
      if (!(chord.values[i] > 0.0)) {
        refuse(chord_path, "expected numbers > 0, got " + rounded(chord.values[i]) + " at " +
                               rounded(chord.grid[i]) +
                               " of the blade; hint: a tip that ends in a point has a small chord");
        break;
      }
    if (!errors_.empty() || places.empty()) return;
    for (const AirfoilPlace& place : places)
      if (place.at < 0.0 || place.at > 1.0 ||
          (&place != &places[0] && !(place.at > (&place)[-1].at)))
        refuse(listed, "expected places that rise from 0 to 1, got " + rounded(place.at));
    if (!errors_.empty()) return;

    const bool by_thickness = !thickness.grid.empty() && have_thickness(places);
    std::vector<double> own_grid;
    for (const AirfoilPlace& place : places) own_grid.push_back(place.at);
    const bool is_share = offset_path.ends_with(".pitch_axis");
    for (const Station& station :
         merge_grids({&chord.grid, &twist.grid, &offset.grid, &thickness.grid, &own_grid})) {
      if (station.behind) continue;
      model::AeroSectionDefinition section;
      section.at = station.place;
      section.chord = interpolate(chord, station);
      section.twist = fields::deg.to_si(to_degrees(interpolate(twist, station)));
      const double axis = interpolate(offset, station) * (is_share ? section.chord : 1.0);
      const double center = by_thickness ? choose_thickness(thickness, station, section.thickness)
                                         : choose_airfoil(places, station, section.airfoil);
      // The chord of the section against its structural axes.
      const double structural = model::interpolate_section(turbine_.blades.beam, section.at).twist;
      const double ahead = axis - center * section.chord;
      const double turned = section.twist - structural;
      section.center = {ahead * std::cos(turned), -ahead * std::sin(turned)};
      for (double& component : section.center)
        if (std::abs(component) <= no_distance * turbine_.blades.beam.length) component = 0.0;
      turbine_.blades.aero_sections.push_back(section);
    }
    set_air_mesh(turbine_.blades.beam);
    say(chord_path, Fate::taken, "chord of blades.aero_sections");
    say(twist_path, is_first_ ? Fate::derived : Fate::taken, "twist_deg of blades.aero_sections");
    say(offset_path, Fate::derived,
        std::string("center of blades.aero_sections = ") + (is_share ? "pitch_axis chord" : "it") +
            " - aerodynamic_center chord along the chord");
    if (by_thickness) {
      say(thickness_path, Fate::taken, "thickness of blades.aero_sections");
      say(listed, Fate::derived, "airfoils of the case, chosen by their thickness");
    } else {
      if (!thickness_path.empty())
        say(thickness_path, Fate::ignored, "two airfoils of one thickness, or one without");
      say(listed, Fate::derived, "airfoil of blades.aero_sections");
    }
    say("airfoils", Fate::taken, "blades.airfoils");
    if (const std::string across = choose({outer + ".section_offset_x"}); !across.empty())
      say_offset_across(across);
    note("blades.airfoils", std::string("airfoils of windIO") +
                                (by_thickness ? "" : ", those between two linear in the span"));
    note("blades.aero_sections", std::string("outer shape; center: the aerodynamic centre from ") +
                                     (is_share ? "pitch_axis" : "section_offset_y"));
    say_wind();
  }

  void say_offset_across(const std::string& path) {
    const Curve across = curve(path);
    const bool is_zero =
        std::ranges::all_of(across.values, [](double value) { return value == 0.0; });
    say(path, Fate::ignored, is_zero ? "0" : "offsets across the chord are left out");
    if (!is_zero) warn(place(*find(path)), path + ": note: offsets across the chord are left out");
  }

  /// windIO states the air but no operating wind.
  void say_wind() {
    const std::string density = "environment.air_density";
    std::string words = "note: the deck has no wind: no air acts before the case has one, such as ";
    std::string wind = "wind: {speed: 8";
    if (find(density) != nullptr) {
      const double value = number({density}, Fate::ignored, "wind.density beside a wind.speed");
      wind += ", density: " + rounded(value);
    }
    warn(path_, words + wind + "}");
    head_.push_back("No air acts before the case has a wind, such as `" + wind + "}`.");
  }

  std::vector<AirfoilPlace> read_airfoil_places(const std::string& listed) {
    std::vector<AirfoilPlace> places;
    const io::YamlNode& node = *find(listed);
    if (node.kind == io::YamlNode::Kind::list) {  // windIO 2.0
      for (const io::YamlNode& child : node.children) {
        const io::YamlNode* name = child.find("name");
        const io::YamlNode* at = child.find("spanwise_position");
        if (name == nullptr || at == nullptr) {
          errors_.add(place(child), listed + ": an airfoil needs name and spanwise_position");
          return {};
        }
        std::string configuration;
        if (const io::YamlNode* list = child.find("configuration");
            list != nullptr && !list->children.empty())
          configuration = list->children[0].text;
        places.push_back({number_at(listed + ".spanwise_position", *at),
                          add_airfoil(*name, configuration), name->text});
      }
      return places;
    }
    const io::YamlNode* grid = node.find("grid");
    const io::YamlNode* labels = node.find("labels");
    if (grid == nullptr || labels == nullptr || grid->children.size() != labels->children.size() ||
        grid->children.empty()) {
      errors_.add(place(node), listed + ": expected grid and labels of one size");
      return {};
    }
    for (std::size_t i = 0; i < grid->children.size(); ++i)
      places.push_back({number_at(listed + ".grid", grid->children[i]),
                        add_airfoil(labels->children[i], ""), labels->children[i].text});
    return places;
  }

  /// The name in the case of an airfoil of the deck, which it then has; empty with an error.
  std::string add_airfoil(const io::YamlNode& label, const std::string& configuration) {
    const auto known = airfoil_names_.find(label.text + "/" + configuration);
    if (known != airfoil_names_.end()) return known->second;
    const io::YamlNode& list = *find("airfoils");
    const auto found = std::ranges::find_if(list.children, [&](const io::YamlNode& node) {
      const io::YamlNode* own = node.find("name");
      return own != nullptr && own->text == label.text;
    });
    if (found == list.children.end()) {
      errors_.add(place(label), "there is no airfoil \"" + label.text + "\" in airfoils");
      return "";
    }
    const std::string name = name_airfoil(clean_text(label.text), turbine_.blades.airfoils);
    model::AirfoilDefinition airfoil;
    airfoil.polars = read_polars(*found, configuration);
    for (const char* key : {"rthick", "relative_thickness"})
      if (const io::YamlNode* node = found->find(key)) {
        const double value = number_at("airfoils." + label.text + "." + key, *node);
        if (value > 0.0 && value <= 1.0) airfoil.thickness = value;
      }
    if (const io::YamlNode* node = found->find("aerodynamic_center"))
      aerodynamic_centers_[name] =
          number_at("airfoils." + label.text + ".aerodynamic_center", *node);
    else
      aerodynamic_centers_[name] = 0.25;
    turbine_.blades.airfoils[name] = std::move(airfoil);
    airfoil_names_[label.text + "/" + configuration] = name;
    return name;
  }

  /// Polars of one configuration, by default that of the first; at several Reynolds numbers.
  std::vector<model::PolarDefinition> read_polars(const io::YamlNode& airfoil,
                                                  std::string configuration) {
    const std::string where = "airfoils." + airfoil.find("name")->text + ".polars";
    const io::YamlNode* list = airfoil.find("polars");
    std::vector<model::PolarDefinition> polars;
    if (list == nullptr || list->children.empty()) {
      errors_.add(place(airfoil), where + ": missing, the polars of the airfoil");
      return polars;
    }
    const auto configuration_of = [](const io::YamlNode& node) {
      const io::YamlNode* own = node.find("configuration");
      return own == nullptr ? std::string() : own->text;
    };
    const bool is_known =
        std::ranges::find(list->children, configuration, configuration_of) != list->children.end();
    if (!is_known) configuration = configuration_of(list->children[0]);
    for (const io::YamlNode& node : list->children) {
      if (configuration_of(node) != configuration) continue;
      const io::YamlNode* sets = node.find("re_sets");
      if (sets == nullptr) {
        add_polar(node, {"c_l", "c_d", "c_m"}, where, polars);
        continue;
      }
      for (const io::YamlNode& set : sets->children)
        add_polar(set, {"cl", "cd", "cm"}, where, polars);
    }
    std::ranges::sort(polars, {}, &model::PolarDefinition::reynolds);
    return polars;
  }

  static bool spans_circle(const std::vector<double>& angles) {
    constexpr double largest_gap = 2e-3;  // as the polars of a case
    return std::abs(angles.front() + std::numbers::pi) <= largest_gap &&
           std::abs(angles.back() - std::numbers::pi) <= largest_gap &&
           std::ranges::adjacent_find(angles, std::greater_equal<>()) == angles.end();
  }

  /// Coefficients may have grids of their own. A second polar at a Reynolds number is left out.
  void add_polar(const io::YamlNode& node, const std::array<const char*, 3>& keys,
                 const std::string& where, std::vector<model::PolarDefinition>& polars) {
    model::PolarDefinition polar;
    if (const io::YamlNode* reynolds = node.find("re"))
      polar.reynolds = number_at(where + ".re", *reynolds);
    std::array<Curve, 3> curves;
    std::vector<double> angles;
    for (std::size_t k = 0; k < keys.size(); ++k) {
      const io::YamlNode* own = node.find(keys[k]);
      if (own == nullptr && k == 2) continue;  // no moment
      const io::YamlNode* grid = own == nullptr ? nullptr : own->find("grid");
      const io::YamlNode* values = own == nullptr ? nullptr : own->find("values");
      if (grid == nullptr || values == nullptr) {
        errors_.add(place(own == nullptr ? node : *own),
                    where + ": missing " + keys[k] + " with grid and values");
        return;
      }
      curves[k] = {numbers_at(where + "." + keys[k] + ".grid", *grid),
                   numbers_at(where + "." + keys[k] + ".values", *values)};
      if (curves[k].grid.size() != curves[k].values.size() || curves[k].grid.empty()) {
        errors_.add(place(*values), where + "." + keys[k] + ": grid has " +
                                        std::to_string(curves[k].grid.size()) + " angles, values " +
                                        std::to_string(curves[k].values.size()));
        return;
      }
      for (double& angle : curves[k].grid) {
        angle = is_first_ ? angle : fields::deg.to_si(angle);
        angles.push_back(angle);
      }
      if (!spans_circle(curves[k].grid)) {
        errors_.add(place(*grid), where + "." + keys[k] +
                                      ".grid: expected rising angles from -180 to 180 degrees" +
                                      (is_first_ ? ", in radians" : "") + "; hint: angles are in " +
                                      (is_first_ ? "radians in 1.0" : "degrees in 2.0"));
        return;
      }
    }
    polar.angles = merge_angles(std::move(angles));
    for (std::size_t k = 0; k < keys.size(); ++k) {
      std::vector<double>& values = k == 0 ? polar.lift : k == 1 ? polar.drag : polar.moment;
      for (const double angle : polar.angles)
        values.push_back(curves[k].grid.empty() ? 0.0
                                                : interpolate(curves[k], Station{angle, false}));
    }
    if (const std::string fault = model::find_polar_fault(polar); !fault.empty()) {
      errors_.add(place(node), where + ": " + fault);
      return;
    }
    if (std::ranges::find(polars, polar.reynolds, &model::PolarDefinition::reynolds) ==
        polars.end())
      polars.push_back(std::move(polar));
  }

  /// Whether all airfoils of the blade have a thickness of their own, so that sections with a
  /// thickness have an airfoil.
  bool have_thickness(const std::vector<AirfoilPlace>& places) {
    std::map<double, std::string> names;
    for (const AirfoilPlace& place : places) {
      const std::optional<double> own = turbine_.blades.airfoils[place.name].thickness;
      if (!own || names.try_emplace(*own, place.name).first->second != place.name) return false;
    }
    return true;
  }

  /// Sets the thickness of a section, within the range of the airfoils, and returns the aerodynamic
  /// centre behind the leading edge [of the chord], linear between those of the airfoils.
  double choose_thickness(const Curve& thickness, const Station& station,
                          std::optional<double>& own) {
    const auto sorted = model::sort_by_thickness(turbine_.blades.airfoils);
    own = std::clamp(interpolate(thickness, station), sorted.front().first, sorted.back().first);
    const auto thicker =
        std::ranges::lower_bound(sorted, *own, {}, &std::pair<double, std::string>::first);
    const double center = aerodynamic_centers_[thicker->second];
    if (thicker == sorted.begin()) return center;
    const auto& [least, thinner] = *(thicker - 1);
    const double before = aerodynamic_centers_[thinner];
    return before + (*own - least) / (thicker->first - least) * (center - before);
  }

  /// Sets the airfoil at a station and returns its aerodynamic centre behind the leading edge [of
  /// the chord]. Between two airfoils of the deck it is one of its own, linear in the span.
  double choose_airfoil(const std::vector<AirfoilPlace>& places, const Station& station,
                        std::string& name) {
    constexpr double steps = 1000.0;  // of the weights, which are parts of names
    auto& airfoils = turbine_.blades.airfoils;
    const auto behind =
        std::ranges::upper_bound(places, station.place + straight_tolerance, {}, &AirfoilPlace::at);
    const AirfoilPlace& a = behind == places.begin() ? places.front() : *(behind - 1);
    const AirfoilPlace& b = behind == places.end() ? places.back() : *behind;
    const double weight = a.at == b.at ? 0.0 : (station.place - a.at) / (b.at - a.at);
    const double step = std::round(std::clamp(weight, 0.0, 1.0) * steps);
    const double center_a = aerodynamic_centers_[a.name];
    const double center_b = aerodynamic_centers_[b.name];
    if (a.name == b.name || step == 0.0) {
      name = a.name;
      return center_a;
    }
    if (step == steps) {
      name = b.name;
      return center_b;
    }
    name = a.name + " to " + b.name + " " + std::to_string(std::lround(step));
    if (!airfoils.contains(name))
      airfoils[name] = mix_airfoils(airfoils[a.name], airfoils[b.name], step / steps);
    return center_a + step / steps * (center_b - center_a);
  }

  // ---- keys that are left out

  /// Warns of the parts that are left out, by name.
  void warn_of_left_out() {
    std::string names;
    const auto add = [&](const char* path, const char* words) {
      if (find(path) != nullptr) names += (names.empty() ? "" : ", ") + std::string(words);
    };
    if (turbine_.blades.aero_sections.empty()) add("airfoils", "airfoils (aerodynamics)");
    add("control", "control");
    add("components.mooring", "mooring lines");
    add("components.foundation", "the foundation");
    if (!names.empty()) warn(path_, "note: left out: " + names);
  }

  static std::string reason(const std::string& path) {
    const auto starts = [&](const char* word) { return path.starts_with(word); };
    if (starts("airfoils") || path.find("airfoil") != std::string::npos ||
        path.find("chord") != std::string::npos || path.find("thick") != std::string::npos ||
        path.find(".cd") != std::string::npos || path.find("drag") != std::string::npos)
      return "aerodynamics";
    if (starts("control")) return "a controller is no part of a case";
    if (starts("materials")) return "belongs to another component, whose matrices the deck states";
    if (starts("environment") || starts("assembly") || starts("bos") || starts("costs"))
      return "a statement about the site or the machine, no part of the structure";
    if (path.find("webs") != std::string::npos || path.find("layers") != std::string::npos ||
        path.find("anchors") != std::string::npos)
      return "the deck states the matrices that follow from it";
    return "no part of the structure of a case";
  }

  bool is_used_below(const std::string& path) const {
    const auto next = used_.lower_bound(path);
    return next != used_.end() && (*next == path || next->starts_with(path + "."));
  }

  bool is_used(const std::string& path) const { return used_.contains(path); }

  /// Reports the keys that nothing has read, at the highest possible level of the tree.
  void report_rest(const io::YamlNode& node, const std::string& path) {
    if (node.kind != io::YamlNode::Kind::map) return;
    for (const io::YamlNode& child : node.children) {
      const std::string below = path.empty() ? child.key : path + "." + child.key;
      if (is_used(below) || below == "materials") continue;
      if (is_used_below(below) || below == "components")
        report_rest(child, below);
      else
        report_.push_back({place(child), below, Fate::ignored, reason(below)});
    }
  }

  std::string path_;
  ImportOptions options_;
  io::YamlNode root_;
  DeckErrors errors_;
  model::TurbineDefinition turbine_;
  io::CaseComments comments_;
  std::vector<ImportLine> report_;
  std::vector<std::string> warnings_;
  std::set<std::string> used_;
  std::vector<std::string> head_;                      ///< further lines at the top of the case
  std::map<std::string, std::string> airfoil_names_;   ///< in the case, by name and configuration
  std::map<std::string, double> aerodynamic_centers_;  ///< behind the leading edge [of the chord]
  bool is_first_ = false;
  bool is_upwind_ = true;
  bool blade_shear_is_rigid_ = false;
};

}  // namespace

Import import_windio(const std::string& path, const ImportOptions& options) {
  return Importer(path, options).run();
}

}  // namespace samara::decks
