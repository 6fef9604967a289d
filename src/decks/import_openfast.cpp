#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>

#include "samara/base/error.hpp"
#include "samara/model/definition.hpp"

#include "import_common.hpp"

namespace samara::decks {
namespace {

/// A line of key points is straight where it stays this close to its axis, of its length.
constexpr double straight_tolerance = 1e-9;

/// Differences of blades beyond this are real.
constexpr double same_blade = 1e-12;

constexpr int integration_steps = 2000;

/// The coefficients of a mode shape add up to 1 within this.
constexpr double shape_tolerance = 0.015;

/// One blade, from whichever module describes it.
struct BladeData {
  DraftBeam beam;
  std::string path;
};

/// ElastoDyn's own frequency of an assumed shape, sum c_k x^k with k from 2, without the masses at
/// its end: stiffness along the local principal direction, which the twist turns.
double compute_shape_frequency(const std::array<double, 5>& coefficients, const Curve& mass,
                               const Curve& stiffness, const Curve& twist, double length) {
  const double h = 1.0 / integration_steps;
  std::complex<double> slope = 0.0;
  std::complex<double> place = 0.0;
  double generalized_mass = 0.0;
  double generalized_stiffness = 0.0;
  for (int i = 0; i < integration_steps; ++i) {
    const double x = (i + 0.5) * h;
    const Station station{x, false};
    double curvature = 0.0;
    for (int k = 6; k >= 2; --k)
      curvature = curvature * x + coefficients[static_cast<std::size_t>(k - 2)] * k * (k - 1);
    const std::complex<double> turned =
        curvature * std::polar(1.0, interpolate(twist, station) * std::numbers::pi / 180.0);
    const std::complex<double> middle = place + 0.5 * h * slope + 0.125 * h * h * turned;
    generalized_mass += interpolate(mass, station) * std::norm(middle) * h * length;
    generalized_stiffness +=
        interpolate(stiffness, station) * curvature * curvature * h / (length * length * length);
    place += h * slope + 0.5 * h * h * turned;
    slope += h * turned;
  }
  return std::sqrt(generalized_stiffness / generalized_mass);
}

class Importer {
 public:
  Importer(std::string path, const ImportOptions& options)
      : path_(std::move(path)), options_(options), main_(path_, errors_) {}

  Import run() {
    read_main();
    if (!elastodyn_) {
      errors_.throw_if_any();
      throw InputError(path_ + ": no ElastoDyn file to read");
    }
    read_freedoms();
    read_geometry();
    read_masses();
    read_tower();
    read_blades();
    read_teeter();
    errors_.throw_if_any();
    report_masses();
    report_rest();
    Import result;
    draft_.head.insert(draft_.head.begin(),
                       {"Imported by samara from OpenFAST, " +
                            clean_text(std::filesystem::path(path_).filename().string()) + ".",
                        "Every key is explained in docs/case_file.md, the import in docs/import.md."
                        " SI units."});
    result.text = write_case_text(draft_);
    result.report = std::move(report_);
    check_import(result);
    return result;
  }

 private:
  // ---- the report

  void say(Deck& deck, const std::string& key, Fate fate, const std::string& words) {
    report_.push_back({deck.place_of(key), key, fate, words});
    for (DeckEntry& entry : deck.entries())
      if (deck.place(entry.line) == deck.place_of(key)) entry.used = true;
  }

  void note(const std::string& key, const std::string& words) { draft_.notes[key] = words; }

  double take(Deck& deck, const std::string& key, const std::string& target) {
    const double value = deck.number(key);
    say(deck, key, Fate::taken, target);
    note(target, key);
    return value;
  }

  double derive(Deck& deck, const std::string& key, const std::string& words) {
    const double value = deck.number(key);
    say(deck, key, Fate::derived, words);
    return value;
  }

  void ignore(Deck& deck, const std::string& key, const std::string& why) {
    if (deck.has(key)) say(deck, key, Fate::ignored, why);
  }

  void require(bool holds, Deck& deck, const std::string& key, const std::string& what) {
    if (!holds && deck.has(key)) errors_.add(deck.place_of(key), key + ": " + what);
  }

  /// Opens another file; nothing where it cannot be read, which is an error.
  std::unique_ptr<Deck> open(const std::string& path) {
    if (path.empty()) return nullptr;
    try {
      return std::make_unique<Deck>(path, errors_);
    } catch (const InputError& error) {
      errors_.add_message(error.what());
      return nullptr;
    }
  }

  // ---- the main file

  void read_main() {
    const std::string name = main_.file("EDFile");
    say(main_, "EDFile", Fate::taken, "read");
    const int switch_value = main_.integer("CompElast", 1, 3);
    require(switch_value != 3, main_, "CompElast",
            "3, the simplified ElastoDyn, has no beams to import; give the deck of 1 or 2");
    uses_beamdyn_ = switch_value == 2;
    say(main_, "CompElast", Fate::derived,
        uses_beamdyn_ ? "2: the blades come from BeamDyn" : "1: the blades come from ElastoDyn");
    if (main_.number_or("NRotors", 1.0) != 1.0)
      errors_.add(main_.place_of("NRotors"), "NRotors: a case has one rotor");
    elastodyn_ = open(name);
    if (main_.number("CompSub") != 0.0) {
      if (options_.tower_only)
        say(main_, "CompSub", Fate::ignored,
            "--tower-only: the tower is clamped at TowerBsHt, the substructure is left out");
      else
        errors_.add(main_.place_of("CompSub"),
                    "CompSub: the substructure (SubDyn) cannot be imported; hint: --tower-only "
                    "clamps the tower at TowerBsHt");
    }
    read_gravity();
  }

  void read_gravity() {
    // FAST 8.16 has it in the file of ElastoDyn, OpenFAST in the main file.
    if (main_.has("Gravity"))
      draft_.gravity = take(main_, "Gravity", "gravity");
    else if (elastodyn_ && elastodyn_->has("Gravity"))
      draft_.gravity = take(*elastodyn_, "Gravity", "gravity");
    else
      errors_.add(path_, "missing key \"Gravity\", here or in the file of ElastoDyn");
    if (draft_.gravity < 0.0) errors_.add(path_, "Gravity: expected a number >= 0");
  }

  // ---- ElastoDyn

