#include "samara/model/air.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "samara/math/rotation.hpp"
#include "samara/model/air_stations.hpp"
#include "samara/model/radius.hpp"

namespace samara::model {
namespace {

elements::MeanWind wind_of(const WindDefinition& definition) {
  elements::MeanWind wind;
  wind.speed = definition.speed;
  wind.height = definition.height;
  wind.profile = definition.profile;
  wind.exponent = definition.exponent;
  wind.roughness = definition.roughness;
  if (definition.shear_length > 0.0) {
    wind.shear_left = definition.speed * definition.shear_left / definition.shear_length;
    wind.shear_up = definition.speed * definition.shear_up / definition.shear_length;
  }
  wind.direction = definition.direction;
  wind.veer = definition.veer;
  wind.upflow = definition.upflow;
  return wind;
}

elements::TowerFlow tower_flow_of(const TowerFlowDefinition& definition, const Turbine& turbine) {
  elements::TowerFlow flow;
  flow.potential = definition.potential;
  flow.wake = definition.wake;
  flow.turbulence = definition.turbulence;
  flow.top = Vector3(turbine.tower.tip(1), turbine.tower.tip(2), turbine.tower.tip(0));
  const auto curve_of = [&definition](const std::vector<double>& values) {
    std::vector<math::TimeCurve::Point> points;
    for (std::size_t i = 0; i < values.size(); ++i)
      points.emplace_back(definition.heights[i], values[i]);
    if (points.size() == 1) points.emplace_back(points[0].first + 1.0, points[0].second);
    return math::TimeCurve::through(points);
  };
  flow.diameter = curve_of(definition.diameters);
  flow.drag = curve_of(definition.drags);
  return flow;
}

/// Height of the apex of the undeformed rotor, and the wind there, along the rotor's axis and
/// whole.
struct HubWind {
  double height = 0.0;
  double axial = 0.0;
  double speed = 0.0;
};

HubWind find_hub_wind(const elements::MeanWind& wind, const Turbine& turbine) {
  const elements::RigidChain& chain = turbine.chain;
  const Matrix3 bearing = math::turn_about<double>(Vector3::UnitZ(), turbine.yaw_motion.angle) *
                          math::turn_about<double>(Vector3::UnitX(), chain.tilt);
  Vector3 apex = Vector3(0.0, 0.0, chain.height) +
                 bearing * Vector3(0.0, chain.overhang + chain.undersling, 0.0);
  if (turbine.has_tower)
    apex += Vector3(turbine.tower.tip(1), turbine.tower.tip(2), turbine.tower.tip(0));
  const Vector3 v = wind.at<double>(apex);
  return {apex(2), v.dot(bearing.col(1)), v.norm()};
}

/// Mean axial induction of the undeformed rotor in axial wind over the area of its stations.
double find_mean_induction(const Air& air, const Turbine& turbine, double wind_axial) {
  elements::AirRotor rotor = air.rotor;
  rotor.wind = {};
  rotor.wind.mean.speed = wind_axial;  // along n2, which is the rotor's axis here
  elements::HubPose<double> hub;
  hub.speed = turbine.speed;
  double sum = 0.0;
  double area = 0.0;
  for (std::size_t k = 0; k < air.stations.size(); ++k) {
    const elements::RootPose<double> root{turbine.roots[k].position, turbine.roots[k].C_Ha};
    const Vector3 spin = root.axes.transpose() * Vector3(0.0, turbine.speed, 0.0);
    for (std::size_t p = 0; p < air.stations[k].size(); ++p) {
      const elements::AirStation& station = air.stations[k][p];
      const Vector3 arm = root.axes.transpose() * root.place + station.x;
      Eigen::Matrix<double, 12, 1> z = Eigen::Matrix<double, 12, 1>::Zero();
      z.segment<3>(6) = station.turned.transpose() * math::cross(spin, Vector3(arm));
      z.segment<3>(9) = station.turned.transpose() * spin;
      const auto motion = elements::station_motion<double>(rotor, station, z, root, hub);
      const double weight =
          turbine.blades[k].point_length(static_cast<int>(p)) * station.radius * motion.spread;
      sum -= weight * elements::steady_induction(rotor, station, motion)(0) / wind_axial;
      area += weight;
    }
  }
  return sum / area;
}

/// First time constant of Oye's dynamic inflow.
double find_tau1(const Air& air, const Turbine& turbine, double wind_axial) {
  constexpr double least_wind = 0.1;  // [m/s]
  constexpr double longest = 100.0;   // [s]
  constexpr double largest = 0.5;     // induction
  const double U = std::abs(wind_axial);
  if (U < least_wind || air.rotor.models.induction == elements::Induction::none) return longest;
  const double a = std::clamp(find_mean_induction(air, turbine, wind_axial), 0.0, largest);
  return std::min(1.1 / (1.0 - 1.3 * a) * air.rotor.tip_radius / U, longest);
}

}  // namespace

Air build_air(const TurbineDefinition& definition, const Turbine& turbine) {
  Air air;
  elements::AirRotor& rotor = air.rotor;
  rotor.models = *definition.aero;
  rotor.wind.mean = wind_of(*definition.wind);
  if (definition.wind->tower) {
    rotor.wind.tower = tower_flow_of(*definition.wind->tower, turbine);
    air.tower_has_drag = definition.wind->tower->drag_load;
  }
  air.nacelle = definition.wind->nacelle;
  rotor.density = definition.wind->density;
  rotor.blades = static_cast<int>(turbine.blades.size());
  rotor.hub_radius = definition.hub.radius;
  rotor.tip_radius = rotor_radius(turbine);
  place_air_stations(definition, turbine, air);
  const HubWind wind = find_hub_wind(rotor.wind.mean, turbine);
  air.hub_height = wind.height;
  air.hub_wind = wind.speed;
  air.hub_wind_axial = wind.axial;
  constexpr double share = 0.01;
  constexpr double least = 0.01;  // [m/s]
  rotor.least_speed = std::max(share * wind.speed, least);
  rotor.tau1 = definition.aero->tau1 ? *definition.aero->tau1 : find_tau1(air, turbine, wind.axial);
  return air;
}

}  // namespace samara::model
