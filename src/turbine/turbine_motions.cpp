#include "turbine_motions.hpp"

#include <array>
#include <string>
#include <vector>

#include "samara/math/rotation.hpp"

namespace samara::turbine {
namespace {

using Complex = std::complex<double>;
using Vector3c = Eigen::Matrix<Complex, 3, 1>;
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

// ---- linear maps
// ---------------------------------------------------------------------------------

Vector3c cross(const Vector3& a, const Vector3c& b) { return math::skew<double>(a) * b; }

/// A small motion of a rigid body: translation of one of its points, and rotation.
struct Twist {
  Vector3c translation = Vector3c::Zero();
  Vector3c rotation = Vector3c::Zero();

  Twist at(const Vector3& arm) const { return {translation - cross(arm, rotation), rotation}; }
  Twist operator*(const Complex& size) const { return {translation * size, rotation * size}; }
  Twist operator+(const Twist& other) const {
    return {translation + other.translation, rotation + other.rotation};
  }
  Twist operator-(const Twist& other) const {
    return {translation - other.translation, rotation - other.rotation};
  }
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

/// Positions of a block about their steady values; converts them from the beam's root to the
/// ground.
struct Node {
  int first = 0;
  Matrix3 C = Matrix3::Identity();  ///< axes of the root
  Matrix3 turn = Matrix3::Zero();   ///< rotation per theta, ground axes

  Twist twist_of(const Eigen::Ref<const Eigen::VectorXcd>& z) const {
    return {C * z.segment<3>(first), turn * z.segment<3>(first + 3)};
  }
};

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

/// A beam in its steady state.
struct SteadyBeam {
  struct Point {
    Node node;
    Mass mass;
    Matrix3 axes = Matrix3::Identity();  ///< section, undeformed relative to the displaced root
    Matrix3 node_axes = Matrix3::Identity();  ///< axes of its velocities, as columns
    std::vector<Rider> riders{};
  };
  std::vector<Point> points;
  int gauss_points = 0;  ///< number of Gauss points; they come first, then mass nodes, then the end
  bool has_support = false;
  Point support;
  Vector3 root = Vector3::Zero();
  Vector3 tip = Vector3::Zero();  ///< displaced
};

/// A free hinge of a blade's root in its steady state.
struct SteadyHinge {
  int angle = 0;   ///< unknown
  int motion = 0;  ///< index in root_directions
  Twist twist;     ///< motion of the root's place per angle
};

SteadyBeam place(const components::PlacedBeam& where, const Vector3& root, const Matrix3& C,
                 const Eigen::VectorXd& steady) {
  const model::Beam& beam = *where.beam;
  SteadyBeam placed;
  placed.root = root;
  placed.gauss_points = beam.point_count();
  Matrix3 axes = C;  // axes of the root on its support
  if (beam.has_support)
    axes *= math::direction_cosines<double>(Vector3(steady.segment<3>(where.masses[0] + 3)))
                .transpose();
  const auto put = [&](int first, const Vector3& x, const Matrix3& turned, const Matrix6& mass,
                       const Matrix3& section) {
    const Vector3 theta = steady.segment<3>(first + 3);
    const Matrix3 back = math::direction_cosines<double>(theta).transpose();
    Matrix3 Q;
    for (int i = 0; i < 3; ++i) Q.col(i) = math::tangent_times<double>(theta, Vector3::Unit(i));
    const Vector3 at = root + C * (x + steady.segment<3>(first));
    return SteadyBeam::Point{{first, C, C * back * Q},
                             mass_of(at, C * back * turned, mass),
                             axes * section,
                             C * back * turned};
  };
  for (int p = 0; p < beam.point_count(); ++p) {
    const auto at = static_cast<std::size_t>(p);
    const elements::BeamPoint& point = beam.points[at];
    placed.points.push_back(put(where.points[at], point.x, point.reference * point.C_ab,
                                beam.point_length(p) * point.mass, point.C_ab));
  }
  for (std::size_t m = 0; m < beam.mass_nodes.size(); ++m) {
    const model::MassNode& node = beam.mass_nodes[m];
    const auto next = static_cast<std::size_t>(node.end * beam.order);  // index of the next point
    placed.points.push_back(put(where.masses[m], node.x, beam.reference_before(node.end), node.mass,
                                beam.points[next].C_ab));
    if (node.end != 0) continue;
    placed.points.back().mass.matrix +=
        mass_of(Vector3::Zero(), axes, beam.support.added_mass).matrix;
    placed.has_support = true;
    placed.support = placed.points.back();
  }
  placed.points.push_back(put(where.tip, beam.tip, beam.reference(beam.elements - 1), beam.tip_mass,
                              beam.points.back().C_ab));
  placed.tip = placed.points.back().mass.place;
  return placed;
}

// ---- the walk
// ------------------------------------------------------------------------------------

class TurbineMotionEnergies final : public system::MotionEnergies {
 public:
  TurbineMotionEnergies(const TurbineEquations& equations, double t, const Eigen::VectorXd& steady)
      : layout_(equations.layout()),
        chain_(equations.turbine().chain),
        numbering_(equations.turbine()),
        has_tower_(equations.turbine().has_tower),
        size_(numbering_.size + static_cast<int>(equations.declarations().motions.size())) {
    const model::Turbine& turbine = equations.turbine();
    const TurbineLayout& layout = layout_;
    const std::vector<double> z(steady.begin(), steady.end());
    pitch_ = equations.report<double>(t, z, std::vector<double>(z.size()), {}).pitch;
    Matrix3 C = Matrix3::Identity();  // axes of T
    if (has_tower_) place_tower(steady, C);
    yaw_axis_ = C.col(2);
    C *= math::turn_about<double>(Vector3::UnitZ(), steady(layout.yaw()));
    nacelle_ = mass_of(top_, C, chain_.nacelle);
    nacelle_axes_ = C;
    bearing_ = top_ + C * Vector3(0.0, 0.0, chain_.height);
    C *= math::turn_about<double>(Vector3::UnitX(), chain_.tilt);
    shaft_axis_ = C.col(1);
    pin_ = bearing_ + chain_.overhang * shaft_axis_;
    C *= math::turn_about<double>(
        Vector3::UnitY(),
        turbine.turning_at(t).value + steady(layout.generator()) + steady(layout.shaft_torsion()));
    shaft_ = mass_of(bearing_, C, chain_.shaft);
    teeter_axis_ = C * chain_.teeter_axis;
    C *= math::turn_about<double>(chain_.teeter_axis, steady(layout.teeter()));
    hub_ = mass_of(pin_, C, chain_.hub);
    const Vector3 apex = pin_ + chain_.undersling * C.col(1);
    for (std::size_t k = 0; k < turbine.blades.size(); ++k)
      place_blade(turbine, k, t, apex, C, steady);
    place_riders(equations, steady);
  }

