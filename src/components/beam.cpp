#include "samara/components/beam.hpp"

#include <algorithm>

#include "samara/base/index.hpp"
#include "samara/elements/beam_drag.hpp"
#include "samara/elements/beam_load.hpp"
#include "samara/elements/beam_tip.hpp"

#include "beam_mesh_error.hpp"

namespace samara::components {
namespace {

using elements::Attachment;
using elements::PointTerms;
constexpr int block = elements::point_size;

// Arguments of a point or an end: z, z_dot, motion of the root.
constexpr int end_arguments = 2 * block + 9;
// Offsets of the values of a point, three components each.
constexpr int force_flux = 0;
constexpr int force_load = 3;
constexpr int moment_flux = 6;
constexpr int moment_load = 9;
constexpr int stretch = 12;
constexpr int turn = 15;
constexpr int velocity = 18;
constexpr int spin = 21;
constexpr int point_values = 24;
// Offsets of the values of an end: motion and balance.
constexpr int end_velocity = 0;
constexpr int end_spin = 3;
constexpr int end_balance = 6;
constexpr int end_values = 12;
// Offsets of the further values of a root on its support: the law of the springs, and the load on
// the part that carries them.
constexpr int support_law = 12;
constexpr int support_root = 18;
constexpr int support_values = 24;
// Arguments of a change of reference: rotation and section load of each point of the element
// before.
constexpr int most_points = 6;
constexpr int change_arguments = 9 * most_points;
// Arguments of mass-proportional damping: u, u_dot of the point; u, theta of the root and their
// rates.
constexpr int drag_arguments = 18;

using system::EnergyGroup;
using system::PartKind;
using system::RowRole;
using system::UnknownRole;

struct NamedUnknown {
  const char* name;
  const char* unit;
};

constexpr std::array<NamedUnknown, block> point_unknowns{{{"u1", "m"},
                                                          {"u2", "m"},
                                                          {"u3", "m"},
                                                          {"theta1", "rad"},
                                                          {"theta2", "rad"},
                                                          {"theta3", "rad"},
                                                          {"V1", "m/s"},
                                                          {"V2", "m/s"},
                                                          {"V3", "m/s"},
                                                          {"Omega1", "rad/s"},
                                                          {"Omega2", "rad/s"},
                                                          {"Omega3", "rad/s"},
                                                          {"F1", "N"},
                                                          {"F2", "N"},
                                                          {"F3", "N"},
                                                          {"M1", "N m"},
                                                          {"M2", "N m"},
                                                          {"M3", "N m"}}};

UnknownRole role_at(int i) {
  return i < 6 ? UnknownRole::position : i < 12 ? UnknownRole::velocity : UnknownRole::internal;
}

RowRole row_role_at(int i) {
  return i < 6 ? RowRole::constraint : i < 12 ? RowRole::kinematic : RowRole::balance;
}

template <class T>
using EndArguments = Eigen::Matrix<T, end_arguments, 1>;
template <class T>
using State = Eigen::Matrix<T, block, 1>;

template <class T>
State<T> state_of(const EndArguments<T>& x) {
  return x.template head<block>();
}
template <class T>
State<T> rates_of(const EndArguments<T>& x) {
  return x.template segment<block>(block);
}
template <class T>
Attachment<T> attachment_of(const EndArguments<T>& x) {
  return {x.template segment<3>(2 * block), x.template segment<3>(2 * block + 3),
          x.template segment<3>(2 * block + 6)};
}

}  // namespace

// ---- places ------------------------------------------------------------------------------------

std::array<double, 2> PlacedBeam::node_weights(int a, int p) const {
  const auto j = at(p % beam->order);
  const double w = beam->functions.weights[j];
  return {w * beam->functions.slope[at(a)][j],
          w * beam->element_length(p / beam->order) * beam->functions.value[at(a)][j]};
}

int PlacedBeam::mass_at(int e) const {
  for (std::size_t m = 0; m < beam->mass_nodes.size(); ++m)
    if (beam->mass_nodes[m].end == e) return masses[m];
  return -1;
}

int PlacedBeam::strain_rows(int p, int a) const {
  const int e = p / beam->order;
  if (a == beam->order) {
    if (e + 1 == beam->elements) return tip;
    const int mass = mass_at(e + 1);
    if (mass >= 0) return mass;
  }
  return points[at(e * beam->order + a)];
}

int PlacedBeam::force_rows(int p, int a) const {
  const int e = p / beam->order;
  if (a == 0) {
    const int mass = mass_at(e);
    if (mass >= 0) return mass + 12;
    if (e == 0) return root;
  }
  return points[at(e * beam->order + a - 1)] + 12;
}

std::vector<ReferenceChange> PlacedBeam::find_changes() const {
  std::vector<ReferenceChange> changes;
  for (int e = 0; e < beam->elements; ++e) {
    const Matrix3 before = beam->reference_before(e);
    if (before == beam->reference(e)) continue;
    changes.push_back({e, points[at(e * beam->order)] + 3, mass_at(e),
                       math::parameters_of(before * beam->reference(e).transpose())});
  }
  return changes;
}

// ---- declaration -------------------------------------------------------------------------------

Beam::Beam(const BeamSetting& setting) : setting_(setting) {
  placed_.beam = setting_.mesh;
  if (setting_.mesh->order > most_points) throw InternalError("an element has too many points");
}

/// The blocks of a beam are eliminated toward the part that carries the beam, or toward the bodies
/// that the beam carries.
void Beam::place(Registry& registry) {
  const model::Beam& beam = *placed_.beam;
  placed_.points.assign(at(beam.point_count()), 0);
  placed_.masses.assign(beam.mass_nodes.size(), 0);
  if (setting_.has_air) placed_.air.assign(at(beam.point_count()), 0);
  std::vector<int*> blocks;  // root to tip
  auto mass = placed_.masses.begin();
  auto node = beam.mass_nodes.begin();
  for (int p = 0; p < beam.point_count(); ++p) {
    if (node != beam.mass_nodes.end() && node->end * beam.order == p) {
      blocks.push_back(&*mass++);
      ++node;
    }
    blocks.push_back(&placed_.points[at(p)]);
  }
  blocks.push_back(&placed_.tip);
  if (setting_.end == BeamEnd::free) std::reverse(blocks.begin(), blocks.end());
  // The air of a point is eliminated before the point: it adds entries to that point's block only.
  const auto add_block = [&](int* first) {
    const auto p = std::find_if(placed_.points.begin(), placed_.points.end(),
                                [first](const int& point) { return &point == first; });
    if (setting_.has_air && p != placed_.points.end())
      placed_.air[static_cast<std::size_t>(p - placed_.points.begin())] =
          registry.add_block(setting_.rank);
    *first = registry.add_block(setting_.rank);
  };
  for (int* first : blocks) add_block(first);
  placed_.root = registry.add_shared(setting_.shared_rank, 6);
  placed_.root_port = registry.add_port(9);
}

void Beam::describe(Registry& registry) {
  const model::Beam& beam = *placed_.beam;
  for (int p = 0; p < beam.point_count(); ++p) {
    describe_unknowns(registry, placed_.points[at(p)], "point " + std::to_string(p + 1));
    describe_energies(registry, p);
  }
  for (std::size_t m = 0; m < beam.mass_nodes.size(); ++m) {
    const int first = placed_.masses[m];
    if (beam.mass_nodes[m].end == 0) {
      describe_unknowns(registry, first, "support");
      describe_support(registry, first);
      describe_mass(registry, first, beam.support.added_mass);
    } else {  // point masses count from 1, with and without a support of the root
      describe_unknowns(registry, first, "mass " + std::to_string(beam.has_support ? m : m + 1));
    }
    describe_mass(registry, first, beam.mass_nodes[m].mass);
  }
  describe_unknowns(registry, placed_.tip, setting_.end_name);
  if (setting_.end == BeamEnd::free) describe_end_support(registry);
  describe_mass(registry, placed_.tip, beam.tip_mass);
  describe_unknowns(registry, placed_.root, "root", 12);
  for (int e = 0; e < beam.elements; ++e) registry.add(find_mesh_error(beam, e, placed_.points));

  changes_ = placed_.find_changes();
  if (!changes_.empty()) end_reference_ = math::parameters_of(beam.reference(beam.elements - 1));
  connect_points();
  connect_ends();
  connect_changes();
  connect_loads();
  if (beam.has_drag) connect_drag();
}

/// Declares the unknowns of a point from number `from` on; `first`: index of the first of them.
void Beam::describe_unknowns(Registry& registry, int first, const std::string& place,
                             int from) const {
  for (int i = from; i < block; ++i) {
    const NamedUnknown& named = point_unknowns[at(i)];
    registry.describe(first + i - from,
                      {setting_.owner, place, named.name, named.unit, role_at(i), setting_.frame},
                      row_role_at(i));
  }
}

void Beam::describe_support(Registry& registry, int first) const {
  const model::Beam& beam = *placed_.beam;
  for (int i = 0; i < 6; ++i) {
    if (beam.support.free[at(i)]) registry.set_free(first + i);
    if (beam.support.is_elastic(i))
      registry.add(EnergyGroup{EnergyGroup::Kind::strain,
                               {PartKind::support, setting_.support_part, setting_.owner.instance},
                               setting_.support_directions[at(i)],
                               setting_.frame,
                               {first + 12 + i},
                               {beam.support.compliance(i, i)},
                               beam.support.damping(i)});
  }
}

void Beam::describe_end_support(Registry& registry) const {
  const elements::EndSupport& support = placed_.beam->end_support;
  for (int i = 0; i < 6; ++i) {
    if (support.rigid[at(i)]) registry.set_row(placed_.tip + 12 + i, RowRole::constraint);
    if (support.stiffness(i, i) > 0.0)
      registry.add(EnergyGroup{EnergyGroup::Kind::strain,
                               {PartKind::support, setting_.owner.part, setting_.owner.instance},
                               "end support",
                               setting_.frame,
                               {placed_.tip + i},
                               {support.stiffness(i, i)}});
  }
}

/// A mass whose velocities are those of the block at `first`.
void Beam::describe_mass(Registry& registry, int first, const Matrix6& mass) const {
  if (mass.isZero(0.0)) return;
  EnergyGroup group{EnergyGroup::Kind::kinetic, setting_.owner, "", setting_.frame, {}, {}};
  for (int i = 0; i < 6; ++i) group.unknowns.push_back(first + 6 + i);
  group.weight.assign(mass.data(), mass.data() + mass.size());
  registry.add(group);
}

void Beam::describe_energies(Registry& registry, int p) const {
  const model::Beam& beam = *placed_.beam;
  const elements::BeamPoint& point = beam.points[at(p)];
  const int first = placed_.points[at(p)];
  const double length = beam.point_length(p);
  describe_mass(registry, first, length * point.mass);
  for (int i = 0; i < 6; ++i)
    if (point.compliance(i, i) > 0.0)
      registry.add(EnergyGroup{EnergyGroup::Kind::strain,
                               setting_.owner,
                               setting_.directions[at(i)],
                               setting_.frame,
                               {first + 12 + i},
                               {length * point.compliance(i, i)},
                               point.damping(i)});
}

/// A dead force has a potential where the axes in which it is fixed move as prescribed. A dead
/// moment has none.
bool Beam::is_conservative() const {
  const model::Beam& beam = *placed_.beam;
  if (beam.has_drag || (beam.has_support && !beam.support.damping.isZero(0.0))) return false;
  for (const elements::BeamPoint& point : beam.points)
    if (!point.damping.isZero(0.0)) return false;
  for (const model::BeamLoad& load : beam.loads)
    if (load.follower || setting_.root_moves || !load.load.tail<3>().isZero(0.0)) return false;
  return true;
}

// ---- connections -------------------------------------------------------------------------------

void Beam::connect_points() {
  for (int p = 0; p < placed_.beam->point_count(); ++p) {
    const int first = placed_.points[at(p)];
    Connections point;
    point.arguments = {unknowns(first, block), rates(first, block), motion_of_root()};
    point.shares = {{first + 6, 3, velocity}, {first + 9, 3, spin}};
    for (int node = 0; node <= placed_.beam->order; ++node) {
      const auto [slope, value] = placed_.node_weights(node, p);
      const int strain = placed_.strain_rows(p, node);
      const int force = placed_.force_rows(p, node);
      linear_.push_back({strain, first, 6, -slope});
      point.shares.push_back({strain, 3, stretch, -value});
      point.shares.push_back({strain + 3, 3, turn, -value});
      point.shares.push_back({force, 3, force_flux, slope, force_load, value});
      point.shares.push_back({force + 3, 3, moment_flux, slope, moment_load, value});
    }
    points_.push_back(point);
  }
}

/// `point`: the last one before the end. Its balance contains the section load there.
Connections Beam::connect_end(int first, int point, bool has_balance) {
  linear_.push_back({first, first, 6, 1.0});
  linear_.push_back({placed_.points[at(point)] + 12, first + 12, 6, -1.0});
  Connections end;
  end.arguments = {unknowns(first, block), rates(first, block), motion_of_root()};
  end.shares = {{first + 6, 3, end_velocity}, {first + 9, 3, end_spin}};
  if (!has_balance) return end;
  end.shares.push_back({first + 12, 3, end_balance});
  end.shares.push_back({first + 15, 3, end_balance + 3});
  return end;
}

void Beam::connect_ends() {
  const model::Beam& beam = *placed_.beam;
  linear_.push_back({placed_.root, placed_.root, 6, 1.0});
  tip_ = connect_end(placed_.tip, beam.point_count() - 1, setting_.end == BeamEnd::free);
  for (std::size_t m = 0; m < beam.mass_nodes.size(); ++m) {
    const int next = beam.mass_nodes[m].end * beam.order;  // the first point behind it
    if (next == 0)
      connect_support();
    else
      masses_.push_back(connect_end(placed_.masses[m], next - 1, true));
    linear_.push_back({placed_.points[at(next)], placed_.masses[m], 6, -1.0});
  }
}

void Beam::connect_support() {
  const int first = placed_.masses.front();
  Connections support;
  support.arguments = {unknowns(first, block), rates(first, block), motion_of_root()};
  support.shares = {{first, 3, support_law},
                    {first + 3, 3, support_law + 3},
                    {placed_.root, 3, support_root, -1.0},
                    {placed_.root + 3, 3, support_root + 3, -1.0},
                    {first + 6, 3, end_velocity},
                    {first + 9, 3, end_spin},
                    {first + 12, 3, end_balance},
                    {first + 15, 3, end_balance + 3}};
  masses_.push_back(support);
}

void Beam::connect_changes() {
  const int order = placed_.beam->order;
  for (const ReferenceChange& change : changes_) {
    Connections connections;
    int count = 0;
    if (change.mass >= 0) {
      connections.arguments = {unknowns(change.mass + 3, 3)};
      count = 3;
    } else if (change.element > 0) {
      for (int p = (change.element - 1) * order; p < change.element * order; ++p) {
        connections.arguments.push_back(unknowns(placed_.points[at(p)] + 3, 3));
        connections.arguments.push_back(unknowns(placed_.points[at(p)] + 12, 6));
      }
      count = 9 * order;
    }
    connections.arguments.push_back(zeros(change_arguments - count));
    connections.shares = {{change.row, 3, 0}};
    change_connections_.push_back(connections);
  }
}

void Beam::connect_loads() {
  const model::Beam& beam = *placed_.beam;
  const auto add = [](Connections& connections, int row, double weight) {
    connections.shares.push_back({row, 3, 0, -weight});
    connections.shares.push_back({row + 3, 3, 3, -weight});
  };
  for (const model::BeamLoad& load : beam.loads) {
    // A dead load is equal at all places and has one part. A follower has one part for each place.
    const auto part_at = [&](int first, const Matrix3& C_ab) -> Connections& {
      if (load.follower || loads_.empty() || loads_.back().load != &load) {
        loads_.push_back({&load, C_ab, {}});
        loads_.back().connections.arguments = {load.follower ? unknowns(first + 3, 3) : zeros(3)};
      }
      return loads_.back().connections;
    };
    if (load.at_tip)
      add(part_at(placed_.tip, beam.reference(beam.elements - 1) * load.tip_axes),
          placed_.end_rows(), 1.0);
    for (std::size_t e = 0; e < load.weights.size(); ++e) {
      const int start = (load.first_element + static_cast<int>(e)) * beam.order;
      for (int j = 0; j < beam.order; ++j) {
        const elements::BeamPoint& point = beam.points[at(start + j)];
        Connections& part = part_at(placed_.points[at(start + j)], point.reference * point.C_ab);
        for (int node = 0; node <= beam.order; ++node)
          add(part, placed_.force_rows(start, node), load.weights[e](node, j));
      }
    }
  }
  if (setting_.end != BeamEnd::carries) return;
  end_force_.arguments = {zeros(1)};
  end_force_.shares = {{placed_.end_rows(), 3, 0, -1.0}};
}

void Beam::connect_drag() {
  const model::Beam& beam = *placed_.beam;
  for (int p = 0; p < beam.point_count(); ++p) {
    const int first = placed_.points[at(p)];
    Connections drag;
    drag.arguments = {unknowns(first, 3), rates(first, 3)};
    if (beam.has_support) {
      drag.arguments.push_back(unknowns(placed_.masses.front(), 6));
      drag.arguments.push_back(rates(placed_.masses.front(), 6));
    } else {
      drag.arguments.push_back(zeros(12));
    }
    for (int node = 0; node <= beam.order; ++node)
      drag.shares.push_back({placed_.force_rows(p, node), 3, 0, -placed_.node_weights(node, p)[1]});
    drag.shares.push_back({placed_.root_rows(), 3, 0, beam.point_length(p)});
    drag.shares.push_back({placed_.root_rows() + 3, 3, 3, beam.point_length(p)});
    drag_.push_back(drag);
  }
}

// ---- equations ---------------------------------------------------------------------------------

template <class System>
void Beam::state(System& system) const {
  system.add(linear_);
  state_points(system);
  state_ends(system);
  state_changes(system);
  state_loads(system);
  if (placed_.beam->has_drag) state_drag(system);
}

template <class System>
void Beam::state_points(System& system) const {
  const model::Beam& beam = *placed_.beam;
  for (int p = 0; p < beam.point_count(); ++p) {
    system.require_rotation(placed_.points[at(p)] + 3,
                            [&] { return beam.name + " point " + std::to_string(p + 1); });
    const elements::BeamPoint& point = beam.points[at(p)];
    const auto terms_of = [&point]<class T>(const EndArguments<T>& x) {
      const PointTerms<T> terms =
          elements::beam_point_terms<T>(point, state_of<T>(x), rates_of<T>(x), attachment_of<T>(x));
      Eigen::Matrix<T, point_values, 1> y;
      y << terms.force_flux, terms.force_load, terms.moment_flux, terms.moment_load, terms.stretch,
          terms.turn, terms.velocity, terms.spin;
      return y;
    };
    system.template add<end_arguments, point_values>(points_[at(p)], terms_of,
                                                     Memory::of_arguments);
  }
}

/// The boundary quantities of a beam: reactions at the root, loads and motion at the tip. At a mass
/// between two elements: the end of the one and the start of the other.
template <class System>
void Beam::state_ends(System& system) const {
  const model::Beam& beam = *placed_.beam;
  const auto add_end = [&](const Connections& connections, const Vector3& x_end,
                           const Matrix3& reference, const Matrix6& mass, bool is_held) {
    const auto terms_of = [&]<class T>(const EndArguments<T>& x) {
      const State<T> z = state_of<T>(x);
      const elements::TipTerms<T> terms = elements::beam_tip_terms<T>(
          x_end, reference, mass, z, rates_of<T>(x), attachment_of<T>(x));
      Vec6<T> balance;
      balance << terms.force, terms.moment;
      if (is_held)
        balance = elements::end_support_rows<T>(beam.end_support, end_reference_,
                                                z.template head<6>(), Vec6<T>(balance));
      Eigen::Matrix<T, end_values, 1> y;
      y << terms.velocity, terms.spin, balance;
      return y;
    };
    system.template add<end_arguments, end_values>(connections, terms_of, Memory::of_arguments);
  };
  system.require_rotation(placed_.tip + 3, [&] { return beam.name + " tip"; });
  add_end(tip_, beam.tip, beam.reference(beam.elements - 1), beam.tip_mass,
          setting_.end == BeamEnd::free && !beam.end_support.is_none());
  for (std::size_t m = 0; m < beam.mass_nodes.size(); ++m) {
    const model::MassNode& node = beam.mass_nodes[m];
    if (node.end == 0) {
      state_support(system);
      continue;
    }
    system.require_rotation(placed_.masses[m] + 3, [&] {
      return beam.name + " mass " + std::to_string(beam.has_support ? m : m + 1);
    });
    add_end(masses_[m], node.x, beam.reference(node.end - 1), node.mass, false);
  }
}

/// The root on its rigid body and springs: law of the springs, motion of the body and its balance.
template <class System>
void Beam::state_support(System& system) const {
  const model::Beam& beam = *placed_.beam;
  system.require_rotation(placed_.masses.front() + 3, [&] { return beam.name + " root"; });
  const auto terms_of = [&]<class T>(const EndArguments<T>& x) {
    State<T> node = state_of<T>(x);
    const State<T> rates = rates_of<T>(x);
    const elements::RootSupportTerms<T> held =
        elements::root_support_terms<T>(beam.support, node, rates);
    node.template segment<6>(12) = held.load;
    const elements::TipTerms<T> terms =
        elements::beam_tip_terms<T>(Vector3::Zero(), Matrix3::Identity(),
                                    beam.mass_nodes.front().mass, node, rates, attachment_of<T>(x));
    Vec6<T> balance;
    balance << terms.force, terms.moment;
    if (!beam.support.added_mass.isZero(0.0))
      balance += elements::added_mass_load<T>(beam.support, node, rates);
    Eigen::Matrix<T, support_values, 1> y;
    y << terms.velocity, terms.spin, balance, held.law, held.root;
    return y;
  };
  system.template add<end_arguments, support_values>(masses_.front(), terms_of,
                                                     Memory::of_arguments);
}

/// Correction of the sums in the curvature balances at elements with different references.
template <class System>
void Beam::state_changes(System& system) const {
  const model::Beam& beam = *placed_.beam;
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    const ReferenceChange& change = changes_[i];
    const auto missed = [&]<class T>(const Eigen::Matrix<T, change_arguments, 1>& x) {
      Vec3<T> before = Vec3<T>::Zero();  // rotation at the start; zero at the root
      if (change.mass >= 0) {
        before = x.template head<3>();
      } else if (change.element > 0) {
        for (int j = 0; j < beam.order; ++j) {
          const int p = (change.element - 1) * beam.order + j;
          const auto [slope, value] = placed_.node_weights(beam.order, p);
          const Vec3<T> theta = x.template segment<3>(9 * j);
          before +=
              theta * T(slope) + elements::beam_point_turn<T>(beam.points[at(p)], theta,
                                                              x.template segment<6>(9 * j + 3)) *
                                     T(value);
        }
      }
      return Vec3<T>(before - math::compose<T>(before, change.turn.cast<T>()));
    };
    system.template add<change_arguments, 3>(change_connections_[i], missed, Memory::of_arguments);
  }
}

