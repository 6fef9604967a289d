// Turbines for the tests of the system, with everything non-zero that can be, and PETSc's objects
// as dense arrays.
#pragma once

#include <complex>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "samara/math/rotation.hpp"
#include "samara/model/turbine.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace samara::sample {

/// Variation from sample to sample.
struct Choice {
  int blades = 2;
  int order = 1;
  bool tower = true;
  bool yaw = true;
  bool teeter = true;
  bool damped = true;
  bool rigid_shear = false;  ///< and rigid extension, as in the paper
  bool full = false;         ///< beams that lean, masses on them, delta-3, a free drivetrain
  bool prescribed = false;   ///< yaw and teeter that move as prescribed
};

/// Every combination that meets another branch of the assembly.
inline std::vector<Choice> choices() {
  return {{2, 1, true, true, true, true, false},
          {2, 2, true, true, true, false, true},
          {3, 1, true, true, false, true, false},
          {3, 3, true, false, false, false, false},
          {2, 3, true, false, true, true, true},
          {1, 2, true, true, false, false, false},
          {2, 2, false, true, true, true, false},
          {3, 2, false, false, false, true, true},
          {2, 1, true, true, true, true, false, true},
          {3, 2, true, false, false, true, true, true},
          {2, 2, true, false, false, true, false, false, true},
          {2, 1, true, false, false, false, true, true, true}};
}

/// Section mass per length `m` with its centre at (0, c2, c3) and inertias about the centre.
inline Matrix6 section_mass(double m, double c2, double c3, const Vector3& inertia) {
  const Matrix3 across = math::skew<double>(Vector3(0.0, c2, c3));
  Matrix6 mass;
  mass << m * Matrix3::Identity(), -m * across, m * across,
      Matrix3(inertia.asDiagonal()) - m * across * across;
  return mass;
}

/// Diagonal stiffness (EA, GA2, GA3, GJ, EI2, EI3) with couplings between every two strains.
inline Matrix6 section_stiffness(const Vector6& diagonal, double coupling) {
  Matrix6 stiffness = diagonal.asDiagonal();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      if (i != j)
        stiffness(i, j) =
            coupling * ((i + j) % 2 == 0 ? 1.0 : -1.0) * std::sqrt(diagonal(i) * diagonal(j));
  return stiffness;
}

inline model::SectionDefinition section(double at, double m, const Vector6& stiffness,
                                        const Choice& choice) {
  model::SectionDefinition s;
  s.at = at;
  s.stiffness = section_stiffness(stiffness, 0.12);
  s.mass = section_mass(m, 0.11, -0.07, Vector3(0.5, 0.2, 0.3));
  s.twist = 0.3 * (1.0 - at);
  if (choice.rigid_shear) {
    for (int i = 0; i < 3; ++i) {
      s.rigid[static_cast<std::size_t>(i)] = true;
      s.stiffness.row(i).setZero();
      s.stiffness.col(i).setZero();
    }
  }
  return s;
}

