#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>

#include "samara/base/error.hpp"

#include "import_aerodyn.hpp"
#include "import_air.hpp"
#include "import_beamdyn.hpp"
#include "import_common.hpp"
#include "import_elastodyn.hpp"
#include "import_furling.hpp"
#include "import_inflow.hpp"
#include "import_servodyn.hpp"
#include "openfast_import.hpp"

namespace samara::decks {
namespace {

/// Relative difference up to which blades are equal.
constexpr double same_blade = 1e-12;

/// One blade, from the module that describes it.
struct BladeData {
  model::BeamDefinition beam;
  std::string path;
};

/// A module that a main file can switch on, and the effects that are lost without it.
struct LeftOut {
  const char* key;
  std::vector<const char*> names;  ///< by the value of the key, from 1; none: it is read
  const char* words;
};

const std::vector<LeftOut>& left_out() {
  static const std::vector<LeftOut> modules{
      {"CompAero", {"AeroDisk or AeroDyn 14", nullptr, "ExtLoads"}, "aerodynamics"},
      {"CompServo", {"ServoDyn"}, "control of pitch, torque and yaw, and structural control"},
      {"CompHydro", {"HydroDyn"}, "buoyancy, added mass and loads of the water"},
      {"CompMooring", {"MAP++", "FEAMooring", "MoorDyn", "OrcaFlex"}, "mooring lines"},
      {"CompIce", {"IceFloe", "IceDyn"}, "loads of ice"},
      {"CompSoil", {"SoilDyn"}, "springs of the soil"}};
  return modules;
}

class Importer {
 public:
  Importer(std::string path, const ImportOptions& options)
      : path_(std::move(path)), import_(options), main_(path_, import_.errors) {}

  Import run() {
    refuse_other_files();
    read_main();
    if (!elastodyn_) {
      import_.errors.throw_if_any();
      throw InputError(path_ + ": no ElastoDyn file to read");
    }
    open_servo();
    read_freedoms();
    read_geometry();
    read_masses();
    read_tower();
    read_blades();
    read_teeter();
    if (servo_) read_law_of_generator();
    if (import_.errors.empty()) read_air();
    import_.errors.throw_if_any();
    warn_of_platform();
    warn_of_modules();
    report_masses();
    import_.report_unused(main_);
    import_.report_unused(*elastodyn_);
    Import result;
    import_.comments.head.insert(
        import_.comments.head.begin(),
        {"Imported by samara from OpenFAST, " +
             clean_text(std::filesystem::path(path_).filename().string()) + ".",
         "Every key is explained in docs/case_file.md, the import in docs/import.md."
         " SI units."});
    result.text = io::write_case_text(import_.turbine, import_.comments, import_.operation);
    result.report = std::move(import_.report);
    result.warnings = std::move(import_.warnings);
    check_import(result);
    return result;
  }

 private:
  // ---- the main file

  void refuse_other_files() {
    if (main_.has("EDFile")) return;
    const auto has = [&](const char* key) { return main_.has(key); };
    std::string what;
    if (has("ADAMSPrep") || has("AnalMode"))
      what =
          "a deck of FAST 7 or older, which cannot be read; hint: OpenFAST's repository has "
          "scripts that convert it to FAST 8";
    else if (has("TwrFile") && has("OverHang"))
      what = "a file of ElastoDyn; hint: give the main file (.fst) that names it as EDFile";
    else if (has("kp_total") || has("station_total"))
      what = "a file of BeamDyn; hint: give the main file (.fst) that names it as BDBldFile";
    else if (has("NTwInpSt") || has("NBlInpSt"))
      what = "a file of ElastoDyn's beams; hint: give the main file (.fst)";
    else if (has("NumTurbines") || has("DT_low"))
      what = "a file of FAST.Farm; hint: give the main file (.fst) of one of its turbines";
    if (!what.empty()) throw InputError(path_ + ": " + what);
    throw InputError(path_ + ": missing key \"EDFile\": not a main file of OpenFAST (.fst)");
  }

