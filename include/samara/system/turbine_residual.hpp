// The residual of a whole turbine, templated on the scalar: beams in their places and the rigid
// chain between them. Everything that assembles or checks a turbine builds on this.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "samara/base/error.hpp"
#include "samara/elements/beam_drag.hpp"
#include "samara/elements/beam_load.hpp"
#include "samara/elements/beam_tip.hpp"
#include "samara/elements/rigid_chain.hpp"
#include "samara/model/layout.hpp"
#include "samara/model/turbine.hpp"

namespace samara::system {

/// Where the rotations of two neighbours count from different references: the start of an element,
/// whose balance of curvature asks for the rotation of what is before it, expressed anew.
struct ReferenceChange {
  int element = 0;
  int row = 0;                     ///< of the balance
  int mass = -1;                   ///< first unknown of the mass node before it; -1: none
  Vector3 turn = Vector3::Zero();  ///< reference before it, as seen from the one behind it
};

/// A beam in its place: where its unknowns are and what carries it.
struct PlacedBeam {
  const model::Beam* beam = nullptr;
  std::vector<int> points;  ///< first unknown of each point
  std::vector<int> masses;  ///< first unknown of each mass node
  int tip = 0;
  int root = 0;  ///< first of F_hat_0, M_hat_0
  std::vector<ReferenceChange> changes;
  Vector3 end_reference = Vector3::Zero();  ///< parameters of that of the tip
  int blade = -1;                           ///< from 0; -1: the tower
  Vector3 position = Vector3::Zero();       ///< root from the apex, in H
  Matrix3 C_Ha = Matrix3::Identity();

  bool on_hub() const { return blade >= 0; }

  /// v_a, omega_a, gravity of a blade root from the hub's motion, at the pitch of C_Ha: constant
  /// and linear.
  Eigen::Matrix<double, 9, 9> root_from_hub() const;

  /// Force and moment about the apex in H of a blade's root load, at that pitch.
  Matrix6 hub_from_root() const;

  /// First row of the strain and curvature balance of local node a of the element of point p. A
  /// mass node has a balance of its own for the element before it.
  int strain_rows(int p, int a) const;
  /// First row of the force and moment balance. A mass node has one for the element behind it.
  int force_rows(int p, int a) const;
  /// Weights of point p in the balances of local node a: w N_a' and w L N_a.
  std::array<double, 2> node_weights(int a, int p) const;
  /// The mass node at end e of the elements, -1 where there is none.
  int mass_at(int e) const;

  /// First row of the force and moment balance of the root: its own, or that of the mass between
  /// the beam and the springs of its support.
  int root_rows() const { return force_rows(0, 0); }
};

/// How a blade's axes a have turned about -b1 from those that C_Ha states.
template <class T>
struct BladePitch {
  bool moves = false;  ///< false: they have not, and do not
  T angle = T(0);      ///< [rad]
  T rate = T(0);       ///< [rad/s]

  /// Components in the axes that C_Ha states from those in the turned ones.
  Mat3<T> feather() const { return math::turn_about<T>(-Vector3::UnitX(), angle); }
};

/// What acts on a turbine from outside beside its loads (docs/theory.md, section 10).
template <class T>
struct TurbineInputs {
  std::vector<T> pitch;       ///< of each blade beside its own, toward feather [rad]; empty: none
  std::vector<T> pitch_rate;  ///< [rad/s], as many
  T generator_torque = T(0);  ///< against the turning, on a free generator [N m]
  T yaw_torque = T(0);        ///< of the tower top on a free nacelle, about y3 [N m]
  Vec3<T> top_force = Vec3<T>::Zero();      ///< on the tower top along n1 n2 n3 [N]
  Vec3<T> base_velocity = Vec3<T>::Zero();  ///< of the tower's foot along n1 n2 n3 [m/s]
  Vec3<T> base_turn = Vec3<T>::Zero();      ///< of the tower's foot about n1 n2 n3, small [rad]
  Vec3<T> base_rate = Vec3<T>::Zero();      ///< of these angles [rad/s]

