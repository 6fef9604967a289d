#include "samara/system/turbine_system.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <string>

#include "block_matrix.hpp"
#include "samara/base/error.hpp"
#include "samara/elements/beam_tip.hpp"
#include "samara/math/autodiff.hpp"
#include "turbine_description.hpp"

namespace samara::system {
namespace {

using elements::Attachment;
using elements::BeamPoint;
using elements::PointTerms;

constexpr int block = model::Layout::block;
using State = Eigen::Matrix<double, block, 1>;

// Independent quantities of a point or beam end: z (18), z_dot (18), attachment (9).
constexpr int point_inputs = 2 * block + 9;
using PointDual = math::Dual<point_inputs>;
using PointDualState = Eigen::Matrix<PointDual, block, 1>;

// Independent quantities of the rigid chain, in this order.
constexpr int at_theta = 0;
constexpr int at_top_velocity = 3;
constexpr int at_yaw = 9;  // q_y, U1, q_h, U2
constexpr int at_top_velocity_dot = 13;
constexpr int at_yaw_speed_dot = 19;  // U1_dot, U2_dot, q_y_dot, q_h_dot
constexpr int at_top_load = 23;
constexpr int at_hub_load = 29;
constexpr int chain_inputs = 35;
constexpr int chain_motion_inputs = 13;  // on which the hub's motion depends
using ChainDual = math::Dual<chain_inputs>;
using MotionJacobian = Eigen::Matrix<double, 9, chain_motion_inputs>;

/// A beam in its place: where its unknowns are and what carries it.
struct PlacedBeam {
  const model::Beam* beam = nullptr;
  std::vector<int> points;  ///< first unknown of each point
  int tip = 0;
  int root = 0;             ///< first of F_hat_0, M_hat_0
  bool on_hub = false;
  Vector3 position = Vector3::Zero();        ///< root from the apex, in H
  Matrix3 C_Ha = Matrix3::Identity();
};

/// v_a, omega_a, gravity of a blade root from the hub's motion: constant and linear.
Eigen::Matrix<double, 9, 9> root_from_hub(const PlacedBeam& placed) {
  const Matrix3 C_aH = placed.C_Ha.transpose();
  Eigen::Matrix<double, 9, 9> map = Eigen::Matrix<double, 9, 9>::Zero();
  map.block<3, 3>(0, 0) = C_aH;
  map.block<3, 3>(0, 3) = -C_aH * math::skew<double>(placed.position);
  map.block<3, 3>(3, 3) = C_aH;
  map.block<3, 3>(6, 6) = C_aH;
  return map;
}

/// Force and moment about the apex in H of a blade's root load.
Matrix6 hub_from_root(const PlacedBeam& placed) {
  Matrix6 map = Matrix6::Zero();
  map.topLeftCorner<3, 3>() = placed.C_Ha;
  map.bottomLeftCorner<3, 3>() = math::skew<double>(placed.position) * placed.C_Ha;
  map.bottomRightCorner<3, 3>() = placed.C_Ha;
  return map;
}

void check_rotation(const Vector3& theta, const std::string& place) {
  if (!(theta.norm() < math::largest_rodrigues_length))
    throw DomainError(place + ": rotation beyond 170 degrees");
}

}  // namespace

class TurbineSystem::Assembly {
 public:
  Assembly(const model::Turbine& whole_turbine, MPI_Comm communicator)
      : turbine(whole_turbine),
        layout(turbine),
        description(describe(turbine, layout)),
        comm(communicator) {
    place_beams();
    find_range();
    jacobian.emplace_back(pattern());
    jacobian.emplace_back(pattern());
    find_mass_pattern();
  }

  model::Turbine turbine;
  model::Layout layout;
  TurbineDescription description;
  MPI_Comm comm;
  std::vector<PlacedBeam> beams;
  std::vector<bool> differential;
  std::vector<std::vector<PetscInt>> mass_columns;  ///< by row
  std::vector<std::size_t> mass_offsets;            ///< into the blocks, row by row
  PetscInt first_row = 0;
  PetscInt last_row = 0;
  mutable std::vector<BlockMatrix> jacobian;        ///< K, M as blocks
  mutable petsc::Handle<VecScatter> gather;
  mutable petsc::Handle<Vec> whole;

  double time_azimuth(double t) const { return turbine.azimuth_at(t); }

  bool parallel() const {
    int ranks = 1;
    MPI_Comm_size(comm, &ranks);
    return ranks > 1;
  }

  // ---- the state -----------------------------------------------------------------------------

