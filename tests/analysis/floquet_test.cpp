// Floquet's analysis of systems whose multipliers are known without the program.
#include "samara/analysis/floquet.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include <boost/test/unit_test.hpp>

#include "samara/analysis/constant_modes.hpp"
#include "samara/base/error.hpp"

#include "../verification/record.hpp"
#include "small_systems.hpp"

using namespace samara;
using namespace samara::test;
using Complex = std::complex<double>;

namespace {

/// The analysis about z = 0.
analysis::Floquet floquet_at_rest(const system::PeriodicSystem& system, int steps,
                                  analysis::FloquetPeriod period = analysis::FloquetPeriod::full) {
  const analysis::PeriodicSolution rest(Eigen::MatrixXd::Zero(system.size(), 1), system.period());
  analysis::Observer observer;
  return find_floquet_modes(system, rest, {steps, period, 2, {}}, PETSC_COMM_SELF, observer);
}

/// The computed multiplier that is nearest to `wanted` or to its conjugate.
Complex nearest(const analysis::Floquet& floquet, Complex wanted) {
  Complex best = std::numeric_limits<double>::infinity();
  for (const analysis::Mode& mode : floquet.set.modes)
    for (const Complex found : {mode.multiplier, std::conj(mode.multiplier)})
      if (std::abs(found - wanted) < std::abs(best - wanted)) best = found;
  return best;
}

/// Richardson's limit of figures at n and 2 n steps.
template <class T>
T extrapolate(T coarse, T fine) {
  return fine + (fine - coarse) / 3.0;
}

/// Errors at n, 2 n, 4 n steps must fall by 2^order each time; Richardson's limit must agree.
void require_order_two(const std::vector<Complex>& found, Complex exact, double slack,
                       double tolerance) {
  for (std::size_t i = 0; i + 1 < found.size(); ++i) {
    const double slope = std::log2(std::abs(found[i] - exact) / std::abs(found[i + 1] - exact));
    BOOST_TEST(slope == 2.0, boost::test_tools::tolerance(slack));
  }
  const Complex limit = extrapolate(found[found.size() - 2], found.back());
  BOOST_TEST(std::abs(limit - exact) < tolerance * std::abs(exact),
             "limit " << limit << " exact " << exact);
}

/// Tolerance of slopes at the steps below, where the next term of the error is some 1e-3 of the
/// first.
constexpr double slope_slack = 0.01;

}  // namespace

