#include "htc_air.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "samara/base/words.hpp"
#include "samara/model/airfoil.hpp"

#include "htc_tables.hpp"
#include "import_air.hpp"

namespace samara::decks {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// The half-chord point is behind the aerodynamic centre [of the chord].
constexpr double quarter = 0.25;

/// The last row of the aerodynamic layout and the end of the line may differ by this [of the
/// length].
constexpr double length_tolerance = 2e-3;

/// An angle of a polar closer than this to a half turn is one [rad].
constexpr double same_angle = 1e-6;

class AirReader {
 public:
  AirReader(HtcImport& import, const HtcAirSource& source) : import_(import), source_(source) {}

  void read() {
    read_wind();
    read_models();
    read_sections();
  }

 private:
  const HtcBlock& root() const { return import_.deck.root(); }

  // ---- wind

  void read_wind() {
    const HtcBlock* block = root().find_block("wind");
    if (block == nullptr) {
      import_.warn(import_.deck.path(),
                   "note: the deck has no begin wind: no air acts before the case has a wind, such "
                   "as wind: {speed: 8}");
      import_.comments.head.emplace_back(
          "No air acts before the case has a wind, such as `wind: {speed: 8}`.");
      return;
    }
    block->used = true;
    const HtcCommand* speed = import_.require(*block, "wsp");
    const auto value = speed == nullptr ? std::optional<double>() : import_.number(*speed, 0);
    if (!value) return;
    if (*value < 0.0) import_.errors.add(speed->place, "wsp: expected a number >= 0");
    wind_.speed = *value;
    import_.say("wind", *speed, Fate::taken, "wind.speed");
    import_.note("wind.speed", "wsp");
    if (const HtcCommand* density = block->find("density")) {
      if (const auto number = import_.number(*density, 0)) wind_.density = *number;
      if (!(wind_.density > 0.0))
        import_.errors.add(density->place, "density: expected a number > 0");
      import_.say("wind", *density, Fate::taken, "wind.density");
      import_.note("wind.density", "density");
    } else {
      import_.note("wind.density", "not in the deck");
    }
    read_directions(*block);
    read_shear(*block);
    read_tower_flow(*block);
    read_turbulence(*block);
    import_.turbine.wind = wind_;
  }

  void read_directions(const HtcBlock& block) {
    double yaw = 0.0;
    double slope = 0.0;
    const HtcCommand* command = block.find("windfield_rotations");
    if (command != nullptr) {
      const auto values = import_.numbers(*command, 0, 3);
      if (!values) return;
      yaw = (*values)[0] * degree;
      slope = (*values)[1] * degree;
      import_.say("wind", *command, Fate::derived,
                  "wind.direction_deg = -yaw, wind.upflow_deg = slope; the roll turns turbulence "
                  "alone");
    }
    wind_.direction = std::remainder(-yaw - source_.yaw, 2.0 * std::numbers::pi);
    wind_.upflow = slope;
    if (command != nullptr && std::abs(slope) >= 0.5 * std::numbers::pi)
      import_.errors.add(command->place,
                         "windfield_rotations: expected a slope between -90 and 90");
    if (wind_.direction != 0.0)
      import_.note("wind.direction_deg", source_.yaw == 0.0
                                             ? "-yaw of windfield_rotations"
                                             : "-yaw of the wind - yaw of the nacelle");
    if (const HtcCommand* horizontal = block.find("horizontal_input")) {
      const auto flag = import_.integer(*horizontal, 0, 0, 1);
      if (flag && *flag == 1 && std::abs(slope) < 0.5 * std::numbers::pi)
        wind_.speed /= std::cos(slope);
      import_.say("wind", *horizontal, Fate::derived,
                  flag && *flag == 1 ? "wsp is the horizontal component" : "wsp is along the wind");
    }
  }

