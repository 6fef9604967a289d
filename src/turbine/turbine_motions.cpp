#include "turbine_motions.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "turbine_pose.hpp"

namespace samara::turbine {
namespace {

using Complex = std::complex<double>;
using Vector6c = Eigen::Matrix<Complex, 6, 1>;

/// Motions of the six directions of a section or of a root, in its axes.
struct Directions {
  std::array<const char*, 4> names;
  std::array<int, 6> motion;

  const char* name(int i) const { return names[static_cast<std::size_t>(i)]; }
};
/// Bending about b2 moves the beam along b3; bending about b3 moves it along b2.
constexpr std::array<int, 6> bending{0, 1, 2, 3, 2, 1};
constexpr Directions blade_directions{{"axial", "lead-lag", "flap", "torsion"}, bending};
/// The tower's b2 is side-side (n1), its b3 downwind (n2).
constexpr Directions tower_directions{{"axial", "side-side", "fore-aft", "torsion"}, bending};
constexpr Directions root_directions{{"support", "pitch hinge", "flap hinge", "lag hinge"},
                                     {0, 0, 0, 1, 2, 3}};
constexpr Directions foundation_directions{{"", "", "", ""}, {0, 0, 0, 0, 0, 0}};
constexpr int motions_a_beam = 4;
/// True if motion i of the four motions of a beam is bending; for all lists of names.
constexpr bool bends(int i) { return i == 1 || i == 2; }

/// Number of a hinge's motion among root_directions.
int motion_of(model::HingeAxis axis) {
  switch (axis) {
    case model::HingeAxis::pitch:
      return 1;
    case model::HingeAxis::flap:
      return 2;
    case model::HingeAxis::lag:
      break;
  }
  return 3;
}

enum Joint { yaw, teeter, torsion, generator, joints };
constexpr std::array<const char*, joints> joint_names{"yaw", "teeter", "shaft torsion",
                                                      "rotor rotation"};

/// Index of the first motion of each part: blades (deformations, then root), tower (deformations,
/// then foundation), joints.
struct Numbering {
  explicit Numbering(const model::Turbine& turbine)
      : tower(2 * motions_a_beam * static_cast<int>(turbine.blades.size())),
        joints(tower + (turbine.has_tower ? 2 * motions_a_beam : 0)),
        size(joints + Joint::joints) {}
  static int blade(std::size_t k) { return 2 * motions_a_beam * static_cast<int>(k); }
  int tower;
  int joints;
  int size;
};

/// Momentum and angular momentum about a point.
struct Momentum {
  Vector3c linear = Vector3c::Zero();
  Vector3c angular = Vector3c::Zero();

  /// The same momentum about the point from which the present point is at `arm`.
  Momentum from(const Vector3& arm) const { return {linear, angular + cross(arm, linear)}; }
  Momentum& operator+=(const Momentum& other) {
    linear += other.linear;
    angular += other.angular;
    return *this;
  }
  /// Component along a real twist of the same point.
  Complex along(const Twist& twist) const {
    return twist.translation.cwiseProduct(linear).sum() +
           twist.rotation.cwiseProduct(angular).sum();
  }
};

double half_product(const Complex& q, const Complex& p) {
  return 0.5 * std::real(std::conj(q) * p);
}

/// Adds q* p / 2 of each direction of a twist, in the axes of the columns of C.
void add_products(const Twist& twist, const Momentum& momentum, const Matrix3& C,
                  const std::array<int, 6>& motion, int first, Eigen::VectorXd& energies) {
  const Vector3c d = C.transpose() * twist.translation;
  const Vector3c phi = C.transpose() * twist.rotation;
  const Vector3c p = C.transpose() * momentum.linear;
  const Vector3c h = C.transpose() * momentum.angular;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    energies(first + motion[i]) += half_product(d(row), p(row));
    energies(first + motion[i + 3]) += half_product(phi(row), h(row));
  }
}

// ---- bodies
// --------------------------------------------------------------------------------------

/// A mass at a place, in ground axes.
struct Mass {
  Vector3 place = Vector3::Zero();
  Matrix6 matrix = Matrix6::Zero();  ///< momenta from velocities, about the place
  Vector3 center = Vector3::Zero();  ///< from the place

