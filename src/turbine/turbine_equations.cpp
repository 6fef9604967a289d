#include "samara/turbine/turbine_equations.hpp"

#include <algorithm>

#include "samara/turbine/extension.hpp"

#include "rotor_symmetry.hpp"

namespace samara::turbine {
namespace {

using components::BeamSetting;
using components::Residual;
using system::Frame;
using system::PartKind;

// Ranks of elimination.
constexpr int blade_rank = 0;
constexpr int tower_rank = 1;
constexpr int shared_rank = 2;
/// Rank of the hinges, whose balance contains only a moment of the roots' reactions, of the states
/// of controls, and of extensions.
constexpr int last_rank = extension_rank;

BeamSetting blade_setting(const model::Turbine& turbine, std::size_t k) {
  const elements::RigidChain& chain = turbine.chain;
  BeamSetting blade;
  blade.mesh = &turbine.blades[k];
  blade.owner = {PartKind::beam, "blade", static_cast<int>(k) + 1};
  blade.frame = Frame::rotating;
  blade.directions = {"axial", "lead-lag", "flap", "torsion", "flap", "lead-lag"};
  blade.support_part = "blade";
  blade.support_directions = {"support",     "support",    "support",
                              "pitch hinge", "flap hinge", "lag hinge"};
  blade.rank = blade_rank;
  blade.shared_rank = shared_rank;
  blade.speed = turbine.speed;
  blade.has_air = turbine.air.has_value();
  blade.root_moves = turbine.has_tower || chain.yaw.free || chain.teeter.free ||
                     chain.torsion.free || chain.generator.free || !turbine.roots[k].hinges.empty();
  return blade;
}

/// The tower's b2 is side-side (n1), its b3 downwind (n2). Bending about b2 moves the tower along
/// b3.
BeamSetting tower_setting(const model::Turbine& turbine) {
  BeamSetting tower;
  tower.mesh = &turbine.tower;
  tower.owner = {PartKind::beam, "tower"};
  tower.end = components::BeamEnd::carries;
  tower.end_name = "top";
  tower.directions = {"axial", "side-side", "fore-aft", "torsion", "fore-aft", "side-side"};
  tower.support_part = "foundation";
  tower.support_directions.fill("");
  tower.rank = tower_rank;
  tower.shared_rank = shared_rank;
  tower.speed = turbine.speed;
  return tower;
}

}  // namespace

TurbineEquations::TurbineEquations(const model::Turbine& turbine,
                                   const components::TangentPlan* at_least)
    : turbine_(turbine) {
  make_components();
  components::Registry registry = place();
  describe(registry);
  components::Pattern pattern(layout_.size(), declarations_.port_sizes);
  state(pattern);
  plan_ = std::make_shared<const components::TangentPlan>(pattern.finish(at_least));
}

void TurbineEquations::state(components::Pattern& pattern) const {
  pattern.add(padding_);
  for (const components::Component* component : components_) component->add_to(pattern);
}

std::shared_ptr<const components::TangentPlan> TurbineEquations::find_plan(
    const components::Portion& portion) const {
  components::Pattern pattern(layout_.size(), declarations_.port_sizes, &portion);
  state(pattern);
  return std::make_shared<const components::TangentPlan>(pattern.finish());
}

TurbineEquations::~TurbineEquations() = default;

/// Order: first the controls, which provide the pitch; then the bodies, which provide the motion of
/// the beams' roots.
void TurbineEquations::make_components() {
  components::BodiesSetting bodies;
  bodies.shared_rank = shared_rank;
  bodies.hinge_rank = last_rank;
  for (std::size_t k = 0; k < turbine_.blades.size(); ++k) {
    beams_.push_back(std::make_unique<components::Beam>(blade_setting(turbine_, k)));
    bodies.blades.push_back(beams_.back().get());
  }
  if (turbine_.has_tower) {
    beams_.push_back(std::make_unique<components::Beam>(tower_setting(turbine_)));
    bodies.tower = beams_.back().get();
  }
  bodies_ = std::make_unique<components::RigidBodies>(turbine_, bodies);
  if (turbine_.controller) {
    controller_ = std::make_unique<components::Controller>(turbine_, last_rank);
    components_.push_back(controller_.get());
  }
  for (std::size_t k = 0; turbine_.pitch_actuator && k < turbine_.blades.size(); ++k) {
    actuators_.push_back(std::make_unique<components::PitchActuator>(turbine_, k, last_rank));
    components_.push_back(actuators_.back().get());
  }
  components_.push_back(bodies_.get());
  for (const auto& beam : beams_) components_.push_back(beam.get());
  for (std::size_t k = 0; turbine_.air && k < turbine_.blades.size(); ++k) {
    airs_.push_back(std::make_unique<components::BladeAir>(turbine_, k, *beams_[k]));
    components_.push_back(airs_.back().get());
  }
  if (turbine_.air && turbine_.air->rotor.models.has_rotor_wake()) {
    wake_ = std::make_unique<components::RotorWake>(turbine_, bodies.blades, last_rank);
    components_.push_back(wake_.get());
  }
  if (turbine_.has_tower && turbine_.air && turbine_.air->tower_has_drag) {
    tower_air_ = std::make_unique<components::TowerAir>(turbine_, *beams_.back());
    components_.push_back(tower_air_.get());
  }
  if (turbine_.has_tower && turbine_.air && turbine_.air->nacelle) {
    nacelle_air_ = std::make_unique<components::NacelleAir>(turbine_, *beams_.back());
    components_.push_back(nacelle_air_.get());
  }
  for (const model::MassDamper& damper : turbine_.mass_dampers) {
    const bool is_on_blade = damper.blade >= 0;
    components::MassDamperSetting setting;
    setting.turbine = &turbine_;
    setting.damper = &damper;
    setting.beam =
        is_on_blade ? beams_[static_cast<std::size_t>(damper.blade)].get() : beams_.back().get();
    setting.shared_rank = shared_rank;
    mass_dampers_.push_back(std::make_unique<components::MassDamper>(setting));
    components_.push_back(mass_dampers_.back().get());
  }
  for (const auto& extension : turbine_.extensions) {
    extensions_.push_back(extension->make(turbine_, layout_));
    components_.push_back(extensions_.back().get());
  }
}

components::Registry TurbineEquations::place() {
  components::Registry counted;
  for (components::Component* component : components_) component->place(counted);
  components::Registry registry = components::Registry::placing(counted);
  for (components::Component* component : components_) component->place(registry);
  return registry;
}

/// Connects a controller to the pitch, through the actuators if there are any.
void TurbineEquations::tie_controls() {
  components::ControllerTies ties;
  if (turbine_.has_tower) ties.tower_top = layout_.tower_tip();
  ties.yaw = layout_.yaw();
  ties.generator = layout_.generator();
  const bool has_pitch_loop = controller_ && turbine_.controller->pitch;
  for (std::size_t k = 0; k < turbine_.blades.size(); ++k) {
    const int pitch_port = bodies_->roots()[k].pitch_port();
    if (actuators_.empty()) {
      if (has_pitch_loop) ties.pitch_ports.push_back(pitch_port);
      continue;
    }
    actuators_[k]->set_pitch(pitch_port);
    if (has_pitch_loop) ties.pitch_ports.push_back(actuators_[k]->command_port());
  }
  if (!controller_) return;
  controller_->tie(ties);
  bodies_->set_integral(controller_->integral());
}

void TurbineEquations::describe(components::Registry& registry) {
  for (const auto& beam : beams_) layout_.beams_.push_back(beam->placed());
  layout_.has_tower_ = turbine_.has_tower;
  layout_.joints_ = bodies_->joints();
  for (const components::BladeRoot& root : bodies_->roots())
    layout_.hinges_.push_back(root.first());
  tie_controls();
  if (controller_) controller_->describe(registry);
  for (const auto& actuator : actuators_) actuator->describe(registry);
  for (const auto& beam : beams_) beam->describe(registry);
  bodies_->describe(registry);
  for (std::size_t k = 0; k < airs_.size(); ++k) {
    airs_[k]->tie(bodies_->pose_port(), bodies_->roots()[k].pose_port());
    airs_[k]->describe(registry);
  }
  if (wake_) {
    std::vector<int> root_ports;
    for (const components::BladeRoot& root : bodies_->roots())
      root_ports.push_back(root.pose_port());
    wake_->tie(bodies_->pose_port(), root_ports);
    wake_->describe(registry);
  }
  if (tower_air_) tower_air_->describe(registry);
  if (nacelle_air_) {
    nacelle_air_->set_yaw(layout_.yaw());
    nacelle_air_->describe(registry);
  }
  for (const auto& damper : mass_dampers_) {
    damper->set_yaw(layout_.yaw());
    damper->describe(registry);
  }
  for (const auto& extension : extensions_) extension->describe(registry);
  declarations_ = registry.finish();
  const int blades = static_cast<int>(turbine_.blades.size());
  const std::string fault = blades < 2 ? "" : find_symmetry_fault(turbine_);
  symmetry_ = registry.symmetry(fault.empty() ? std::max(blades, 1) : 1);
  symmetry_.broken_by = fault;
  layout_.size_ = static_cast<int>(declarations_.unknowns.size());
  layout_.padding_ = declarations_.padding;
  for (const int i : layout_.padding()) padding_.push_back({i, i, 1, 1.0});
}

bool TurbineEquations::is_conservative() const {
  return std::all_of(components_.begin(), components_.end(),
                     [](const components::Component* one) { return one->is_conservative(); });
}

bool TurbineEquations::constraints_are_autonomous() const {
  return std::all_of(components_.begin(), components_.end(), [](const components::Component* one) {
    return one->has_autonomous_constraints();
  });
}

template <class T>
void TurbineEquations::evaluate(double t, const std::vector<T>& z, const std::vector<T>& z_dot,
                                const TurbineInputs<T>& inputs, std::vector<T>& r,
                                const components::Portion* portion) const {
  std::fill(r.begin(), r.end(), T(0));
  Residual<T> residual(t, z, z_dot, inputs, declarations_.port_sizes, r, portion);
  residual.add(padding_);
  for (const components::Component* component : components_) component->add_to(residual);
}

void TurbineEquations::evaluate(double t, const std::vector<double>& z,
                                const std::vector<double>& z_dot,
                                components::Tangents& tangents) const {
  tangents.start(t, z, z_dot);
  for (const components::Component* component : components_) component->add_to(tangents);
}

/// Fills the ports of the poses of the hub and of the blades' roots.
template <class T>
void TurbineEquations::provide_poses(Residual<T>& residual) const {
  if (controller_) controller_->add_to(residual);
  for (const auto& actuator : actuators_) actuator->add_to(residual);
  bodies_->add_to(residual);
}

std::optional<elements::DiskFlow<double>> TurbineEquations::disk_flow(
    double t, const std::vector<double>& z, const std::vector<double>& z_dot) const {
  if (!wake_) return std::nullopt;
  std::vector<double> unused(z.size(), 0.0);  // only the ports count
  const TurbineInputs<double> inputs;
  Residual<double> residual(t, z, z_dot, inputs, declarations_.port_sizes, unused);
  provide_poses(residual);
  return wake_->flow(residual);
}

void TurbineEquations::settle_air(double t, std::vector<double>& z) const {
  if (airs_.empty()) return;
  const std::vector<double> rates(z.size(), 0.0);
  std::vector<double> unused(z.size(), 0.0);  // only the ports count
  const TurbineInputs<double> inputs;
  Residual<double> residual(t, z, rates, inputs, declarations_.port_sizes, unused);
  provide_poses(residual);
  std::vector<double> settled = z;
  for (const auto& air : airs_) air->settle(residual, settled);
  if (wake_) wake_->settle(residual, settled);
  z = settled;
}

void TurbineEquations::require_admissible(double t, const std::vector<double>& z) const {
  bodies_->require_admissible(z);
  if (airs_.empty() || !turbine_.air->rotor.wind.tower.disturbs()) return;
  const std::vector<double> rates(z.size(), 0.0);
  std::vector<double> unused(z.size(), 0.0);  // only the ports count
  const TurbineInputs<double> inputs;
  Residual<double> residual(t, z, rates, inputs, declarations_.port_sizes, unused);
  provide_poses(residual);
  for (const auto& air : airs_) air->require_admissible(residual);
}

template <class T>
components::BodiesReport<T> TurbineEquations::report(double t, const std::vector<T>& z,
                                                     const std::vector<T>& z_dot,
                                                     const TurbineInputs<T>& inputs) const {
  std::vector<T> unused(z.size());  // rows of hinges; only the ports count
  Residual<T> residual(t, z, z_dot, inputs, declarations_.port_sizes, unused);
  if (controller_) controller_->add_to(residual);
  for (const auto& actuator : actuators_) actuator->add_to(residual);
  return bodies_->report(residual);
}

template <class T>
std::vector<std::vector<components::AirPointReport<T>>> TurbineEquations::air_report(
    double t, const std::vector<T>& z, const std::vector<T>& z_dot,
    const TurbineInputs<T>& inputs) const {
  std::vector<std::vector<components::AirPointReport<T>>> reports;
  if (airs_.empty()) return reports;
  std::vector<T> unused(z.size());  // only the ports count
  Residual<T> residual(t, z, z_dot, inputs, declarations_.port_sizes, unused);
  provide_poses(residual);
  for (const auto& air : airs_) reports.push_back(air->report(residual));
  return reports;
}

using Complex = std::complex<double>;
template void TurbineEquations::evaluate(double, const std::vector<double>&,
                                         const std::vector<double>&, const TurbineInputs<double>&,
                                         std::vector<double>&, const components::Portion*) const;
template void TurbineEquations::evaluate(double, const std::vector<Complex>&,
                                         const std::vector<Complex>&, const TurbineInputs<Complex>&,
                                         std::vector<Complex>&, const components::Portion*) const;
template components::BodiesReport<double> TurbineEquations::report(
    double, const std::vector<double>&, const std::vector<double>&,
    const TurbineInputs<double>&) const;
template std::vector<std::vector<components::AirPointReport<double>>> TurbineEquations::air_report(
    double, const std::vector<double>&, const std::vector<double>&,
    const TurbineInputs<double>&) const;
template std::vector<std::vector<components::AirPointReport<Complex>>> TurbineEquations::air_report(
    double, const std::vector<Complex>&, const std::vector<Complex>&,
    const TurbineInputs<Complex>&) const;
template components::BodiesReport<Complex> TurbineEquations::report(
    double, const std::vector<Complex>&, const std::vector<Complex>&,
    const TurbineInputs<Complex>&) const;

}  // namespace samara::turbine
