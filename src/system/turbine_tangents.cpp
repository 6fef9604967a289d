#include "turbine_tangents.hpp"

#include <array>
#include <limits>
#include <set>

#include "samara/math/autodiff.hpp"

namespace samara::system {
namespace {

using elements::Attachment;
using elements::PointTerms;

constexpr int block = model::Layout::block;
using State = TurbineResidual::State<double>;

// Independent quantities of a point or beam end: z (18), z_dot (18), attachment (9).
constexpr int point_inputs = 2 * block + 9;
using PointDual = math::Dual<point_inputs>;
using PointDualState = Eigen::Matrix<PointDual, block, 1>;
using ChainDual = math::Dual<chain_inputs>;
using MotionJacobian = Eigen::Matrix<double, 9, chain_motion_inputs>;
using PointInputs = Eigen::Matrix<double, point_inputs, 1>;
using TermJacobian = Eigen::Matrix<double, 3, point_inputs>;
using LoadJacobian = Eigen::Matrix<double, 6, 3>;  // of force and moment by theta

TermJacobian jacobian_of(const Vec3<PointDual>& term) {
  TermJacobian j;
  for (int i = 0; i < 3; ++i) j.row(i) = term(i).derivatives();
  return j;
}

/// The block columns of every block row.
class Pattern {
 public:
  explicit Pattern(const TurbineResidual& equations)
      : equations_(equations), turbine_(equations.turbine()), layout_(equations.layout()) {}

  std::vector<std::vector<int>> pattern() const {
    std::vector<std::set<int>> found(static_cast<std::size_t>(layout_.blocks()));
    const auto couple = [&found](int row, int column) {
      found[static_cast<std::size_t>(row / block)].insert(column / block);
    };
    const int hub_first = layout_.yaw();
    for (int i = hub_first; i < layout_.size(); i += block)
      for (int j = hub_first; j < layout_.size(); j += block) couple(i, j);
    for (int i = 0; i < layout_.size(); i += block) couple(i, i);
    for (const PlacedBeam& placed : equations_.beams()) {
      const model::Beam& beam = *placed.beam;
      for (int p = 0; p < beam.point_count(); ++p) {
        const int first = placed.points[static_cast<std::size_t>(p)];
        for (int node = 0; node <= beam.order; ++node) {
          for (const int row : {placed.strain_rows(p, node), placed.force_rows(p, node)}) {
            couple(row, first);
            if (placed.on_hub()) couple_to_motion(couple, row);
          }
        }
      }
      couple(placed.root, placed.root);
      if (beam.has_drag) couple_drag(couple, placed);
      couple(placed.points.back(), placed.tip);
      if (placed.on_hub()) couple_to_motion(couple, placed.tip);
      for (std::size_t m = 0; m < beam.mass_nodes.size(); ++m) {
        const auto next = static_cast<std::size_t>(beam.mass_nodes[m].end * beam.order);
        couple(next == 0 ? placed.root : placed.points[next - 1], placed.masses[m]);
        couple(placed.points[next], placed.masses[m]);
        if (placed.on_hub()) couple_to_motion(couple, placed.masses[m]);
      }
    }
    if (turbine_.has_tower) {
      for (int j = hub_first; j < layout_.size(); j += block) couple(layout_.tower_tip(), j);
      couple(hub_first, layout_.tower_tip());
      couple(layout_.yaw(), layout_.tower_tip());
    }
    std::vector<std::vector<int>> columns;
    for (const std::set<int>& row : found) columns.emplace_back(row.begin(), row.end());
    return columns;
  }

 private:
  /// The root has the reactions of all sections, which see its motion where it stands on springs.
  template <class Couple>
  static void couple_drag(const Couple& couple, const PlacedBeam& placed) {
    const model::Beam& beam = *placed.beam;
    for (int p = 0; p < beam.point_count(); ++p) {
      couple(placed.root_rows(), placed.points[static_cast<std::size_t>(p)]);
      for (int node = 0; beam.has_support && node <= beam.order; ++node)
        couple(placed.force_rows(p, node), placed.masses.front());
    }
  }

  template <class Couple>
  void couple_to_motion(const Couple& couple, int row) const {
    couple(row, layout_.joints());
    if (turbine_.has_tower) couple(row, layout_.tower_tip());
  }

