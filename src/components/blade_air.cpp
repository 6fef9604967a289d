#include "samara/components/blade_air.hpp"

#include <algorithm>
#include <array>
#include <complex>

#include "samara/base/index.hpp"

namespace samara::components {
namespace {

namespace air = elements::air;
using elements::AirfoilDynamics;
using elements::AirModels;
using elements::AirStation;
using elements::Induction;
using elements::Inflow;
using system::RowRole;
using system::UnknownRole;

struct NamedUnknown {
  const char* name;
  const char* unit;
};

constexpr std::array<NamedUnknown, air::unknowns> air_unknowns{{{"W_n", "m/s"},
                                                                {"W_t", "m/s"},
                                                                {"R_n", "m/s"},
                                                                {"R_t", "m/s"},
                                                                {"Q_n", "m/s"},
                                                                {"Q_t", "m/s"},
                                                                {"x1", "m/s"},
                                                                {"x2", "m/s"},
                                                                {"x3", "1"},
                                                                {"x4", "1"},
                                                                {"f1", "N/m"},
                                                                {"f2", "N/m"},
                                                                {"f3", "N/m"},
                                                                {"m1", "N"},
                                                                {"m2", "N"},
                                                                {"m3", "N"}}};

/// Place of a station with the displacement u, components n1 n2 n3 [m].
template <class T>
Vec3<T> place_of(const AirStation& station, const Vec3<T>& u, const elements::RootPose<T>& root) {
  return root.place + root.axes * Vec3<T>(station.x.cast<T>() + u);
}

/// Whether an unknown is a state of the shed wake.
bool is_of_wake(const AirModels& models, int i) {
  if (models.dynamics == AirfoilDynamics::peters)
    return (i >= air::wake && i < air::force) || (i >= air::reduced && i < air::quasi_steady);
  return i >= air::wake && i < air::lift;
}

/// Part after which exponents are named.
const char* part_of(const AirModels& models, int i) {
  return is_of_wake(models, i) ? "shed wake"
         : i < air::wake       ? "inflow"
         : i < air::force      ? "stall"
                               : "air load";
}

/// Name and unit of an unknown.
NamedUnknown name_of(const AirModels& models, int i) {
  constexpr std::array<const char*, 6> states{"mu5", "mu6", "mu1", "mu2", "mu3", "mu4"};
  if (models.dynamics != AirfoilDynamics::peters || !is_of_wake(models, i))
    return air_unknowns[at(i)];
  return {states[at(i < air::wake ? i - air::reduced : 2 + i - air::wake)], "m/s"};
}

/// Role of unknown i of a station, and whether the models have it.
enum class Use { none, state, auxiliary };

Use use_of(const AirModels& models, const AirStation& station, int i) {
  if (i >= air::force) return Use::auxiliary;
  const bool has_dynamics = station.has_dynamics(models);
  if (i >= air::wake) {
    if (!has_dynamics) return Use::none;
    return models.dynamics != AirfoilDynamics::oye || i == air::separation ? Use::state : Use::none;
  }
  if (has_dynamics && is_of_wake(models, i)) return Use::state;
  if (models.induction == Induction::none) return Use::none;
  if (models.induction == Induction::axial && i % 2 == 1) return Use::none;
  if (models.has_rotor_wake() && i == air::quasi_steady) return Use::none;
  if (i >= air::quasi_steady) return Use::auxiliary;
  if (models.inflow == Inflow::oye) return Use::state;
  return i >= air::reduced ? Use::none : Use::auxiliary;
}

}  // namespace

double usual_induced_velocity(const model::Turbine& turbine) {
  const elements::AirRotor& rotor = turbine.air->rotor;
  return std::max({turbine.speed * rotor.tip_radius, rotor.wind.mean.speed, 1.0}) / 10.0;
}

BladeAir::BladeAir(const model::Turbine& turbine, std::size_t k, const Beam& blade)
    : turbine_(turbine), k_(k), blade_(blade), stations_(turbine.air->stations[k]) {
  // The references of the points may be those of a deformed blade.
  for (std::size_t p = 0; p < stations_.size(); ++p) {
    const elements::BeamPoint& point = turbine.blades[k].points[p];
    stations_[p].x = point.x;
    stations_[p].turned = point.reference * point.C_ab;
  }
}

void BladeAir::tie(int hub_port, int root_port) {
  hub_port_ = hub_port;
  root_port_ = root_port;
}

void BladeAir::describe(Registry& registry) {
  for (int p = 0; p < blade_.placed().beam->point_count(); ++p) {
    describe_point(registry, p);
    connect_point(p);
    if (air().rotor.models.added_mass) connect_added_mass(p);
  }
}

void BladeAir::describe_point(Registry& registry, int p) const {
  const elements::AirRotor& rotor = air().rotor;
  const double velocity = usual_induced_velocity(turbine_);
  const double load = 50.0 * rotor.density * velocity * velocity * station(p).chord;
  const int first = blade_.placed().air[at(p)];
  for (int i = 0; i < air::unknowns; ++i) {
    const Use use = use_of(rotor.models, station(p), i);
    if (use == Use::none) continue;
    const system::Owner owner(system::PartKind::medium, part_of(rotor.models, i),
                              static_cast<int>(k_) + 1);
    const NamedUnknown named = name_of(rotor.models, i);
    system::Unknown unknown{owner,
                            "point " + std::to_string(p + 1),
                            named.name,
                            named.unit,
                            use == Use::state ? UnknownRole::state : UnknownRole::auxiliary,
                            system::Frame::rotating};
    if (i < air::lift || is_of_wake(rotor.models, i)) unknown.scale = velocity;
    if (i >= air::force) unknown.scale = i < air::moment ? load : load * station(p).chord;
    registry.describe(first + i, unknown,
                      use == Use::state ? RowRole::evolution : RowRole::definition);
  }
}

void BladeAir::connect_point(int p) {
  const PlacedBeam& placed = blade_.placed();
  const int point = placed.points[at(p)];
  const int first = placed.air[at(p)];
  Connections connections;
  connections.arguments = {unknowns(point, 12)};
  std::vector<Argument> rates_of_states;
  for (int i = 0; i < air::unknowns; ++i) {
    const Use use = use_of(air().rotor.models, station(p), i);
    const auto add = [](std::vector<Argument>& list, const Argument& next) {
      Argument* last = list.empty() ? nullptr : &list.back();
      if (last != nullptr && last->kind == next.kind &&
          (next.kind == Argument::Kind::zeros || last->first + last->count == next.first))
        last->count += next.count;
      else
        list.push_back(next);
    };
    add(connections.arguments, use == Use::none ? zeros(1) : unknowns(first + i, 1));
    if (i < rate_count) add(rates_of_states, use == Use::state ? rates(first + i, 1) : zeros(1));
    if (use != Use::none) connections.shares.push_back({first + i, 1, i});
  }
  connections.arguments.insert(connections.arguments.end(), rates_of_states.begin(),
                               rates_of_states.end());
  connections.arguments.push_back(port_values(hub_port_, hub_pose_values));
  connections.arguments.push_back(port_values(root_port_, root_pose_values));
  points_.push_back(connections);
  for (int node = 0; node <= placed.beam->order; ++node) {
    const double weight = -placed.node_weights(node, p)[1];
    const int row = placed.force_rows(p, node);
    linear_.push_back({row, first + air::force, 3, weight});
    linear_.push_back({row + 3, first + air::moment, 3, weight});
  }
}

void BladeAir::connect_added_mass(int p) {
  const PlacedBeam& placed = blade_.placed();
  const int point = placed.points[at(p)];
  Connections connections;
  connections.arguments = {unknowns(point + 3, 3), rates(point + 6, 6)};
  for (int node = 0; node <= placed.beam->order; ++node) {
    const double weight = -placed.node_weights(node, p)[1];
    const int row = placed.force_rows(p, node);
    connections.shares.push_back({row, 3, 0, weight});
    connections.shares.push_back({row + 3, 3, 3, weight});
  }
  inertias_.push_back(connections);
}

template <class T>
elements::StationMotion<T> BladeAir::motion_at(int p, const Eigen::Matrix<T, arguments, 1>& x,
                                               double t,
                                               const elements::WindInputs<T>* change) const {
  return elements::station_motion<T>(air().rotor, station(p), x.template head<12>(),
                                     root_pose_of<T>(x.template segment<root_pose_values>(at_root)),
                                     hub_pose_of<T>(x.template segment<hub_pose_values>(at_hub)), t,
                                     change);
}

template <class System>
void BladeAir::state(System& system) const {
  system.add(linear_);
  const double t = system.time();
  const Memory memory = air().rotor.wind.changing ? Memory::none : Memory::of_arguments;
  for (int p = 0; p < blade_.placed().beam->point_count(); ++p) {
    const auto rows_of = [&]<class T>(const Eigen::Matrix<T, arguments, 1>& x) {
      return elements::air_station_rows<T>(
          air().rotor, station(p), motion_at<T>(p, x, t, wind_inputs<T>(system)),
          x.template segment<air::unknowns>(at_air), x.template segment<rate_count>(at_rates));
    };
    system.template add<arguments, air::unknowns>(points_[at(p)], rows_of, memory);
    if (inertias_.empty()) continue;
    const auto inertia_of = [&]<class T>(const Eigen::Matrix<T, 9, 1>& x) {
      const Mat3<T> R = math::direction_cosines<T>(x.template head<3>()).transpose() *
                        station(p).turned.template cast<T>();
      const Vec6<T> load =
          elements::added_mass_load<T>(air().rotor, station(p), x.template tail<6>()) *
          T(air().rotor.acting);
      Vec6<T> y;
      y << R * Vec3<T>(load.template head<3>()), R * Vec3<T>(load.template tail<3>());
      return y;
    };
    system.template add<9, 6>(inertias_[at(p)], inertia_of, Memory::of_arguments);
  }
}

template <class T>
AirPointReport<T> BladeAir::report_at(int p, const Eigen::Matrix<T, arguments, 1>& x, double t,
                                      const elements::WindInputs<T>& change) const {
  using math::cross;
  using math::dot;
  using std::sqrt;
  const elements::AirRotor& rotor = air().rotor;
  const AirStation& station = this->station(p);
  const elements::HubPose<T> hub = hub_pose_of<T>(x.template segment<hub_pose_values>(at_hub));
  const elements::RootPose<T> root = root_pose_of<T>(x.template segment<root_pose_values>(at_root));
  const elements::StationMotion<T> motion = motion_at<T>(p, x, t, &change);
  const elements::StationAir<T> present =
      elements::station_air<T>(rotor, station, motion, x.template segment<air::unknowns>(at_air),
                               x.template segment<rate_count>(at_rates));
  const elements::SectionFlow<T>& flow = present.flow;
  const Vec3<T> force = root.axes * Vec3<T>(x.template segment<3>(at_air + air::force));
  const Vec3<T> moment = root.axes * Vec3<T>(x.template segment<3>(at_air + air::moment));
  const Vec3<T> place = place_of<T>(station, x.template head<3>(), root);
  const Vec3<T> arm = place - hub.place;
  const Vec3<T> outward = arm - hub.axis * dot(arm, hub.axis);
  const Mat3<T> section = root.axes * motion.R;
  const Vec3<T> edge =
      section * Vec3<T>(T(0.0), T(std::cos(station.twist)), T(-std::sin(station.twist)));
  const Vec3<T> suction =
      section * Vec3<T>(T(0.0), T(std::sin(station.twist)), T(std::cos(station.twist)));
  AirPointReport<T> report;
  report.radius = sqrt(dot(outward, outward));
  const Vec3<T> e_t = cross(hub.axis, outward) / report.radius;
  const Vec3<T> relative = section * Vec3<T>(motion.relative + motion.axial * present.induced_n +
                                             motion.tangential * present.induced_t);
  report.angle = air::angle_of(flow, flow.n);
  report.inflow_angle = math::arctangent(T(dot(relative, hub.axis)), T(-dot(relative, e_t)));
  report.speed = flow.speed;
  report.pressure = flow.speed * flow.speed * T(0.5 * rotor.density);
  report.wind =
      dot(Vec3<T>(rotor.wind.undisturbed_at<T>(place, t, &change) - hub.velocity), hub.axis);
  report.hub_speed = hub.speed;
  report.hub_place = hub.place;
  const auto share_of = [&](const T& induced, const T& whole) {
    return -(induced * whole) / (whole * whole + T(rotor.least_speed * rotor.least_speed));
  };
  report.induced_n = present.induced_n;
  report.induced_t = present.induced_t;
  report.axial = share_of(present.induced_n, report.wind);
  report.tangential = share_of(present.induced_t, T(hub.speed * report.radius));
  report.lift = present.coefficients.lift;
  report.drag = present.coefficients.drag;
  report.moment = present.coefficients.moment;
  report.normal = dot(force, suction);
  report.chordwise = dot(force, edge);
  report.thrust = dot(force, hub.axis);
  report.driving = dot(force, e_t);
  Mat3<T> axes;  // h1 h2 h3
  axes.col(0) = x.template segment<3>(at_hub + 3);
  axes.col(1) = hub.axis;
  axes.col(2) = cross(Vec3<T>(axes.col(0)), Vec3<T>(axes.col(1)));
  report.place = place;
  report.force = force;
  report.couple = moment;
  report.section_axes = section;
  report.hub_axes = axes;
  report.hub_load << axes.transpose() * force,
      axes.transpose() * Vec3<T>(cross(arm, force) + moment);
  return report;
}

template <class T>
std::vector<AirPointReport<T>> BladeAir::report(const Residual<T>& residual) const {
  std::vector<AirPointReport<T>> reports;
  for (std::size_t p = 0; p < points_.size(); ++p)
    reports.push_back(report_at<T>(static_cast<int>(p),
                                   residual.template gather<arguments>(points_[p]), residual.time(),
                                   residual.inputs().wind));
  return reports;
}

template std::vector<AirPointReport<double>> BladeAir::report(const Residual<double>&) const;
template std::vector<AirPointReport<std::complex<double>>> BladeAir::report(
    const Residual<std::complex<double>>&) const;

void BladeAir::settle(const Residual<double>& residual, std::vector<double>& values) const {
  for (int p = 0; p < blade_.placed().beam->point_count(); ++p) {
    const auto x = residual.gather<arguments>(points_[at(p)]);
    const Eigen::Matrix<double, air::unknowns, 1> steady =
        elements::steady_air(air().rotor, station(p), motion_at<double>(p, x, residual.time()));
    for (const Share& share : points_[at(p)].shares) values[at(share.row)] = steady(share.value);
  }
}

void BladeAir::require_admissible(const Residual<double>& residual) const {
  for (int p = 0; p < blade_.placed().beam->point_count(); ++p) {
    const auto x = residual.gather<arguments>(points_[at(p)]);
    const elements::RootPose<double> root =
        root_pose_of<double>(x.segment<root_pose_values>(at_root));
    air().rotor.wind.tower.require_outside(place_of<double>(station(p), x.head<3>(), root),
                                           "blade " + std::to_string(k_ + 1));
  }
}

template class Stated<BladeAir>;

}  // namespace samara::components
