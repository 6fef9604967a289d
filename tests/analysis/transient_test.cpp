#include "samara/analysis/transient.hpp"

#include <cmath>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/petsc/session.hpp"

#include "small_systems.hpp"

using namespace samara;
using namespace samara::test;
using analysis::TransientMethod;
using analysis::TransientSample;
using boost::test_tools::tolerance;

namespace {

constexpr double gravity = 9.81;

/// Two masses on rigid rods, one hung on the other, of mass and length 1, and rods that pull with
/// the loads N: index 3.
class DoublePendulum final : public SmallSystem {
 public:
  DoublePendulum() {
    for (const char* name : {"x1", "y1", "x2", "y2"}) add_position(name);
    for (const char* name : {"u1", "v1", "u2", "v2"}) add_velocity(name);
    for (const char* name : {"N1", "N2"}) add(name, UnknownRole::internal, RowRole::constraint);
  }

  Eigen::VectorXd residual_at(double, const Eigen::VectorXd& z,
                              const Eigen::VectorXd& z_dot) const override {
    const Eigen::Vector2d a = z.segment<2>(0);
    const Eigen::Vector2d b = z.segment<2>(2) - a;
    const Eigen::Vector2d weight(0.0, gravity);
    Eigen::VectorXd r(10);
    r.head<4>() = z.segment<4>(4) - z_dot.head<4>();
    r.segment<2>(4) = z_dot.segment<2>(4) + weight + z(8) * a - z(9) * b;
    r.segment<2>(6) = z_dot.segment<2>(6) + weight + z(9) * b;
    r(8) = 0.5 * (a.squaredNorm() - 1.0);
    r(9) = 0.5 * (b.squaredNorm() - 1.0);
    return r;
  }

  void tangents_at(double, const Eigen::VectorXd& z, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    const Eigen::Matrix2d one = Eigen::Matrix2d::Identity();
    const Eigen::Vector2d a = z.segment<2>(0);
    const Eigen::Vector2d b = z.segment<2>(2) - a;
    K.block<4, 4>(0, 4).setIdentity();
    M.block<4, 4>(0, 0) = -Eigen::Matrix4d::Identity();
    M.block<4, 4>(4, 4).setIdentity();
    K.block<2, 2>(4, 0) = (z(8) + z(9)) * one;
    K.block<2, 2>(4, 2) = -z(9) * one;
    K.block<2, 2>(6, 0) = -z(9) * one;
    K.block<2, 2>(6, 2) = z(9) * one;
    K.block<2, 1>(4, 8) = a;
    K.block<2, 1>(4, 9) = -b;
    K.block<2, 1>(6, 9) = b;
    K.block<1, 2>(8, 0) = a.transpose();
    K.block<1, 2>(9, 0) = -b.transpose();
    K.block<1, 2>(9, 2) = b.transpose();
  }
};

/// An angle whose weight restores it: q'' = -stiffness sin(q).
class StiffPendulum final : public SmallSystem {
 public:
  explicit StiffPendulum(double stiffness) : stiffness_(stiffness) {
    add("q", UnknownRole::position, RowRole::kinematic, "rad");
    unknowns_.back().owner.kind = PartKind::joint;
    add_velocity("v");
  }

  Eigen::VectorXd residual_at(double, const Eigen::VectorXd& z,
                              const Eigen::VectorXd& z_dot) const override {
    return Eigen::Vector2d(z(1) - z_dot(0), z_dot(1) + stiffness_ * std::sin(z(0)));
  }

  void tangents_at(double, const Eigen::VectorXd& z, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    K(0, 1) = 1.0;
    M(0, 0) = -1.0;
    M(1, 1) = 1.0;
    K(1, 0) = stiffness_ * std::cos(z(0));
  }

