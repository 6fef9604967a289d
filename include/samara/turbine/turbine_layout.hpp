// Places of the unknowns of a turbine.
#pragma once

#include <vector>

#include "samara/base/error.hpp"
#include "samara/components/beam.hpp"
#include "samara/elements/beam_point.hpp"

namespace samara::turbine {

/// Places of the unknowns of a turbine, in blocks of 18. Every Gauss point, beam end and mass node
/// is one block; the joints and the root reactions share the last blocks. Order: blades (tip to
/// root), tower (foot to top), joints and root reactions, hinges of blades. Elimination in this
/// order causes fill-in only in the columns of the joints, the hinges and the tower top.
class TurbineLayout {
 public:
  static constexpr int block = elements::point_size;

  int size() const { return size_; }
  int blocks() const { return size_ / block; }
  /// First unknown of Gauss point p (0 at the root) of blade k (0-based).
  int blade_point(int k, int p) const { return blade(k).points[static_cast<std::size_t>(p)]; }
  /// First unknown of mass node m (0 nearest to the root), in the order of a tip.
  int blade_mass(int k, int m) const { return blade(k).masses[static_cast<std::size_t>(m)]; }
  int blade_tip(int k) const { return blade(k).tip; }
  int blade_root(int k) const { return blade(k).root; }  ///< F_hat_0, M_hat_0
  int tower_point(int p) const { return tower().points[static_cast<std::size_t>(p)]; }
  int tower_mass(int m) const { return tower().masses[static_cast<std::size_t>(m)]; }
  /// u_hat, theta_hat, V_hat = (U8 U6 U7), Omega_hat = (U5 U3 U4), F_hat, M_hat of the tower top.
  int tower_tip() const { return tower().tip; }
  int tower_root() const { return tower().root; }
  /// Index of q of free hinge i of blade k, both from 0; U follows.
  int hinge(int k, int i) const { return hinges_[static_cast<std::size_t>(k)] + 2 * i; }
  int joints() const { return joints_; }
  int yaw() const { return joints_; }                ///< q_y; U1 follows
  int teeter() const { return joints_ + 2; }         ///< q_h; U2 follows
  int shaft_torsion() const { return joints_ + 4; }  ///< q_s; U_s follows
  int generator() const { return joints_ + 6; }      ///< q_g; U_g follows
  /// Unknowns that fill blocks and stay zero.
  const std::vector<int>& padding() const { return padding_; }

  /// The beams of the blades, then the beam of the tower.
  const std::vector<components::PlacedBeam>& beams() const { return beams_; }

 private:
  friend class TurbineEquations;
  const components::PlacedBeam& blade(int k) const { return beams_[static_cast<std::size_t>(k)]; }
  const components::PlacedBeam& tower() const {
    if (!has_tower_) throw InternalError("a turbine without a tower has no tower unknowns");
    return beams_.back();
  }

  std::vector<components::PlacedBeam> beams_;
  std::vector<int> hinges_;  ///< first unknown of the hinges of each blade
  bool has_tower_ = false;
  int joints_ = 0;
  int size_ = 0;
  std::vector<int> padding_;
};

}  // namespace samara::turbine
