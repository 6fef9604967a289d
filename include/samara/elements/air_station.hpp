// The air at one station of a blade (docs/theory.md, section 11): relative wind, airfoil dynamics,
// balance of momentum and dynamic inflow.
//
// Unknowns of a station, in order: W_n, W_t, induced velocity along the rotor's axis n and along
// e_t, the direction in which a rotor with positive speed moves; R_n, R_t, intermediate velocities
// of the dynamic inflow; Q_n, Q_t, quasi-steady induced velocity; x1, x2, shed wake; x3, lagged
// lift coefficient; x4, separation point; f(3), m(3), force and moment per length about the
// reference line, components in a. With finite states of the shed wake, x1 to x4, R_n and R_t are
// these six; the dynamic inflow then has no intermediate velocity. With a finite-state wake of the
// rotor (rotor_wake.hpp) W_n is that of the wake, and there are no R_n, R_t and Q_n.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "samara/elements/air_models.hpp"
#include "samara/elements/airfoil.hpp"
#include "samara/elements/wind.hpp"
#include "samara/math/linearized.hpp"
#include "samara/math/rotation.hpp"
#include "samara/math/smooth.hpp"
#include "samara/math/types.hpp"

namespace samara::elements {

/// Offsets of the unknowns of a station, and of their rows.
namespace air {
inline constexpr int induced = 0;       ///< W_n, W_t [m/s]
inline constexpr int reduced = 2;       ///< R_n, R_t [m/s]
inline constexpr int quasi_steady = 4;  ///< Q_n, Q_t [m/s]
inline constexpr int wake = 6;          ///< x1, x2 [m/s]
inline constexpr int lift = 8;          ///< x3
inline constexpr int separation = 9;    ///< x4
inline constexpr int force = 10;        ///< f [N/m]
inline constexpr int moment = 13;       ///< m [N m/m]
inline constexpr int unknowns = 16;
}  // namespace air

/// The finite-state airloads of Peters, Karunamoorthy and Cao (1995) with six states.
struct FiniteStates {
  static constexpr int count = 6;
  using Vector = Eigen::Matrix<double, count, 1>;
  Eigen::Matrix<double, count, count> inverse;  ///< A^-1
  Vector feed;                                  ///< A^-1 c
  Vector weights;                               ///< b/2: lambda_0 = weights . lambda
};
const FiniteStates& finite_states();

/// Share of the quasi-steady velocity that reaches W without the first lag (Oye 1990).
inline constexpr double direct_share = 0.6;

/// Constants of a rotor in the air.
struct AirRotor {
  AirModels models;
  Wind wind;
  double density = 1.225;  ///< [kg/m^3]
  int blades = 1;
  double tip_radius = 0.0;    ///< undeformed, normal to the shaft [m]
  double hub_radius = 0.0;    ///< [m]
  double tau1 = 0.0;          ///< first time constant of the dynamic inflow [s]
  double least_speed = 0.01;  ///< eps of the balance of momentum [m/s]
  double acting = 1.0;        ///< factor of the load on the blades
  /// With `inflow: frozen`: the present induced velocity is that of the steady state. It satisfies
  /// its rows, and no other unknown changes it.
  bool wake_is_held = false;
  /// No motion changes the loads of the air: the present loads satisfy their rows.
  bool load_is_held = false;
};

/// Constants of a station.
struct AirStation {
  std::shared_ptr<const AirfoilCurves> airfoil;
  Vector3 x = Vector3::Zero();           ///< undeformed place on the reference line, in a [m]
  Matrix3 turned = Matrix3::Identity();  ///< undeformed section basis, turned by its reference
  double chord = 0.0;                    ///< [m]
  double twist = 0.0;                ///< of the chord from b2 of the section, toward feather [rad]
  Vector3 center = Vector3::Zero();  ///< aerodynamic centre from the reference line, in B [m]
  double arc_to_tip = 0.0;           ///< along the blade [m]
  double arc_to_hub = 0.0;
  double radius = 0.0;  ///< undeformed distance from the shaft axis [m]

