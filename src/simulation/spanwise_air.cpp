#include "samara/simulation/spanwise_air.hpp"

#include <array>
#include <numbers>

#include "samara/simulation/steady_state.hpp"

namespace samara::simulation {
namespace {

using Report = components::AirPointReport<double>;
using Reports = std::vector<std::vector<Report>>;

constexpr double degree = std::numbers::pi / 180.0;

struct Quantity {
  const char* name;
  const char* unit;
  const char* description;
  double (*value)(const Report&);
};

constexpr std::array quantities{
    Quantity{"angle_of_attack", "deg", "at the aerodynamic centre",
             [](const Report& r) { return r.angle / degree; }},
    Quantity{"inflow_angle", "deg", "of the relative wind from the plane of the rotor",
             [](const Report& r) { return r.inflow_angle / degree; }},
    Quantity{"relative_speed", "m/s", "of the relative wind in the section",
             [](const Report& r) { return r.speed; }},
    Quantity{"axial_induction", "1", "induction factor along the shaft",
             [](const Report& r) { return r.axial; }},
    Quantity{"tangential_induction", "1", "induction factor about the shaft",
             [](const Report& r) { return r.tangential; }},
    Quantity{"Cl", "1", "lift coefficient", [](const Report& r) { return r.lift; }},
    Quantity{"Cd", "1", "drag coefficient", [](const Report& r) { return r.drag; }},
    Quantity{"Cm", "1", "moment coefficient about the aerodynamic centre, nose up",
             [](const Report& r) { return r.moment; }},
    Quantity{"normal_force", "N/m", "per length, along the shaft downwind",
             [](const Report& r) { return r.thrust; }},
    Quantity{"tangential_force", "N/m", "per length, in the sense in which the rotor turns",
             [](const Report& r) { return r.driving; }},
};

}  // namespace

SpanwiseAir find_spanwise_air(const turbine::TurbineSystem& system, const analysis::Trim& trim) {
  SpanwiseAir air;
  const model::Turbine& turbine = system.turbine();
  if (!turbine.air) return air;
  air.blades = turbine.air->stations.size();
  air.fractions = turbine.blades.front().fractions;
  for (const elements::AirStation& station : turbine.air->stations.front()) {
    air.radii.push_back(station.radius);
    air.chords.push_back(station.chord);
  }
  const std::size_t size = air.blades * air.fractions.size();
  for (const Quantity& quantity : quantities) {
    air.quantities.push_back({quantity.name, quantity.unit, "none", quantity.description});
    air.quantities.back().resize(size);
  }
  const int instants = instants_of_means(trim);
  visit_instants(system, trim, [&](double t, Vec z, Vec z_dot) {
    const Reports reports =
        system.equations().air_report<double>(t, petsc::values_of(z), petsc::values_of(z_dot), {});
    for (std::size_t q = 0; q < quantities.size(); ++q) {
      SpanwiseQuantity& own = air.quantities[q];
      std::size_t at = 0;
      for (const std::vector<Report>& blade : reports)
        for (const Report& report : blade) own.add(at++, quantities[q].value(report), instants);
    }
  });
  return air;
}

}  // namespace samara::simulation
