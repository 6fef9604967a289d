// Inputs of a turbine (docs/theory.md, section 10).
#pragma once

#include <vector>

#include "samara/components/tower_axes.hpp"
#include "samara/elements/wind.hpp"
#include "samara/math/rotation.hpp"
#include "samara/math/types.hpp"

namespace samara::components {

/// Inputs of a turbine beside its loads (docs/theory.md, section 10).
template <class T>
struct TurbineInputs {
  std::vector<T> pitch;  ///< pitch of each blade beside its own, toward feather [rad]; empty: none
  std::vector<T> pitch_rate;  ///< [rad/s], same size
  T generator_torque = T(0);  ///< torque on a free generator, against its rotation [N m]
  T yaw_torque = T(0);        ///< torque of the tower top on a free nacelle, about y3 [N m]
  Vec3<T> top_force = Vec3<T>::Zero();      ///< on the tower top along n1 n2 n3 [N]
  Vec3<T> base_velocity = Vec3<T>::Zero();  ///< velocity of the tower's foot along n1 n2 n3 [m/s]
  Vec3<T> base_turn = Vec3<T>::Zero();  ///< small rotation of the tower's foot about n1 n2 n3 [rad]
  Vec3<T> base_rate = Vec3<T>::Zero();  ///< rates of these angles [rad/s]
  elements::WindInputs<T> wind;         ///< changes of the mean wind

  /// Components in the axes of the tower's foot, in their order (n3, n1, n2), of a vector;
  /// `ground`: its components in these axes when the foot is not turned.
  Vec3<T> at_foot(const Vec3<T>& ground) const {
    return math::turn_about<T>(Vector3::UnitX(), base_turn(2)).transpose() *
           (math::turn_about<T>(Vector3::UnitZ(), base_turn(1)).transpose() *
            (math::turn_about<T>(Vector3::UnitY(), base_turn(0)).transpose() * ground));
  }
  /// The reverse of at_foot.
  Vec3<T> in_ground(const Vec3<T>& foot) const {
    return math::turn_about<T>(Vector3::UnitY(), base_turn(0)) *
           (math::turn_about<T>(Vector3::UnitZ(), base_turn(1)) *
            (math::turn_about<T>(Vector3::UnitX(), base_turn(2)) * foot));
  }
  Vec3<T> up() const { return at_foot(Vec3<T>::UnitX()); }
};

/// Components n1 n2 n3 of a vector in the axes of the tower's foot (n3, n1, n2), which turns with
/// the inputs of a system that has them.
template <class T, class System>
Vec3<T> in_ground(const System& system, const Vec3<T>& foot) {
  if constexpr (System::has_inputs)
    return from_beam_order<T>(system.inputs().in_ground(foot));
  else
    return from_beam_order<T>(foot);
}
/// The reverse of in_ground.
template <class T, class System>
Vec3<T> at_foot(const System& system, const Vec3<T>& ground) {
  if constexpr (System::has_inputs)
    return system.inputs().at_foot(to_beam_order<T>(ground));
  else
    return to_beam_order<T>(ground);
}

/// Changes of the mean wind of a system with inputs; null for others.
template <class T, class System>
const elements::WindInputs<T>* wind_inputs(const System& system) {
  if constexpr (System::has_inputs)
    return &system.inputs().wind;
  else
    return nullptr;
}

}  // namespace samara::components