  Momentum momentum_of(const Twist& twist) const {
    Vector6c velocity;
    velocity << twist.translation, twist.rotation;
    const Vector6c momentum = matrix * velocity;
    return {momentum.head<3>(), momentum.tail<3>()};
  }
};

Mass mass_of(const Vector3& place, const Matrix3& C, const Matrix6& matrix) {
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = C;
  Mass mass;
  mass.place = place;
  mass.matrix = turn * matrix * turn.transpose();
  if (matrix(0, 0) > 0.0)
    mass.center = C * Vector3(matrix(5, 1), matrix(3, 2), matrix(4, 0)) / matrix(0, 0);
  return mass;
}

Mass mass_of(const Vector3& place, const Matrix3& C, const elements::RigidBody& body) {
  return mass_of(place, C, model::rigid_mass(body.mass, body.center, body.inertia));
}

/// A mass that moves along axes of its carrier, in its steady state, ground axes.
struct Rider {
  double mass = 0.0;
  Vector3 place = Vector3::Zero();
  std::vector<Vector3> axes;
  std::vector<int> displacements;  ///< unknowns
  int motion = 0;                  ///< number of the first axis's motion

  /// Momentum about the point `at` of the carrier, which moves with `carrier`. Adds the energies of
  /// the mass's own motions.
  Momentum momentum_of(const Vector3& at, const Twist& carrier,
                       const Eigen::Ref<const Eigen::VectorXcd>& z_dot,
                       const Eigen::Ref<const Eigen::VectorXcd>& z,
                       Eigen::VectorXd& energies) const {
    Vector3c velocity = carrier.at(place - at).translation;
    for (std::size_t i = 0; i < axes.size(); ++i)
      velocity += axes[i].cast<Complex>() * z(displacements[i]);
    const Vector3c linear = mass * velocity;
    for (std::size_t i = 0; i < axes.size(); ++i)
      energies(motion + static_cast<int>(i)) +=
          half_product(z_dot(displacements[i]), axes[i].cast<Complex>().cwiseProduct(linear).sum());
    return Momentum{linear, Vector3c::Zero()}.from(place - at);
  }
};

/// The masses on a beam, in the order of its nodes.
struct CarriedMasses {
  std::vector<Mass> masses;
  std::vector<std::vector<Rider>> riders;
};

CarriedMasses masses_of(const model::Beam& beam, const BeamPose& pose) {
  CarriedMasses carried;
  const auto put = [&](const Matrix6& mass) {
    const NodePose& node = pose.nodes[carried.masses.size()];
    carried.masses.push_back(mass_of(node.place, node.axes, mass));
  };
  for (int p = 0; p < beam.point_count(); ++p)
    put(beam.point_length(p) * beam.points[static_cast<std::size_t>(p)].mass);
  for (const model::MassNode& node : beam.mass_nodes) {
    put(node.mass);
    if (node.end == 0)
      carried.masses.back().matrix +=
          mass_of(Vector3::Zero(), pose.root_axes, beam.support.added_mass).matrix;
  }
  put(beam.tip_mass);
  carried.riders.resize(carried.masses.size());
  return carried;
}

// ---- the walk
// ------------------------------------------------------------------------------------

class TurbineMotionEnergies final : public system::MotionEnergies {
 public:
  TurbineMotionEnergies(const TurbineEquations& equations, double t, const Eigen::VectorXd& steady)
      : layout_(equations.layout()),
        chain_(equations.turbine().chain),
        numbering_(equations.turbine()),
        size_(numbering_.size + static_cast<int>(equations.declarations().motions.size())),
        pose_(equations, t, steady),
        nacelle_(mass_of(pose_.top(), pose_.nacelle_axes(), chain_.nacelle)),
        shaft_(mass_of(pose_.bearing(), pose_.shaft_axes(), chain_.shaft)),
        hub_(mass_of(pose_.pin(), pose_.hub_axes(), chain_.hub)) {
    const model::Turbine& turbine = equations.turbine();
    if (pose_.has_tower()) tower_ = masses_of(*layout_.beams().back().beam, pose_.tower());
    for (std::size_t k = 0; k < turbine.blades.size(); ++k)
      blades_.push_back(masses_of(turbine.blades[k], pose_.blades()[k]));
    place_riders(equations, steady);
    const BodyTwists unit = turn_of_shaft();
    const Eigen::VectorXcd rest = Eigen::VectorXcd::Zero(steady.size());
    Eigen::VectorXd unused = Eigen::VectorXd::Zero(size_);
    turning_inertia_ =
        sum(pose_.shaft_axis(), momentum_of_rotor(unit, rest, rest, unused).angular).real();
  }

