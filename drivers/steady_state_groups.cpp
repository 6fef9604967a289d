#include "steady_state_groups.hpp"

#include <string>
#include <vector>

#include "samara/simulation/spanwise_air.hpp"
#include "samara/simulation/spanwise_beams.hpp"

namespace samara::drivers {
namespace {

constexpr char no_frame[] = "none";

void write_stations(io::ResultFile& file, const std::string& group,
                    const std::vector<double>& fractions) {
  file.write_values(
      group + "station", fractions,
      {"1", no_frame, "places of the stations, fractions of the length", {"station"}});
}

/// Three datasets for each quantity. Axes: blade (where there is a choice), station.
void write_quantities(io::ResultFile& file, const std::string& group,
                      const std::vector<simulation::SpanwiseQuantity>& quantities,
                      const std::vector<std::size_t>& shape) {
  std::vector<std::string> axes{"station"};
  if (shape.size() > 1) axes.insert(axes.begin(), "blade");
  for (const simulation::SpanwiseQuantity& quantity : quantities) {
    const auto write = [&](const std::string& ending, const std::vector<double>& values,
                           const std::string& words) {
      file.write_array(group + quantity.name + ending, values, shape,
                       {quantity.unit, quantity.frame, words, axes});
    };
    write("", quantity.mean, "mean over a revolution: " + quantity.description);
    write("_least", quantity.least, "least value over a revolution");
    write("_largest", quantity.largest, "largest value over a revolution");
  }
}

void write_radii(io::ResultFile& file, const std::string& group, const std::vector<double>& radii) {
  file.write_values(group + "radius", radii,
                    {"m", no_frame, "undeformed distance from the shaft axis", {"station"}});
}

void write_air(io::ResultFile& file, const simulation::SpanwiseAir& air) {
  if (air.quantities.empty()) return;
  const std::string group = "/trim/air/";
  write_stations(file, group, air.fractions);
  write_radii(file, group, air.radii);
  file.write_values(group + "chord", air.chords, {"m", no_frame, "chord", {"station"}});
  write_quantities(file, group, air.quantities, {air.blades, air.fractions.size()});
}

void write_structure(io::ResultFile& file, const simulation::SpanwiseStructure& structure) {
  const simulation::SpanwiseBeams& blades = structure.blades;
  if (blades.count > 0) {
    write_stations(file, "/trim/blades/", blades.fractions);
    write_radii(file, "/trim/blades/", blades.places);
    write_quantities(file, "/trim/blades/", blades.quantities,
                     {blades.count, blades.fractions.size()});
  }
  const simulation::SpanwiseBeams& tower = structure.tower;
  if (tower.count == 0) return;
  write_stations(file, "/trim/tower/", tower.fractions);
  file.write_values("/trim/tower/height", tower.places,
                    {"m", no_frame, "undeformed height above the foot", {"station"}});
  write_quantities(file, "/trim/tower/", tower.quantities, {tower.fractions.size()});
}

}  // namespace

void write_steady_state(io::ResultFile& file, const turbine::TurbineSystem& system,
                        const analysis::Trim& trim) {
  file.write_trim(trim);
  write_structure(file, simulation::find_spanwise_structure(system, trim));
  write_air(file, simulation::find_spanwise_air(system, trim));
}

}  // namespace samara::drivers
