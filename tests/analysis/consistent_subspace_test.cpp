// The states that the paper's turbine can have: their number and the equations they obey.
#include "samara/analysis/consistent_subspace.hpp"

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include "samara/analysis/sparse_parts.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/turbine/turbine_system.hpp"

#include "small_systems.hpp"
#include "turbines.hpp"

using namespace samara;
using namespace samara::test;

namespace {

analysis::PeriodicSolution trim_of(const system::PeriodicSystem& system) {
  analysis::Observer observer;
  analysis::TrimOptions options;
  options.harmonics = 2;
  return analysis::find_trim(system, options, observer).solution;
}

Eigen::VectorXd joined(const Eigen::VectorXd& eta, const Eigen::VectorXd& eta_dot) {
  Eigen::VectorXd both(eta.size() + eta_dot.size());
  both << eta, eta_dot;
  return both;
}

/// Largest entry of the rows of one role in `sum`, relative to the largest of the row in `terms`,
/// what was added up for it.
double defect(const system::PeriodicSystem& system, RowRole role, const Eigen::MatrixXd& sum,
              const Eigen::MatrixXd& terms) {
  double worst = 0.0;
  for (Eigen::Index i = 0; i < sum.rows(); ++i) {
    if (system.rows()[static_cast<std::size_t>(i)] != role) continue;
    const double size = terms.row(i).maxCoeff();
    if (size > 0.0) worst = std::max(worst, sum.row(i).cwiseAbs().maxCoeff() / size);
  }
  return worst;
}

/// Round-off of a solve with the constraint rows; the shortest element makes them largest.
constexpr double round_off = 1e-9;

}  // namespace

BOOST_AUTO_TEST_CASE(degrees_of_freedom_are_three_a_tower_point_six_a_blade_point_and_two) {
  // Degrees of freedom: 3 M + 6 N + 2 for M points in the tower and N in a blade, with an order for
  // each.
  for (const Mesh& mesh : {Mesh{4, 1, 4, 1}, Mesh{1, 1, 1, 1}, Mesh{3, 2, 5, 1}, Mesh{1, 3, 2, 2},
                           Mesh{2, 4, 1, 6}, Mesh{7, 1, 3, 3}, Mesh{2, 5, 12, 1}}) {
    const turbine::TurbineSystem system(model::build_turbine(lee_turbine(mesh)), PETSC_COMM_SELF);
    const int tower = mesh.tower_elements * mesh.tower_order;
    const int blade = mesh.blade_elements * mesh.blade_order;
    const analysis::ConsistentSubspace subspace(system, trim_of(system));
    BOOST_TEST(subspace.degrees_of_freedom() == 3 * tower + 6 * blade + 2);
    BOOST_TEST(system.turbine().degrees_of_freedom == 3 * tower + 6 * blade + 2);
  }
}

BOOST_AUTO_TEST_CASE(locked_joints_and_other_rigid_strains_change_the_count) {
  model::TurbineDefinition definition = lee_turbine({2, 2, 3, 1});
  definition.nacelle.yaw.kind = model::JointKind::locked;
  definition.hub.teeter.kind = model::JointKind::locked;
  // All strains of the tower elastic (6 a point), torsion of the blades rigid (2 a point).
  model::SectionDefinition& tower = definition.tower.sections[0];
  tower.rigid = {};
  tower.stiffness.diagonal() << 1e10, 1e9, 1e9, 1e9, 1e9, 1e9;
  definition.blades.beam.sections[0].rigid[3] = true;
  definition.blades.beam.sections[0].stiffness(3, 3) = 0.0;
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  const analysis::ConsistentSubspace subspace(system, trim_of(system));
  BOOST_TEST(subspace.degrees_of_freedom() == 6 * 4 + 2 * 2 * 3);
}

BOOST_AUTO_TEST_CASE(without_tower_and_nacelle_only_blades_and_teeter_move) {
  model::TurbineDefinition definition = lee_turbine({1, 1, 3, 2});
  definition.has_tower = false;
  definition.has_nacelle = false;
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  const analysis::ConsistentSubspace subspace(system, trim_of(system));
  BOOST_TEST(subspace.degrees_of_freedom() == 6 * 6 + 1);
}