  Eigen::VectorXd of(const ShapeView& z_dot, const ShapeView& z) const override {
    Eigen::VectorXd energies = Eigen::VectorXd::Zero(size_);
    const auto add_joint = [&](Joint joint, int coordinate, const Complex& p) {
      energies(numbering_.joints + joint) += half_product(z_dot(coordinate), p);
    };
    // Outward: motion of each body.
    const BodyTwists twists = pose_.body_twists(z);
    // Inward: momenta of all parts that a joint carries, about a point of its axis.
    Momentum carried = momentum_of_rotor(twists, z_dot, z, energies);
    const Complex turning = sum(pose_.shaft_axis(), carried.angular);
    const Complex rolling = sum(pose_.shaft_axis(), twists.nacelle.rotation);
    const Complex spin =
        chain_.generator_inertia * (rolling + chain_.gear_ratio * z(layout_.generator()));
    add_joint(torsion, layout_.shaft_torsion(), turning);
    add_joint(generator, layout_.generator(), turning + chain_.gear_ratio * spin);
    carried = carried.from(pose_.bearing() - pose_.top());
    carried += nacelle_.momentum_of(twists.nacelle);
    for (const Rider& rider : nacelle_riders_)
      carried += rider.momentum_of(pose_.top(), twists.nacelle, z_dot, z, energies);
    carried.angular += pose_.shaft_axis() * spin;
    add_joint(yaw, layout_.yaw(), sum(pose_.yaw_axis(), carried.angular));
    if (pose_.has_tower())
      momentum_of(pose_.tower(), tower_, {}, tower_directions, foundation_directions,
                  numbering_.tower, carried, z_dot, z, energies);
    return energies;
  }

  Eigen::VectorXd of_mean_turns(const ShapeView& z_dot, const ShapeView& z) const override {
    Eigen::VectorXd energies = of(z_dot, z);
    if (!(turning_inertia_ > 0.0)) return energies;
    const BodyTwists twists = pose_.body_twists(z);
    Eigen::VectorXd whole = Eigen::VectorXd::Zero(size_);
    const Complex p = sum(pose_.shaft_axis(), momentum_of_rotor(twists, z_dot, z, whole).angular);
    // Momentum of the deformation on a shaft that stands still.
    Eigen::VectorXd unused = Eigen::VectorXd::Zero(size_);
    const Complex deformation =
        sum(pose_.shaft_axis(), momentum_of_rotor({}, z_dot, z_dot, unused).angular);
    // Momenta of the motion without its mean turn.
    BodyTwists rest = twists;
    const BodyTwists turn = turn_of_shaft();
    rest.shaft = rest.shaft - turn.shaft * (p / turning_inertia_);
    rest.hub = rest.hub - turn.hub * (p / turning_inertia_);
    Eigen::VectorXd relative = Eigen::VectorXd::Zero(size_);
    momentum_of_rotor(rest, z_dot, z, relative);
    energies += relative - whole;
    energies(numbering_.joints + torsion) += half_product(deformation / turning_inertia_, p);
    return energies;
  }

 private:
  /// A turn of the shaft and of all that it carries by one radian.
  BodyTwists turn_of_shaft() const {
    BodyTwists twists;
    twists.shaft.rotation = pose_.shaft_axis().cast<Complex>();
    twists.hub = twists.shaft.at(pose_.pin() - pose_.bearing());
    return twists;
  }