/// Tilt, cone, pitch, overhang, undersling, offsets, twist, springs and dampers are all there;
/// strains of some percent under the turbine's own weight.
inline model::TurbineDefinition turbine_definition(const Choice& choice) {
  model::TurbineDefinition d;
  d.gravity = 9.81;
  d.has_tower = choice.tower;
  d.has_nacelle = true;
  const Vector6 blade(4e4, 2e4, 3e4, 1e3, 1.5e3, 2.5e3);
  const Vector6 tower(3e5, 2e5, 2e5, 1.5e4, 2e4, 2.2e4);
  Vector6 damping;
  damping << 0.01, 0.02, 0.03, 0.04, 0.05, 0.06;

  d.tower.length = 5.0;
  d.tower.elements = 2;
  d.tower.order = 1 + choice.order % 3;
  d.tower.sections = {section(0.0, 4.0, tower, choice), section(1.0, 3.0, 0.7 * tower, choice)};
  if (choice.damped) d.tower.damping = damping;
  if (choice.damped) d.tower.mass_damping = Vector3(0.1, 0.3, 0.2);
  d.tower.tip_mass = 0.8;

  d.nacelle.mass = 7.0;
  d.nacelle.center_of_mass = Vector3(0.1, 0.3, 0.4);
  d.nacelle.inertia = Vector3(3.0, 2.0, 4.0);
  d.nacelle.yaw = {choice.yaw ? model::JointKind::free : model::JointKind::locked, 300.0, 20.0};
  d.shaft.speed = 3.0;
  d.shaft.overhang = 1.1;
  d.shaft.tilt = 0.15;
  d.shaft.height = 0.4;
  d.shaft.azimuth = 0.7;
  d.shaft.mass = 2.0;
  d.shaft.center_of_mass = 0.6;
  d.shaft.inertia_axial = 0.4;
  d.shaft.inertia_transverse = 0.9;
  d.hub.mass = 3.0;
  d.hub.center_of_mass = 0.2;
  d.hub.inertia = Vector3(0.8, 0.5, 0.8);
  d.hub.radius = 0.35;
  d.hub.teeter = {choice.teeter ? model::JointKind::free : model::JointKind::locked, 200.0, 10.0};
  d.hub.undersling = -0.25;
  d.blades.count = choice.blades;
  d.blades.precone = 0.08;
  d.blades.pitch = 0.2;
  d.blades.beam.length = 3.0;
  d.blades.beam.elements = 2;
  d.blades.beam.order = choice.order;
  d.blades.beam.sections = {section(0.0, 2.0, blade, choice),
                            section(1.0, 1.2, 0.6 * blade, choice)};
  if (choice.damped) d.blades.beam.damping = damping;
  if (choice.damped) d.blades.beam.mass_damping = Vector3(0.2, 0.5, 0.4);
  d.blades.beam.tip_mass = choice.order == 2 ? 0.0 : 0.7;
  if (choice.prescribed) {
    d.nacelle.yaw.kind = d.hub.teeter.kind = model::JointKind::prescribed;
    d.nacelle.yaw.motion = {0.5, 0.2, 2, 0.0, 0.7};
    d.hub.teeter.motion = {-0.1, 0.15, 1, 0.0, -0.4};
    d.hub.point_masses = {{1.5, Vector3(0.3, -0.2, -0.6), Vector3(0.1, 0.2, 0.3)},
                          {0.4, Vector3(-0.5, 0.1, 0.2), Vector3(0.02, 0.01, 0.03)}};
  }
  d.shaft.generator.inertia = 1.1;
  d.shaft.gear_ratio = choice.blades == 2 ? -2.5 : 1.8;
  if (!choice.full) return d;
  // Two points make a line that leans from the root on.
  d.tower.reference_line = {Vector3::Zero(), Vector3(4.8, 0.9, -1.1)};
  d.blades.beam.reference_line = {Vector3::Zero(), Vector3(2.7, -0.8, 0.6)};
  for (model::BeamDefinition* beam : {&d.tower, &d.blades.beam})
    beam->length = beam->reference_line.back().norm();
  d.tower.point_masses = {{0.4, 1.2, Vector3(0.1, -0.2, 0.3), Vector3(0.2, 0.3, 0.4)},
                          {1.0, 0.9, Vector3(-0.1, 0.2, 0.1), Vector3(0.3, 0.1, 0.2)}};
  d.blades.beam.point_masses = {{0.55, 0.6, Vector3(0.05, 0.1, -0.1), Vector3(0.1, 0.05, 0.08)},
                                {1.0, 0.3, Vector3(0.0, 0.1, 0.2), Vector3(0.02, 0.03, 0.01)}};
  d.hub.delta3 = 0.5;
  d.shaft.torsion = {model::JointKind::free, 250.0, 15.0};
  d.shaft.generator = {model::JointKind::free, 1.5, {6.0, 4.0, {}}};
  d.shaft.rotor = {5.0, -3.0, {}};
  return d;
}

/// A state in which everything moves, with rotations up to |theta| = 2 (a right angle), and
/// internal loads that strain the sections by some percent.
struct RandomState {
  Eigen::VectorXd z;
  Eigen::VectorXd z_dot;
};

inline RandomState random_state(const turbine::TurbineSystem& turbine, unsigned seed) {
  std::minstd_rand random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  RandomState state;
  state.z.resize(turbine.size());
  state.z_dot.resize(turbine.size());
  for (int i = 0; i < turbine.size(); ++i) {
    const system::UnknownRole role = turbine.unknowns()[static_cast<std::size_t>(i)].role;
    // theta has three components of up to 2 / sqrt(3).
    const double size = role == system::UnknownRole::position   ? 1.15
                        : role == system::UnknownRole::velocity ? 3.0
                        : role == system::UnknownRole::state    ? 0.3
                                                                : 60.0;
    state.z(i) = size * uniform(random);
    state.z_dot(i) = size * uniform(random);
  }
  return state;
}

/// The rows of a vector that this rank owns, from a whole one.
inline petsc::Handle<Vec> to_petsc(const system::PeriodicSystem& system,
                                   const Eigen::VectorXd& values) {
  petsc::Handle<Vec> vector = system.make_state();
  PetscInt first = 0;
  PetscInt last = 0;
  petsc::check(VecGetOwnershipRange(vector.get(), &first, &last));
  const petsc::WriteView view(vector.get());
  for (PetscInt i = first; i < last; ++i) view[i - first] = values(i);
  return vector;
}

