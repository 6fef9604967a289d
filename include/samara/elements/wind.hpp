// The wind as a function of the place, and of time (docs/theory.md, section 11.1).
#pragma once

#include <cmath>
#include <memory>

#include "samara/elements/air_models.hpp"
#include "samara/elements/tower_flow.hpp"
#include "samara/math/linearized.hpp"
#include "samara/math/smooth.hpp"
#include "samara/math/types.hpp"

namespace samara::elements {

/// Small changes of a mean wind, the inputs of linear models.
template <class T>
struct WindInputs {
  T speed = T(0);       ///< at the reference height, elsewhere in proportion to the profile [m/s]
  T direction = T(0);   ///< counter-clockwise seen from above [rad]
  T upflow = T(0);      ///< [rad]
  T shear_up = T(0);    ///< change of the speed with the height above `height` [1/s]
  T shear_left = T(0);  ///< and to the left of one who looks downwind [1/s]
  double height = 0.0;  ///< [m]
};

/// Steady wind. Places and velocities have components n1 n2 n3; the height counts along n3.
struct MeanWind {
  double speed = 0.0;   ///< at the reference height [m/s]
  double height = 0.0;  ///< reference height [m]
  WindProfile profile = WindProfile::uniform;
  double exponent = 0.0;    ///< of the power law
  double roughness = 0.0;   ///< roughness length of the logarithmic law [m]
  double shear_left = 0.0;  ///< change of the speed to the left of one who looks downwind [1/s]
  double shear_up = 0.0;    ///< and with the height [1/s]
  double direction = 0.0;   ///< 0: along n2; > 0: counter-clockwise seen from above [rad]
  double veer = 0.0;        ///< change of the direction with the height [rad/m]
  double upflow = 0.0;      ///< > 0: the wind rises [rad]
  double gust = 0.0;        ///< added to the speed at all places [m/s]

  /// Velocity at a place [m/s]. `change`: null for none.
  template <class T>
  Vec3<T> at(const Vec3<T>& place, const WindInputs<T>* change = nullptr) const;

 private:
  template <class T>
  T profile_factor(const T& z) const;
};

/// Speed at height z by that at the reference height. Below 1 m, the speed is that of about 1 m.
template <class T>
T MeanWind::profile_factor(const T& z) const {
  constexpr double lowest = 1.0;
  if (profile == WindProfile::uniform) return T(1.0);
  const T above = math::smooth_max(z, T(lowest));
  if (profile == WindProfile::power) return math::power(T(above / T(height)), exponent);
  return math::logarithm(T(above / T(roughness))) / T(std::log(height / roughness));
}

template <class T>
Vec3<T> MeanWind::at(const Vec3<T>& place, const WindInputs<T>* change) const {
  using std::cos;
  using std::sin;
  T factor = profile_factor<T>(place(2));
  factor *= change == nullptr ? T(speed) : T(change->speed + T(speed));
  T sine(std::sin(direction));
  T cosine(std::cos(direction));
  if (veer != 0.0 || change != nullptr) {
    T turned(direction);
    if (veer != 0.0) turned += (place(2) - T(height)) * T(veer);
    if (change != nullptr) turned += change->direction;
    sine = sin(turned);
    cosine = cos(turned);
  }
  if (shear_left != 0.0) factor -= (cosine * place(0) + sine * place(1)) * T(shear_left);
  if (shear_up != 0.0) factor += (place(2) - T(height)) * T(shear_up);
  if (gust != 0.0) factor += T(gust);
  T rising(std::sin(upflow));
  T level(std::cos(upflow));
  if (change != nullptr) {
    factor += (place(2) - T(change->height)) * change->shear_up -
              (cosine * place(0) + sine * place(1)) * change->shear_left;
    const T angle = change->upflow + T(upflow);
    rising = sin(angle);
    level = cos(angle);
  }
  level *= factor;
  return Vec3<T>(-(level * sine), level * cosine, factor * rising);
}

/// A wind that changes with time.
class ChangingWind {
 public:
  /// Velocity [m/s] and its derivatives by the place, dv_i/dx_j [1/s]; components n1 n2 n3.
  struct Sample {
    Vector3 velocity = Vector3::Zero();
    Matrix3 gradient = Matrix3::Zero();
  };

  ChangingWind() = default;
  ChangingWind(const ChangingWind&) = delete;
  ChangingWind& operator=(const ChangingWind&) = delete;
  virtual ~ChangingWind() = default;

  /// @throws DomainError where the wind is not known
  virtual Sample at(const Vector3& place, double t) const = 0;
};

/// The wind around a turbine.
struct Wind {
  MeanWind mean;
  std::shared_ptr<const ChangingWind> changing;  ///< instead of the mean wind; null: none
  TowerFlow tower;

  /// Velocity at a place and a time without the tower [m/s]. `change`: of the mean wind; null for
  /// none.
  template <class T>
  Vec3<T> undisturbed_at(const Vec3<T>& place, double t,
                         const WindInputs<T>* change = nullptr) const {
    if (!changing) return mean.at<T>(place, change);
    Vector3 plain;
    for (int i = 0; i < 3; ++i) plain(i) = math::plain_value(place(i));
    ChangingWind::Sample sample;
    if (plain.allFinite())
      sample = changing->at(plain, t);
    else  // dependences, or no place at all
      sample = {Vector3::Constant(std::nan("")), Matrix3::Constant(std::nan(""))};
    Vec3<T> velocity;
    for (int i = 0; i < 3; ++i) {
      velocity(i) = T(sample.velocity(i));
      for (int j = 0; j < 3; ++j)
        velocity(i) += (place(j) - T(plain(j))) * T(sample.gradient(i, j));
    }
    return velocity;
  }
  /// The same with the influence of the tower on the blades.
  template <class T>
  Vec3<T> at(const Vec3<T>& place, double t, const WindInputs<T>* change = nullptr) const {
    const Vec3<T> wind = undisturbed_at<T>(place, t, change);
    return tower.disturbs() ? tower.disturb(wind, place) : wind;
  }
};

}  // namespace samara::elements
