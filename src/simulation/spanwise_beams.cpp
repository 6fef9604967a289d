#include "samara/simulation/spanwise_beams.hpp"

#include <numbers>
#include <string>

#include "samara/math/rotation.hpp"
#include "samara/model/radius.hpp"
#include "samara/simulation/steady_state.hpp"
#include "samara/turbine/beam_stations.hpp"

namespace samara::simulation {
namespace {

using turbine::BeamStation;

constexpr double degree = std::numbers::pi / 180.0;

/// Names of the deflections and axes of a kind of beams. A deflection along b3 comes first, then
/// that against b2 (docs/channels.md), then the twist.
struct Kind {
  SpanwiseQuantity deflections[3];
  const char* load_frame;
  const char* carrier;
};

const Kind blade_kind{
    {{"out_of_plane", "m", "blade root, coned, not pitched",
      "deflection out of the plane of the rotor, downwind"},
     {"in_plane", "m", "blade root, coned, not pitched",
      "deflection in the plane of the rotor, to the trailing edge"},
     {"twist", "deg", "blade root, coned and pitched", "rotation vector about b1, toward feather"}},
    "blade root, coned and pitched",
    "hub"};

const Kind tower_kind{{{"fore_aft", "m", "tower base", "deflection along n2, downwind"},
                       {"side_side", "m", "tower base", "deflection against n1, to the left"},
                       {"twist", "deg", "tower base", "rotation vector about n3"}},
                      "tower base: b1 = n3, b2 = n1, b3 = n2",
                      "foundation"};

SpanwiseBeams make_beams(const Kind& kind, const model::Beam& beam, std::size_t count) {
  SpanwiseBeams beams;
  beams.count = count;
  beams.fractions = turbine::station_fractions(beam);
  beams.quantities.assign(std::begin(kind.deflections), std::end(kind.deflections));
  const auto add_three = [&](const std::string& name, const std::string& unit,
                             const std::string& word) {
    for (int i = 1; i <= 3; ++i) {
      const std::string axis = std::to_string(i);
      beams.quantities.push_back({name + axis, unit, kind.load_frame,
                                  "internal " + word + " b" + axis +
                                      " of the outer part on the inner one, at the root on the " +
                                      kind.carrier});
    }
  };
  add_three("F", "N", "force along");
  add_three("M", "N m", "moment about");
  for (SpanwiseQuantity& quantity : beams.quantities)
    quantity.resize(count * beams.fractions.size());
  return beams;
}

/// `moved`: the displacement in the axes of the deflections. `twist`: [rad]
void add(SpanwiseBeams& beams, std::size_t at, int instants, const BeamStation& station,
         const Vector3& moved, double twist) {
  auto quantity = beams.quantities.begin();
  const auto put = [&](double value) { (quantity++)->add(at, value, instants); };
  put(moved(2));
  put(0.0 - moved(1));
  put(twist / degree);
  for (int i = 0; i < 3; ++i) put(station.force(i));
  for (int i = 0; i < 3; ++i) put(station.moment(i));
}

}  // namespace

SpanwiseStructure find_spanwise_structure(const turbine::TurbineSystem& system,
                                          const analysis::Trim& trim) {
  const model::Turbine& turbine = system.turbine();
  SpanwiseStructure structure;
  if (!turbine.blades.empty()) {
    const model::Beam& blade = turbine.blades.front();
    const model::BladeRoot& root = turbine.roots.front();
    structure.blades = make_beams(blade_kind, blade, turbine.blades.size());
    structure.blades.places.push_back(model::undeformed_radius(root, Vector3::Zero()));
    for (const elements::BeamPoint& point : blade.points)
      structure.blades.places.push_back(model::undeformed_radius(root, point.x));
    structure.blades.places.push_back(model::undeformed_radius(root, blade.tip));
  }
  if (turbine.has_tower) {
    structure.tower = make_beams(tower_kind, turbine.tower, 1);
    structure.tower.places.push_back(0.0);
    for (const elements::BeamPoint& point : turbine.tower.points)
      structure.tower.places.push_back(point.x(0));
    structure.tower.places.push_back(turbine.tower.tip(0));
  }
  const int instants = instants_of_means(trim);
  visit_instants(system, trim, [&](double t, Vec z, Vec z_dot) {
    const std::vector<double> state = petsc::values_of(z);
    const std::vector<double> rates = petsc::values_of(z_dot);
    const std::vector<std::vector<BeamStation>> beams =
        turbine::find_beam_stations(system, t, state, rates);
    const std::vector<double> pitch = system.equations().report<double>(t, state, rates, {}).pitch;
    std::size_t at = 0;
    for (std::size_t k = 0; k < turbine.blades.size(); ++k) {
      const Matrix3 to_cone = math::turn_about<double>(-Vector3::UnitX(), pitch[k]);
      for (const BeamStation& station : beams[k])
        add(structure.blades, at++, instants, station, to_cone * station.displacement,
            0.0 - station.rotation(0));
    }
    if (!turbine.has_tower) return;
    at = 0;
    for (const BeamStation& station : beams.back())
      add(structure.tower, at++, instants, station, station.displacement, station.rotation(0));
  });
  return structure;
}

}  // namespace samara::simulation