  /// The whole vector, from all ranks.
  std::vector<double> gathered(Vec z) const {
    std::vector<double> values(static_cast<std::size_t>(layout.size()));
    if (!parallel()) {
      const petsc::ReadView view(z);
      std::copy(view.data(), view.data() + layout.size(), values.begin());
      return values;
    }
    if (!gather) petsc::check(VecScatterCreateToAll(z, gather.fill(), whole.fill()));
    petsc::check(VecScatterBegin(gather.get(), z, whole.get(), INSERT_VALUES, SCATTER_FORWARD));
    petsc::check(VecScatterEnd(gather.get(), z, whole.get(), INSERT_VALUES, SCATTER_FORWARD));
    const petsc::ReadView view(whole.get());
    std::copy(view.data(), view.data() + layout.size(), values.begin());
    return values;
  }

  static State at(const std::vector<double>& z, int first) {
    return Eigen::Map<const State>(z.data() + first);
  }
  static double one(const std::vector<double>& z, int i) { return z[static_cast<std::size_t>(i)]; }

  Vector6 hub_load(const std::vector<double>& z) const {
    Vector6 load = Vector6::Zero();
    for (const PlacedBeam& placed : beams)
      if (placed.on_hub)
        load += hub_from_root(placed) * Eigen::Map<const Vector6>(z.data() + placed.root);
    return load;
  }

  /// The chain's state with each input passed through `make(value, index)`.
  template <class T, class Make>
  elements::ChainState<T> chain_state(double t, const std::vector<double>& z,
                                      const std::vector<double>& z_dot, Make make) const {
    State top = State::Zero();
    State top_dot = State::Zero();
    if (turbine.has_tower) {
      top = at(z, layout.tower_tip());
      top_dot = at(z_dot, layout.tower_tip());
      check_rotation(top.segment<3>(3), "tower top");
    }
    const Vector6 load = hub_load(z);
    elements::ChainState<T> state;
    for (int i = 0; i < 3; ++i) state.theta(i) = make(top(3 + i), at_theta + i);
    for (int i = 0; i < 6; ++i) {
      state.top_velocity(i) = make(top(6 + i), at_top_velocity + i);
      state.top_velocity_dot(i) = make(top_dot(6 + i), at_top_velocity_dot + i);
      state.top_load(i) = make(top(12 + i), at_top_load + i);
      state.hub_load(i) = make(load(i), at_hub_load + i);
    }
    const int yaw = layout.yaw();
    const int teeter = layout.teeter();
    state.yaw = make(one(z, yaw), at_yaw);
    state.yaw_speed = make(one(z, yaw + 1), at_yaw + 1);
    state.teeter = make(one(z, teeter), at_yaw + 2);
    state.teeter_speed = make(one(z, teeter + 1), at_yaw + 3);
    state.yaw_speed_dot = make(one(z_dot, yaw + 1), at_yaw_speed_dot);
    state.teeter_speed_dot = make(one(z_dot, teeter + 1), at_yaw_speed_dot + 1);
    state.yaw_dot = make(one(z_dot, yaw), at_yaw_speed_dot + 2);
    state.teeter_dot = make(one(z_dot, teeter), at_yaw_speed_dot + 3);
    state.azimuth = time_azimuth(t);
    state.speed = turbine.speed;
    return state;
  }

  Attachment<double> attachment(const PlacedBeam& placed,
                                const elements::HubMotion<double>& hub) const {
    Attachment<double> a;
    if (!placed.on_hub) {
      a.gravity = Vector3(-turbine.chain.gravity, 0.0, 0.0);  // the tower's b1 is n3
      return a;
    }
    Eigen::Matrix<double, 9, 1> motion;
    motion << hub.velocity, hub.omega, hub.gravity;
    const Eigen::Matrix<double, 9, 1> seen = root_from_hub(placed) * motion;
    a.v = seen.segment<3>(0);
    a.omega = seen.segment<3>(3);
    a.gravity = seen.segment<3>(6);
    return a;
  }

  // ---- the residual --------------------------------------------------------------------------

  void residual(double t, const std::vector<double>& z, const std::vector<double>& z_dot,
                std::vector<double>& r) const {
    std::fill(r.begin(), r.end(), 0.0);
    const auto plain = [](double value, int) { return value; };
    elements::HubMotion<double> hub;
    const elements::ChainRows<double> rows =
        elements::rigid_chain(turbine.chain, chain_state<double>(t, z, z_dot, plain), hub);
    for (const PlacedBeam& placed : beams) {
      const Attachment<double> a = attachment(placed, hub);
      for (int p = 0; p < placed.beam->point_count(); ++p)
        add_point(placed, p, a, z, z_dot, r);
      add_ends(placed, a, z, z_dot, r);
    }
    const auto put = [&r](int i, double value) { r[static_cast<std::size_t>(i)] = value; };
    if (turbine.has_tower)
      for (int i = 0; i < 6; ++i) put(layout.tower_tip() + 12 + i, rows.top(i));
    put_joint(layout.yaw(), turbine.chain.yaw.free, rows.yaw_kinematic, rows.yaw_balance, z, r);
    put_joint(layout.teeter(), turbine.chain.teeter.free, rows.teeter_kinematic,
              rows.teeter_balance, z, r);
    put(layout.shaft_torsion(), one(z, layout.shaft_torsion()));
    put(layout.shaft_torsion() + 1, one(z, layout.shaft_torsion() + 1));
    for (int i = layout.padding(); i < layout.size(); ++i) put(i, one(z, i));
  }

