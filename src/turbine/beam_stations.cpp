#include "samara/turbine/beam_stations.hpp"

#include <Eigen/Core>

#include "samara/elements/beam_load.hpp"

#include "turning.hpp"

namespace samara::turbine {
namespace {

using Block = Eigen::Matrix<double, TurbineLayout::block, 1>;

Block block_at(const std::vector<double>& z, int first) {
  return Eigen::Map<const Block>(z.data() + first);
}

/// The prescribed loads at the end, axes a.
Vector6 end_load(const model::Beam& beam, double t, double rotor_speed, const Vector3& theta) {
  Vector6 sum = Vector6::Zero();
  for (const model::BeamLoad& load : beam.loads) {
    if (!load.at_tip) continue;
    const Vector6 value = load.variation.factor(t, rotor_speed) * load.load;
    const Matrix3 axes = beam.reference(beam.elements - 1) * load.tip_axes;
    sum += load.follower ? elements::follower_load<double>(theta, axes, value) : value;
  }
  return sum;
}

std::vector<BeamStation> stations_of(const components::PlacedBeam& placed, double t,
                                     double rotor_speed, const std::vector<double>& z,
                                     const std::vector<double>& z_dot) {
  const model::Beam& beam = *placed.beam;
  std::vector<BeamStation> stations;
  const auto add = [&](const Block& state, const Matrix3& reference, const Vector6& load) {
    stations.push_back({state.segment<3>(0),
                        turned_from<double>(reference, Vector3(state.segment<3>(3))),
                        load.head<3>(), load.tail<3>()});
  };
  add(beam.has_support ? block_at(z, placed.masses.front()) : Block(Block::Zero()),
      Matrix3::Identity(), Eigen::Map<const Vector6>(z.data() + placed.root));
  for (int p = 0; p < beam.point_count(); ++p) {
    const auto at = static_cast<std::size_t>(p);
    const elements::BeamPoint& point = beam.points[at];
    const Block state = block_at(z, placed.points[at]);
    const Vector6 rates = block_at(z_dot, placed.points[at]).tail<6>();
    const Vector6 of_section = state.tail<6>() + point.damping.cwiseProduct(rates);
    const Matrix3 axes = math::direction_cosines<double>(Vector3(state.segment<3>(3))).transpose() *
                         point.reference * point.C_ab;
    Vector6 load;
    load << axes * of_section.head<3>(), axes * of_section.tail<3>();
    add(state, point.reference, load);
  }
  // The unknown load of the end is in axes a, without the loads that are prescribed there.
  const Block end = block_at(z, placed.tip);
  add(end, beam.reference(beam.elements - 1),
      end.tail<6>() + end_load(beam, t, rotor_speed, end.segment<3>(3)));
  return stations;
}

}  // namespace

std::vector<double> station_fractions(const model::Beam& beam) {
  std::vector<double> fractions{0.0};
  fractions.insert(fractions.end(), beam.fractions.begin(), beam.fractions.end());
  fractions.push_back(1.0);
  return fractions;
}

std::vector<std::vector<BeamStation>> find_beam_stations(const TurbineSystem& system, double t,
                                                         const std::vector<double>& z,
                                                         const std::vector<double>& z_dot) {
  std::vector<std::vector<BeamStation>> all;
  for (const components::PlacedBeam& placed : system.equations().beams())
    all.push_back(stations_of(placed, t, system.turbine().speed, z, z_dot));
  return all;
}

}  // namespace samara::turbine