  void read_freedoms() {
    Deck& deck = *elastodyn_;
    blades_ = deck.integer("NumBl", 1, 3);
    draft_.blades = blades_;
    say(deck, "NumBl", Fate::taken, "blades.count");
    note("blades.count", "NumBl");
    const auto lock = [&](const std::string& key, const std::string& what, const std::string& why) {
      if (!deck.has(key)) return;
      say(deck, key, Fate::derived,
          deck.flag(key) ? "True, but " + what + " is locked: " + why
                         : "False: " + what + " is locked");
    };
    draft_.has_torsion = deck.flag("DrTrDOF");
    if (draft_.has_torsion) {
      say(deck, "DrTrDOF", Fate::taken, "shaft.torsion");
      draft_.torsion_stiffness = take(deck, "DTTorSpr", "shaft.torsion");
      draft_.torsion_damping = take(deck, "DTTorDmp", "shaft.torsion");
      require(draft_.torsion_stiffness > 0.0, deck, "DTTorSpr", "expected a number > 0");
      require(draft_.torsion_damping >= 0.0, deck, "DTTorDmp", "expected a number >= 0");
      note("shaft.torsion", "DTTorSpr, DTTorDmp");
    } else {
      lock("DrTrDOF", "shaft torsion", "");
      note("shaft.torsion", "DrTrDOF");
    }
    lock("GenDOF", "the rotor speed",
         "the generator torque (ServoDyn) is not read; the rotor turns at RotSpeed");
    lock("YawDOF", "yaw", "the yaw spring and damper (ServoDyn) are not read");
    lock("PitchDOF", "blade pitch", "the pitch drive (ServoDyn) is not read");
    for (const char* key :
         {"PtfmSgDOF", "PtfmSwDOF", "PtfmHvDOF", "PtfmRDOF", "PtfmPDOF", "PtfmYDOF"})
      lock(key, "the platform", "a case has no platform; the tower is clamped at TowerBsHt");
    note("nacelle.yaw", "YawDOF: the yaw drive of ServoDyn is not read");
    if (deck.flag("Furling"))
      errors_.add(deck.place_of("Furling"),
                  "Furling: a furling turbine cannot be imported; only False");
  }

  void read_geometry() {
    Deck& deck = *elastodyn_;
    draft_.speed_rpm = take(deck, "RotSpeed", "shaft.speed_rpm");
    require(draft_.speed_rpm >= 0.0, deck, "RotSpeed", "expected a number >= 0");
    draft_.overhang = take(deck, "OverHang", "shaft.overhang");
    draft_.tilt_deg = take(deck, "ShftTilt", "shaft.tilt_deg");
    require(std::abs(draft_.tilt_deg) < 90.0, deck, "ShftTilt",
            "expected an angle between -90 and 90 degrees");
    draft_.height = take(deck, "Twr2Shft", "shaft.height");
    draft_.hub_radius = take(deck, "HubRad", "hub.radius");
    require(draft_.hub_radius >= 0.0, deck, "HubRad", "expected a number >= 0");
    const double start = deck.number("Azimuth");
    const double up = deck.number("AzimB1Up");
    draft_.azimuth_deg = start - up;
    say(deck, "Azimuth", Fate::derived, "shaft.azimuth_deg = Azimuth - AzimB1Up");
    say(deck, "AzimB1Up", Fate::derived, "shaft.azimuth_deg = Azimuth - AzimB1Up");
    note("shaft.azimuth_deg", "Azimuth - AzimB1Up");
    tip_radius_ = deck.number("TipRad");

    for (int k = 1; k <= blades_; ++k) {
      const std::string cone = "PreCone(" + std::to_string(k) + ")";
      const double value = derive(deck, cone, "blades.precone_deg");
      if (k == 1) draft_.precone_deg = value;
      require(value == draft_.precone_deg, deck, cone,
              "a case has one precone for all blades, blade 1 has " + rounded(draft_.precone_deg));
      const std::string pitch = "BlPitch(" + std::to_string(k) + ")";
      const double angle = derive(
          deck, pitch, k == 1 ? "blades.pitch_deg" : "blades.each: what differs from blade 1");
      if (k == 1)
        draft_.pitch_deg = angle;
      else if (angle != draft_.pitch_deg)
        draft_.each[k].pitch_deg = angle - draft_.pitch_deg;
    }
    require(std::abs(draft_.precone_deg) < 90.0, deck, "PreCone(1)",
            "expected an angle between -90 and 90 degrees");
    note("blades.precone_deg", "PreCone");
    note("blades.pitch_deg", "BlPitch(1)");
  }

  void read_masses() {
    Deck& deck = *elastodyn_;
    draft_.nacelle_mass = take(deck, "NacMass", "nacelle.mass");
    const double x = derive(deck, "NacCMxn", "nacelle.center_of_mass, y2 = x (downwind)");
    const double y = derive(deck, "NacCMyn", "nacelle.center_of_mass, y1 = -y (y is to the left)");
    const double z = derive(deck, "NacCMzn", "nacelle.center_of_mass, y3 = z (up)");
    draft_.nacelle_center = {-y, x, z};
    note("nacelle.center_of_mass", "-NacCMyn, NacCMxn, NacCMzn");
    const double about_yaw = deck.number("NacYIner");
    const double own = about_yaw - draft_.nacelle_mass * (x * x + y * y);
    require(own >= 0.0, deck, "NacYIner",
            "less than NacMass (NacCMxn^2 + NacCMyn^2) = " +
                rounded(draft_.nacelle_mass * (x * x + y * y)) + ", which no body has");
    draft_.nacelle_inertia = {0.0, 0.0, own};
    say(deck, "NacYIner", Fate::derived,
        "nacelle.inertia about y3 = NacYIner - NacMass (NacCMxn^2 + NacCMyn^2) = " + rounded(own) +
            " kg m^2; ElastoDyn has none about the other axes");
    note("nacelle.inertia", "NacYIner - NacMass (NacCMxn^2 + NacCMyn^2), about its own centre");

    draft_.generator_inertia = take(deck, "GenIner", "shaft.generator.own_inertia");
    const std::size_t errors_before = errors_.size();
    draft_.gear_ratio = take(deck, "GBRatio", "shaft.gear_ratio");
    require(draft_.gear_ratio != 0.0 || errors_.size() > errors_before, deck, "GBRatio",
            "expected a number other than 0");
    note("shaft.generator", "GenIner; GenDOF: the torque of ServoDyn is not read");

    draft_.tower.tip_mass = take(deck, "YawBrMass", "tower.tip_mass");
    read_hub();
    for (const auto& [key, value] : {std::pair<const char*, double>{"NacMass", draft_.nacelle_mass},
                                     {"YawBrMass", draft_.tower.tip_mass},
                                     {"HubMass", draft_.hub_mass},
                                     {"GenIner", draft_.generator_inertia}})
      require(value >= 0.0, deck, key, "expected a number >= 0");
  }

