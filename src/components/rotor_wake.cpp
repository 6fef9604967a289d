#include "samara/components/rotor_wake.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "samara/base/index.hpp"
#include "samara/components/blade_air.hpp"
#include "samara/elements/air_station.hpp"

namespace samara::components {
namespace {

namespace air = elements::air;
using elements::WakeShape;

constexpr int parts_of_block = 9;
/// A rotor whose axis is nearer to the vertical than this counts its azimuth from -n2.
constexpr double steep = 0.7;

/// Axes of the disk, components n1 n2 n3.
template <class T>
struct Disk {
  Vec3<T> e1, e2, n;
};

template <class T>
Disk<T> disk_of(const Vector3& upward, const Vec3<T>& axis) {
  using math::dot;
  using std::sqrt;
  T along(0.0);  // the axis
  for (int i = 0; i < 3; ++i) along += axis(i) * T(upward(i));
  const Vec3<T> inside = upward.cast<T>() - axis * along;
  const Vec3<T> e1 = inside / T(sqrt(dot(inside, inside)));
  return {e1, math::cross(axis, e1), axis};
}

}  // namespace

RotorWake::RotorWake(const model::Turbine& turbine, std::vector<const Beam*> blades, int rank)
    : turbine_(turbine),
      blades_(std::move(blades)),
      rank_(rank),
      upward_(std::abs(std::sin(turbine.chain.tilt)) < steep ? Vector3::UnitZ().eval()
                                                             : (-Vector3::UnitY()).eval()),
      shapes_(elements::make_wake_shapes(turbine.air->rotor.models.wake_shapes)) {
  int count = 0;
  for (const WakeShape& shape : shapes_) {
    first_of_shape_.push_back(count);
    count += shape.parts();
  }
  first_of_shape_.push_back(count);
}

void RotorWake::tie(int hub_port, const std::vector<int>& root_ports) {
  hub_port_ = hub_port;
  root_ports_ = root_ports;
}

void RotorWake::place(Registry& registry) {
  blocks_.clear();
  for (int left = first_of_shape_.back(); left > 0; left -= parts_of_block)
    blocks_.push_back(registry.add_shared(rank_, 2 * std::min(left, parts_of_block)));
  flow_port_ = registry.add_port(flow_values);
}

int RotorWake::part(std::size_t shape, int sine) const {
  const int number = first_of_shape_[shape] + sine;
  return blocks_[at(number / parts_of_block)] + 2 * (number % parts_of_block);
}

Argument RotorWake::part_or_zero(std::size_t shape, int sine, bool is_auxiliary,
                                 bool is_rate) const {
  if (sine >= shapes_[shape].parts()) return zeros(1);
  const int unknown = part(shape, sine) + (is_auxiliary ? 1 : 0);
  return is_rate ? rates(unknown, 1) : unknowns(unknown, 1);
}

void RotorWake::describe_part(Registry& registry, std::size_t shape, int sine) {
  using system::Frame;
  using system::RowRole;
  using system::UnknownRole;
  const system::Owner owner(system::PartKind::medium, "inflow");
  const std::string place = "harmonic " + std::to_string(shapes_[shape].harmonic);
  const std::string order = std::to_string(shapes_[shape].order);
  const double scale = usual_induced_velocity(turbine_);
  const int first = part(shape, sine);
  registry.describe(first,
                    {owner, place, (sine == 0 ? "alpha" : "beta") + order, "m/s",
                     UnknownRole::state, Frame::fixed, false, scale},
                    RowRole::evolution);
  registry.describe(first + 1,
                    {owner, place, (sine == 0 ? "t_c" : "t_s") + order, "m/s",
                     UnknownRole::auxiliary, Frame::fixed, false, scale},
                    RowRole::definition);
  linear_.push_back({first + 1, first, 1, 1.0});
}

void RotorWake::describe(Registry& registry) {
  flow_.arguments = {port_values(hub_port_, hub_pose_values), part_or_zero(0, 0, true)};
  flow_.provisions = {{flow_port_, 0}};
  for (std::size_t row = 0; row < shapes_.size(); ++row) {
    Connections evolution;
    evolution.arguments = {port_values(flow_port_, flow_values), part_or_zero(row, 0, true),
                           part_or_zero(row, 1, true), part_or_zero(row, 0, false, true),
                           part_or_zero(row, 1, false, true)};
    for (int sine = 0; sine < shapes_[row].parts(); ++sine) {
      describe_part(registry, row, sine);
      evolution.shares.push_back({part(row, sine), 1, sine});
    }
    evolutions_.push_back(evolution);
    for (std::size_t column = 0; column < shapes_.size(); ++column) {
      const double gain = elements::wake_coupling(shapes_[row], shapes_[column]);
      if (gain == 0.0) continue;
      Coupling coupling{row, column, {}};
      coupling.connections.arguments = {port_values(flow_port_, flow_values),
                                        part_or_zero(column, 0, true),
                                        part_or_zero(column, 1, true)};
      for (int sine = 0; sine < shapes_[row].parts(); ++sine)
        coupling.connections.shares.push_back({part(row, sine) + 1, 1, sine, -gain});
      couplings_.push_back(coupling);
    }
  }
  connect_points();
}

void RotorWake::connect_points() {
  for (std::size_t k = 0; k < blades_.size(); ++k) {
    const PlacedBeam& placed = blades_[k]->placed();
    for (int p = 0; p < placed.beam->point_count(); ++p)
      for (std::size_t first = 0; first < shapes_.size(); first += batch) {
        PointBatch point{k, p, first, {}};
        Connections& connections = point.connections;
        connections.arguments = {
            unknowns(placed.points[at(p)], 3), unknowns(placed.air[at(p)] + air::force, 3),
            port_values(root_ports_[k], root_pose_values), port_values(hub_port_, hub_pose_values)};
        for (std::size_t i = 0; i < static_cast<std::size_t>(batch); ++i) {
          const std::size_t shape = first + i;
          if (shape >= shapes_.size()) {
            connections.arguments.push_back(zeros(2));
            continue;
          }
          for (int sine = 0; sine < 2; ++sine) {
            connections.arguments.push_back(part_or_zero(shape, sine, false));
            if (sine < shapes_[shape].parts())
              connections.shares.push_back(
                  {part(shape, sine), 1, 2 * static_cast<int>(i) + sine, -1.0});
          }
        }
        connections.shares.push_back({placed.air[at(p)] + air::induced, 1, 2 * batch});
        points_.push_back(point);
      }
  }
}

/// Wind against the apex, along e1, e2 and n.
template <class T>
Vec3<T> RotorWake::wind_at(const Eigen::Matrix<T, flow_arguments, 1>& x, double t,
                           const elements::WindInputs<T>* change) const {
  using math::dot;
  const elements::HubPose<T> hub = hub_pose_of<T>(x.template head<hub_pose_values>());
  const Vec3<T> wind = rotor().wind.undisturbed_at<T>(hub.place, t, change) - hub.velocity;
  const Disk<T> disk = disk_of<T>(upward_, hub.axis);
  return Vec3<T>(dot(wind, disk.e1), dot(wind, disk.e2), dot(wind, disk.n));
}

/// The load of a point on the shapes and their velocity there.
template <class T>
auto RotorWake::point_terms(const PointBatch& point, const Eigen::Matrix<T, point_arguments, 1>& x,
                            double t, const elements::WindInputs<T>* change) const
    -> Eigen::Matrix<T, point_values, 1> {
  using math::dot;
  const elements::RootPose<T> root = root_pose_of<T>(x.template segment<root_pose_values>(at_root));
  const elements::HubPose<T> hub = hub_pose_of<T>(x.template segment<hub_pose_values>(at_hub));
  const Vec3<T> local =
      blades_[point.blade]->placed().beam->points[at(point.point)].x.template cast<T>() +
      Vec3<T>(x.template head<3>());
  const Vec3<T> arm = root.place + root.axes * local - hub.place;
  const Disk<T> disk = disk_of<T>(upward_, hub.axis);
  const double radius = rotor().tip_radius;
  const T x1 = dot(arm, disk.e1) / T(radius);
  const T x2 = dot(arm, disk.e2) / T(radius);
  const double length = blades_[point.blade]->placed().beam->point_length(point.point);
  const Vec3<T> wind = rotor().wind.undisturbed_at<T>(hub.place, t, change) - hub.velocity;
  const T share_of_disk = elements::disk_share<T>(rotor(), hub.speed, dot(wind, wind));
  const T thrust =
      share_of_disk * dot(Vec3<T>(root.axes * Vec3<T>(x.template segment<3>(at_force))), disk.n);
  // Half of tau.
  const double factor = 0.5 * length / (std::numbers::pi * rotor().density * radius * radius);
  Eigen::Matrix<T, point_values, 1> y = Eigen::Matrix<T, point_values, 1>::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(batch); ++i) {
    const std::size_t number = point.first_shape + i;
    if (number >= shapes_.size()) break;
    const WakeShape& shape = shapes_[number];
    const auto at_point = elements::wake_shape_at<T>(shape, x1, x2);
    const double share = shape.harmonic == 0 ? 0.5 * factor : factor;
    for (int sine = 0; sine < shape.parts(); ++sine) {
      const int place_of_part = 2 * static_cast<int>(i) + sine;
      y(place_of_part) = at_point[at(sine)] * thrust * T(share);
      y(2 * batch) += at_point[at(sine)] * x(at_states + place_of_part);
    }
  }
  return y;
}

