// The equations of a whole turbine: its components in their places, and what is made of them.
#pragma once

#include <complex>
#include <memory>
#include <vector>

#include "samara/components/beam.hpp"
#include "samara/components/inputs.hpp"
#include "samara/components/rigid_bodies.hpp"
#include "samara/model/layout.hpp"
#include "samara/model/turbine.hpp"

namespace samara::system {

template <class T>
using TurbineInputs = components::TurbineInputs<T>;

class TurbineEquations {
 public:
  explicit TurbineEquations(const model::Turbine& turbine);
  ~TurbineEquations();
  TurbineEquations(const TurbineEquations&) = delete;
  TurbineEquations& operator=(const TurbineEquations&) = delete;

  const model::Turbine& turbine() const { return turbine_; }
  const model::Layout& layout() const { return layout_; }
  /// Those of the blades, then that of the tower.
  const std::vector<components::PlacedBeam>& beams() const { return placed_; }

  /// r(t, z, z_dot, u, u_dot), all of layout().size(). T: double, or std::complex<double> to
  /// differentiate by a complex step. @throws DomainError where a rotation is out of range.
  template <class T>
  void evaluate(double t, const std::vector<T>& z, const std::vector<T>& z_dot,
                const TurbineInputs<T>& inputs, std::vector<T>& r) const;
  /// The same without inputs.
  template <class T>
  void evaluate(double t, const std::vector<T>& z, const std::vector<T>& z_dot,
                std::vector<T>& r) const {
    evaluate(t, z, z_dot, TurbineInputs<T>(), r);
  }

  /// Places of the entries of K and M.
  std::shared_ptr<const components::TangentPlan> plan() const { return plan_; }
  /// K and M, in a workspace made of plan().
  void evaluate(double t, const std::vector<double>& z, const std::vector<double>& z_dot,
                components::Tangents& tangents) const;

  /// What is asked of the rigid bodies beside their rows.
  template <class T>
  elements::ChainReport<T> report(double t, const std::vector<T>& z, const std::vector<T>& z_dot,
                                  const TurbineInputs<T>& inputs) const;

 private:
  void place_beams();
  components::PlacedBeam place(const model::Beam& beam) const;
  components::PlacedBodies place_bodies() const;

  model::Turbine turbine_;
  model::Layout layout_;
  std::vector<int> port_sizes_;
  std::vector<components::PlacedBeam> placed_;
  std::vector<components::LinearShare> padding_;
  std::unique_ptr<components::RigidBodies> bodies_;
  std::vector<std::unique_ptr<components::Component>> components_;
  std::shared_ptr<const components::TangentPlan> plan_;
};

}  // namespace samara::system
