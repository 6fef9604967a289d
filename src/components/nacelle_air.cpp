#include "samara/components/nacelle_air.hpp"

#include "samara/base/index.hpp"
#include "samara/components/inputs.hpp"
#include "samara/components/prescribed_motion.hpp"
#include "samara/components/tower_axes.hpp"
#include "samara/math/rotation.hpp"

namespace samara::components {

void NacelleAir::describe(Registry&) {
  const int top = tower_.placed().tip;
  connections_.arguments = {unknowns(top, 12), unknowns(yaw_, 2)};
  // The balance of the tower's end is that of the bodies on it.
  connections_.shares = {{top + 12, 3, 0}, {top + 15, 3, 3}};
  if (turbine_.chain.yaw.free) connections_.shares.push_back({yaw_ + 1, 1, 6});
}

template <class T, class System>
auto NacelleAir::load_of(const System& system, const Eigen::Matrix<T, arguments, 1>& x,
                         const elements::JointMotion& yaw) const -> Eigen::Matrix<T, values, 1> {
  using std::sqrt;
  constexpr double least = 1e-6;  // square of a speed [m^2/s^2]
  const model::Air& air = *turbine_.air;
  const model::NacelleDragDefinition& drag = *air.nacelle;
  const bool is_free = turbine_.chain.yaw.free;
  const Mat3<T> C_top = math::direction_cosines<T>(x.template segment<3>(3));
  const Mat3<T> turn =
      math::turn_about<T>(Vector3::UnitZ(), is_free ? x(at_yaw) : T(yaw.angle)).transpose();
  // Components in the nacelle from those in the axes of the tower's foot.
  const auto in_nacelle = [&](const Vec3<T>& foot) {
    return Vec3<T>(turn * from_beam_order<T>(Vec3<T>(C_top * foot)));
  };
  const Vec3<T> arm(T(drag.center[0]), T(drag.center[1]), T(drag.center[2]));
  const Vec3<T> along = to_beam_order<T>(Vec3<T>(turn.transpose() * arm));
  const Vec3<T> place = tower_.placed().beam->tip.template cast<T>() + x.template head<3>() +
                        C_top.transpose() * along;
  const Vec3<T> wind = air.rotor.wind.undisturbed_at<T>(in_ground<T>(system, place), system.time(),
                                                        wind_inputs<T>(system));
  Vec3<T> omega = turn * from_beam_order<T>(Vec3<T>(x.template segment<3>(9)));
  omega(2) = is_free ? x(at_yaw + 1) : omega(2) + T(yaw.rate);
  const Vec3<T> relative = in_nacelle(at_foot<T>(system, wind)) -
                           turn * from_beam_order<T>(Vec3<T>(x.template segment<3>(6))) -
                           math::cross(omega, arm);
  Vec3<T> force;
  for (int i = 0; i < 3; ++i)
    force(i) =
        relative(i) * sqrt(T(relative(i) * relative(i) + T(least))) *
        T(0.5 * air.rotor.density * air.rotor.acting * drag.areas[at(i)] * drag.drags[at(i)]);
  Vec3<T> moment = math::cross(arm, force);
  Eigen::Matrix<T, values, 1> y;
  y(6) = moment(2);
  if (is_free) moment(2) = T(0.0);  // the joint does not transmit it
  y.template head<3>() = to_beam_order<T>(Vec3<T>(turn.transpose() * force));
  y.template segment<3>(3) = to_beam_order<T>(Vec3<T>(turn.transpose() * moment));
  if (air.rotor.load_is_held) y = elements::held<T>(y);
  return y;
}

template <class System>
void NacelleAir::state(System& system) const {
  const elements::JointMotion yaw = prescribed_yaw(system, turbine_);
  const Memory memory = yaw_varies(turbine_) || turbine_.air->rotor.wind.changing
                            ? Memory::none
                            : Memory::of_arguments;
  const auto load = [&]<class T>(const Eigen::Matrix<T, arguments, 1>& x) {
    return load_of<T>(system, x, yaw);
  };
  system.template add<arguments, values>(connections_, load, memory);
}

template class Stated<NacelleAir>;

}  // namespace samara::components
