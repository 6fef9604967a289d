#include "samara/model/air_stations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "samara/base/error.hpp"
#include "samara/math/quadrature.hpp"
#include "samara/model/airfoil.hpp"
#include "samara/model/beam.hpp"
#include "samara/model/radius.hpp"

namespace samara::model {
namespace {

constexpr double kinematic_viscosity = 1.46e-5;  // of air at 15 degrees [m^2/s]

using Sections = std::vector<AeroSectionDefinition>;

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

Between find_sections(const Sections& sections, double at) {
  const auto behind = std::ranges::lower_bound(sections, at, {},
                                               [](const AeroSectionDefinition& s) { return s.at; });
  if (behind == sections.begin()) return {&*behind, &*behind, 0.0};
  if (behind == sections.end()) return {&sections.back(), &sections.back(), 0.0};
  const AeroSectionDefinition& before = *(behind - 1);
  return {&before, &*behind, (at - before.at) / (behind->at - before.at)};
}

double thickness_of(const AeroSectionDefinition& section) {
  if (!section.thickness)
    throw InputError("blades.aero_sections: expected a thickness at all sections or at none");
  return *section.thickness;
}

using Weights = std::map<std::string, double>;  // of airfoils, by their names; their sum is 1

/// The airfoils of a case.
class Airfoils {
 public:
  explicit Airfoils(const std::map<std::string, AirfoilDefinition>& airfoils)
      : airfoils_(airfoils), by_thickness_(sort_by_thickness(airfoils)) {}

  const AirfoilDefinition& at(const std::string& name) const {
    const auto found = airfoils_.find(name);
    if (found == airfoils_.end())
      throw InputError("blades.aero_sections: there is no airfoil \"" + name + "\"");
    return found->second;
  }

  Weights at(const Between& place) const {
    if (place.before->thickness) return at_thickness(place.of(thickness_of));
    return between(place.before->airfoil, place.behind->airfoil, place.weight);
  }

  /// Thickness and name, the thinnest first.
  const std::vector<std::pair<double, std::string>>& by_thickness() const { return by_thickness_; }

 private:
  static Weights between(const std::string& a, const std::string& b, double weight) {
    if (a == b || weight == 0.0) return {{a, 1.0}};
    if (weight == 1.0) return {{b, 1.0}};
    return {{a, 1.0 - weight}, {b, weight}};
  }

  Weights at_thickness(double thickness) const {
    if (by_thickness_.empty())
      throw InputError("blades.aero_sections: there is no airfoil with a thickness");
    const auto thicker = std::ranges::lower_bound(by_thickness_, thickness, {},
                                                  &std::pair<double, std::string>::first);
    if (thicker == by_thickness_.begin()) return {{thicker->second, 1.0}};
    const auto& [least, thinner] = *(thicker - 1);
    if (thicker == by_thickness_.end()) return {{thinner, 1.0}};
    return between(thinner, thicker->second, (thickness - least) / (thicker->first - least));
  }

  const std::map<std::string, AirfoilDefinition>& airfoils_;
  std::vector<std::pair<double, std::string>> by_thickness_;
};

/// The section of a station.
struct StationSection {
  double chord = 0.0;
  double twist = 0.0;
  std::array<double, 2> center{};
  Weights airfoils;
};

StationSection section_at(const Between& place, const Airfoils& airfoils) {
  StationSection section;
  section.chord = place.of([](const AeroSectionDefinition& s) { return s.chord; });
  section.twist = place.of([](const AeroSectionDefinition& s) { return s.twist; });
  for (std::size_t i = 0; i < 2; ++i)
    section.center[i] = place.of([i](const AeroSectionDefinition& s) { return s.center[i]; });
  section.airfoils = airfoils.at(place);
  return section;
}

/// The ends of an element, and the places between them where the slope of a property jumps:
/// sections, and thicknesses of airfoils.
std::vector<double> cuts_of(const Sections& sections, const Airfoils& airfoils, double start,
                            double end) {
  std::vector<double> cuts{start, end};
  const auto add = [&](double at) {
    if (at > start && at < end) cuts.push_back(at);
  };
  for (std::size_t i = 0; i < sections.size(); ++i) {
    add(sections[i].at);
    if (i == 0 || !sections[i].thickness) continue;
    const double before = thickness_of(sections[i - 1]);
    const double change = thickness_of(sections[i]) - before;
    for (const auto& [thickness, name] : airfoils.by_thickness()) {
      const double weight = (thickness - before) / change;
      if (weight > 0.0 && weight < 1.0)
        add(sections[i - 1].at + weight * (sections[i].at - sections[i - 1].at));
    }
  }
  std::ranges::sort(cuts);
  return cuts;
}

/// Mean sections of an element from `start` to `end`. The values at the points would omit sections
/// between them. Chord c, and c times each other property m, have the values
/// (1 / w_j) int l_j(xi) c m dxi, with the polynomials l_j through the points: they keep the
/// moments of a load that is linear in the properties. Nothing is returned where no property
/// changes its slope in the element: the values at the points have these moments.
std::vector<StationSection> mean_sections(const Sections& sections, const Airfoils& airfoils,
                                          int order, double start, double end) {
  const std::vector<double> cuts = cuts_of(sections, airfoils, start, end);
  if (cuts.size() == 2) return {};
  const math::QuadratureRule rule = math::gauss_rule(order);
  const math::QuadratureRule fine = math::gauss_rule(order + 1);  // of degree order - 1 + 2
  std::vector<StationSection> means(rule.points.size());
  for (std::size_t c = 0; c + 1 < cuts.size(); ++c)
    for (std::size_t q = 0; q < fine.points.size(); ++q) {
      const double at = cuts[c] + (cuts[c + 1] - cuts[c]) * fine.points[q];
      const double xi = (at - start) / (end - start);
      const double length = (cuts[c + 1] - cuts[c]) / (end - start) * fine.weights[q];
      const StationSection section = section_at(find_sections(sections, at), airfoils);
      for (std::size_t j = 0; j < means.size(); ++j) {
        const double weight = math::lagrange(rule.points, static_cast<int>(j), xi) * length /
                              rule.weights[j] * section.chord;
        StationSection& mean = means[j];
        mean.chord += weight;
        mean.twist += weight * section.twist;
        for (std::size_t i = 0; i < 2; ++i) mean.center[i] += weight * section.center[i];
        for (const auto& [name, part] : section.airfoils) mean.airfoils[name] += weight * part;
      }
    }
  for (StationSection& mean : means) {
    mean.twist /= mean.chord;
    for (double& offset : mean.center) offset /= mean.chord;
    for (auto& [name, part] : mean.airfoils) part /= mean.chord;
  }
  return means;
}

/// The curves of the airfoils of stations, each made once.
class CurveShelf {
 public:
  explicit CurveShelf(const Airfoils& airfoils) : airfoils_(airfoils) {}