  /// Momentum of the rotor and the shaft about the bearing. Adds the energies of the motions of the
  /// blades and of the teeter.
  Momentum momentum_of_rotor(const BodyTwists& twists, const ShapeView& z_dot, const ShapeView& z,
                             Eigen::VectorXd& energies) const {
    Momentum carried = hub_.momentum_of(twists.hub);
    for (std::size_t k = 0; k < blades_.size(); ++k) {
      const BeamPose& blade = pose_.blades()[k];
      const Twist base = pose_.base_twist(k, twists.hub, z);
      const Momentum momentum =
          momentum_of(blade, blades_[k], base, blade_directions, root_directions,
                      Numbering::blade(k), {}, z_dot, z, energies);
      for (const HingePose& hinge : pose_.hinges(k))
        energies(Numbering::blade(k) + motions_a_beam + motion_of(hinge.axis)) +=
            half_product(z_dot(hinge.angle), momentum.along(hinge.twist));
      carried += momentum.from(blade.base - pose_.pin());
    }
    energies(numbering_.joints + teeter) +=
        half_product(z_dot(layout_.teeter()), sum(pose_.teeter_axis(), carried.angular));
    carried = carried.from(pose_.pin() - pose_.bearing());
    carried += shaft_.momentum_of(twists.shaft);
    return carried;
  }

  static Complex sum(const Vector3& axis, const Vector3c& vector) {
    return axis.cast<Complex>().cwiseProduct(vector).sum();
  }

  /// Places mass dampers. Their motions come after all others, in the order of declaration.
  void place_riders(const TurbineEquations& equations, const Eigen::VectorXd& steady) {
    int motion = numbering_.size;
    for (std::size_t d = 0; d < equations.mass_dampers().size(); ++d) {
      const model::MassDamper& damper = equations.turbine().mass_dampers[d];
      const bool is_on_tower = damper.blade < 0;
      const auto blade = static_cast<std::size_t>(std::max(damper.blade, 0));
      const BeamPose& beam = is_on_tower ? pose_.tower() : pose_.blades()[blade];
      CarriedMasses& carrier = is_on_tower ? tower_ : blades_[blade];
      const bool is_on_nacelle = damper.is_on_nacelle();
      const std::size_t at = damper.node < 0
                                 ? beam.nodes.size() - 1
                                 : static_cast<std::size_t>(beam.gauss_points + damper.node);
      const Matrix3 axes = is_on_nacelle ? pose_.nacelle_axes() : beam.nodes[at].axes;
      Rider rider;
      rider.mass = damper.definition.mass;
      rider.place = is_on_nacelle ? pose_.top() : beam.nodes[at].place;
      rider.place += axes * damper.place;
      rider.motion = motion;
      for (std::size_t i = 0; i < damper.definition.axes.size(); ++i) {
        rider.axes.push_back(axes * damper.axis(i));
        rider.displacements.push_back(equations.mass_dampers()[d]->first(i));
        rider.place += rider.axes.back() * steady(rider.displacements.back());
        ++motion;
      }
      (is_on_nacelle ? nacelle_riders_ : carrier.riders[at]).push_back(rider);
    }
  }

  /// Adds the energies of a beam's motions and returns its momentum about its base. `base`: motion
  /// of the base; `tip`: momentum of the parts on the end, about the end.
  static Momentum momentum_of(const BeamPose& beam, const CarriedMasses& carried, const Twist& base,
                              const Directions& deformation, const Directions& root, int first,
                              const Momentum& tip, const ShapeView& z_dot, const ShapeView& z,
                              Eigen::VectorXd& energies) {
    Twist given;
    Vector3 foot = beam.base;
    if (beam.support >= 0) {
      const NodePose& support = beam.nodes[static_cast<std::size_t>(beam.support)];
      given = support.twist_of(z_dot);
      foot = support.place;
    }
    Momentum total;
    for (std::size_t i = 0; i < beam.nodes.size(); ++i) {
      const NodePose& node = beam.nodes[i];
      const Mass& mass = carried.masses[i];
      const Twist own = node.twist_of(z);
      const Twist rate = node.twist_of(z_dot);
      const Twist whole = own + base.at(node.place - beam.base);
      Momentum momentum = mass.momentum_of(whole);
      for (const Rider& rider : carried.riders[i])
        momentum += rider.momentum_of(node.place, whole, z_dot, z, energies);
      if (i + 1 == beam.nodes.size()) momentum += tip;
      const Twist deformed = rate - given.at(node.place - foot);
      // About the centre of a mass, translation and rotation have no common momentum.
      add_products(deformed.at(mass.center), momentum.from(-mass.center), node.section,
                   deformation.motion, first, energies);
      total += momentum.from(node.place - beam.base);
    }
    if (beam.support >= 0)
      add_products(given, total.from(beam.base - foot), beam.base_axes, root.motion,
                   first + motions_a_beam, energies);
    return total;
  }