/// This rank's rows in their places; zero elsewhere.
inline Eigen::VectorXd to_dense(Vec vector) {
  PetscInt size = 0;
  PetscInt first = 0;
  PetscInt last = 0;
  petsc::check(VecGetSize(vector, &size));
  petsc::check(VecGetOwnershipRange(vector, &first, &last));
  Eigen::VectorXd values = Eigen::VectorXd::Zero(size);
  const petsc::ReadView view(vector);
  for (PetscInt i = first; i < last; ++i) values(i) = view[i - first];
  return values;
}

inline Eigen::MatrixXd to_dense(Mat matrix) {
  PetscInt rows = 0;
  PetscInt columns = 0;
  PetscInt first = 0;
  PetscInt last = 0;
  petsc::check(MatGetSize(matrix, &rows, &columns));
  petsc::check(MatGetOwnershipRange(matrix, &first, &last));
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(rows, columns);
  for (PetscInt i = first; i < last; ++i) {
    PetscInt count = 0;
    const PetscInt* places = nullptr;
    const PetscScalar* values = nullptr;
    petsc::check(MatGetRow(matrix, i, &count, &places, &values));
    for (PetscInt c = 0; c < count; ++c) dense(i, places[c]) = values[c];
    petsc::check(MatRestoreRow(matrix, i, &count, &places, &values));
  }
  return dense;
}

inline Eigen::VectorXd residual_of(const system::PeriodicSystem& system, double t,
                                   const Eigen::VectorXd& z, const Eigen::VectorXd& z_dot) {
  const petsc::Handle<Vec> r = system.make_state();
  system.residual(t, to_petsc(system, z).get(), to_petsc(system, z_dot).get(), r.get());
  return to_dense(r.get());
}

struct Tangents {
  Eigen::MatrixXd K;
  Eigen::MatrixXd M;
};

inline Tangents tangents_of(const system::PeriodicSystem& system, double t,
                            const Eigen::VectorXd& z, const Eigen::VectorXd& z_dot) {
  const petsc::Handle<Mat> K = system.make_jacobian();
  const petsc::Handle<Mat> M = system.make_mass();
  system.tangents(t, to_petsc(system, z).get(), to_petsc(system, z_dot).get(), 0.0, K.get(),
                  M.get());
  return {to_dense(K.get()), to_dense(M.get())};
}

/// Largest difference of the tangents from a complex step of the residual, relative to the largest
/// entry of the row in K and M.
inline double tangent_error(const turbine::TurbineSystem& system, double t,
                            const RandomState& state) {
  using Complex = std::complex<double>;
  const auto n = static_cast<std::size_t>(system.size());
  const Tangents found = tangents_of(system, t, state.z, state.z_dot);
  std::vector<Complex> z(state.z.data(), state.z.data() + n);
  std::vector<Complex> z_dot(state.z_dot.data(), state.z_dot.data() + n);
  std::vector<Complex> r(n);
  Tangents expected{Eigen::MatrixXd(n, n), Eigen::MatrixXd(n, n)};
  constexpr double step = 1e-30;
  const auto fill_column = [&](std::vector<Complex>& moved, Eigen::MatrixXd& target,
                               std::size_t j) {
    const Complex before = moved[j];
    moved[j] += Complex(0.0, step);
    system.equations().evaluate<Complex>(t, z, z_dot, r);
    for (std::size_t i = 0; i < n; ++i)
      target(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = r[i].imag() / step;
    moved[j] = before;
  };
  for (std::size_t j = 0; j < n; ++j) {
    fill_column(z, expected.K, j);
    fill_column(z_dot, expected.M, j);
  }
  const Eigen::VectorXd scale = expected.K.cwiseAbs().rowwise().maxCoeff().cwiseMax(
      expected.M.cwiseAbs().rowwise().maxCoeff());
  const Eigen::VectorXd error =
      (found.K - expected.K)
          .cwiseAbs()
          .rowwise()
          .maxCoeff()
          .cwiseMax((found.M - expected.M).cwiseAbs().rowwise().maxCoeff());
  return error.cwiseQuotient(scale).maxCoeff();
}

inline Eigen::VectorXd reference_state_of(const system::PeriodicSystem& system, double t) {
  const petsc::Handle<Vec> z = system.make_state();
  system.reference_state(t, z.get());
  return to_dense(z.get());
}

}  // namespace samara::sample
