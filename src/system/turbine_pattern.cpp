#include "turbine_pattern.hpp"

#include <algorithm>
#include <limits>

#include "samara/math/dependence.hpp"

namespace samara::system {
namespace {

using elements::Attachment;
using math::Dependence;

constexpr int block = model::Layout::block;
using State = TurbineResidual::State<Dependence>;

/// A number that changes with time.
constexpr double any = std::numeric_limits<double>::quiet_NaN();

// What the terms of a point or beam end depend on: z (18), z_dot (18), the hub's motion.
constexpr int at_rates = block;
constexpr int at_motion = 2 * block;
static_assert(at_motion + chain_motion_inputs <= Dependence::most_quantities);
static_assert(chain_inputs <= Dependence::most_quantities);

/// The unknowns of a point or beam end and their rates.
struct PointState {
  State z, z_dot;
  PointState() {
    for (int i = 0; i < block; ++i) {
      z(i) = Dependence::on(i);
      z_dot(i) = Dependence::on(at_rates + i);
    }
  }
};

/// Goes the way of TurbineTangents, with dependences instead of derivatives.
class PatternFinder {
 public:
  explicit PatternFinder(const TurbineResidual& equations)
      : equations_(equations), turbine_(equations.turbine()), layout_(equations.layout()) {
    pattern_.K.resize(static_cast<std::size_t>(layout_.size()));
    pattern_.M.resize(static_cast<std::size_t>(layout_.size()));
  }

  TurbinePattern run() {
    elements::HubMotion<Dependence> hub;
    const elements::ChainRows<Dependence> rows =
        elements::rigid_chain(chain_at_any_speed(), chain_state(), hub);
    for (const PlacedBeam& placed : equations_.beams()) {
      const Attachment<Dependence> a = attachment(placed, hub);
      for (int p = 0; p < placed.beam->point_count(); ++p) add_point(placed, p, a);
      add_ends(placed, a);
      add_changes(placed);
      add_loads(placed);
      if (placed.beam->has_drag) add_drag(placed);
    }
    add_chain(rows);
    for (std::vector<std::vector<int>>* rows_of : {&pattern_.K, &pattern_.M})
      for (std::vector<int>& columns : *rows_of) {
        std::sort(columns.begin(), columns.end());
        columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
      }
    return std::move(pattern_);
  }

 private:
  std::vector<int>& K(int row) { return pattern_.K[static_cast<std::size_t>(row)]; }
  std::vector<int>& M(int row) { return pattern_.M[static_cast<std::size_t>(row)]; }

  // ---- what carries the beams ------------------------------------------------------------------

  /// A table may have any slope.
  elements::RigidChain chain_at_any_speed() const {
    elements::RigidChain chain = turbine_.chain;
    for (elements::TorqueLine* line : {&chain.generator_torque, &chain.rotor_torque})
      if (!line->table.empty()) *line = {any, any, any, {}};
    return chain;
  }

  /// At any time: what changes with it may have any value.
  elements::ChainState<Dependence> chain_state() const {
    const auto make = [this](double, int i) {
      const bool is_there = i >= at_hub_load || equations_.chain_unknown(i) >= 0;
      return is_there ? Dependence::on(i) : Dependence();
    };
    const std::vector<double> rest(static_cast<std::size_t>(layout_.size()), 0.0);
    elements::ChainState<Dependence> state =
        equations_.chain_state<Dependence>(0.0, rest, rest, make);
    const model::Operation& operation = turbine_.operation;
    if (operation.yaw || !turbine_.yaw_motion.is_constant()) state.yaw.prescribed = {any, any, any};
    if (operation.teeter || !turbine_.teeter_motion.is_constant())
      state.teeter.prescribed = {any, any, any};
    if (operation.turning || turbine_.speed != 0.0) state.azimuth = any;
    if (operation.turning) state.speed = state.speed_dot = any;
    return state;
  }

  bool blades_pitch() const { return !turbine_.operation.pitch.empty(); }

  /// From the axes that C_Ha states to the turned ones, or back.
  static void feather(Eigen::Ref<Vec3<Dependence>> vector) {
    const BladePitch<Dependence> pitch{true, Dependence::varying(), Dependence::varying()};
    vector = (pitch.feather() * vector).eval();
  }