  static void put_joint(int first, bool free, double kinematic, double balance,
                        const std::vector<double>& z, std::vector<double>& r) {
    const auto at = static_cast<std::size_t>(first);
    r[at] = free ? kinematic : z[at];
    r[at + 1] = free ? balance : kinematic;
  }

  /// First row of the strain and curvature balance of node n of a beam.
  static int strain_rows(const PlacedBeam& placed, int n) {
    return n < placed.beam->point_count() ? placed.points[static_cast<std::size_t>(n)]
                                          : placed.tip;
  }
  /// First row of its force and moment balance.
  static int force_rows(const PlacedBeam& placed, int n) {
    return n == 0 ? placed.root : placed.points[static_cast<std::size_t>(n - 1)] + 12;
  }

  /// Weights of a point in the balances of local node a: w N_a' and w L N_a.
  static std::array<double, 2> node_weights(const model::Beam& beam, int a, int p) {
    const auto j = static_cast<std::size_t>(p % beam.order);
    const auto node = static_cast<std::size_t>(a);
    const double w = beam.functions.weights[j];
    return {w * beam.functions.slope[node][j],
            w * beam.element_length * beam.functions.value[node][j]};
  }

  void add_point(const PlacedBeam& placed, int p, const Attachment<double>& a,
                 const std::vector<double>& z, const std::vector<double>& z_dot,
                 std::vector<double>& r) const {
    const model::Beam& beam = *placed.beam;
    const int first = placed.points[static_cast<std::size_t>(p)];
    const State state = at(z, first);
    check_rotation(state.segment<3>(3), beam.name + " point " + std::to_string(p + 1));
    const PointTerms<double> terms = elements::beam_point_terms<double>(
        beam.points[static_cast<std::size_t>(p)], state, at(z_dot, first), a);
    Eigen::Map<Vector3>(r.data() + first + 6) += terms.velocity;
    Eigen::Map<Vector3>(r.data() + first + 9) += terms.spin;
    for (int node = 0; node <= beam.order; ++node) {
      const int n = p / beam.order * beam.order + node;
      const auto [slope, value] = node_weights(beam, node, p);
      const int strain = strain_rows(placed, n);
      const int force = force_rows(placed, n);
      Eigen::Map<Vector3>(r.data() + strain) +=
          -slope * state.segment<3>(0) - value * terms.stretch;
      Eigen::Map<Vector3>(r.data() + strain + 3) +=
          -slope * state.segment<3>(3) - value * terms.turn;
      Eigen::Map<Vector3>(r.data() + force) += slope * terms.force_flux + value * terms.force_load;
      Eigen::Map<Vector3>(r.data() + force + 3) +=
          slope * terms.moment_flux + value * terms.moment_load;
    }
  }

  /// The boundary quantities of a beam: reactions at the root, the loads and the motion at the tip.
  void add_ends(const PlacedBeam& placed, const Attachment<double>& a,
                const std::vector<double>& z, const std::vector<double>& z_dot,
                std::vector<double>& r) const {
    const int last = placed.beam->point_count();
    const State tip = at(z, placed.tip);
    check_rotation(tip.segment<3>(3), placed.beam->name + " tip");
    Eigen::Map<Vector6>(r.data() + force_rows(placed, 0)) +=
        Eigen::Map<const Vector6>(z.data() + placed.root);
    Eigen::Map<Vector6>(r.data() + strain_rows(placed, last)) += tip.head<6>();
    Eigen::Map<Vector6>(r.data() + force_rows(placed, last)) -= tip.tail<6>();
    const elements::TipTerms<double> terms = elements::beam_tip_terms<double>(
        placed.beam->tip, placed.on_hub ? placed.beam->tip_mass : 0.0, tip,
        at(z_dot, placed.tip), a);
    Eigen::Map<Vector3>(r.data() + placed.tip + 6) += terms.velocity;
    Eigen::Map<Vector3>(r.data() + placed.tip + 9) += terms.spin;
    if (!placed.on_hub) return;  // the tower top's loads are Kane's rows
    Eigen::Map<Vector3>(r.data() + placed.tip + 12) += terms.force;
    Eigen::Map<Vector3>(r.data() + placed.tip + 15) += terms.moment;
  }

  // ---- the tangents --------------------------------------------------------------------------

