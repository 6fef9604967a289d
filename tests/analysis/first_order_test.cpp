// First-order states through the analyses: against roots of polynomials, an integral, and an
// integration of the explicit form.
#include <memory>

#include <boost/test/unit_test.hpp>
#include <unsupported/Eigen/MatrixFunctions>

#include "samara/analysis/consistent_subspace.hpp"
#include "samara/analysis/constant_modes.hpp"
#include "samara/analysis/floquet.hpp"
#include "samara/analysis/transient.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/base/error.hpp"

#include "first_order_systems.hpp"

using namespace samara;
using namespace samara::test;
using Complex = std::complex<double>;

namespace {

analysis::Floquet floquet_of(const system::PeriodicSystem& system, int steps,
                             analysis::FloquetPeriod period = analysis::FloquetPeriod::full) {
  analysis::Observer observer;
  return find_floquet_modes(system, rest(system), {steps, period, 2, {}}, PETSC_COMM_SELF,
                            observer);
}

std::vector<std::unique_ptr<FirstOrderSystem>> systems(double period) {
  std::vector<std::unique_ptr<FirstOrderSystem>> all;
  all.push_back(std::make_unique<LagInBalance>(period));
  all.push_back(std::make_unique<StateInKinematics>(period));
  all.push_back(std::make_unique<DrivenJoint>(period));
  all.push_back(std::make_unique<SpeedControl>(period));
  return all;
}

/// Every exponent has its mode, and there are no others; of a pair the one above the real axis.
void require_exponents(const analysis::ModeSet& set, const std::vector<Complex>& wanted,
                       double tolerance) {
  std::size_t count = 0;
  for (const Complex exponent : wanted) {
    if (exponent.imag() < -1e-9) continue;
    ++count;
    double nearest = 1.0;
    for (const analysis::Mode& mode : set.modes)
      nearest = std::min(nearest, std::abs(mode.exponent - exponent));
    BOOST_TEST(nearest < tolerance, "exponent " << exponent << " missed by " << nearest);
  }
  BOOST_TEST(set.modes.size() == count);
  BOOST_TEST(set.states == static_cast<int>(wanted.size()));
  BOOST_TEST(set.found == static_cast<int>(wanted.size()));
}

/// z(T) of z' = A(t) z from the unit states, by the classical Runge-Kutta method.
template <class System>
Eigen::MatrixXd monodromy_of(const System& system, int steps) {
  const Eigen::Index n = system.explicit_form(0.0).rows();
  Eigen::MatrixXd z = Eigen::MatrixXd::Identity(n, n);
  const double h = system.period() / steps;
  for (int k = 0; k < steps; ++k) {
    const double t = k * h;
    const Eigen::MatrixXd middle = system.explicit_form(t + 0.5 * h);
    const Eigen::MatrixXd a = system.explicit_form(t) * z;
    const Eigen::MatrixXd b = middle * (z + 0.5 * h * a);
    const Eigen::MatrixXd c = middle * (z + 0.5 * h * b);
    const Eigen::MatrixXd d = system.explicit_form(t + h) * (z + h * c);
    z += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
  return z;
}

}  // namespace

BOOST_AUTO_TEST_CASE(modes_have_the_roots_of_the_polynomial) {
  for (const auto& system : systems(0.0))
    require_exponents(find_constant_modes(*system, rest(*system)), system->exponents(), 1e-10);
}

BOOST_AUTO_TEST_CASE(floquet_has_them_behind_the_map_of_the_step) {
  for (const auto& system : systems(1.1))
    require_exponents(floquet_of(*system, 60).set, system->exponents(), 1e-9);
}

BOOST_AUTO_TEST_CASE(a_periodic_lag_alone_has_the_multiplier_of_its_mean) {
  const PeriodicLag system;
  std::vector<Complex> found;
  for (const int steps : {400, 800}) {
    const analysis::ModeSet set = floquet_of(system, steps).set;
    BOOST_TEST(set.degrees_of_freedom == 0);
    BOOST_REQUIRE(set.modes.size() == 1U);
    found.push_back(set.modes[0].exponent);
    BOOST_TEST(set.modes[0].label == "lag");
    const double error = std::abs(found.back() + 1.0);
    BOOST_TEST(error < 2.0 * set.modes[0].step_error);
    BOOST_TEST(error > 0.1 * set.modes[0].step_error);
  }
  BOOST_TEST(std::abs(found[1] + (found[1] - found[0]) / 3.0 + 1.0) < 1e-7);
}

BOOST_AUTO_TEST_CASE(a_state_drives_a_joint_through_a_constraint_that_changes_in_time) {
  const PeriodicJoint system;
  const Eigen::VectorXcd exact = monodromy_of(system, 4000).eigenvalues();
  const analysis::ModeSet coarse = floquet_of(system, 400).set;
  const analysis::ModeSet fine = floquet_of(system, 800).set;
  BOOST_TEST(fine.found == 4);
  const auto nearest = [](const analysis::ModeSet& set, Complex multiplier) {
    Complex best = 10.0;
    for (const analysis::Mode& mode : set.modes)
      for (const Complex one : {mode.multiplier, std::conj(mode.multiplier)})
        if (std::abs(one - multiplier) < std::abs(best - multiplier)) best = one;
    return best;
  };
  for (const Complex multiplier : exact) {
    const Complex a = nearest(coarse, multiplier);
    const Complex b = nearest(fine, multiplier);
    BOOST_TEST(std::abs(b + (b - a) / 3.0 - multiplier) < 1e-6, multiplier << " " << a << " " << b);
  }
}

BOOST_AUTO_TEST_CASE(states_of_blades_repeat_from_blade_to_blade) {
  for (const int blades : {2, 3, 4}) {
    const RotorWithLags system(blades);
    const Eigen::VectorXcd exact = monodromy_of(system, 4000).eigenvalues();
    const int steps = 240 * blades;
    const analysis::ModeSet full = floquet_of(system, steps).set;
    const analysis::ModeSet fast = floquet_of(system, steps, analysis::FloquetPeriod::blade).set;
    BOOST_TEST(full.found == 3 * blades + 1);
    BOOST_TEST(fast.found == 3 * blades + 1);
    for (const Complex multiplier : exact)
      for (const analysis::ModeSet* set : {&full, &fast}) {
        double nearest = 1.0;
        for (const analysis::Mode& mode : set->modes)
          for (const Complex one : {mode.multiplier, std::conj(mode.multiplier)})
            nearest = std::min(nearest, std::abs(one - multiplier));
        BOOST_TEST(nearest < 2e-4,
                   blades << " blades, multiplier " << multiplier << " missed by " << nearest);
      }
    for (const analysis::Mode& mode : full.modes) {
      double nearest = 1.0;
      for (const analysis::Mode& other : fast.modes)
        nearest = std::min(nearest, std::abs(other.multiplier - mode.multiplier));
      for (const analysis::Mode& other : fast.modes)
        nearest = std::min(nearest, std::abs(std::conj(other.multiplier) - mode.multiplier));
      BOOST_TEST(nearest < 1e-10);
    }
  }
}

namespace {

/// A system of one mass and one first-order equation, with a flaw.
class Flawed final : public SmallSystem {
 public:
  enum class Flaw {
    as_velocity,           ///< the state is declared as a velocity
    other_row,             ///< the state's row is a balance
    rate_in_definition,    ///< a definition row with a rate
    auxiliary_constrains,  ///< an auxiliary in a constraint row
    velocity_drives,       ///< a state in a constraint row, driven by a velocity
    load_in_kinematics,    ///< an internal load in a kinematic row
  };