  void read_hub() {
    Deck& deck = *elastodyn_;
    draft_.hub_mass = take(deck, "HubMass", "hub.mass");
    const double center = deck.number("HubCM");
    const double inertia = deck.number("HubIner");
    if (blades_ != 2) {
      draft_.hub_center = center;
      say(deck, "HubCM", Fate::taken, "hub.center_of_mass");
      note("hub.center_of_mass", "HubCM");
      draft_.hub_inertia = {0.0, inertia, 0.0};
      say(deck, "HubIner", Fate::taken, "hub.inertia about h2 (the shaft)");
      note("hub.inertia", "HubIner about the shaft");
      require(inertia >= 0.0, deck, "HubIner", "expected a number >= 0");
      ignore(deck, "HubIner_Teeter", "of two-bladed rotors only");
      return;
    }
    // OpenFAST measures UndSling from the teeter pin to the apex upwind, HubCM from the apex
    // downwind: pin to apex = -UndSling, apex to centre = HubCM.
    const double sling = deck.number("UndSling");
    const double delta = deck.number("Delta3") * std::numbers::pi / 180.0;
    draft_.hub_center = center - sling;
    say(deck, "HubCM", Fate::derived, "hub.center_of_mass = HubCM - UndSling, from the teeter pin");
    note("hub.center_of_mass", "HubCM - UndSling");
    const bool has_both = deck.has("HubIner_Teeter");
    const std::string key = has_both ? "HubIner_Teeter" : "HubIner";
    const double about_pin = has_both ? deck.number(key) : inertia;
    const double shift = draft_.hub_mass * (sling - center) * (sling - center);
    const double own = (about_pin - shift) / (std::cos(delta) * std::cos(delta));
    require(own >= 0.0, deck, key,
            "less than HubMass (UndSling - HubCM)^2 = " + rounded(shift) + ", which no body has");
    draft_.hub_inertia = {own, has_both ? inertia : own, 0.0};
    const std::string words =
        "(" + key + " - HubMass (UndSling - HubCM)^2)/cos(Delta3)^2 = " + rounded(own) + " kg m^2";
    if (has_both) {
      say(deck, "HubIner", Fate::taken, "hub.inertia about h2 (the shaft)");
      say(deck, key, Fate::derived, "hub.inertia about h1 (teeter axis) = " + words);
    } else {
      say(deck, key, Fate::derived,
          "hub.inertia about h1 (teeter axis) and h2 (shaft), a cylinder along h3 as in "
          "ElastoDyn: " +
              words);
    }
    note("hub.inertia", words);
  }

  void read_teeter() {
    Deck& deck = *elastodyn_;
    if (blades_ != 2) {
      for (const char* key : {"TeetDOF", "UndSling", "Delta3", "TeetMod", "TeetDmpP", "TeetDmp",
                              "TeetCDmp", "TeetSStP", "TeetHStP", "TeetSSSp", "TeetHSSp"})
        ignore(deck, key, "of two-bladed rotors only");
      return;
    }
    draft_.has_teeter = true;
    draft_.undersling = -deck.number("UndSling");
    say(deck, "UndSling", Fate::derived,
        "hub.teeter.undersling = -UndSling (OpenFAST counts the apex upwind of the pin)");
    note("hub.teeter.undersling", "-UndSling: OpenFAST counts it upwind");
    draft_.delta3_deg = deck.number("Delta3");
    if (deck.has("Delta3")) {
      say(deck, "Delta3", Fate::taken, "hub.teeter.delta3_deg");
      require(std::abs(draft_.delta3_deg) < 90.0, deck, "Delta3",
              "expected an angle between -90 and 90 degrees");
    }
    note("hub.teeter.delta3_deg", "Delta3");
    draft_.teeter_free = deck.flag("TeetDOF");
    const int mode = deck.integer("TeetMod", 0, 2);
    if (mode == 2 && draft_.teeter_free) {
      draft_.teeter_free = false;
      say(deck, "TeetMod", Fate::derived,
          "2: teeter is locked, for the user's routine cannot be read");
    } else {
      say(deck, "TeetMod", Fate::derived, "0: no spring, no damper; 1: TeetDmp and TeetSSSp");
    }
    say(deck, "TeetDOF", Fate::derived,
        draft_.teeter_free ? "hub.teeter: free" : "hub.teeter: locked");
    note("hub.teeter.joint", "TeetDOF");
    if (mode != 1) return;
    const auto at_rest = [&](const char* edge, const char* key, double& value,
                             const std::string& what) {
      const double number = deck.number(key);
      const double angle = deck.number(edge);
      if (angle == 0.0) {
        value = number;
        say(deck, key, Fate::taken, "hub.teeter." + what);
      } else {
        say(deck, key, Fate::ignored,
            std::string("acts beyond ") + edge + " = " + rounded(angle) + " deg only");
      }
    };
    at_rest("TeetDmpP", "TeetDmp", draft_.teeter_damping, "damping");
    at_rest("TeetSStP", "TeetSSSp", draft_.teeter_stiffness, "stiffness");
    ignore(deck, "TeetCDmp", "dry friction is not linear");
    for (const char* key : {"TeetDmpP", "TeetSStP"}) ignore(deck, key, "the edge of the above");
    for (const char* key : {"TeetHStP", "TeetHSSp"})
      ignore(deck, key, "the hard stop is out of reach of small motions");
  }

  // ---- the tower

