#include "import_aerodyn.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "samara/base/error.hpp"
#include "samara/base/words.hpp"
#include "samara/io/polar_file.hpp"
#include "samara/io/whole_file.hpp"
#include "samara/model/airfoil.hpp"

#include "import_air.hpp"
#include "import_common.hpp"

namespace samara::decks {
namespace {

using model::AirfoilDynamics;
using model::Induction;
using model::Inflow;
using model::ThrustLaw;

constexpr std::size_t max_megabytes = 16;
constexpr int most_airfoils = 1000;
constexpr int most_nodes = 10000;

/// The last node may be this far beyond the tip [of the length].
constexpr double beyond_the_tip = 1e-2;

/// The place whose airfoil has the constants of the airfoil dynamics [of the length].
constexpr double typical_place = 0.75;

/// Constants of the airfoil dynamics of an airfoil file, with OpenFAST's defaults.
struct DynamicsConstants {
  std::array<double, 4> wake{0.3, 0.7, 0.14, 0.53};  ///< A1, A2, b1, b2
  double pressure_lag = 1.7;
  double separation_lag = 3.0;
  double cut_out_deg = 45.0;

  bool operator==(const DynamicsConstants&) const = default;
};

/// The rows of a blade file.
struct BladeTable {
  std::unique_ptr<Deck> deck;
  DeckTable table;
};

enum Column { span, curve, sweep, curve_angle, twist, chord, airfoil_id };

const std::vector<std::string>& column_names() {
  static const std::vector<std::string> names{"BlSpn",   "BlCrvAC", "BlSwpAC", "BlCrvAng",
                                              "BlTwist", "BlChord", "BlAFID"};
  return names;
}

class AerodynImporter {
 public:
  AerodynImporter(OpenfastImport& import, const AerodynSource& source)
      : import_(import), source_(source) {}

  AerodynModels read() {
    deck_ = import_.open(source_.path);
    if (!deck_) return {};
    is_new_ = deck().has("Wake_Mod") || deck().has("Skew_Mod") || deck().has("UA_Mod");
    read_density();
    read_induction();
    read_skew();
    read_dynamics();
    read_tower();
    read_nacelle();
    read_airfoils();
    read_blades();
    if (import_.errors.empty()) {
      place_sections();
      take_constants();
    }
    say_left_out();
    import_.report_unused(*deck_);
    return models_;
  }

 private:
  Deck& deck() { return *deck_; }

  /// A number that files since OpenFAST 4 have, and older ones may lack.
  int integer_since_4(const std::string& key, int value) {
    return static_cast<int>(is_new_ ? deck().number(key) : deck().number_or(key, value));
  }

  void derive(const std::string& key, const std::string& words) {
    if (deck().has(key)) import_.say(deck(), key, Fate::derived, words);
  }

  void comment(const std::string& key, const std::string& words) {
    import_.note("aero." + key, words);
  }

  /// Says that the case has another model than the deck.
  void replace(const std::string& key, const std::string& words) {
    derive(key, words);
    import_.warn(deck().place_of(key), key + ": note: " + words);
  }

  // ---- models

  void read_density() {
    if (!deck().has("AirDens")) import_.errors.add(deck().path(), "missing key \"AirDens\"");
    const double density = deck().number_or_default("AirDens", source_.air_density);
    models_.density = density;
    import_.require(density > 0.0, deck(), "AirDens", "expected a number > 0");
    derive("AirDens",
           density == source_.air_density ? "wind.density, as in the main file" : "wind.density");
  }