  const TurbineLayout& layout_;
  const elements::RigidChain& chain_;
  Numbering numbering_;
  int size_;
  TurbinePose pose_;
  Mass nacelle_, shaft_, hub_;
  double turning_inertia_ = 0.0;  ///< of rotor and shaft, about the shaft's axis
  CarriedMasses tower_;
  std::vector<CarriedMasses> blades_;
  std::vector<Rider> nacelle_riders_;
};

/// Adds the positions of all masses of a blade that belong to a motion. Bending moves masses along
/// b2 and b3 at any twist.
void add_positions(const model::Beam& beam, const TurbineLayout& layout, int blade, int i,
                   system::Motion& motion) {
  const std::vector<int> positions =
      i == 0 || i == 3 ? std::vector<int>{i} : std::vector<int>{1, 2};
  const auto add = [&](int first, const Matrix6& mass) {
    for (const int position : positions) {
      if (!(mass(position, position) > 0.0)) continue;
      motion.unknowns.push_back(first + position);
      motion.weight.push_back(mass(position, position));
    }
  };
  for (int p = 0; p < beam.point_count(); ++p)
    add(layout.blade_point(blade, p),
        beam.point_length(p) * beam.points[static_cast<std::size_t>(p)].mass);
  add(layout.blade_tip(blade), beam.tip_mass);
}

}  // namespace

std::vector<system::Motion> motions_of(const model::Turbine& turbine, const TurbineLayout& layout) {
  std::vector<system::Motion> motions;
  for (std::size_t k = 0; k < turbine.blades.size(); ++k) {
    const model::Beam& beam = turbine.blades[k];
    const int blade = static_cast<int>(k);
    for (int i = 0; i < motions_a_beam; ++i) {
      system::Motion motion{
          {system::PartKind::beam, "blade", blade + 1}, blade_directions.name(i), bends(i)};
      add_positions(beam, layout, blade, i, motion);
      motions.push_back(motion);
    }
    for (int i = 0; i < motions_a_beam; ++i) {
      system::Motion motion{{system::PartKind::support, "blade", blade + 1},
                            root_directions.name(i)};
      const model::BladeRoot& root = turbine.roots[k];
      for (std::size_t h = 0; h < root.hinges.size(); ++h) {
        if (motion_of(root.hinges[h].axis) != i) continue;
        motion.unknowns.push_back(layout.hinge(blade, static_cast<int>(h)));
        motion.weight.push_back(1.0);
      }
      for (int j = 0; beam.has_support && j < 6; ++j) {
        if (root_directions.motion[static_cast<std::size_t>(j)] != i) continue;
        motion.unknowns.push_back(layout.blade_mass(blade, 0) + j);
        motion.weight.push_back(1.0);
      }
      motions.push_back(motion);
    }
  }
  if (turbine.has_tower) {
    for (int i = 0; i < motions_a_beam; ++i)
      motions.push_back({{system::PartKind::beam, "tower"}, tower_directions.name(i), bends(i)});
    for (int i = 0; i < motions_a_beam; ++i)
      motions.push_back({{system::PartKind::support, "foundation"}, foundation_directions.name(i)});
  }
  for (const char* name : joint_names) motions.push_back({{system::PartKind::joint, name}});
  return motions;
}

std::unique_ptr<system::MotionEnergies> find_motion_energies(const TurbineEquations& equations,
                                                             double t,
                                                             const Eigen::VectorXd& steady) {
  return std::make_unique<TurbineMotionEnergies>(equations, t, steady);
}

}  // namespace samara::turbine