  void read_main() {
    const std::string name = main_.file("EDFile");
    import_.say(main_, "EDFile", Fate::taken, "read");
    const int switch_value = main_.integer("CompElast", 1, 3);
    import_.require(switch_value != 3, main_, "CompElast",
                    "3, the simplified ElastoDyn, has no beams to import; give the deck of 1 or 2");
    uses_beamdyn_ = switch_value == 2;
    import_.say(
        main_, "CompElast", Fate::derived,
        uses_beamdyn_ ? "2: the blades come from BeamDyn" : "1: the blades come from ElastoDyn");
    if (main_.number_or("NRotors", 1.0) != 1.0)
      import_.errors.add(main_.place_of("NRotors"), "NRotors: a case has one rotor");
    elastodyn_ = import_.open(name);
    if (main_.number("CompSub") != 0.0) {
      if (import_.options.tower_only)
        import_.say(
            main_, "CompSub", Fate::ignored,
            "--tower-only: the tower is clamped at TowerBsHt, the substructure is left out");
      else
        import_.errors.add(
            main_.place_of("CompSub"),
            "CompSub: the substructure (SubDyn) cannot be imported; hint: --tower-only "
            "clamps the tower at TowerBsHt");
    }
    read_gravity();
  }

  void read_gravity() {
    // FAST 8.16 has it in the file of ElastoDyn, OpenFAST in the main file.
    if (main_.has("Gravity"))
      import_.turbine.gravity = import_.take(main_, "Gravity", "gravity");
    else if (elastodyn_ && elastodyn_->has("Gravity"))
      import_.turbine.gravity = import_.take(*elastodyn_, "Gravity", "gravity");
    else
      import_.errors.add(path_, "missing key \"Gravity\", here or in the file of ElastoDyn");
    if (import_.turbine.gravity < 0.0) import_.errors.add(path_, "Gravity: expected a number >= 0");
  }

  // ---- ElastoDyn

  void read_freedoms() {
    Deck& deck = *elastodyn_;
    blades_ = deck.integer("NumBl", 1, 3);
    import_.turbine.blades.count = blades_;
    import_.turbine.has_nacelle = true;
    import_.say(deck, "NumBl", Fate::taken, "blades.count");
    import_.note("blades.count", "NumBl");
    const auto lock = [&](const std::string& key, const std::string& what, const std::string& why) {
      if (!deck.has(key)) return;
      import_.say(deck, key, Fate::derived,
                  deck.flag(key) ? "True, but " + what + " is locked: " + why
                                 : "False: " + what + " is locked");
    };
    if (deck.flag("DrTrDOF")) {
      import_.turbine.shaft.torsion.kind = model::JointKind::free;
      import_.say(deck, "DrTrDOF", Fate::taken, "shaft.torsion");
      import_.turbine.shaft.torsion.stiffness = import_.take(deck, "DTTorSpr", "shaft.torsion");
      import_.turbine.shaft.torsion.damping = import_.take(deck, "DTTorDmp", "shaft.torsion");
      import_.require(import_.turbine.shaft.torsion.stiffness > 0.0, deck, "DTTorSpr",
                      "expected a number > 0");
      import_.require(import_.turbine.shaft.torsion.damping >= 0.0, deck, "DTTorDmp",
                      "expected a number >= 0");
      import_.note("shaft.torsion", "DTTorSpr, DTTorDmp");
    } else {
      lock("DrTrDOF", "shaft torsion", "");
      import_.note("shaft.torsion", "DrTrDOF");
    }
    lock("GenDOF", "the rotor speed", "the generator is locked; the rotor turns at RotSpeed");
    read_yaw();
    lock("PitchDOF", "blade pitch", "the pitch drive (ServoDyn) is not read");
    for (const char* key :
         {"PtfmSgDOF", "PtfmSwDOF", "PtfmHvDOF", "PtfmRDOF", "PtfmPDOF", "PtfmYDOF"})
      lock(key, "the platform", "a case has no platform; the tower is clamped at TowerBsHt");
  }

  /// The file of ServoDyn, where it is on and the file exists. Only a free yaw needs it.
  void open_servo() {
    if (main_.number_or("CompServo", 0.0) == 0.0 || !main_.has("ServoFile")) return;
    const std::string path = main_.find_file("ServoFile");
    if (path.empty()) return;
    import_.say(main_, "ServoFile", Fate::taken,
                "the law of the generator's torque; YawSpr and YawDamp of a free yaw");
    if (elastodyn_->flag_or("YawDOF", false))
      servo_ = import_.open(path);
    else
      without_law([&] { servo_ = import_.open(path); });
  }

  void read_law_of_generator() {
    without_law([&] { read_generator_law(import_, *servo_, import_.turbine.shaft.speed); });
  }

  /// A structure needs no law of the torque: faults in it are a warning.
  template <class Read>
  void without_law(const Read& read) {
    DeckErrors others = std::exchange(import_.errors, {});
    read();
    const DeckErrors faults = std::exchange(import_.errors, std::move(others));
    if (faults.empty()) return;
    import_.operation = {};
    import_.warn(faults.first(), "warning: the law of the generator's torque is left out");
  }