  const TurbineResidual& equations_;
  const model::Turbine& turbine_;
  const model::Layout& layout_;
};

}  // namespace

/// The tangents of a point's terms, and where they hold.
struct TurbineTangents::PointTangents {
  PointInputs inputs = PointInputs::Constant(std::numeric_limits<double>::quiet_NaN());
  TermJacobian force_flux, force_load, moment_flux, moment_load, stretch, turn, velocity, spin;
};

/// Differentiates and adds into K and M.
class TurbineTangents::Scatter {
 public:
  explicit Scatter(TurbineTangents& owner)
      : equations_(owner.equations_),
        turbine_(equations_.turbine()),
        layout_(equations_.layout()),
        points_(owner.points_),
        K_(owner.K_),
        M_(owner.M_) {}

  void evaluate(double t, const std::vector<double>& z, const std::vector<double>& z_dot) {
    t_ = t;
    const auto make = [](double value, int i) { return math::independent<chain_inputs>(value, i); };
    elements::HubMotion<ChainDual> hub;
    const elements::ChainRows<ChainDual> rows = elements::rigid_chain(
        turbine_.chain, equations_.chain_state<ChainDual>(t, z, z_dot, make), hub);
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
    auto point = points_.begin();
    for (const PlacedBeam& placed : equations_.beams()) {
      const Attachment<double> a = equations_.attachment(placed, motion, t);
      MotionJacobian root = MotionJacobian::Zero();
      if (placed.on_hub()) root = root_jacobian(placed, motion_jacobian);
      const auto first = point;
      for (int p = 0; p < placed.beam->point_count(); ++p)
        add_point_tangent(placed, p, root, at_point(placed, p, a, z, z_dot, *point++));
      add_end_tangents(placed, a, root, z, z_dot);
      add_change_tangents(placed, z, &*first);
      add_load_tangents(placed, t, z);
      if (placed.beam->has_drag) add_drag_tangents(placed, z, z_dot);
    }
    add_chain_tangents(rows);
  }

 private:
  static void add(BlockMatrix& matrix, int i, int j, double value) {
    matrix.at(i / block, j / block)(i % block, j % block) += value;
  }

  void add_motion(int row, const Eigen::Matrix<double, 3, chain_motion_inputs>& values) {
    for (int c = 0; c < chain_motion_inputs; ++c) {
      const int unknown = equations_.chain_unknown(c);
      if (unknown < 0 || values.col(c).isZero(0.0)) continue;
      BlockMatrix::Block target = K_.at(row / block, unknown / block);
      target.block<3, 1>(row % block, unknown % block) += values.col(c);
    }
  }

  static PointInputs inputs_of(const State& z, const State& z_dot, const Attachment<double>& a) {
    PointInputs inputs;
    inputs << z, z_dot, a.v, a.omega, a.gravity;
    return inputs;
  }

  static void fill_inputs(const PointInputs& inputs, PointDualState& dual, PointDualState& dual_dot,
                          Attachment<PointDual>& dual_a) {
    const auto input = [&inputs](int i) { return math::independent<point_inputs>(inputs(i), i); };
    for (int i = 0; i < block; ++i) {
      dual(i) = input(i);
      dual_dot(i) = input(block + i);
    }
    for (int i = 0; i < 3; ++i) {
      dual_a.v(i) = input(2 * block + i);
      dual_a.omega(i) = input(2 * block + 3 + i);
      dual_a.gravity(i) = input(2 * block + 6 + i);
    }
  }

  /// Adds three rows that depend on the 18 unknowns from `first`, their rates and the attachment.
  void add_term(int row, int first, const TermJacobian& term, const MotionJacobian& root,
                bool on_hub) {
    K_.at(row / block, first / block).block<3, block>(row % block, 0) += term.leftCols<block>();
    M_.at(row / block, first / block).block<3, block>(row % block, 0) +=
        term.middleCols<block>(block);
    if (!on_hub) return;
    const Eigen::Matrix<double, 3, chain_motion_inputs> carried = term.rightCols<9>() * root;
    add_motion(row, carried);
  }

