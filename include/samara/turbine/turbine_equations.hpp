// The equations of a whole turbine: its components in their places, and what is made of them.
#pragma once

#include <complex>
#include <memory>
#include <vector>

#include "samara/base/error.hpp"
#include "samara/components/beam.hpp"
#include "samara/components/controller.hpp"
#include "samara/components/inputs.hpp"
#include "samara/components/mass_damper.hpp"
#include "samara/components/pitch_actuator.hpp"
#include "samara/components/rigid_bodies.hpp"
#include "samara/model/turbine.hpp"

namespace samara::turbine {

template <class T>
using TurbineInputs = components::TurbineInputs<T>;

/// Where each unknown of a turbine is. Blocks of 18: every Gauss point, every beam end and every
/// mass node is one; the joints and the root reactions share the last ones. Blades come first, tip
/// to root, then the tower, foot to top, then the joints and the roots' reactions, then the hinges
/// of blades: an elimination in this order fills in nothing but the columns of the joints, the
/// hinges and the tower top.
class TurbineLayout {
 public:
  static constexpr int block = elements::point_size;

  int size() const { return size_; }
  int blocks() const { return size_ / block; }
  /// First unknown of Gauss point p (0 at the root) of blade k (0-based).
  int blade_point(int k, int p) const { return blade(k).points[static_cast<std::size_t>(p)]; }
  /// The same of mass node m (0 nearest to the root), in the order of a tip.
  int blade_mass(int k, int m) const { return blade(k).masses[static_cast<std::size_t>(m)]; }
  int blade_tip(int k) const { return blade(k).tip; }
  int blade_root(int k) const { return blade(k).root; }  ///< F_hat_0, M_hat_0
  int tower_point(int p) const { return tower().points[static_cast<std::size_t>(p)]; }
  int tower_mass(int m) const { return tower().masses[static_cast<std::size_t>(m)]; }
  /// u_hat, theta_hat, V_hat = (U8 U6 U7), Omega_hat = (U5 U3 U4), F_hat, M_hat of the tower top.
  int tower_tip() const { return tower().tip; }
  int tower_root() const { return tower().root; }
  /// q of free hinge i of blade k, both from 0; U follows.
  int hinge(int k, int i) const { return hinges_[static_cast<std::size_t>(k)] + 2 * i; }
  int joints() const { return joints_; }
  int yaw() const { return joints_; }                ///< q_y; U1 follows
  int teeter() const { return joints_ + 2; }         ///< q_h; U2 follows
  int shaft_torsion() const { return joints_ + 4; }  ///< q_s; U_s follows
  int generator() const { return joints_ + 6; }      ///< q_g; U_g follows
  /// Unknowns that stay zero: they fill blocks.
  const std::vector<int>& padding() const { return padding_; }

  /// The beams of the blades, then that of the tower.
  const std::vector<components::PlacedBeam>& beams() const { return beams_; }

 private:
  friend class TurbineEquations;
  const components::PlacedBeam& blade(int k) const { return beams_[static_cast<std::size_t>(k)]; }
  const components::PlacedBeam& tower() const {
    if (!has_tower_) throw InternalError("a turbine without a tower is asked for its place");
    return beams_.back();
  }

  std::vector<components::PlacedBeam> beams_;
  std::vector<int> hinges_;  ///< of each blade
  bool has_tower_ = false;
  int joints_ = 0;
  int size_ = 0;
  std::vector<int> padding_;
};

class TurbineEquations {
 public:
  /// `at_least`: blocks that the plan has, whatever else; null: its own.
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
  components::BodiesReport<T> report(double t, const std::vector<T>& z, const std::vector<T>& z_dot,
                                     const TurbineInputs<T>& inputs) const;

 private:
  void make_components();
  components::Registry place();
  void tie_controls();
  void describe(components::Registry& registry);

  model::Turbine turbine_;
  std::vector<std::unique_ptr<components::Beam>> beams_;  ///< of the blades, then of the tower
  std::unique_ptr<components::Controller> controller_;    ///< null: none
  std::vector<std::unique_ptr<components::PitchActuator>> actuators_;  ///< of each blade, if any
  std::unique_ptr<components::RigidBodies> bodies_;
  std::vector<std::unique_ptr<components::MassDamper>> mass_dampers_;
  std::vector<components::Component*> components_;  ///< in the order of their equations
  components::Declarations declarations_;
  system::RotorSymmetry symmetry_;
  TurbineLayout layout_;
  std::vector<components::LinearShare> padding_;
  std::shared_ptr<const components::TangentPlan> plan_;
};

}  // namespace samara::turbine
