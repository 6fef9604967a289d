#include "air_validation.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "samara/base/format.hpp"
#include "samara/base/words.hpp"
#include "samara/elements/rotor_wake.hpp"
#include "samara/model/airfoil.hpp"

namespace samara::model {
namespace {

std::string indexed(const std::string& list, std::size_t i) {
  return list + "[" + std::to_string(i) + "]";
}

/// Names are parts of paths of keys (`--set blades.airfoils.NAME.file=F.dat`).
bool is_name(const std::string& text) {
  const auto is_inner = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '+' || c == ' ';
  };
  return !text.empty() && text.front() != ' ' && text.back() != ' ' &&
         std::ranges::all_of(text, is_inner);
}

class AirValidation {
 public:
  explicit AirValidation(const TurbineDefinition& turbine) : turbine_(turbine) {}

  std::vector<Fault> find() {
    if (turbine_.wind) check_wind(*turbine_.wind);
    if (turbine_.aero) check_aero(*turbine_.aero);
    if (turbine_.blades.count == 0) return std::move(faults_);
    for (const auto& [name, airfoil] : turbine_.blades.airfoils) check_airfoil(name, airfoil);
    by_thickness_ = sort_by_thickness(turbine_.blades.airfoils);
    for (std::size_t i = 0; i < turbine_.blades.aero_sections.size(); ++i) check_section(i);
    return std::move(faults_);
  }

 private:
  void add(const std::string& field, const std::string& text,
           const std::vector<std::string>& others = {}) {
    faults_.push_back({field, text, others});
  }

  void check_wind(const WindDefinition& wind) {
    using Profile = WindDefinition::Profile;
    if (turbine_.blades.count == 0) return add("wind", "there are no blades");
    if (wind.tower) check_tower(*wind.tower);
    if (wind.nacelle) check_nacelle(*wind.nacelle);
    const bool needs_height =
        wind.profile != Profile::uniform || wind.shear_up != 0.0 || wind.veer != 0.0;
    if (needs_height && !(wind.height > 0.0))
      add("wind.height",
          "expected a number > 0; hint: shear and veer count from the height at which the wind has "
          "its speed, e.g. that of the hub",
          {"wind.shear", "wind.veer_deg"});
    if (wind.profile == Profile::logarithmic && wind.height > 0.0 &&
        !(wind.roughness < wind.height))
      add("wind.shear.log",
          "expected less than the height, " + general(wind.height, 6) +
              " m; hint: a roughness "
              "length in metres, such as 0.03",
          {"wind.height"});
    if ((wind.shear_left != 0.0 || wind.shear_up != 0.0) && !(wind.shear_length > 0.0))
      add("wind.shear.length",
          "expected a number > 0; hint: left and up are changes of the speed by this length, e.g. "
          "the diameter of the rotor",
          {"wind.shear.left", "wind.shear.up"});
  }

  void check_tower(const TowerFlowDefinition& tower) {
    const std::string place = "wind.tower.sections";
    if (tower.heights.empty() || tower.diameters.size() != tower.heights.size() ||
        tower.drags.size() != tower.heights.size())
      return add(place, "expected one height, diameter and drag coefficient or more");
    for (std::size_t i = 0; i < tower.heights.size(); ++i) {
      if (i > 0 && !(tower.heights[i] > tower.heights[i - 1]))
        add(place, "the heights do not rise (" + general(tower.heights[i - 1], 6) + ", then " +
                       general(tower.heights[i], 6) + ")");
      if (!(tower.diameters[i] > 0.0))
        add(place, "expected diameters > 0, got " + general(tower.diameters[i], 6));
      if (!(tower.drags[i] >= 0.0))
        add(place, "expected drag coefficients >= 0, got " + general(tower.drags[i], 6));
    }
    if (!(tower.turbulence > 0.0)) add("wind.tower.turbulence", "expected a number > 0");
    if (!turbine_.has_tower) add("wind.tower", "there is no tower", {"tower"});
  }

  void check_nacelle(const NacelleDragDefinition& nacelle) {
    for (const auto& [key, values] :
         {std::pair{"wind.nacelle.areas", nacelle.areas}, {"wind.nacelle.drag", nacelle.drags}})
      if (std::ranges::any_of(values, [](double value) { return !(value >= 0.0); }))
        add(key, "expected numbers >= 0");
    if (!turbine_.has_tower)
      add("wind.nacelle",
          "the nacelle stands on the ground, where its drag has no effect; hint: tower", {"tower"});
  }

  void check_aero(const AeroDefinition& aero) {
    const BladesDefinition& blades = turbine_.blades;
    if (blades.count == 0)
      add("aero", "there are no blades");
    else if (blades.aero_sections.empty())
      add("aero", "needs blades.aero_sections, the chords and airfoils of the blades",
          {"blades.aero_sections"});
    if (aero.dynamics == AirfoilDynamics::peters && aero.induction != Induction::none &&
        aero.inflow == Inflow::oye)
      add("aero.airfoil_dynamics",
          "peters has no dynamic inflow beside it; hint: inflow: equilibrium, or induction: none",
          {"aero.inflow"});
    check_wake_shapes(aero.wake_shapes);
    if (!(aero.wake[2] > 0.0 && aero.wake[3] > 0.0))
      add("aero.wake_constants", "expected decay rates b1, b2 > 0");
  }

