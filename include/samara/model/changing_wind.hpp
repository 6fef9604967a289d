// Winds that change with time: curves of the mean wind, gusts of IEC 61400-1, and boxes of
// turbulence (docs/theory.md, section 11.1).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "samara/elements/wind.hpp"
#include "samara/math/time_curve.hpp"

namespace samara::model {

/// Velocities at the points of a grid across the wind and at equal times. Axes: along the wind, to
/// the left of one who looks downwind, and up.
struct WindBox {
  int times = 0, rows = 0, columns = 0;  ///< instants; points up; points across
  double step = 0.0;  ///< between instants [s]; before a box of HAWC2 is read, along the wind [m]
  double width = 0.0, height = 0.0;  ///< between points, across and up [m]
  double bottom = 0.0;               ///< height of the lowest row above the ground [m]
  double speed = 0.0;                ///< with which the box moves downwind [m/s]
  /// Place downwind of the tower's axis where the first instant is at t = 0 [m].
  double front = 0.0;
  bool is_periodic = false;     ///< the last instant is followed by the first one
  bool is_fluctuation = false;  ///< the velocities are added to the mean wind
  std::vector<float> values;    ///< [m/s], component fastest, then column from the right, row, time

  double duration() const { return step * (is_periodic ? times : times - 1); }
  /// In the axes of the box, and derivatives by its coordinates; linear between the points. Below
  /// the lowest row the wind is that of the lowest row.
  /// @throws DomainError outside the box
  elements::ChangingWind::Sample at(const Vector3& place, double t) const;
};

/// A gust of IEC 61400-1, edition 3, section 6.3.2, for a turbine of class `reference_speed` and
/// `turbulence`.
struct GustDefinition {
  enum class Type : std::uint8_t {
    operating,         ///< EOG, extreme operating gust
    direction,         ///< EDC, extreme direction change
    coherent,          ///< ECD, extreme coherent gust with direction change
    vertical_shear,    ///< EWS, extreme vertical wind shear
    horizontal_shear,  ///< EWS, extreme horizontal wind shear
  };
  Type type = Type::operating;
  double start = 0.0;             ///< [s]
  double turbulence = 0.16;       ///< I_ref: 0.16 (A), 0.14 (B), 0.12 (C)
  double reference_speed = 50.0;  ///< V_ref [m/s]: 50 (I), 42.5 (II), 37.5 (III)
  bool is_negative = false;       ///< the other sign of the change of direction or shear

  bool operator==(const GustDefinition&) const = default;
};

/// Change of the mean wind with time. A curve replaces the value of the mean wind.
struct WindChange {
  std::optional<math::TimeCurve> speed;       ///< [m/s]
  std::optional<math::TimeCurve> direction;   ///< [rad]
  std::optional<math::TimeCurve> upflow;      ///< [rad]
  std::optional<math::TimeCurve> exponent;    ///< of the power law
  std::optional<math::TimeCurve> shear_left;  ///< parts of the speed across the length of the shear
  std::optional<math::TimeCurve> shear_up;
  std::optional<math::TimeCurve> gust;  ///< added to the speed at all places [m/s]
  std::optional<GustDefinition> standard;
  std::string table_path;             ///< file of a uniform wind; empty: none
  std::vector<std::string> box_path;  ///< one file of TurbSim, or three of HAWC2; empty: none
  WindBox box_shape;                  ///< of a box of HAWC2, without values
  std::array<double, 3> box_scale{1.0, 1.0, 1.0};  ///< factors of its components
  std::shared_ptr<const WindBox> box;              ///< that was read
};

/// What a gust depends on.
struct GustSite {
  double wind = 0.0;      ///< V_hub [m/s]
  double height = 0.0;    ///< of the hub [m]
  double diameter = 0.0;  ///< of the rotor [m]
};

/// Changes of the mean wind by a gust.
struct GustState {
  double speed = 0.0;       ///< [m/s]
  double direction = 0.0;   ///< [rad]
  double shear_up = 0.0;    ///< [1/s]
  double shear_left = 0.0;  ///< [1/s]
};
GustState gust_at(const GustDefinition& gust, const GustSite& site, double t);
/// Time from the start of a gust to its end [s].
double gust_duration(const GustDefinition& gust);

/// `shear_length`: of the shears of the mean wind [m].
std::shared_ptr<const elements::ChangingWind> make_changing_wind(const WindChange& change,
                                                                 const elements::MeanWind& mean,
                                                                 double shear_length,
                                                                 const GustSite& site);

}  // namespace samara::model