  /// A free yaw has the spring and the damper of ServoDyn.
  void read_yaw() {
    Deck& deck = *elastodyn_;
    import_.note("nacelle.yaw", "YawDOF");
    nacelle_yaw_ = fields::deg.to_si(deck.number_or("NacYaw", 0.0));
    import_.ignore(
        deck, "NacYaw",
        "the angle of yaw is 0: the direction that the nacelle faces has no effect where "
        "the tower is the same in both directions; a locked yaw turns the wind instead");
    if (!deck.flag("YawDOF")) {
      import_.say(deck, "YawDOF", Fate::taken, "nacelle.yaw: locked");
      return;
    }
    model::JointDefinition& yaw = import_.turbine.nacelle.yaw;
    if (main_.number("CompServo") == 0.0) {
      yaw.kind = model::JointKind::free;
      import_.say(deck, "YawDOF", Fate::taken,
                  "nacelle.yaw: free, without spring and damper, for ServoDyn is off");
      return;
    }
    if (!servo_) {
      if (!import_.errors.empty()) return;  // those of the file
      import_.say(deck, "YawDOF", Fate::derived, "True, but the file of ServoDyn cannot be read");
      import_.warn(main_.place_of("ServoFile"),
                   "ServoFile: warning: there is no such file, so that spring and damper of the "
                   "yaw are unknown: yaw is locked; hint: nacelle.yaw of the case");
      return;
    }
    yaw.kind = model::JointKind::free;
    yaw.stiffness = servo_->number("YawSpr");
    yaw.damping = servo_->number("YawDamp");
    import_.require(yaw.stiffness >= 0.0, *servo_, "YawSpr", "expected a number >= 0");
    import_.require(yaw.damping >= 0.0, *servo_, "YawDamp", "expected a number >= 0");
    import_.say(deck, "YawDOF", Fate::taken, "nacelle.yaw: free");
    import_.say(*servo_, "YawSpr", Fate::taken, "nacelle.yaw.stiffness");
    import_.say(*servo_, "YawDamp", Fate::taken, "nacelle.yaw.damping");
    import_.ignore(*servo_, "YawNeut", "the spring of a case is relaxed at 0");
    import_.note("nacelle.yaw", "YawDOF; YawSpr, YawDamp of ServoDyn");
  }

  // ---- parts that a case does not have

  /// Warns where a moving platform or effects of the water are left out.
  void warn_of_platform() {
    Deck& deck = *elastodyn_;
    std::string moves;
    for (const char* key :
         {"PtfmSgDOF", "PtfmSwDOF", "PtfmHvDOF", "PtfmRDOF", "PtfmPDOF", "PtfmYDOF"})
      if (deck.has(key) && deck.flag(key)) moves += (moves.empty() ? "" : ", ") + std::string(key);
    const double marine = main_.number_or("MHK", 0.0);
    if (marine != 0.0)
      import_.warn(main_.place_of("MHK"),
                   std::string("MHK: warning: a ") + (marine == 2.0 ? "floating " : "") +
                       "turbine under water: its buoyancy and added mass are left out");
    if (moves.empty()) return;
    import_.warn(deck.place_of("PtfmMass"),
                 "PtfmMass: warning: the platform (" + rounded(deck.number_or("PtfmMass", 0.0)) +
                     " kg), which moves in the deck (" + moves +
                     "), is left out: the tower is clamped at TowerBsHt = " +
                     rounded(deck.number("TowerBsHt")) + " m" +
                     (import_.options.tower_only
                          ? std::string()
                          : "; hint: --tower-only confirms this; tower.support of the case can "
                            "state stiffness, mass and inertia of the structure below it"));
  }

  void warn_of_modules() {
    for (const LeftOut& module : left_out()) {
      const double value = main_.number_or(module.key, 0.0);
      if (!(value >= 1.0 && value <= static_cast<double>(module.names.size()))) continue;
      const char* name = module.names[static_cast<std::size_t>(value) - 1];
      if (name == nullptr) continue;  // read
      import_.say(main_, module.key, Fate::ignored, std::string(name) + ": " + module.words);
      import_.warn(main_.place_of(module.key),
                   std::string(module.key) + ": note: " + name + " is left out: " + module.words);
    }
  }

  // ---- bodies

