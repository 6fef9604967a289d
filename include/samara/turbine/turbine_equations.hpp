// The equations of a whole turbine: its components with their places, the residual and the
// tangents.
#pragma once

#include <complex>
#include <memory>
#include <optional>
#include <vector>

#include "samara/base/error.hpp"
#include "samara/components/beam.hpp"
#include "samara/components/blade_air.hpp"
#include "samara/components/controller.hpp"
#include "samara/components/inputs.hpp"
#include "samara/components/mass_damper.hpp"
#include "samara/components/nacelle_air.hpp"
#include "samara/components/pitch_actuator.hpp"
#include "samara/components/rigid_bodies.hpp"
#include "samara/components/rotor_wake.hpp"
#include "samara/components/tower_air.hpp"
#include "samara/model/turbine.hpp"
#include "samara/turbine/turbine_layout.hpp"

namespace samara::turbine {

template <class T>
using TurbineInputs = components::TurbineInputs<T>;

class TurbineEquations {
 public:
  /// `at_least`: the plan includes its blocks; null: no further blocks.
  explicit TurbineEquations(const model::Turbine& turbine,
                            const components::TangentPlan* at_least = nullptr);
  ~TurbineEquations();
  TurbineEquations(const TurbineEquations&) = delete;
  TurbineEquations& operator=(const TurbineEquations&) = delete;

  const model::Turbine& turbine() const { return turbine_; }
  const TurbineLayout& layout() const { return layout_; }
  const std::vector<components::PlacedBeam>& beams() const { return layout_.beams(); }
  const components::Declarations& declarations() const { return declarations_; }
  const system::RotorSymmetry& symmetry() const { return symmetry_; }
  bool is_conservative() const;
  bool constraints_are_autonomous() const;
  const std::vector<std::unique_ptr<components::MassDamper>>& mass_dampers() const {
    return mass_dampers_;
  }

  /// r(t, z, z_dot, u, u_dot); all vectors have layout().size(). T: double, or std::complex<double>
  /// to differentiate by a complex step. `portion`: the functions that count; null: all.
  /// @throws DomainError if a rotation is out of range.
  template <class T>
  void evaluate(double t, const std::vector<T>& z, const std::vector<T>& z_dot,
                const TurbineInputs<T>& inputs, std::vector<T>& r,
                const components::Portion* portion = nullptr) const;
  /// The same without inputs.
  template <class T>
  void evaluate(double t, const std::vector<T>& z, const std::vector<T>& z_dot,
                std::vector<T>& r) const {
    evaluate(t, z, z_dot, TurbineInputs<T>(), r);
  }

  /// Sets the unknowns of the air to those of steady air around the blades in their motion at t.
  void settle_air(double t, std::vector<double>& z) const;

  /// @throws DomainError if a blade is inside the tower
  void require_admissible(double t, const std::vector<double>& z) const;

  /// The flow through the disk of a rotor with a finite-state wake; none without it.
  std::optional<elements::DiskFlow<double>> disk_flow(double t, const std::vector<double>& z,
                                                      const std::vector<double>& z_dot) const;

  /// Places of the entries of K and M.
  std::shared_ptr<const components::TangentPlan> plan() const { return plan_; }
  /// The places of the terms of a portion.
  std::shared_ptr<const components::TangentPlan> find_plan(
      const components::Portion& portion) const;
  /// K and M, in a workspace made from plan().
  void evaluate(double t, const std::vector<double>& z, const std::vector<double>& z_dot,
                components::Tangents& tangents) const;

  /// Motions and loads of the rigid bodies beside their rows.
  template <class T>
  components::BodiesReport<T> report(double t, const std::vector<T>& z, const std::vector<T>& z_dot,
                                     const TurbineInputs<T>& inputs) const;

  /// The air at each point of each blade; empty without air.
  template <class T>
  std::vector<std::vector<components::AirPointReport<T>>> air_report(
      double t, const std::vector<T>& z, const std::vector<T>& z_dot,
      const TurbineInputs<T>& inputs) const;

 private:
  template <class T>
  void provide_poses(components::Residual<T>& residual) const;
  void make_components();
  components::Registry place();
  void tie_controls();
  void describe(components::Registry& registry);
  void state(components::Pattern& pattern) const;

  model::Turbine turbine_;
  std::vector<std::unique_ptr<components::Beam>> beams_;  ///< blades, then tower
  /// Extensions of the calling program, after all others.
  std::vector<std::unique_ptr<components::Component>> extensions_;
  std::unique_ptr<components::Controller> controller_;                 ///< null: none
  std::vector<std::unique_ptr<components::PitchActuator>> actuators_;  ///< one per blade, if any
  std::unique_ptr<components::RigidBodies> bodies_;
  std::vector<std::unique_ptr<components::BladeAir>> airs_;  ///< one per blade, or none
  std::unique_ptr<components::RotorWake> wake_;              ///< null: none
  std::unique_ptr<components::TowerAir> tower_air_;          ///< null: none
  std::unique_ptr<components::NacelleAir> nacelle_air_;      ///< null: none
  std::vector<std::unique_ptr<components::MassDamper>> mass_dampers_;
  std::vector<components::Component*> components_;  ///< in the order of their equations
  components::Declarations declarations_;
  system::RotorSymmetry symmetry_;
  TurbineLayout layout_;
  std::vector<components::LinearShare> padding_;
  std::shared_ptr<const components::TangentPlan> plan_;
};

}  // namespace samara::turbine
