#include "samara/model/layout.hpp"

namespace samara::model {

Layout::Layout(const Turbine& turbine)
    : blade_count_(static_cast<int>(turbine.blades.size())),
      blade_points_(turbine.blades.front().point_count()),
      tower_points_(turbine.has_tower ? turbine.tower.point_count() : 0) {
  tower_first_ = block * (blade_points_ + 1) * blade_count_;
  joints_ = tower_first_ + (turbine.has_tower ? block * (tower_points_ + 1) : 0);
  padding_ = joints_ + 6 + 6 * blade_count_ + (turbine.has_tower ? 6 : 0);
  size_ = (padding_ + block - 1) / block * block;
}

}  // namespace samara::model