  void read_geometry() {
    Deck& deck = *elastodyn_;
    model::ShaftDefinition& shaft = import_.turbine.shaft;
    shaft.speed = fields::rpm.to_si(import_.take(deck, "RotSpeed", "shaft.speed_rpm"));
    import_.require(shaft.speed >= 0.0, deck, "RotSpeed", "expected a number >= 0");
    shaft.overhang = import_.take(deck, "OverHang", "shaft.overhang");
    const double tilt = import_.take(deck, "ShftTilt", "shaft.tilt_deg");
    shaft.tilt = fields::deg.to_si(tilt);
    import_.require(std::abs(tilt) < 90.0, deck, "ShftTilt",
                    "expected an angle between -90 and 90 degrees");
    shaft.height = import_.take(deck, "Twr2Shft", "shaft.height");
    import_.turbine.hub.radius = import_.take(deck, "HubRad", "hub.radius");
    import_.require(import_.turbine.hub.radius >= 0.0, deck, "HubRad", "expected a number >= 0");
    const double start = deck.number("Azimuth");
    const double up = deck.number("AzimB1Up");
    shaft.azimuth = fields::deg.to_si(start - up);
    import_.say(deck, "Azimuth", Fate::derived, "shaft.azimuth_deg = Azimuth - AzimB1Up");
    import_.say(deck, "AzimB1Up", Fate::derived, "shaft.azimuth_deg = Azimuth - AzimB1Up");
    import_.note("shaft.azimuth_deg", "Azimuth - AzimB1Up");
    tip_radius_ = deck.number("TipRad");

    double precone = 0.0;
    double blade_pitch = 0.0;
    for (int k = 1; k <= blades_; ++k) {
      const std::string cone = "PreCone(" + std::to_string(k) + ")";
      const double value = import_.derive(deck, cone, "blades.precone_deg");
      if (k == 1) precone = value;
      import_.require(value == precone, deck, cone,
                      "a case has one precone for all blades, blade 1 has " + rounded(precone));
      const std::string pitch = "BlPitch(" + std::to_string(k) + ")";
      const double angle = import_.derive(
          deck, pitch, k == 1 ? "blades.pitch_deg" : "blades.each: the difference from blade 1");
      if (k == 1)
        blade_pitch = angle;
      else if (angle != blade_pitch)
        import_.turbine.blades.each[k].pitch = fields::deg.to_si(angle - blade_pitch);
    }
    import_.turbine.blades.precone = fields::deg.to_si(precone);
    import_.turbine.blades.pitch = fields::deg.to_si(blade_pitch);
    import_.require(std::abs(precone) < 90.0, deck, "PreCone(1)",
                    "expected an angle between -90 and 90 degrees");
    import_.note("blades.precone_deg", "PreCone");
    import_.note("blades.pitch_deg", "BlPitch(1)");
  }

  void read_masses() {
    Deck& deck = *elastodyn_;
    import_.turbine.nacelle.mass = import_.take(deck, "NacMass", "nacelle.mass");
    const double x = import_.derive(deck, "NacCMxn", "nacelle.center_of_mass, y2 = x (downwind)");
    const double y =
        import_.derive(deck, "NacCMyn", "nacelle.center_of_mass, y1 = -y (y is to the left)");
    const double z = import_.derive(deck, "NacCMzn", "nacelle.center_of_mass, y3 = z (up)");
    import_.turbine.nacelle.center_of_mass = {-y, x, z};
    import_.note("nacelle.center_of_mass", "-NacCMyn, NacCMxn, NacCMzn");
    const double about_yaw = deck.number("NacYIner");
    const double own = about_yaw - import_.turbine.nacelle.mass * (x * x + y * y);
    import_.require(own >= 0.0, deck, "NacYIner",
                    "less than NacMass (NacCMxn^2 + NacCMyn^2) = " +
                        rounded(import_.turbine.nacelle.mass * (x * x + y * y)) +
                        ", which no body has");
    import_.turbine.nacelle.inertia = {0.0, 0.0, own};
    import_.say(deck, "NacYIner", Fate::derived,
                "nacelle.inertia about y3 = NacYIner - NacMass (NacCMxn^2 + NacCMyn^2) = " +
                    rounded(own) + " kg m^2; ElastoDyn has none about the other axes");
    import_.note("nacelle.inertia",
                 "NacYIner - NacMass (NacCMxn^2 + NacCMyn^2), about its own centre");

    if (deck.has("Furling") && deck.flag("Furling"))
      add_locked_furling(import_, deck);
    else
      import_.ignore(deck, "Furling", "False: there is nothing that furls");

    import_.turbine.shaft.generator.inertia =
        import_.take(deck, "GenIner", "shaft.generator.own_inertia");
    const std::size_t errors_before = import_.errors.size();
    import_.turbine.shaft.gear_ratio = import_.take(deck, "GBRatio", "shaft.gear_ratio");
    import_.require(
        import_.turbine.shaft.gear_ratio != 0.0 || import_.errors.size() > errors_before, deck,
        "GBRatio", "expected a number other than 0");
    import_.note("shaft.generator", "GenIner; GenDOF: the generator is locked");

    import_.turbine.tower.tip_mass = import_.take(deck, "YawBrMass", "tower.tip_mass");
    read_hub();
    for (const auto& [key, value] :
         {std::pair<const char*, double>{"NacMass", import_.turbine.nacelle.mass},
          {"YawBrMass", import_.turbine.tower.tip_mass},
          {"HubMass", import_.turbine.hub.mass},
          {"GenIner", import_.turbine.shaft.generator.inertia}})
      import_.require(value >= 0.0, deck, key, "expected a number >= 0");
  }

