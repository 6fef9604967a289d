// Where the masses of a turbine are in the inertial axes (n1, n2, n3), and how they move: written
// from the definition and the unknowns by plain geometry, as a check of the assembled balances.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "sample_turbine.hpp"

namespace samara::sample {

/// Angle and axis of Rodrigues parameters, by Eigen.
inline Matrix3 turned(const Vector3& theta) {
  if (theta.norm() == 0.0) return Matrix3::Identity();
  return Eigen::AngleAxisd(2.0 * std::atan(0.5 * theta.norm()), theta.normalized())
      .toRotationMatrix();
}

inline Matrix3 turned(const Vector3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

/// Axes b1, b2, b3 of blade k (from 0) as columns in hub axes, from the case file's page: b1 from
/// root to tip, at azimuth 0 up and turning toward h1, tips of positive cone toward h2; b3 along
/// the shaft and b2 toward the leading edge; positive pitch turns the leading edge upwind.
inline Matrix3 blade_axes(const model::BladesDefinition& blades, int k) {
  const double azimuth = 2.0 * std::numbers::pi * k / blades.count;
  const double pitch =
      blades.pitch + (blades.each.count(k + 1) == 0 ? 0.0 : blades.each.at(k + 1).pitch);
  const double cone = blades.precone;
  const Vector3 outward(std::sin(azimuth), 0.0, std::cos(azimuth));
  const Vector3 forward(std::cos(azimuth), 0.0, -std::sin(azimuth));
  const Vector3 downwind(0.0, 1.0, 0.0);
  const Vector3 normal = downwind * std::cos(cone) - outward * std::sin(cone);
  Matrix3 axes;
  axes.col(0) = outward * std::cos(cone) + downwind * std::sin(cone);
  axes.col(1) = forward * std::cos(pitch) - normal * std::sin(pitch);
  axes.col(2) = normal * std::cos(pitch) + forward * std::sin(pitch);
  return axes;
}

/// A piece of the turbine: a rigid body, a Gauss point's share of its beam, or a tip mass.
struct Piece {
  double mass = 0.0;
  Vector3 center = Vector3::Zero();              ///< in N
  Vector3 momentum = Vector3::Zero();            ///< in N
  Vector3 moment_of_momentum = Vector3::Zero();  ///< about the origin of N
  double kinetic = 0.0;
  double strain = 0.0;  ///< strain energy
  int blade = -1;       ///< from 0; -1: tower, nacelle, shaft, hub
};

/// All pieces, and the frames that they hang on.
struct Bodies {
  std::vector<Piece> pieces;
  Vector3 top = Vector3::Zero();
  Matrix3 R_T = Matrix3::Identity();
  Matrix3 R_H = Matrix3::Identity();
  std::vector<Vector3> roots;
  std::vector<Matrix3> axes;  ///< of the blades at their roots, in N
  double joint_energy = 0.0;
  double gear_rate = 0.0;  ///< of the gear's low-speed end against the nacelle [rad/s]

  double mass() const {
    double sum = 0.0;
    for (const Piece& piece : pieces) sum += piece.mass;
    return sum;
  }
  /// Potential of gravity.
  double potential(double gravity) const {
    double sum = 0.0;
    for (const Piece& piece : pieces) sum += piece.mass * gravity * piece.center(2);
    return sum;
  }
  double kinetic() const {
    double sum = 0.0;
    for (const Piece& piece : pieces) sum += piece.kinetic;
    return sum;
  }
  double strain() const {
    double sum = joint_energy;
    for (const Piece& piece : pieces) sum += piece.strain;
    return sum;
  }
};

class BodyBuilder {
 public:
  BodyBuilder(const model::TurbineDefinition& definition, const turbine::TurbineSystem& system,
              double t, const Eigen::VectorXd& z)
      : definition_(definition), system_(system), z_(z), layout_(system.layout()), time_(t) {}

  Bodies run() {
    tower_axes_ << 0, 1, 0, 0, 0, 1, 1, 0, 0;  // columns b1 b2 b3 = n3 n1 n2
    if (definition_.has_tower) add_tower();
    add_nacelle_and_rotor();
    return bodies_;
  }

 private:
  Vector3 three(int first) const { return z_.segment<3>(first); }

  void add_tower() {
    const model::Beam& beam = system_.turbine().tower;
    for (int p = 0; p < beam.point_count(); ++p)
      add_point(definition_.tower, beam, p, layout_.tower_point(p), Vector3::Zero(), tower_axes_,
                {}, -1);
    const int tip = layout_.tower_tip();
    bodies_.top = tower_axes_ * (undeformed(definition_.tower, 1.0) + three(tip));
    bodies_.R_T = turned(Vector3(tower_axes_ * three(tip + 3)));
    // Components along (t3, t1, t2) are those along the turned tower axes.
    top_velocity_ = bodies_.R_T * tower_axes_ * three(tip + 6);
    top_spin_ = bodies_.R_T * tower_axes_ * three(tip + 9);
    add_particle(definition_.tower.tip_mass, bodies_.top, top_velocity_, -1);
    add_lumps(definition_.tower, Vector3::Zero(), tower_axes_, -1);
  }

  /// Undeformed place on a line of no or two points, in the beam's axes.
  static Vector3 undeformed(const model::BeamDefinition& beam, double fraction) {
    if (beam.reference_line.empty()) return {fraction * beam.length, 0.0, 0.0};
    return fraction * beam.reference_line.back();
  }

  /// Section axes there: twist turns b2 toward -b3, as pitch does.
  static Matrix3 undeformed_axes(const model::BeamDefinition& beam, double fraction) {
    const double twist = model::interpolate_section(beam, fraction).twist;
    const Vector3 along = undeformed(beam, 1.0);
    return Eigen::Quaterniond::FromTwoVectors(Vector3::UnitX(), along).toRotationMatrix() *
           turned(Vector3::UnitX(), -twist);
  }

  /// Masses on the beam; `number` of the blade from 0, -1: tower.
  void add_lumps(const model::BeamDefinition& beam, const Vector3& root, const Matrix3& axes,
                 int number) {
    int inner = 0;
    for (const model::PointMassDefinition& lump : beam.point_masses) {
      int first = number < 0 ? layout_.tower_tip() : layout_.blade_tip(number);
      if (lump.at < 1.0) {
        first = number < 0 ? layout_.tower_mass(inner) : layout_.blade_mass(number, inner);
        ++inner;
      }
      const Matrix3 R = axes * turned(three(first + 3));
      const Vector3 place = root + axes * (undeformed(beam, lump.at) + three(first));
      add_body(lump.mass, lump.center, lump.inertia, place, R * three(first + 6),
               R * undeformed_axes(beam, lump.at), R * three(first + 9));
      bodies_.pieces.back().blade = number;
    }
  }

  void add_nacelle_and_rotor() {
    const model::ShaftDefinition& shaft = definition_.shaft;
    const model::HubDefinition& hub = definition_.hub;
    const model::NacelleDefinition& nacelle = definition_.nacelle;
    const bool yaws = nacelle.yaw.kind != model::JointKind::locked;
    const bool teeters = hub.teeter.kind != model::JointKind::locked;
    const double yaw = z_(layout_.yaw());
    const double teeter = z_(layout_.teeter());
    Matrix3 R_Y = bodies_.R_T;
    Vector3 spin = top_spin_;
    if (yaws) {
      R_Y = bodies_.R_T * turned(Vector3::UnitZ(), yaw);
      // U1 is the nacelle's whole angular velocity about y3.
      spin += R_Y.col(2) * (z_(layout_.yaw() + 1) - R_Y.col(2).dot(spin));
      if (nacelle.yaw.kind == model::JointKind::free)
        bodies_.joint_energy += 0.5 * nacelle.yaw.stiffness * yaw * yaw;
    }
    add_body(nacelle.mass, nacelle.center_of_mass, nacelle.inertia, bodies_.top, top_velocity_, R_Y,
             spin);
    const Matrix3 bearing = R_Y * turned(Vector3::UnitX(), shaft.tilt);
    double azimuth = shaft.azimuth + shaft.speed * time_;
    const Vector3 along = bearing.col(1);
    const Vector3 place = bodies_.top + R_Y.col(2) * shaft.height;
    const Vector3 velocity = top_velocity_ + spin.cross(place - bodies_.top);
    const auto turn_on = [&](model::JointKind kind, int joint, double rate) {
      if (kind == model::JointKind::free) {
        azimuth += z_(joint);
        rate = z_(joint + 1) - along.dot(spin);
      }
      spin += along * rate;
    };
    const Vector3 carried = spin;
    turn_on(shaft.generator.kind, layout_.generator(), shaft.speed);
    bodies_.gear_rate = along.dot(spin - carried);
    add_body(0.0, Vector3::Zero(), Vector3(0.0, shaft.generator.inertia, 0.0), place, velocity,
             bearing, carried + shaft.gear_ratio * bodies_.gear_rate * along);
    turn_on(shaft.torsion.kind, layout_.shaft_torsion(), 0.0);
    const double twist = z_(layout_.shaft_torsion());
    if (shaft.torsion.kind == model::JointKind::free)
      bodies_.joint_energy += 0.5 * shaft.torsion.stiffness * twist * twist;
    const Matrix3 R_S = bearing * turned(Vector3::UnitY(), azimuth);
    add_body(shaft.mass, Vector3(0.0, shaft.center_of_mass, 0.0),
             Vector3(shaft.inertia_transverse, shaft.inertia_axial, shaft.inertia_transverse),
             place, velocity, R_S, spin);
    const Vector3 pin = place + R_S.col(1) * shaft.overhang;
    const Vector3 pin_velocity = velocity + spin.cross(pin - place);
    bodies_.R_H = R_S;
    if (teeters) {
      const Vector3 axis(std::cos(hub.delta3), 0.0, std::sin(hub.delta3));
      const Vector3 hinge = R_S * axis;
      bodies_.R_H = R_S * turned(axis, teeter);
      spin += hinge * (z_(layout_.teeter() + 1) - hinge.dot(spin));
      if (hub.teeter.kind == model::JointKind::free)
        bodies_.joint_energy += 0.5 * hub.teeter.stiffness * teeter * teeter;
    }
    add_body(hub.mass, Vector3(0.0, hub.center_of_mass, 0.0), hub.inertia, pin, pin_velocity,
             bodies_.R_H, spin);
    for (const model::HubMassDefinition& lump : hub.point_masses)
      add_body(lump.mass, lump.center, lump.inertia, pin, pin_velocity, bodies_.R_H, spin);
    const Vector3 apex = pin + bodies_.R_H.col(1) * hub.undersling;
    for (int k = 0; k < definition_.blades.count; ++k) add_blade(k, apex);
  }

  void add_body(double mass, const Vector3& center, const Vector3& inertia, const Vector3& place,
                const Vector3& velocity, const Matrix3& R, const Vector3& spin) {
    Piece piece;
    const Vector3 arm = R * center;
    const Vector3 v = velocity + spin.cross(arm);
    const Vector3 local_spin = R.transpose() * spin;
    const Vector3 local_momentum = inertia.cwiseProduct(local_spin);
    piece.mass = mass;
    piece.center = place + arm;
    piece.momentum = mass * v;
    piece.moment_of_momentum = piece.center.cross(piece.momentum) + R * local_momentum;
    piece.kinetic = 0.5 * mass * v.squaredNorm() + 0.5 * local_spin.dot(local_momentum);
    bodies_.pieces.push_back(piece);
  }

  void add_blade(int k, const Vector3& apex) {
    const model::Beam& beam = system_.turbine().blades[static_cast<std::size_t>(k)];
    const Matrix3 axes = bodies_.R_H * blade_axes(definition_.blades, k);
    const Vector3 root = apex + definition_.hub.radius * axes.col(0);
    const model::BladeDifference own = definition_.blades.each.count(k + 1) == 0
                                           ? model::BladeDifference{}
                                           : definition_.blades.each.at(k + 1);
    bodies_.roots.push_back(root);
    bodies_.axes.push_back(axes);
    for (int p = 0; p < beam.point_count(); ++p)
      add_point(definition_.blades.beam, beam, p, layout_.blade_point(k, p), root, axes, own, k);
    const int tip = layout_.blade_tip(k);
    const Vector3 velocity = axes * turned(three(tip + 3)) * three(tip + 6);
    add_particle(definition_.blades.beam.tip_mass,
                 root + axes * (undeformed(definition_.blades.beam, 1.0) + three(tip)), velocity,
                 k);
    add_lumps(definition_.blades.beam, root, axes, k);
  }

  void add_particle(double mass, const Vector3& place, const Vector3& velocity, int blade) {
    Piece piece;
    piece.mass = mass;
    piece.center = place;
    piece.momentum = mass * velocity;
    piece.moment_of_momentum = place.cross(piece.momentum);
    piece.kinetic = 0.5 * mass * velocity.squaredNorm();
    piece.blade = blade;
    bodies_.pieces.push_back(piece);
  }

  void add_point(const model::BeamDefinition& definition, const model::Beam& beam, int p, int first,
                 const Vector3& root, const Matrix3& axes, const model::BladeDifference& own,
                 int blade) {
    const auto at = static_cast<std::size_t>(p);
    const double fraction = beam.fractions[at];
    const model::SectionDefinition section = model::interpolate_section(definition, fraction);
    const Matrix6 mass = own.mass_factor * section.mass;
    const Matrix6 compliance = model::compliance_of(section) / own.stiffness_factor;
    const double length = beam.point_length(p);
    const Matrix3 section_axes =
        axes * turned(three(first + 3)) * undeformed_axes(definition, fraction);
    const Vector3 place = root + axes * (undeformed(definition, fraction) + three(first));
    const Vector3 center(0.0, mass(0, 5) == 0.0 ? 0.0 : -mass(0, 5) / mass(0, 0),
                         mass(0, 4) / mass(0, 0));
    const Vector6 velocity = z_.segment<6>(first + 6);
    const Vector6 momentum = mass * velocity;
    const Vector6 load = z_.segment<6>(first + 12);
    Piece piece;
    piece.mass = length * mass(0, 0);
    piece.center = place + section_axes * center;
    piece.momentum = length * (section_axes * momentum.head<3>());
    piece.moment_of_momentum =
        place.cross(piece.momentum) + length * (section_axes * momentum.tail<3>());
    piece.kinetic = 0.5 * length * velocity.dot(momentum);
    piece.strain = 0.5 * length * load.dot(compliance * load);
    piece.blade = blade;
    bodies_.pieces.push_back(piece);
  }

  const model::TurbineDefinition& definition_;
  const turbine::TurbineSystem& system_;
  const Eigen::VectorXd& z_;
  const turbine::TurbineLayout& layout_;
  double time_ = 0.0;
  Matrix3 tower_axes_ = Matrix3::Identity();
  Vector3 top_velocity_ = Vector3::Zero();
  Vector3 top_spin_ = Vector3::Zero();
  Bodies bodies_;
};

inline Bodies bodies_at(const model::TurbineDefinition& definition,
                        const turbine::TurbineSystem& system, double t, const Eigen::VectorXd& z) {
  return BodyBuilder(definition, system, t, z).run();
}

}  // namespace samara::sample