  /// The tangents of a point, taken again only where it moves otherwise than the last time: a rotor
  /// whose coefficients are constant in its own axes asks for the same ones at every azimuth.
  const PointTangents& at_point(const PlacedBeam& placed, int p, const Attachment<double>& a,
                                const std::vector<double>& z, const std::vector<double>& z_dot,
                                PointTangents& tangents) const {
    const int first = placed.points[static_cast<std::size_t>(p)];
    const PointInputs inputs =
        inputs_of(TurbineResidual::at(z, first), TurbineResidual::at(z_dot, first), a);
    if (inputs == tangents.inputs) return tangents;
    PointDualState dual;
    PointDualState dual_dot;
    Attachment<PointDual> dual_a;
    fill_inputs(inputs, dual, dual_dot, dual_a);
    const PointTerms<PointDual> terms = elements::beam_point_terms<PointDual>(
        placed.beam->points[static_cast<std::size_t>(p)], dual, dual_dot, dual_a);
    tangents.inputs = inputs;
    tangents.force_flux = jacobian_of(terms.force_flux);
    tangents.force_load = jacobian_of(terms.force_load);
    tangents.moment_flux = jacobian_of(terms.moment_flux);
    tangents.moment_load = jacobian_of(terms.moment_load);
    tangents.stretch = jacobian_of(terms.stretch);
    tangents.turn = jacobian_of(terms.turn);
    tangents.velocity = jacobian_of(terms.velocity);
    tangents.spin = jacobian_of(terms.spin);
    return tangents;
  }

  void add_point_tangent(const PlacedBeam& placed, int p, const MotionJacobian& root,
                         const PointTangents& terms) {
    const model::Beam& beam = *placed.beam;
    const int first = placed.points[static_cast<std::size_t>(p)];
    TermJacobian u = TermJacobian::Zero();
    TermJacobian theta = TermJacobian::Zero();
    u.block<3, 3>(0, 0).setIdentity();
    theta.block<3, 3>(0, 3).setIdentity();
    add_term(first + 6, first, terms.velocity, root, placed.on_hub());
    add_term(first + 9, first, terms.spin, root, placed.on_hub());
    for (int node = 0; node <= beam.order; ++node) {
      const auto [slope, value] = placed.node_weights(node, p);
      const int strain = placed.strain_rows(p, node);
      const int force = placed.force_rows(p, node);
      const TermJacobian strain_rows_j = -slope * u - value * terms.stretch;
      const TermJacobian curvature_rows_j = -slope * theta - value * terms.turn;
      const TermJacobian force_rows_j = slope * terms.force_flux + value * terms.force_load;
      const TermJacobian moment_rows_j = slope * terms.moment_flux + value * terms.moment_load;
      add_term(strain, first, strain_rows_j, root, false);
      add_term(strain + 3, first, curvature_rows_j, root, false);
      add_term(force, first, force_rows_j, root, placed.on_hub());
      add_term(force + 3, first, moment_rows_j, root, placed.on_hub());
    }
  }

  void add_end_tangents(const PlacedBeam& placed, const Attachment<double>& a,
                        const MotionJacobian& root, const std::vector<double>& z,
                        const std::vector<double>& z_dot) {
    const model::Beam& beam = *placed.beam;
    for (int i = 0; i < 6; ++i) add(K_, placed.root + i, placed.root + i, 1.0);
    Vector6 tip_balance = Vector6::Zero();
    const auto add_end = [&](int first, int point, const Vector3& x, const Matrix3& reference,
                             const Matrix6& mass, bool balance) {
      for (int i = 0; i < 6; ++i) {
        add(K_, first + i, first + i, 1.0);
        add(K_, placed.points[static_cast<std::size_t>(point)] + 12 + i, first + 12 + i, -1.0);
      }
      PointDualState dual;
      PointDualState dual_dot;
      Attachment<PointDual> dual_a;
      fill_inputs(inputs_of(TurbineResidual::at(z, first), TurbineResidual::at(z_dot, first), a),
                  dual, dual_dot, dual_a);
      const elements::TipTerms<PointDual> terms =
          elements::beam_tip_terms<PointDual>(x, reference, mass, dual, dual_dot, dual_a);
      add_term(first + 6, first, jacobian_of(terms.velocity), root, placed.on_hub());
      add_term(first + 9, first, jacobian_of(terms.spin), root, placed.on_hub());
      if (!balance) return;
      add_term(first + 12, first, jacobian_of(terms.force), root, placed.on_hub());
      add_term(first + 15, first, jacobian_of(terms.moment), root, placed.on_hub());
      for (int i = 0; i < 3 && first == placed.tip; ++i) {
        tip_balance(i) = terms.force(i).value();
        tip_balance(3 + i) = terms.moment(i).value();
      }
    };
    add_end(placed.tip, beam.point_count() - 1, beam.tip, beam.reference(beam.elements - 1),
            beam.tip_mass, placed.on_hub());
    if (placed.on_hub()) add_end_support_tangent(placed, z, tip_balance);
    for (std::size_t m = 0; m < beam.mass_nodes.size(); ++m) {
      const model::MassNode& node = beam.mass_nodes[m];
      const int next = node.end * beam.order;
      const int first = placed.masses[m];
      if (node.end == 0)
        add_support_tangent(placed, first, a, root, z, z_dot);
      else
        add_end(first, next - 1, node.x, beam.reference(node.end - 1), node.mass, true);
      for (int i = 0; i < 6; ++i)
        add(K_, placed.points[static_cast<std::size_t>(next)] + i, first + i, -1.0);
    }
  }