  void read_hub() {
    Deck& deck = *elastodyn_;
    import_.turbine.hub.mass = import_.take(deck, "HubMass", "hub.mass");
    const double center = deck.number("HubCM");
    const double inertia = deck.number("HubIner");
    if (blades_ != 2) {
      import_.turbine.hub.center_of_mass = center;
      import_.say(deck, "HubCM", Fate::taken, "hub.center_of_mass");
      import_.note("hub.center_of_mass", "HubCM");
      import_.turbine.hub.inertia = {0.0, inertia, 0.0};
      import_.say(deck, "HubIner", Fate::taken, "hub.inertia about h2 (the shaft)");
      import_.note("hub.inertia", "HubIner about the shaft");
      import_.require(inertia >= 0.0, deck, "HubIner", "expected a number >= 0");
      import_.ignore(deck, "HubIner_Teeter", "for two-bladed rotors only");
      return;
    }
    // OpenFAST measures UndSling from the teeter pin to the apex upwind, HubCM from the apex
    // downwind: pin to apex = -UndSling, apex to centre = HubCM.
    const double sling = deck.number("UndSling");
    const double delta = deck.number("Delta3") * std::numbers::pi / 180.0;
    import_.turbine.hub.center_of_mass = center - sling;
    import_.say(deck, "HubCM", Fate::derived,
                "hub.center_of_mass = HubCM - UndSling, from the teeter pin");
    import_.note("hub.center_of_mass", "HubCM - UndSling");
    const bool has_both = deck.has("HubIner_Teeter");
    const std::string key = has_both ? "HubIner_Teeter" : "HubIner";
    const double about_pin = has_both ? deck.number(key) : inertia;
    const double shift = import_.turbine.hub.mass * (sling - center) * (sling - center);
    const double own = (about_pin - shift) / (std::cos(delta) * std::cos(delta));
    import_.require(
        own >= 0.0, deck, key,
        "less than HubMass (UndSling - HubCM)^2 = " + rounded(shift) + ", which no body has");
    import_.turbine.hub.inertia = {own, has_both ? inertia : own, 0.0};
    const std::string words =
        "(" + key + " - HubMass (UndSling - HubCM)^2)/cos(Delta3)^2 = " + rounded(own) + " kg m^2";
    if (has_both) {
      import_.say(deck, "HubIner", Fate::taken, "hub.inertia about h2 (the shaft)");
      import_.say(deck, key, Fate::derived, "hub.inertia about h1 (teeter axis) = " + words);
    } else {
      import_.say(deck, key, Fate::derived,
                  "hub.inertia about h1 (teeter axis) and h2 (shaft), a cylinder along h3 as in "
                  "ElastoDyn: " +
                      words);
    }
    import_.note("hub.inertia", words);
  }

