#include "samara/model/air.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <tuple>

#include "samara/base/error.hpp"
#include "samara/math/rotation.hpp"
#include "samara/model/airfoil.hpp"
#include "samara/model/radius.hpp"

namespace samara::model {
namespace {

constexpr double kinematic_viscosity = 1.46e-5;  // of air at 15 degrees [m^2/s]

/// Place of a fraction of the length between two sections, and the weight of the second one.
struct Between {
  const AeroSectionDefinition* before = nullptr;
  const AeroSectionDefinition* behind = nullptr;
  double weight = 0.0;

  /// A property of the sections, linear between them.
  double of(auto member) const {
    return (1.0 - weight) * member(*before) + weight * member(*behind);
  }
};

Between find_sections(const std::vector<AeroSectionDefinition>& sections, double at) {
  const auto behind = std::ranges::lower_bound(sections, at, {},
                                               [](const AeroSectionDefinition& s) { return s.at; });
  if (behind == sections.begin()) return {&*behind, &*behind, 0.0};
  if (behind == sections.end()) return {&sections.back(), &sections.back(), 0.0};
  const AeroSectionDefinition& before = *(behind - 1);
  return {&before, &*behind, (at - before.at) / (behind->at - before.at)};
}

/// The curves of the airfoils between sections, each made once.
class AirfoilShelf {
 public:
  explicit AirfoilShelf(const std::map<std::string, AirfoilDefinition>& airfoils)
      : airfoils_(airfoils), by_thickness_(sort_by_thickness(airfoils)) {}

  std::shared_ptr<const elements::AirfoilCurves> at(const Between& place, double reynolds) {
    if (place.before->thickness) return at_thickness(place, reynolds);
    return between(place.before->airfoil, place.behind->airfoil, place.weight, reynolds);
  }

 private:
  std::shared_ptr<const elements::AirfoilCurves> between(const std::string& a, const std::string& b,
                                                         double weight, double reynolds) {
    if (a == b) weight = 0.0;
    const bool has_many = airfoil(a).polars.size() > 1 || airfoil(b).polars.size() > 1;
    auto& curves = made_[{a, b, weight, has_many ? reynolds : 0.0}];
    if (!curves)
      curves = std::make_shared<const elements::AirfoilCurves>(
          make_curves(airfoil(a), airfoil(b), weight, reynolds));
    return curves;
  }

  std::shared_ptr<const elements::AirfoilCurves> at_thickness(const Between& place,
                                                              double reynolds) {
    const double thickness = place.of([](const AeroSectionDefinition& s) {
      if (!s.thickness)
        throw InputError("blades.aero_sections: expected a thickness at all sections or at none");
      return *s.thickness;
    });
    if (by_thickness_.empty())
      throw InputError("blades.aero_sections: there is no airfoil with a thickness");
    const auto thicker = std::ranges::lower_bound(by_thickness_, thickness, {},
                                                  &std::pair<double, std::string>::first);
    if (thicker == by_thickness_.begin())
      return between(thicker->second, thicker->second, 0.0, reynolds);
    const auto& [least, thinner] = *(thicker - 1);
    if (thicker == by_thickness_.end()) return between(thinner, thinner, 0.0, reynolds);
    return between(thinner, thicker->second, (thickness - least) / (thicker->first - least),
                   reynolds);
  }

  const AirfoilDefinition& airfoil(const std::string& name) const {
    const auto found = airfoils_.find(name);
    if (found == airfoils_.end())
      throw InputError("blades.aero_sections: there is no airfoil \"" + name + "\"");
    return found->second;
  }

  const std::map<std::string, AirfoilDefinition>& airfoils_;
  std::vector<std::pair<double, std::string>> by_thickness_;
  std::map<std::tuple<std::string, std::string, double, double>,
           std::shared_ptr<const elements::AirfoilCurves>>
      made_;
};

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

void place_stations(const TurbineDefinition& definition, const Turbine& turbine, Air& air) {
  AirfoilShelf shelf(definition.blades.airfoils);
  for (std::size_t k = 0; k < turbine.blades.size(); ++k) {
    const Beam& beam = turbine.blades[k];
    const BladeRoot& root = turbine.roots[k];
    std::vector<elements::AirStation>& stations = air.stations.emplace_back();
    for (int p = 0; p < beam.point_count(); ++p) {
      const auto at = static_cast<std::size_t>(p);
      const double fraction = beam.fractions[at];
      const Between place = find_sections(definition.blades.aero_sections, fraction);
      elements::AirStation station;
      station.x = beam.points[at].x;
      station.turned = beam.points[at].reference * beam.points[at].C_ab;
      station.chord = place.of([](const AeroSectionDefinition& s) { return s.chord; });
      station.twist = place.of([](const AeroSectionDefinition& s) { return s.twist; }) -
                      interpolate_section(definition.blades.beam, fraction).twist;
      station.center =
          Vector3(0.0, place.of([](const AeroSectionDefinition& s) { return s.center[0]; }),
                  place.of([](const AeroSectionDefinition& s) { return s.center[1]; }));
      station.arc_to_tip = (1.0 - fraction) * beam.length;
      station.arc_to_hub = fraction * beam.length;
      station.radius = undeformed_radius(root, station.x);
      const double speed = std::hypot(turbine.speed * station.radius, definition.wind->speed);
      station.airfoil = shelf.at(place, speed * station.chord / kinematic_viscosity);
      if (air.rotor.models.induction != elements::Induction::none &&
          !(station.radius > 0.3 * definition.hub.radius && station.radius > 0.0))
        throw InputError("blades.aero_sections: " + beam.name + " point " + std::to_string(p + 1) +
                         " is inboard of the hub, where there is no balance of momentum (use "
                         "aero.induction: none)");
      stations.push_back(station);
    }
  }
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
  place_stations(definition, turbine, air);
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