  void read_shear(const HtcBlock& block) {
    double height = 0.0;
    if (const HtcCommand* center = block.find("center_pos0")) {
      const auto values = import_.numbers(*center, 0, 3);
      if (values) height = -(*values)[2] - source_.foot;
      import_.say(
          "wind", *center, Fate::derived,
          "wind.height = -z, above the foot of the tower at " + rounded(source_.foot) + " m");
    }
    const HtcCommand* command = block.find("shear_format");
    if (command == nullptr) return;
    const auto kind = import_.integer(*command, 0, 0, 5);
    if (!kind) return;
    const auto parameter =
        command->words.size() > 1 ? import_.number(*command, 1) : std::optional<double>(0.0);
    if (!parameter) return;
    using Profile = model::WindDefinition::Profile;
    std::string words = "uniform wind";
    if (*kind == 0) {
      words = "no mean wind: wsp moves the turbulence alone";
      import_.warn(command->place,
                   "shear_format: note: 0 means no mean wind in HAWC2; the case has wind.speed 0");
      wind_.speed = 0.0;
    } else if (*kind == 2 || *kind == 3) {
      const bool is_power = *kind == 3;
      if (!(height > 0.0)) {
        import_.errors.add(command->place,
                           "shear_format: needs center_pos0 with a height above the foot of the "
                           "tower, got " +
                               rounded(height));
        return;
      }
      wind_.height = height;
      wind_.profile = is_power ? Profile::power : Profile::logarithmic;
      (is_power ? wind_.exponent : wind_.roughness) = *parameter;
      words = is_power ? "wind.shear.power" : "wind.shear.log";
      import_.note("wind.height", "-z of center_pos0, above the foot of the tower");
      import_.note(is_power ? "wind.shear.power" : "wind.shear.log", "shear_format");
      if (source_.foot != 0.0)
        import_.warn(command->place,
                     "shear_format: note: HAWC2 counts the height from its origin, " +
                         rounded(source_.foot) +
                         " m below the foot of the tower, a case from the foot: the shear differs");
    } else if (*kind != 1) {
      words = "left out: a case has power law and logarithm";
      import_.warn(command->place,
                   "shear_format: note: " + std::to_string(*kind) +
                       " is left out, the wind is uniform; hint: shear {up, length} of the case is "
                       "linear");
    }
    import_.say("wind", *command, Fate::derived, words);
  }

  /// Rows of one kind of command, with `count` numbers.
  std::vector<std::vector<double>> rows_of(const HtcBlock& block, const std::string& name,
                                           std::size_t count) {
    std::vector<std::vector<double>> rows;
    for (const HtcCommand& command : block.commands) {
      if (command.name != name) continue;
      command.used = true;
      const auto values = import_.numbers(command, 0, count);
      if (!values) return {};
      rows.push_back(*values);
    }
    const HtcCommand* stated = block.find("nsec");
    if (stated != nullptr) {
      const auto number = import_.integer(*stated, 0, 1, 100000);
      stated->used = true;
      if (number && *number != static_cast<int>(rows.size()))
        import_.errors.add(stated->place, "nsec: " + std::to_string(*number) + ", there are " +
                                              std::to_string(rows.size()) + " of " + name);
    }
    return rows;
  }