  void read_teeter() {
    Deck& deck = *elastodyn_;
    if (blades_ != 2) {
      for (const char* key : {"TeetDOF", "UndSling", "Delta3", "TeetMod", "TeetDmpP", "TeetDmp",
                              "TeetCDmp", "TeetSStP", "TeetHStP", "TeetSSSp", "TeetHSSp"})
        import_.ignore(deck, key, "for two-bladed rotors only");
      return;
    }
    model::HubDefinition& hub = import_.turbine.hub;
    hub.undersling = -deck.number("UndSling");
    import_.say(deck, "UndSling", Fate::derived,
                "hub.teeter.undersling = -UndSling (OpenFAST counts the apex upwind of the pin)");
    import_.note("hub.teeter.undersling", "-UndSling: OpenFAST counts it upwind");
    const double delta3 = deck.number("Delta3");
    hub.delta3 = fields::deg.to_si(delta3);
    if (deck.has("Delta3")) {
      import_.say(deck, "Delta3", Fate::taken, "hub.teeter.delta3_deg");
      import_.require(std::abs(delta3) < 90.0, deck, "Delta3",
                      "expected an angle between -90 and 90 degrees");
    }
    import_.note("hub.teeter.delta3_deg", "Delta3");
    bool is_free = deck.flag("TeetDOF");
    const int mode = deck.integer("TeetMod", 0, 2);
    if (mode == 2 && is_free) {
      is_free = false;
      import_.say(deck, "TeetMod", Fate::derived,
                  "2: teeter is locked, for the user's routine cannot be read");
    } else {
      import_.say(deck, "TeetMod", Fate::derived,
                  "0: no spring, no damper; 1: TeetDmp and TeetSSSp");
    }
    import_.say(deck, "TeetDOF", Fate::derived,
                is_free ? "hub.teeter: free" : "hub.teeter: locked");
    import_.note("hub.teeter.joint", "TeetDOF");
    hub.teeter.kind = is_free ? model::JointKind::free : model::JointKind::locked;
    if (mode != 1) return;
    const auto at_rest = [&](const char* edge, const char* key, double& value,
                             const std::string& what) {
      const double number = deck.number(key);
      const double angle = deck.number(edge);
      if (angle == 0.0) {
        value = number;
        import_.say(deck, key, Fate::taken, "hub.teeter." + what);
      } else {
        import_.say(deck, key, Fate::ignored,
                    std::string("acts beyond ") + edge + " = " + rounded(angle) + " deg only");
      }
    };
    at_rest("TeetDmpP", "TeetDmp", hub.teeter.damping, "damping");
    at_rest("TeetSStP", "TeetSSSp", hub.teeter.stiffness, "stiffness");
    import_.ignore(deck, "TeetCDmp", "dry friction is not linear");
    for (const char* key : {"TeetDmpP", "TeetSStP"})
      import_.ignore(deck, key, "the angle beyond which the damper or the spring acts");
    for (const char* key : {"TeetHStP", "TeetHSSp"})
      import_.ignore(deck, key, "the hard stop is out of reach of small motions");
  }

  // ---- the air

  /// The path of a file that may be missing: a note says so then.
  std::string optional_file(const char* key, const char* what) {
    const std::string path = main_.find_file(key);
    if (path.empty())
      import_.warn(main_.place_of(key),
                   std::string(key) + ": warning: there is no such file: " + what);
    else
      import_.say(main_, key, Fate::taken, "read");
    return path;
  }

  void read_air() {
    if (!main_.has("CompAero")) return;
    const double modules = main_.number("CompAero");
    if (modules == 0.0) {
      import_.say(main_, "CompAero", Fate::derived, "0: there is no air at the blades");
      import_.warn(main_.place_of("CompAero"), "CompAero: note: 0: the case has no air");
      return;
    }
    if (modules != 2.0) return;  // another module, which is left out
    import_.say(main_, "CompAero", Fate::derived, "2: AeroDyn");
    if (main_.number_or("MHK", 0.0) != 0.0) {
      import_.warn(main_.place_of("MHK"),
                   "MHK: note: the blades turn in water: AeroDyn is left out");
      return;
    }
    const std::string path = optional_file("AeroFile", "AeroDyn is left out, the case has no air");
    if (path.empty()) return;
    const AerodynSource source{path, blades_, main_.number_or("AirDens", 0.0)};
    const AerodynModels models = read_aerodyn(import_, source);
    const std::optional<model::WindDefinition> wind = read_wind(models);
    if (!import_.errors.empty()) return;
    import_.turbine.aero = models.aero;
    if (wind) {
      import_.turbine.wind = wind;
      if (models.tower) place_tower_flow(*models.tower);
      import_.turbine.wind->nacelle = models.nacelle;
      if (models.nacelle) import_.note("wind.nacelle", "NacArea, NacCd, NacDragAC");
      return;
    }
    import_.comments.head.push_back(
        "No air acts before the case has a wind, such as `wind: {speed: 8, density: " +
        rounded(models.density) + "}`.");
    if (models.tower)
      import_.warn(path, "note: left out: the flow around the tower, which needs a steady wind");
    if (models.nacelle)
      import_.warn(path, "note: left out: the drag of the nacelle, which needs a steady wind");
  }

  /// Heights of a case count from the foot of the tower.
  void place_tower_flow(model::TowerFlowDefinition flow) {
    const double foot = elastodyn_->number("TowerBsHt");
    for (double& height : flow.heights) height -= foot;
    import_.turbine.wind->tower = std::move(flow);
    import_.note("wind.tower",
                 foot == 0.0 ? "TwrElev, TwrDiam, TwrCd" : "TwrElev - TowerBsHt, TwrDiam, TwrCd");
  }

