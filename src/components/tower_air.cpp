#include "samara/components/tower_air.hpp"

#include "samara/base/index.hpp"
#include "samara/components/inputs.hpp"
#include "samara/math/rotation.hpp"

namespace samara::components {

void TowerAir::describe(Registry&) {
  const PlacedBeam& placed = tower_.placed();
  for (int p = 0; p < placed.beam->point_count(); ++p) {
    Connections connections;
    connections.arguments = {unknowns(placed.points[at(p)], arguments)};
    for (int node = 0; node <= placed.beam->order; ++node)
      connections.shares.push_back(
          {placed.force_rows(p, node), 3, 0, -placed.node_weights(node, p)[1]});
    points_.push_back(connections);
  }
}

/// The tower's axes a1 a2 a3 are n3 n1 n2.
template <class T, class System>
Vec3<T> TowerAir::load_at(const System& system, int p,
                          const Eigen::Matrix<T, arguments, 1>& x) const {
  using std::sqrt;
  constexpr double least = 1e-6;  // square of a speed [m^2/s^2]
  const model::Air& air = *turbine_.air;
  const elements::TowerFlow& flow = air.rotor.wind.tower;
  const elements::BeamPoint& point = tower_.placed().beam->points[at(p)];
  const Mat3<T> R = math::direction_cosines<T>(x.template segment<3>(3)).transpose() *
                    Matrix3(point.reference * point.C_ab).template cast<T>();
  const Vec3<T> place = point.x.template cast<T>() + x.template head<3>();
  const Vec3<T> wind = air.rotor.wind.undisturbed_at<T>(in_ground<T>(system, place), system.time(),
                                                        wind_inputs<T>(system));
  const Vec3<T> relative = R.transpose() * at_foot<T>(system, wind) - x.template segment<3>(6);
  const T speed = sqrt(T(relative(1) * relative(1) + relative(2) * relative(2) + T(least)));
  const T factor = elements::TowerFlow::over_height(flow.diameter, place(0)) *
                   elements::TowerFlow::over_height(flow.drag, place(0)) * speed *
                   T(0.5 * air.rotor.density * air.rotor.acting);
  const Vec3<T> load = R * Vec3<T>(T(0.0), T(factor * relative(1)), T(factor * relative(2)));
  return air.rotor.load_is_held ? elements::held<T>(load) : load;
}

template <class System>
void TowerAir::state(System& system) const {
  const Memory memory = turbine_.air->rotor.wind.changing ? Memory::none : Memory::of_arguments;
  for (int p = 0; p < tower_.placed().beam->point_count(); ++p) {
    const auto load_of = [&]<class T>(const Eigen::Matrix<T, arguments, 1>& x) {
      return load_at<T>(system, p, x);
    };
    system.template add<arguments, 3>(points_[at(p)], load_of, memory);
  }
}

template class Stated<TowerAir>;

}  // namespace samara::components