  void read_tower_flow(const HtcBlock& block) {
    const HtcCommand* method = block.find("tower_shadow_method");
    const auto kind =
        method == nullptr ? std::optional<int>(0) : import_.integer(*method, 0, 0, 100);
    if (!kind) return;
    model::TowerFlowDefinition flow;
    flow.potential = model::TowerFlowDefinition::Potential::none;
    Curve diameter;
    for (const HtcBlock& part : block.blocks) {
      if (!part.name.starts_with("tower_shadow_potential")) continue;
      const bool is_second = part.name.ends_with("_2");
      if (*kind != (is_second ? 3 : 1)) {
        import_.say(part, "wind." + part.name, Fate::ignored, "tower_shadow_method is another one");
        continue;
      }
      for (const std::vector<double>& row : rows_of(part, "radius", 2)) {
        diameter.grid.push_back(is_second ? row[0] : -row[0] - source_.foot);
        diameter.values.push_back(2.0 * row[1]);
      }
      flow.potential = model::TowerFlowDefinition::Potential::plain;
      mark(part, {"tower_mbdy_link", "tower_offset"});
      import_.say(part, "wind." + part.name, Fate::derived, "wind.tower.sections");
      if (!require_rising(diameter, part.place, "radius")) return;
    }
    if (method != nullptr) {
      const bool is_potential = flow.potential != model::TowerFlowDefinition::Potential::none;
      if (*kind != 0 && !is_potential)
        import_.warn(method->place,
                     "tower_shadow_method: note: " + std::to_string(*kind) +
                         (*kind == 1 || *kind == 3 ? ": its block is missing, there is no shadow"
                                                   : " (a jet) is left out"));
      import_.say("wind", *method, is_potential ? Fate::derived : Fate::ignored,
                  is_potential ? "wind.tower.potential: plain"
                  : *kind == 0 ? "none"
                               : "left out");
    }
    const Curve drag = read_tower_drag(diameter);
    if (diameter.grid.empty()) return;
    for (const Station& station : merge_places(diameter.grid, drag.grid)) {
      const double size = at_height(diameter, station.place);
      if (!(size > 0.0)) return;
      flow.heights.push_back(station.place);
      flow.diameters.push_back(size);
      flow.drags.push_back(drag.grid.empty() ? 0.0 : at_height(drag, station.place));
    }
    flow.drag_load = !drag.grid.empty();
    if (flow.heights.size() < 2) {
      flow.heights.push_back(flow.heights.front() + 1.0);
      flow.diameters.push_back(flow.diameters.front());
      flow.drags.push_back(flow.drags.front());
    }
    wind_.tower = flow;
    import_.note("wind.tower.sections", "radius of the tower shadow, drag of aerodrag");
    import_.note("wind.tower.potential", "tower_shadow_method");
  }

  static void mark(const HtcBlock& block, const std::vector<std::string>& names) {
    for (const HtcCommand& command : block.commands)
      if (std::ranges::find(names, command.name) != names.end()) command.used = true;
  }

  static std::vector<Station> merge_places(const std::vector<double>& a,
                                           const std::vector<double>& b) {
    std::vector<double> all = a;
    all.insert(all.end(), b.begin(), b.end());
    std::ranges::sort(all);
    std::vector<Station> places;
    for (const double place : all)
      if (places.empty() || place - places.back().place > 1e-6) places.push_back({place, false});
    return places;
  }

  static double at_height(const Curve& curve, double height) {
    return interpolate(curve, Station{height, false});
  }

  bool require_rising(Curve& curve, const std::string& place, const std::string& what) {
    if (curve.grid.size() > 1 && curve.grid.front() > curve.grid.back()) {
      std::ranges::reverse(curve.grid);
      std::ranges::reverse(curve.values);
    }
    for (std::size_t i = 0; i < curve.grid.size(); ++i)
      if ((i > 0 && !(curve.grid[i] > curve.grid[i - 1])) || !(curve.values[i] >= 0.0)) {
        import_.errors.add(place, what + ": expected places that rise, and numbers >= 0");
        return false;
      }
    if (curve.grid.empty()) {
      import_.errors.add(place, "expected at least one \"" + what + "\"");
      return false;
    }
    return true;
  }

  /// Drag coefficients of the tower; its widths where the shadow has no radii.
  Curve read_tower_drag(Curve& diameter) {
    Curve drag;
    std::map<std::string, std::string> others;  // by names, their places
    for (const HtcBlock& block : root().blocks) {
      if (block.name != "aerodrag") continue;
      block.used = true;
      for (const HtcBlock& part : block.blocks) {
        const HtcCommand* body = part.find("mbdy_name", "body_name");
        const std::string name =
            body == nullptr ? std::string() : to_lower(import_.word(*body, 0, "a body"));
        if (name != source_.tower || part.name != "aerodrag_element") {
          others.emplace(name.empty() ? part.name : name, part.place);
          import_.say(part, "aerodrag " + (name.empty() ? part.name : name), Fate::ignored,
                      "the air acts on blades and tower alone");
          continue;
        }
        mark(part, {"mbdy_name", "body_name", "aerodrag_sections", "update_states"});
        Curve width;
        for (const std::vector<double>& row : rows_of(part, "sec", 3)) {
          drag.grid.push_back(row[0]);
          drag.values.push_back(row[1]);
          width.grid.push_back(row[0]);
          width.values.push_back(row[2]);
        }
        import_.say(part, "aerodrag " + name, Fate::derived,
                    "drag of wind.tower.sections" +
                        std::string(diameter.grid.empty() ? ", and their diameters" : ""));
        if (!require_rising(drag, part.place, "sec") || !require_rising(width, part.place, "sec"))
          return drag;
        if (diameter.grid.empty())
          diameter = width;
        else
          compare_widths(diameter, width, part.place);
      }
    }
    for (const auto& [name, place] : others)
      import_.warn(place, "note: the drag of " + name + " (aerodrag) is left out");
    return drag;
  }

