// Where each unknown of a turbine lives. Blocks of 18: every Gauss point, every beam end and every
// mass node is one; the joints and the root reactions share the last ones. Blades come first, tip
// to root, then the tower, foot to top, then the joints: an elimination in this order fills in
// nothing but the columns of the joints and of the tower top.
#pragma once

#include "samara/model/turbine.hpp"

namespace samara::model {

class Layout {
 public:
  static constexpr int block = elements::point_size;

  explicit Layout(const Turbine& turbine);

  int size() const { return size_; }
  int blocks() const { return size_ / block; }

  /// Unknowns of a blade: points, mass nodes, tip.
  int blade_size() const { return blade_.size; }
  /// First unknown of Gauss point p (0 at the root) of blade k (0-based).
  int blade_point(int k, int p) const {
    return blade_size() * (k + 1) - from_root(blade_.points, p);
  }
  /// The same of mass node m (0 nearest to the root), in the order of a tip.
  int blade_mass(int k, int m) const {
    return blade_size() * (k + 1) - from_root(blade_.masses, m);
  }
  int blade_tip(int k) const { return blade_size() * k; }
  int tower_point(int p) const { return tower_first_ + from_root(tower_.points, p) - block; }
  int tower_mass(int m) const { return tower_first_ + from_root(tower_.masses, m) - block; }
  /// u_hat, theta_hat, V_hat = (U8 U6 U7), Omega_hat = (U5 U3 U4), F_hat, M_hat of the tower top.
  int tower_tip() const { return tower_first_ + tower_.size - block; }
  int joints() const { return joints_; }
  int yaw() const { return joints_; }                           ///< q_y; U1 follows
  int teeter() const { return joints_ + 2; }                    ///< q_h; U2 follows
  int shaft_torsion() const { return joints_ + 4; }             ///< q_s; U_s follows
  int generator() const { return joints_ + 6; }                 ///< q_g; U_g follows
  int blade_root(int k) const { return joints_ + 12 + 6 * k; }  ///< F_hat_0, M_hat_0
  int tower_root() const { return joints_ + 12 + 6 * blade_count_; }
  /// Unknowns that stay zero: those that keep the sixes of the reactions in one block each, and
  /// what fills the last block.
  const std::vector<int>& padding() const { return padding_; }

 private:
  /// The blocks of a beam, root to tip: unknowns up to and with that of each point and mass node.
  struct Chain {
    Chain() = default;
    explicit Chain(const Beam& beam);
    std::vector<int> points;
    std::vector<int> masses;
    int size = 0;
  };
  static int from_root(const std::vector<int>& places, int i) {
    return places[static_cast<std::size_t>(i)];
  }

  Chain blade_;
  Chain tower_;
  int blade_count_ = 0;
  int tower_first_ = 0;
  int joints_ = 0;
  std::vector<int> padding_;
  int size_ = 0;
};

}  // namespace samara::model
