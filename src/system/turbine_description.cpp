#include "turbine_description.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "samara/math/rotation.hpp"

namespace samara::system {
namespace {

constexpr int block = model::Layout::block;

/// Relative to the larger of the terms that should cancel, lengths and inertias of the hub's
/// masses: what places typed with ten digits leave (three masses 120 degrees apart). Frequencies
/// change by no more than that, which no analysis resolves.
constexpr double symmetry_rounding = 1e-9;

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

/// Directions of a blade's root.
constexpr std::array<const char*, 6> root_motions{"support",     "support",    "support",
                                                  "pitch hinge", "flap hinge", "lag hinge"};

const Owner tower(PartKind::beam, "tower");
Owner body_owner(const char* name) { return {PartKind::body, name}; }
Owner joint_owner(const std::string& name) { return {PartKind::joint, name}; }
Owner blade_owner(int k) { return {PartKind::beam, "blade", k + 1}; }

UnknownRole role_at(int i) {
  return i < 6 ? UnknownRole::position : i < 12 ? UnknownRole::velocity : UnknownRole::internal;
}

RowRole row_role_at(int i) {
  return i < 6 ? RowRole::constraint : i < 12 ? RowRole::kinematic : RowRole::balance;
}

class Describer {
 public:
  Describer(const model::Turbine& turbine, const model::Layout& layout)
      : turbine_(turbine), layout_(layout) {
    const auto n = static_cast<std::size_t>(layout.size());
    result_.unknowns.resize(n);
    result_.rows.assign(n, RowRole::constraint);
  }

  TurbineDescription run() {
    for (std::size_t k = 0; k < turbine_.blades.size(); ++k) describe_blade(static_cast<int>(k));
    if (turbine_.has_tower) describe_tower();
    describe_joints();
    describe_symmetry();
    return std::move(result_);
  }

 private:
  static Frame frame_of(const Owner& beam) {
    return beam.instance > 0 ? Frame::rotating : Frame::fixed;
  }

  void describe_block(int first, const Owner& beam, const std::string& place) {
    for (int i = 0; i < block; ++i) {
      const auto at = static_cast<std::size_t>(first + i);
      const NamedUnknown& named = point_unknowns[static_cast<std::size_t>(i)];
      result_.unknowns[at] = {beam, place, named.name, named.unit, role_at(i), frame_of(beam)};
      result_.rows[at] = row_role_at(i);
    }
  }

  void describe_root(int first, const Owner& beam) {
    for (int i = 0; i < 6; ++i) {
      const auto at = static_cast<std::size_t>(first + i);
      const NamedUnknown& named = point_unknowns[static_cast<std::size_t>(12 + i)];
      result_.unknowns[at] = {beam,       "root",          named.name,
                              named.unit, role_at(12 + i), frame_of(beam)};
      result_.rows[at] = row_role_at(12 + i);
    }
  }

  /// Point masses count from 1, whatever the root stands on.
  void describe_mass_node(const model::Beam& beam, const Owner& owner, int m, int first) {
    const bool is_root = beam.mass_nodes[static_cast<std::size_t>(m)].end == 0;
    describe_block(first, owner,
                   is_root ? "support" : "mass " + std::to_string(beam.has_support ? m : m + 1));
    if (is_root) describe_support(beam, owner, first);
    add_mass(first, beam.mass_nodes[static_cast<std::size_t>(m)].mass, owner);
  }

  void describe_support(const model::Beam& beam, const Owner& owner, int first) {
    for (int i = 0; i < 6; ++i) {
      if (beam.support.free[static_cast<std::size_t>(i)]) {
        result_.rows[static_cast<std::size_t>(first + i)] = RowRole::balance;
        result_.unknowns[static_cast<std::size_t>(first + i)].is_free = true;
      }
      if (beam.support.is_elastic(i))
        result_.groups.push_back(
            {EnergyGroup::Kind::strain,
             {PartKind::support, owner == tower ? "foundation" : owner.part, owner.instance},
             owner == tower ? "" : root_motions[static_cast<std::size_t>(i)],
             frame_of(owner),
             {first + 12 + i},
             {beam.support.compliance(i, i)},
             beam.support.damping});
    }
  }

