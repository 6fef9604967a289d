#include "samara/components/mass_damper.hpp"

#include <array>

#include "samara/base/index.hpp"
#include "samara/components/prescribed_motion.hpp"
#include "samara/components/tower_axes.hpp"
#include "samara/elements/torque_laws.hpp"

namespace samara::components {
namespace {

using Carrier = model::MassDamperDefinition::Carrier;
using elements::FrameMotion;
using system::PartKind;

}  // namespace

// ---- declaration -------------------------------------------------------------------------------

MassDamper::MassDamper(const MassDamperSetting& setting) : setting_(setting) {}

void MassDamper::place(Registry& registry) {
  first_ = registry.add_shared(setting_.shared_rank, 2 * static_cast<int>(axis_count()));
}

/// First unknown of the node that carries the damper.
int MassDamper::node() const {
  const PlacedBeam& placed = setting_.beam->placed();
  const int number = setting_.damper->node;
  return number < 0 ? placed.tip : placed.masses[at(number)];
}

system::Owner MassDamper::owner() const {
  const model::MassDamper& damper = *setting_.damper;
  const std::array<const char*, 3> carriers{"tower", "nacelle", "blade"};
  std::string part = carriers[static_cast<std::size_t>(damper.definition.carrier)];
  part += " mass damper";
  if (damper.number > 1) part += " (" + std::to_string(damper.number) + ")";
  return {PartKind::body, part, damper.blade + 1};
}

system::Frame MassDamper::frame() const {
  return setting_.damper->blade < 0 ? system::Frame::fixed : system::Frame::rotating;
}

std::string MassDamper::direction(std::size_t i) const {
  const std::array<std::array<const char*, 3>, 3> names{{{"vertical", "side-side", "fore-aft"},
                                                         {"side-side", "fore-aft", "vertical"},
                                                         {"axial", "lead-lag", "flap"}}};
  return names[static_cast<std::size_t>(definition().carrier)][at(definition().axes[i].axis)];
}

void MassDamper::describe(Registry& registry) {
  for (std::size_t i = 0; i < axis_count(); ++i) {
    describe_axis(registry, i);
    describe_channels(registry, i);
  }
  describe_mass(registry);
  connect();
}

void MassDamper::describe_axis(Registry& registry, std::size_t i) const {
  const model::MassDamperAxis& axis = definition().axes[i];
  const std::string way = direction(i);
  const int q = first(i);
  registry.describe(q, {owner(), way, "displacement", "m", system::UnknownRole::position, frame()},
                    system::RowRole::kinematic);
  registry.describe(q + 1, {owner(), way, "speed", "m/s", system::UnknownRole::velocity, frame()},
                    system::RowRole::balance);
  registry.add(system::Motion{owner(), way, false, {q}, {definition().mass}});
  registry.add(system::EnergyGroup{system::EnergyGroup::Kind::strain,
                                   owner(),
                                   way,
                                   frame(),
                                   {q},
                                   {axis.stiffness},
                                   axis.damping / axis.stiffness});
}

/// Channel names follow OpenFAST's structural control, along its x y z.
void MassDamper::describe_channels(Registry& registry, std::size_t i) const {
  const model::MassDamper& damper = *setting_.damper;
  // OpenFAST's x y z in b1 b2 b3 and in y1 y2 y3: downwind, side-side against the second axis, up.
  struct Along {
    char letter;
    double sign;
  };
  constexpr std::array<Along, 3> of_beam{{{'Z', 1.0}, {'Y', -1.0}, {'X', 1.0}}};
  constexpr std::array<Along, 3> of_nacelle{{{'Y', -1.0}, {'X', 1.0}, {'Z', 1.0}}};
  const int number = damper.definition.axes[i].axis;
  const Along along = damper.is_on_nacelle() ? of_nacelle[at(number)] : of_beam[at(number)];
  std::string name = std::string(1, "TNB"[static_cast<int>(damper.definition.carrier)]) + "StC" +
                     std::to_string(damper.number) + "_";
  if (damper.blade >= 0) name += "B" + std::to_string(damper.blade + 1) + "_";
  const std::string place = damper.blade < 0
                                ? damper.is_on_nacelle() ? "nacelle" : "tower section"
                                : "blade " + std::to_string(damper.blade + 1) + ", section";
  const std::string words = owner().name() + ", " + direction(i);
  registry.add(Channel{name + along.letter + "Q", "m", place, words + ", displacement", first(i),
                       along.sign});
  registry.add(Channel{name + along.letter + "QD", "m/s", place, words + ", speed", first(i) + 1,
                       along.sign});
}

/// Kinetic energy in the velocities of the node and of the damper, at the mean of a prescribed yaw.
void MassDamper::describe_mass(Registry& registry) const {
  const model::MassDamper& damper = *setting_.damper;
  const int first_velocity = node() + 6;
  system::EnergyGroup group{system::EnergyGroup::Kind::kinetic, owner(), "", frame(), {}, {}};
  Matrix3 turned = Matrix3::Identity();
  if (damper.is_on_nacelle()) {  // V = (U6 U7 U8), omega = (U3 U4 U1)
    turned = math::turn_about<double>(Vector3::UnitZ(), setting_.turbine->yaw_motion.angle);
    for (const int i : {1, 2, 0, 4, 5}) group.unknowns.push_back(first_velocity + i);
    group.unknowns.push_back(yaw_ + 1);
  } else {
    for (int i = 0; i < 6; ++i) group.unknowns.push_back(first_velocity + i);
  }
  const auto columns = static_cast<Eigen::Index>(6 + axis_count());
  Eigen::MatrixXd velocity = Eigen::MatrixXd::Zero(3, columns);
  velocity.leftCols<3>().setIdentity();
  velocity.middleCols<3>(3) = -math::skew<double>(Vector3(turned * damper.place));
  for (std::size_t i = 0; i < axis_count(); ++i) {
    velocity.col(static_cast<Eigen::Index>(6 + i)) = turned * damper.axis(i);
    group.unknowns.push_back(first(i) + 1);
  }
  const Eigen::MatrixXd weight = damper.definition.mass * velocity.transpose() * velocity;
  group.weight.assign(weight.data(), weight.data() + weight.size());
  registry.add(group);
}

bool MassDamper::is_conservative() const {
  for (const model::MassDamperAxis& axis : definition().axes)
    if (axis.damping != 0.0 || axis.stop_damping != 0.0) return false;
  return true;
}

void MassDamper::connect() {
  const model::MassDamper& damper = *setting_.damper;
  const int first_of_node = node();
  connections_.arguments = {unknowns(first_of_node + 3, 3), unknowns(first_of_node + 6, 6),
                            rates(first_of_node + 6, 6),
                            port_values(setting_.beam->placed().root_port, 9)};
  if (damper.is_on_nacelle()) {
    connections_.arguments.push_back(unknowns(yaw_, 2));
    connections_.arguments.push_back(rates(yaw_ + 1, 1));
  } else {
    connections_.arguments.push_back(zeros(3));
  }
  for (std::size_t i = 0; i < axis_count(); ++i) {
    connections_.arguments.push_back(unknowns(first(i), 2));
    connections_.arguments.push_back(rates(first(i), 2));
    connections_.shares.push_back({first(i), 2, 2 * static_cast<int>(i)});
  }
  if (axis_count() < most_axes) connections_.arguments.push_back(zeros(4));
  // The balance of a beam's node contains the inertial load of the mass; that of bodies contains
  // the load on the bodies.
  const double weight = is_on_bodies() ? 1.0 : -1.0;
  connections_.shares.push_back({first_of_node + 12, 3, node_force, weight});
  connections_.shares.push_back({first_of_node + 15, 3, node_moment, weight});
  if (damper.is_on_nacelle() && setting_.turbine->chain.yaw.free)
    connections_.shares.push_back({yaw_ + 1, 1, yaw_row});
}

// ---- equations ---------------------------------------------------------------------------------

/// `R`: components in the axes of the beam's root from those of the node.
template <class T>
FrameMotion<T> MassDamper::node_motion(const Eigen::Matrix<T, arguments, 1>& x,
                                       const Mat3<T>& R) const {
  FrameMotion<T> node;
  node.v = x.template segment<3>(at_velocity);
  node.omega = x.template segment<3>(at_velocity + 3);
  node.alpha = x.template segment<3>(at_velocity_dot + 3);
  node.a = x.template segment<3>(at_velocity_dot);
  node.a += math::cross(node.omega, node.v);
  node.gravity = R.transpose() * x.template segment<3>(at_root + 6);
  return node;
}

/// `top`: motion of the tower's end, in t1 t2 t3. `turn`: components in the nacelle from t1 t2 t3.
template <class T, class System>
FrameMotion<T> MassDamper::nacelle_motion(const System& system,
                                          const Eigen::Matrix<T, arguments, 1>& x,
                                          const FrameMotion<T>& top, Mat3<T>& turn) const {
  const model::Turbine& turbine = *setting_.turbine;
  const Vec3<T> axis = Vector3::UnitZ().cast<T>();
  if (turbine.chain.yaw.free) {
    turn = math::turn_about<T>(Vector3::UnitZ(), x(at_yaw)).transpose();
    const T& speed = x(at_yaw + 1);
    const T& speed_dot = x(at_yaw + 2);
    return elements::detail::with_outer_speed<T>(axis, speed, speed_dot,
                                                 elements::detail::seen_from<T>(turn, top));
  }
  const elements::JointMotion now = prescribed_yaw(system, turbine);
  turn = math::turn_about<T>(Vector3::UnitZ(), T(now.angle)).transpose();
  return elements::detail::with_relative_rate<T>(axis, now.rate, now.acceleration,
                                                 elements::detail::seen_from<T>(turn, top));
}

template <class System>
void MassDamper::state(System& system) const {
  const model::MassDamper& damper = *setting_.damper;
  const model::Beam& beam = *setting_.beam->placed().beam;
  const double mass = damper.definition.mass;
  const Matrix3 reference = is_on_bodies() ? Matrix3(Matrix3::Identity())
                            : damper.node < 0
                                ? beam.reference(beam.elements - 1)
                                : beam.reference_before(beam.mass_nodes[at(damper.node)].end);
  const auto rows_of = [&]<class T>(const Eigen::Matrix<T, arguments, 1>& x) {
    const Mat3<T> R =
        math::direction_cosines<T>(x.template head<3>()).transpose() * reference.template cast<T>();
    FrameMotion<T> carrier = node_motion<T>(x, R);
    Mat3<T> turn;
    if (damper.is_on_nacelle()) {
      for (Vec3<T>* vector :
           {&carrier.omega, &carrier.alpha, &carrier.v, &carrier.a, &carrier.gravity})
        *vector = from_beam_order<T>(*vector);
      carrier = nacelle_motion<T>(system, x, carrier, turn);
    }
    Vec3<T> r = damper.place.template cast<T>();
    Vec3<T> velocity = Vec3<T>::Zero();  // relative to the carrier
    Vec3<T> acceleration = Vec3<T>::Zero();
    for (std::size_t i = 0; i < axis_count(); ++i) {
      const Vec3<T> axis = damper.axis(i).template cast<T>();
      const int own = at_axes + 4 * static_cast<int>(i);
      r += axis * x(own);
      velocity += axis * x(own + 1);
      acceleration += axis * x(own + 3);
    }
    const FrameMotion<T> there = elements::detail::moved_to<T>(r, carrier);
    const Vec3<T> coriolis = math::cross(carrier.omega, velocity);
    const Vec3<T> force = (there.gravity - there.a - acceleration - coriolis * T(2.0)) * T(mass);
    Eigen::Matrix<T, values, 1> y = Eigen::Matrix<T, values, 1>::Zero();
    for (std::size_t i = 0; i < axis_count(); ++i) {
      const model::MassDamperAxis& law = damper.definition.axes[i];
      const Vec3<T> axis = damper.axis(i).template cast<T>();
      const int own = at_axes + 4 * static_cast<int>(i);
      const int row = 2 * static_cast<int>(i);
      const T& q = x(own);
      const T& speed = x(own + 1);
      y(row) = x(own + 2) - speed;
      y(row + 1) = math::dot(axis, force) - q * law.stiffness - speed * law.damping;
      if (law.stop > 0.0)
        y(row + 1) += elements::torque_of<T>(
            elements::StopTorque(law.stop, law.stop_stiffness, law.stop_damping), q, speed);
    }
    Vec3<T> on_node = force;
    Vec3<T> moment = math::cross(r, force);
    if (damper.is_on_nacelle()) {
      const Vec3<T> axis = Vector3::UnitZ().cast<T>();
      if (setting_.turbine->chain.yaw.free) {
        y(yaw_row) = moment(2);
        moment = elements::detail::across<T>(axis, moment);
      }
      on_node = to_beam_order<T>(Vec3<T>(turn.transpose() * on_node));
      moment = to_beam_order<T>(Vec3<T>(turn.transpose() * moment));
    } else if (!is_on_bodies()) {
      on_node = (R * on_node).eval();
      moment = (R * moment).eval();
    }
    y.template segment<3>(node_force) = on_node;
    y.template segment<3>(node_moment) = moment;
    return y;
  };
  system.template add<arguments, values>(connections_, rows_of);
}

template class Stated<MassDamper>;

}  // namespace samara::components