  void read_induction() {
    const std::string key = is_new_ ? "Wake_Mod" : "WakeMod";
    const int wake = deck().integer(key, 0, 3);
    const bool has_swirl = deck().flag("TanInd");
    if (wake == 0) {
      models_.aero.induction = Induction::none;
      derive(key, "aero.induction: none");
      comment("induction", key + " 0");
      for (const char* unused : {"TanInd", "TipLoss", "HubLoss", "AIDrag", "TIDrag", "BEM_Mod",
                                 "DBEMT_Mod", "tau1_const"})
        import_.ignore(deck(), unused, "there is no induced velocity");
      return;
    }
    models_.aero.induction = has_swirl ? Induction::full : Induction::axial;
    const std::string words = has_swirl ? "aero.induction: full" : "aero.induction: axial";
    comment("induction", key + " " + std::to_string(wake) + ", TanInd");
    if (wake == 3)
      replace(
          key,
          "3, vortices of the wake (OLAF): the case has the balance of momentum instead, " + words);
    else
      derive(key, words);
    derive("TanInd", words);
    const auto take_flag = [&](const char* name, const char* target, bool& value) {
      value = deck().flag(name);
      import_.say(deck(), name, Fate::taken, std::string("aero.") + target);
      comment(target, name);
    };
    take_flag("TipLoss", "tip_loss", models_.aero.tip_loss);
    take_flag("HubLoss", "hub_loss", models_.aero.hub_loss);
    take_flag("AIDrag", "axial_drag", models_.aero.axial_drag);
    take_flag("TIDrag", "tangential_drag", models_.aero.tangential_drag);
    read_thrust();
    read_inflow(is_new_ ? wake != 3 : wake == 2);
  }

  void read_thrust() {
    const bool is_polar = integer_since_4("BEM_Mod", 1) == 2;
    models_.aero.thrust = is_polar ? ThrustLaw::glauert_skew : ThrustLaw::buhl_f;
    const std::string words =
        is_polar ? "aero.thrust: glauert_skew" : "aero.thrust: buhl_f, AeroDyn's parabola";
    derive("BEM_Mod", words);
    comment("thrust", deck().has("BEM_Mod") ? "BEM_Mod" : "as AeroDyn without BEM_Mod");
  }

  void read_inflow(bool may_lag) {
    const int mode = may_lag ? static_cast<int>(deck().number("DBEMT_Mod")) : 0;
    models_.aero.inflow = mode == 0 ? Inflow::equilibrium : Inflow::oye;
    comment("inflow", may_lag ? "DBEMT_Mod " + std::to_string(mode) : "no dynamic wake");
    if (mode == 0) {
      derive("DBEMT_Mod", "aero.inflow: equilibrium");
      import_.ignore(deck(), "tau1_const", "there is no dynamic wake");
      return;
    }
    if (mode < 0) {
      models_.aero.inflow = Inflow::frozen;
      derive("DBEMT_Mod", "aero.inflow: frozen");
      import_.ignore(deck(), "tau1_const", "the wake is frozen");
      return;
    }
    derive("DBEMT_Mod", "aero.inflow: oye");
    if (mode != 1 && mode != 3) {
      import_.ignore(deck(), "tau1_const", "aero.tau1 follows from the wind, as with DBEMT_Mod 2");
      return;
    }
    const double tau1 = deck().number("tau1_const");
    import_.require(tau1 > 0.0, deck(), "tau1_const", "expected a number > 0");
    if (!(tau1 > 0.0)) return;
    models_.aero.tau1 = tau1;
    import_.say(deck(), "tau1_const", Fate::taken, "aero.tau1");
    comment("tau1", "tau1_const");
  }

  void read_skew() {
    if (models_.aero.induction == Induction::none) return;
    const std::string key = is_new_ ? "Skew_Mod" : "SkewMod";
    // Older files: 1 is uncoupled, without correction; 2 is Pitt and Peters.
    const int mode = static_cast<int>(deck().number(key));
    if (is_new_ && !deck().has("SkewRedistr_Mod"))
      import_.errors.add(deck().path(), "missing key \"SkewRedistr_Mod\"");
    const int redistribution = static_cast<int>(deck().number_or_default("SkewRedistr_Mod", 1.0));
    const bool has_correction = is_new_ ? mode == 1 && redistribution == 1 : mode == 2;
    const std::string factor = is_new_ ? "SkewRedistrFactor" : "SkewModFactor";
    models_.aero.skew =
        has_correction ? deck().number_or_default(factor, elements::pitt_peters_skew) : 0.0;
    comment("skew", key);
    const std::string words = has_correction ? "aero.skew" : "aero.skew: none";
    if (is_new_ && mode < 0)
      replace(key, std::to_string(mode) +
                       ": wind across the shaft is left in the balance of momentum, " + words);
    else
      derive(key, words);
    derive("SkewRedistr_Mod", words);
    derive(factor, words);
    import_.require(models_.aero.skew >= 0.0, deck(), factor, "expected a number >= 0");
    if (deck().flag_or("SkewMomCorr", false))
      derive("SkewMomCorr", "True: as aero.thrust: glauert_skew has it");
    else
      import_.ignore(deck(), "SkewMomCorr",
                     "False; aero.thrust: glauert_skew has the wind in the plane of the rotor");
  }