  /// Damping [s] that ElastoDyn gives to a direction by its first mode; reports the second.
  double fit_damping(Deck& deck, const std::vector<std::string>& shapes,
                     const std::vector<std::string>& ratios, const std::vector<std::string>& tuners,
                     const Curve& mass, const Curve& stiffness, const Curve& twist, double length,
                     const std::string& target) {
    double mu = 0.0;
    double first_tuner = 1.0;
    for (std::size_t mode = 0; mode < shapes.size(); ++mode) {
      std::array<double, 5> coefficients{};
      for (std::size_t k = 0; k < 5; ++k) {
        const std::string key = shapes[mode] + "(" + std::to_string(k + 2) + ")";
        coefficients[k] = deck.number(key);
        say(deck, key, Fate::derived, "the shape from which " + target + " follows");
      }
      double sum = 0.0;
      for (const double coefficient : coefficients) sum += coefficient;
      if (!(std::abs(sum - 1.0) <= shape_tolerance) && deck.has(shapes[mode] + "(2)"))
        errors_.add(deck.place_of(shapes[mode] + "(2)"),
                    shapes[mode] + ": the coefficients of a mode shape add up to 1, these to " +
                        rounded(sum));
      const double ratio = 0.01 * deck.number(ratios[mode]);
      require(ratio >= 0.0, deck, ratios[mode], "expected a number >= 0");
      const double tuner = mode < tuners.size() ? deck.number(tuners[mode]) : 1.0;
      if (mode == 0) first_tuner = tuner;
      if (!errors_.empty()) continue;
      // `stiffness` holds the first tuner already.
      const double frequency =
          compute_shape_frequency(coefficients, mass, stiffness, twist, length) *
          std::sqrt(tuner / first_tuner);
      const std::string words = rounded(100.0 * ratio, 4) + " % at the " +
                                rounded(frequency * 0.5 / std::numbers::pi, 5) +
                                " Hz of the assumed shape";
      if (mode == 0) {
        mu = 2.0 * ratio / frequency;
        say(deck, ratios[mode], Fate::derived,
            target + " = 2 zeta/omega = " + rounded(mu, 5) + " s from " + words +
                " without masses at the end, as ElastoDyn has it");
        if (mode < tuners.size())
          say(deck, tuners[mode], Fate::derived, "multiplies the stiffness of all sections");
        continue;
      }
      const double given = 0.5 * mu * frequency;
      say(deck, ratios[mode], Fate::ignored,
          words + ": one mu serves both modes and gives this one " + rounded(100.0 * given, 4) +
              " %");
      if (mode < tuners.size())
        say(deck, tuners[mode], tuner == first_tuner ? Fate::derived : Fate::ignored,
            tuner == first_tuner
                ? "the same as the first, which multiplies the stiffness"
                : rounded(tuner) + " differs from the first, " + rounded(first_tuner) +
                      ", which multiplies the stiffness of all modes");
    }
    return mu;
  }

  /// Whether any of the modes of a direction is on; says what becomes of it.
  bool is_flexible(const std::vector<std::string>& keys, const std::string& target) {
    Deck& deck = *elastodyn_;
    bool any = false;
    bool all = true;
    for (const std::string& key : keys) {
      const bool on = deck.flag(key);
      any = any || on;
      all = all && on;
    }
    for (const std::string& key : keys)
      say(deck, key, Fate::derived,
          !any  ? "False: " + target + " is rigid"
          : all ? "True: the beam bends, " + target
                : "the modes are not all on: " + target + " is kept, with all of its modes");
    return any;
  }

  void read_tower() {
    Deck& deck = *elastodyn_;
    const double top = deck.number("TowerHt");
    const double foot = deck.number("TowerBsHt");
    draft_.has_tower = true;
    draft_.tower.length = top - foot;
    require(top > foot, deck, "TowerHt", "expected more than TowerBsHt = " + rounded(foot));
    say(deck, "TowerHt", Fate::derived, "tower.length = TowerHt - TowerBsHt");
    say(deck, "TowerBsHt", Fate::derived, "tower.length = TowerHt - TowerBsHt, clamped there");
    note("tower.length", "TowerHt - TowerBsHt");
    const bool fore_aft = is_flexible({"TwFADOF1", "TwFADOF2"}, "EI2 (fore-aft) of the tower");
    const bool side = is_flexible({"TwSSDOF1", "TwSSDOF2"}, "EI3 (side-side) of the tower");
    const std::string name = deck.file("TwrFile");
    say(deck, "TwrFile", Fate::taken, "read");
    tower_ = open(name);
    if (!tower_) return;
    Deck& tower = *tower_;
    const int count = tower.has("NTwInpSt") ? tower.integer("NTwInpSt", 1, 100000) : -1;
    if (count < 0) tower.number("NTwInpSt");
    say(tower, "NTwInpSt", Fate::derived, "the number of tower.sections");
    const DeckTable table =
        tower.table({"HtFract", "TMassDen", "TwFAStif", "TwSSStif"}, count, "NTwInpSt");
    const double mass_factor = derive(tower, "AdjTwMa", "multiplies the mass of all sections");
    const double fa_factor =
        derive(tower, "AdjFASt", "multiplies EI2 of all sections") * tower.number("FAStTunr(1)");
    const double ss_factor =
        derive(tower, "AdjSSSt", "multiplies EI3 of all sections") * tower.number("SSStTunr(1)");
    check_grid(tower, table, "HtFract");
    if (!errors_.empty()) return;
    say_columns(tower, table,
                {{"HtFract", "at"},
                 {"TMassDen", "mass, times AdjTwMa"},
                 {"TwFAStif", "EI2, times AdjFASt FAStTunr(1)"},
                 {"TwSSStif", "EI3, times AdjSSSt SSStTunr(1)"}});
    Curve mass{table.columns[0], {}}, fa{table.columns[0], {}}, ss{table.columns[0], {}};
    for (std::size_t i = 0; i < table.lines.size(); ++i) {
      mass.values.push_back(table.columns[1][i] * mass_factor);
      fa.values.push_back(table.columns[2][i] * fa_factor);
      ss.values.push_back(table.columns[3][i] * ss_factor);
    }
    draft_.tower.sections = build_sections(tower, table, mass, fa, ss, nullptr, fore_aft, side,
                                           "TMassDen", "TwFAStif", "TwSSStif");
    if (!errors_.empty()) return;
    const Curve no_twist{{0.0}, {0.0}};
    const double length = draft_.tower.length;
    draft_.tower.damping(4) = fit_damping(
        tower, {"TwFAM1Sh", "TwFAM2Sh"}, {"TwrFADmp(1)", "TwrFADmp(2)"},
        {"FAStTunr(1)", "FAStTunr(2)"}, mass, fa, no_twist, length, "tower.damping of bending 2");
    draft_.tower.damping(5) = fit_damping(
        tower, {"TwSSM1Sh", "TwSSM2Sh"}, {"TwrSSDmp(1)", "TwrSSDmp(2)"},
        {"SSStTunr(1)", "SSStTunr(2)"}, mass, ss, no_twist, length, "tower.damping of bending 3");
    set_mesh(draft_.tower, tower_mesh);
    note("tower.elements", "chosen by the importer");
    note("tower.damping", "from the first fore-aft and side-side mode, 2 zeta/omega");
    note("tower.sections",
         "ElastoDyn has no axial, shear and torsional stiffness: rigid; no rotary inertia: 0");
  }