  /// K and M as blocks.
  void tangents(double t, const std::vector<double>& z, const std::vector<double>& z_dot) const {
    jacobian[0].clear();
    jacobian[1].clear();
    const auto make = [](double value, int i) {
      return math::independent<chain_inputs>(value, i);
    };
    elements::HubMotion<ChainDual> hub;
    const elements::ChainRows<ChainDual> rows =
        elements::rigid_chain(turbine.chain, chain_state<ChainDual>(t, z, z_dot, make), hub);
    elements::HubMotion<double> motion;
    MotionJacobian motion_jacobian;
    for (int i = 0; i < 3; ++i) {
      motion.velocity(i) = hub.velocity(i).value();
      motion.omega(i) = hub.omega(i).value();
      motion.gravity(i) = hub.gravity(i).value();
      motion_jacobian.row(i) = hub.velocity(i).derivatives().head<chain_motion_inputs>();
      motion_jacobian.row(3 + i) = hub.omega(i).derivatives().head<chain_motion_inputs>();
      motion_jacobian.row(6 + i) = hub.gravity(i).derivatives().head<chain_motion_inputs>();
    }
    for (const PlacedBeam& placed : beams) {
      const Attachment<double> a = attachment(placed, motion);
      MotionJacobian root = MotionJacobian::Zero();
      if (placed.on_hub) root = root_from_hub(placed) * motion_jacobian;
      for (int p = 0; p < placed.beam->point_count(); ++p)
        add_point_tangent(placed, p, a, root, z, z_dot);
      add_end_tangents(placed, a, root, z, z_dot);
    }
    add_chain_tangents(rows);
  }

  void add(int which, int i, int j, double value) const {
    jacobian[static_cast<std::size_t>(which)].at(i / block, j / block)(i % block, j % block) +=
        value;
  }

  /// The unknown behind input i of the chain (motion inputs and rates), -1 where there is none.
  int chain_unknown(int i) const {
    const int top = turbine.has_tower ? layout.tower_tip() : -1000;
    int unknown = -1;
    if (i < at_top_velocity) {
      unknown = top + 3 + i;
    } else if (i < at_yaw) {
      unknown = top + 6 + i - at_top_velocity;
    } else if (i < at_top_velocity_dot) {
      unknown = i < at_yaw + 2 ? layout.yaw() + i - at_yaw : layout.teeter() + i - at_yaw - 2;
    } else if (i < at_yaw_speed_dot) {
      unknown = top + 6 + i - at_top_velocity_dot;
    } else if (i < at_top_load) {
      const std::array<int, 4> rates{layout.yaw() + 1, layout.teeter() + 1, layout.yaw(),
                                     layout.teeter()};
      unknown = rates[static_cast<std::size_t>(i - at_yaw_speed_dot)];
    } else if (i < at_hub_load) {
      unknown = top + 12 + i - at_top_load;
    }
    return unknown < 0 ? -1 : unknown;
  }

  void add_motion(int row, const Eigen::Matrix<double, 3, chain_motion_inputs>& values) const {
    for (int c = 0; c < chain_motion_inputs; ++c) {
      const int unknown = chain_unknown(c);
      if (unknown < 0 || values.col(c).isZero(0.0)) continue;
      BlockMatrix::Block target = jacobian[0].at(row / block, unknown / block);
      target.block<3, 1>(row % block, unknown % block) += values.col(c);
    }
  }

  static void fill_inputs(const State& z, const State& z_dot, const Attachment<double>& a,
                          PointDualState& dual, PointDualState& dual_dot,
                          Attachment<PointDual>& dual_a) {
    for (int i = 0; i < block; ++i) {
      dual(i) = math::independent<point_inputs>(z(i), i);
      dual_dot(i) = math::independent<point_inputs>(z_dot(i), block + i);
    }
    for (int i = 0; i < 3; ++i) {
      dual_a.v(i) = math::independent<point_inputs>(a.v(i), 2 * block + i);
      dual_a.omega(i) = math::independent<point_inputs>(a.omega(i), 2 * block + 3 + i);
      dual_a.gravity(i) = math::independent<point_inputs>(a.gravity(i), 2 * block + 6 + i);
    }
  }

  using TermJacobian = Eigen::Matrix<double, 3, point_inputs>;

  static TermJacobian jacobian_of(const Vec3<PointDual>& term) {
    TermJacobian j;
    for (int i = 0; i < 3; ++i) j.row(i) = term(i).derivatives();
    return j;
  }

  /// Adds three rows that depend on the 18 unknowns from `first`, their rates and the attachment.
  void add_term(int row, int first, const TermJacobian& term, const MotionJacobian& root,
                bool on_hub) const {
    jacobian[0].at(row / block, first / block).block<3, block>(row % block, 0) +=
        term.leftCols<block>();
    jacobian[1].at(row / block, first / block).block<3, block>(row % block, 0) +=
        term.middleCols<block>(block);
    if (!on_hub) return;
    const Eigen::Matrix<double, 3, chain_motion_inputs> carried = term.rightCols<9>() * root;
    add_motion(row, carried);
  }