  std::shared_ptr<const elements::AirfoilCurves> at(const Weights& weights, double reynolds) {
    const bool has_many = std::ranges::any_of(
        weights, [this](const auto& part) { return airfoils_.at(part.first).polars.size() > 1; });
    auto& curves = made_[{weights, has_many ? reynolds : 0.0}];
    if (!curves)
      curves = std::make_shared<const elements::AirfoilCurves>(
          make_curves(shares_of(weights), reynolds));
    return curves;
  }

  /// Whether airfoils make a section with a chord, and with drag where all of them have drag.
  bool are_possible(const StationSection& section, double reynolds) const {
    if (!(section.chord > 0.0)) return false;
    double bound = 0.0;
    const auto least_drag = [](const PolarDefinition& polar) {
      return *std::ranges::min_element(polar.drag);
    };
    for (const auto& [name, part] : section.airfoils)
      bound = std::min(bound, least_drag(polar_at(airfoils_.at(name), reynolds)));
    return least_drag(blend(shares_of(section.airfoils), reynolds)) >= bound;
  }

 private:
  std::vector<AirfoilShare> shares_of(const Weights& weights) const {
    std::vector<AirfoilShare> shares;
    for (const auto& [name, part] : weights) shares.push_back({&airfoils_.at(name), part});
    return shares;
  }

  const Airfoils& airfoils_;
  std::map<std::pair<Weights, double>, std::shared_ptr<const elements::AirfoilCurves>> made_;
};

}  // namespace

void place_air_stations(const TurbineDefinition& definition, const Turbine& turbine, Air& air) {
  const Airfoils airfoils(definition.blades.airfoils);
  const Sections& sections = definition.blades.aero_sections;
  CurveShelf shelf(airfoils);
  for (std::size_t k = 0; k < turbine.blades.size(); ++k) {
    const Beam& beam = turbine.blades[k];
    std::vector<elements::AirStation>& stations = air.stations.emplace_back();
    const auto radius_of = [&](std::size_t p) {
      return undeformed_radius(turbine.roots[k], beam.points[p].x);
    };
    const auto reynolds_of = [&](const StationSection& section, std::size_t p) {
      return std::hypot(turbine.speed * radius_of(p), definition.wind->speed) * section.chord /
             kinematic_viscosity;
    };
    for (int e = 0; e < beam.elements; ++e) {
      const auto at = static_cast<std::size_t>(e);
      const auto first = static_cast<std::size_t>(e * beam.order);
      std::vector<StationSection> means =
          mean_sections(sections, airfoils, beam.order, beam.ends[at], beam.ends[at + 1]);
      bool are_possible = !means.empty();
      for (std::size_t j = 0; j < means.size(); ++j)
        are_possible =
            are_possible && shelf.are_possible(means[j], reynolds_of(means[j], first + j));
      for (std::size_t j = 0; j < static_cast<std::size_t>(beam.order); ++j) {
        const std::size_t p = first + j;
        const double fraction = beam.fractions[p];
        const StationSection section =
            are_possible ? means[j] : section_at(find_sections(sections, fraction), airfoils);
        elements::AirStation station;
        station.x = beam.points[p].x;
        station.turned = beam.points[p].reference * beam.points[p].C_ab;
        station.chord = section.chord;
        station.twist = section.twist - interpolate_section(definition.blades.beam, fraction).twist;
        station.center = Vector3(0.0, section.center[0], section.center[1]);
        station.arc_to_tip = (1.0 - fraction) * beam.length;
        station.arc_to_hub = fraction * beam.length;
        station.radius = radius_of(p);
        station.airfoil = shelf.at(section.airfoils, reynolds_of(section, p));
        if (air.rotor.models.induction != elements::Induction::none &&
            !(station.radius > 0.3 * definition.hub.radius && station.radius > 0.0))
          throw InputError("blades.aero_sections: " + beam.name + " point " +
                           std::to_string(p + 1) +
                           " is inboard of the hub, where there is no balance of momentum (use "
                           "aero.induction: none)");
        stations.push_back(station);
      }
    }
  }
}

}  // namespace samara::model
