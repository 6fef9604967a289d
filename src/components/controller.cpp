#include "samara/components/controller.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "samara/base/error.hpp"
#include "samara/components/tower_axes.hpp"
#include "samara/math/rotation.hpp"

namespace samara::components {

Controller::Controller(const model::Turbine& turbine, int rank) : turbine_(turbine), rank_(rank) {}

void Controller::place(Registry& registry) {
  first_ = registry.add_shared(rank_, has_integral() ? 2 : 1);
}

void Controller::describe(Registry& registry) {
  using system::Frame;
  using system::RowRole;
  using system::UnknownRole;
  const system::Owner owner(system::PartKind::law, "controller");
  const double usual = std::max(*law().set_point, 1.0);
  registry.describe(
      first_, {owner, "", "speed error", "rad/s", UnknownRole::state, Frame::fixed, false, usual},
      RowRole::evolution);
  registry.add(Channel{"CtrlSpdErr", "rpm", "generator",
                       "filtered generator speed less the set point of the controller", first_,
                       30.0 / std::numbers::pi});
  connections_.arguments = {ties_.tower_top < 0 ? zeros(3) : unknowns(ties_.tower_top + 9, 3),
                            unknowns(ties_.yaw, 2),
                            unknowns(ties_.generator + 1, 1),
                            unknowns(first_, 1),
                            has_integral() ? unknowns(first_ + 1, 1) : zeros(1),
                            rates(first_, 1),
                            has_integral() ? rates(first_ + 1, 1) : zeros(1)};
  connections_.shares = {{first_, has_integral() ? 2 : 1, 0}};
  if (law().torque) connections_.shares.push_back({ties_.generator + 1, 1, torque});
  for (const int port : ties_.pitch_ports) connections_.provisions.push_back({port, pitch});
  if (!has_integral()) return;
  registry.describe(first_ + 1,
                    {owner, "", "integral", "rad", UnknownRole::state, Frame::fixed, false, usual},
                    RowRole::evolution);
  registry.add(Channel{"CtrlIntegral", "rad", "generator",
                       "integral of the speed error of the controller", first_ + 1, 1.0});
}

/// Speed of the generator relative to the nacelle, positive in its sense of rotation.
template <class T>
T Controller::generator_speed(const Eigen::Matrix<T, arguments, 1>& x) const {
  const elements::RigidChain& chain = turbine_.chain;
  const Vec3<T> top = from_beam_order<T>(x.template head<3>());
  // Without the rate of the yaw joint.
  const Vec3<T> nacelle = math::turn_about<T>(Vector3::UnitZ(), x(at_yaw)).transpose() * top;
  const T carried = nacelle(1) * std::cos(chain.tilt) + x(at_yaw + 1) * std::sin(chain.tilt);
  return (x(at_generator) - carried) * chain.gear();
}

/// The gains are divided by 1 + (p + angle)/K, p the own pitch of the blades. This gives the
/// quadratic equation u = (1 + (p + angle)/K) angle for the angle.
template <class T>
void Controller::schedule(T& angle, T& rate) const {
  using std::sqrt;
  const double K = law().schedule;
  const double start = K + turbine_.pitch;
  const T square = angle * (4.0 * K) + T(start * start);
  if (math::plain_value(square) <= 0.0)
    throw DomainError("controller: the pitch is outside the range of its gain schedule");
  const T root = sqrt(square);
  angle = (root - T(start)) * 0.5;
  rate = rate * T(K) / root;
}

template <class System>
void Controller::state(System& system) const {
  const auto rows_of = [&]<class T>(const Eigen::Matrix<T, arguments, 1>& x) {
    const T& error = x(at_states);
    const T& integral = x(at_states + 1);
    const T error_dot = (generator_speed<T>(x) - T(*law().set_point) - error) * law().filter;
    Eigen::Matrix<T, values, 1> y = Eigen::Matrix<T, values, 1>::Zero();
    y(0) = x(at_states + 2) - error_dot;
    y(1) = x(at_states + 3) - error;
    if (law().torque && !turbine_.operation.generator_off)
      y(torque) = (error * law().torque->proportional + integral * law().torque->integral) *
                  -turbine_.chain.gear();
    if (!law().pitch) return y;
    y(pitch) = error * law().pitch->proportional + integral * law().pitch->integral;
    y(pitch + 1) = error_dot * law().pitch->proportional + error * law().pitch->integral;
    if (law().schedule > 0.0) schedule<T>(y(pitch), y(pitch + 1));
    return y;
  };
  system.template add<arguments, values>(connections_, rows_of);
}

template class Stated<Controller>;

}  // namespace samara::components