  Attachment<Dependence> attachment(const PlacedBeam& placed,
                                    const elements::HubMotion<Dependence>& hub) const {
    if (!placed.on_hub()) return equations_.attachment<Dependence>(placed, hub, 0.0);
    Eigen::Matrix<Dependence, 9, 1> motion;
    motion << hub.velocity, hub.omega, hub.gravity;
    for (int i = 0; i < 9; ++i) motion(i) = motion(i).shifted(at_motion);
    motion = (placed.root_from_hub().cast<Dependence>() * motion).eval();
    Attachment<Dependence> a{motion.segment<3>(0), motion.segment<3>(3), motion.segment<3>(6)};
    if (!blades_pitch()) return a;
    for (Vec3<Dependence>* vector : {&a.v, &a.omega, &a.gravity}) feather(*vector);
    a.omega(0) -= Dependence::varying();
    return a;
  }

  // ---- rows of beams ---------------------------------------------------------------------------

  /// A row that depends on the 18 unknowns from `first`, their rates and the hub's motion.
  void add(int row, int first, const Dependence& term) {
    for (int i = 0; i < block; ++i) {
      if (term.is_on(i)) K(row).push_back(first + i);
      if (term.is_on(at_rates + i)) M(row).push_back(first + i);
    }
    for (int i = 0; i < chain_motion_inputs; ++i)
      if (term.is_on(at_motion + i)) K(row).push_back(equations_.chain_unknown(i));
  }

  template <class Terms>
  void add_rows(int row, int first, const Terms& terms) {
    for (int i = 0; i < terms.size(); ++i) add(row + i, first, terms(i));
  }

  void add_identity(int row, int column) {
    for (int i = 0; i < 6; ++i) K(row + i).push_back(column + i);
  }

  void add_point(const PlacedBeam& placed, int p, const Attachment<Dependence>& a) {
    const model::Beam& beam = *placed.beam;
    const int first = placed.points[static_cast<std::size_t>(p)];
    const elements::PointTerms<Dependence> terms = elements::beam_point_terms<Dependence>(
        beam.points[static_cast<std::size_t>(p)], point_.z, point_.z_dot, a);
    add_rows(first + 6, first, terms.velocity);
    add_rows(first + 9, first, terms.spin);
    for (int node = 0; node <= beam.order; ++node) {
      const auto [slope, value] = placed.node_weights(node, p);
      const int strain = placed.strain_rows(p, node);
      const int force = placed.force_rows(p, node);
      if (slope != 0.0) {
        add_identity(strain, first);
        add_rows(force, first, terms.force_flux);
        add_rows(force + 3, first, terms.moment_flux);
      }
      if (value != 0.0) {
        add_rows(strain, first, terms.stretch);
        add_rows(strain + 3, first, terms.turn);
        add_rows(force, first, terms.force_load);
        add_rows(force + 3, first, terms.moment_load);
      }
    }
  }

  void add_ends(const PlacedBeam& placed, const Attachment<Dependence>& a) {
    const model::Beam& beam = *placed.beam;
    add_identity(placed.root, placed.root);
    const auto add_end = [&](int first, int point, const Vector3& x, const Matrix3& reference,
                             const Matrix6& mass, bool balance) {
      add_identity(first, first);
      add_identity(placed.points[static_cast<std::size_t>(point)] + 12, first + 12);
      const elements::TipTerms<Dependence> terms =
          elements::beam_tip_terms<Dependence>(x, reference, mass, point_.z, point_.z_dot, a);
      add_end_rows(first, terms, balance);
    };
    add_end(placed.tip, beam.point_count() - 1, beam.tip, beam.reference(beam.elements - 1),
            beam.tip_mass, placed.on_hub());
    if (placed.on_hub() && !beam.end_support.is_none()) add_end_support(placed);
    for (std::size_t m = 0; m < beam.mass_nodes.size(); ++m) {
      const model::MassNode& node = beam.mass_nodes[m];
      const int next = node.end * beam.order;
      const int first = placed.masses[m];
      if (node.end == 0)
        add_support(placed, first, a);
      else
        add_end(first, next - 1, node.x, beam.reference(node.end - 1), node.mass, true);
      add_identity(placed.points[static_cast<std::size_t>(next)], first);
    }
  }