  void check_grid(Deck& deck, const DeckTable& table, const std::string& name) {
    if (table.columns.empty() || table.columns[0].empty()) return;
    const std::vector<double>& grid = table.columns[0];
    for (std::size_t i = 1; i < grid.size(); ++i)
      if (!(grid[i] > grid[i - 1]))
        errors_.add(deck.place(table.lines[i]),
                    name + ": expected more than the row before has, " + rounded(grid[i - 1]));
    if (grid.front() != 0.0)
      errors_.add(deck.place(table.lines.front()), name + ": the first row must be at 0");
    if (std::abs(grid.back() - 1.0) > straight_tolerance)
      errors_.add(deck.place(table.lines.back()), name + ": the last row must be at 1");
  }

  void say_columns(Deck& deck, const DeckTable& table,
                   const std::vector<std::pair<std::string, std::string>>& used) {
    for (const std::string& name : table.names) {
      const auto found = std::find_if(used.begin(), used.end(),
                                      [&](const auto& entry) { return entry.first == name; });
      if (found != used.end())
        report_.push_back(
            {deck.place(table.line), name, Fate::taken, "sections: " + found->second});
      else
        report_.push_back(
            {deck.place(table.line), name, Fate::ignored, "ElastoDyn's beams do not use it"});
    }
  }

  /// Sections of ElastoDyn: bending only, no rotary inertia.
  std::vector<DraftSection> build_sections(Deck& deck, const DeckTable& table, const Curve& mass,
                                           const Curve& k2, const Curve& k3, const Curve* twist,
                                           bool bends2, bool bends3, const std::string& mass_name,
                                           const std::string& k2_name, const std::string& k3_name) {
    std::vector<DraftSection> sections;
    for (std::size_t i = 0; i < table.lines.size(); ++i) {
      for (const auto& [name, value] :
           {std::pair<const std::string&, double>{mass_name, mass.values[i]},
            {k2_name, k2.values[i]},
            {k3_name, k3.values[i]}})
        if (!(value > 0.0))
          errors_.add(deck.place(table.lines[i]),
                      name + ": " + rounded(value) + ", expected a number > 0, factors included");
      DraftSection section;
      section.at = std::min(table.columns[0][i], 1.0);
      section.mass = build_mass_matrix(mass.values[i], Vector3::Zero());
      section.rigid = {true, true, true, true, !bends2, !bends3};
      if (bends2) section.stiffness(4, 4) = k2.values[i];
      if (bends3) section.stiffness(5, 5) = k3.values[i];
      if (twist != nullptr) section.twist_deg = twist->values[i];
      sections.push_back(section);
    }
    return sections;
  }

  // ---- the blades

  void read_blades() {
    std::vector<BladeData> blades;
    if (uses_beamdyn_) {
      for (const char* key : {"FlapDOF1", "FlapDOF2", "EdgeDOF"})
        ignore(*elastodyn_, key, "the blades are BeamDyn's");
      for (int k = 1; k <= 3; ++k) {
        ignore(*elastodyn_, "BldFile(" + std::to_string(k) + ")", "the blades are BeamDyn's");
        ignore(*elastodyn_, "TipMass(" + std::to_string(k) + ")", "the blades are BeamDyn's");
      }
      read_each_blade(main_, "BDBldFile", blades,
                      [this](const std::string& path, bool speaks, BladeData& blade) {
                        return read_beamdyn(path, speaks, blade);
                      });
    } else {
      Deck& deck = *elastodyn_;
      flap_ = is_flexible({"FlapDOF1", "FlapDOF2"}, "EI2 (flap) of the blades");
      edge_ = is_flexible({"EdgeDOF"}, "EI3 (edge) of the blades");
      for (int k = 1; k <= blades_; ++k) {
        const std::string key = "TipMass(" + std::to_string(k) + ")";
        const double value = derive(deck, key, "blades.tip_mass");
        if (k == 1) tip_mass_ = value;
        require(value >= 0.0, deck, key, "expected a number >= 0");
        require(value == tip_mass_, deck, key,
                "a case has one tip mass for all blades, blade 1 has " + rounded(tip_mass_));
      }
      note("blades.tip_mass", "TipMass");
      read_each_blade(deck, "BldFile", blades,
                      [this](const std::string& path, bool speaks, BladeData& blade) {
                        return read_elastodyn_blade(path, speaks, blade);
                      });
    }
    if (!errors_.empty() || blades.empty()) return;
    draft_.blade = blades[0].beam;
    set_mesh(draft_.blade, blade_mesh);
    note("blades.elements", "chosen by the importer");
    for (std::size_t k = 1; k < blades.size(); ++k) compare_blade(blades, k);
    const double flexible = tip_radius_ - draft_.hub_radius;
    if (!uses_beamdyn_) {
      say(*elastodyn_, "TipRad", Fate::derived, "blades.length = TipRad - HubRad");
      note("blades.length", "TipRad - HubRad");
      return;
    }
    say(*elastodyn_, "TipRad", Fate::ignored,
        "BeamDyn's key points give the length; TipRad - HubRad = " + rounded(flexible) + " m");
  }

  void read_each_blade(Deck& deck, const std::string& prefix, std::vector<BladeData>& blades,
                       const std::function<bool(const std::string&, bool, BladeData&)>& read_one) {
    for (int k = 1; k <= blades_; ++k) {
      const std::string key = prefix + "(" + std::to_string(k) + ")";
      const std::string path = deck.file(key);
      say(deck, key, Fate::taken, "read");
      if (path.empty()) continue;
      const auto known = std::find_if(blades.begin(), blades.end(),
                                      [&](const BladeData& blade) { return blade.path == path; });
      if (known != blades.end()) {
        blades.push_back(*known);
        continue;
      }
      BladeData blade;
      blade.path = path;
      if (read_one(path, blades.empty(), blade)) blades.push_back(blade);
    }
  }

