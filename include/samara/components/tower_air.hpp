// Drag of the wind on the tower (docs/theory.md, section 11.1).
#pragma once

#include <vector>

#include "samara/components/beam.hpp"
#include "samara/components/component.hpp"
#include "samara/model/turbine.hpp"

namespace samara::components {

/// Load at each point of the tower's mesh: rho/2 C_d D |v| v per length, with the wind v against
/// the point, normal to the tower, without the tower's own influence.
class TowerAir final : public Stated<TowerAir> {
 public:
  /// `tower`: its beam. Both must outlive the component.
  TowerAir(const model::Turbine& turbine, const Beam& tower) : turbine_(turbine), tower_(tower) {}

  void place(Registry&) override {}  // the tower has the places
  void describe(Registry& registry) override;
  bool is_conservative() const override { return false; }

  template <class System>
  void state(System& system) const;

 private:
  static constexpr int arguments = 12;  ///< u, theta, V, Omega

  /// Force per length, components in a.
  template <class T, class System>
  Vec3<T> load_at(const System& system, int p, const Eigen::Matrix<T, arguments, 1>& x) const;

  const model::Turbine& turbine_;
  const Beam& tower_;
  std::vector<Connections> points_;
};

extern template class Stated<TowerAir>;

}  // namespace samara::components
