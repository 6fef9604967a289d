// The choice among models of the air around a rotor, and their constants (docs/theory.md,
// section 11).
#pragma once

#include <array>
#include <cstdint>
#include <numbers>
#include <vector>

namespace samara::elements {

/// Mean wind over the height.
enum class WindProfile : std::uint8_t { uniform, power, logarithmic };

/// Flow ahead of the tower and beside it. plain: potential flow around a cylinder; bak: the same a
/// tenth of a radius farther upwind, with a source of the drag (Bak, Madsen & Johansen 2001).
enum class TowerPotential : std::uint8_t { none, plain, bak };
/// Wake of the tower. powles: a cosine (Powles 1983); eames: a bell curve that the turbulence
/// widens (Eames, Jonsson & Johnson 2011).
enum class TowerWake : std::uint8_t { none, powles, eames };

/// Components of the induced velocity that the balance of momentum gives.
enum class Induction : std::uint8_t { none, axial, full };
/// Relation of the induced velocity W to its quasi-steady value Q. equilibrium: W = Q; oye: two
/// lags in series (Oye 1990); frozen: W = Q in the steady state, without change in a motion about
/// it. peters_he: finite states of the whole rotor give W along the axis (Peters & He 1991).
enum class Inflow : std::uint8_t { equilibrium, oye, frozen, peters_he };
/// Load in the balance of momentum. equilibrium: of the polars at the quasi-steady induced
/// velocity; actual: of the airfoil dynamics.
enum class MomentumLoad : std::uint8_t { equilibrium, actual };
/// Thrust over induction of an annulus. glauert_skew: with the component of the wind in the plane
/// of the disk; buhl: for axial wind, with a tip loss that multiplies it; buhl_f: the same with the
/// tip loss in its coefficients (Buhl 2005, AeroDyn); madsen: the induction as a polynomial of the
/// thrust (Madsen et al. 2020, HAWC2).
enum class ThrustLaw : std::uint8_t { glauert_skew, buhl, buhl_f, madsen };
/// Airfoil dynamics. hgm: shed wake, pressure lag and separation lag (Hansen, Gaunaa, Madsen 2004);
/// oye: separation lag; quasi_steady: none, angle of attack at three quarters of the chord;
/// static_polar: the same at the aerodynamic centre; peters: shed wake of attached flow by finite
/// states (Peters, Karunamoorthy & Cao 1995).
enum class AirfoilDynamics : std::uint8_t { hgm, oye, quasi_steady, static_polar, peters };

/// Constants of the shed wake: lift deficits A1, A2 and decay rates b1, b2 per half chord
/// travelled.
using WakeConstants = std::array<double, 4>;
/// R. T. Jones's approximation of a flat plate (NACA Report 681, 1940).
inline constexpr WakeConstants jones_constants{0.165, 0.335, 0.0455, 0.3};

/// Factor of the skewed wake of Pitt and Peters (1981): 15 pi / 32.
inline constexpr double pitt_peters_skew = 15.0 * std::numbers::pi / 32.0;

/// Models of the air that are the same at all stations of a rotor.
struct AirModels {
  Induction induction = Induction::full;
  Inflow inflow = Inflow::oye;
  /// Shapes over the radius of the harmonics 0, 1, 2, ... of `Inflow::peters_he`. With the default
  /// no shape has a power of the radius above the fourth.
  std::vector<int> wake_shapes{3, 2, 2, 1, 1};
  MomentumLoad closure = MomentumLoad::equilibrium;
  ThrustLaw thrust = ThrustLaw::glauert_skew;
  bool tip_loss = true;
  bool hub_loss = true;
  bool axial_drag = true;          ///< the drag takes part in the axial balance of momentum
  bool tangential_drag = true;     ///< and in the tangential one
  double skew = pitt_peters_skew;  ///< factor of the skewed wake; 0: none
  AirfoilDynamics dynamics = AirfoilDynamics::hgm;
  WakeConstants wake = jones_constants;
  double pressure_lag = 1.7;                ///< T_p by c/(2 U)
  double separation_lag = 3.0;              ///< T_f by c/(2 U)
  double cut_out = std::numbers::pi / 4.0;  ///< angle beyond which loads are static [rad]
  bool added_mass = false;

  bool has_rotor_wake() const {
    return induction != Induction::none && inflow == Inflow::peters_he;
  }
  bool operator==(const AirModels&) const = default;
};

}  // namespace samara::elements