  /// A blade may differ from the first by one factor of mass and one of stiffness.
  void compare_blade(const std::vector<BladeData>& blades, std::size_t k) {
    if (blades[k].path == blades[0].path) return;
    const DraftBeam& first = blades[0].beam;
    const DraftBeam& other = blades[k].beam;
    const int number = static_cast<int>(k + 1);
    bool alike = first.sections.size() == other.sections.size() &&
                 std::abs(first.length - other.length) <= same_blade * first.length &&
                 first.reference_line.size() == other.reference_line.size();
    for (std::size_t i = 0; alike && i < first.reference_line.size(); ++i)
      alike =
          (first.reference_line[i] - other.reference_line[i]).norm() <= same_blade * first.length;
    double mass_factor = 1.0;
    double stiffness_factor = 1.0;
    for (std::size_t i = 0; alike && i < first.sections.size(); ++i) {
      const DraftSection& a = first.sections[i];
      const DraftSection& b = other.sections[i];
      if (i == 0) {
        mass_factor = b.mass(0, 0) / a.mass(0, 0);
        if (a.stiffness.norm() > 0.0) stiffness_factor = b.stiffness.norm() / a.stiffness.norm();
      }
      alike =
          std::abs(a.at - b.at) <= same_blade && a.twist_deg == b.twist_deg && a.rigid == b.rigid &&
          (b.mass - mass_factor * a.mass).norm() <= same_blade * b.mass.norm() &&
          (b.stiffness - stiffness_factor * a.stiffness).norm() <= same_blade * b.stiffness.norm();
    }
    if (!alike) {
      errors_.add(blades[k].path,
                  "blade " + std::to_string(number) + " differs from blade 1 (" + blades[0].path +
                      ") by more than one factor of its mass and one of its stiffness, which is "
                      "all a case can state");
      return;
    }
    if (mass_factor == 1.0 && stiffness_factor == 1.0) return;
    draft_.each[number].mass_factor = mass_factor;
    draft_.each[number].stiffness_factor = stiffness_factor;
    report_.push_back({blades[k].path, "blade " + std::to_string(number), Fate::derived,
                       "blades.each: mass_factor " + rounded(mass_factor) + ", stiffness_factor " +
                           rounded(stiffness_factor) + "; damping is that of blade 1"});
  }

  bool read_elastodyn_blade(const std::string& path, bool speaks, BladeData& blade) {
    const std::unique_ptr<Deck> file = open(path);
    if (!file) return false;
    Deck& deck = *file;
    const std::size_t lines_before = report_.size();
    const int count = deck.has("NBlInpSt") ? deck.integer("NBlInpSt", 1, 100000) : -1;
    if (count < 0) deck.number("NBlInpSt");
    say(deck, "NBlInpSt", Fate::derived, "the number of blades.sections");
    const DeckTable table =
        deck.table({"BlFract", "StrcTwst", "BMassDen", "FlpStff", "EdgStff"}, count, "NBlInpSt");
    const double mass_factor = derive(deck, "AdjBlMs", "multiplies the mass of all sections");
    const double flap_factor =
        derive(deck, "AdjFlSt", "multiplies EI2 of all sections") * deck.number("FlStTunr(1)");
    const double edge_factor = derive(deck, "AdjEdSt", "multiplies EI3 of all sections");
    check_grid(deck, table, "BlFract");
    blade.beam.length = tip_radius_ - draft_.hub_radius;
    require(blade.beam.length > 0.0, *elastodyn_, "TipRad",
            "expected more than HubRad = " + rounded(draft_.hub_radius));
    if (!errors_.empty()) return false;
    say_columns(deck, table,
                {{"BlFract", "at"},
                 {"StrcTwst", "twist_deg"},
                 {"BMassDen", "mass, times AdjBlMs"},
                 {"FlpStff", "EI2, times AdjFlSt FlStTunr(1)"},
                 {"EdgStff", "EI3, times AdjEdSt"}});
    Curve mass{table.columns[0], {}}, flap{table.columns[0], {}}, edge{table.columns[0], {}};
    const Curve twist{table.columns[0], table.columns[1]};
    for (std::size_t i = 0; i < table.lines.size(); ++i) {
      mass.values.push_back(table.columns[2][i] * mass_factor);
      flap.values.push_back(table.columns[3][i] * flap_factor);
      edge.values.push_back(table.columns[4][i] * edge_factor);
    }
    blade.beam.sections = build_sections(deck, table, mass, flap, edge, &twist, flap_, edge_,
                                         "BMassDen", "FlpStff", "EdgStff");
    if (!errors_.empty()) return false;
    blade.beam.damping(4) =
        fit_damping(deck, {"BldFl1Sh", "BldFl2Sh"}, {"BldFlDmp(1)", "BldFlDmp(2)"},
                    {"FlStTunr(1)", "FlStTunr(2)"}, mass, flap, twist, blade.beam.length,
                    "blades.damping of bending 2");
    blade.beam.damping(5) = fit_damping(deck, {"BldEdgSh"}, {"BldEdDmp(1)"}, {}, mass, edge, twist,
                                        blade.beam.length, "blades.damping of bending 3");
    blade.beam.tip_mass = tip_mass_;
    note("blades.damping", "from the first flap and the first edge mode, 2 zeta/omega");
    note("blades.sections",
         "ElastoDyn has no axial, shear and torsional stiffness: rigid; no rotary inertia: 0");
    report_unused(deck);
    if (!speaks) report_.resize(lines_before);
    return errors_.empty();
  }

  bool read_beamdyn(const std::string& path, bool speaks, BladeData& blade) {
    const std::unique_ptr<Deck> primary = open(path);
    if (!primary) return false;
    Deck& deck = *primary;
    const std::size_t lines_before = report_.size();
    const int count = deck.has("kp_total") ? deck.integer("kp_total", 2, 100000) : -1;
    if (count < 0) deck.number("kp_total");
    say(deck, "kp_total", Fate::derived, "the number of key points");
    const DeckTable points =
        deck.table({"kp_xr", "kp_yr", "kp_zr", "initial_twist"}, count, "kp_total");
    const std::string name = deck.file("BldFile");
    say(deck, "BldFile", Fate::taken, "read");
    ignore(deck, "member_total", "the key points of all members make one beam");
    for (const char* key : {"UsePitchAct", "PitchJ", "PitchK", "PitchC"})
      ignore(deck, key, "pitch is locked");
    const std::unique_ptr<Deck> body = open(name);
    if (!body || !errors_.empty()) return false;

    const Curve twist = read_key_points(deck, points, blade.beam);
    if (!errors_.empty()) return false;
    read_beamdyn_body(*body, twist, blade.beam);
    if (!errors_.empty()) return false;
    for (const auto& [column, words] :
         {std::pair<const char*, const char*>{"kp_xr", "b3"}, {"kp_yr", "-b2"}, {"kp_zr", "b1"}})
      report_.push_back({deck.place(points.line), column, Fate::taken,
                         blade.beam.reference_line.empty()
                             ? "the line is straight: blades.length"
                             : std::string("blades.reference_line along ") + words});
    report_.push_back({deck.place(points.line), "initial_twist", Fate::taken,
                       "twist_deg of the sections, linear between the key points (BeamDyn: a "
                       "cubic spline)"});
    report_unused(deck);
    report_unused(*body);
    if (!speaks) report_.resize(lines_before);
    return true;
  }