  Eigen::VectorXd of(const Eigen::Ref<const Eigen::VectorXcd>& z_dot,
                     const Eigen::Ref<const Eigen::VectorXcd>& z) const override {
    Eigen::VectorXd energies = Eigen::VectorXd::Zero(size_);
    const Complex q_y = z(layout_.yaw());
    const Complex q_h = z(layout_.teeter());
    const Complex q_s = z(layout_.shaft_torsion());
    const Complex q_g = z(layout_.generator());
    const auto add_joint = [&](Joint joint, int coordinate, const Complex& p) {
      energies(numbering_.joints + joint) += half_product(z_dot(coordinate), p);
    };
    // Outward: motion of each body.
    const Twist top = has_tower_ ? tower_.points.back().node.twist_of(z) : Twist{};
    const Twist nacelle{top.translation, top.rotation + yaw_axis_ * q_y};
    const Twist shaft{nacelle.at(bearing_ - top_).translation,
                      nacelle.rotation + shaft_axis_ * (q_g + q_s)};
    const Twist hub{shaft.at(pin_ - bearing_).translation, shaft.rotation + teeter_axis_ * q_h};
    // Inward: momenta of all parts that a joint carries, about a point of its axis.
    Momentum carried = hub_.momentum_of(hub);
    for (std::size_t k = 0; k < blades_.size(); ++k) {
      const SteadyBeam& blade = blades_[k];
      Twist base = hub.at(blade.root - pin_);
      for (const SteadyHinge& hinge : hinges_[k]) base = base + hinge.twist * z(hinge.angle);
      const Momentum momentum = momentum_of(blade, base, blade_directions, root_directions,
                                            Numbering::blade(k), {}, z_dot, z, energies);
      for (const SteadyHinge& hinge : hinges_[k])
        energies(Numbering::blade(k) + motions_a_beam + hinge.motion) +=
            half_product(z_dot(hinge.angle), momentum.along(hinge.twist));
      carried += momentum.from(blade.root - pin_);
    }
    add_joint(teeter, layout_.teeter(), sum(teeter_axis_, carried.angular));
    carried = carried.from(pin_ - bearing_);
    carried += shaft_.momentum_of(shaft);
    const Complex turning = sum(shaft_axis_, carried.angular);
    const Complex rolling = sum(shaft_axis_, nacelle.rotation);
    const Complex spin = chain_.generator_inertia * (rolling + chain_.gear_ratio * q_g);
    add_joint(torsion, layout_.shaft_torsion(), turning);
    add_joint(generator, layout_.generator(), turning + chain_.gear_ratio * spin);
    carried = carried.from(bearing_ - top_);
    carried += nacelle_.momentum_of(nacelle);
    for (const Rider& rider : nacelle_riders_)
      carried += rider.momentum_of(top_, nacelle, z_dot, z, energies);
    carried.angular += shaft_axis_ * spin;
    add_joint(yaw, layout_.yaw(), sum(yaw_axis_, carried.angular));
    if (has_tower_)
      momentum_of(tower_, {}, tower_directions, foundation_directions, numbering_.tower, carried,
                  z_dot, z, energies);
    return energies;
  }