  void add_end_rows(int first, const elements::TipTerms<Dependence>& terms, bool balance) {
    add_rows(first + 6, first, terms.velocity);
    add_rows(first + 9, first, terms.spin);
    if (!balance) return;
    add_rows(first + 12, first, terms.force);
    add_rows(first + 15, first, terms.moment);
  }

  void add_support(const PlacedBeam& placed, int first, const Attachment<Dependence>& a) {
    const model::Beam& beam = *placed.beam;
    State node = point_.z;
    const elements::RootSupportTerms<Dependence> held =
        elements::root_support_terms<Dependence>(beam.support, node, point_.z_dot);
    node.segment<6>(12) = held.load;
    add_rows(first, first, held.law);
    add_rows(placed.root, first, held.root);
    add_end_rows(
        first,
        elements::beam_tip_terms<Dependence>(Vector3::Zero(), Matrix3::Identity(),
                                             beam.mass_nodes.front().mass, node, point_.z_dot, a),
        true);
  }

  /// The rows of the end, whose balance has been added before and is combined anew.
  void add_end_support(const PlacedBeam& placed) {
    Vec6<Dependence> end;
    Vec6<Dependence> balance;
    for (int i = 0; i < 6; ++i) {
      end(i) = Dependence::on(i);
      balance(i) = Dependence::on(6 + i);
    }
    const Vec6<Dependence> rows = elements::end_support_rows<Dependence>(
        placed.beam->end_support, placed.end_reference, end, balance);
    const int first = placed.tip + 12;
    for (std::vector<std::vector<int>>* rows_of : {&pattern_.K, &pattern_.M}) {
      const auto at = rows_of->begin() + first;
      const std::vector<std::vector<int>> before(at, at + 6);
      for (int i = 0; i < 6; ++i) {
        at[i].clear();
        for (int j = 0; j < 6; ++j) {
          const std::vector<int>& part = before[static_cast<std::size_t>(j)];
          if (rows(i).is_on(6 + j)) at[i].insert(at[i].end(), part.begin(), part.end());
        }
      }
    }
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        if (rows(i).is_on(j)) K(first + i).push_back(placed.tip + j);
  }

  void add_changes(const PlacedBeam& placed) {
    const model::Beam& beam = *placed.beam;
    Vec3<Dependence> before;
    for (int i = 0; i < 3; ++i) before(i) = Dependence::on(i);
    for (const ReferenceChange& change : placed.changes) {
      const Vec3<Dependence> missed =
          before - math::compose<Dependence>(before, change.turn.cast<Dependence>());
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          if (!missed(i).is_on(j)) continue;
          if (change.mass >= 0)
            K(change.row + i).push_back(change.mass + 3 + j);
          else if (change.element > 0)
            add_rotation(placed, change.row + i, j, (change.element - 1) * beam.order);
        }
    }
  }

  /// Component j of the rotation that the points of an element, from number `start` on, lead to.
  void add_rotation(const PlacedBeam& placed, int row, int j, int start) {
    const model::Beam& beam = *placed.beam;
    for (int p = start; p < start + beam.order; ++p) {
      const auto [slope, value] = placed.node_weights(beam.order, p);
      const int first = placed.points[static_cast<std::size_t>(p)];
      const elements::PointTerms<Dependence> terms = elements::beam_point_terms<Dependence>(
          beam.points[static_cast<std::size_t>(p)], point_.z, State::Constant(Dependence()), {});
      if (slope != 0.0) K(row).push_back(first + 3 + j);
      if (value != 0.0) add(row, first, terms.turn(j));
    }
  }

  /// Only what turns with the sections depends on the state.
  void add_loads(const PlacedBeam& placed) {
    const model::Beam& beam = *placed.beam;
    for (const model::BeamLoad& load : beam.loads) {
      if (!load.follower) continue;
      const auto couple = [&](int row, int first) {
        for (int i = 0; i < 6; ++i) {
          if (load.load.segment<3>(i / 3 * 3).isZero(0.0)) continue;
          for (int j = 0; j < 3; ++j) K(row + i).push_back(first + 3 + j);
        }
      };
      if (load.at_tip) couple(placed.force_rows(beam.point_count() - 1, beam.order), placed.tip);
      for (std::size_t e = 0; e < load.weights.size(); ++e) {
        const int start = (load.first_element + static_cast<int>(e)) * beam.order;
        for (int j = 0; j < beam.order; ++j)
          for (int node = 0; node <= beam.order; ++node)
            if (load.weights[e](node, j) != 0.0)
              couple(placed.force_rows(start, node),
                     placed.points[static_cast<std::size_t>(start + j)]);
      }
    }
  }