  void describe_end_support(const model::Beam& beam, int tip, const Owner& blade) {
    for (int i = 0; i < 6; ++i) {
      if (beam.end_support.rigid[static_cast<std::size_t>(i)])
        result_.rows[static_cast<std::size_t>(tip + 12 + i)] = RowRole::constraint;
      if (beam.end_support.stiffness(i, i) > 0.0)
        result_.groups.push_back({EnergyGroup::Kind::strain,
                                  {PartKind::support, blade.part, blade.instance},
                                  "end support",
                                  Frame::rotating,
                                  {tip + i},
                                  {beam.end_support.stiffness(i, i)}});
    }
  }

  void describe_blade(int k) {
    const model::Beam& beam = turbine_.blades[static_cast<std::size_t>(k)];
    const Owner blade = blade_owner(k);
    for (int p = 0; p < beam.point_count(); ++p) {
      describe_block(layout_.blade_point(k, p), blade, "point " + std::to_string(p + 1));
      add_energies(beam, p, layout_.blade_point(k, p), blade,
                   {"axial", "lead-lag", "flap", "torsion", "flap", "lead-lag"});
    }
    for (int m = 0; m < static_cast<int>(beam.mass_nodes.size()); ++m)
      describe_mass_node(beam, blade, m, layout_.blade_mass(k, m));
    describe_block(layout_.blade_tip(k), blade, "tip");
    describe_end_support(beam, layout_.blade_tip(k), blade);
    describe_root(layout_.blade_root(k), blade);
    add_mass(layout_.blade_tip(k), beam.tip_mass, blade);
  }

  /// A rigid mass whose velocities are those of the block at `first`.
  void add_mass(int first, const Matrix6& mass, const Owner& beam) {
    if (mass(0, 0) == 0.0) return;
    EnergyGroup group{EnergyGroup::Kind::kinetic, beam, "", frame_of(beam), {}, {}};
    for (int i = 0; i < 6; ++i) group.unknowns.push_back(first + 6 + i);
    group.weight.assign(mass.data(), mass.data() + mass.size());
    result_.groups.push_back(group);
  }

  /// The tower's b2 is lateral (n1), its b3 downwind (n2): bending about b2 moves it along b3.
  void describe_tower() {
    const model::Beam& beam = turbine_.tower;
    for (int p = 0; p < beam.point_count(); ++p) {
      describe_block(layout_.tower_point(p), tower, "point " + std::to_string(p + 1));
      add_energies(beam, p, layout_.tower_point(p), tower,
                   {"axial", "lateral", "fore-aft", "torsion", "fore-aft", "lateral"});
    }
    for (int m = 0; m < static_cast<int>(beam.mass_nodes.size()); ++m)
      describe_mass_node(beam, tower, m, layout_.tower_mass(m));
    describe_block(layout_.tower_tip(), tower, "top");
    add_mass(layout_.tower_tip(), beam.tip_mass, tower);
    describe_root(layout_.tower_root(), tower);
  }

  /// `directions`: those that strains and curvatures belong to, shear to the bending that it makes.
  void add_energies(const model::Beam& beam, int p, int first, const Owner& owner,
                    const std::array<const char*, 6>& directions) {
    const elements::BeamPoint& point = beam.points[static_cast<std::size_t>(p)];
    const double length = beam.point_length(p);
    EnergyGroup kinetic{EnergyGroup::Kind::kinetic, owner, "", frame_of(owner), {}, {}};
    for (int i = 0; i < 6; ++i) kinetic.unknowns.push_back(first + 6 + i);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) kinetic.weight.push_back(length * point.mass(i, j));
    result_.groups.push_back(kinetic);
    for (int i = 0; i < 6; ++i) {
      if (point.compliance(i, i) <= 0.0) continue;
      result_.groups.push_back({EnergyGroup::Kind::strain,
                                owner,
                                directions[static_cast<std::size_t>(i)],
                                frame_of(owner),
                                {first + 12 + i},
                                {length * point.compliance(i, i)},
                                point.damping(i)});
    }
  }

  void describe_joint(int first, const std::string& name, Frame frame, bool free) {
    const auto at = static_cast<std::size_t>(first);
    const Owner joint = joint_owner(name);
    result_.unknowns[at] = {joint, "", "angle", "rad", UnknownRole::position, frame};
    result_.unknowns[at + 1] = {joint, "", "speed", "rad/s", UnknownRole::velocity, frame};
    result_.rows[at] = free ? RowRole::kinematic : RowRole::constraint;
    result_.rows[at + 1] = free ? RowRole::balance : RowRole::kinematic;
  }