  void add_point_tangent(const PlacedBeam& placed, int p, const Attachment<double>& a,
                         const MotionJacobian& root, const std::vector<double>& z,
                         const std::vector<double>& z_dot) const {
    const model::Beam& beam = *placed.beam;
    const int first = placed.points[static_cast<std::size_t>(p)];
    PointDualState dual;
    PointDualState dual_dot;
    Attachment<PointDual> dual_a;
    fill_inputs(at(z, first), at(z_dot, first), a, dual, dual_dot, dual_a);
    const PointTerms<PointDual> terms = elements::beam_point_terms<PointDual>(
        beam.points[static_cast<std::size_t>(p)], dual, dual_dot, dual_a);
    const TermJacobian force_flux = jacobian_of(terms.force_flux);
    const TermJacobian force_load = jacobian_of(terms.force_load);
    const TermJacobian moment_flux = jacobian_of(terms.moment_flux);
    const TermJacobian moment_load = jacobian_of(terms.moment_load);
    TermJacobian u = TermJacobian::Zero();
    TermJacobian theta = TermJacobian::Zero();
    u.block<3, 3>(0, 0).setIdentity();
    theta.block<3, 3>(0, 3).setIdentity();
    const TermJacobian stretch = jacobian_of(terms.stretch);
    const TermJacobian turn = jacobian_of(terms.turn);
    add_term(first + 6, first, jacobian_of(terms.velocity), root, placed.on_hub);
    add_term(first + 9, first, jacobian_of(terms.spin), root, placed.on_hub);
    for (int node = 0; node <= beam.order; ++node) {
      const int n = p / beam.order * beam.order + node;
      const auto [slope, value] = node_weights(beam, node, p);
      const int strain = strain_rows(placed, n);
      const int force = force_rows(placed, n);
      const TermJacobian strain_rows_j = -slope * u - value * stretch;
      const TermJacobian curvature_rows_j = -slope * theta - value * turn;
      const TermJacobian force_rows_j = slope * force_flux + value * force_load;
      const TermJacobian moment_rows_j = slope * moment_flux + value * moment_load;
      add_term(strain, first, strain_rows_j, root, false);
      add_term(strain + 3, first, curvature_rows_j, root, false);
      add_term(force, first, force_rows_j, root, placed.on_hub);
      add_term(force + 3, first, moment_rows_j, root, placed.on_hub);
    }
  }

  void add_end_tangents(const PlacedBeam& placed, const Attachment<double>& a,
                        const MotionJacobian& root, const std::vector<double>& z,
                        const std::vector<double>& z_dot) const {
    const int last = placed.beam->point_count();
    for (int i = 0; i < 6; ++i) {
      add(0, force_rows(placed, 0) + i, placed.root + i, 1.0);
      add(0, strain_rows(placed, last) + i, placed.tip + i, 1.0);
      add(0, force_rows(placed, last) + i, placed.tip + 12 + i, -1.0);
    }
    PointDualState dual;
    PointDualState dual_dot;
    Attachment<PointDual> dual_a;
    fill_inputs(at(z, placed.tip), at(z_dot, placed.tip), a, dual, dual_dot, dual_a);
    const elements::TipTerms<PointDual> terms = elements::beam_tip_terms<PointDual>(
        placed.beam->tip, placed.on_hub ? placed.beam->tip_mass : 0.0, dual, dual_dot, dual_a);
    add_term(placed.tip + 6, placed.tip, jacobian_of(terms.velocity), root, placed.on_hub);
    add_term(placed.tip + 9, placed.tip, jacobian_of(terms.spin), root, placed.on_hub);
    if (!placed.on_hub) return;
    add_term(placed.tip + 12, placed.tip, jacobian_of(terms.force), root, true);
    add_term(placed.tip + 15, placed.tip, jacobian_of(terms.moment), root, true);
  }

  void add_chain_row(int row, const ChainDual& value) const {
    for (int i = 0; i < at_hub_load; ++i) {
      const int unknown = chain_unknown(i);
      const double d = value.derivatives()(i);
      if (unknown < 0 || d == 0.0) continue;
      add(i >= at_top_velocity_dot && i < at_top_load ? 1 : 0, row, unknown, d);
    }
    const Vector6 by_hub_load = value.derivatives().segment<6>(at_hub_load);
    if (by_hub_load.isZero(0.0)) return;
    for (const PlacedBeam& placed : beams) {
      if (!placed.on_hub) continue;
      const Vector6 by_root = hub_from_root(placed).transpose() * by_hub_load;
      for (int i = 0; i < 6; ++i) add(0, row, placed.root + i, by_root(i));
    }
  }