  void add_drag(const PlacedBeam& placed) {
    const model::Beam& beam = *placed.beam;
    const auto three = [](int first) {
      return Vec3<Dependence>(Dependence::on(first), Dependence::on(first + 1),
                              Dependence::on(first + 2));
    };
    const elements::RootMotion<Dependence> root{three(6), three(9), three(12), three(15)};
    const int base = beam.has_support ? placed.masses.front() : 0;
    for (int p = 0; p < beam.point_count(); ++p) {
      const elements::BeamPoint& point = beam.points[static_cast<std::size_t>(p)];
      const int first = placed.points[static_cast<std::size_t>(p)];
      const elements::DragTerms<Dependence> drag = elements::beam_drag_terms<Dependence>(
          point.x, point.drag, three(0), three(3), beam.has_support ? &root : nullptr);
      const auto add_rows = [&](int row, const Vec3<Dependence>& terms) {
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) {
            if (terms(i).is_on(j)) K(row + i).push_back(first + j);
            if (terms(i).is_on(3 + j)) M(row + i).push_back(first + j);
            for (const int part : {0, 3}) {
              if (terms(i).is_on(6 + part + j)) K(row + i).push_back(base + part + j);
              if (terms(i).is_on(12 + part + j)) M(row + i).push_back(base + part + j);
            }
          }
      };
      for (int node = 0; node <= beam.order; ++node)
        if (placed.node_weights(node, p)[1] != 0.0)
          add_rows(placed.force_rows(p, node), drag.force);
      add_rows(placed.root_rows(), drag.force);
      add_rows(placed.root_rows() + 3, drag.moment);
    }
  }

  // ---- rows of the chain -----------------------------------------------------------------------

  void add_chain_row(int row, const Dependence& value) {
    for (int i = 0; i < at_hub_load; ++i) {
      if (!value.is_on(i)) continue;
      const int unknown = equations_.chain_unknown(i);
      (i >= at_top_velocity_dot && i < at_top_load ? M(row) : K(row)).push_back(unknown);
    }
    for (const PlacedBeam& placed : equations_.beams()) {
      if (!placed.on_hub()) continue;
      Vec6<Dependence> load;
      for (int i = 0; i < 6; ++i) load(i) = Dependence::on(i);
      if (blades_pitch()) {
        feather(load.head<3>());
        feather(load.tail<3>());
      }
      load = (placed.hub_from_root().cast<Dependence>() * load).eval();
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
          if (value.is_on(at_hub_load + i) && load(i).is_on(j)) K(row).push_back(placed.root + j);
    }
  }

  void add_chain(const elements::ChainRows<Dependence>& rows) {
    if (turbine_.has_tower)
      for (int i = 0; i < 6; ++i) add_chain_row(layout_.tower_tip() + 12 + i, rows.top(i));
    const elements::RigidChain& chain = turbine_.chain;
    add_joint(layout_.yaw(), chain.yaw.free, rows.yaw);
    add_joint(layout_.teeter(), chain.teeter.free, rows.teeter);
    add_joint(layout_.shaft_torsion(), chain.torsion.free, rows.torsion);
    add_joint(layout_.generator(), chain.generator.free, rows.generator);
    for (const int i : layout_.padding()) K(i).push_back(i);
  }

  void add_joint(int first, bool free, const elements::JointRows<Dependence>& rows) {
    add_chain_row(first, free ? rows.kinematic : rows.position);
    add_chain_row(first + 1, free ? rows.balance : rows.kinematic);
  }

  const TurbineResidual& equations_;
  const model::Turbine& turbine_;
  const model::Layout& layout_;
  const PointState point_;
  TurbinePattern pattern_;
};

}  // namespace

TurbinePattern find_pattern(const TurbineResidual& equations) {
  return PatternFinder(equations).run();
}

}  // namespace samara::system