  /// Two terms of three rows each.
  void add_terms(int row, int first, const Vec6<PointDual>& terms, const MotionJacobian& root,
                 bool on_hub) {
    add_term(row, first, jacobian_of(terms.head<3>()), root, on_hub);
    add_term(row + 3, first, jacobian_of(terms.tail<3>()), root, on_hub);
  }

  void add_support_tangent(const PlacedBeam& placed, int first, const Attachment<double>& a,
                           const MotionJacobian& root, const std::vector<double>& z,
                           const std::vector<double>& z_dot) {
    const model::Beam& beam = *placed.beam;
    PointDualState node;
    PointDualState node_dot;
    Attachment<PointDual> dual_a;
    fill_inputs(inputs_of(TurbineResidual::at(z, first), TurbineResidual::at(z_dot, first), a),
                node, node_dot, dual_a);
    const elements::RootSupportTerms<PointDual> held =
        elements::root_support_terms<PointDual>(beam.support, node, node_dot);
    node.segment<6>(12) = held.load;
    const elements::TipTerms<PointDual> terms = elements::beam_tip_terms<PointDual>(
        Vector3::Zero(), Matrix3::Identity(), beam.mass_nodes.front().mass, node, node_dot, dual_a);
    add_terms(first, first, held.law, root, false);
    add_terms(placed.root, first, -held.root, root, false);
    add_term(first + 6, first, jacobian_of(terms.velocity), root, placed.on_hub());
    add_term(first + 9, first, jacobian_of(terms.spin), root, placed.on_hub());
    add_term(first + 12, first, jacobian_of(terms.force), root, placed.on_hub());
    add_term(first + 15, first, jacobian_of(terms.moment), root, placed.on_hub());
  }

  /// The rows of the end, whose balance has been added before.
  void add_end_support_tangent(const PlacedBeam& placed, const std::vector<double>& z,
                               const Vector6& balance) {
    using EndDual = math::Dual<6>;
    const elements::EndSupport& support = placed.beam->end_support;
    if (support.is_none()) return;
    const Vector6 position = Eigen::Map<const Vector6>(z.data() + placed.tip);
    Vec6<EndDual> end;
    for (int i = 0; i < 6; ++i) end(i) = math::independent<6>(position(i), i);
    const Vec6<EndDual> rows = elements::end_support_rows<EndDual>(support, placed.end_reference,
                                                                   end, balance.cast<EndDual>());
    const auto rows_of = [&](const Vector6& some) -> Vector6 {
      return elements::end_support_rows<double>(support, placed.end_reference, position, some);
    };
    Matrix6 by_balance;  // in which the rows are linear
    for (int i = 0; i < 6; ++i)
      by_balance.col(i) = rows_of(Vector6::Unit(i)) - rows_of(Vector6::Zero());
    const int row = placed.tip / block;
    for (BlockMatrix* matrix : {&K_, &M_})
      for (const int column : matrix->columns()[static_cast<std::size_t>(row)]) {
        BlockMatrix::Block target = matrix->at(row, column);
        const Eigen::Matrix<double, 6, block> before = target.middleRows<6>(12);
        target.middleRows<6>(12) = by_balance * before;
      }
    BlockMatrix::Block K = K_.at(row, row);
    for (int i = 0; i < 6; ++i) K.block<1, 6>(12 + i, 0) += rows(i).derivatives().transpose();
  }