BOOST_AUTO_TEST_CASE(mathieu_has_published_multipliers_with_slope_two) {
  // Known multipliers, all digits as printed; the two of a real pair, or one of a complex pair.
  // Their product is 1 (no damping), which the print obeys to its last digit.
  struct Case {
    double a, q;
    std::vector<Complex> multipliers;
  };
  const std::vector<Case> cases{{1.0, 1.0, {-0.2406128, -4.15605494}},
                                {2.5, 1.0, {Complex(-0.04837615, 0.99882919)}},
                                {4.0, 1.0, {0.86427423, 1.15704017}}};
  constexpr double print = 3e-7;  // relative; half a unit of the seventh digit of -0.2406128
  constexpr double extrapolated = 1e-7;
  const Figures published{"P1", "known multipliers, as printed", "400 and 800 steps, extrapolated"};
  const Figures own{"P1", "Runge-Kutta, 4000 steps", published.mesh};
  const Convergence page{"P1", "multipliers, relative, q = 1", "steps"};
  for (const Case& c : cases) {
    const Mathieu system(c.a, c.q);
    const Eigen::VectorXcd reference = reference_multipliers(
        [&system](double t) { return system.explicit_form(t); }, system.period(), 4000);
    for (std::size_t k = 0; k < c.multipliers.size(); ++k) {
      const Complex printed = c.multipliers[k];
      Complex exact = std::numeric_limits<double>::infinity();
      for (const Complex value : reference)
        if (std::abs(value - printed) < std::abs(exact - printed)) exact = value;
      BOOST_TEST(std::abs(exact - printed) < print * std::abs(printed));
      std::vector<Complex> found;
      std::vector<std::pair<double, double>> errors;
      for (const int steps : {200, 400, 800}) {
        found.push_back(nearest(floquet_at_rest(system, steps), exact));
        errors.emplace_back(steps, std::abs(found.back() / exact - 1.0));
      }
      const std::string what = "mu" + std::to_string(k + 1) + ", a = " + in_short(c.a);
      page.check(what, -2.0, 2.0 * slope_slack, errors);
      const Complex limit = extrapolate(found[1], found[2]);
      BOOST_TEST(std::abs(limit - exact) < extrapolated * std::abs(exact));
      for (const auto& [figures, wanted, tolerance] :
           {std::tuple(&published, printed, print), std::tuple(&own, exact, extrapolated)}) {
        const double size = tolerance * std::abs(printed);
        const bool real = printed.imag() == 0.0;
        figures->check_absolute((real ? "" : "Re ") + what, limit.real(), wanted.real(), size);
        if (!real) figures->check_absolute("Im " + what, limit.imag(), wanted.imag(), size);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(mathieu_changes_stability_at_its_characteristic_values) {
  // There the multipliers meet at 1 (period pi) or -1 (2 pi), and their sum is 2 or -2.
  struct Boundary {
    const char* name;
    double a, sum;
  };
  const Figures page{"P1", "characteristic values of Mathieu's equation",
                     "200 and 400 steps, extrapolated"};
  for (const Boundary& boundary :
       {Boundary{"a0", -0.455138604, 2.0}, Boundary{"b1", -0.110248817, -2.0},
        Boundary{"a1", 1.859108073, -2.0}, Boundary{"b2", 3.917024773, 2.0},
        Boundary{"a2", 4.371300983, 2.0}}) {
    const auto find = [&](int steps) {
      const auto excess = [&](double a) {
        Complex sum = 0.0;
        const analysis::Floquet floquet = floquet_at_rest(Mathieu(a, 1.0), steps);
        for (const analysis::Mode& mode : floquet.set.modes)
          sum += mode.multiplier.imag() == 0.0 ? mode.multiplier : 2.0 * mode.multiplier.real();
        return sum.real() - boundary.sum;
      };
      double before = boundary.a - 1e-2;
      double a = boundary.a + 1e-2;
      double excess_before = excess(before);
      for (int i = 0; i < 20 && std::abs(a - before) > 1e-10; ++i) {
        const double excess_now = excess(a);
        const double next = a - excess_now * (a - before) / (excess_now - excess_before);
        before = a;
        excess_before = excess_now;
        a = next;
      }
      return a;
    };
    page.check_absolute(std::string(boundary.name) + ", q = 1", extrapolate(find(200), find(400)),
                        boundary.a, 1e-7);
  }
}

BOOST_AUTO_TEST_CASE(multipliers_of_a_hamiltonian_system_have_product_one) {
  // (19) is symplectic for x'' + k(t) x = 0: the product is 1 to round-off at any step.
  for (const int steps : {7, 20, 101}) {
    const analysis::Floquet floquet = floquet_at_rest(Mathieu(1.0, 1.0), steps);
    BOOST_REQUIRE(floquet.set.modes.size() == 2U);
    const Complex product = floquet.set.modes[0].multiplier * floquet.set.modes[1].multiplier;
    BOOST_TEST(std::abs(product - 1.0) < 1e-11);
  }
}

BOOST_AUTO_TEST_CASE(growth_on_a_tongue_is_at_half_the_frequency_of_the_coefficients) {
  // Principal resonance: negative real multipliers, frequency Omega / 2 = 1 rad/s, growth
  // ln(4.15605494) / pi.
  const analysis::Floquet floquet = floquet_at_rest(Mathieu(1.0, 1.0), 800);
  BOOST_REQUIRE(floquet.set.modes.size() == 2U);
  double growth = -1.0;
  for (const analysis::Mode& mode : floquet.set.modes) {
    BOOST_TEST(mode.step_exponent.imag() == 1.0, boost::test_tools::tolerance(1e-9));
    // The step maps back as if coefficients were constant, within the estimate.
    BOOST_TEST(std::abs(mode.exponent.imag() - 1.0) < 3.0 * mode.step_error);
    growth = std::max(growth, mode.exponent.real());
  }
  // The step of 1/800 period leaves 1e-5.
  BOOST_TEST(growth == std::log(4.15605494) / pi, boost::test_tools::tolerance(1e-4));
}

BOOST_AUTO_TEST_CASE(rigid_constraint_that_changes_with_time_leaves_one_degree_of_freedom) {
  const ChangingGear system;
  const Eigen::VectorXcd reference =
      reference_multipliers(ChangingGear::explicit_form, system.period(), 8000);
  BOOST_TEST(std::abs(reference(0) * reference(1) - 1.0) < 1e-9);  // Liouville, by c's period
  for (const int steps : {400, 401}) {
    const analysis::Floquet floquet = floquet_at_rest(system, steps);
    BOOST_TEST(floquet.set.degrees_of_freedom == 1);
    BOOST_TEST(floquet.set.modes.size() == (reference(0).imag() == 0.0 ? 2U : 1U));
  }
  std::vector<Complex> found;
  for (const int steps : {400, 800, 1600})
    found.push_back(nearest(floquet_at_rest(system, steps), reference(0)));
  require_order_two(found, reference(0), slope_slack, 1e-6);
}

BOOST_AUTO_TEST_CASE(rigid_constraints_hold_at_every_instant_of_a_mode_shape) {
  const ChangingGear system;
  const analysis::Floquet floquet = floquet_at_rest(system, 720);
  for (std::size_t m = 0; m < floquet.set.modes.size(); ++m) {
    const Eigen::MatrixXcd& shape = floquet.set.shapes[m];
    for (std::size_t k = 0; k < floquet.set.shape_times.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      const double c = ChangingGear::c(floquet.set.shape_times[k]);
      // Values at the middle of a step are means of its ends: O(dt^2), here (Omega dt)^2 = 8e-5.
      BOOST_TEST(std::abs(shape(1, at) - c * shape(0, at)) < 1e-3);
    }
  }
}

BOOST_AUTO_TEST_CASE(constant_coefficients_give_the_map_of_the_exponents) {
  // In axes that turn, where the coefficients are constant: exponents -c/2 +- i (w -+ speed).
  constexpr double frequency = 5.3;
  constexpr double damping = 0.2;
  constexpr double speed = 2.0;
  const TurningMass system(frequency, damping, speed);
  const double whirl = std::sqrt(frequency * frequency - 0.25 * damping * damping);
  for (const int steps : {50, 101, 500}) {
    const analysis::Floquet floquet = floquet_at_rest(system, steps);
    BOOST_REQUIRE(floquet.set.modes.size() == 2U);
    const double dt = system.period() / steps;
    std::size_t at = 0;
    for (const double seen : {whirl - speed, whirl + speed}) {
      const Complex exponent(-0.5 * damping, seen);
      const Complex step = (1.0 + 0.5 * dt * exponent) / (1.0 - 0.5 * dt * exponent);
      const Complex multiplier = std::pow(step, steps);
      const analysis::Mode& mode = floquet.set.modes[at++];
      BOOST_TEST(std::abs(mode.multiplier - multiplier) < 1e-11);
      // Not folded by a multiple of the speed, and without the warping of the step.
      BOOST_TEST(std::abs(mode.step_exponent - std::log(step) / dt) < 1e-10);
      BOOST_TEST(std::abs(mode.exponent - exponent) < 1e-10 * std::abs(exponent));
      BOOST_TEST(mode.damping_ratio == -mode.exponent.real() / std::abs(mode.exponent),
                 boost::test_tools::tolerance(1e-12));
    }
  }
}

BOOST_AUTO_TEST_CASE(modes_are_resolved_up_to_a_half_phase_of_seven_tenths) {
  // w dt / 2 = 0.69 and 0.71 at the same step.
  for (const auto& [half_phase, resolved] : {std::pair{0.69, true}, std::pair{0.71, false}}) {
    constexpr int steps = 60;
    const double speed = 1.0;
    const double frequency = 2.0 * half_phase * steps / (2.0 * pi) - speed;
    const TurningMass system(frequency, 0.0, speed);
    const analysis::Floquet floquet = floquet_at_rest(system, steps);
    BOOST_REQUIRE(floquet.set.modes.size() == 2U);
    BOOST_TEST(floquet.set.modes[1].resolved == resolved);
  }
}

BOOST_AUTO_TEST_CASE(ground_resonance_over_a_blade_period_is_that_over_the_full_period) {
  // Three and five blades tell the direction in which P renames blades; two do not.
  for (const int blades : {2, 3, 4, 5}) {
    const GroundResonance system(blades);
    constexpr int steps = 240;
    const analysis::Floquet full = floquet_at_rest(system, steps, analysis::FloquetPeriod::full);
    const analysis::Floquet fast = floquet_at_rest(system, steps, analysis::FloquetPeriod::blade);
    BOOST_TEST(full.sectors == 1);
    BOOST_TEST(fast.sectors == blades);
    for (const analysis::Mode& mode : full.set.modes)
      BOOST_TEST(std::abs(nearest(fast, mode.multiplier) - mode.multiplier) < 1e-11,
                 blades << " blades " << mode.multiplier);
  }
}

BOOST_AUTO_TEST_CASE(ground_resonance_converges_to_a_runge_kutta_monodromy) {
  const GroundResonance system(3);
  const Eigen::VectorXcd reference = reference_multipliers(
      [&system](double t) { return system.explicit_form(t); }, system.period(), 3000);
  std::vector<analysis::Floquet> runs;
  for (const int steps : {300, 600, 1200})
    runs.push_back(floquet_at_rest(system, steps, analysis::FloquetPeriod::automatic));
  BOOST_TEST(runs[0].sectors == 3);
  for (const Complex exact : reference) {
    std::vector<Complex> found;
    for (const analysis::Floquet& run : runs) found.push_back(nearest(run, exact));
    require_order_two(found, exact, 0.05, 1e-6);
  }
}

BOOST_AUTO_TEST_CASE(exponents_agree_between_blade_and_full_period) {
  // The identified frequency does not depend on how much of the period was integrated.
  for (const int blades : {2, 3}) {
    const GroundResonance system(blades);
    const analysis::Floquet full = floquet_at_rest(system, 240);
    const analysis::Floquet fast = floquet_at_rest(system, 240, analysis::FloquetPeriod::blade);
    BOOST_REQUIRE(full.set.modes.size() == fast.set.modes.size());
    for (std::size_t m = 0; m < full.set.modes.size(); ++m) {
      BOOST_TEST(std::abs(full.set.modes[m].exponent - fast.set.modes[m].exponent) < 1e-9);
      // Harmonics count from the principal exponent, which is that of the integrated part: those
      // beside the identified one are the same.
      const auto row = static_cast<Eigen::Index>(m);
      for (int beside = -20; beside <= 20; ++beside) {
        const int a = full.set.modes[m].harmonic + beside - full.set.first_harmonic;
        const int b = fast.set.modes[m].harmonic + beside - fast.set.first_harmonic;
        BOOST_TEST(std::abs(full.set.participation(row, a) - fast.set.participation(row, b)) <
                   1e-9);
      }
      BOOST_TEST(full.set.participation.row(row).sum() == 1.0, boost::test_tools::tolerance(1e-12));
      BOOST_TEST(fast.set.participation.row(row).sum() == 1.0, boost::test_tools::tolerance(1e-12));
    }
  }
}

BOOST_AUTO_TEST_CASE(mode_shapes_are_solutions_of_the_equations) {
  // Z(t) exp(lambda t) solves z' = A z: Runge-Kutta takes each instant of a shape to the next one.
  const GroundResonance system(3);
  const auto form = [&system](double t) { return system.explicit_form(t); };
  for (const analysis::FloquetPeriod period :
       {analysis::FloquetPeriod::full, analysis::FloquetPeriod::blade}) {
    const analysis::Floquet floquet = floquet_at_rest(system, 1080, period);
    const std::vector<double>& times = floquet.set.shape_times;
    for (std::size_t m = 0; m < floquet.set.modes.size(); ++m) {
      const analysis::Mode& mode = floquet.set.modes[m];
      const Eigen::MatrixXcd& shape = floquet.set.shapes[m];
      BOOST_REQUIRE(static_cast<std::size_t>(shape.cols()) == times.size());
      double worst = 0.0;
      for (std::size_t k = 0; k + 1 < times.size(); ++k) {
        const double span = times[k + 1] - times[k];
        const Eigen::MatrixXd transition = runge_kutta<Eigen::MatrixXd>(
            [&form](double t, const Eigen::MatrixXd& y) { return Eigen::MatrixXd(form(t) * y); },
            Eigen::MatrixXd::Identity(system.size(), system.size()), times[k], span, 20);
        // The shape belongs to lambda without the whole turns that identification adds: any k.
        const Eigen::VectorXcd moved = transition * shape.col(static_cast<Eigen::Index>(k));
        const Complex principal =
            mode.exponent - Complex(0.0, mode.harmonic * GroundResonance::speed);
        const Eigen::VectorXcd next =
            shape.col(static_cast<Eigen::Index>(k + 1)) * std::exp(principal * span);
        worst = std::max(worst, (moved - next).norm() / next.norm());
      }
      // At the middle of a step the mean of its ends is taken: (Omega dt)^2 = 3e-5.
      BOOST_TEST(worst < 1e-4, "mode " << mode.exponent << " k " << mode.harmonic);
    }
  }
}

BOOST_AUTO_TEST_CASE(wrong_requests_are_refused) {
  BOOST_CHECK_THROW(floquet_at_rest(Mathieu(1.0, 1.0), 100, analysis::FloquetPeriod::blade),
                    InputError);
}

BOOST_AUTO_TEST_CASE(steps_are_rounded_up_to_a_multiple_of_the_blades_and_said) {
  struct Listener final : analysis::Observer {
    void note(const std::string& text) override { said += text; }
    std::string said;
  };
  const GroundResonance system(3);
  const analysis::PeriodicSolution rest(Eigen::MatrixXd::Zero(system.size(), 1), system.period());
  Listener listener;
  const analysis::Floquet floquet = find_floquet_modes(
      system, rest, {100, analysis::FloquetPeriod::automatic, 2, {}}, PETSC_COMM_SELF, listener);
  BOOST_TEST(floquet.steps == 102);
  BOOST_TEST(listener.said.find("102") != std::string::npos);
}