  void compare_widths(const Curve& diameter, const Curve& width, const std::string& place) {
    for (std::size_t i = 0; i < width.grid.size(); ++i) {
      const double size = at_height(diameter, width.grid[i]);
      if (std::abs(width.values[i] - size) > 1e-3 * size) {
        import_.warn(place, "note: the tower is " + rounded(width.values[i]) + " m wide here and " +
                                rounded(size) +
                                " m in the tower shadow: the case has the latter for both");
        return;
      }
    }
  }

  void read_turbulence(const HtcBlock& block) {
    const HtcCommand* format = block.find("turb_format");
    const auto kind =
        format == nullptr ? std::optional<int>(0) : import_.integer(*format, 0, 0, 100);
    if (format != nullptr)
      import_.say("wind", *format, Fate::ignored,
                  kind && *kind != 0 ? "turbulence is no part of a case" : "none");
    if (kind && *kind != 0)
      import_.warn(format->place,
                   "turb_format: note: the turbulence is left out, the case has the mean wind");
    static const std::map<std::string, const char*> known{
        {"tint", "turbulence is no part of a case"},
        {"scale_time_start", "turbulence is no part of a case"},
        {"wind_ramp_factor", "a change with time; the case has wsp"},
        {"wind_ramp_abs", "a change with time; the case has wsp"},
        {"wind_ramp_t0", "a change with time; the case has wsp"},
        {"iec_gust", "a change with time; the case has wsp"}};
    std::set<std::string> named;
    for (const HtcCommand& command : block.commands) {
      const auto found = known.find(command.name);
      if (command.used || found == known.end()) continue;
      import_.say("wind", command, Fate::ignored, found->second);
      const bool is_change = command.name.starts_with("wind_ramp") || command.name == "iec_gust";
      if (is_change && named.insert(command.name).second)
        import_.warn(command.place,
                     command.name + ": note: left out, the wind of the case is steady");
    }
    for (const HtcBlock& part : block.blocks)
      if (!part.used) {
        const bool is_turbulence =
            part.name == "mann" || part.name == "flex" || part.name == "turb_export";
        import_.say(part, "wind." + part.name, Fate::ignored,
                    is_turbulence ? "turbulence is no part of a case" : "a case has no such flow");
        if (!is_turbulence && !part.name.starts_with("tower_shadow"))
          import_.warn(part.place, "begin " + part.name + ": note: left out");
      }
  }

  // ---- models

  /// 0 where it is missing, with a default of HAWC2.
  int flag(const std::string& name, int standard, int high, const std::string& key) {
    const HtcCommand* command = source_.aero->find(name);
    if (command == nullptr) {
      import_.note(key, "not in the deck");
      return standard;
    }
    const auto value = import_.integer(*command, 0, 0, high);
    import_.say("aero", *command, Fate::derived, key);
    import_.note(key, name);
    return value.value_or(standard);
  }