  void describe_joints() {
    const elements::RigidChain& chain = turbine_.chain;
    describe_joint(layout_.yaw(), "yaw", Frame::fixed, chain.yaw.free);
    describe_joint(layout_.teeter(), "teeter", Frame::rotating, chain.teeter.free);
    describe_joint(layout_.shaft_torsion(), "shaft torsion", Frame::rotating, chain.torsion.free);
    describe_joint(layout_.generator(), "generator", Frame::rotating, chain.generator.free);
    for (const int i : layout_.padding()) {
      result_.unknowns[static_cast<std::size_t>(i)] = {{PartKind::law, "padding"}, "", "", ""};
      result_.rows[static_cast<std::size_t>(i)] = RowRole::constraint;
    }
    if (chain.yaw.free && chain.yaw.stiffness == 0.0)
      result_.neutral.push_back({"yaw", layout_.yaw(), layout_.yaw() + 1, "N m"});
    if (chain.teeter.free && chain.teeter.stiffness == 0.0 && turbine_.speed == 0.0)
      result_.neutral.push_back({"teeter", layout_.teeter(), layout_.teeter() + 1, "N m"});
    if (chain.generator.free)
      result_.neutral.push_back({"generator", layout_.generator(), layout_.generator() + 1, "N m"});
    add_rigid_energies();
  }

  bool turns_freely() const { return turbine_.chain.torsion.free || turbine_.chain.generator.free; }

  /// Axes of the bearing in t1 t2 t3 at the mean of a prescribed yaw.
  Matrix3 bearing_axes() const {
    return math::turn_about<double>(Vector3::UnitZ(), turbine_.yaw_motion.angle) *
           math::turn_about<double>(Vector3::UnitX(), turbine_.chain.tilt);
  }

  /// What the tower top carries, at zero azimuth and the mean of a prescribed yaw: nacelle and
  /// shaft, and the hub, of which a free teeter leaves only the mass at the pin; what turns about
  /// the hinge is the hub's own. A generator that is not free rolls with the nacelle, gear or not.
  Matrix6 carried_mass() const {
    const elements::RigidChain& chain = turbine_.chain;
    const Matrix3 yawed = math::turn_about<double>(Vector3::UnitZ(), turbine_.yaw_motion.angle);
    const Matrix3 tilted = bearing_axes();
    const Vector3 bearing(0.0, 0.0, chain.height);
    const Vector3 pin = bearing + tilted * Vector3(0.0, chain.overhang, 0.0);
    Matrix6 weight = Matrix6::Zero();
    const auto add = [&weight](double mass, const Vector3& center, const Matrix3& inertia) {
      const Matrix3 across = math::skew<double>(center);
      weight.topLeftCorner<3, 3>() += mass * Matrix3::Identity();
      weight.topRightCorner<3, 3>() -= mass * across;  // m V.(omega x c)
      weight.bottomLeftCorner<3, 3>() += mass * across;
      weight.bottomRightCorner<3, 3>() += inertia - mass * across * across;
    };
    const auto add_body = [&](const elements::RigidBody& body, const Matrix3& C,
                              const Vector3& reference) {
      add(body.mass, reference + C * body.center, C * body.inertia * C.transpose());
    };
    add_body(chain.nacelle, yawed, Vector3::Zero());
    elements::RigidBody shaft = chain.shaft;
    elements::RigidBody hub = chain.hub;
    if (turns_freely()) shaft.inertia(1, 1) = hub.inertia(1, 1) = 0.0;  // counted with their speed
    add_body(shaft, tilted, bearing);
    if (!chain.generator.free)
      add(0.0, Vector3::Zero(),
          chain.generator_inertia * tilted.col(1) * tilted.col(1).transpose());
    if (chain.teeter.free)
      add(chain.hub.mass, pin, Matrix3::Zero());
    else
      add_body(hub, tilted, pin);
    return weight;
  }