  explicit Flawed(Flaw flaw) : flaw_(flaw) {
    add("p", UnknownRole::position, RowRole::constraint);
    add("v", UnknownRole::velocity, RowRole::kinematic);
    add("R", UnknownRole::internal, RowRole::balance);
    if (flaw == Flaw::as_velocity)
      add("x", UnknownRole::velocity, RowRole::balance);
    else if (flaw == Flaw::other_row)
      add("x", UnknownRole::state, RowRole::balance);
    else
      add_state("lag", "x");
    if (flaw == Flaw::other_row) unknowns_.back().owner.part = "lag";
    add_auxiliary("a");
  }
  void tangents_at(double, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    K(0, 0) = 1.0;
    if (flaw_ == Flaw::auxiliary_constrains) K(0, 4) = 1.0;
    if (flaw_ == Flaw::velocity_drives) K(0, 3) = 1.0;
    M(1, 0) = -1.0;
    K(1, 1) = 1.0;
    if (flaw_ == Flaw::load_in_kinematics) K(1, 2) = 0.1;
    M(2, 1) = 1.0;
    K(2, 2) = 1.0;
    M(3, 3) = 1.0;
    K(3, 3) = 0.5;
    if (flaw_ == Flaw::velocity_drives) K(3, 1) = 0.2;
    K(4, 4) = 1.0;
    if (flaw_ == Flaw::rate_in_definition) M(4, 3) = 0.3;
  }

