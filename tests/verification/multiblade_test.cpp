// Floquet exponents of an isotropic three-bladed turbine are the eigenvalues of the constant system
// in multiblade coordinates. The two share the tangents K and M and nothing else.
#include "multiblade.hpp"

#include <boost/test/unit_test.hpp>

using namespace samara;
using namespace samara::test;

namespace {

/// The NREL 5 MW turbine without gravity and tilt: coned and twisted blades, flexible tower and
/// drivetrain, all damped.
model::TurbineDefinition isotropic_nrel5mw() {
  return structure("nrel5mw/land", {"gravity=0", "shaft.tilt_deg=0", "blades.elements=2",
                                    "blades.order=2", "tower.elements=2", "tower.order=2"})
      .turbine;
}

/// Largest difference of two matrices, each row relative to its largest entry.
double difference(const Eigen::SparseMatrix<double>& a, const Eigen::SparseMatrix<double>& b) {
  const Eigen::MatrixXd full(a);
  const Eigen::VectorXd sizes = full.cwiseAbs().rowwise().maxCoeff().cwiseMax(1e-300);
  return (sizes.cwiseInverse().asDiagonal() * (Eigen::MatrixXd(b) - full)).cwiseAbs().maxCoeff();
}

}  // namespace

BOOST_AUTO_TEST_CASE(multiblade_coordinates_make_an_isotropic_turbine_constant) {
  model::TurbineDefinition definition = isotropic_nrel5mw();
  for (const bool isotropic : {true, false}) {
    if (!isotropic) definition.blades.each[2].mass_factor = 1.1;
    const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
    analysis::Observer observer;
    const analysis::Trim trim = analysis::find_trim(system, {}, observer);
    const Multiblade multiblade(system);
    const MultibladeSystem first = multiblade.at(0.0, trim.solution);
    for (const double part : {0.07, 0.41, 0.83}) {
      const MultibladeSystem other = multiblade.at(part * system.period(), trim.solution);
      const double change = std::max(difference(first.K, other.K), difference(first.M, other.M));
      if (isotropic)
        BOOST_TEST(change < 1e-8);
      else
        BOOST_TEST(change > 1e-3);
    }
  }
}

BOOST_AUTO_TEST_CASE(floquet_exponents_are_those_of_multiblade_coordinates) {
  // Two steps, extrapolated: what is left of (omega dt)^4 at 600 and 1200 steps a revolution is
  // 3e-7 of the tenth mode. An exponent is known modulo i Omega: in turning axes a cyclic
  // motion is one Omega off.
  const model::TurbineDefinition definition = isotropic_nrel5mw();
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::Trim trim = analysis::find_trim(system, {}, observer);
  const std::vector<MultibladeMode> modes =
      slow_modes(Multiblade(system).at(0.0, trim.solution), 2.0, 40.0);
  const analysis::ModeSet coarse = floquet_of(definition, 600).set;
  const analysis::ModeSet fine = floquet_of(definition, 1200).set;
  const auto nearest_exponent = [](const analysis::ModeSet& set, Complex wanted) {
    Complex best(1e9, 0.0);
    for (const analysis::Mode& mode : set.modes)
      for (const Complex exponent : {mode.step_exponent, std::conj(mode.step_exponent)})
        for (const double k : {-1.0, 0.0, 1.0}) {
          const Complex candidate = exponent + Complex(0.0, k * set.rotor_speed);
          if (std::abs(candidate - wanted) < std::abs(best - wanted)) best = candidate;
        }
    return best;
  };
  BOOST_REQUIRE(modes.size() >= 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    const Complex wanted = modes[i].exponent;
    BOOST_TEST(modes[i].residual < 1e-9);
    const Complex a = nearest_exponent(coarse, wanted);
    const Complex b = nearest_exponent(fine, wanted);
    BOOST_TEST(std::abs(b + (b - a) / 3.0 - wanted) < 1e-6 * std::abs(wanted),
               wanted << " " << a << " " << b);
    // Second order: a quarter of the error is left.
    BOOST_TEST(std::abs(b - wanted) == 0.25 * std::abs(a - wanted),
               boost::test_tools::tolerance(0.01));
  }
}