  /// `points`: tangents of the beam's points.
  void add_change_tangents(const PlacedBeam& placed, const std::vector<double>& z,
                           const PointTangents* points) {
    const model::Beam& beam = *placed.beam;
    for (const ReferenceChange& change : placed.changes) {
      const Vector3 before = equations_.rotation_before(placed, change, z);
      Vec3<math::Dual<3>> dual;
      for (int i = 0; i < 3; ++i) dual(i) = math::independent<3>(before(i), i);
      const Vec3<math::Dual<3>> anew =
          math::compose<math::Dual<3>>(dual, change.turn.cast<math::Dual<3>>());
      Matrix3 missed = Matrix3::Identity();
      for (int i = 0; i < 3; ++i) missed.row(i) -= anew(i).derivatives();
      if (change.mass >= 0) {
        K_.at(change.row / block, change.mass / block).block<3, 3>(change.row % block, 3) += missed;
        continue;
      }
      for (int j = 0; j < beam.order && change.element > 0; ++j) {
        const int p = (change.element - 1) * beam.order + j;
        const auto [slope, value] = placed.node_weights(beam.order, p);
        const int first = placed.points[static_cast<std::size_t>(p)];
        TermJacobian rotation = value * points[p].turn;
        rotation.block<3, 3>(0, 3) += slope * Matrix3::Identity();
        add_term(change.row, first, missed * rotation, {}, false);
      }
    }
  }

  // Independent quantities of a drag: u, u_dot; u, theta of the root and their rates.
  using DragDual = math::Dual<18>;
  using DragJacobian = Eigen::Matrix<double, 3, 18>;

  void add_drag_tangents(const PlacedBeam& placed, const std::vector<double>& z,
                         const std::vector<double>& z_dot) {
    const model::Beam& beam = *placed.beam;
    const auto three = [](const std::vector<double>& values, int first, int quantity) {
      Vec3<DragDual> dual;
      for (int i = 0; i < 3; ++i)
        dual(i) = math::independent<18>(values[static_cast<std::size_t>(first + i)], quantity + i);
      return dual;
    };
    elements::RootMotion<DragDual> root;
    const int base = beam.has_support ? placed.masses.front() : -1;
    if (beam.has_support)
      root = {three(z, base, 6), three(z, base + 3, 9), three(z_dot, base, 12),
              three(z_dot, base + 3, 15)};
    const auto add_rows = [&](int row, int first, const DragJacobian& j) {
      K_.at(row / block, first / block).block<3, 3>(row % block, 0) += j.middleCols<3>(0);
      M_.at(row / block, first / block).block<3, 3>(row % block, 0) += j.middleCols<3>(3);
      if (base < 0) return;
      K_.at(row / block, base / block).block<3, 6>(row % block, 0) += j.middleCols<6>(6);
      M_.at(row / block, base / block).block<3, 6>(row % block, 0) += j.middleCols<6>(12);
    };
    for (int p = 0; p < beam.point_count(); ++p) {
      const elements::BeamPoint& point = beam.points[static_cast<std::size_t>(p)];
      const int first = placed.points[static_cast<std::size_t>(p)];
      const elements::DragTerms<DragDual> drag = elements::beam_drag_terms<DragDual>(
          point.x, point.drag, three(z, first, 0), three(z_dot, first, 3),
          beam.has_support ? &root : nullptr);
      DragJacobian force, moment;
      for (int i = 0; i < 3; ++i) {
        force.row(i) = drag.force(i).derivatives();
        moment.row(i) = drag.moment(i).derivatives();
      }
      for (int node = 0; node <= beam.order; ++node)
        add_rows(placed.force_rows(p, node), first, -placed.node_weights(node, p)[1] * force);
      add_rows(placed.root_rows(), first, beam.point_length(p) * force);
      add_rows(placed.root_rows() + 3, first, beam.point_length(p) * moment);
    }
  }

  /// Only what turns with the sections depends on the state.
  void add_load_tangents(const PlacedBeam& placed, double t, const std::vector<double>& z) {
    const model::Beam& beam = *placed.beam;
    for (const model::BeamLoad& load : beam.loads) {
      if (!load.follower) continue;
      const Vector6 value = load.at(t, turbine_.speed);
      if (load.at_tip)
        add_follower(placed.force_rows(beam.point_count() - 1, beam.order), placed.tip, 1.0,
                     follower_tangent(z, placed.tip,
                                      beam.reference(beam.elements - 1) * load.tip_axes, value));
      for (std::size_t e = 0; e < load.weights.size(); ++e) {
        const int start = (load.first_element + static_cast<int>(e)) * beam.order;
        for (int j = 0; j < beam.order; ++j) {
          const auto p = static_cast<std::size_t>(start + j);
          const LoadJacobian tangent = follower_tangent(
              z, placed.points[p], beam.points[p].reference * beam.points[p].C_ab, value);
          for (int node = 0; node <= beam.order; ++node)
            add_follower(placed.force_rows(start, node), placed.points[p], load.weights[e](node, j),
                         tangent);
        }
      }
    }
  }