  std::optional<model::WindDefinition> read_wind(const AerodynModels& models) {
    if (main_.number_or("CompInflow", 0.0) != 1.0) {
      import_.say(main_, "CompInflow", Fate::ignored, "no InflowWind: the case has no wind");
      import_.warn(main_.place_of("CompInflow"),
                   "CompInflow: note: there is no InflowWind: the case has no wind; hint: "
                   "wind.speed of the case states it");
      return {};
    }
    import_.say(main_, "CompInflow", Fate::derived, "1: InflowWind");
    if (main_.has("AirDens"))
      import_.say(main_, "AirDens", Fate::derived, "wind.density, where AeroDyn has no other");
    const std::string path = optional_file("InflowFile", "the case has no wind");
    if (path.empty()) return {};
    const bool is_locked = import_.turbine.nacelle.yaw.kind != model::JointKind::free;
    const InflowSource source{path, elastodyn_->number("TowerBsHt"), is_locked ? nacelle_yaw_ : 0.0,
                              models.density, "AirDens"};
    return read_inflow(import_, source);
  }

  // ---- the tower

  void read_tower() {
    Deck& deck = *elastodyn_;
    const double top = deck.number("TowerHt");
    const double foot = deck.number("TowerBsHt");
    import_.turbine.has_tower = true;
    import_.turbine.tower.length = top - foot;
    import_.require(top > foot, deck, "TowerHt", "expected more than TowerBsHt = " + rounded(foot));
    import_.say(deck, "TowerHt", Fate::derived, "tower.length = TowerHt - TowerBsHt");
    import_.say(deck, "TowerBsHt", Fate::derived,
                "tower.length = TowerHt - TowerBsHt, clamped there");
    import_.note("tower.length", "TowerHt - TowerBsHt");
    const bool fore_aft =
        is_flexible(import_, deck, {"TwFADOF1", "TwFADOF2"}, "EI2 (fore-aft) of the tower");
    const bool side =
        is_flexible(import_, deck, {"TwSSDOF1", "TwSSDOF2"}, "EI3 (side-side) of the tower");
    const std::string name = deck.file("TwrFile");
    import_.say(deck, "TwrFile", Fate::taken, "read");
    read_elastodyn_tower(import_, name, fore_aft, side);
  }

  // ---- the blades

  void read_blades() {
    std::vector<BladeData> blades;
    if (uses_beamdyn_) {
      for (const char* key : {"FlapDOF1", "FlapDOF2", "EdgeDOF"})
        import_.ignore(*elastodyn_, key, "the blades are BeamDyn's");
      for (int k = 1; k <= 3; ++k) {
        import_.ignore(*elastodyn_, "BldFile(" + std::to_string(k) + ")",
                       "the blades are BeamDyn's");
        import_.ignore(*elastodyn_, "TipMass(" + std::to_string(k) + ")",
                       "the blades are BeamDyn's");
      }
      read_each_blade(main_, "BDBldFile", blades,
                      [this](const std::string& path, bool speaks, BladeData& blade) {
                        return read_beamdyn(import_, path, speaks, blade.beam);
                      });
    } else {
      Deck& deck = *elastodyn_;
      flap_ = is_flexible(import_, deck, {"FlapDOF1", "FlapDOF2"}, "EI2 (flap) of the blades");
      edge_ = is_flexible(import_, deck, {"EdgeDOF"}, "EI3 (edge) of the blades");
      for (int k = 1; k <= blades_; ++k) {
        const std::string key = "TipMass(" + std::to_string(k) + ")";
        const double value = import_.derive(deck, key, "blades.tip_mass");
        if (k == 1) tip_mass_ = value;
        import_.require(value >= 0.0, deck, key, "expected a number >= 0");
        import_.require(
            value == tip_mass_, deck, key,
            "a case has one tip mass for all blades, blade 1 has " + rounded(tip_mass_));
      }
      import_.note("blades.tip_mass", "TipMass");
      read_each_blade(deck, "BldFile", blades,
                      [this](const std::string& path, bool speaks, BladeData& blade) {
                        return read_elastodyn(path, speaks, blade.beam);
                      });
    }
    if (!import_.errors.empty() || blades.empty()) return;
    import_.turbine.blades.beam = blades[0].beam;
    set_mesh(import_.turbine.blades.beam, uses_beamdyn_ ? blade_mesh : bending_blade_mesh);
    set_mesh(import_.turbine.tower, uses_beamdyn_ ? tower_mesh : bending_tower_mesh);
    import_.note("blades.elements", "chosen by the importer");
    import_.note("tower.elements", "chosen by the importer");
    for (std::size_t k = 1; k < blades.size(); ++k) compare_blade(blades, k);
    const double flexible = tip_radius_ - import_.turbine.hub.radius;
    if (!uses_beamdyn_) {
      import_.say(*elastodyn_, "TipRad", Fate::derived, "blades.length = TipRad - HubRad");
      import_.note("blades.length", "TipRad - HubRad");
      return;
    }
    import_.say(
        *elastodyn_, "TipRad", Fate::ignored,
        "BeamDyn's key points give the length; TipRad - HubRad = " + rounded(flexible) + " m");
  }