 private:
  static Complex sum(const Vector3& axis, const Vector3c& vector) {
    return axis.cast<Complex>().cwiseProduct(vector).sum();
  }

  /// Places a blade behind its hinges, at the apex of a hub with the axes C.
  void place_blade(const model::Turbine& turbine, std::size_t k, double t, const Vector3& apex,
                   const Matrix3& C, const Eigen::VectorXd& steady) {
    const model::BladeRoot& root = turbine.roots[k];
    const int blade = static_cast<int>(k);
    const auto angle_of = [&](int hinge) { return steady(layout_.hinge(blade, hinge)); };
    std::vector<SteadyHinge> hinges(root.hinges.size());
    std::vector<Vector3> points(root.hinges.size());
    Vector3 place_of_pitch = apex;
    Vector3 pitch_axis = Vector3::Zero();
    Vector3 at = apex;
    Matrix3 axes = C;
    for (const model::RootLink& link : root.links) {
      at += axes * link.arm;
      axes = (axes * link.axes).eval();
      const Vector3 axis = axes * link.axis;
      double angle = link.motion.at(t, turbine.speed).angle;
      if (link.is_pitch) {
        place_of_pitch = at;
        pitch_axis = axis;
        angle += pitch_[k] - root.pitch;
      }
      if (link.hinge >= 0) {
        const auto i = static_cast<std::size_t>(link.hinge);
        points[i] = at;
        hinges[i] = {layout_.hinge(blade, link.hinge), motion_of(root.hinges[i].axis), {}};
        hinges[i].twist.rotation = axis.cast<Complex>();
        angle += angle_of(link.hinge);
      }
      if (link.is_pitch && root.flap_hinge >= 0)
        angle += root.pitch_by_flap * angle_of(root.flap_hinge);
      axes = (axes * math::turn_about<double>(link.axis, angle)).eval();
    }
    // Twists of the root's place: a hinge turns it about the hinge's point, the pitch link about
    // the point of the pitch.
    for (std::size_t i = 0; i < hinges.size(); ++i)
      hinges[i].twist = hinges[i].twist.at(at - points[i]);
    if (root.flap_hinge >= 0 && root.pitch_by_flap != 0.0) {
      Twist linked;
      linked.rotation = pitch_axis.cast<Complex>();
      Twist& flap = hinges[static_cast<std::size_t>(root.flap_hinge)].twist;
      flap = flap + linked.at(at - place_of_pitch) * root.pitch_by_flap;
    }
    hinges_.push_back(hinges);
    blades_.push_back(place(layout_.beams()[k], at, axes, steady));
  }