 private:
  Flaw flaw_;
};

}  // namespace

BOOST_AUTO_TEST_CASE(roles_that_do_not_fit_are_refused_by_name) {
  using Flaw = Flawed::Flaw;
  const std::vector<std::pair<Flaw, std::vector<std::string>>> cases{
      {Flaw::as_velocity, {"1 kinematic rows for 2 velocities", "state"}},
      {Flaw::other_row, {"state \"lag x\"", "balance row"}},
      {Flaw::rate_in_definition, {"definition row of \"a\"", "rate of \"lag x\""}},
      {Flaw::auxiliary_constrains, {"constraint row of \"p\"", "auxiliary \"a\""}},
      {Flaw::velocity_drives, {"constraint row of \"p\"", "state \"lag x\"", "velocity \"v\""}},
      {Flaw::load_in_kinematics, {"kinematic row of \"v\"", "internal \"R\""}}};
  for (const auto& [flaw, words] : cases) {
    const Flawed system(flaw);
    std::string said;
    try {
      find_constant_modes(system, rest(system));
    } catch (const InternalError& error) {
      said = error.what();
    }
    for (const std::string& word : words)
      BOOST_TEST(said.find(word) != std::string::npos, said << ": without " << word);
  }
}

BOOST_AUTO_TEST_CASE(modes_of_states_have_their_owners_names) {
  const LagInBalance system(0.0);
  const analysis::ModeSet set = find_constant_modes(system, rest(system));
  BOOST_REQUIRE(set.modes.size() == 2U);
  for (const analysis::Mode& mode : set.modes)
    BOOST_TEST((mode.label == "lag") == (mode.exponent.imag() == 0.0), mode.label);
  // Where the actuator is slow and the spring stiff, the pair near the actuator's roots is its own.
  const DrivenJoint joint(0.0);
  int owned = 0;
  for (const analysis::Mode& mode : find_constant_modes(joint, rest(joint)).modes)
    if (mode.label == "actuator") ++owned;
  BOOST_TEST(owned == 1);
}

namespace {

/// Keeps nothing.
class Silent final : public analysis::TransientObserver {
 public:
  bool sample(const analysis::TransientSample&) override { return true; }
};

}  // namespace

BOOST_AUTO_TEST_CASE(transients_follow_the_exponential_of_the_explicit_form) {
  constexpr double duration = 2.0;
  for (const auto& system : systems(0.0)) {
    const analysis::PeriodicSolution solution = rest(*system);
    const analysis::ConsistentSubspace subspace(*system, solution);
    Eigen::VectorXd reduced(subspace.size());
    for (Eigen::Index i = 0; i < reduced.size(); ++i)
      reduced(i) = 0.2 + 0.1 * static_cast<double>(i);
    const petsc::Handle<Vec> z = system->make_state();
    subspace.find_state(0.0, reduced, z.get());
    const Eigen::VectorXd start = system->values_of(z.get());
    const std::vector<int> unknowns = system->explicit_unknowns();
    const Eigen::MatrixXd change = system->explicit_form() * duration;
    const Eigen::VectorXd exact = change.exp() * Eigen::VectorXd(start(unknowns));
    for (const auto method :
         {analysis::TransientMethod::bdf2, analysis::TransientMethod::midpoint}) {
      std::vector<double> errors;
      for (const double step : {0.01, 0.005}) {
        analysis::TransientOptions options;
        options.method = method;
        options.step = step;
        options.duration = duration;
        options.tolerance = 1e-12;
        analysis::TransientStart begin;
        begin.z = start;
        Silent observer;
        const Eigen::VectorXd end = run_transient(*system, begin, options, observer).end.z;
        errors.push_back((end(unknowns) - exact).norm());
      }
      BOOST_TEST(errors[1] < 1e-3 * exact.norm());
      BOOST_TEST(std::log2(errors[0] / errors[1]) == 2.0, boost::test_tools::tolerance(0.1));
    }
  }
}

BOOST_AUTO_TEST_CASE(trims_have_the_amplitudes_of_the_linear_solution) {
  const std::vector<PetscInt> forced{1, 1, 3, 1};
  const auto all = systems(1.3);
  for (std::size_t i = 0; i < all.size(); ++i) {
    FirstOrderSystem& system = *all[i];
    system.force(forced[i], 0.7);
    const Eigen::VectorXcd amplitudes = system.forced_amplitudes();
    for (const auto method :
         {analysis::TrimMethod::harmonic_balance, analysis::TrimMethod::shooting}) {
      analysis::TrimOptions options;
      options.method = method;
      options.steps = 400;
      analysis::Observer observer;
      const analysis::Trim trim = find_trim(system, options, observer);
      const petsc::Handle<Vec> z = system.make_state();
      const petsc::Handle<Vec> z_dot = system.make_state();
      double difference = 0.0;
      for (const double t : {0.0, 0.31, 0.77}) {
        trim.solution.evaluate(t, z.get(), z_dot.get());
        const Eigen::VectorXd exact =
            (amplitudes * std::polar(1.0, 2.0 * pi * t / system.period())).real();
        difference =
            std::max(difference, (system.values_of(z.get()) - exact).cwiseAbs().maxCoeff());
      }
      const bool is_series = method == analysis::TrimMethod::harmonic_balance;
      BOOST_TEST(difference < (is_series ? 1e-9 : 1e-3) * amplitudes.norm(),
                 "system " << i << ": " << difference / amplitudes.norm());
      if (is_series) BOOST_TEST(trim.state_residual < 1e-9);
      for (const analysis::HeldCoordinate& held : trim.held) BOOST_TEST(std::abs(held.load) < 1e-9);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_filter_that_rests_is_balanced_and_has_a_shape_of_its_own) {
  const RateFilter system(1.3);
  for (const bool automatic : {false, true}) {
    analysis::TrimOptions options;
    options.automatic = automatic;
    options.least_harmonics = 1;  // a constant is not tried
    analysis::Observer observer;
    const analysis::Trim trim = find_trim(system, options, observer);
    BOOST_TEST(trim.solution.coefficients()(0, 0) == 3.7 / 5.0,
               boost::test_tools::tolerance(1e-12));
    BOOST_TEST(trim.state_residual < 1e-9);
  }
  for (const analysis::ModeSet& set :
       {find_constant_modes(system, rest(system)), floquet_of(system, 60).set}) {
    require_exponents(set, system.exponents(), 1e-9);
    for (std::size_t m = 0; m < set.modes.size(); ++m) {
      if (set.modes[m].label != "filter") continue;
      BOOST_TEST(set.shapes[m].row(2).cwiseAbs().maxCoeff() == 0.1,
                 boost::test_tools::tolerance(1e-12));
      BOOST_TEST(set.modes[m].kinetic_energy < 1e-12);
    }
  }
}