 private:
  double stiffness_;
};

/// The largest size of the first unknown.
class Range final : public analysis::TransientObserver {
 public:
  bool sample(const TransientSample& sample) override {
    const petsc::ReadView view(sample.z);
    largest = std::max(largest, std::abs(view[0]));
    return true;
  }
  double largest = 0.0;
};

/// Keeps the states at which a run may go on.
class Keeper final : public analysis::TransientObserver {
 public:
  bool sample(const TransientSample&) override { return true; }
  void checkpoint(const analysis::TransientStart& state) override { states.push_back(state); }
  std::vector<analysis::TransientStart> states;
};

/// At rest with the rods at angles to the vertical [rad].
analysis::TransientStart hung(double first, double second) {
  analysis::TransientStart start;
  start.z = Eigen::VectorXd::Zero(10);
  start.z.segment<2>(0) = Eigen::Vector2d(std::sin(first), -std::cos(first));
  start.z.segment<2>(2) =
      start.z.segment<2>(0) + Eigen::Vector2d(std::sin(second), -std::cos(second));
  return start;
}

double energy_of(const Eigen::VectorXd& z) {
  return 0.5 * z.segment<4>(4).squaredNorm() + gravity * (z(1) + z(3));
}

/// The loads of the rods at z, from their own equations: rods keep their length.
Eigen::Vector2d loads_of(const Eigen::VectorXd& z) {
  const Eigen::Vector2d a = z.segment<2>(0);
  const Eigen::Vector2d b = z.segment<2>(2) - a;
  const Eigen::Vector2d weight(0.0, gravity);
  const Eigen::Vector2d rate = z.segment<2>(6) - z.segment<2>(4);
  // a . a_dotdot + |a_dot|^2 = 0 with a_dotdot = -weight - N1 a + N2 b; b_dotdot = N1 a - 2 N2 b.
  Eigen::Matrix2d A;
  A << -a.squaredNorm(), a.dot(b), a.dot(b), -2.0 * b.squaredNorm();
  const Eigen::Vector2d right(a.dot(weight) - z.segment<2>(4).squaredNorm(), -rate.squaredNorm());
  return A.inverse() * right;
}

class Watch final : public analysis::TransientObserver {
 public:
  bool sample(const TransientSample& sample) override {
    const petsc::ReadView view(sample.z);
    const Eigen::VectorXd z = Eigen::Map<const Eigen::VectorXd>(view.data(), 10);
    if (sample.step > 0) error = std::max(error, (loads_of(z) - z.tail<2>()).cwiseAbs().maxCoeff());
    return true;
  }
  double error = 0.0;
};

analysis::TransientOptions midpoint(double step, double duration) {
  analysis::TransientOptions options;
  options.method = TransientMethod::midpoint;
  options.step = step;
  options.duration = duration;
  options.tolerance = 1e-13;
  return options;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_step_that_is_too_long_does_not_turn_over) {
  // dt^2 times the stiffness is 5 to 500: the equations of a step have several solutions. A
  // pendulum that is let go below the top never reaches it, and the error of BDF2 takes energy.
  for (const double step : {0.03, 0.1, 0.3})
    for (const double angle : {1.0, 2.0, 2.9}) {
      const StiffPendulum system(5e3);
      analysis::TransientStart start;
      start.z = Eigen::Vector2d(angle, 0.0);
      analysis::TransientOptions options;
      options.step = step;
      options.duration = 100.0 * step;
      Range range;
      const analysis::TransientRun run = analysis::run_transient(system, start, options, range);
      BOOST_TEST((run.reason == analysis::TransientEnd::complete));
      BOOST_TEST_MESSAGE(step << " s from " << angle << " rad: " << range.largest << ", "
                              << run.cuts << " cuts");
      BOOST_TEST(range.largest < angle + 0.05);
    }
}

BOOST_AUTO_TEST_CASE(a_run_with_cut_steps_goes_on_from_a_checkpoint_bit_by_bit) {
  const StiffPendulum system(5e3);
  analysis::TransientStart start;
  start.z = Eigen::Vector2d(2.0, 0.0);
  for (const TransientMethod method : {TransientMethod::bdf2, TransientMethod::midpoint}) {
    analysis::TransientOptions options;
    options.method = method;
    options.step = 0.05;
    options.duration = 2.0;
    options.checkpoint_steps = 7;
    Keeper keeper;
    const analysis::TransientRun whole = analysis::run_transient(system, start, options, keeper);
    BOOST_TEST(whole.cuts > 0);
    BOOST_TEST_REQUIRE(keeper.states.size() == 5U);
    for (const analysis::TransientStart& state : keeper.states) {
      Keeper none;
      const analysis::TransientRun rest = analysis::run_transient(system, state, options, none);
      BOOST_TEST((rest.end.z == whole.end.z));
    }
  }
}

BOOST_AUTO_TEST_CASE(the_trapezoidal_rule_is_not_cut_in_smooth_motion) {
  // Its equations see twice the rate at times; an angle at a constant rate of 4 rad/s is no leap.
  const petsc::Session session({"-transient_ts_type", "cn"});
  const StiffPendulum system(0.01);
  analysis::TransientStart start;
  start.z = Eigen::Vector2d(0.0, 4.0);
  start.z_dot = Eigen::Vector2d(4.0, 0.0);
  analysis::TransientOptions options;
  options.step = 0.05;
  options.duration = 2.0;
  Keeper keeper;
  const analysis::TransientRun run = analysis::run_transient(system, start, options, keeper);
  petsc::check(PetscOptionsClearValue(nullptr, "-transient_ts_type"));
  BOOST_TEST(run.cuts == 0);
  BOOST_TEST(run.end.z(0) == 8.0, boost::test_tools::tolerance(0.01));
}

BOOST_AUTO_TEST_CASE(midpoint_rule_gives_reactions_of_second_order) {
  const DoublePendulum system;
  std::vector<double> errors;
  for (const double step : {0.01, 0.005, 0.0025}) {
    Watch watch;
    analysis::run_transient(system, hung(0.4, -0.3), midpoint(step, 20.0), watch);
    errors.push_back(watch.error);
  }
  BOOST_TEST_MESSAGE("errors " << errors[0] << " " << errors[1] << " " << errors[2]);
  for (std::size_t i = 1; i < errors.size(); ++i)
    BOOST_TEST(std::log2(errors[i - 1] / errors[i]) == 2.0, tolerance(0.1));
  BOOST_TEST(errors.back() < 1e-2);
}

BOOST_AUTO_TEST_CASE(midpoint_rule_ends_steps_with_consistent_positions_and_velocities) {
  const DoublePendulum system;
  Watch watch;
  const Eigen::VectorXd z =
      analysis::run_transient(system, hung(1.0, 2.0), midpoint(0.01, 7.0), watch).end.z;
  const Eigen::Vector2d a = z.segment<2>(0);
  const Eigen::Vector2d b = z.segment<2>(2) - a;
  BOOST_TEST(a.norm() == 1.0, tolerance(1e-10));
  BOOST_TEST(b.norm() == 1.0, tolerance(1e-10));
  BOOST_TEST(std::abs(a.dot(z.segment<2>(4))) < 1e-10);
  BOOST_TEST(std::abs(b.dot(z.segment<2>(6) - z.segment<2>(4))) < 1e-10);
}

BOOST_AUTO_TEST_CASE(midpoint_rule_keeps_the_energy_of_pendulums) {
  // Its first frequency is 2.4 rad/s: 1000 swings of 2.6 s with 260 steps each.
  const DoublePendulum system;
  const analysis::TransientStart start = hung(0.4, -0.3);
  const double lowest = -3.0 * gravity;
  const double size = energy_of(start.z) - lowest;
  Watch watch;
  const analysis::TransientRun run =
      analysis::run_transient(system, start, midpoint(0.01, 2600.0), watch);
  BOOST_TEST_MESSAGE("energy " << (energy_of(run.end.z) - energy_of(start.z)) / size);
  BOOST_TEST(std::abs(energy_of(run.end.z) - energy_of(start.z)) < 2e-3 * size);
}