  void add_rigid_energies() {
    const elements::RigidChain& chain = turbine_.chain;
    const Matrix6 carried = carried_mass();
    EnergyGroup group{EnergyGroup::Kind::kinetic, body_owner("nacelle"), "", Frame::fixed, {}, {}};
    if (turbine_.has_tower) {
      const int top = layout_.tower_tip();  // V = (U6 U7 U8), omega = (U3 U4 U1)
      group.unknowns = {top + 7, top + 8, top + 6, top + 10, top + 11, layout_.yaw() + 1};
      group.weight.assign(carried.data(), carried.data() + carried.size());
      result_.groups.push_back(group);
    } else if (chain.yaw.free && carried(5, 5) > 0.0) {
      group.unknowns = {layout_.yaw() + 1};
      group.weight = {carried(5, 5)};
      result_.groups.push_back(group);
    }
    if (chain.teeter.free) {
      const Vector3 e = chain.teeter_axis;
      const Matrix3 across = math::skew<double>(chain.hub.center);
      const double inertia = e.dot((chain.hub.inertia - chain.hub.mass * across * across) * e);
      if (inertia > 0.0)
        result_.groups.push_back({EnergyGroup::Kind::kinetic,
                                  body_owner("hub"),
                                  "",
                                  Frame::rotating,
                                  {layout_.teeter() + 1},
                                  {inertia}});
    }
    const auto add_shaft = [this](int speed, double shaft_inertia) {
      if (shaft_inertia > 0.0)
        result_.groups.push_back({EnergyGroup::Kind::kinetic,
                                  body_owner("drivetrain"),
                                  "",
                                  Frame::rotating,
                                  {speed},
                                  {shaft_inertia}});
    };
    const Vector3 off_axis(chain.hub.center(0), 0.0, chain.hub.center(2));
    const double hub_turning = chain.hub.inertia(1, 1) + chain.hub.mass * off_axis.squaredNorm();
    const double turning = chain.shaft.inertia(1, 1) + (chain.teeter.free ? 0.0 : hub_turning);
    if (turns_freely()) add_shaft(layout_.shaft_torsion() + 1, turning);
    if (chain.generator.free) add_generator();
    add_spring(chain.yaw, "yaw", Frame::fixed, layout_.yaw());
    add_spring(chain.teeter, "teeter", Frame::rotating, layout_.teeter());
    add_spring(chain.torsion, "shaft torsion", Frame::rotating, layout_.shaft_torsion());
  }

  /// J_g w^2/2 of a free generator, w = (1 - n) omega_Y.s2 + n U_g.
  void add_generator() {
    const elements::RigidChain& chain = turbine_.chain;
    if (chain.generator_inertia == 0.0) return;
    EnergyGroup group{EnergyGroup::Kind::kinetic,
                      body_owner("drivetrain"),
                      "",
                      Frame::rotating,
                      {layout_.generator() + 1},
                      {}};
    std::vector<double> shares{chain.gear_ratio};
    const Vector3 along = (1.0 - chain.gear_ratio) * bearing_axes().col(1);
    const auto add_share = [&](int unknown, double share) {
      if (share == 0.0) return;
      group.unknowns.push_back(unknown);
      shares.push_back(share);
    };
    if (turbine_.has_tower) {
      add_share(layout_.tower_tip() + 10, along(0));
      add_share(layout_.tower_tip() + 11, along(1));
    }
    if (turbine_.has_tower || chain.yaw.free) add_share(layout_.yaw() + 1, along(2));
    for (const double a : shares)
      for (const double b : shares) group.weight.push_back(chain.generator_inertia * a * b);
    result_.groups.push_back(group);
  }

  void add_spring(const elements::Hinge& hinge, const std::string& name, Frame frame, int angle) {
    if (!hinge.free || hinge.stiffness == 0.0) return;
    result_.groups.push_back({EnergyGroup::Kind::strain,
                              joint_owner(name),
                              "",
                              frame,
                              {angle},
                              {hinge.stiffness},
                              hinge.damping / hinge.stiffness});
  }

  /// Why the rotor does not look the same after 1/B of a turn; empty where it does.
  std::string symmetry_fault() const {
    const elements::RigidChain& chain = turbine_.chain;
    const auto blades = turbine_.blades.size();
    if (!turbine_.identical_blades) return "the blades differ";
    if (blades > 2 && chain.teeter.free) return "the hub teeters";
    for (const std::string& fault : {hub_fault(blades > 2), motion_fault(), load_fault()})
      if (!fault.empty()) return fault;
    return "";
  }