  /// Places mass dampers. Their motions come after all others, in the order of declaration.
  void place_riders(const TurbineEquations& equations, const Eigen::VectorXd& steady) {
    int motion = numbering_.size;
    for (std::size_t d = 0; d < equations.mass_dampers().size(); ++d) {
      const model::MassDamper& damper = equations.turbine().mass_dampers[d];
      SteadyBeam& beam =
          damper.blade < 0 ? tower_ : blades_[static_cast<std::size_t>(damper.blade)];
      SteadyBeam::Point& point =
          damper.node < 0 ? beam.points.back()
                          : beam.points[static_cast<std::size_t>(beam.gauss_points + damper.node)];
      const Matrix3 axes = damper.is_on_nacelle() ? nacelle_axes_ : point.node_axes;
      Rider rider;
      rider.mass = damper.definition.mass;
      rider.place = damper.is_on_nacelle() ? top_ : point.mass.place;
      rider.place += axes * damper.place;
      rider.motion = motion;
      for (std::size_t i = 0; i < damper.definition.axes.size(); ++i) {
        rider.axes.push_back(axes * damper.axis(i));
        rider.displacements.push_back(equations.mass_dampers()[d]->first(i));
        rider.place += rider.axes.back() * steady(rider.displacements.back());
        ++motion;
      }
      (damper.is_on_nacelle() ? nacelle_riders_ : point.riders).push_back(rider);
    }
  }

  /// Places the tower. C becomes the axes of the tower top: ground components of t1 t2 t3.
  void place_tower(const Eigen::VectorXd& steady, Matrix3& C) {
    Matrix3 upright;  // a = (n3, n1, n2)
    upright << 0, 1, 0, 0, 0, 1, 1, 0, 0;
    tower_ = place(layout_.beams().back(), Vector3::Zero(), upright, steady);
    top_ = tower_.tip;
    const Vector3 theta = steady.segment<3>(layout_.tower_tip() + 3);
    C = upright * math::direction_cosines<double>(theta).transpose() * upright.transpose();
  }

  /// Adds the energies of a beam's motions and returns its momentum about its root. `base`: motion
  /// of the root's place; `carried`: momentum of the parts on the tip, about the tip.
  static Momentum momentum_of(const SteadyBeam& beam, const Twist& base,
                              const Directions& deformation, const Directions& root, int first,
                              const Momentum& carried,
                              const Eigen::Ref<const Eigen::VectorXcd>& z_dot,
                              const Eigen::Ref<const Eigen::VectorXcd>& z,
                              Eigen::VectorXd& energies) {
    Twist given;
    Vector3 foot = beam.root;
    if (beam.has_support) {
      given = beam.support.node.twist_of(z_dot);
      foot = beam.support.mass.place;
    }
    Momentum total;
    for (std::size_t i = 0; i < beam.points.size(); ++i) {
      const SteadyBeam::Point& point = beam.points[i];
      const Twist own = point.node.twist_of(z);
      const Twist rate = point.node.twist_of(z_dot);
      const Vector3& at = point.mass.place;
      const Twist whole = own + base.at(at - beam.root);
      Momentum momentum = point.mass.momentum_of(whole);
      for (const Rider& rider : point.riders)
        momentum += rider.momentum_of(at, whole, z_dot, z, energies);
      if (i + 1 == beam.points.size()) momentum += carried;
      const Twist deformed = rate - given.at(at - foot);
      // About the centre of a mass, translation and rotation have no common momentum.
      const Vector3& center = point.mass.center;
      add_products(deformed.at(center), momentum.from(-center), point.axes, deformation.motion,
                   first, energies);
      total += momentum.from(at - beam.root);
    }
    if (beam.has_support)
      add_products(given, total.from(beam.root - foot), beam.points.front().node.C, root.motion,
                   first + motions_a_beam, energies);
    return total;
  }

  const TurbineLayout& layout_;
  const elements::RigidChain& chain_;
  Numbering numbering_;
  bool has_tower_;
  int size_;
  SteadyBeam tower_;
  std::vector<SteadyBeam> blades_;
  std::vector<std::vector<SteadyHinge>> hinges_;  ///< hinges of each blade
  Mass nacelle_, shaft_, hub_;
  std::vector<double> pitch_;  ///< pitch of each blade
  Matrix3 nacelle_axes_ = Matrix3::Identity();
  std::vector<Rider> nacelle_riders_;
  Vector3 top_ = Vector3::Zero();
  Vector3 bearing_ = Vector3::Zero();
  Vector3 pin_ = Vector3::Zero();
  Vector3 yaw_axis_ = Vector3::UnitZ();
  Vector3 shaft_axis_ = Vector3::UnitY();
  Vector3 teeter_axis_ = Vector3::UnitX();
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