BOOST_AUTO_TEST_CASE(basis_is_the_identity_in_its_own_coordinates) {
  const turbine::TurbineSystem system(model::build_turbine(lee_turbine({2, 1, 2, 2})),
                                      PETSC_COMM_SELF);
  const analysis::PeriodicSolution solution = trim_of(system);
  const analysis::ConsistentSubspace subspace(system, solution);
  const Eigen::Index d = subspace.degrees_of_freedom();
  const Eigen::MatrixXd eta = subspace.coordinates_of(subspace.basis(0.0));
  BOOST_TEST((eta.leftCols(d) - Eigen::MatrixXd::Identity(d, d)).cwiseAbs().maxCoeff() < 1e-12);
  BOOST_TEST(eta.rightCols(d).cwiseAbs().maxCoeff() == 0.0);
}

BOOST_AUTO_TEST_CASE(basis_obeys_constraints_and_kinematics_of_a_constant_solution) {
  for (const Mesh& mesh : {Mesh{4, 1, 4, 1}, Mesh{2, 2, 1, 4}}) {
    const turbine::TurbineSystem system(model::build_turbine(lee_turbine(mesh)), PETSC_COMM_SELF);
    const analysis::PeriodicSolution solution = trim_of(system);
    BOOST_REQUIRE(solution.is_constant());
    const analysis::ConsistentSubspace subspace(system, solution);
    const Eigen::Index d = subspace.degrees_of_freedom();
    for (const double t : {0.0, 0.31}) {  // the velocities change with azimuth
      const Eigen::MatrixXd z = subspace.basis(t);
      const analysis::SparseTangents tangents = analysis::tangents_on(system, solution, t);
      // Positions in the left half, at rest; in the right half they are the rates of position.
      Eigen::MatrixXd z_dot = Eigen::MatrixXd::Zero(z.rows(), z.cols());
      z_dot.rightCols(d) = z.leftCols(d);
      for (Eigen::Index i = 0; i < z.rows(); ++i)
        if (system.unknowns()[static_cast<std::size_t>(i)].role != UnknownRole::position)
          z_dot.row(i).setZero();
      const Eigen::MatrixXd sum = tangents.K * z + tangents.M * z_dot;
      const Eigen::MatrixXd terms =
          tangents.K.cwiseAbs() * z.cwiseAbs() + tangents.M.cwiseAbs() * z_dot.cwiseAbs();
      BOOST_TEST(defect(system, RowRole::constraint, sum, terms) < round_off);
      BOOST_TEST(defect(system, RowRole::kinematic, sum, terms) < round_off);
      // Something moves in every column.
      for (Eigen::Index j = 0; j < z.cols(); ++j) BOOST_TEST(z.col(j).norm() > 0.0);
    }
  }
}

BOOST_AUTO_TEST_CASE(basis_obeys_constraints_and_kinematics_of_a_periodic_solution) {
  // Under gravity the constraints change in time: their rate gives the left half a velocity, by
  // central differences with an error of (Omega step)^2 / 6 = 6e-8 of it.
  const turbine::TurbineSystem system(model::build_turbine(lee_turbine({2, 1, 2, 2}, 9.80665)),
                                      PETSC_COMM_SELF);
  const analysis::PeriodicSolution solution = trim_of(system);
  BOOST_REQUIRE(!solution.is_constant());
  const analysis::ConsistentSubspace subspace(system, solution);
  const Eigen::Index d = subspace.degrees_of_freedom();
  constexpr double step = 1e-4;
  const double t = 0.4;
  const Eigen::MatrixXd z = subspace.basis(t);
  const analysis::SparseTangents tangents = analysis::tangents_on(system, solution, t);
  const Eigen::MatrixXd rate = (subspace.basis(t + step) - subspace.basis(t - step)) / (2.0 * step);
  Eigen::MatrixXd z_dot(z.rows(), z.cols());
  z_dot.leftCols(d) = rate.leftCols(d);
  z_dot.rightCols(d) = z.leftCols(d);
  for (Eigen::Index i = 0; i < z.rows(); ++i)
    if (system.unknowns()[static_cast<std::size_t>(i)].role != UnknownRole::position)
      z_dot.row(i).setZero();
  BOOST_TEST(z_dot.leftCols(d).cwiseAbs().maxCoeff() > 0.0);
  const Eigen::MatrixXd sum = tangents.K * z + tangents.M * z_dot;
  const Eigen::MatrixXd terms =
      tangents.K.cwiseAbs() * z.cwiseAbs() + tangents.M.cwiseAbs() * z_dot.cwiseAbs();
  BOOST_TEST(defect(system, RowRole::constraint, sum, terms) < round_off);
  BOOST_TEST(defect(system, RowRole::kinematic, sum, terms) < 1e-7);
}

