// The cases of inputs/ that have no article or deck of their own, against closed forms.
#include <array>

#include <Eigen/Core>
#include <boost/test/unit_test.hpp>

#include "samara/math/quadrature.hpp"

#include "cases.hpp"

using namespace samara;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

io::Case input(const std::string& name, const std::vector<std::string>& settings = {}) {
  return structure(name, settings);
}

/// Rigid, and of one section, so that any mesh has its mass exactly.
void make_rigid(model::BeamDefinition& beam) {
  beam.damping.setZero();
  beam.sections = {beam.sections[beam.sections.size() / 2]};
  for (model::SectionDefinition& section : beam.sections) {
    section.stiffness.setZero();
    section.rigid.fill(true);
  }
}

/// Mass of a straight blade and its first and second moment about the rotor's apex along the blade.
struct BladeMoments {
  explicit BladeMoments(const model::TurbineDefinition& turbine) {
    const model::BeamDefinition& beam = turbine.blades.beam;
    const math::QuadratureRule rule = math::gauss_rule(3);
    std::vector<double> stations{0.0};
    for (const model::SectionDefinition& section : beam.sections) stations.push_back(section.at);
    stations.push_back(1.0);
    for (std::size_t s = 1; s < stations.size(); ++s) {
      const double from = stations[s - 1];
      const double to = stations[s];
      for (std::size_t q = 0; q < rule.points.size(); ++q) {
        const double at = from + (to - from) * rule.points[q];
        const double r = turbine.hub.radius + at * beam.length;
        const double dm = model::interpolate_section(beam, at).mass(0, 0) * rule.weights[q] *
                          (to - from) * beam.length;
        mass += dm;
        first += dm * r;
        second += dm * r * r;
      }
    }
  }
  double mass = 0.0, first = 0.0, second = 0.0;
};

std::vector<std::string> coarse() {
  return {"blades.elements=2", "blades.order=3", "tower.elements=2", "tower.order=2"};
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_rotating_beam_has_the_frequencies_of_wright) {
  // Wright et al. (1982), flap; lead-lag by the identity flap^2 - speed^2. The effect of shear and
  // rotary inertia is below 1e-4 in the first mode, 2e-3 in the third.
  struct Published {
    const char* speed;
    std::array<double, 3> flap;
  };
  for (const Published& published : {Published{"shaft.speed=0", {3.5160, 22.0345, 61.697}},
                                     Published{"shaft.speed=6", {7.3604, 26.8091, 66.684}},
                                     Published{"shaft.speed=12", {13.1702, 37.6031, 79.615}}}) {
    const io::Case beam = input("beam/rotating", {published.speed});
    const std::vector<double> found = frequencies(constant_modes_of(beam.turbine));
    const double speed = beam.turbine.shaft.speed;
    for (std::size_t i = 0; i < 3; ++i) {
      const double flap = published.flap[i];
      const double lag = std::sqrt(flap * flap - speed * speed);
      BOOST_TEST(nearest(found, flap) == flap, tolerance(i == 0 ? 1e-4 : 2e-3));
      BOOST_TEST(nearest(found, lag) == lag, tolerance(i == 0 ? 3e-4 : 2e-3));
    }
  }
}

BOOST_AUTO_TEST_CASE(the_teetering_rotor_is_balanced_about_its_pin) {
  // The sum in the case's head: the mass centre of cone, undersling and hub is on the teeter axis.
  const model::TurbineDefinition turbine = input("two_bladed/teetering").turbine;
  const BladeMoments blade(turbine);
  const double along_shaft =
      2.0 * (blade.mass * turbine.hub.undersling + blade.first * std::sin(turbine.blades.precone)) +
      turbine.hub.mass * turbine.hub.center_of_mass;
  BOOST_TEST(std::abs(along_shaft) < 1e-4 * blade.mass);
}

BOOST_AUTO_TEST_CASE(undersling_and_cone_enter_the_teeter_by_the_moments_of_inertia_about_the_pin) {
  // A rigid rotor that turns about h2 and teeters about h1, whatever the undersling: with moments
  // about the pin, J1 q'' + Omega^2 (J2 - J3) q = 0. Blades at y = u + r sin(cone), z = r
  // cos(cone).
  model::TurbineDefinition turbine = input("two_bladed/teetering").turbine;
  make_rigid(turbine.blades.beam);
  turbine.has_tower = false;
  turbine.has_nacelle = false;
  turbine.gravity = 0.0;
  turbine.shaft.torsion.kind = model::JointKind::locked;
  turbine.hub.teeter.damping = 0.0;
  const BladeMoments blade(turbine);
  const double speed = turbine.shaft.speed;
  for (const double cone : {-2.5, 6.0})
    for (const double undersling : {0.0, 0.96054, -3.0}) {
      turbine.blades.precone = cone * pi / 180.0;
      turbine.hub.undersling = undersling;
      const double s = std::sin(turbine.blades.precone);
      const double c = std::cos(turbine.blades.precone);
      const double zz = 2.0 * blade.second * c * c;
      const double yy = 2.0 * (blade.mass * undersling * undersling +
                               2.0 * undersling * blade.first * s + blade.second * s * s);
      const Vector3& hub = turbine.hub.inertia;
      const double J1 = hub(0) + yy + zz;
      const double J2 = hub(1) + zz;
      const double J3 = hub(2) + yy;
      const double omega = speed * std::sqrt((J2 - J3) / J1);
      const std::vector<double> found = frequencies(constant_modes_of(turbine));
      BOOST_REQUIRE(found.size() == 1u);
      BOOST_TEST(found.front() == omega, tolerance(1e-9));
    }
}