  /// Dynamics of the wake and of separation, beside the steady polar.
  bool has_dynamics(const AirModels& models) const {
    return airfoil->has_dynamics &&
           (models.dynamics == AirfoilDynamics::hgm || models.dynamics == AirfoilDynamics::oye ||
            models.dynamics == AirfoilDynamics::peters);
  }
};

/// Pose of a blade's root, components n1 n2 n3.
template <class T>
struct RootPose {
  Vec3<T> place = Vec3<T>::Zero();
  Mat3<T> axes = Mat3<T>::Identity();  ///< a1 a2 a3 as columns
};

/// Pose and motion of the rotor's apex, components n1 n2 n3.
template <class T>
struct HubPose {
  Vec3<T> place = Vec3<T>::Zero();
  Vec3<T> velocity = Vec3<T>::Zero();
  Vec3<T> axis = Vec3<T>::UnitY();  ///< n = h2
  T speed = T(0);                   ///< angular velocity about n [rad/s]
};

/// The present values of a load, which no motion changes.
template <class T, class Load>
Load held(const Load& load) {
  Load values = load;
  for (Eigen::Index i = 0; i < values.size(); ++i) values(i) = T(math::plain_value(load(i)));
  return values;
}

/// Motion of a station and the wind there.
template <class T>
struct StationMotion {
  Mat3<T> R;             ///< components in a from those in B
  Vec3<T> relative;      ///< wind against the aerodynamic centre without induction, in B [m/s]
  Vec3<T> axial;         ///< n in B
  Vec3<T> tangential;    ///< e_t in B
  Vec6<T> velocity;      ///< V, Omega
  T radius;              ///< distance from n [m]
  T spread;              ///< dr per length of the blade
  T hub_speed;           ///< [rad/s]
  T wind_axial;          ///< U_n, of the wind against the apex [m/s]
  T wind_across_square;  ///< |u_p|^2 [m^2/s^2]
  T wind_outward;        ///< e_r . u_p [m/s]
};

/// Relative wind of a section: components toward the leading edge and the suction side.
template <class T>
struct SectionFlow {
  T c, n;
  T speed;            ///< regular at rest
  T omega;            ///< [rad/s]
  T half_chord_time;  ///< T_u = c/(2 U) [s]
};

template <class T>
struct AirCoefficients {
  T lift, drag, moment;
};

namespace air {

/// Angle of attack of a normal velocity. At U below 0.1 m/s it tends to zero.
template <class T>
T angle_of(const SectionFlow<T>& flow, const T& normal) {
  constexpr double slow = 0.1;
  const T s = math::smoothstep(T(flow.speed / T(slow)));
  return math::arctangent(T(s * normal), T((T(1.0) - s) * T(slow) - s * flow.c));
}

template <class T>
T three_quarter_velocity(const AirStation& station, const SectionFlow<T>& flow) {
  return flow.n + flow.omega * T(0.5 * station.chord);
}

/// g: 1 where the airfoil dynamics act, 0 beyond the angle `cut_out` and at rest.
template <class T>
T dynamics_share(const AirModels& models, const SectionFlow<T>& flow, const T& angle) {
  constexpr double band = std::numbers::pi / 36.0;  // 5 degrees
  const T size = math::smooth_abs(angle);
  const T beyond = math::smoothstep(T((size - T(models.cut_out - band)) / T(band)));
  return (T(1.0) - beyond) * math::smoothstep(T((flow.speed - T(0.01)) / T(0.99)));
}

}  // namespace air

/// Motion of a station with u, theta; V, Omega, and the wind there at the time t. `change`: of the
/// mean wind; null for none.
template <class T>
StationMotion<T> station_motion(const AirRotor& rotor, const AirStation& station,
                                const Eigen::Matrix<T, 12, 1>& z, const RootPose<T>& root,
                                const HubPose<T>& hub, double t = 0.0,
                                const WindInputs<T>* change = nullptr) {
  using math::cross;
  using math::dot;
  using std::sqrt;
  StationMotion<T> motion;
  const Vec3<T> theta = z.template segment<3>(3);
  const Vec3<T> omega = z.template segment<3>(9);
  motion.R = math::direction_cosines(theta).transpose() * station.turned.cast<T>();
  const Vec3<T> local = station.x.cast<T>() + z.template head<3>();
  const Vec3<T> place = root.place + root.axes * local;
  const Mat3<T> axes = root.axes * motion.R;  // of the section, as columns in N
  const Vec3<T> wind = rotor.wind.at<T>(place, t, change);
  motion.velocity = z.template segment<6>(6);
  motion.relative = axes.transpose() * wind - z.template segment<3>(6) -
                    cross(omega, Vec3<T>(station.center.cast<T>()));
  motion.hub_speed = hub.speed;
  if (rotor.models.induction == Induction::none) {
    motion.axial = motion.tangential = Vec3<T>::Zero();
    motion.radius = motion.spread = motion.wind_axial = motion.wind_across_square =
        motion.wind_outward = T(0.0);
    return motion;
  }
  const Vec3<T> arm = place - hub.place;
  const Vec3<T> outward = arm - hub.axis * dot(arm, hub.axis);
  motion.radius = sqrt(dot(outward, outward));
  const Vec3<T> e_r = outward / motion.radius;
  const Vec3<T> e_t = cross(hub.axis, e_r);
  motion.axial = axes.transpose() * hub.axis;
  motion.tangential = axes.transpose() * e_t;
  motion.spread = math::smooth_abs(dot(Vec3<T>(axes.col(0)), e_r));
  const Vec3<T> on_disk = wind - hub.velocity;
  motion.wind_axial = dot(on_disk, hub.axis);
  const Vec3<T> across = on_disk - hub.axis * motion.wind_axial;
  motion.wind_across_square = dot(across, across);
  motion.wind_outward = dot(e_r, across);
  return motion;
}

/// Relative wind with the induced velocity (v_n, v_t).
template <class T>
SectionFlow<T> section_flow(const AirStation& station, const StationMotion<T>& motion, const T& v_n,
                            const T& v_t) {
  using std::sqrt;
  constexpr double least = 1e-3;    // [m/s]
  constexpr double slowest = 0.02;  // [1/s]
  const double cosine = std::cos(station.twist);
  const double sine = std::sin(station.twist);
  const Vec3<T> w = motion.relative + motion.axial * v_n + motion.tangential * v_t;
  SectionFlow<T> flow;
  flow.c = w(1) * T(cosine) - w(2) * T(sine);
  flow.n = w(1) * T(sine) + w(2) * T(cosine);
  flow.speed = sqrt(T(flow.c * flow.c + flow.n * flow.n + T(least * least)));
  flow.omega = motion.velocity(3);
  flow.half_chord_time =
      T(1.0) / math::smooth_max(T(flow.speed * T(2.0 / station.chord)), T(slowest));
  return flow;
}

/// Factor of W_n from the skewed wake (Pitt & Peters 1981): 1 + sigma.
template <class T>
T skew_factor(const AirRotor& rotor, const StationMotion<T>& motion, const T& induced) {
  using std::sqrt;
  if (rotor.models.skew == 0.0 || rotor.models.has_rotor_wake()) return T(1.0);
  const double square = rotor.least_speed * rotor.least_speed;
  const T axial_square = motion.wind_axial * motion.wind_axial + T(square);
  const T whole = sqrt(T(axial_square + motion.wind_across_square));
  const T strength = T(1.0) - induced * motion.wind_axial / axial_square * T(0.6);
  return strength * motion.wind_outward / T(whole + sqrt(axial_square)) * motion.radius *
             T(rotor.models.skew / rotor.tip_radius) +
         T(1.0);
}

/// Coefficients of attached flow whose shed wake induces the velocity `induced` at the section:
/// Cl_alpha ((w_34 - induced)/U - alpha_0) + pi T_u omega. Where g < 1 the rest is the polar.
template <class T>
AirCoefficients<T> attached_coefficients(const AirStation& station, const SectionFlow<T>& flow,
                                         const T& g, const T& angle, const T& induced) {
  const AirfoilCurves& airfoil = *station.airfoil;
  const T w_34 = air::three_quarter_velocity(station, flow);
  const T turning = flow.half_chord_time * flow.omega;
  const T attached = ((w_34 - induced) / flow.speed - T(airfoil.zero_lift)) * T(airfoil.lift_slope);
  AirCoefficients<T> c;
  c.lift = g * (attached + turning * T(std::numbers::pi)) + (T(1.0) - g) * airfoil.lift_at(angle);
  c.drag = airfoil.drag_at(air::angle_of(flow, T(g * w_34 + (T(1.0) - g) * flow.n)));
  c.moment = airfoil.moment_at(angle) - g * turning * T(0.5 * std::numbers::pi);
  return c;
}

/// The same with finite states and their rows: T_u mu_dot + A^-1 (mu + A^-1 c w_34) = 0. With
/// lambda = mu + A^-1 c w_34 this is A lambda_dot + lambda/T_u = c dw_34/dt, without the rate of a
/// velocity.
template <class T>
AirCoefficients<T> finite_state_coefficients(const AirModels& models, const AirStation& station,
                                             const SectionFlow<T>& flow,
                                             const Eigen::Matrix<T, FiniteStates::count, 1>& mu,
                                             const Eigen::Matrix<T, FiniteStates::count, 1>& mu_dot,
                                             Eigen::Matrix<T, FiniteStates::count, 1>& rows) {
  const FiniteStates& wake = finite_states();
  const T angle = air::angle_of(flow, flow.n);
  const T g = air::dynamics_share(models, flow, angle);
  const T w_34 = air::three_quarter_velocity(station, flow);
  Eigen::Matrix<T, FiniteStates::count, 1> lambda;
  T induced(0.0);
  for (int n = 0; n < FiniteStates::count; ++n) {
    lambda(n) = mu(n) + w_34 * T(wake.feed(n));
    induced += lambda(n) * T(wake.weights(n));
  }
  for (int n = 0; n < FiniteStates::count; ++n) {
    rows(n) = mu_dot(n) * flow.half_chord_time;
    for (int k = 0; k < FiniteStates::count; ++k) rows(n) += lambda(k) * T(wake.inverse(n, k));
  }
  return attached_coefficients(station, flow, g, angle, induced);
}

/// Coefficients of a steady flow, from which the balance of momentum with `closure: equilibrium`
/// takes its load: of the polar at the aerodynamic centre (static_polar), else at three quarters of
/// the chord.
template <class T>
AirCoefficients<T> steady_coefficients(const AirModels& models, const AirStation& station,
                                       const SectionFlow<T>& flow) {
  const AirfoilCurves& airfoil = *station.airfoil;
  const T angle = air::angle_of(flow, flow.n);
  if (models.dynamics == AirfoilDynamics::static_polar || !airfoil.has_dynamics)
    return {airfoil.lift_at(angle), airfoil.drag_at(angle), airfoil.moment_at(angle)};
  const T g = air::dynamics_share(models, flow, angle);
  if (models.dynamics == AirfoilDynamics::peters)
    return attached_coefficients(station, flow, g, angle, T(0.0));
  const T normal = g * air::three_quarter_velocity(station, flow) + (T(1.0) - g) * flow.n;
  const T at_three_quarters = air::angle_of(flow, normal);
  AirCoefficients<T> c{airfoil.lift_at(at_three_quarters), airfoil.drag_at(at_three_quarters),
                       airfoil.moment_at(at_three_quarters)};
  if (models.dynamics == AirfoilDynamics::oye) return c;
  const T turning = flow.half_chord_time * flow.omega * g;
  c.drag += (math::wrapped(T(angle - at_three_quarters)) * g + turning) * c.lift;
  c.lift += turning * T(std::numbers::pi);
  c.moment -= turning * T(0.5 * std::numbers::pi);
  return c;
}

/// Coefficients with the states x1 to x4 and, for stations with dynamics, their rows. `x`,
/// `x_dot`: states and their rates.
template <class T>
AirCoefficients<T> dynamic_coefficients(const AirModels& models, const AirStation& station,
                                        const SectionFlow<T>& flow, const Eigen::Matrix<T, 4, 1>& x,
                                        const Eigen::Matrix<T, 4, 1>& x_dot,
                                        Eigen::Matrix<T, 4, 1>& rows) {
  using std::sqrt;
  rows = x;
  if (!station.has_dynamics(models)) return steady_coefficients(models, station, flow);
  const AirfoilCurves& airfoil = *station.airfoil;
  const T angle = air::angle_of(flow, flow.n);
  const T g = air::dynamics_share(models, flow, angle);
  const T w_34 = air::three_quarter_velocity(station, flow);
  const T T_f = flow.half_chord_time * T(models.separation_lag);
  if (models.dynamics == AirfoilDynamics::oye) {
    const T steady = air::angle_of(flow, T(g * w_34 + (T(1.0) - g) * flow.n));
    const T attached = airfoil.separation_at(steady);
    rows(3) = T_f * x_dot(3) + x(3) - attached;
    return {airfoil.lift_at(steady) + g * (x(3) - attached) * airfoil.deficit_at(steady),
            airfoil.drag_at(steady), airfoil.moment_at(steady)};
  }
  const auto& [A1, A2, b1, b2] = models.wake;
  rows(0) = flow.half_chord_time * x_dot(0) + x(0) * T(b1) - w_34 * T(b1 * A1);
  rows(1) = flow.half_chord_time * x_dot(1) + x(1) * T(b2) - w_34 * T(b2 * A2);
  const T downwash = g * (w_34 * T(1.0 - A1 - A2) + x(0) + x(1)) + (T(1.0) - g) * flow.n;
  const T effective = air::angle_of(flow, downwash);
  const T turning = flow.half_chord_time * flow.omega;
  const T T_p = flow.half_chord_time * T(models.pressure_lag);
  rows(2) =
      T_p * x_dot(2) + x(2) - inviscid_lift(airfoil, effective) - turning * T(std::numbers::pi);
  const T lagged = x(2) / T(airfoil.lift_slope) + T(airfoil.zero_lift);
  rows(3) = T_f * x_dot(3) + x(3) - airfoil.separation_at(lagged);
  const T attached = airfoil.separation_at(effective);
  const T circulatory =
      airfoil.lift_at(effective) + g * (x(3) - attached) * airfoil.deficit_at(effective);
  const auto root = [](const T& y) { return T(sqrt(math::smooth_max(y, T(1e-4)))); };
  const T separated = (root(attached) - root(x(3))) * T(0.5) - (attached - x(3)) * T(0.25);
  const T drag = airfoil.drag_at(effective);
  AirCoefficients<T> c;
  c.lift = circulatory + g * turning * T(std::numbers::pi);
  c.drag = drag + (math::wrapped(T(angle - effective)) + turning) * g * circulatory +
           g * (drag - T(airfoil.drag.at(airfoil.zero_lift).value)) * separated;
  c.moment = airfoil.moment_at(effective) - g * turning * T(0.5 * std::numbers::pi);
  return c;
}

/// Force per length in B of lift and drag coefficients.
template <class T>
Vec3<T> air_force(const AirRotor& rotor, const AirStation& station, const SectionFlow<T>& flow,
                  const T& lift, const T& drag) {
  const double cosine = std::cos(station.twist);
  const double sine = std::sin(station.twist);
  const T pressure = flow.speed * T(0.5 * rotor.density * station.chord);
  const T to_edge = pressure * (lift * flow.n + drag * flow.c);     // along e_c
  const T to_suction = pressure * (drag * flow.n - lift * flow.c);  // along e_n
  return {T(0.0), to_edge * T(cosine) + to_suction * T(sine),
          to_suction * T(cosine) - to_edge * T(sine)};
}

/// Force and moment per length about the reference line, in B.
template <class T>
Vec6<T> air_load(const AirRotor& rotor, const AirStation& station, const SectionFlow<T>& flow,
                 const AirCoefficients<T>& c) {
  const Vec3<T> force = air_force(rotor, station, flow, c.lift, c.drag);
  Vec3<T> moment = math::cross(Vec3<T>(station.center.cast<T>()), force);
  moment(0) +=
      flow.speed * flow.speed * c.moment * T(0.5 * rotor.density * station.chord * station.chord);
  Vec6<T> load;
  load << force, moment;
  return load;
}

/// The air that moves with a section.
struct AddedMass {
  double mass = 0.0;     ///< of mid-chord along e_n, per length [kg/m]
  double inertia = 0.0;  ///< about b1 at mid-chord, per length [kg m]
  Vector6 normal;        ///< velocity of mid-chord along e_n from V, Omega
  Vector6 along;         ///< and along e_c
};

inline AddedMass added_mass_of(const AirRotor& rotor, const AirStation& station) {
  const double half = 0.5 * station.chord;
  const Vector3 edge(0.0, std::cos(station.twist), -std::sin(station.twist));
  const Vector3 suction(0.0, std::sin(station.twist), std::cos(station.twist));
  const Vector3 middle = station.center - 0.5 * half * edge;
  AddedMass added;
  added.mass = std::numbers::pi * rotor.density * half * half;
  added.inertia = 0.125 * added.mass * half * half;
  added.normal << suction, math::cross(middle, suction);  // (Omega x p) . e = Omega . (p x e)
  added.along << edge, math::cross(middle, edge);
  return added;
}

/// Loss of circulation at tip and hub (Prandtl), with a floor that keeps the balance regular.
template <class T>
T loss_factor(const AirRotor& rotor, const AirStation& station, const StationMotion<T>& motion,
              const T& Q_n, const T& Q_t) {
  using std::sqrt;
  const AirModels& models = rotor.models;
  const double floor = models.thrust == ThrustLaw::buhl_f ? 1e-4 : 0.02;
  const bool has_hub = models.hub_loss && rotor.hub_radius > 0.0;
  if ((!models.tip_loss && !has_hub) || models.has_rotor_wake()) return T(1.0);
  const T axial = motion.wind_axial + Q_n;
  const T turning = motion.hub_speed * motion.radius - Q_t;
  const T whole = axial * axial + turning * turning + T(rotor.least_speed * rotor.least_speed);
  const T sine = sqrt(T(axial * axial / whole + T(1e-6)));
  const auto loss = [&](double arc, const T& radius) {
    const T decay = math::exponential(T(T(-0.5 * rotor.blades * arc) / (radius * sine)));
    return T(math::arctangent(T(sqrt(T(T(1.0) - decay * decay))), decay) *
             T(2.0 / std::numbers::pi));
  };
  T F(1.0);
  if (models.tip_loss) F = loss(station.arc_to_tip, motion.radius);
  if (has_hub) F *= loss(station.arc_to_hub, T(rotor.hub_radius));
  return sqrt(T(F * F + T(floor * floor))) * T(1.0 / std::sqrt(1.0 + floor * floor));
}

/// Thrust of an annulus over rho/2 times its area [m^2/s^2], with the sign of the thrust, at the
/// axial induced velocity Q_n. F: loss factor.
template <class T>
T annulus_thrust(const AirRotor& rotor, const StationMotion<T>& motion, const T& Q_n, const T& F) {
  using std::sqrt;
  const double eps_square = rotor.least_speed * rotor.least_speed;
  const double sign = math::plain_value(motion.wind_axial) < 0.0 ? -1.0 : 1.0;
  const T u = motion.wind_axial * T(sign);
  const T q = Q_n * T(sign);
  const bool is_skew = rotor.models.thrust == ThrustLaw::glauert_skew;
  const T across_square = is_skew ? motion.wind_across_square : T(0.0);
  T a_c(0.4);
  T c0(8.0 / 9.0);
  T c1(-4.0 / 9.0);
  T c2(14.0 / 9.0);
  T skewed(0.0);
  if (is_skew) {
    const T T_raw = across_square / T(u * u + T(eps_square));
    const T ratio = math::smooth_min(T_raw, T(1e4), 1e3);
    a_c = math::smooth_min(T(sqrt(T(ratio + T(1.0))) * T(0.35)), T(0.5), 0.02);
    const T left = T(1.0) - a_c;
    const T flow = sqrt(T(left * left + ratio));
    const T C_c = a_c * flow * T(4.0);
    const T s_c = (T(1.0) - a_c * T(3.0) + a_c * a_c * T(2.0) + ratio) / flow * T(4.0);
    const T empirical =
        (math::power(T(ratio + T(1e-4)), 0.7635) - T(std::pow(1e-4, 0.7635))) * T(2.113) + T(2.0);
    const T C_1 = math::smooth_max(empirical, T(C_c + s_c * left + T(1e-3)), 0.02);
    const T D = left * left;
    c0 = (C_1 * a_c * a_c - C_c * a_c * T(2.0) + C_c + a_c * a_c * s_c - a_c * s_c) / D;
    c1 = (C_c * a_c * T(2.0) - C_1 * a_c * T(2.0) - a_c * a_c * s_c + s_c) / D;
    c2 = (C_1 - C_c + a_c * s_c - s_c) / D;
    skewed = math::smoothstep(T((ratio - T(1.0)) * T(1.0 / 3.0)));
  } else if (rotor.models.thrust == ThrustLaw::buhl_f) {
    c1 = F * T(4.0) - T(40.0 / 9.0);
    c2 = T(50.0 / 9.0) - F * T(4.0);
  }
  const T into = -(q + (a_c - T(0.05)) * u) / sqrt(T(u * u * T(0.01) + T(eps_square)));
  const T out = -(q + u * T(1.5)) / sqrt(T(u * u + T(eps_square)));
  // The last factor: no seam at U_n = 0.
  const T s = math::smoothstep(into) * (T(1.0) - math::smoothstep(out)) * (T(1.0) - skewed) *
              math::smoothstep(T(u / T(rotor.least_speed)));
  const T glauert = -(q * sqrt(T((u + q) * (u + q) + across_square + T(eps_square)))) * T(4.0);
  const T empirical = c0 * u * u - c1 * u * q + c2 * q * q;
  if (rotor.models.thrust == ThrustLaw::buhl_f)
    return ((T(1.0) - s) * glauert * F + s * empirical) * T(sign);
  return ((T(1.0) - s) * glauert + s * empirical) * F * T(sign);
}

/// Axial row of the balance of momentum with the polynomial of Madsen et al. (2020) [m^2/s^2]:
/// F^3 a = k1 F^2 c + k2 F c |c| + k3 c^3, times 4 u^2. a = -Q_n/U_n; c: thrust coefficient without
/// the loss factor F. `thrust`: axial load divided by rho pi r [m^2/s^2]. The rows are odd in c and
/// have no seam at U_n = 0; the polynomial is that of positive c.
template <class T>
T madsen_row(const AirRotor& rotor, const StationMotion<T>& motion, const T& Q_n, const T& F,
             const T& thrust) {
  using std::sqrt;
  constexpr double k1 = 0.2460;
  constexpr double k2 = 0.0586;
  constexpr double k3 = 0.0883;
  const T square = motion.wind_axial * motion.wind_axial + T(rotor.least_speed * rotor.least_speed);
  const T c = thrust / square;
  const T size = math::plain_value(c) < 0.0 ? T(-c) : c;
  const T polynomial = ((c * c * T(k3) + F * size * T(k2)) + F * F * T(k1)) * c;
  return (polynomial * square + F * F * F * sqrt(square) * Q_n) * T(4.0);
}

/// Factor of the load in the balance of momentum: 0 up to the tip-speed ratio 1, where the rotor is
/// no disk, and 1 from 2 on. `hub_speed` [rad/s]; `wind_square`: of the wind against the rotor
/// [m^2/s^2].
template <class T>
T disk_share(const AirRotor& rotor, const T& hub_speed, const T& wind_square) {
  using std::sqrt;
  const T least(rotor.least_speed * rotor.least_speed);
  const T tip_speed = hub_speed * T(rotor.tip_radius);
  const T ratio = sqrt(T((tip_speed * tip_speed + least) / (wind_square + least)));
  return math::smoothstep(T(ratio - T(1.0)));
}

/// The two rows of the balance of momentum, divided by rho pi r_0 [m^2/s^2]. `lift`, `drag`: force
/// per length and density in B.
template <class T>
Eigen::Matrix<T, 2, 1> momentum_rows(const AirRotor& rotor, const AirStation& station,
                                     const StationMotion<T>& motion, const T& Q_n, const T& Q_t,
                                     const Vec3<T>& lift, const Vec3<T>& drag) {
  using math::dot;
  using std::sqrt;
  const AirModels& models = rotor.models;
  const T wind_square = motion.wind_axial * motion.wind_axial + motion.wind_across_square;
  const T per_ring = disk_share(rotor, motion.hub_speed, wind_square) *
                     T(rotor.blades / (rotor.density * std::numbers::pi * station.radius));
  const T ring = motion.radius * motion.spread * T(1.0 / station.radius);
  const T F = loss_factor(rotor, station, motion, Q_n, Q_t);
  T axial = dot(lift, motion.axial);
  if (models.axial_drag) axial += dot(drag, motion.axial);
  Eigen::Matrix<T, 2, 1> rows;
  rows(0) = models.thrust == ThrustLaw::madsen
                ? T(ring * madsen_row(rotor, motion, Q_n, F, T(axial * per_ring / ring)))
                : T(axial * per_ring - ring * annulus_thrust(rotor, motion, Q_n, F));
  rows(1) = Q_t;
  if (models.induction != Induction::full) return rows;
  T tangential = dot(lift, motion.tangential);
  if (models.tangential_drag) tangential += dot(drag, motion.tangential);
  const T through = motion.wind_axial + Q_n;
  const T mass_flow = sqrt(
      T(through * through + motion.wind_across_square + T(rotor.least_speed * rotor.least_speed)));
  rows(1) = tangential * per_ring + ring * F * mass_flow * Q_t * T(4.0);
  return rows;
}

/// The balance of momentum with the load of a steady flow at the induced velocity Q.
template <class T>
Eigen::Matrix<T, 2, 1> steady_momentum_rows(const AirRotor& rotor, const AirStation& station,
                                            const StationMotion<T>& motion, const T& Q_n,
                                            const T& Q_t) {
  const SectionFlow<T> flow = section_flow(station, motion, Q_n, Q_t);
  const AirCoefficients<T> c = steady_coefficients(rotor.models, station, flow);
  return momentum_rows<T>(rotor, station, motion, Q_n, Q_t,
                          air_force(rotor, station, flow, c.lift, T(0.0)),
                          air_force(rotor, station, flow, T(0.0), c.drag));
}

/// Inertia of the air that an accelerated section moves (Theodorsen 1935): load per length about
/// the reference line in B from the rates of V and Omega. It is linear in them.
template <class T>
Vec6<T> added_mass_load(const AirRotor& rotor, const AirStation& station,
                        const Vec6<T>& velocity_dot) {
  const AddedMass added = added_mass_of(rotor, station);
  T normal(0.0);
  for (int i = 0; i < 6; ++i) normal += velocity_dot(i) * T(added.normal(i));
  Vec6<T> load;
  for (int i = 0; i < 6; ++i) load(i) = normal * T(-added.mass * added.normal(i));
  load(3) -= velocity_dot(3) * T(added.inertia);
  return load;
}

/// The part of the inertia of the air that depends on velocities: mid-chord turns with the section.
template <class T>
Vec6<T> added_mass_turning(const AirRotor& rotor, const AirStation& station,
                           const Vec6<T>& velocity) {
  const AddedMass added = added_mass_of(rotor, station);
  T along(0.0);
  for (int i = 0; i < 6; ++i) along += velocity(i) * T(added.along(i));
  Vec6<T> load;
  for (int i = 0; i < 6; ++i) load(i) = along * velocity(3) * T(-added.mass * added.normal(i));
  return load;
}

/// Flow and coefficients of a station in its present state.
template <class T>
struct StationAir {
  T induced_n, induced_t;  ///< induced velocity with the skewed wake [m/s]
  SectionFlow<T> flow;
  AirCoefficients<T> coefficients;
  Eigen::Matrix<T, 4, 1> lags;  ///< rows of x1 to x4
  Eigen::Matrix<T, 2, 1> more;  ///< rows of R_n, R_t where they are states of the shed wake
};

/// `z`, `z_dot`: unknowns of the station and their rates.
template <class T>
StationAir<T> station_air(const AirRotor& rotor, const AirStation& station,
                          const StationMotion<T>& motion,
                          const Eigen::Matrix<T, air::unknowns, 1>& z,
                          const Eigen::Matrix<T, 10, 1>& z_dot) {
  StationAir<T> present;
  present.induced_n = present.induced_t = T(0.0);
  if (rotor.models.induction != Induction::none) {
    present.induced_n = z(air::induced) * skew_factor(rotor, motion, T(z(air::induced)));
    present.induced_t = z(air::induced + 1);
  }
  present.flow = section_flow(station, motion, present.induced_n, present.induced_t);
  present.more = z.template segment<2>(air::reduced);
  if (rotor.models.dynamics == AirfoilDynamics::peters && station.has_dynamics(rotor.models)) {
    using States = Eigen::Matrix<T, FiniteStates::count, 1>;
    States mu;
    States mu_dot;
    States rows;
    mu << z.template segment<4>(air::wake), z.template segment<2>(air::reduced);
    mu_dot << z_dot.template segment<4>(air::wake), z_dot.template segment<2>(air::reduced);
    present.coefficients =
        finite_state_coefficients<T>(rotor.models, station, present.flow, mu, mu_dot, rows);
    present.lags = rows.template head<4>();
    present.more = rows.template tail<2>();
    return present;
  }
  present.coefficients =
      dynamic_coefficients<T>(rotor.models, station, present.flow, z.template segment<4>(air::wake),
                              z_dot.template segment<4>(air::wake), present.lags);
  return present;
}

/// All rows of a station. `z`, `z_dot`: its unknowns and their rates. Rows of unknowns that the
/// models do not use have no meaning.
template <class T>
Eigen::Matrix<T, air::unknowns, 1> air_station_rows(const AirRotor& rotor,
                                                    const AirStation& station,
                                                    const StationMotion<T>& motion,
                                                    const Eigen::Matrix<T, air::unknowns, 1>& z,
                                                    const Eigen::Matrix<T, 10, 1>& z_dot) {
  Eigen::Matrix<T, air::unknowns, 1> rows = z;
  const AirModels& models = rotor.models;
  const bool is_induced = models.induction != Induction::none;
  const StationAir<T> present = station_air<T>(rotor, station, motion, z, z_dot);
  const SectionFlow<T>& flow = present.flow;
  const AirCoefficients<T>& c = present.coefficients;
  rows.template segment<4>(air::wake) = present.lags;
  rows.template segment<2>(air::reduced) = present.more;
  Vec6<T> load = air_load(rotor, station, flow, c);
  if (models.added_mass) load += added_mass_turning<T>(rotor, station, motion.velocity);
  load *= T(rotor.acting);
  if (rotor.load_is_held) {
    for (int i = air::force; i < air::unknowns; ++i) rows(i) -= T(math::plain_value(z(i)));
  } else {
    rows.template segment<3>(air::force) -= motion.R * Vec3<T>(load.template head<3>());
    rows.template segment<3>(air::moment) -= motion.R * Vec3<T>(load.template tail<3>());
  }
  if (!is_induced) return rows;
  const T& Q_n = z(models.has_rotor_wake() ? air::induced : air::quasi_steady);
  const T& Q_t = z(air::quasi_steady + 1);
  rows.template segment<2>(air::quasi_steady) =
      models.closure == MomentumLoad::equilibrium
          ? steady_momentum_rows<T>(rotor, station, motion, Q_n, Q_t)
          : momentum_rows<T>(rotor, station, motion, Q_n, Q_t,
                             air_force(rotor, station, flow, c.lift, T(0.0)),
                             air_force(rotor, station, flow, T(0.0), c.drag));
  if (models.has_rotor_wake()) {  // the wake adds its velocity to the first row
    rows(air::induced + 1) = z(air::induced + 1) - Q_t;
    return rows;
  }
  const double outward = station.radius / rotor.tip_radius;
  const double tau2 = (0.39 - 0.26 * outward * outward) * rotor.tau1;
  for (int i = 0; i < 2; ++i) {
    const T& W = z(air::induced + i);
    const T& Q = z(air::quasi_steady + i);
    const T& R = z(air::reduced + i);
    if (models.inflow != Inflow::oye) {
      rows(air::induced + i) = rotor.wake_is_held ? T(W - T(math::plain_value(W))) : T(W - Q);
      continue;
    }
    rows(air::reduced + i) =
        z_dot(air::reduced + i) * T(rotor.tau1) + R - Q * T(1.0 - direct_share);
    rows(air::induced + i) = z_dot(air::induced + i) * T(tau2) + W - R - Q * T(direct_share);
  }
  return rows;
}

/// The same motion as constants of another scalar.
template <class T>
StationMotion<T> constant_motion(const StationMotion<double>& motion) {
  return {motion.R.cast<T>(),        motion.relative.cast<T>(),
          motion.axial.cast<T>(),    motion.tangential.cast<T>(),
          motion.velocity.cast<T>(), T(motion.radius),
          T(motion.spread),          T(motion.hub_speed),
          T(motion.wind_axial),      T(motion.wind_across_square),
          T(motion.wind_outward)};
}

/// Q_n, Q_t by damped Newton steps on the balance of momentum, from an induced velocity of a
/// quarter of the wind. Where it does not converge: the best that was found.
Eigen::Vector2d steady_induction(const AirRotor& rotor, const AirStation& station,
                                 const StationMotion<double>& motion);

/// The unknowns of a station in steady air: the solution of its rows without rates. With `closure:
/// load` the induced velocity is that of the steady coefficients.
Eigen::Matrix<double, air::unknowns, 1> steady_air(const AirRotor& rotor, const AirStation& station,
                                                   const StationMotion<double>& motion);

}  // namespace samara::elements