BOOST_AUTO_TEST_CASE(nonlinear_state_obeys_constraints_and_kinematics) {
  // At deflections of some degrees, where the equations are far from linear.
  const turbine::TurbineSystem system(model::build_turbine(lee_turbine({2, 1, 2, 1})),
                                      PETSC_COMM_SELF);
  const analysis::PeriodicSolution solution = trim_of(system);
  const analysis::ConsistentSubspace subspace(system, solution);
  const double t = 0.3;
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const petsc::Handle<Vec> r = system.make_state();
  solution.evaluate(t, z.get(), z_dot.get());
  Eigen::VectorXd start;
  {
    const petsc::ReadView view(z.get());
    start = Eigen::Map<const Eigen::VectorXd>(view.data(), system.size());
  }
  Eigen::VectorXd eta = subspace.coordinates_of(start);
  Eigen::VectorXd eta_dot = Eigen::VectorXd::Zero(eta.size());
  for (Eigen::Index i = 0; i < eta.size(); ++i) {
    eta(i) += 0.02 * std::sin(static_cast<double>(i));
    eta_dot(i) = 0.1 * std::cos(static_cast<double>(i));
  }
  subspace.find_state(t, joined(eta, eta_dot), z.get());
  Eigen::VectorXd state;
  {
    const petsc::ReadView view(z.get());
    state = Eigen::Map<const Eigen::VectorXd>(view.data(), system.size());
  }
  BOOST_TEST((subspace.coordinates_of(state) - eta).cwiseAbs().maxCoeff() < 1e-12);
  double largest = 0.0;
  for (Eigen::Index i = 0; i < state.size(); ++i)
    if (system.unknowns()[static_cast<std::size_t>(i)].role == UnknownRole::position)
      largest = std::max(largest, std::abs(state(i) - start(i)));
  BOOST_TEST(largest > 0.05);
  // The rates of positions by central differences of neighbouring states.
  constexpr double step = 1e-5;
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(state.size());
  for (const double side : {1.0, -1.0}) {
    const petsc::Handle<Vec> near = system.make_state();
    petsc::check(VecCopy(z.get(), near.get()));
    subspace.find_state(t + side * step, joined(eta + side * step * eta_dot, eta_dot), near.get());
    const petsc::ReadView view(near.get());
    rate += side / (2.0 * step) * Eigen::Map<const Eigen::VectorXd>(view.data(), system.size());
  }
  {
    const petsc::WriteView view(z_dot.get());
    for (PetscInt i = 0; i < system.size(); ++i)
      view[i] = system.unknowns()[static_cast<std::size_t>(i)].role == UnknownRole::position
                    ? rate(i)
                    : 0.0;
  }
  system.residual(t, z.get(), z_dot.get(), r.get());
  const petsc::ReadView view(r.get());
  for (std::size_t i = 0; i < system.rows().size(); ++i) {
    const double value = std::abs(view[static_cast<PetscInt>(i)]);
    if (system.rows()[i] == RowRole::constraint) BOOST_TEST(value < 1e-10);
    if (system.rows()[i] == RowRole::kinematic)  // differences: step^2 and round-off / step
      BOOST_TEST(value < 1e-7, system.unknowns()[i].name() << " " << value);
  }
}

BOOST_AUTO_TEST_CASE(gear_carries_its_positions_and_the_load_of_its_spring) {
  const ChangingGear system;
  const analysis::PeriodicSolution rest(Eigen::MatrixXd::Zero(6, 1), system.period());
  const analysis::ConsistentSubspace subspace(system, rest);
  BOOST_REQUIRE(subspace.degrees_of_freedom() == 1);
  BOOST_TEST(subspace.coordinates()[0] == 4);
  const double t = 0.2;
  const Eigen::MatrixXd z = subspace.basis(t);
  const double w = z(0, 0);
  BOOST_TEST(w != 0.0);
  BOOST_TEST(z(1, 0) == ChangingGear::c(t) * w, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(std::abs(z(2, 0)) < 1e-12 * std::abs(w));
  BOOST_TEST(z(3, 0) == ChangingGear::c_rate(t) * w, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(z(4, 0) == w / ChangingGear::f, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(z(2, 1) == w, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(z(3, 1) == ChangingGear::c(t) * w, boost::test_tools::tolerance(1e-12));
}