  void add_chain_tangents(const elements::ChainRows<ChainDual>& rows) const {
    if (turbine.has_tower)
      for (int i = 0; i < 6; ++i) add_chain_row(layout.tower_tip() + 12 + i, rows.top(i));
    add_joint_tangents(layout.yaw(), turbine.chain.yaw.free, rows.yaw_kinematic,
                       rows.yaw_balance);
    add_joint_tangents(layout.teeter(), turbine.chain.teeter.free, rows.teeter_kinematic,
                       rows.teeter_balance);
    add(0, layout.shaft_torsion(), layout.shaft_torsion(), 1.0);
    add(0, layout.shaft_torsion() + 1, layout.shaft_torsion() + 1, 1.0);
    for (int i = layout.padding(); i < layout.size(); ++i) add(0, i, i, 1.0);
  }

  void add_joint_tangents(int first, bool free, const ChainDual& kinematic,
                          const ChainDual& balance) const {
    if (free) {
      add_chain_row(first, kinematic);
      add_chain_row(first + 1, balance);
    } else {
      add(0, first, first, 1.0);
      add_chain_row(first + 1, kinematic);
    }
  }

 private:
  void place_beams() {
    for (std::size_t k = 0; k < turbine.blades.size(); ++k) {
      const int number = static_cast<int>(k);
      PlacedBeam placed;
      placed.beam = &turbine.blades[k];
      for (int p = 0; p < placed.beam->point_count(); ++p)
        placed.points.push_back(layout.blade_point(number, p));
      placed.tip = layout.blade_tip(number);
      placed.root = layout.blade_root(number);
      placed.on_hub = true;
      placed.position = turbine.roots[k].position;
      placed.C_Ha = turbine.roots[k].C_Ha;
      beams.push_back(placed);
    }
    if (!turbine.has_tower) return;
    PlacedBeam placed;
    placed.beam = &turbine.tower;
    for (int p = 0; p < placed.beam->point_count(); ++p)
      placed.points.push_back(layout.tower_point(p));
    placed.tip = layout.tower_tip();
    placed.root = layout.tower_root();
    beams.push_back(placed);
  }

  void find_range() {
    const petsc::Handle<Vec> z = vector();
    petsc::check(VecGetOwnershipRange(z.get(), &first_row, &last_row));
  }

  std::vector<std::vector<int>> pattern() const {
    std::vector<std::set<int>> found(static_cast<std::size_t>(layout.blocks()));
    const auto couple = [&found](int row, int column) {
      found[static_cast<std::size_t>(row / block)].insert(column / block);
    };
    const int hub_first = layout.yaw();
    for (int i = hub_first; i < layout.size(); i += block)
      for (int j = hub_first; j < layout.size(); j += block) couple(i, j);
    for (int i = 0; i < layout.size(); i += block) couple(i, i);
    for (const PlacedBeam& placed : beams) {
      const model::Beam& beam = *placed.beam;
      for (int p = 0; p < beam.point_count(); ++p) {
        const int first = placed.points[static_cast<std::size_t>(p)];
        for (int node = 0; node <= beam.order; ++node) {
          const int n = p / beam.order * beam.order + node;
          for (const int row : {strain_rows(placed, n), force_rows(placed, n)}) {
            couple(row, first);
            if (placed.on_hub) couple_to_motion(couple, row);
          }
        }
      }
      couple(force_rows(placed, 0), placed.root);
      couple(force_rows(placed, beam.point_count()), placed.tip);
      if (placed.on_hub) couple_to_motion(couple, placed.tip);
    }
    if (turbine.has_tower) {
      for (int j = hub_first; j < layout.size(); j += block) couple(layout.tower_tip(), j);
      couple(hub_first, layout.tower_tip());
      couple(layout.yaw(), layout.tower_tip());
    }
    std::vector<std::vector<int>> columns;
    for (const std::set<int>& row : found) columns.emplace_back(row.begin(), row.end());
    return columns;
  }

  template <class Couple>
  void couple_to_motion(const Couple& couple, int row) const {
    couple(row, layout.yaw());
    couple(row, layout.teeter() + 1);
    if (turbine.has_tower) couple(row, layout.tower_tip());
  }