  void read_dynamics() {
    std::string key = "UA_Mod";
    int mode = 0;
    if (is_new_) {
      mode = deck().integer("UA_Mod", 0, 7);
      if (!deck().has("AoA34")) import_.errors.add(deck().path(), "missing key \"AoA34\"");
    } else {
      key = "UAMod";
      const bool is_steady = deck().integer("AFAeroMod", 1, 2) == 1;
      mode = is_steady ? 0 : deck().integer("UAMod", 1, 7);
      derive("AFAeroMod", is_steady ? "1: no airfoil dynamics" : "2: see UAMod");
      if (is_steady) import_.ignore(deck(), "UAMod", "AFAeroMod is 1");
    }
    // Files without AoA34 take the angle of attack at the aerodynamic centre without dynamics.
    const bool is_behind = deck().flag_or_default("AoA34", is_new_);
    has_constants_ = mode != 0;
    const std::string number = std::to_string(mode);
    if (mode == 0) {
      models_.aero.dynamics =
          is_behind ? AirfoilDynamics::quasi_steady : AirfoilDynamics::static_polar;
      const std::string words = is_behind ? "aero.airfoil_dynamics: quasi_steady"
                                          : "aero.airfoil_dynamics: static, at the aerodynamic "
                                            "centre";
      derive(key, words);
      derive("AoA34", words);
      comment("airfoil_dynamics", key + " 0, AoA34");
      return;
    }
    comment("airfoil_dynamics", key + " " + number);
    import_.ignore(deck(), "AoA34",
                   "airfoil dynamics have the angle of attack at 3/4 of the chord");
    if (mode == 6) {
      models_.aero.dynamics = AirfoilDynamics::oye;
      derive(key, "aero.airfoil_dynamics: oye");
    } else if (mode == 4) {
      derive(key, "aero.airfoil_dynamics: hgm");
    } else if (mode == 5) {
      replace(key, "5: aero.airfoil_dynamics: hgm, without the vortex of the leading edge");
    } else {
      replace(key, number +
                       ", a model of its own: aero.airfoil_dynamics: hgm, the continuous form of "
                       "Beddoes and Leishman");
    }
  }

  /// A number, or a flag in other versions; 0 without.
  double number_or_flag(const char* key) {
    if (!deck().has(key)) return 0.0;
    const std::optional<double> value = parse_number(deck().text(key));
    return value ? *value : (deck().flag(key) ? 1.0 : 0.0);
  }

  /// The flow around the tower and its drag.
  void read_tower() {
    using Flow = model::TowerFlowDefinition;
    const int potential = static_cast<int>(number_or_flag("TwrPotent"));
    const int shadow = static_cast<int>(number_or_flag("TwrShadow"));
    const bool has_drag = number_or_flag("TwrAero") != 0.0;
    for (const auto& [key, value, most] :
         {std::tuple("TwrPotent", potential, 2), std::tuple("TwrShadow", shadow, 2)})
      if (deck().has(key))
        import_.require(value >= 0 && value <= most, deck(), key, "expected 0, 1 or 2");
    const std::vector<const char*> keys{"TwrPotent", "TwrShadow", "TwrAero"};
    for (const char* key : keys)
      if (!deck().has(key))
        import_.errors.add(deck().path(), std::string("missing key \"") + key + "\"");
    if (potential == 0 && shadow == 0 && !has_drag) {
      for (const char* key : keys) import_.ignore(deck(), key, "off");
      import_.ignore(deck(), "NumTwrNds", "the tower is not in the wind");
      return;
    }
    Flow flow;
    flow.potential = potential == 0   ? Flow::Potential::none
                     : potential == 1 ? Flow::Potential::plain
                                      : Flow::Potential::bak;
    flow.wake = shadow == 0   ? Flow::Wake::none
                : shadow == 1 ? Flow::Wake::powles
                              : Flow::Wake::eames;
    flow.drag_load = has_drag;
    derive("TwrPotent", "wind.tower.potential");
    derive("TwrShadow", "wind.tower.wake");
    derive("TwrAero", "wind.tower.drag_load");
    std::vector<std::string> columns{"TwrElev", "TwrDiam", "TwrCd"};
    if (shadow == 2) columns.emplace_back("TwrTI");
    const std::size_t errors_before = import_.errors.size();
    const int count = deck().integer("NumTwrNds", 1, most_nodes);
    if (import_.errors.size() > errors_before) return;
    const DeckTable table = deck().table(columns, count, "NumTwrNds");
    if (import_.errors.size() > errors_before) return;
    import_.say(deck(), "NumTwrNds", Fate::derived, "wind.tower.sections");
    flow.heights = table.columns[0];
    flow.diameters = table.columns[1];
    flow.drags = table.columns[2];
    for (std::size_t i = 0; i < flow.heights.size(); ++i) {
      const auto require = [&](bool holds, const std::string& words) {
        if (!holds) import_.errors.add(deck().path() + ":" + std::to_string(table.lines[i]), words);
      };
      require(i == 0 || flow.heights[i] > flow.heights[i - 1], "TwrElev: the heights do not rise");
      require(flow.diameters[i] > 0.0, "TwrDiam: expected a number > 0");
      require(flow.drags[i] >= 0.0, "TwrCd: expected a number >= 0");
    }
    if (shadow == 2) {
      flow.turbulence = 0.0;
      for (const double intensity : table.columns[3])
        flow.turbulence += intensity / static_cast<double>(count);
      import_.require(flow.turbulence > 0.0, deck(), "TwrShadow", "expected TwrTI > 0");
    }
    models_.tower = flow;
  }