  /// Components in the axes of the tower's foot, in their order (n3, n1, n2), of what has the
  /// components `ground` in them where the foot is not turned.
  Vec3<T> at_foot(const Vec3<T>& ground) const {
    return math::turn_about<T>(Vector3::UnitX(), base_turn(2)).transpose() *
           (math::turn_about<T>(Vector3::UnitZ(), base_turn(1)).transpose() *
            (math::turn_about<T>(Vector3::UnitY(), base_turn(0)).transpose() * ground));
  }
  Vec3<T> up() const { return at_foot(Vec3<T>::UnitX()); }
};

// Inputs of the rigid chain, in this order.
inline constexpr int at_theta = 0;
inline constexpr int at_top_velocity = 3;
inline constexpr int at_joints = 9;  // q_y, U1, q_h, U2, q_s, U_s, q_g, U_g
inline constexpr int joint_unknowns = 8;
inline constexpr int at_top_velocity_dot = at_joints + joint_unknowns;
inline constexpr int at_joint_rates = at_top_velocity_dot + 6;  // in the order of the joints
inline constexpr int at_top_load = at_joint_rates + joint_unknowns;
inline constexpr int at_hub_load = at_top_load + 6;
inline constexpr int chain_inputs = at_hub_load + 6;
inline constexpr int chain_motion_inputs = at_top_velocity_dot;  // of the hub's motion

class TurbineResidual {
 public:
  static constexpr int block = model::Layout::block;
  template <class T>
  using State = Eigen::Matrix<T, block, 1>;

  explicit TurbineResidual(const model::Turbine& turbine);
  TurbineResidual(const TurbineResidual&) = delete;
  TurbineResidual& operator=(const TurbineResidual&) = delete;

  const model::Turbine& turbine() const { return turbine_; }
  const model::Layout& layout() const { return layout_; }
  const std::vector<PlacedBeam>& beams() const { return beams_; }

  /// r(t, z, z_dot), all of layout().size(). T: double, or std::complex<double> to differentiate
  /// by a complex step. @throws DomainError where a rotation is out of range.
  template <class T>
  void evaluate(double t, const std::vector<T>& z, const std::vector<T>& z_dot,
                std::vector<T>& r) const {
    evaluate(t, z, z_dot, TurbineInputs<T>(), r);
  }

  /// r(t, z, z_dot, u, u_dot)
  template <class T>
  void evaluate(double t, const std::vector<T>& z, const std::vector<T>& z_dot,
                const TurbineInputs<T>& inputs, std::vector<T>& r) const;

  template <class T>
  static State<T> at(const std::vector<T>& z, int first) {
    return Eigen::Map<const State<T>>(z.data() + first);
  }

  /// The chain's state with each input passed through `make(value, index)`.
  template <class T, class Value, class Make>
  elements::ChainState<T> chain_state(double t, const std::vector<Value>& z,
                                      const std::vector<Value>& z_dot, Make make,
                                      const TurbineInputs<Value>& inputs = {}) const;

  /// The unknown behind input i of the chain, or behind its rate; -1 where there is none: without a
  /// tower, and for the sum of the blades' loads.
  int chain_unknown(int i) const;

  /// The motion of a beam's root and the gravity there.
  template <class T>
  elements::Attachment<T> attachment(const PlacedBeam& placed, const elements::HubMotion<T>& hub,
                                     double t, const TurbineInputs<T>& inputs = {}) const;

  /// By the turbine's operation and by inputs together.
  template <class T>
  BladePitch<T> pitch_of(const PlacedBeam& placed, double t,
                         const TurbineInputs<T>& inputs = {}) const;

  /// The rotation before a change of reference, counted as there.
  template <class T>
  Vec3<T> rotation_before(const PlacedBeam& placed, const ReferenceChange& change,
                          const std::vector<T>& z) const;

  /// @throws DomainError beyond 170 degrees, naming the place.
  static void check_rotation(const Vector3& theta, const std::string& place);

