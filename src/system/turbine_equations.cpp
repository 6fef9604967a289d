#include "samara/system/turbine_equations.hpp"

#include <algorithm>

namespace samara::system {
namespace {

using components::Residual;

// Ports: the hub's motion, the load on it, the motion of each root.
constexpr int hub_port = 0;
constexpr int load_port = 1;
constexpr int first_root_port = 2;
constexpr int motion_values = 9;
constexpr int load_values = 6;

}  // namespace

TurbineEquations::TurbineEquations(const model::Turbine& turbine)
    : turbine_(turbine), layout_(turbine_), port_sizes_{motion_values, load_values} {
  place_beams();
  port_sizes_.resize(first_root_port + placed_.size(), motion_values);
  bodies_ = std::make_unique<components::RigidBodies>(turbine_, place_bodies());
  for (const components::PlacedBeam& placed : placed_)
    components_.push_back(std::make_unique<components::Beam>(placed, turbine_.speed));
  for (const int i : layout_.padding()) padding_.push_back({i, i, 1, 1.0});
  components::Pattern pattern(layout_.size(), port_sizes_);
  pattern.add(padding_);
  bodies_->add_to(pattern);
  for (const auto& component : components_) component->add_to(pattern);
  plan_ = std::make_shared<const components::TangentPlan>(pattern.finish());
}

TurbineEquations::~TurbineEquations() = default;

void TurbineEquations::place_beams() {
  const auto add = [this](const model::Beam& beam) -> components::PlacedBeam& {
    components::PlacedBeam placed;
    placed.beam = &beam;
    placed.root_port = first_root_port + static_cast<int>(placed_.size());
    placed_.push_back(placed);
    return placed_.back();
  };
  for (std::size_t k = 0; k < turbine_.blades.size(); ++k) {
    const int number = static_cast<int>(k);
    const model::Beam& beam = turbine_.blades[k];
    components::PlacedBeam& blade = add(beam);
    for (int p = 0; p < beam.point_count(); ++p)
      blade.points.push_back(layout_.blade_point(number, p));
    for (std::size_t m = 0; m < beam.mass_nodes.size(); ++m)
      blade.masses.push_back(layout_.blade_mass(number, static_cast<int>(m)));
    blade.tip = layout_.blade_tip(number);
    blade.root = layout_.blade_root(number);
  }
  if (!turbine_.has_tower) return;
  const model::Beam& beam = turbine_.tower;
  components::PlacedBeam& tower = add(beam);
  for (int p = 0; p < beam.point_count(); ++p) tower.points.push_back(layout_.tower_point(p));
  for (std::size_t m = 0; m < beam.mass_nodes.size(); ++m)
    tower.masses.push_back(layout_.tower_mass(static_cast<int>(m)));
  tower.tip = layout_.tower_tip();
  tower.root = layout_.tower_root();
  tower.end = components::BeamEnd::carries;
}

components::PlacedBodies TurbineEquations::place_bodies() const {
  components::PlacedBodies bodies;
  bodies.joints = layout_.joints();
  bodies.hub_port = hub_port;
  bodies.load_port = load_port;
  for (const components::PlacedBeam& placed : placed_) {
    if (placed.end == components::BeamEnd::carries) {
      bodies.tower_top = placed.tip;
      bodies.tower_port = placed.root_port;
      continue;
    }
    bodies.blade_roots.push_back(placed.root);
    bodies.root_ports.push_back(placed.root_port);
  }
  return bodies;
}

template <class T>
void TurbineEquations::evaluate(double t, const std::vector<T>& z, const std::vector<T>& z_dot,
                                const TurbineInputs<T>& inputs, std::vector<T>& r) const {
  std::fill(r.begin(), r.end(), T(0));
  Residual<T> residual(t, z, z_dot, inputs, port_sizes_, r);
  residual.add(padding_);
  bodies_->add_to(residual);
  for (const auto& component : components_) component->add_to(residual);
}

void TurbineEquations::evaluate(double t, const std::vector<double>& z,
                                const std::vector<double>& z_dot,
                                components::Tangents& tangents) const {
  tangents.start(t, z, z_dot);
  bodies_->add_to(tangents);
  for (const auto& component : components_) component->add_to(tangents);
}

template <class T>
elements::ChainReport<T> TurbineEquations::report(double t, const std::vector<T>& z,
                                                  const std::vector<T>& z_dot,
                                                  const TurbineInputs<T>& inputs) const {
  std::vector<T> unused;  // only ports are filled
  Residual<T> residual(t, z, z_dot, inputs, port_sizes_, unused);
  return bodies_->report(residual);
}

using Complex = std::complex<double>;
template void TurbineEquations::evaluate(double, const std::vector<double>&,
                                         const std::vector<double>&, const TurbineInputs<double>&,
                                         std::vector<double>&) const;
template void TurbineEquations::evaluate(double, const std::vector<Complex>&,
                                         const std::vector<Complex>&, const TurbineInputs<Complex>&,
                                         std::vector<Complex>&) const;
template elements::ChainReport<double> TurbineEquations::report(double, const std::vector<double>&,
                                                                const std::vector<double>&,
                                                                const TurbineInputs<double>&) const;
template elements::ChainReport<Complex> TurbineEquations::report(
    double, const std::vector<Complex>&, const std::vector<Complex>&,
    const TurbineInputs<Complex>&) const;

}  // namespace samara::system
