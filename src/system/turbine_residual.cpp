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
          w * beam->element_length * beam->functions.value[node][j]};
}

TurbineResidual::TurbineResidual(const model::Turbine& turbine)
    : turbine_(turbine), layout_(turbine_) {
  place_beams();
}

void TurbineResidual::check_rotation(const Vector3& theta, const std::string& place) {
  if (!(theta.norm() < math::largest_rodrigues_length))
    throw DomainError(place + ": rotation beyond 170 degrees");
}

void TurbineResidual::place_beams() {
  for (std::size_t k = 0; k < turbine_.blades.size(); ++k) {
    const int number = static_cast<int>(k);
    PlacedBeam placed;
    placed.beam = &turbine_.blades[k];
    for (int p = 0; p < placed.beam->point_count(); ++p)
      placed.points.push_back(layout_.blade_point(number, p));
    placed.tip = layout_.blade_tip(number);
    placed.root = layout_.blade_root(number);
    placed.on_hub = true;
    placed.position = turbine_.roots[k].position;
    placed.C_Ha = turbine_.roots[k].C_Ha;
    beams_.push_back(placed);
  }
  if (!turbine_.has_tower) return;
  PlacedBeam placed;
  placed.beam = &turbine_.tower;
  for (int p = 0; p < placed.beam->point_count(); ++p)
    placed.points.push_back(layout_.tower_point(p));
  placed.tip = layout_.tower_tip();
  placed.root = layout_.tower_root();
  beams_.push_back(placed);
}

}  // namespace samara::system