template <class System>
void RotorWake::state(System& system) const {
  system.add(linear_);
  const double t = system.time();
  const Memory memory = rotor().wind.changing ? Memory::none : Memory::of_arguments;
  const auto flow_of = [&]<class T>(const Eigen::Matrix<T, flow_arguments, 1>& x) {
    const elements::DiskFlow<T> flow = elements::disk_flow<T>(
        wind_at<T>(x, t, wind_inputs<T>(system)), x(hub_pose_values), rotor().least_speed);
    return Eigen::Matrix<T, flow_values, 1>(flow.z1, flow.z2, flow.speed, flow.carrying);
  };
  system.template add<flow_arguments, flow_values>(flow_, flow_of, memory);
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    const bool is_mean = i == 0;  // the uniform load
    const double mass = rotor().tip_radius * shapes_[i].mass();
    const auto rows_of = [&]<class T>(const Eigen::Matrix<T, evolution_arguments, 1>& x) {
      const T& speed = x(is_mean ? 2 : 3);
      return Eigen::Matrix<T, 2, 1>(x(flow_values + 2) * T(mass) + speed * x(flow_values),
                                    x(flow_values + 3) * T(mass) + speed * x(flow_values + 1));
    };
    system.template add<evolution_arguments, 2>(evolutions_[i], rows_of, Memory::of_arguments);
  }
  for (const Coupling& coupling : couplings_) {
    const auto terms_of = [&]<class T>(const Eigen::Matrix<T, coupling_arguments, 1>& x) {
      const auto terms = elements::wake_coupling_terms<T>(shapes_[coupling.row].harmonic,
                                                          shapes_[coupling.column].harmonic, x(0),
                                                          x(1), x(flow_values), x(flow_values + 1));
      return Eigen::Matrix<T, 2, 1>(terms[0], terms[1]);
    };
    system.template add<coupling_arguments, 2>(coupling.connections, terms_of,
                                               Memory::of_arguments);
  }
  for (const PointBatch& point : points_) {
    const auto terms_of = [&]<class T>(const Eigen::Matrix<T, point_arguments, 1>& x) {
      return point_terms<T>(point, x, t, wind_inputs<T>(system));
    };
    system.template add<point_arguments, point_values>(point.connections, terms_of, memory);
  }
}

