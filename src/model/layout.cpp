#include "samara/model/layout.hpp"

namespace samara::model {

Layout::Chain::Chain(const Beam& beam) {
  if (beam.has_support) masses.push_back(size += block);
  for (int p = 0; p < beam.point_count(); ++p) {
    points.push_back(size += block);
    const auto next = masses.size();
    if (next < beam.mass_nodes.size() && p + 1 == beam.mass_nodes[next].end * beam.order)
      masses.push_back(size += block);
  }
  size += block;  // the tip
}

Layout::Layout(const Turbine& turbine)
    : blade_(turbine.blades.empty() ? Chain() : Chain(turbine.blades.front())),
      tower_(turbine.tower),
      blade_count_(static_cast<int>(turbine.blades.size())) {
  tower_first_ = blade_.size * blade_count_;
  joints_ = tower_first_ + (turbine.has_tower ? tower_.size : 0);
  const int end = tower_root() + (turbine.has_tower ? 6 : 0);
  size_ = (end + block - 1) / block * block;
  for (int i = generator() + 2; i < blade_root(0); ++i) padding_.push_back(i);
  for (int i = end; i < size_; ++i) padding_.push_back(i);
}

}  // namespace samara::model
