// Wind, airfoils and aerodynamic models as defined by the user, in SI and radians
// (docs/theory.md, section 11).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "samara/elements/air_models.hpp"

namespace samara::model {

/// The tower in the wind, a body of round sections.
struct TowerFlowDefinition {
  using Potential = elements::TowerPotential;
  using Wake = elements::TowerWake;

  std::vector<double> heights;    ///< above the foot, rising [m]
  std::vector<double> diameters;  ///< at each height [m], > 0
  std::vector<double> drags;      ///< drag coefficient at each height, >= 0
  Potential potential = Potential::bak;
  Wake wake = Wake::none;
  double turbulence = 0.1;  ///< intensity, for the wake of Eames et al., > 0
  bool drag_load = true;    ///< the drag of the wind acts on the tower

  bool operator==(const TowerFlowDefinition&) const = default;
};

/// The nacelle in the wind: a box.
struct NacelleDragDefinition {
  std::array<double, 3> areas{};   ///< projected along y1, y2, y3 of the nacelle [m^2], >= 0
  std::array<double, 3> drags{};   ///< drag coefficient along each axis, >= 0
  std::array<double, 3> center{};  ///< place of the load, from the tower top in y1 y2 y3 [m]

  bool operator==(const NacelleDragDefinition&) const = default;
};

/// Mean wind: steady, a function of the place.
struct WindDefinition {
  using Profile = elements::WindProfile;

  double speed = 0.0;   ///< at `height` [m/s], >= 0
  double height = 0.0;  ///< of the reference, above the foot of the tower [m], > 0 with a profile
  Profile profile = Profile::uniform;
  double exponent = 0.0;   ///< of the power law
  double roughness = 0.0;  ///< roughness length of the logarithmic law [m], > 0
  /// Change of the speed across `shear_length`, as parts of `speed`: to the left of one who looks
  /// downwind, and up.
  double shear_left = 0.0;
  double shear_up = 0.0;
  double shear_length = 0.0;  ///< [m], > 0 with such a shear
  /// 0: along n2; > 0: turned counter-clockwise seen from above [rad].
  double direction = 0.0;
  double veer = 0.0;       ///< change of the direction with the height [rad/m]
  double upflow = 0.0;     ///< > 0: the wind rises [rad]
  double density = 1.225;  ///< of the air [kg/m^3], > 0
  std::optional<TowerFlowDefinition> tower;
  std::optional<NacelleDragDefinition> nacelle;

  bool operator==(const WindDefinition&) const = default;
};

/// Coefficients of an airfoil over its angle of attack, at one Reynolds number.
struct PolarDefinition {
  double reynolds = 0.0;       ///< 0: not known
  std::vector<double> angles;  ///< [rad], rising, from -pi to pi
  std::vector<double> lift;    ///< at each angle
  std::vector<double> drag;
  std::vector<double> moment;  ///< about the aerodynamic centre, nose up

  bool operator==(const PolarDefinition&) const = default;
};

struct AirfoilDefinition {
  std::string file;                     ///< that the polars were read from; empty: none
  std::vector<PolarDefinition> polars;  ///< at least one
  std::optional<double> thickness;      ///< relative to the chord
  std::optional<double> lift_slope;     ///< replaces that of the polar [1/rad]

  bool operator==(const AirfoilDefinition&) const = default;
};

/// Aerodynamic properties of a blade section.
struct AeroSectionDefinition {
  double at = 0.0;      ///< fraction of the blade's length
  double chord = 0.0;   ///< [m], > 0
  double twist = 0.0;   ///< of the chord, from b2 of the root toward feather [rad]
  std::string airfoil;  ///< name; empty: by the thickness
  /// Aerodynamic centre from the reference line along b2 and b3 of the structural section [m].
  std::array<double, 2> center{};
  /// Relative to the chord, linear along the blade. The coefficients are linear in the thickness
  /// between those of the next thinner and the next thicker airfoil. Either all sections have it,
  /// or none.
  std::optional<double> thickness = std::nullopt;

  bool operator==(const AeroSectionDefinition&) const = default;
};

using elements::AirfoilDynamics;
using elements::Induction;
using elements::Inflow;
using elements::MomentumLoad;
using elements::ThrustLaw;
using elements::WakeConstants;

/// Models of the air around the rotor. Without a wind they have no effect.
struct AeroDefinition : elements::AirModels {
  std::optional<double> tau1;  ///< first time constant of the dynamic inflow [s]; none: from the
                               ///< mean induction of the rigid rotor

  bool operator==(const AeroDefinition&) const = default;
};

}  // namespace samara::model