  static LoadJacobian follower_tangent(const std::vector<double>& z, int first, const Matrix3& C_ab,
                                       const Vector6& load) {
    Vec3<math::Dual<3>> theta;
    for (int i = 0; i < 3; ++i)
      theta(i) = math::independent<3>(z[static_cast<std::size_t>(first + 3 + i)], i);
    const Vec6<math::Dual<3>> turned = elements::follower_load<math::Dual<3>>(theta, C_ab, load);
    LoadJacobian j;
    for (int i = 0; i < 6; ++i) j.row(i) = turned(i).derivatives();
    return j;
  }

  void add_follower(int row, int first, double weight, const LoadJacobian& tangent) {
    K_.at(row / block, first / block).block<6, 3>(row % block, 3) -= weight * tangent;
  }

  void add_chain_row(int row, const ChainDual& value) {
    for (int i = 0; i < at_hub_load; ++i) {
      const int unknown = equations_.chain_unknown(i);
      const double d = value.derivatives()(i);
      if (unknown < 0 || d == 0.0) continue;
      add(i >= at_top_velocity_dot && i < at_top_load ? M_ : K_, row, unknown, d);
    }
    const Vector6 by_hub_load = value.derivatives().segment<6>(at_hub_load);
    if (by_hub_load.isZero(0.0)) return;
    for (const PlacedBeam& placed : equations_.beams()) {
      if (!placed.on_hub()) continue;
      Vector6 by_root = placed.hub_from_root().transpose() * by_hub_load;
      if (const BladePitch<double> pitch = equations_.pitch_of<double>(placed, t_); pitch.moves) {
        const Matrix3 feather = pitch.feather();
        by_root << feather.transpose() * by_root.head<3>(), feather.transpose() * by_root.tail<3>();
      }
      for (int i = 0; i < 6; ++i) add(K_, row, placed.root + i, by_root(i));
    }
  }

  /// Of v_a, omega_a and gravity at a blade's root.
  MotionJacobian root_jacobian(const PlacedBeam& placed, const MotionJacobian& of_hub) const {
    MotionJacobian root = placed.root_from_hub() * of_hub;
    const BladePitch<double> pitch = equations_.pitch_of<double>(placed, t_);
    if (!pitch.moves) return root;
    const Matrix3 feather = pitch.feather();
    for (int vector = 0; vector < 9; vector += 3)
      root.middleRows<3>(vector) = (feather.transpose() * root.middleRows<3>(vector)).eval();
    return root;
  }

  void add_chain_tangents(const elements::ChainRows<ChainDual>& rows) {
    if (turbine_.has_tower)
      for (int i = 0; i < 6; ++i) add_chain_row(layout_.tower_tip() + 12 + i, rows.top(i));
    const elements::RigidChain& chain = turbine_.chain;
    add_joint_tangents(layout_.yaw(), chain.yaw.free, rows.yaw);
    add_joint_tangents(layout_.teeter(), chain.teeter.free, rows.teeter);
    add_joint_tangents(layout_.shaft_torsion(), chain.torsion.free, rows.torsion);
    add_joint_tangents(layout_.generator(), chain.generator.free, rows.generator);
    for (const int i : layout_.padding()) add(K_, i, i, 1.0);
  }

  void add_joint_tangents(int first, bool free, const elements::JointRows<ChainDual>& rows) {
    if (free) {
      add_chain_row(first, rows.kinematic);
      add_chain_row(first + 1, rows.balance);
    } else {
      add_chain_row(first, rows.position);
      add_chain_row(first + 1, rows.kinematic);
    }
  }

  const TurbineResidual& equations_;
  const model::Turbine& turbine_;
  const model::Layout& layout_;
  std::vector<PointTangents>& points_;
  BlockMatrix& K_;
  BlockMatrix& M_;
  double t_ = 0.0;
};

TurbineTangents::TurbineTangents(const TurbineResidual& equations)
    : equations_(equations), K_(Pattern(equations).pattern()), M_(K_.columns()) {
  std::size_t points = 0;
  for (const PlacedBeam& placed : equations.beams()) points += placed.points.size();
  points_.resize(points);
}

TurbineTangents::~TurbineTangents() = default;

void TurbineTangents::evaluate(double t, const std::vector<double>& z,
                               const std::vector<double>& z_dot) {
  K_.clear();
  M_.clear();
  Scatter(*this).evaluate(t, z, z_dot);
}

}  // namespace samara::system