/// The prescribed loads: -f and -m in the force and moment balances.
template <class System>
void Beam::state_loads(System& system) const {
  for (const LoadPart& part : loads_) {
    const model::BeamLoad& load = *part.load;
    const double now = load.variation.factor(system.time(), setting_.speed);
    const double factor = load.variation.is_constant() ? now : system.varying(now);
    Vector6 value;
    for (int i = 0; i < 6; ++i) value(i) = load.load(i) == 0.0 ? 0.0 : factor * load.load(i);
    const auto turned = [&]<class T>(const Vec3<T>& theta) {
      Vec6<T> given = value.cast<T>();
      if (load.follower) given = elements::follower_load<T>(theta, part.C_ab, value);
      if constexpr (System::has_inputs) {
        if (load.follower || setting_.end == BeamEnd::free) return given;
        const TurbineInputs<T>& inputs = system.inputs();  // dead load: fixed in the ground
        const Vec3<T> force = inputs.at_foot(given.template head<3>());
        const Vec3<T> moment = inputs.at_foot(given.template tail<3>());
        given << force, moment;
      }
      return given;
    };
    system.template add<3, 6>(part.connections, turned);
  }
  if (setting_.end != BeamEnd::carries) return;
  const auto end_force = [&system]<class T>(const Eigen::Matrix<T, 1, 1>&) {
    Vec3<T> force = Vec3<T>::Zero();
    if constexpr (System::has_inputs) {
      const Vec3<T>& given = system.inputs().top_force;
      force << given(2), given(0), given(1);
    }
    return force;
  };
  system.template add<1, 3>(end_force_, end_force);
}

/// Mass-proportional damping on the sections, and its reaction on the root.
template <class System>
void Beam::state_drag(System& system) const {
  const model::Beam& beam = *placed_.beam;
  for (int p = 0; p < beam.point_count(); ++p) {
    const elements::BeamPoint& point = beam.points[at(p)];
    const auto terms_of = [&]<class T>(const Eigen::Matrix<T, drag_arguments, 1>& x) {
      const elements::RootMotion<T> root{x.template segment<3>(6), x.template segment<3>(9),
                                         x.template segment<3>(12), x.template segment<3>(15)};
      const elements::DragTerms<T> drag = elements::beam_drag_terms<T>(
          point.x, point.drag, x.template head<3>(), x.template segment<3>(3),
          beam.has_support ? &root : nullptr);
      Vec6<T> y;
      y << drag.force, drag.moment;
      return y;
    };
    system.template add<drag_arguments, 6>(drag_[at(p)], terms_of, Memory::of_arguments);
  }
}

template class Stated<Beam>;

}  // namespace samara::components
