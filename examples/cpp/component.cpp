// A user-defined component: the torque of a generator that follows its speed error with a lag,
//   tau T' = c (omega - omega_0) - T,
// a first-order state that acts on the shaft. On a rigid rotor of inertia J the roots are those of
// J tau s^2 + J s + c = 0.
#include <cstdio>

#include <samara/analysis/constant_modes.hpp>
#include <samara/model/masses.hpp>
#include <samara/petsc/session.hpp>
#include <samara/simulation/steady_state.hpp>
#include <samara/turbine/extension.hpp>

using namespace samara;

namespace {

struct LagSettings {
  double slope = 0.0;  // c [N m s/rad]
  double lag = 0.0;    // tau [s]
};

/// The equations, stated once as a template on the scalar. Residual and tangents follow from them.
class LaggingTorque final : public components::Stated<LaggingTorque> {
 public:
  LaggingTorque(LagSettings settings, const turbine::TurbineLayout& layout)
      : settings_(settings), layout_(layout) {}

  void place(components::Registry& registry) override {
    torque_ = registry.add_shared(turbine::extension_rank, 1);
  }

  void describe(components::Registry& registry) override {
    const system::Owner owner(system::PartKind::law, "lagging torque");
    registry.describe(torque_,
                      {owner, "", "torque", "N m", system::UnknownRole::state, system::Frame::fixed,
                       false, settings_.slope},
                      system::RowRole::evolution);
    const int speed = layout_.generator() + 1;  // rate of its angle beside the mean speed
    connections_.arguments = {components::unknowns(torque_, 1), components::rates(torque_, 1),
                              components::unknowns(speed, 1)};
    connections_.shares = {{torque_, 1, 0}, {speed, 1, 1}};
  }

  bool is_conservative() const override { return false; }

  template <class System>
  void state(System& system) const {
    const auto rows_of = [this]<class T>(const Eigen::Matrix<T, 3, 1>& x) {
      Eigen::Matrix<T, 2, 1> y;
      y(0) = x(1) * settings_.lag + x(0) - (x(2) - T(speed_)) * settings_.slope;
      y(1) = -x(0);  // against the rotation, in the row of Kane's equation of the generator
      return y;
    };
    system.template add<3, 2>(connections_, rows_of);
  }

  /// The mean speed [rad/s].
  void set_speed(double speed) { speed_ = speed; }

 private:
  LagSettings settings_;
  const turbine::TurbineLayout& layout_;
  double speed_ = 0.0;
  int torque_ = 0;
  components::Connections connections_;
};

class LagExtension final : public turbine::Extension {
 public:
  explicit LagExtension(LagSettings settings) : settings_(settings) {}

  std::unique_ptr<components::Component> make(const model::Turbine& turbine,
                                              const turbine::TurbineLayout& layout) const override {
    auto component = std::make_unique<LaggingTorque>(settings_, layout);
    component->set_speed(turbine.speed);
    return component;
  }
  bool keeps_rotor_symmetry() const override { return true; }

 private:
  LagSettings settings_;
};

simulation::Scenario rigid_rotor() {
  simulation::Scenario scenario;
  model::TurbineDefinition& turbine = scenario.turbine;
  turbine.gravity = 0.0;
  turbine.shaft.speed = 6.0;
  turbine.shaft.generator.kind = model::JointKind::free;
  turbine.hub.mass = 20.0;
  turbine.hub.inertia = Vector3(2.0, 5.0, 2.0);
  turbine.hub.radius = 0.5;
  turbine.blades.count = 3;
  turbine.blades.beam.length = 4.0;
  model::SectionDefinition section;
  section.rigid = {true, true, true, true, true, true};
  section.mass.diagonal() << 1.0, 1.0, 1.0, 1e-3, 1e-3, 1e-3;
  turbine.blades.beam.sections = {section};
  return scenario;
}

}  // namespace

template class samara::components::Stated<LaggingTorque>;

int main() {
  const petsc::Session session({});
  simulation::Scenario scenario = rigid_rotor();
  const LagSettings settings{40.0, 2.0};
  scenario.turbine.extensions = {std::make_shared<LagExtension>(settings)};
  const model::Turbine turbine = model::build_turbine(scenario.turbine);
  const turbine::TurbineSystem system(turbine, PETSC_COMM_SELF);
  analysis::Observer silent;
  const analysis::Trim trim = simulation::find_trim(scenario, system, silent);
  const analysis::ModeSet set = analysis::find_constant_modes(system, trim.solution);
  const double inertia =
      model::compute_masses(scenario.turbine, turbine).meshed_rotor.inertia(1, 1);
  std::printf("J %.10g kg m^2, tau %g s, c %g N m s/rad\n", inertia, settings.lag, settings.slope);
  for (const analysis::Mode& mode : set.modes)
    std::printf("%-20s %+.10f %+.10fi 1/s\n", mode.label.c_str(), mode.exponent.real(),
                mode.exponent.imag());
  return 0;
}