  /// The drag of the nacelle. AeroDyn's y points to the left of one who looks downwind.
  void read_nacelle() {
    if (!deck().has("NacelleDrag")) return;
    if (!deck().flag("NacelleDrag")) {
      import_.ignore(deck(), "NacelleDrag", "False");
      return;
    }
    import_.say(deck(), "NacelleDrag", Fate::taken, "wind.nacelle");
    const Vector3 areas = deck().three_numbers("NacArea");
    const Vector3 drags = deck().three_numbers("NacCd");
    const Vector3 center = deck().three_numbers("NacDragAC");
    import_.require(areas.minCoeff() >= 0.0, deck(), "NacArea", "expected numbers >= 0");
    import_.require(drags.minCoeff() >= 0.0, deck(), "NacCd", "expected numbers >= 0");
    import_.say(deck(), "NacArea", Fate::derived, "wind.nacelle.areas");
    import_.say(deck(), "NacCd", Fate::derived, "wind.nacelle.drag");
    import_.say(deck(), "NacDragAC", Fate::derived, "wind.nacelle.center");
    models_.nacelle = model::NacelleDragDefinition{{areas(1), areas(0), areas(2)},
                                                   {drags(1), drags(0), drags(2)},
                                                   {-center(1), center(0), center(2)}};
  }

  void say_left_out() {
    std::string names;
    const auto leave = [&](const char* key, bool is_on, const char* words) {
      if (!deck().has(key)) return;
      import_.ignore(deck(), key, is_on ? std::string(words) + " is left out" : "off");
      if (is_on) names += (names.empty() ? "" : ", ") + std::string(words) + " (" + key + ")";
    };
    const auto is_set = [&](const char* key) { return number_or_flag(key) != 0.0; };
    leave("TFinAero", is_set("TFinAero"), "the air at the tail fin");
    leave("Buoyancy", is_set("Buoyancy"), "buoyancy");
    leave("FrozenWake", is_set("FrozenWake"), "the frozen wake of a linearization");
    leave("SectAvg", is_set("SectAvg"), "averaging of the wind over sectors");
    import_.ignore(deck(), "FLookup", "the separation follows from the polars");
    for (const char* key : {"UAStartRad", "UAEndRad"})
      import_.ignore(deck(), key, "airfoil dynamics act where the lift has a slope");
    import_.ignore(deck(), "KinVisc", "Reynolds numbers of a case have that of air at 15 degrees");
    for (const char* key : {"IndToler", "MaxIter"})
      import_.ignore(deck(), key, "a setting of the solution");
    if (!names.empty()) import_.warn(deck().path(), "note: left out: " + names);
  }

  // ---- airfoils