  /// The places of M that are not always zero, found at states where everything moves.
  void find_mass_pattern() {
    const auto n = static_cast<std::size_t>(layout.size());
    std::vector<bool> used(jacobian[1].values().size(), false);
    std::minstd_rand random(1);
    std::uniform_real_distribution<double> uniform(-0.5, 0.5);
    for (int trial = 0; trial < 2; ++trial) {
      std::vector<double> z(n);
      std::vector<double> z_dot(n);
      for (std::size_t i = 0; i < n; ++i) {
        z[i] = uniform(random);
        z_dot[i] = uniform(random);
      }
      tangents(0.1 + trial, z, z_dot);
      const std::vector<double>& values = jacobian[1].values();
      for (std::size_t i = 0; i < values.size(); ++i)
        if (values[i] != 0.0) used[i] = true;
    }
    differential.assign(n, false);
    mass_columns.resize(n);
    for (int row = 0; row < layout.size(); ++row) {
      const std::vector<int>& columns =
          jacobian[1].columns()[static_cast<std::size_t>(row / block)];
      for (std::size_t c = 0; c < columns.size(); ++c) {
        for (int j = 0; j < block; ++j) {
          const std::size_t offset = jacobian[1].offset(row / block, static_cast<int>(c)) +
                                     static_cast<std::size_t>(j * block + row % block);
          if (!used[offset]) continue;
          const int column = columns[c] * block + j;
          mass_columns[static_cast<std::size_t>(row)].push_back(column);
          mass_offsets.push_back(offset);
          differential[static_cast<std::size_t>(column)] = true;
        }
      }
    }
  }