  /// Fills the line; returns the twist [deg] over the arc.
  Curve read_key_points(Deck& deck, const DeckTable& points, DraftBeam& beam) {
    Curve twist;
    std::vector<Vector3> line;
    double across = 0.0;
    for (std::size_t i = 0; i < points.lines.size(); ++i) {
      line.push_back(turn_to_section_axes(
          Vector3(points.columns[0][i], points.columns[1][i], points.columns[2][i])));
      across = std::max(across, std::hypot(line[i](1), line[i](2)));
      if (i > 0 && !(line[i](0) > line[i - 1](0)))
        errors_.add(
            deck.place(points.lines[i]),
            "kp_zr: expected more than the key point before has, " + rounded(line[i - 1](0)));
    }
    if (!line.empty() && !line[0].isZero(0.0))
      errors_.add(deck.place(points.lines[0]), "the first key point must be 0, 0, 0");
    if (!errors_.empty()) return twist;
    const bool is_straight = across <= straight_tolerance * line.back()(0);
    beam.length = is_straight ? line.back()(0) : model::compute_arc_length(line);
    for (std::size_t i = 0; i < line.size(); ++i) {
      twist.grid.push_back(is_straight ? line[i](0) / beam.length : arc_fraction(line, i));
      twist.values.push_back(points.columns[3][i]);
    }
    if (!is_straight) beam.reference_line = line;
    note("blades.length", "the last key point");
    note("blades.reference_line", "key points, [z, -y, x] of BeamDyn");
    return twist;
  }

  /// io::Place of a key point as a fraction of the polygon through all points; along the spline it
  /// is the same to second order in the angle between two chords.
  static double arc_fraction(const std::vector<Vector3>& line, std::size_t i) {
    double part = 0.0;
    double whole = 0.0;
    for (std::size_t k = 1; k < line.size(); ++k) {
      whole += (line[k] - line[k - 1]).norm();
      if (k == i) part = whole;
    }
    return part / whole;
  }

  void read_beamdyn_body(Deck& deck, const Curve& twist, DraftBeam& beam) {
    const int count = deck.has("station_total") ? deck.integer("station_total", 1, 100000) : -1;
    if (count < 0) deck.number("station_total");
    say(deck, "station_total", Fate::derived, "the number of stations");
    const int type = deck.integer("damp_type", 0, 2);
    say(deck, "damp_type", type == 1 ? Fate::taken : Fate::derived,
        type == 0   ? "0: no damping"
        : type == 1 ? "1: blades.damping"
                    : "2, modal damping, is not imported: blades.damping is 0");
    Vector6 mu = Vector6::Zero();
    if (type == 1) {
      const DeckTable table =
          deck.table({"mu1", "mu2", "mu3", "mu4", "mu5", "mu6"}, 1, "damp_type");
      if (!errors_.empty()) return;
      for (std::size_t i = 0; i < 6; ++i) {
        mu(static_cast<Eigen::Index>(i)) = table.columns[i][0];
        if (table.columns[i][0] < 0.0)
          errors_.add(deck.place(table.lines[0]), table.names[i] + ": expected a number >= 0");
        constexpr std::array<const char*, 6> targets = {"shear 3",   "shear 2",   "axial",
                                                        "bending 3", "bending 2", "torsion"};
        report_.push_back({deck.place(table.line), table.names[i], Fate::taken,
                           std::string("blades.damping of ") + targets[i]});
      }
    }
    beam.damping = turn_damping(mu);
    note("blades.damping", type == 1   ? "mu3, mu2, mu1, mu6, mu5, mu4 of BeamDyn"
                           : type == 2 ? "BeamDyn's modal damping is not imported"
                                       : "damp_type 0");
    note("blades.sections", "matrices of BeamDyn, turned to b1 = z, b2 = -y, b3 = x");

    const int heading = find_body(deck);
    if (heading == 0) return;
    const std::vector<DeckRow> rows = deck.rows_after(heading);
    std::vector<Matrix6> stiffness;
    std::vector<Matrix6> mass;
    std::vector<int> lines;
    Curve stations;
    if (!read_matrices(deck, rows, count, stations, stiffness, mass, lines)) return;

    // Stations of the matrices and key points of the twist make one list.
    std::vector<std::string> places;
    for (const Station& station : merge_grids({&stations.grid, &twist.grid})) {
      DraftSection section;
      section.at = std::min(1.0, place_of(station));
      for (Eigen::Index i = 0; i < 6; ++i)
        for (Eigen::Index j = 0; j < 6; ++j) {
          section.stiffness(i, j) = entry_at(stations, stiffness, i, j, station);
          section.mass(i, j) = entry_at(stations, mass, i, j, station);
        }
      section.stiffness = turn_to_section_axes(section.stiffness);
      section.mass = turn_to_section_axes(section.mass);
      section.twist_deg = interpolate(twist, station);
      const auto next = std::lower_bound(stations.grid.begin(), stations.grid.end(),
                                         station.place - straight_tolerance);
      const auto row = static_cast<std::size_t>(next - stations.grid.begin());
      places.push_back(deck.place(lines[std::min(row, lines.size() - 1)]));
      beam.sections.push_back(section);
    }
    check_sections(beam, "blade", places, errors_);
    report_.push_back({deck.place(heading), "stations", Fate::taken,
                       "sections: mass_matrix and stiffness_matrix; where key points lie between "
                       "stations the matrices are interpolated"});
  }

  static double entry_at(const Curve& stations, const std::vector<Matrix6>& matrices,
                         Eigen::Index i, Eigen::Index j, const Station& station) {
    Curve curve{stations.grid, {}};
    for (const Matrix6& matrix : matrices) curve.values.push_back(matrix(i, j));
    return interpolate(curve, station);
  }