elements::DiskFlow<double> RotorWake::flow(const Residual<double>& residual) const {
  const auto x = residual.gather<flow_arguments>(flow_);
  return elements::disk_flow<double>(wind_at<double>(x, residual.time(), nullptr),
                                     x(hub_pose_values), rotor().least_speed);
}

void RotorWake::settle(const Residual<double>& residual, std::vector<double>& values) const {
  // The loads in `values` are those of the settled points; the poses are those of the residual.
  Eigen::VectorXd load = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(shapes_.size()));
  const auto arguments_of = [&](const PointBatch& point) {
    auto x = residual.gather<point_arguments>(point.connections);
    const int force = blades_[point.blade]->placed().air[at(point.point)] + air::force;
    for (int i = 0; i < 3; ++i) x(at_force + i) = values[at(force + i)];
    return x;
  };
  for (const PointBatch& point : points_) {
    const auto y = point_terms<double>(point, arguments_of(point), residual.time(), nullptr);
    for (int i = 0; i < batch; ++i) {
      const std::size_t shape = point.first_shape + at(i);
      if (shape < shapes_.size() && shapes_[shape].harmonic == 0)
        load(static_cast<Eigen::Index>(shape)) += y(2 * i);
    }
  }
  const auto x = residual.gather<flow_arguments>(flow_);
  const Vector3 wind = wind_at<double>(x, residual.time(), nullptr);
  Eigen::VectorXd t = Eigen::VectorXd::Zero(load.size());
  t(0) = elements::find_steady_wake(wind, load(0), rotor().least_speed).t;
  const double carrying = elements::disk_flow<double>(wind, t(0), rotor().least_speed).carrying;
  for (Eigen::Index i = 1; i < t.size(); ++i) t(i) = load(i) / carrying;
  for (std::size_t row = 0; row < shapes_.size(); ++row) {
    for (int sine = 0; sine < shapes_[row].parts(); ++sine)
      values[at(part(row, sine))] = values[at(part(row, sine) + 1)] = 0.0;
    if (shapes_[row].harmonic > 0) continue;
    values[at(part(row, 0) + 1)] = t(static_cast<Eigen::Index>(row));
    for (std::size_t column = 0; column < shapes_.size(); ++column)
      if (shapes_[column].harmonic == 0)
        values[at(part(row, 0))] += elements::wake_coupling(shapes_[row], shapes_[column]) *
                                    t(static_cast<Eigen::Index>(column));
  }
  for (const PointBatch& point : points_) {
    auto arguments = arguments_of(point);
    for (std::size_t i = 0; i < static_cast<std::size_t>(batch); ++i) {
      const std::size_t shape = point.first_shape + i;
      for (int sine = 0; sine < 2; ++sine)
        arguments(at_states + 2 * static_cast<int>(i) + sine) =
            shape < shapes_.size() && sine < shapes_[shape].parts() ? values[at(part(shape, sine))]
                                                                    : 0.0;
    }
    const int row = blades_[point.blade]->placed().air[at(point.point)] + air::induced;
    if (point.first_shape == 0) values[at(row)] = 0.0;
    values[at(row)] -= point_terms<double>(point, arguments, residual.time(), nullptr)(2 * batch);
  }
}

template class Stated<RotorWake>;

}  // namespace samara::components
