// Floquet's analysis on several ranks: every rank also does the whole work alone and compares.
#include <cmath>
#include <exception>
#include <string>

#include <boost/test/unit_test.hpp>

#include "samara/analysis/floquet.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/turbine/turbine_system.hpp"

#include "first_order_systems.hpp"
#include "turbines.hpp"

using namespace samara;
using namespace samara::test;

namespace {

struct Runs {
  analysis::Floquet alone, together;
};

Runs run(const model::TurbineDefinition& definition, const analysis::FloquetOptions& options) {
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::Trim trim = analysis::find_trim(system, {}, observer);
  return {find_floquet_modes(system, trim.solution, options, PETSC_COMM_SELF, observer),
          find_floquet_modes(system, trim.solution, options, PETSC_COMM_WORLD, observer)};
}

/// An exponent of the free yaw, where mu = 1 is defective: round-off moves it by its root.
bool is_defective(const analysis::Mode& mode, double speed) {
  return std::abs(mode.exponent) < 1e-4 * speed;
}

constexpr double regular = 1e-9;    // relative; round-off of other sums
constexpr double defective = 1e-4;  // in the multiplier: the root of round-off and much to spare

void require_same(const Runs& runs) {
  const analysis::ModeSet& a = runs.alone.set;
  const analysis::ModeSet& b = runs.together.set;
  BOOST_REQUIRE(a.modes.size() == b.modes.size());
  std::size_t defective_count = 0;
  for (std::size_t m = 0; m < a.modes.size(); ++m) {
    const analysis::Mode& x = a.modes[m];
    if (is_defective(x, a.rotor_speed)) {
      ++defective_count;
      BOOST_TEST(std::abs(b.modes[m].multiplier - 1.0) < defective);
      continue;
    }
    // Equal exponents may change places: take the nearest.
    double nearest = 1e300;
    for (const analysis::Mode& y : b.modes)
      nearest = std::min(nearest, std::abs(x.exponent - y.exponent));
    if (x.resolved) BOOST_TEST(nearest < regular * std::abs(x.exponent), x.label);
    BOOST_TEST(b.modes[m].label == x.label);
    BOOST_TEST(b.modes[m].harmonic == x.harmonic, x.label);
    BOOST_TEST(b.modes[m].resolved == x.resolved, x.label);
    if (!x.resolved) continue;
    BOOST_REQUIRE(b.modes[m].parts.size() == x.parts.size());
    for (std::size_t p = 0; p < x.parts.size(); ++p)
      BOOST_TEST(std::abs(b.modes[m].parts[p].share - x.parts[p].share) < 1e-7);
    const auto row = static_cast<Eigen::Index>(m);
    BOOST_TEST((a.participation.row(row) - b.participation.row(row)).cwiseAbs().maxCoeff() < 1e-7);
  }
  BOOST_TEST(defective_count <= 2U);
}

}  // namespace

BOOST_AUTO_TEST_CASE(ranks_do_not_change_the_modes_of_a_coupled_turbine) {
  require_same(run(lee_turbine({3, 1, 3, 1}), {200, analysis::FloquetPeriod::automatic}));
}

BOOST_AUTO_TEST_CASE(ranks_do_not_change_the_modes_under_gravity_over_the_full_period) {
  require_same(run(lee_turbine({2, 1, 2, 2}, 9.80665), {201, analysis::FloquetPeriod::full}));
}

BOOST_AUTO_TEST_CASE(ranks_do_not_change_the_modes_of_first_order_states) {
  const RotorWithLags system(3);
  const analysis::PeriodicSolution rest(Eigen::MatrixXd::Zero(system.size(), 1), system.period());
  for (const auto period : {analysis::FloquetPeriod::full, analysis::FloquetPeriod::blade}) {
    analysis::Observer observer;
    const analysis::FloquetOptions options{240, period, 2, {}};
    require_same({find_floquet_modes(system, rest, options, PETSC_COMM_SELF, observer),
                  find_floquet_modes(system, rest, options, PETSC_COMM_WORLD, observer)});
  }
}

BOOST_AUTO_TEST_CASE(mode_shapes_are_on_the_first_rank) {
  const Runs runs = run(lee_turbine({1, 1, 1, 1}), {100, analysis::FloquetPeriod::automatic});
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank != 0) {
    BOOST_TEST(runs.together.set.shapes.empty());
    return;
  }
  BOOST_REQUIRE(runs.together.set.shapes.size() == runs.alone.set.shapes.size());
  for (std::size_t m = 0; m < runs.alone.set.shapes.size(); ++m) {
    const Eigen::MatrixXcd& x = runs.alone.set.shapes[m];
    const Eigen::MatrixXcd& y = runs.together.set.shapes[m];
    if (is_defective(runs.alone.set.modes[m], runs.alone.set.rotor_speed)) continue;
    if (!runs.alone.set.modes[m].resolved) continue;
    // A shape is known up to a complex factor.
    const std::complex<double> factor = (x.conjugate().cwiseProduct(y)).sum() / x.squaredNorm();
    BOOST_TEST((y - factor * x).norm() < 1e-7 * y.norm(), runs.alone.set.modes[m].label);
    BOOST_TEST(std::abs(factor) == 1.0, boost::test_tools::tolerance(1e-6));
  }
}

BOOST_AUTO_TEST_CASE(ranks_without_a_step_of_their_own_change_nothing) {
  // One step and the closing one are dealt to up to three ranks.
  const Mathieu system(2.5, 0.1);
  const analysis::PeriodicSolution rest(Eigen::MatrixXd::Zero(system.size(), 1), system.period());
  analysis::Observer observer;
  for (const int steps : {1, 2}) {
    const analysis::FloquetOptions options{steps, analysis::FloquetPeriod::full, 6, {}};
    require_same({find_floquet_modes(system, rest, options, PETSC_COMM_SELF, observer),
                  find_floquet_modes(system, rest, options, PETSC_COMM_WORLD, observer)});
  }
}

namespace {

/// An oscillator whose equations end within the period.
class Ending final : public SmallSystem {
 public:
  Ending() {
    period_ = 2.0 * pi;
    add_position("x");
    add_velocity("v");
    add_kinetic("mass", 1, 1.0);
  }
  void tangents_at(double t, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    if (t > 0.9 * period_) throw DomainError("the equations end here");
    K << 0.0, 1.0, 1.7, 0.1;
    M << -1.0, 0.0, 0.0, 1.0;
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(a_failure_on_one_rank_ends_all_of_them) {
  const Ending system;
  const analysis::PeriodicSolution rest(Eigen::MatrixXd::Zero(system.size(), 1), system.period());
  analysis::Observer observer;
  BOOST_CHECK_EXCEPTION(find_floquet_modes(system, rest, {30, analysis::FloquetPeriod::full, 6, {}},
                                           PETSC_COMM_WORLD, observer),
                        std::exception, [](const std::exception& error) {
                          return std::string(error.what()).find("the equations end here") !=
                                 std::string::npos;
                        });
}