  void read_airfoils() {
    for (const auto& [key, column] : {std::pair<const char*, double>{"InCol_Alfa", 1.0},
                                      {"InCol_Cl", 2.0},
                                      {"InCol_Cd", 3.0}}) {
      const double value = deck().number(key);
      import_.require(value == column, deck(), key,
                      "expected " + rounded(column) +
                          "; the columns of a polar are read in the order Alpha, Cl, Cd, Cm");
      derive(key, "the order of the columns of a polar");
    }
    const double moment = deck().number("InCol_Cm");
    import_.require(moment == 4.0 || moment == 0.0, deck(), "InCol_Cm", "expected 4, or 0 without");
    const bool uses_moment = deck().flag("UseBlCm");
    derive("InCol_Cm", "the order of the columns of a polar");
    derive("UseBlCm", uses_moment ? "True: Cm of the polars" : "False: Cm of all polars is 0");
    has_moment_ = moment != 0.0 && uses_moment;
    const int tables = integer_since_4("AFTabMod", 1);
    is_first_table_ = tables != 2;
    derive("AFTabMod", is_first_table_ ? "the first table of each file" : "all tables of a file");
    if (tables == 3)
      import_.warn(deck().place_of("AFTabMod"),
                   "AFTabMod: note: 3, tables by a control setting: the first table is taken");

    const int count = deck().integer("NumAFfiles", 1, most_airfoils);
    const std::vector<Deck::Word> names = deck().first_words("AFNames", count);
    if (!deck().has("AFNames")) {
      import_.errors.add(deck().path(), "missing key \"AFNames\", the files of the airfoils");
      return;
    }
    import_.say(deck(), "NumAFfiles", Fate::derived, "blades.airfoils");
    import_.say(deck(), "AFNames", Fate::taken, "blades.airfoils, as tables");
    if (static_cast<int>(names.size()) < count)
      import_.errors.add(deck().place_of("AFNames"),
                         "AFNames: expected " + std::to_string(count) +
                             " lines with names of files, as NumAFfiles states");
    for (const Deck::Word& word : names) read_airfoil(word);
    import_.note("blades.airfoils", "airfoil files of AeroDyn");
  }

  void read_airfoil(const Deck::Word& word) {
    names_.emplace_back();
    constants_.emplace_back();
    const std::string path = deck().file_named(word.text, word.line, "AFNames");
    paths_.push_back(path);
    if (path.empty()) {
      if (word.text.empty())
        import_.errors.add(deck().place(word.line), "AFNames: expected the name of a file");
      return;
    }
    const auto place = static_cast<std::size_t>(std::ranges::find(paths_, path) - paths_.begin());
    if (place + 1 < paths_.size()) {
      names_.back() = names_[place];
      constants_.back() = constants_[place];
      return;
    }
    try {
      model::AirfoilDefinition airfoil;
      std::string text = io::read_whole_file(path, max_megabytes, "polar file");
      if (is_first_table_) keep_first_table(text);
      airfoil.polars = io::parse_polars(path, text);
      for (model::PolarDefinition& polar : airfoil.polars) {
        if (!has_moment_) std::ranges::fill(polar.moment, 0.0);
        if (const std::string fault = model::find_polar_fault(polar); !fault.empty())
          throw InputError(path + ": " + fault);
      }
      auto& airfoils = import_.turbine.blades.airfoils;
      const std::string name =
          name_airfoil(clean_text(std::filesystem::path(path).stem().string()), airfoils);
      airfoils[name] = std::move(airfoil);
      names_.back() = name;
      if (has_constants_) read_constants(path);
    } catch (const InputError& error) {
      import_.errors.add_message(error.what());
    }
  }

  /// The reader of polars takes as many tables as NumTabs states.
  static void keep_first_table(std::string& text) {
    const std::string key = "numtabs";
    const auto is_same = [](char a, char b) { return to_lower(a) == b; };
    const auto found = std::search(text.begin(), text.end(), key.begin(), key.end(), is_same);
    if (found == text.end()) return;
    const auto place = static_cast<std::size_t>(found - text.begin());
    const std::size_t line = text.find_last_of("\r\n", place);
    const std::size_t first =
        text.find_first_not_of(" \t", line == std::string::npos ? 0 : line + 1);
    const std::size_t end = text.find_first_of(" \t", first);
    const bool is_number = end <= place && text[first] >= '1' && text[first] <= '9';
    if (is_number) text.replace(first, end - first, "1");
  }