  /// The same for the hub: its axis must be a principal one through its centre, and all axes across
  /// it alike where it is turned by less than half a turn.
  std::string hub_fault(bool round) const {
    const elements::RigidBody& hub = turbine_.chain.hub;
    const Matrix3& I = hub.inertia;
    const double largest = I.cwiseAbs().maxCoeff();
    const double inertia = symmetry_rounding * largest;
    const double length = hub.mass > 0.0 ? hub.center.norm() + std::sqrt(largest / hub.mass) : 0.0;
    if (std::hypot(hub.center(0), hub.center(2)) > symmetry_rounding * length)
      return "the hub's centre of mass is off the shaft";
    if (std::hypot(I(0, 1), I(1, 2)) > inertia)
      return "the shaft is no principal axis of the hub's inertia";
    if (round && (std::abs(I(0, 0) - I(2, 2)) > inertia || std::abs(I(0, 2)) > inertia))
      return "hub.inertia differs about h1 and h3";
    return "";
  }

  /// The same for the prescribed motions: the yaw must repeat from blade to blade, and half a turn
  /// must reverse the teeter angle of two blades.
  std::string motion_fault() const {
    const int blades = static_cast<int>(turbine_.blades.size());
    const model::JointHistory& yaw = turbine_.yaw_motion;
    const model::JointHistory& teeter = turbine_.teeter_motion;
    if (!yaw.is_constant() && (yaw.per_rev == 0 || yaw.per_rev % blades != 0))
      return "the yaw does not repeat from blade to blade";
    const bool reverses = teeter.angle == 0.0 && (teeter.is_constant() || teeter.per_rev % 2 == 1);
    if (!reverses || (blades > 2 && !teeter.is_constant()))
      return "the teeter angle does not repeat from blade to blade";
    return "";
  }

  /// The same for the prescribed loads.
  std::string load_fault() const {
    const int blades = static_cast<int>(turbine_.blades.size());
    const auto repeats = [&](const model::BeamLoad& load) {
      return load.history.is_constant() ||
             (load.history.table.empty() && load.history.per_rev > 0 &&
              load.history.per_rev % blades == 0);
    };
    const auto alike = [](const model::BeamLoad& a, const model::BeamLoad& b) {
      return a.source == b.source;
    };
    if (turbine_.blades.empty()) return "there are no blades";
    const std::vector<model::BeamLoad>& first = turbine_.blades.front().loads;
    for (const model::Beam& blade : turbine_.blades)
      if (!std::equal(first.begin(), first.end(), blade.loads.begin(), blade.loads.end(), alike))
        return "the loads on the blades differ";
    for (const std::vector<model::BeamLoad>* loads : {&first, &turbine_.tower.loads})
      if (!std::all_of(loads->begin(), loads->end(), repeats))
        return "a load does not repeat from blade to blade";
    return "";
  }

  void describe_symmetry() {
    RotorSymmetry& symmetry = result_.symmetry;
    const int n = layout_.size();
    for (int i = 0; i < n; ++i) symmetry.source.push_back(i);
    symmetry.sign.assign(static_cast<std::size_t>(n), 1.0);
    const int count = static_cast<int>(turbine_.blades.size());
    if (count < 2) return;
    symmetry.broken_by = symmetry_fault();
    if (!symmetry.broken_by.empty()) return;
    symmetry.sectors = count;
    for (int k = 0; k < count; ++k) {
      const int before = (k + count - 1) % count;  // blade k + 1 of P z is blade k of z
      for (int i = 0; i < layout_.blade_size(); ++i)
        symmetry.source[static_cast<std::size_t>(layout_.blade_tip(k) + i)] =
            layout_.blade_tip(before) + i;
      for (int i = 0; i < 6; ++i)
        symmetry.source[static_cast<std::size_t>(layout_.blade_root(k) + i)] =
            layout_.blade_root(before) + i;
    }
    if (count == 2) {  // the hinge axis turns with the shaft: half a turn reverses it
      symmetry.sign[static_cast<std::size_t>(layout_.teeter())] = -1.0;
      symmetry.sign[static_cast<std::size_t>(layout_.teeter()) + 1] = -1.0;
    }
  }

  const model::Turbine& turbine_;
  const model::Layout& layout_;
  TurbineDescription result_;
};

}  // namespace

TurbineDescription describe(const model::Turbine& turbine, const model::Layout& layout) {
  return Describer(turbine, layout).run();
}

}  // namespace samara::system