  void read_models() {
    constexpr int most = 100;
    model::AeroDefinition aero;
    aero.thrust = model::ThrustLaw::madsen;
    aero.hub_loss = false;
    const int induction = flag("induction_method", 1, most, "aero.induction");
    aero.induction = induction == 0 ? model::Induction::none : model::Induction::full;
    if (induction > 1)
      import_.warn(source_.aero->find("induction_method")->place,
                   "induction_method: note: " + std::to_string(induction) +
                       " (near wake or others) is replaced by the balance of momentum");
    aero.tip_loss = flag("tiploss_method", 1, most, "aero.tip_loss") != 0;
    using Dynamics = model::AirfoilDynamics;
    const int stall = flag("dynstall_method", 2, most, "aero.airfoil_dynamics");
    aero.dynamics = stall == 0   ? Dynamics::quasi_steady
                    : stall == 1 ? Dynamics::oye
                                 : Dynamics::hgm;
    if (stall > 2)
      import_.warn(source_.aero->find("dynstall_method")->place,
                   "dynstall_method: note: " + std::to_string(stall) +
                       " is replaced by that of Hansen, Gaunaa and Madsen (2)");
    for (const HtcBlock& part : source_.aero->blocks) {
      if (part.name != "dynstall_mhh") {
        import_.say(part, "aero." + part.name, Fate::ignored, "a case has no such model");
        import_.warn(part.place, "begin " + part.name + ": note: left out");
        continue;
      }
      part.used = true;
      read_constants(part, aero);
    }
    import_.report.push_back(
        {source_.aero->place, "begin aero", Fate::derived,
         "thrust, hub_loss as in HAWC2; its dynamic inflow and its model of yaw are replaced by "
         "inflow: oye and skew: pitt_peters"});
    import_.note("aero.thrust", "the polynomial of HAWC2");
    import_.note("aero.hub_loss", "HAWC2 has none");
    import_.note("aero.skew", "not that of HAWC2, which has a model of its own");
    import_.note("aero.inflow", "HAWC2 has a model of its own with two lags in parallel");
    has_air_ = flag("aerocalc_method", 1, most, "aero") != 0;
    import_.comments.keys.erase("aero");
    if (has_air_)
      import_.turbine.aero = aero;
    else
      import_.warn(source_.aero->find("aerocalc_method")->place,
                   "aerocalc_method: note: 0: no loads of the air (aero: none)");
  }

  void read_constants(const HtcBlock& block, model::AeroDefinition& aero) {
    const std::map<std::string, std::pair<double*, const char*>> known{
        {"a1", {&aero.wake[0], "aero.wake_constants"}},
        {"a2", {&aero.wake[1], "aero.wake_constants"}},
        {"b1", {&aero.wake[2], "aero.wake_constants"}},
        {"b2", {&aero.wake[3], "aero.wake_constants"}},
        {"taupre", {&aero.pressure_lag, "aero.T_p"}},
        {"taubly", {&aero.separation_lag, "aero.T_f"}}};
    for (const HtcCommand& command : block.commands) {
      const auto found = known.find(command.name);
      if (found == known.end()) continue;
      const auto value = import_.number(command, 0);
      if (!value) continue;
      if (!(*value > 0.0))
        import_.errors.add(command.place, command.name + ": expected a number > 0");
      *found->second.first = *value;
      import_.say("aero.dynstall_mhh", command, Fate::taken, found->second.second);
      import_.note(found->second.second, "dynstall_mhh");
    }
  }

  // ---- sections

  void read_sections() {
    const HtcCommand* layout = import_.require(*source_.aero, "ae_filename");
    const HtcCommand* polars = import_.require(*source_.aero, "pc_filename");
    if (layout == nullptr || polars == nullptr) return;
    int set = 1;
    if (const HtcCommand* sets = source_.aero->find("ae_sets")) {
      for (std::size_t i = 0; i < std::max<std::size_t>(sets->words.size(), 1); ++i) {
        const auto value = import_.integer(*sets, i, 1, 100000);
        if (!value) return;
        if (i > 0 && *value != set) {
          import_.errors.add(sets->place, "ae_sets: blades with different sets cannot be imported");
          return;
        }
        set = *value;
      }
      import_.say("aero", *sets, Fate::derived, "set " + std::to_string(set) + " of ae_filename");
    }
    const std::string layout_word = import_.word(*layout, 0, "the name of a file");
    const std::string polars_word = import_.word(*polars, 0, "the name of a file");
    const std::string layout_path =
        layout_word.empty() ? "" : import_.deck.find_file(layout_word, layout->place);
    const std::string polars_path =
        polars_word.empty() ? "" : import_.deck.find_file(polars_word, polars->place);
    if (layout_path.empty() || polars_path.empty()) return;
    const std::vector<AeRow> rows = read_ae(layout_path, set, import_.errors);
    if (rows.empty()) return;
    std::vector<int> wanted;
    for (const AeRow& row : rows)
      if (std::ranges::find(wanted, row.set) == wanted.end()) wanted.push_back(row.set);
    const auto found = read_pc(polars_path, wanted, import_.errors);
    if (found.empty()) return;
    add_airfoils(found, polars_path);
    if (!import_.errors.empty()) return;
    add_sections(rows, layout_path, wanted.size() == 1);
    import_.say(
        "aero", *layout, Fate::derived,
        "blades.aero_sections: place, chord, thickness; " + std::to_string(rows.size()) + " rows");
    import_.say(
        "aero", *polars, Fate::derived,
        "blades.airfoils, " + std::to_string(import_.turbine.blades.airfoils.size()) + " polars");
    import_.note("blades.airfoils", "pc_filename, by thickness");
    import_.note("blades.aero_sections",
                 "ae_filename; twist of the half-chord line; center: a quarter of the chord before "
                 "it");
  }