  void check_wake_shapes(const std::vector<int>& counts) {
    const std::string place = "aero.wake_shapes";
    if (counts.empty() || counts[0] < 1)
      return add(place, "expected 1 or more shapes of the mean, the first number");
    for (std::size_t m = 0; m < counts.size(); ++m) {
      if (counts[m] < 0) return add(place, "expected whole numbers from 0");
      const int order = static_cast<int>(m) + 2 * counts[m] - 1;
      if (counts[m] > 0 && order > elements::largest_wake_order)
        return add(place, "harmonic " + std::to_string(m) + " with " + std::to_string(counts[m]) +
                              " shapes has the order " + std::to_string(order) +
                              "; the harmonic plus twice its shapes less one is at most " +
                              std::to_string(elements::largest_wake_order));
    }
  }

  void check_airfoil(const std::string& name, const AirfoilDefinition& airfoil) {
    const std::string place = "blades.airfoils." + name;
    if (!is_name(name))
      add("blades.airfoils",
          "expected a name of letters, digits, spaces, \"_\", \"-\" and \"+\", got \"" + name +
              "\"");
    if (airfoil.polars.empty())
      add(place + ".polars", "expected one polar or more", {place + ".file"});
    for (std::size_t i = 0; i < airfoil.polars.size(); ++i) {
      const PolarDefinition& polar = airfoil.polars[i];
      const std::string own = indexed(place + ".polars", i);
      if (const std::string fault = find_polar_fault(polar); !fault.empty()) add(own, fault);
      if (airfoil.polars.size() > 1 && !(polar.reynolds > 0.0))
        add(own + ".reynolds", "expected a number > 0; several polars are told apart by it");
      const bool is_double =
          std::any_of(airfoil.polars.begin(), airfoil.polars.begin() + static_cast<long>(i),
                      [&](const auto& other) { return other.reynolds == polar.reynolds; });
      if (is_double && polar.reynolds > 0.0) add(own + ".reynolds", "the same as of another polar");
    }
  }

  void check_section(std::size_t i) {
    const std::vector<AeroSectionDefinition>& sections = turbine_.blades.aero_sections;
    const AeroSectionDefinition& section = sections[i];
    const std::string place = indexed("blades.aero_sections", i);
    if (i > 0 && !(section.at > sections[i - 1].at))
      add(place + ".at",
          "expected more than the section before has, got " + general(section.at, 6));
    if (!(section.chord > 0.0))
      add(place + ".chord", "expected a number > 0, got " + general(section.chord, 6));
    if (section.thickness.has_value() != sections[0].thickness.has_value())
      return add(place, "expected a thickness at all sections or at none");
    if (section.thickness) return check_thickness(i);
    const auto& airfoils = turbine_.blades.airfoils;
    if (airfoils.contains(section.airfoil)) return;
    std::vector<std::string> names;
    for (const auto& [name, airfoil] : airfoils) names.push_back(name);
    add(place + ".airfoil", "there is no airfoil \"" + section.airfoil + "\" in blades.airfoils" +
                                suggest(section.airfoil, names));
  }

  void check_thickness(std::size_t i) {
    const AeroSectionDefinition& section = turbine_.blades.aero_sections[i];
    const std::string place = indexed("blades.aero_sections", i);
    if (!section.airfoil.empty())
      add(place, "airfoil and thickness cannot both be given", {place + ".thickness"});
    if (i == 0) check_airfoils_by_thickness();
    if (by_thickness_.empty()) return;
    constexpr double round_off = 1e-9;
    const double least = by_thickness_.front().first;
    const double largest = by_thickness_.back().first;
    if (!(*section.thickness >= least - round_off && *section.thickness <= largest + round_off))
      add(place + ".thickness", "expected " + general(least, 6) + " to " + general(largest, 6) +
                                    ", those of blades.airfoils, got " +
                                    general(*section.thickness, 6));
  }

  void check_airfoils_by_thickness() {
    if (by_thickness_.empty())
      add("blades.aero_sections[0].thickness", "no airfoil of blades.airfoils has a thickness");
    for (std::size_t k = 1; k < by_thickness_.size(); ++k)
      if (by_thickness_[k].first == by_thickness_[k - 1].first)
        add("blades.airfoils." + by_thickness_[k].second + ".thickness",
            "that of airfoil \"" + by_thickness_[k - 1].second +
                "\"; sections with a thickness need airfoils that differ in it");
  }

  const TurbineDefinition& turbine_;
  std::vector<std::pair<double, std::string>> by_thickness_;
  std::vector<Fault> faults_;
};

}  // namespace

std::vector<Fault> find_air_faults(const TurbineDefinition& turbine) {
  return AirValidation(turbine).find();
}

std::vector<Fault> find_air_notes(const TurbineDefinition& turbine) {
  const BladesDefinition& blades = turbine.blades;
  if (turbine.wind && blades.count > 0 && blades.aero_sections.empty())
    return {{"wind", "without effect, there are no blades.aero_sections"}};
  if (!turbine.aero) return {};
  std::vector<Fault> notes;
  if (!turbine.wind) notes.push_back({"aero", "without effect, there is no wind"});
  const bool has_thickness = !blades.aero_sections.empty() && blades.aero_sections[0].thickness;
  for (const auto& [name, airfoil] : blades.airfoils) {
    const bool is_used =
        (has_thickness && airfoil.thickness) ||
        std::ranges::find(blades.aero_sections, name, &AeroSectionDefinition::airfoil) !=
            blades.aero_sections.end();
    if (!is_used) continue;
    for (std::size_t i = 0; i < airfoil.polars.size(); ++i) {
      if (!find_polar_fault(airfoil.polars[i]).empty()) continue;
      for (const std::string& text : find_polar_notes(airfoil.polars[i]))
        notes.push_back({indexed("blades.airfoils." + name + ".polars", i), text});
    }
  }
  return notes;
}

}  // namespace samara::model
