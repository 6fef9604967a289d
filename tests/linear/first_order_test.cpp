// Linear models of systems with first-order states: against the equations themselves.
#include <memory>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include "samara/linear/linear_model.hpp"
#include "samara/linear/lyapunov_floquet.hpp"
#include "samara/linear/multiblade.hpp"

#include "../analysis/first_order_systems.hpp"

using namespace samara;
using namespace samara::test;
using Complex = std::complex<double>;

namespace {

/// A load on one row, which counts with its rates; all unknowns are seen.
class OneRow final : public system::InputOutput {
 public:
  OneRow(const system::PeriodicSystem& system, PetscInt row) : size_(system.size()), row_(row) {
    inputs_.push_back({"load", "", "", "", "", 0, true});
    for (const system::Unknown& unknown : system.unknowns())
      outputs_.push_back({unknown.name(), "", "", "", "", 0, false});
  }
  const std::vector<system::Signal>& inputs() const override { return inputs_; }
  const std::vector<system::Signal>& outputs() const override { return outputs_; }
  system::InputTangents input_tangents(double, Vec, Vec) const override {
    system::InputTangents tangents{Eigen::MatrixXd::Zero(size_, 1),
                                   Eigen::MatrixXd::Zero(size_, 1)};
    tangents.by_value(row_, 0) = -1.0;
    return tangents;
  }
  system::OutputTangents output_tangents(double, Vec, Vec) const override {
    return {Eigen::MatrixXd::Identity(size_, size_), Eigen::MatrixXd::Zero(size_, size_),
            Eigen::MatrixXd::Zero(size_, 1)};
  }
  Eigen::VectorXd output_values(double, Vec z, Vec) const override {
    const petsc::ReadView view(z);
    return Eigen::Map<const Eigen::VectorXd>(view.data(), size_);
  }

 private:
  Eigen::Index size_;
  PetscInt row_;
  std::vector<system::Signal> inputs_, outputs_;
};

/// z of (K + s M) z = f with a unit load on a row.
Eigen::VectorXcd exact_response(const SmallSystem& system, PetscInt row, Complex s) {
  const auto n = static_cast<Eigen::Index>(system.size());
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd M = K;
  system.tangents_at(0.0, Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), K, M);
  Eigen::VectorXcd f = Eigen::VectorXcd::Zero(n);
  f(row) = 1.0;
  return (K + s * M).lu().solve(f);
}

Eigen::VectorXcd response(const linear::LinearModel& model, Complex s) {
  const linear::StateSpace form = model.state_space(0.0);
  Eigen::VectorXcd B = Eigen::VectorXcd::Zero(form.B.rows());
  Eigen::VectorXcd D = Eigen::VectorXcd::Zero(form.D.rows());
  for (std::size_t j = 0; j < model.input_columns().size(); ++j) {
    const Complex factor = std::pow(s, model.input_columns()[j].derivative);
    B += factor * form.B.col(static_cast<Eigen::Index>(j));
    D += factor * form.D.col(static_cast<Eigen::Index>(j));
  }
  const Eigen::MatrixXcd left =
      s * Eigen::MatrixXcd::Identity(form.A.rows(), form.A.rows()) - form.A.cast<Complex>();
  return form.C * left.lu().solve(B) + D;
}

}  // namespace

BOOST_AUTO_TEST_CASE(state_space_answers_as_the_equations_do) {
  std::vector<std::unique_ptr<FirstOrderSystem>> systems;
  systems.push_back(std::make_unique<LagInBalance>(0.0));
  systems.push_back(std::make_unique<StateInKinematics>(0.0));
  systems.push_back(std::make_unique<DrivenJoint>(0.0));
  systems.push_back(std::make_unique<SpeedControl>(0.0));
  for (const auto& system : systems) {
    const analysis::PeriodicSolution solution = rest(*system);
    for (PetscInt row = 0; row < system->size(); ++row) {
      // Inputs stand in no constraint row.
      if (system->rows()[static_cast<std::size_t>(row)] == system::RowRole::constraint) continue;
      const OneRow input_output(*system, row);
      const linear::LinearModel model(*system, input_output, solution);
      BOOST_TEST(model.states().size() == system->explicit_unknowns().size());
      for (const Complex s : {Complex(0.0, 0.3), Complex(0.2, 2.1), Complex(-0.1, 7.0)}) {
        const Eigen::VectorXcd exact = exact_response(*system, row, s);
        BOOST_TEST((response(model, s) - exact).norm() < 1e-12 * exact.norm(),
                   "row " << row << " of " << system->unknowns()[0].name() << ", s = " << s);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_periodic_lag_has_a_constant_form) {
  // x' = (-1 + 2 cos t) x: in Lyapunov-Floquet coordinates its exponent is -1.
  const PeriodicLag system;
  const analysis::PeriodicSolution solution = rest(system);
  const OneRow input_output(system, 0);
  const linear::LinearModel model(system, input_output, solution);
  BOOST_TEST_REQUIRE(model.states().size() == 1U);
  const linear::AzimuthSeries series([&](double psi) { return model.state_space(psi); }, 12, 2);
  const linear::LyapunovFloquet floquet(series, 1.0, 16, 0, linear::LyapunovFloquet::default_steps,
                                        1);
  for (const double psi : {0.0, 1.3, 4.0}) {
    const Eigen::MatrixXd A = floquet.form(psi).A;
    BOOST_TEST(A.rows() == 1);
    BOOST_TEST(std::abs(A(0, 0) + 1.0) < 1e-7);
  }
}

BOOST_AUTO_TEST_CASE(the_state_matrix_of_a_turning_rotor_is_its_explicit_form) {
  const RotorWithLags system(3);
  const analysis::PeriodicSolution solution = rest(system);
  const OneRow input_output(system, 3);
  const linear::LinearModel model(system, input_output, solution);
  for (const double t : {0.0, 0.9, 4.4})
    BOOST_TEST((model.state_space(t).A - system.explicit_form(t)).norm() < 1e-12);
  BOOST_TEST(model.states()[0].name == "blade 1 u");
  BOOST_TEST(model.states()[3].name == "blade 1 u rate");
  BOOST_TEST(model.states()[6].name == "lag 1 x");
  BOOST_TEST(model.states()[9].name == "inflow h");
}

BOOST_AUTO_TEST_CASE(a_constraint_that_changes_in_time_gives_second_rates_of_its_state) {
  const PeriodicJoint system;
  const analysis::PeriodicSolution solution = rest(system);
  const OneRow input_output(system, 3);
  const linear::LinearModel model(system, input_output, solution);
  for (const double t : {0.0, 0.9, 4.4})
    BOOST_TEST((model.state_space(t).A - system.explicit_form(t)).norm() < 1e-7);
}

BOOST_AUTO_TEST_CASE(multiblade_coordinates_make_states_of_blades_constant) {
  // The hub drives by the first harmonic alone, and sees it alone.
  const RotorWithLags system(4);
  const analysis::PeriodicSolution solution = rest(system);
  const OneRow input_output(system, 4);
  const linear::LinearModel model(system, input_output, solution);
  const linear::Multiblade multiblade(model);
  const Eigen::MatrixXd first = multiblade.transform(0.0, model.state_space(0.0)).A;
  BOOST_TEST((model.state_space(0.0).A - model.state_space(0.7).A).norm() > 0.1);
  for (const double t : {0.7, 2.9})
    BOOST_TEST((multiblade.transform(t, model.state_space(t)).A - first).norm() < 1e-12);
  BOOST_TEST(multiblade.states()[8].name == "mean lag x");
  BOOST_TEST(multiblade.states()[12].name == "inflow h");
}