 public:
  petsc::Handle<Vec> vector() const {
    int ranks = 1;
    int rank = 0;
    MPI_Comm_size(comm, &ranks);
    MPI_Comm_rank(comm, &rank);
    const int blocks = layout.blocks();
    const int own = blocks / ranks + (rank < blocks % ranks ? 1 : 0);
    return petsc::make_vector(comm, own * block, layout.size());
  }
};

TurbineSystem::TurbineSystem(const model::Turbine& turbine, MPI_Comm comm)
    : assembly_(std::make_unique<Assembly>(turbine, comm)) {}

TurbineSystem::~TurbineSystem() = default;

const model::Turbine& TurbineSystem::turbine() const { return assembly_->turbine; }
const model::Layout& TurbineSystem::layout() const { return assembly_->layout; }
MPI_Comm TurbineSystem::comm() const { return assembly_->comm; }
PetscInt TurbineSystem::size() const { return assembly_->layout.size(); }

double TurbineSystem::period() const {
  const double speed = assembly_->turbine.speed;
  return speed > 0.0 ? 2.0 * std::numbers::pi / speed : 0.0;
}

const std::vector<Unknown>& TurbineSystem::unknowns() const {
  return assembly_->description.unknowns;
}
const std::vector<RowRole>& TurbineSystem::rows() const { return assembly_->description.rows; }
const std::vector<bool>& TurbineSystem::differential() const { return assembly_->differential; }
const RotorSymmetry& TurbineSystem::symmetry() const { return assembly_->description.symmetry; }
const std::vector<EnergyGroup>& TurbineSystem::energy_groups() const {
  return assembly_->description.groups;
}
const std::vector<NeutralCoordinate>& TurbineSystem::neutral_coordinates() const {
  return assembly_->description.neutral;
}

petsc::Handle<Vec> TurbineSystem::make_state() const { return assembly_->vector(); }

petsc::Handle<Mat> TurbineSystem::make_jacobian() const {
  const Assembly& assembly = *assembly_;
  const petsc::Handle<Vec> z = make_state();
  PetscInt local = 0;
  petsc::check(VecGetLocalSize(z.get(), &local));
  const auto& columns = assembly.jacobian[0].columns();
  const int first = static_cast<int>(assembly.first_row) / block;
  const int last = static_cast<int>(assembly.last_row) / block;
  std::vector<PetscInt> inside;
  std::vector<PetscInt> outside;
  for (int i = first; i < last; ++i) {
    PetscInt own = 0;
    const auto& row = columns[static_cast<std::size_t>(i)];
    for (const int j : row)
      if (j >= first && j < last) ++own;
    inside.push_back(own);
    outside.push_back(static_cast<PetscInt>(row.size()) - own);
  }
  petsc::Handle<Mat> matrix;
  petsc::check(MatCreate(assembly.comm, matrix.fill()));
  petsc::check(MatSetSizes(matrix.get(), local, local, size(), size()));
  petsc::check(MatSetType(matrix.get(), MATBAIJ));
  petsc::check(MatSeqBAIJSetPreallocation(matrix.get(), block, 0, inside.data()));
  petsc::check(MatMPIBAIJSetPreallocation(matrix.get(), block, 0, inside.data(), 0,
                                          outside.data()));
  for (int i = first; i < last; ++i) {  // sets the pattern; the values come block by block
    const std::vector<double> zeros(static_cast<std::size_t>(block * block), 0.0);
    for (const PetscInt j : columns[static_cast<std::size_t>(i)]) {
      const PetscInt row = i;
      petsc::check(
          MatSetValuesBlocked(matrix.get(), 1, &row, 1, &j, zeros.data(), INSERT_VALUES));
    }
  }
  petsc::check(MatAssemblyBegin(matrix.get(), MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(matrix.get(), MAT_FINAL_ASSEMBLY));
  return matrix;
}

petsc::Handle<Mat> TurbineSystem::make_mass() const {
  const Assembly& assembly = *assembly_;
  const petsc::Handle<Vec> z = make_state();
  PetscInt local = 0;
  petsc::check(VecGetLocalSize(z.get(), &local));
  std::vector<PetscInt> inside;
  std::vector<PetscInt> outside;
  for (PetscInt i = assembly.first_row; i < assembly.last_row; ++i) {
    PetscInt own = 0;
    const auto& row = assembly.mass_columns[static_cast<std::size_t>(i)];
    for (const PetscInt j : row)
      if (j >= assembly.first_row && j < assembly.last_row) ++own;
    inside.push_back(own);
    outside.push_back(static_cast<PetscInt>(row.size()) - own);
  }
  petsc::Handle<Mat> matrix;
  petsc::check(MatCreate(assembly.comm, matrix.fill()));
  petsc::check(MatSetSizes(matrix.get(), local, local, size(), size()));
  petsc::check(MatSetType(matrix.get(), MATAIJ));
  petsc::check(MatSeqAIJSetPreallocation(matrix.get(), 0, inside.data()));
  petsc::check(MatMPIAIJSetPreallocation(matrix.get(), 0, inside.data(), 0, outside.data()));
  return matrix;
}

void TurbineSystem::reference_state(double t, Vec z) const {
  const Assembly& assembly = *assembly_;
  const auto n = static_cast<std::size_t>(size());
  std::vector<double> values(n, 0.0);
  const std::vector<double> rates(n, 0.0);
  // With u = theta = 0 the kinematic rows are V - (v_a + omega_a x x): their negative is V. The
  // teeter's row asks for the same of its speed; the motion of the hub does not depend on it yet.
  std::vector<double> r(n, 0.0);
  for (int pass = 0; pass < 2; ++pass) {
    assembly.residual(t, values, rates, r);
    const std::vector<RowRole>& roles = assembly.description.rows;
    for (std::size_t i = 0; i < n; ++i) {
      if (assembly.description.unknowns[i].role != UnknownRole::velocity) continue;
      if (roles[i] == RowRole::kinematic) values[i] -= r[i];
    }
    if (assembly.turbine.chain.teeter.free) {
      const auto teeter = static_cast<std::size_t>(assembly.layout.teeter());
      values[teeter + 1] += r[teeter];
    }
  }
  PetscInt first = 0;
  PetscInt last = 0;
  petsc::check(VecGetOwnershipRange(z, &first, &last));
  const petsc::WriteView view(z);
  for (PetscInt i = first; i < last; ++i) view[i - first] = values[static_cast<std::size_t>(i)];
}

void TurbineSystem::residual(double t, Vec z, Vec z_dot, Vec r) const {
  const Assembly& assembly = *assembly_;
  std::vector<double> values(static_cast<std::size_t>(size()));
  assembly.residual(t, assembly.gathered(z), assembly.gathered(z_dot), values);
  const petsc::WriteView view(r);
  for (PetscInt i = assembly.first_row; i < assembly.last_row; ++i)
    view[i - assembly.first_row] = values[static_cast<std::size_t>(i)];
}

void TurbineSystem::tangents(double t, Vec z, Vec z_dot, double shift, Mat jacobian,
                             Mat mass) const {
  const Assembly& assembly = *assembly_;
  assembly.tangents(t, assembly.gathered(z), assembly.gathered(z_dot));
  std::vector<double>& K = assembly.jacobian[0].values();
  const std::vector<double>& M = assembly.jacobian[1].values();
  if (mass != nullptr) {
    std::size_t entry = 0;
    std::vector<PetscScalar> row_values;
    for (PetscInt i = 0; i < size(); ++i) {
      const auto& columns = assembly.mass_columns[static_cast<std::size_t>(i)];
      const bool own = i >= assembly.first_row && i < assembly.last_row;
      row_values.clear();
      for (std::size_t c = 0; c < columns.size(); ++c)
        row_values.push_back(M[assembly.mass_offsets[entry++]]);
      if (own && !columns.empty())
        petsc::check(MatSetValues(mass, 1, &i, static_cast<PetscInt>(columns.size()),
                                  columns.data(), row_values.data(), INSERT_VALUES));
    }
    petsc::check(MatAssemblyBegin(mass, MAT_FINAL_ASSEMBLY));
    petsc::check(MatAssemblyEnd(mass, MAT_FINAL_ASSEMBLY));
  }
  if (jacobian != nullptr) {
    if (shift != 0.0)
      for (std::size_t i = 0; i < K.size(); ++i) K[i] += shift * M[i];
    assembly.jacobian[0].copy_to(jacobian);
  }
}

}  // namespace samara::system