 private:
  template <class T>
  void add_point(const PlacedBeam& placed, int p, const elements::Attachment<T>& a,
                 const std::vector<T>& z, const std::vector<T>& z_dot, std::vector<T>& r) const;
  template <class T>
  void add_ends(const PlacedBeam& placed, const elements::Attachment<T>& a, const std::vector<T>& z,
                const std::vector<T>& z_dot, std::vector<T>& r) const;
  template <class T>
  void add_support(const PlacedBeam& placed, int first, const elements::Attachment<T>& a,
                   const std::vector<T>& z, const std::vector<T>& z_dot, std::vector<T>& r) const;
  template <class T>
  void add_changes(const PlacedBeam& placed, const std::vector<T>& z, std::vector<T>& r) const;
  template <class T>
  void add_loads(const PlacedBeam& placed, double t, const std::vector<T>& z,
                 const TurbineInputs<T>& inputs, std::vector<T>& r) const;
  template <class T>
  static void add_drag(const PlacedBeam& placed, const std::vector<T>& z,
                       const std::vector<T>& z_dot, std::vector<T>& r);
  template <class T>
  static void add_top_force(const PlacedBeam& tower, const Vec3<T>& force, std::vector<T>& r);
  template <class T>
  static void put_joint(int first, bool free, const elements::JointRows<T>& rows,
                        std::vector<T>& r);

  void place_beams();
  static void find_changes(PlacedBeam& placed);