  bool read_elastodyn(const std::string& path, bool speaks, model::BeamDefinition& beam) {
    beam.length = tip_radius_ - import_.turbine.hub.radius;
    beam.tip_mass = tip_mass_;
    import_.require(beam.length > 0.0, *elastodyn_, "TipRad",
                    "expected more than HubRad = " + rounded(import_.turbine.hub.radius));
    return import_.errors.empty() &&
           read_elastodyn_blade(import_, path, speaks, flap_, edge_, beam);
  }

  void read_each_blade(Deck& deck, const std::string& prefix, std::vector<BladeData>& blades,
                       const std::function<bool(const std::string&, bool, BladeData&)>& read_one) {
    for (int k = 1; k <= blades_; ++k) {
      const std::string key = prefix + "(" + std::to_string(k) + ")";
      const std::string path = deck.file(key);
      import_.say(deck, key, Fate::taken, "read");
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
    const model::BeamDefinition& first = blades[0].beam;
    const model::BeamDefinition& other = blades[k].beam;
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
      const model::SectionDefinition& a = first.sections[i];
      const model::SectionDefinition& b = other.sections[i];
      if (i == 0) {
        mass_factor = b.mass(0, 0) / a.mass(0, 0);
        if (a.stiffness.norm() > 0.0) stiffness_factor = b.stiffness.norm() / a.stiffness.norm();
      }
      alike =
          std::abs(a.at - b.at) <= same_blade && a.twist == b.twist && a.rigid == b.rigid &&
          (b.mass - mass_factor * a.mass).norm() <= same_blade * b.mass.norm() &&
          (b.stiffness - stiffness_factor * a.stiffness).norm() <= same_blade * b.stiffness.norm();
    }
    if (!alike) {
      import_.errors.add(
          blades[k].path,
          "blade " + std::to_string(number) + " differs from blade 1 (" + blades[0].path +
              ") by more than one factor of its mass and one of its stiffness, which is "
              "all a case can state");
      return;
    }
    if (mass_factor == 1.0 && stiffness_factor == 1.0) return;
    import_.turbine.blades.each[number].mass_factor = mass_factor;
    import_.turbine.blades.each[number].stiffness_factor = stiffness_factor;
    import_.report.push_back({blades[k].path, "blade " + std::to_string(number), Fate::derived,
                              "blades.each: mass_factor " + rounded(mass_factor) +
                                  ", stiffness_factor " + rounded(stiffness_factor) +
                                  "; damping is that of blade 1"});
  }

  // ---- masses in the head of the case

  void report_masses() {
    const BeamMass tower = integrate_mass(import_.turbine.tower, import_.turbine.tower.length);
    const BeamMass blade =
        integrate_mass(import_.turbine.blades.beam, import_.turbine.blades.beam.length);
    import_.turbine.title =
        clean_text(elastodyn_->title().empty() ? main_.title() : elastodyn_->title());
    import_.comments.head.push_back("Masses [kg]: tower " + rounded(tower.mass) + ", each blade " +
                                    rounded(blade.mass) + " (centre " +
                                    rounded(blade.moment / blade.mass, 5) +
                                    " m from its root), hub " + rounded(import_.turbine.hub.mass) +
                                    ", nacelle " + rounded(import_.turbine.nacelle.mass) + ".");
  }

  std::string path_;
  OpenfastImport import_;
  Deck main_;
  std::unique_ptr<Deck> elastodyn_;
  std::unique_ptr<Deck> servo_;  ///< of ServoDyn; null: none
  bool uses_beamdyn_ = false;
  int blades_ = 3;
  double tip_radius_ = 0.0;
  double nacelle_yaw_ = 0.0;  ///< [rad]
  double tip_mass_ = 0.0;
  bool flap_ = true;
  bool edge_ = true;
};

}  // namespace

Import import_openfast(const std::string& path, const ImportOptions& options) {
  return Importer(path, options).run();
}

}  // namespace samara::decks