  /// A file with several tables has its keys several times: the first ones count.
  void read_constants(const std::string& path) {
    DeckErrors unused;
    Deck file(path, unused);
    DynamicsConstants& constants = constants_.back();
    const auto read = [&](const char* key, double& value) {
      const double number = file.number_or_default(key, value);
      if (number > 0.0) value = number;
    };
    read("A1", constants.wake[0]);
    read("A2", constants.wake[1]);
    read("b1", constants.wake[2]);
    read("b2", constants.wake[3]);
    read("T_p", constants.pressure_lag);
    read("T_f0", constants.separation_lag);
    read("UACutout", constants.cut_out_deg);
  }

  // ---- blades

  void read_blades() {
    std::vector<std::string> paths;
    for (int k = 1; k <= source_.blades; ++k) {
      const std::string key = "ADBlFile(" + std::to_string(k) + ")";
      const std::string path = deck().file(key);
      import_.say(deck(), key, Fate::taken, "blades.aero_sections");
      if (path.empty() || std::ranges::find(paths, path) != paths.end()) continue;
      paths.push_back(path);
      BladeTable blade = read_blade(path);
      if (!blade.deck) continue;
      if (!first_.deck)
        first_ = std::move(blade);
      else if (blade.table.columns != first_.table.columns)
        import_.errors.add(deck().place_of(key),
                           key + ": differs from blade 1 (" + paths[0] +
                               "); a case has the same aerodynamic sections on all blades; hint: "
                               "CompAero 0 imports the structure alone");
    }
    for (int k = source_.blades + 1; k <= 3; ++k)
      import_.ignore(deck(), "ADBlFile(" + std::to_string(k) + ")", "this rotor does not use it");
  }

  BladeTable read_blade(const std::string& path) {
    BladeTable blade;
    blade.deck = import_.open(path);
    if (!blade.deck) return blade;
    Deck& file = *blade.deck;
    const std::size_t errors_before = import_.errors.size();
    const int count = file.integer("NumBlNds", 2, most_nodes);
    blade.table = file.table(column_names(), count, "NumBlNds");
    if (import_.errors.size() == errors_before) check_rows(file, blade.table);
    if (import_.errors.size() > errors_before) blade.deck = nullptr;
    return blade;
  }

  void check_rows(Deck& file, const DeckTable& table) {
    for (std::size_t i = 0; i < table.lines.size(); ++i) {
      const std::string place = file.place(table.lines[i]);
      const double size = table.columns[chord][i];
      if (!(size > 0.0))
        import_.errors.add(place, "BlChord: expected a number > 0, got " + rounded(size) +
                                      "; hint: a blade without lift there has an airfoil of small "
                                      "chord");
      const double id = table.columns[airfoil_id][i];
      if (!(id >= 1.0 && id <= static_cast<double>(names_.size()) && id == std::floor(id)))
        import_.errors.add(
            place, "BlAFID: expected an integer from 1 to " + std::to_string(names_.size()) +
                       ", the number of airfoil files (NumAFfiles), got " + rounded(id));
      if (i > 0 && !(table.columns[span][i] > table.columns[span][i - 1]))
        import_.errors.add(place, "BlSpn: expected more than in the row before, " +
                                      rounded(table.columns[span][i - 1]) + ", got " +
                                      rounded(table.columns[span][i]));
    }
  }