  void add_airfoils(const std::map<int, std::vector<PcPolar>>& sets, const std::string& path) {
    Airfoils& airfoils = import_.turbine.blades.airfoils;
    for (const auto& [set, polars] : sets)
      for (const PcPolar& polar : polars) {
        model::AirfoilDefinition airfoil;
        airfoil.thickness = std::min(polar.thickness, 1.0);
        model::PolarDefinition own;
        own.angles = polar.angles;
        for (double* end : {&own.angles.front(), &own.angles.back()})
          if (std::abs(std::abs(*end) - std::numbers::pi) <= same_angle)
            *end = std::copysign(std::numbers::pi, *end);
        own.lift = polar.lift;
        own.drag = polar.drag;
        own.moment = polar.moment;
        if (const std::string fault = model::find_polar_fault(own); !fault.empty())
          import_.errors.add(path + ":" + std::to_string(polar.line),
                             "polar of " + rounded(100.0 * polar.thickness) + " % of set " +
                                 std::to_string(set) + ": " + fault);
        airfoil.polars.push_back(std::move(own));
        const std::string name =
            name_airfoil((sets.size() > 1 ? "set " + std::to_string(set) + " " : std::string()) +
                             "t " + plain_percent(polar.thickness),
                         airfoils);
        names_[set].push_back(name);
        airfoils[name] = std::move(airfoil);
      }
  }

  static std::string plain_percent(double thickness) {
    std::string text = rounded(100.0 * thickness, 5);
    std::ranges::replace(text, '.', '_');
    return text;
  }

  void add_sections(const std::vector<AeRow>& rows, const std::string& path, bool by_thickness) {
    const model::BeamDefinition& beam = import_.turbine.blades.beam;
    const double length = beam.length;
    if (std::abs(rows.back().r - length) > length_tolerance * length)
      import_.warn(path + ":" + std::to_string(rows.back().line),
                   "note: the aerodynamic layout ends at " + rounded(rows.back().r) +
                       " m, the line of the blade at " + rounded(length) + " m");
    Curve chord;
    Curve thickness;
    for (const AeRow& row : rows) {
      chord.grid.push_back(row.r / length);
      chord.values.push_back(row.chord);
      thickness.values.push_back(row.thickness);
    }
    thickness.grid = chord.grid;
    const auto& first = names_.begin()->second;
    const double least = *import_.turbine.blades.airfoils[first.front()].thickness;
    const double most = *import_.turbine.blades.airfoils[first.back()].thickness;
    std::vector<double> grid;
    for (const double place : chord.grid)
      if (place <= 1.0) grid.push_back(place);
    bool is_beyond = false;
    for (const Station& station : merge_grids({&grid, &source_.twist.grid})) {
      if (station.behind) continue;
      model::AeroSectionDefinition section;
      section.at = std::min(station.place, 1.0);
      section.chord = interpolate(chord, station);
      section.twist = interpolate(source_.twist, station);
      section.center = {quarter * section.chord, 0.0};
      const double own = interpolate(thickness, station);
      is_beyond = is_beyond || own < least - 1e-4 || own > most + 1e-4;
      if (by_thickness)
        section.thickness = std::clamp(own, least, most);
      else
        section.airfoil = mixed_airfoil(set_at(rows, section.at * length), own);
      import_.turbine.blades.aero_sections.push_back(section);
    }
    set_air_mesh(import_.turbine.blades.beam);
    if (by_thickness && is_beyond)
      import_.warn(path, "note: sections thinner or thicker than all polars (" +
                             rounded(100.0 * least) + " to " + rounded(100.0 * most) +
                             " %) have the nearest polar");
    if (!by_thickness)
      import_.warn(path,
                   "note: sections of several sets of polars: each has the mixed airfoil of its "
                   "thickness, linear along the blade in between");
  }