  model::Turbine turbine_;
  model::Layout layout_;
  std::vector<PlacedBeam> beams_;
};

template <class T, class Value, class Make>
elements::ChainState<T> TurbineResidual::chain_state(double t, const std::vector<Value>& z,
                                                     const std::vector<Value>& z_dot, Make make,
                                                     const TurbineInputs<Value>& inputs) const {
  State<Value> top = State<Value>::Zero();
  State<Value> top_dot = State<Value>::Zero();
  if (turbine_.has_tower) {
    top = at(z, layout_.tower_tip());
    top_dot = at(z_dot, layout_.tower_tip());
    check_rotation(Vector3(top.template segment<3>(3).real()), "tower top");
  }
  Vec6<Value> load = Vec6<Value>::Zero();
  for (const PlacedBeam& placed : beams_) {
    if (!placed.on_hub()) continue;
    Vec6<Value> root = Eigen::Map<const Vec6<Value>>(z.data() + placed.root);
    if (const BladePitch<Value> pitch = pitch_of(placed, t, inputs); pitch.moves) {
      const Mat3<Value> feather = pitch.feather();
      root << feather * root.template head<3>().eval(), feather * root.template tail<3>().eval();
    }
    load += placed.hub_from_root().template cast<Value>() * root;
  }
  elements::ChainState<T> state;
  for (int i = 0; i < 3; ++i) state.theta(i) = make(top(3 + i), at_theta + i);
  for (int i = 0; i < 6; ++i) {
    state.top_velocity(i) = make(top(6 + i), at_top_velocity + i);
    state.top_velocity_dot(i) = make(top_dot(6 + i), at_top_velocity_dot + i);
    state.top_load(i) = make(top(12 + i), at_top_load + i);
    state.hub_load(i) = make(load(i), at_hub_load + i);
  }
  int local = 0;
  for (elements::JointState<T>* joint :
       {&state.yaw, &state.teeter, &state.torsion, &state.generator}) {
    const auto first = static_cast<std::size_t>(layout_.joints() + local);
    joint->angle = make(z[first], at_joints + local);
    joint->speed = make(z[first + 1], at_joints + local + 1);
    joint->angle_dot = make(z_dot[first], at_joint_rates + local);
    joint->speed_dot = make(z_dot[first + 1], at_joint_rates + local + 1);
    local += 2;
  }
  state.yaw.prescribed = turbine_.yaw_at(t);
  state.teeter.prescribed = turbine_.teeter_at(t);
  const math::TimeCurve::Value turning = turbine_.turning_at(t);
  state.azimuth = turning.value;
  state.speed = turning.rate;
  state.speed_dot = turning.acceleration;
  state.generator_torque = T(inputs.generator_torque);
  state.yaw_torque = T(inputs.yaw_torque);
  const Vec3<Value> up = inputs.up();
  for (int i = 0; i < 3; ++i) state.up(i) = T(up(i));
  return state;
}

template <class T>
elements::Attachment<T> TurbineResidual::attachment(const PlacedBeam& placed,
                                                    const elements::HubMotion<T>& hub, double t,
                                                    const TurbineInputs<T>& inputs) const {
  elements::Attachment<T> a;
  if (!placed.on_hub()) {  // the tower's axes are (n3, n1, n2)
    a.gravity = inputs.up() * T(-turbine_.chain.gravity);
    const Vec3<T>& v = inputs.base_velocity;
    a.v = inputs.at_foot(Vec3<T>(v(2), v(0), v(1)));
    const Vec3<T>& rate = inputs.base_rate;
    a.omega = Vec3<T>(rate(2), rate(0), rate(1));
    return a;
  }
  Eigen::Matrix<T, 9, 1> motion;
  motion << hub.velocity, hub.omega, hub.gravity;
  const Eigen::Matrix<T, 9, 1> seen = placed.root_from_hub().template cast<T>() * motion;
  a.v = seen.template segment<3>(0);
  a.omega = seen.template segment<3>(3);
  a.gravity = seen.template segment<3>(6);
  if (const BladePitch<T> pitch = pitch_of(placed, t, inputs); pitch.moves) {
    const Mat3<T> feather = pitch.feather();
    for (Vec3<T>* vector : {&a.v, &a.omega, &a.gravity})
      *vector = (feather.transpose() * *vector).eval();
    a.omega(0) -= pitch.rate;
  }
  return a;
}

template <class T>
BladePitch<T> TurbineResidual::pitch_of(const PlacedBeam& placed, double t,
                                        const TurbineInputs<T>& inputs) const {
  BladePitch<T> pitch;
  pitch.moves = !turbine_.operation.pitch.empty() || !inputs.pitch.empty();
  if (!pitch.moves) return pitch;
  const auto k = static_cast<std::size_t>(placed.blade);
  const math::TimeCurve::Value now = turbine_.pitch_at(k, t);
  pitch.angle = T(now.value - turbine_.roots[k].pitch);
  pitch.rate = T(now.rate);
  if (inputs.pitch.empty()) return pitch;
  pitch.angle += inputs.pitch[k];
  pitch.rate += inputs.pitch_rate[k];
  return pitch;
}

template <class T>
void TurbineResidual::evaluate(double t, const std::vector<T>& z, const std::vector<T>& z_dot,
                               const TurbineInputs<T>& inputs, std::vector<T>& r) const {
  std::fill(r.begin(), r.end(), T(0));
  const auto plain = [](const T& value, int) { return value; };
  elements::HubMotion<T> hub;
  const elements::ChainRows<T> rows =
      elements::rigid_chain(turbine_.chain, chain_state<T>(t, z, z_dot, plain, inputs), hub);
  for (const PlacedBeam& placed : beams_) {
    const elements::Attachment<T> a = attachment(placed, hub, t, inputs);
    for (int p = 0; p < placed.beam->point_count(); ++p) add_point(placed, p, a, z, z_dot, r);
    add_ends(placed, a, z, z_dot, r);
    add_changes(placed, z, r);
    add_loads(placed, t, z, inputs, r);
    if (placed.beam->has_drag) add_drag(placed, z, z_dot, r);
    if (!placed.on_hub()) add_top_force(placed, inputs.top_force, r);
  }
  const auto index = [](int i) { return static_cast<std::size_t>(i); };
  if (turbine_.has_tower)
    for (int i = 0; i < 6; ++i) r[index(layout_.tower_tip() + 12 + i)] = rows.top(i);
  const elements::RigidChain& chain = turbine_.chain;
  put_joint(layout_.yaw(), chain.yaw.free, rows.yaw, r);
  put_joint(layout_.teeter(), chain.teeter.free, rows.teeter, r);
  put_joint(layout_.shaft_torsion(), chain.torsion.free, rows.torsion, r);
  put_joint(layout_.generator(), chain.generator.free, rows.generator, r);
  for (const int i : layout_.padding()) r[index(i)] = z[index(i)];
}

/// As a dead load at the tower's end.
template <class T>
void TurbineResidual::add_top_force(const PlacedBeam& tower, const Vec3<T>& force,
                                    std::vector<T>& r) {
  Eigen::Map<Vec3<T>>(r.data() +
                      tower.force_rows(tower.beam->point_count() - 1, tower.beam->order)) -=
      Vec3<T>(force(2), force(0), force(1));
}

template <class T>
void TurbineResidual::put_joint(int first, bool free, const elements::JointRows<T>& rows,
                                std::vector<T>& r) {
  const auto at_joint = static_cast<std::size_t>(first);
  r[at_joint] = free ? rows.kinematic : rows.position;
  r[at_joint + 1] = free ? rows.balance : rows.kinematic;
}

template <class T>
void TurbineResidual::add_point(const PlacedBeam& placed, int p, const elements::Attachment<T>& a,
                                const std::vector<T>& z, const std::vector<T>& z_dot,
                                std::vector<T>& r) const {
  using Rows = Eigen::Map<Vec3<T>>;
  const model::Beam& beam = *placed.beam;
  const int first = placed.points[static_cast<std::size_t>(p)];
  const State<T> state = at(z, first);
  check_rotation(Vector3(state.template segment<3>(3).real()),
                 beam.name + " point " + std::to_string(p + 1));
  const elements::PointTerms<T> terms = elements::beam_point_terms<T>(
      beam.points[static_cast<std::size_t>(p)], state, at(z_dot, first), a);
  Rows(r.data() + first + 6) += terms.velocity;
  Rows(r.data() + first + 9) += terms.spin;
  for (int node = 0; node <= beam.order; ++node) {
    const auto [slope, value] = placed.node_weights(node, p);
    const T by_slope(slope);
    const T by_value(value);
    const int strain = placed.strain_rows(p, node);
    const int force = placed.force_rows(p, node);
    Rows(r.data() + strain) -= state.template segment<3>(0) * by_slope + terms.stretch * by_value;
    Rows(r.data() + strain + 3) -= state.template segment<3>(3) * by_slope + terms.turn * by_value;
    Rows(r.data() + force) += terms.force_flux * by_slope + terms.force_load * by_value;
    Rows(r.data() + force + 3) += terms.moment_flux * by_slope + terms.moment_load * by_value;
  }
}

/// The boundary quantities of a beam: reactions at the root, the loads and the motion at the tip,
/// and where a mass sits between two elements, the end of one and the start of the other.
template <class T>
void TurbineResidual::add_ends(const PlacedBeam& placed, const elements::Attachment<T>& a,
                               const std::vector<T>& z, const std::vector<T>& z_dot,
                               std::vector<T>& r) const {
  using Rows = Eigen::Map<Vec3<T>>;
  using LongRows = Eigen::Map<Vec6<T>>;
  LongRows(r.data() + placed.root) += Eigen::Map<const Vec6<T>>(z.data() + placed.root);
  const auto add_end = [&](int first, int point, const Vector3& x, const Matrix6& mass,
                           const Matrix3& reference, const std::string& name, bool balance) {
    const State<T> end = at(z, first);
    check_rotation(Vector3(end.template segment<3>(3).real()), placed.beam->name + name);
    LongRows(r.data() + first) += end.template head<6>();
    LongRows(r.data() + placed.points[static_cast<std::size_t>(point)] + 12) -=
        end.template tail<6>();
    const elements::TipTerms<T> terms =
        elements::beam_tip_terms<T>(x, reference, mass, end, at(z_dot, first), a);
    Rows(r.data() + first + 6) += terms.velocity;
    Rows(r.data() + first + 9) += terms.spin;
    if (!balance) return;
    Rows(r.data() + first + 12) += terms.force;
    Rows(r.data() + first + 15) += terms.moment;
  };
  const model::Beam& beam = *placed.beam;
  // The tower top's loads are Kane's rows.
  add_end(placed.tip, beam.point_count() - 1, beam.tip, beam.tip_mass,
          beam.reference(beam.elements - 1), " tip", placed.on_hub());
  if (placed.on_hub() && !beam.end_support.is_none()) {
    LongRows rows(r.data() + placed.tip + 12);
    const Vec6<T> end = Eigen::Map<const Vec6<T>>(z.data() + placed.tip);
    rows =
        elements::end_support_rows<T>(beam.end_support, placed.end_reference, end, Vec6<T>(rows));
  }
  for (std::size_t m = 0; m < beam.mass_nodes.size(); ++m) {
    const model::MassNode& node = beam.mass_nodes[m];
    const int next = node.end * beam.order;  // the first point behind it
    const int first = placed.masses[m];
    if (node.end == 0)
      add_support(placed, first, a, z, z_dot, r);
    else
      add_end(first, next - 1, node.x, node.mass, beam.reference(node.end - 1),
              " mass " + std::to_string(beam.has_support ? m : m + 1), true);
    LongRows(r.data() + placed.points[static_cast<std::size_t>(next)]) -=
        at(z, first).template head<6>();
  }
}

/// The root on its body and springs: their law, the motion of the body, its balance.
template <class T>
void TurbineResidual::add_support(const PlacedBeam& placed, int first,
                                  const elements::Attachment<T>& a, const std::vector<T>& z,
                                  const std::vector<T>& z_dot, std::vector<T>& r) const {
  using LongRows = Eigen::Map<Vec6<T>>;
  const model::Beam& beam = *placed.beam;
  State<T> node = at(z, first);
  check_rotation(Vector3(node.template segment<3>(3).real()), beam.name + " root");
  const elements::RootSupportTerms<T> held =
      elements::root_support_terms<T>(beam.support, node, at(z_dot, first));
  node.template segment<6>(12) = held.load;
  const elements::TipTerms<T> terms =
      elements::beam_tip_terms<T>(Vector3::Zero(), Matrix3::Identity(),
                                  beam.mass_nodes.front().mass, node, at(z_dot, first), a);
  LongRows(r.data() + first) += held.law;
  LongRows(r.data() + placed.root) -= held.root;
  Eigen::Map<Vec3<T>>(r.data() + first + 6) += terms.velocity;
  Eigen::Map<Vec3<T>>(r.data() + first + 9) += terms.spin;
  Eigen::Map<Vec3<T>>(r.data() + first + 12) += terms.force;
  Eigen::Map<Vec3<T>>(r.data() + first + 15) += terms.moment;
}

/// What the plain sums of the curvature balances miss where references differ.
template <class T>
void TurbineResidual::add_changes(const PlacedBeam& placed, const std::vector<T>& z,
                                  std::vector<T>& r) const {
  for (const ReferenceChange& change : placed.changes) {
    const Vec3<T> before = rotation_before<T>(placed, change, z);
    const Vec3<T> anew = math::compose<T>(before, change.turn.cast<T>());
    Eigen::Map<Vec3<T>>(r.data() + change.row) += before - anew;
  }
}

/// The rotation at the start of an element as what is before it has it: the root has none.
template <class T>
Vec3<T> TurbineResidual::rotation_before(const PlacedBeam& placed, const ReferenceChange& change,
                                         const std::vector<T>& z) const {
  if (change.mass >= 0) return at(z, change.mass).template segment<3>(3);
  Vec3<T> rotation = Vec3<T>::Zero();
  if (change.element == 0) return rotation;
  const model::Beam& beam = *placed.beam;
  elements::Attachment<T> still;
  for (int j = 0; j < beam.order; ++j) {
    const int p = (change.element - 1) * beam.order + j;
    const auto [slope, value] = placed.node_weights(beam.order, p);
    const State<T> state = at(z, placed.points[static_cast<std::size_t>(p)]);
    const elements::PointTerms<T> terms = elements::beam_point_terms<T>(
        beam.points[static_cast<std::size_t>(p)], state, State<T>::Zero(), still);
    rotation += state.template segment<3>(3) * T(slope) + terms.turn * T(value);
  }
  return rotation;
}

/// Damping in proportion to the mass, on the sections, and its reaction on the root.
template <class T>
void TurbineResidual::add_drag(const PlacedBeam& placed, const std::vector<T>& z,
                               const std::vector<T>& z_dot, std::vector<T>& r) {
  using Rows = Eigen::Map<Vec3<T>>;
  const model::Beam& beam = *placed.beam;
  elements::RootMotion<T> root;
  if (beam.has_support) {
    const State<T> node = at(z, placed.masses.front());
    const State<T> rate = at(z_dot, placed.masses.front());
    root = {node.template segment<3>(0), node.template segment<3>(3), rate.template segment<3>(0),
            rate.template segment<3>(3)};
  }
  Rows root_force(r.data() + placed.root_rows());
  Rows root_moment(r.data() + placed.root_rows() + 3);
  for (int p = 0; p < beam.point_count(); ++p) {
    const elements::BeamPoint& point = beam.points[static_cast<std::size_t>(p)];
    const int first = placed.points[static_cast<std::size_t>(p)];
    const elements::DragTerms<T> drag = elements::beam_drag_terms<T>(
        point.x, point.drag, at(z, first).template segment<3>(0),
        at(z_dot, first).template segment<3>(0), beam.has_support ? &root : nullptr);
    for (int node = 0; node <= beam.order; ++node)
      Rows(r.data() + placed.force_rows(p, node)) -=
          drag.force * T(placed.node_weights(node, p)[1]);
    root_force += drag.force * T(beam.point_length(p));
    root_moment += drag.moment * T(beam.point_length(p));
  }
}

/// The prescribed loads: -f, -m of the force and moment balances.
template <class T>
void TurbineResidual::add_loads(const PlacedBeam& placed, double t, const std::vector<T>& z,
                                const TurbineInputs<T>& inputs, std::vector<T>& r) const {
  using Rows = Eigen::Map<Vec6<T>>;
  const model::Beam& beam = *placed.beam;
  const auto turned = [&](const model::BeamLoad& load, const Vector6& value, int first,
                          const Matrix3& C_ab) -> Vec6<T> {
    if (!load.follower) {
      if (placed.on_hub()) return value.cast<T>();
      Vec6<T> dead;  // fixed in the ground
      dead << inputs.at_foot(value.head<3>().cast<T>()), inputs.at_foot(value.tail<3>().cast<T>());
      return dead;
    }
    return elements::follower_load<T>(Eigen::Map<const Vec3<T>>(z.data() + first + 3), C_ab, value);
  };
  for (const model::BeamLoad& load : beam.loads) {
    const Vector6 value = load.at(t, turbine_.speed);
    if (load.at_tip)
      Rows(r.data() + placed.force_rows(beam.point_count() - 1, beam.order)) -=
          turned(load, value, placed.tip, beam.reference(beam.elements - 1) * load.tip_axes);
    for (std::size_t e = 0; e < load.weights.size(); ++e) {
      const int start = (load.first_element + static_cast<int>(e)) * beam.order;
      for (int j = 0; j < beam.order; ++j) {
        const auto p = static_cast<std::size_t>(start + j);
        const Vec6<T> part =
            turned(load, value, placed.points[p], beam.points[p].reference * beam.points[p].C_ab);
        for (int node = 0; node <= beam.order; ++node)
          Rows(r.data() + placed.force_rows(start, node)) -= part * T(load.weights[e](node, j));
      }
    }
  }
}

}  // namespace samara::system
