#include "samara/system/turbine_residual.hpp"

namespace samara::system {

Eigen::Matrix<double, 9, 9> PlacedBeam::root_from_hub() const {
  const Matrix3 C_aH = C_Ha.transpose();
  Eigen::Matrix<double, 9, 9> map = Eigen::Matrix<double, 9, 9>::Zero();
  map.block<3, 3>(0, 0) = C_aH;
  map.block<3, 3>(0, 3) = -C_aH * math::skew<double>(position);
  map.block<3, 3>(3, 3) = C_aH;
  map.block<3, 3>(6, 6) = C_aH;
  return map;
}

Matrix6 PlacedBeam::hub_from_root() const {
  Matrix6 map = Matrix6::Zero();
  map.topLeftCorner<3, 3>() = C_Ha;
  map.bottomLeftCorner<3, 3>() = math::skew<double>(position) * C_Ha;
  map.bottomRightCorner<3, 3>() = C_Ha;
  return map;
}

std::array<double, 2> PlacedBeam::node_weights(int a, int p) const {
  const auto j = static_cast<std::size_t>(p % beam->order);
  const auto node = static_cast<std::size_t>(a);
  const double w = beam->functions.weights[j];
  return {w * beam->functions.slope[node][j],
          w * beam->element_length(p / beam->order) * beam->functions.value[node][j]};
}

int PlacedBeam::mass_at(int e) const {
  for (std::size_t m = 0; m < beam->mass_nodes.size(); ++m)
    if (beam->mass_nodes[m].end == e) return masses[m];
  return -1;
}

int PlacedBeam::strain_rows(int p, int a) const {
  const int e = p / beam->order;
  if (a == beam->order) {
    if (e + 1 == beam->elements) return tip;
    const int mass = mass_at(e + 1);
    if (mass >= 0) return mass;
  }
  return points[static_cast<std::size_t>(e * beam->order + a)];
}

int PlacedBeam::force_rows(int p, int a) const {
  const int e = p / beam->order;
  if (a == 0) {
    const int mass = mass_at(e);
    if (mass >= 0) return mass + 12;
    if (e == 0) return root;
  }
  return points[static_cast<std::size_t>(e * beam->order + a - 1)] + 12;
}

TurbineResidual::TurbineResidual(const model::Turbine& turbine)
    : turbine_(turbine), layout_(turbine_) {
  place_beams();
}

int TurbineResidual::chain_unknown(int i) const {
  const int top = layout_.tower_tip();
  const bool is_joint =
      (i >= at_joints && i < at_top_velocity_dot) || (i >= at_joint_rates && i < at_top_load);
  if (!is_joint && (!turbine_.has_tower || i >= at_hub_load)) return -1;
  if (i < at_top_velocity) return top + 3 + i;
  if (i < at_joints) return top + 6 + i - at_top_velocity;
  if (i < at_top_velocity_dot) return layout_.joints() + i - at_joints;
  if (i < at_joint_rates) return top + 6 + i - at_top_velocity_dot;
  if (i < at_top_load) return layout_.joints() + i - at_joint_rates;
  return top + 12 + i - at_top_load;
}

void TurbineResidual::check_rotation(const Vector3& theta, const std::string& place) {
  if (!(theta.norm() < math::largest_rodrigues_length))
    throw DomainError(place + ": rotation beyond 170 degrees");
}

void TurbineResidual::find_changes(PlacedBeam& placed) {
  const model::Beam& beam = *placed.beam;
  for (int e = 0; e < beam.elements; ++e) {
    const Matrix3 before = beam.reference_before(e);
    if (before == beam.reference(e)) continue;
    ReferenceChange change;
    change.element = e;
    change.row = placed.points[static_cast<std::size_t>(e * beam.order)] + 3;
    change.mass = placed.mass_at(e);
    change.turn = math::parameters_of(before * beam.reference(e).transpose());
    placed.changes.push_back(change);
  }
  if (!placed.changes.empty())
    placed.end_reference = math::parameters_of(beam.reference(beam.elements - 1));
}

void TurbineResidual::place_beams() {
  for (std::size_t k = 0; k < turbine_.blades.size(); ++k) {
    const int number = static_cast<int>(k);
    PlacedBeam placed;
    placed.beam = &turbine_.blades[k];
    for (int p = 0; p < placed.beam->point_count(); ++p)
      placed.points.push_back(layout_.blade_point(number, p));
    for (std::size_t m = 0; m < placed.beam->mass_nodes.size(); ++m)
      placed.masses.push_back(layout_.blade_mass(number, static_cast<int>(m)));
    placed.tip = layout_.blade_tip(number);
    placed.root = layout_.blade_root(number);
    placed.blade = number;
    placed.position = turbine_.roots[k].position;
    placed.C_Ha = turbine_.roots[k].C_Ha;
    find_changes(placed);
    beams_.push_back(placed);
  }
  if (!turbine_.has_tower) return;
  PlacedBeam placed;
  placed.beam = &turbine_.tower;
  for (int p = 0; p < placed.beam->point_count(); ++p)
    placed.points.push_back(layout_.tower_point(p));
  for (std::size_t m = 0; m < placed.beam->mass_nodes.size(); ++m)
    placed.masses.push_back(layout_.tower_mass(static_cast<int>(m)));
  placed.tip = layout_.tower_tip();
  placed.root = layout_.tower_root();
  find_changes(placed);
  beams_.push_back(placed);
}

}  // namespace samara::system