  static int set_at(const std::vector<AeRow>& rows, double r) {
    std::size_t i = 0;
    while (i + 1 < rows.size() && rows[i + 1].r <= r * (1.0 + 1e-12)) ++i;
    return rows[i].set;
  }

  /// The airfoil of a set at a thickness between its polars.
  std::string mixed_airfoil(int set, double thickness) {
    Airfoils& airfoils = import_.turbine.blades.airfoils;
    const std::vector<std::string>& names = names_[set];
    std::size_t b = 0;
    while (b + 1 < names.size() && *airfoils[names[b]].thickness < thickness) ++b;
    const double upper = *airfoils[names[b]].thickness;
    if (b == 0 || thickness >= upper) return names[b];
    const double lower = *airfoils[names[b - 1]].thickness;
    const std::string name =
        name_airfoil("set " + std::to_string(set) + " t " + plain_percent(thickness), airfoils);
    airfoils[name] = mix_airfoils(airfoils[names[b - 1]], airfoils[names[b]],
                                  (thickness - lower) / (upper - lower));
    return name;
  }

  HtcImport& import_;
  const HtcAirSource& source_;
  model::WindDefinition wind_;
  std::map<int, std::vector<std::string>> names_;  ///< of airfoils in the case, by sets
  bool has_air_ = true;
};

}  // namespace

HtcRotor read_htc_rotor(HtcImport& import) {
  HtcRotor rotor;
  rotor.block = import.deck.root().find_block("aero");
  if (rotor.block == nullptr) {
    import.errors.add(import.deck.path(),
                      "missing block \"begin aero\", whose links name the blades; hint: the file "
                      "may be cut off");
    return rotor;
  }
  const HtcBlock& block = *rotor.block;
  block.used = true;
  const HtcCommand* count = import.require(block, "nblades");
  const auto blades = count == nullptr ? std::optional<int>() : import.integer(*count, 0, 1, 100);
  if (!blades) return rotor;
  import.say("aero", *count, Fate::taken, "blades.count");
  import.note("blades.count", "nblades");
  rotor.blades.resize(static_cast<std::size_t>(*blades));
  for (const HtcCommand& command : block.commands) {
    if (command.name != "link") continue;
    const auto number = import.integer(command, 0, 1, *blades);
    const std::string name = to_lower(import.word(command, 2, "the name of a body"));
    if (!number || name.empty()) continue;
    std::string& known = rotor.blades[static_cast<std::size_t>(*number) - 1];
    if (!known.empty())
      import.errors.add(command.place,
                        "link: blade " + std::to_string(*number) + " is given twice");
    known = name;
    import.say("aero", command, Fate::derived,
               "blade " + std::to_string(*number) + " is the body " + name);
  }
  for (std::size_t i = 0; i < rotor.blades.size(); ++i)
    if (rotor.blades[i].empty())
      import.errors.add(block.place,
                        "begin aero: there is no link of blade " + std::to_string(i + 1));
  if (const HtcCommand* hub = import.require(block, "hub_vec")) {
    rotor.hub_body = to_lower(import.word(*hub, 0, "the name of a body"));
    const auto axis = import.integer(*hub, 1, -3, 3);
    if (axis && *axis == 0) import.errors.add(hub->place, "hub_vec: expected -3 to 3, not 0");
    rotor.hub_axis = axis.value_or(0);
    rotor.place = hub->place;
    import.say("aero", *hub, Fate::derived, "the axis of the rotor and the sense of its turning");
  }
  return rotor;
}

void read_htc_air(HtcImport& import, const HtcAirSource& source) {
  AirReader(import, source).read();
}

}  // namespace samara::decks