  void place_sections() {
    const DeckTable& table = first_.table;
    model::BladesDefinition& blades = import_.turbine.blades;
    const double length = blades.beam.length;
    const SectionPlacement placement(blades.beam);
    for (std::size_t i = 0; i < table.lines.size(); ++i) {
      const auto value = [&](Column column) { return table.columns[column][i]; };
      const double angle = fields::deg.to_si(value(twist));
      const double lean = fields::deg.to_si(value(curve_angle));
      AeroPoint point;
      point.center = turn_to_section_axes(Vector3(value(curve), value(sweep), value(span)));
      // The plane of the airfoil is turned about y, then the chord in that plane.
      point.forward = Vector3(std::sin(angle) * std::sin(lean), std::cos(angle),
                              -std::sin(angle) * std::cos(lean));
      model::AeroSectionDefinition section;
      section.chord = value(chord);
      section.airfoil = names_[static_cast<std::size_t>(value(airfoil_id)) - 1];
      placement.place(point, section);
      if (lean == 0.0 && blades.beam.reference_line.empty()) section.twist = angle;
      if (!blades.aero_sections.empty() && !(section.at > blades.aero_sections.back().at)) {
        import_.warn(first_.deck->place(table.lines[i]),
                     "BlSpn: note: this row is left out, its place on the blade is that of the row "
                     "before");
        continue;
      }
      blades.aero_sections.push_back(section);
    }
    const double last = table.columns[span].back();
    if (blades.beam.reference_line.empty() && last > (1.0 + beyond_the_tip) * length)
      import_.warn(first_.deck->place(table.lines.back()),
                   "BlSpn: warning: the last node, " + rounded(last) +
                       " m, is beyond the tip of the blade at " + rounded(length) + " m");
    import_.say(*first_.deck, "NumBlNds", Fate::derived, "blades.aero_sections");
    const auto say = [&](const char* names, Fate fate, const char* words) {
      import_.say_line(*first_.deck, table.line, names, fate, words);
    };
    say("BlSpn, BlCrvAC, BlSwpAC", Fate::derived,
        "at and center: the aerodynamic centre from the reference line, in section axes");
    say("BlTwist, BlCrvAng", Fate::derived, "twist_deg of blades.aero_sections");
    say("BlChord", Fate::taken, "chord of blades.aero_sections");
    say("BlAFID", Fate::derived, "airfoil of blades.aero_sections");
    for (const char* unused : {"BlCb", "BlCenBn", "BlCenBt"})
      if (std::ranges::find(table.names, unused) != table.names.end())
        say(unused, Fate::ignored, "buoyancy");
    import_.note("blades.aero_sections", "blade file of AeroDyn");
    set_air_mesh(blades.beam);
  }

  /// A case has one set of constants: that of the airfoil at three quarters of the blade.
  void take_constants() {
    if (!has_constants_ || import_.turbine.blades.aero_sections.empty()) return;
    const std::vector<model::AeroSectionDefinition>& sections =
        import_.turbine.blades.aero_sections;
    const auto nearest = std::ranges::min_element(
        sections, {}, [](const auto& section) { return std::abs(section.at - typical_place); });
    const auto constants_of = [&](const std::string& name) {
      return constants_[static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin())];
    };
    const DynamicsConstants constants = constants_of(nearest->airfoil);
    models_.aero.wake = constants.wake;
    models_.aero.pressure_lag = constants.pressure_lag;
    models_.aero.separation_lag = constants.separation_lag;
    models_.aero.cut_out = fields::deg.to_si(constants.cut_out_deg);
    const std::string source = " of " + nearest->airfoil;
    comment("wake_constants", "A1, A2, b1, b2" + source);
    comment("T_p", "T_p" + source);
    comment("T_f", "T_f0" + source);
    comment("cut_out_deg", "UACutout" + source);
    import_.report.push_back({deck().place_of("AFNames"), "A1, A2, b1, b2, T_p, T_f0, UACutout",
                              Fate::derived,
                              "aero.wake_constants, T_p, T_f and cut_out_deg" + source});
    const bool differ = std::ranges::any_of(
        sections, [&](const auto& section) { return constants_of(section.airfoil) != constants; });
    if (differ)
      import_.warn(deck().place_of("AFNames"),
                   "AFNames: note: airfoils differ in A1, A2, b1, b2, T_p, T_f0 or UACutout: the "
                   "case has those" +
                       source + " for all");
  }

  OpenfastImport& import_;
  const AerodynSource& source_;
  std::unique_ptr<Deck> deck_;
  AerodynModels models_;
  std::vector<std::string> paths_;            ///< of the airfoil files, in their order
  std::vector<std::string> names_;            ///< in the case, of the same
  std::vector<DynamicsConstants> constants_;  ///< of the same
  BladeTable first_;                          ///< of blade 1
  bool is_new_ = true;                        ///< of OpenFAST 4 or later, by the names of keys
  bool has_constants_ = false;
  bool has_moment_ = true;
  bool is_first_table_ = true;
};

}  // namespace

AerodynModels read_aerodyn(OpenfastImport& import, const AerodynSource& source) {
  return AerodynImporter(import, source).read();
}

}  // namespace samara::decks
