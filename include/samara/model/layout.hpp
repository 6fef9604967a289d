// Where each unknown of a turbine lives. Blocks of 18: every Gauss point and every beam end is one;
// the joints and the root reactions share the last ones. Blades come first, tip to root, then the
// tower, foot to top, then the joints: an elimination in this order fills in nothing but the
// columns of the joints and of the tower top.
#pragma once

#include "samara/model/turbine.hpp"

namespace samara::model {

class Layout {
 public:
  static constexpr int block = elements::point_size;

  explicit Layout(const Turbine& turbine);

  int size() const { return size_; }
  int blocks() const { return size_ / block; }

  /// First unknown of Gauss point p (0 at the root) of blade k (0-based).
  int blade_point(int k, int p) const { return blade_tip(k) + block * (blade_points_ - p); }
  int blade_tip(int k) const { return block * (blade_points_ + 1) * k; }
  int tower_point(int p) const { return tower_first_ + block * p; }
  /// u_hat, theta_hat, V_hat = (U8 U6 U7), Omega_hat = (U5 U3 U4), F_hat, M_hat of the tower top.
  int tower_tip() const { return tower_first_ + block * tower_points_; }
  int yaw() const { return joints_; }             ///< q_y; U1 follows
  int teeter() const { return joints_ + 2; }      ///< q_h; U2 follows
  int shaft_torsion() const { return joints_ + 4; }  ///< angle; its rate follows
  int blade_root(int k) const { return joints_ + 6 + 6 * k; }      ///< F_hat_0, M_hat_0
  int tower_root() const { return joints_ + 6 + 6 * blade_count_; }
  int padding() const { return padding_; }        ///< first of the unknowns that stay zero

 private:
  int blade_count_ = 0;
  int blade_points_ = 0;
  int tower_points_ = 0;
  int tower_first_ = 0;
  int joints_ = 0;
  int padding_ = 0;
  int size_ = 0;
};

}  // namespace samara::model