BOOST_AUTO_TEST_CASE(the_teetering_turbine_is_stable_and_teeters_once_a_revolution) {
  // With blades that bend and a tower, under gravity: theory's rigid rotor teeters at 0.9994 of the
  // speed, with the damping that the case's head derives.
  const io::Case teetering = input("two_bladed/teetering", coarse());
  const analysis::Floquet floquet =
      floquet_of(teetering.turbine, 400, analysis::FloquetPeriod::automatic, teetering.trim);
  BOOST_TEST(floquet.sectors == 2);
  int teeters = 0;
  for (const analysis::Mode& mode : floquet.set.modes) {
    if (mode.resolved) BOOST_TEST(mode.exponent.real() < 0.0, mode.label << " " << mode.exponent);
    if (!mode.name.starts_with("teeter")) continue;
    ++teeters;
    BOOST_TEST(mode.exponent.imag() == floquet.set.rotor_speed, tolerance(5e-3));
    BOOST_TEST(mode.damping_ratio == 0.02, tolerance(0.05));
  }
  BOOST_TEST(teeters == 1);
}

BOOST_AUTO_TEST_CASE(a_rigid_turbine_loads_its_tower_by_its_weight_at_its_lever_arms) {
  // Overhang, tilt, cone and a nacelle centre off both axes; three blades that turn, so that their
  // forces add up to a constant. At the top what stands on it does to the tower, components along
  // n1 n2 n3: the arms are (c1, c2, .) of the nacelle and (0, y, .) of the rotor.
  model::TurbineDefinition turbine = input("nrel5mw/land", coarse()).turbine;
  make_rigid(turbine.tower);
  make_rigid(turbine.blades.beam);
  turbine.nacelle.center_of_mass = Vector3(0.7, 1.9, 1.75);
  turbine.shaft.tilt = -0.2;
  turbine.blades.precone = -0.1;
  const turbine::TurbineSystem system(model::build_turbine(turbine), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::Trim trim = analysis::find_trim(system, {}, observer);
  const Eigen::MatrixXd& h = trim.solution.coefficients();
  const turbine::TurbineLayout& layout = system.layout();
  const double g = turbine.gravity;
  const BladeMoments blade(turbine);
  const double rotor = turbine.hub.mass + 3.0 * blade.mass;
  const double on_shaft = (turbine.hub.mass * turbine.shaft.overhang +
                           3.0 * (blade.mass * turbine.shaft.overhang +
                                  blade.first * std::sin(turbine.blades.precone))) /
                          rotor;
  const double arm = on_shaft * std::cos(turbine.shaft.tilt);
  const double nacelle = turbine.nacelle.mass;
  const double weight = (nacelle + rotor) * g;
  const double about_n1 = -g * (nacelle * turbine.nacelle.center_of_mass.y() + rotor * arm);
  const double about_n2 = g * nacelle * turbine.nacelle.center_of_mass.x();
  const auto top = [&](int i) { return h(layout.tower_tip() + 12 + i, 0); };  // n3, n1, n2
  const auto foot = [&](int i) { return h(layout.tower_root() + i, 0); };
  BOOST_TEST(top(0) == -weight, tolerance(1e-9));
  BOOST_TEST(top(4) == about_n1, tolerance(1e-9));
  BOOST_TEST(top(5) == about_n2, tolerance(1e-9));
  BOOST_TEST(std::abs(top(3)) < 1e-9 * about_n2);
  BOOST_TEST(foot(4) == top(4), tolerance(1e-9));
  BOOST_TEST(foot(5) == top(5), tolerance(1e-9));
  // Nothing at the foot but mean values.
  const double harmonics =
      h.rightCols(h.cols() - 1).row(layout.tower_root() + 4).cwiseAbs().maxCoeff();
  BOOST_TEST(harmonics < 1e-6 * about_n2);
}