  /// The line above the first station.
  int find_body(Deck& deck) {
    const int heading = deck.find_heading("DISTRIBUTED");
    if (heading == 0)
      errors_.add(deck.path(), "missing heading \"DISTRIBUTED PROPERTIES\" above the stations");
    return heading;
  }

  bool read_matrices(Deck& deck, const std::vector<DeckRow>& rows, int count, Curve& stations,
                     std::vector<Matrix6>& stiffness, std::vector<Matrix6>& mass,
                     std::vector<int>& lines) {
    std::size_t next = 0;
    while (next < rows.size() && errors_.empty()) {
      if (rows[next].numbers.size() != 1) {
        errors_.add(deck.place(rows[next].line),
                    "expected the place of a station, one number from 0 to 1, got " +
                        std::to_string(rows[next].numbers.size()) + " numbers");
        return false;
      }
      const double place = rows[next].numbers[0];
      lines.push_back(rows[next].line);
      if (place < 0.0 || place > 1.0 + straight_tolerance ||
          (!stations.grid.empty() && !(place > stations.grid.back())))
        errors_.add(deck.place(rows[next].line),
                    "expected a place from 0 to 1, beyond that of the station before, got " +
                        rounded(place));
      stations.grid.push_back(std::min(place, 1.0));
      ++next;
      for (std::vector<Matrix6>* matrices : {&stiffness, &mass}) {
        Matrix6 matrix = Matrix6::Zero();
        for (Eigen::Index i = 0; i < 6; ++i, ++next) {
          if (next == rows.size() || rows[next].numbers.size() != 6) {
            errors_.add(
                deck.place(next == rows.size() ? rows.back().line : rows[next].line),
                std::string("expected row ") + std::to_string(i + 1) + " of 6 numbers of the " +
                    (matrices == &stiffness ? "stiffness" : "mass") + " matrix" +
                    (next == rows.size()
                         ? ", the file ends"
                         : ", got " + std::to_string(rows[next].numbers.size()) + " numbers"));
            return false;
          }
          for (Eigen::Index j = 0; j < 6; ++j)
            matrix(i, j) = rows[next].numbers[static_cast<std::size_t>(j)];
        }
        matrices->push_back(matrix);
      }
    }
    if (!rows.empty() && deck.ends_inside(rows.back().line))
      errors_.add(deck.place(rows.back().line),
                  "the file ends inside this line, perhaps in a number; hint: if it is whole, end "
                  "it with a new line");
    if (count >= 0 && static_cast<int>(lines.size()) != count)
      errors_.add(deck.place_of("station_total"), "station_total: " + std::to_string(count) +
                                                      ", the file has " +
                                                      std::to_string(lines.size()) + " stations");
    if (!stations.grid.empty() && stations.grid.front() != 0.0)
      errors_.add(deck.place(lines.front()), "the first station must be at 0");
    if (!stations.grid.empty() && stations.grid.back() < 1.0 - straight_tolerance)
      errors_.add(deck.place(lines.back()), "the last station must be at 1");
    return errors_.empty();
  }

  // ---- what is left

  void report_masses() {
    const BeamMass tower = integrate_mass(draft_.tower, draft_.tower.length);
    const BeamMass blade = integrate_mass(draft_.blade, draft_.blade.length);
    draft_.title = clean_text(elastodyn_->title().empty() ? main_.title() : elastodyn_->title());
    draft_.head.push_back(
        "Masses [kg]: tower " + rounded(tower.mass) + ", each blade " + rounded(blade.mass) +
        " (centre " + rounded(blade.moment / blade.mass, 5) + " m from its root), hub " +
        rounded(draft_.hub_mass) + ", nacelle " + rounded(draft_.nacelle_mass) + ".");
  }

  /// Why a key of ElastoDyn is of no use.
  static std::string reason(const std::string& key) {
    const auto starts = [&](const char* word) { return key.starts_with(word); };
    const auto is = [&](std::initializer_list<const char*> words) {
      return std::find(words.begin(), words.end(), key) != words.end();
    };
    if (starts("Ptfm")) return "the tower is clamped, there is no platform";
    if (is({"OoPDefl", "IPDefl", "TeetDefl", "TTDspFA", "TTDspSS", "NacYaw"}))
      return "an initial state; the steady state is computed, and yaw is locked at 0";
    if (is({"DTTorSpr", "DTTorDmp"})) return "shaft torsion is locked";
    if (is({"GBoxEff"})) return "losses of the gearbox are no part of a case";
    if (starts("PBrIner") || starts("BlPIner")) return "pitch is locked";
    if (is({"YawFrctMod", "M_CSmax", "M_FCSmax", "M_MCSmax", "M_CD", "M_FCD", "M_MCD", "sig_v",
            "sig_v2", "OmgCut"}))
      return "yaw is locked";
    if (starts("NcIMU") || is({"ShftGagL"})) return "the place of a sensor";
    if (is({"BldNodes", "TwrNodes", "order_elem", "quadrature", "refine"}))
      return "the mesh of a case is its own";
    if (is({"PreCone(3)", "BlPitch(3)", "TipMass(3)", "BldFile(3)", "PreCone(2)", "BlPitch(2)",
            "TipMass(2)", "BldFile(2)", "BDBldFile(1)", "BDBldFile(2)", "BDBldFile(3)"}))
      return "this rotor does not use it";
    if (key.starts_with("Comp") || (key.ends_with("File") && key != "OutFile"))
      return "of a module that describes no structure of a case";
    return "a setting of the simulation or its output, no part of the structure";
  }

  void report_unused(Deck& deck) {
    for (DeckEntry& entry : deck.entries()) {
      if (entry.used) continue;
      report_.push_back({deck.place(entry.line), entry.key, Fate::ignored, reason(entry.key)});
    }
  }

  void report_rest() {
    report_unused(main_);
    report_unused(*elastodyn_);
    if (tower_) report_unused(*tower_);
  }

  std::string path_;
  ImportOptions options_;
  DeckErrors errors_;
  Deck main_;
  std::unique_ptr<Deck> elastodyn_;
  std::unique_ptr<Deck> tower_;
  CaseDraft draft_;
  std::vector<ImportLine> report_;
  bool uses_beamdyn_ = false;
  int blades_ = 3;
  double tip_radius_ = 0.0;
  double tip_mass_ = 0.0;
  bool flap_ = true;
  bool edge_ = true;
};

}  // namespace

Import import_openfast(const std::string& path, const ImportOptions& options) {
  return Importer(path, options).run();
}

}  // namespace samara::decks
