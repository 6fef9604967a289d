// Blades on hinges: frequencies in closed form, and rigid blades of particles on three hinges in
// any order, whose equations are written from positions alone.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include "samara/math/quadrature.hpp"
#include "samara/turbine/turbine_input_output.hpp"

#include "cases.hpp"

using namespace samara;
using namespace samara::test;
using Complex = std::complex<double>;
using model::HingeAxis;

namespace {

constexpr double speed = 10.0;

/// A rotor that turns at `speed` without gravity, its blades rigid and 10 m from the shaft axis to
/// the tip.
std::string rotor(double root, const std::string& inertia, const std::string& blades,
                  int count = 1) {
  const std::string length = std::to_string(10.0 - root);
  return "samara: 1\ngravity: 0\nshaft: {speed: 10}\nhub: {radius: " + std::to_string(root) +
         "}\nblades:\n  count: " + std::to_string(count) + "\n  length: " + length +
         "\n  elements: 2\n  order: 3\n  sections: [{at: 0, mass: 4, inertia: " + inertia +
         ", stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: rigid, EI2: rigid, EI3: rigid}}]\n" +
         blades;
}

struct Solved {
  explicit Solved(const std::string& text, const analysis::TrimOptions& options = {})
      : system(model::build_turbine(io::parse_case("test", text, {}).turbine), PETSC_COMM_SELF),
        trim(analysis::find_trim(system, options, observer)) {
    if (trim.solution.harmonics() == 0) set = analysis::find_constant_modes(system, trim.solution);
  }
  double frequency_of(const std::string& label) const {
    for (const analysis::Mode& mode : set.modes)
      if (mode.label == label) return mode.exponent.imag();
    return -1.0;
  }
  double angle(int hinge) const {
    return trim.solution.coefficients()(system.layout().hinge(0, hinge), 0);
  }

  analysis::Observer observer;
  turbine::TurbineSystem system;
  analysis::Trim trim;
  analysis::ModeSet set;
};

struct Particle {
  double mass = 0.0;
  Vector3 place = Vector3::Zero();  ///< from the root, blade axes
};

/// A rigid blade of particles on hinges with springs and dampers, on a hub that turns about b3.
struct ParticleBlade {
  std::vector<HingeAxis> order;
  std::vector<double> offset;  ///< of each from the one before
  Eigen::Vector3d stiffness, damping;
  double rest = 0.0;  ///< from the last hinge to the root
  std::vector<Particle> particles;

  static Vector3 axis_of(HingeAxis axis) {
    if (axis == HingeAxis::flap) return -Vector3::UnitY();
    return axis == HingeAxis::lag ? Vector3(-Vector3::UnitZ()) : Vector3(-Vector3::UnitX());
  }
  Vector3 place_of(const Particle& particle, const Eigen::Vector3d& q) const {
    Vector3 x = rest * Vector3::UnitX() + particle.place;
    for (int i = 2; i >= 0; --i) {
      const auto at = static_cast<std::size_t>(i);
      x = Eigen::AngleAxisd(q(i), axis_of(order[at])) * x;
      x += offset[at] * Vector3::UnitX();
    }
    return x;
  }
  /// Potential of springs and centrifugal forces.
  double potential(const Eigen::Vector3d& q) const {
    double sum = 0.5 * q.dot(stiffness.cwiseProduct(q));
    for (const Particle& one : particles)
      sum -= 0.5 * one.mass * speed * speed * place_of(one, q).head<2>().squaredNorm();
    return sum;
  }
  Eigen::Matrix3d jacobian(const Particle& one, const Eigen::Vector3d& q) const {
    constexpr double h = 1e-5;
    Eigen::Matrix3d J;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d d = h * Eigen::Vector3d::Unit(i);
      J.col(i) = (8.0 * (place_of(one, q + d) - place_of(one, q - d)) -
                  (place_of(one, q + 2.0 * d) - place_of(one, q - 2.0 * d))) /
                 (12.0 * h);
    }
    return J;
  }
  Eigen::Vector3d gradient(const Eigen::Vector3d& q) const {
    Eigen::Vector3d sum = stiffness.cwiseProduct(q);
    for (const Particle& one : particles) {
      Vector3 outward = place_of(one, q);
      outward(2) = 0.0;
      sum -= one.mass * speed * speed * jacobian(one, q).transpose() * outward;
    }
    return sum;
  }
  Eigen::Matrix3d hessian(const Eigen::Vector3d& q) const {
    constexpr double h = 1e-3;
    Eigen::Matrix3d H;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d d = h * Eigen::Vector3d::Unit(i);
      H.col(i) = (8.0 * (gradient(q + d) - gradient(q - d)) -
                  (gradient(q + 2.0 * d) - gradient(q - 2.0 * d))) /
                 (12.0 * h);
    }
    return H;
  }
  /// From a place near it.
  Eigen::Vector3d equilibrium(Eigen::Vector3d q) const {
    for (int i = 0; i < 50; ++i) q -= hessian(q).lu().solve(gradient(q));
    return q;
  }
  /// Equations of small motions about q: M q'' + (C + G) q' + K q = 0.
  std::vector<Complex> exponents(const Eigen::Vector3d& q) const {
    Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d D = damping.asDiagonal();
    Eigen::Matrix3d spin;
    spin << 0, -1, 0, 1, 0, 0, 0, 0, 0;
    for (const Particle& one : particles) {
      const Eigen::Matrix3d J = jacobian(one, q);
      M += one.mass * J.transpose() * J;
      D += 2.0 * speed * one.mass * J.transpose() * spin * J;
    }
    Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
    A.topRightCorner<3, 3>().setIdentity();
    A.bottomLeftCorner<3, 3>() = -M.lu().solve(hessian(q));
    A.bottomRightCorner<3, 3>() = -M.lu().solve(D);
    const Eigen::Matrix<Complex, 6, 1> values = A.eigenvalues();
    return {values.begin(), values.end()};
  }
};

const char* word_of(HingeAxis axis) {
  return axis == HingeAxis::flap ? "flap" : axis == HingeAxis::lag ? "lag" : "pitch";
}

}  // namespace

BOOST_AUTO_TEST_SUITE(hinges)

BOOST_AUTO_TEST_CASE(flap_and_lag_of_a_uniform_blade_have_their_closed_forms) {
  // nu^2 = 1 + 3 e / (2 (1 - e)) in flap and (3/2) e / (1 - e) in lag, e the offset by the radius.
  for (const double e : {0.02, 0.05, 0.2}) {
    const std::string at = std::to_string(10.0 * e);
    for (const int count : {1, 3}) {
      const Solved solved(rotor(
          10.0 * e, "[0, 0, 0]",
          "  hinges: [{axis: flap, offset: " + at + ", joint: free}, {axis: lag, joint: free}]\n",
          count));
      BOOST_TEST(solved.set.degrees_of_freedom == 2 * count);
      const std::string last = count > 1 ? " collective" : "";
      const double flap = solved.frequency_of("blade flap hinge" + last) / speed;
      const double lag = solved.frequency_of("blade lag hinge" + last) / speed;
      BOOST_TEST(std::abs(flap * flap - (1.0 + 1.5 * e / (1.0 - e))) < 1e-6);
      BOOST_TEST(std::abs(lag * lag - 1.5 * e / (1.0 - e)) < 1e-6);
    }
  }
}

BOOST_AUTO_TEST_CASE(pitch_follows_flap_by_a_link_and_by_a_skewed_axis) {
  // Hinged at the shaft axis, inertias I1 I2 I3 about it, t = tan(delta3): with theta = -t beta
  // nu^2 = (I3 - I1 + t^2 (I3 - I2)) / (I2 + t^2 I1).
  const double I1 = 10.0 * 3.0;
  const double I2 = 4000.0 / 3.0 + 10.0 * 20.0;
  const double I3 = 4000.0 / 3.0 + 10.0 * 11.0;
  for (const double degrees : {0.0, 35.0, -50.0}) {
    const double t = std::tan(degrees * pi / 180.0);
    const double wanted = (I3 - I1 + t * t * (I3 - I2)) / (I2 + t * t * I1);
    const std::string delta = std::to_string(degrees);
    for (const std::string& way :
         {"  hinges: [{axis: flap, joint: free, delta3_deg: " + delta + "}]\n",
          "  hinges: [{axis: flap, joint: free}]\n  pitch_link_delta3_deg: " + delta + "\n",
          "  hinges: [{axis: flap, joint: free}, {axis: pitch, joint: locked}]\n"
          "  pitch_link_delta3_deg: " +
              delta + "\n"}) {
      const Solved solved(rotor(0.0, "[3, 20, 11]", way));
      const double nu = solved.frequency_of("blade flap hinge") / speed;
      BOOST_TEST(std::abs(nu * nu - wanted) < 1e-6, way << nu * nu << " instead of " << wanted);
    }
  }
}

BOOST_AUTO_TEST_CASE(three_hinges_in_any_order_move_as_particles_on_them_do) {
  const std::vector<std::vector<HingeAxis>> orders{
      {HingeAxis::flap, HingeAxis::lag, HingeAxis::pitch},
      {HingeAxis::pitch, HingeAxis::lag, HingeAxis::flap},
      {HingeAxis::lag, HingeAxis::pitch, HingeAxis::flap}};
  for (const std::vector<HingeAxis>& order : orders) {
    ParticleBlade blade;
    blade.order = order;
    blade.offset = {0.3, 0.5, 0.2};
    blade.rest = 0.5;
    blade.stiffness = Eigen::Vector3d(3e3, 5e4, 9e3);
    blade.damping = Eigen::Vector3d(0.0, 400.0, 30.0);
    const double length = 8.5;
    const math::QuadratureRule rule = math::gauss_rule(4);
    for (std::size_t j = 0; j < rule.points.size(); ++j)
      blade.particles.push_back(
          {4.0 * length * rule.weights[j], Vector3(length * rule.points[j], 0.0, 0.0)});
    // A body off the line: its principal axes are those of the blade.
    const Vector3 center(0.5 * length, 0.4, 1.0);
    for (const double side : {-1.0, 1.0}) {
      blade.particles.push_back({6.0, center + Vector3(0.0, 0.5 * side, 0.0)});
      blade.particles.push_back({6.0, center + Vector3(0.0, 0.0, 0.3 * side)});
    }
    std::string list;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      list += std::string(i > 0 ? ", " : "") + "{axis: " + word_of(order[i]) +
              ", joint: free, offset: " + std::to_string(blade.offset[i]) +
              ", stiffness: " + std::to_string(blade.stiffness(at)) +
              ", damping: " + std::to_string(blade.damping(at)) + "}";
    }
    const Solved solved(rotor(1.5, "[0, 0, 0]",
                              "  hinges: [" + list +
                                  "]\n  point_masses:\n"
                                  "    - {at: 0.5, mass: 24, center: [0, 0.4, 1.0], "
                                  "inertia: [4.08, 1.08, 3]}\n"));
    const Eigen::Vector3d q =
        blade.equilibrium({solved.angle(0), solved.angle(1), solved.angle(2)});
    BOOST_TEST(q.cwiseAbs().maxCoeff() > 0.03);  // finite angles
    for (int i = 0; i < 3; ++i) BOOST_TEST(std::abs(solved.angle(i) - q(i)) < 1e-6);
    std::vector<Complex> wanted = blade.exponents(q);
    for (const analysis::Mode& mode : solved.set.modes) {
      double nearest = 1e9;
      for (const Complex& one : wanted) nearest = std::min(nearest, std::abs(one - mode.exponent));
      BOOST_TEST(nearest < 1e-5 * speed, mode.label << " " << mode.exponent);
    }
    BOOST_TEST(solved.set.degrees_of_freedom == 3);
  }
}

BOOST_AUTO_TEST_CASE(a_blade_cones_where_its_spring_and_the_centrifugal_force_balance) {
  // A flap hinge at the shaft axis: a follower force at the tip against a spring and
  // Omega^2 I sin(beta) cos(beta).
  const Solved solved(
      rotor(0.0, "[0, 0, 0]",
            "  hinges: [{axis: flap, joint: free, stiffness: 2e4}]\n"
            "loads: [{beam: blades, at: 1.0, force: [0, 0, 3000], follower: true}]\n"));
  const double I = 4.0 * 1000.0 / 3.0;
  double beta = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double r = 2e4 * beta + speed * speed * I * std::sin(beta) * std::cos(beta) - 3e4;
    beta -= r / (2e4 + speed * speed * I * std::cos(2.0 * beta));
  }
  BOOST_TEST(beta > 0.15);
  BOOST_TEST(std::abs(solved.angle(0) - beta) < 1e-9);
}

BOOST_AUTO_TEST_CASE(a_blade_hangs_on_its_flap_hinge_and_swings_about_it) {
  // Weight W of a rigid blade of length l and a force F across its end, which turns with the blade:
  // W l/2 sin(a) = F l about the hanging position, and (m l^2/3) a'' = -W l/2 cos(a) a.
  constexpr double weight = 40.0 * 9.81;
  for (const double force : {0.0, 20.0, 150.0})
    for (const double azimuth : {180.0, 0.0}) {
      if (force == 0.0 && azimuth == 0.0) continue;  // it stands
      const Solved solved(
          "samara: 1\ngravity: 9.81\nshaft: {azimuth_deg: " + std::to_string(azimuth) +
          "}\nblades:\n  length: 10\n  elements: 2\n  order: 3\n"
          "  sections: [{mass: 4, inertia: [0, 0, 0], stiffness: {EA: rigid, GA2: "
          "rigid, GA3: rigid, GJ: rigid, EI2: rigid, EI3: rigid}}]\n"
          "  hinges: [{axis: flap, joint: free}]\n"
          "loads: [{beam: blades, at: 1.0, force: [0, 0, " +
          std::to_string(force) + "]}]\n");
      const double turned = std::asin(2.0 * force / weight) + (azimuth == 0.0 ? pi : 0.0);
      BOOST_TEST(std::abs(std::remainder(solved.angle(0) - turned, 2.0 * pi)) < 1e-8);
      const double omega = std::sqrt(1.5 * 9.81 / 10.0 * std::cos(std::asin(2.0 * force / weight)));
      BOOST_TEST(std::abs(solved.set.modes[0].exponent.imag() - omega) < 1e-6);
    }
}

BOOST_AUTO_TEST_CASE(a_coned_blade_flaps_into_the_plane_of_its_rotation) {
  // Hinged at 0.4 m: sin(beta) (cos(beta) l/3 + e/2) = 0 for the angle beta to the plane.
  const Solved solved(rotor(
      0.4, "[0, 0, 0]", "  precone_deg: 3\n  hinges: [{axis: flap, offset: 0.4, joint: free}]\n"));
  const double offset = 0.4 * std::cos(3.0 * pi / 180.0);
  BOOST_TEST(std::abs(solved.angle(0) + 3.0 * pi / 180.0) < 1e-9);
  const double nu = solved.set.modes[0].exponent.imag() / speed;
  BOOST_TEST(std::abs(nu * nu - (1.0 + 1.5 * offset / 9.6)) < 1e-6);
}

BOOST_AUTO_TEST_CASE(prescribed_flapping_takes_the_moment_of_a_rigid_blade) {
  // I (beta'' + Omega^2 sin beta cos beta) about the hinge at the shaft axis, every blade by its
  // own azimuth.
  const double mean = 0.05;
  const double size = 4.0 * pi / 180.0;
  const Solved solved(rotor(0.0, "[0, 0, 0]",
                            "  hinges: [{axis: flap, joint: prescribed, angle_deg: " +
                                std::to_string(mean * 180.0 / pi) +
                                ", harmonic: {per_rev: 1, amplitude_deg: 4, phase_deg: 20}}]\n",
                            3),
                      {.harmonics = 8});
  BOOST_TEST(solved.system.symmetry().sectors == 3);
  const double I = 4.0 * 1000.0 / 3.0;
  const petsc::Handle<Vec> z = solved.system.make_state();
  const petsc::Handle<Vec> z_dot = solved.system.make_state();
  for (const double t : {0.0, 0.11, 0.4}) {
    solved.trim.solution.evaluate(t, z.get(), z_dot.get());
    const petsc::ReadView view(z.get());
    for (int k = 0; k < 3; ++k) {
      const double wave = size * std::cos(speed * t + 2.0 * pi * k / 3.0 + 20.0 * pi / 180.0);
      const double beta = std::stod(std::to_string(mean * 180.0 / pi)) * pi / 180.0 + wave;
      const double wanted = I * speed * speed * (std::sin(beta) * std::cos(beta) - wave);
      const double moment = view[solved.system.layout().blade_root(k) + 4];
      BOOST_TEST(std::abs(moment - wanted) < 1e-5 * I * speed * speed);
    }
  }
}

/// A uniform elastic blade, 10 m long, on hinges of the shaft axis.
std::string elastic(double rate, const std::string& hinges, int elements, int count = 1) {
  return "samara: 1\ngravity: 0\nshaft: {speed: " + std::to_string(rate) +
         "}\nhub: {radius: 0}\nblades:\n  count: " + std::to_string(count) +
         "\n  length: 10\n  order: 5\n  elements: " + std::to_string(elements) +
         "\n  sections: [{mass: 1, inertia: [2e-6, 1e-6, 1e-6], stiffness: {EA: 1e8, "
         "GA2: 4e7, GA3: 4e7, GJ: 8e3, EI2: 1e4, EI3: 1e4}}]\n  hinges: " +
         hinges + "\n";
}

/// Moduli of the resolved exponents in the upper half plane, ascending.
std::vector<double> moduli_of(const analysis::ModeSet& set) {
  std::vector<double> moduli;
  for (const analysis::Mode& mode : set.modes)
    if (mode.resolved) moduli.push_back(std::abs(mode.exponent));
  std::ranges::sort(moduli);
  return moduli;
}

/// One bending of an elastic blade behind each hinge has all Gauss points as nodes: no inertia, and
/// no exponent. In the maps of the steps it had multipliers of 1, as rigid-body motions have.
BOOST_AUTO_TEST_CASE(bending_without_inertia_behind_a_hinge_has_no_exponent) {
  constexpr int of_element = 5 * 6;  // elastic strains
  // Roots of tan(x) = tanh(x): a beam on a hinge, with free end.
  constexpr std::array<double, 3> roots{3.926602, 7.068583, 10.210176};
  const Solved parked(elastic(0.0, "[{axis: flap, joint: free}]", 2));
  BOOST_TEST(parked.set.degrees_of_freedom == 2 * of_element);
  BOOST_TEST(parked.set.states == 4 * of_element);
  BOOST_TEST(parked.set.found == 4 * of_element);
  std::vector<double> flap;
  int rigid = 0;
  for (const analysis::Mode& mode : parked.set.modes) {
    BOOST_TEST(mode.resolved, mode.label);
    BOOST_TEST(std::abs(mode.exponent.real()) < 1e-3, mode.label << mode.exponent);
    if (mode.exponent == 0.0) ++rigid;
    if (mode.exponent != 0.0 && mode.name.find("flap") != std::string::npos)
      flap.push_back(mode.exponent.imag());
  }
  BOOST_TEST(rigid == 2);  // the swing of the blade, twice zero
  for (std::size_t i = 0; i < roots.size(); ++i)
    BOOST_TEST(std::abs(flap.at(i) / (roots[i] * roots[i]) - 1.0) < 5e-3, flap.at(i));
  // Turning: by all routes the same modes, with and without a damper, of one blade and of three.
  const std::vector<std::pair<std::string, int>> cases{
      {"[{axis: flap, joint: free}]", 1},
      {"[{axis: flap, joint: free, stiffness: 500}, {axis: lag, joint: free, stiffness: 1000}]", 3},
      {"[{axis: lag, joint: free, stiffness: 1000, damping: 100}]", 3},
      {"[{axis: flap, joint: free, stiffness: 500}]\n"
       "  pitch_actuator: {frequency: 40, damping_ratio: 0.6}",
       1}};
  for (const auto& [hinges, count] : cases) BOOST_TEST_CONTEXT(hinges) {
      Solved turning(elastic(6.0, hinges, 1, count));
      const bool is_damped = hinges.find("damping:") != std::string::npos;
      const std::vector<double> known = moduli_of(turning.set);
      BOOST_TEST(turning.set.found == turning.set.states);
      BOOST_TEST(turning.set.degrees_of_freedom == count * of_element);
      const auto first_order = std::ranges::count(
          turning.system.unknowns(), system::UnknownRole::state, &system::Unknown::role);
      BOOST_TEST(turning.set.states ==
                 2 * count * of_element + (is_damped ? count : 0) + first_order);
      analysis::FloquetOptions some;
      some.modes = 3 * count;
      some.search = analysis::ModeSearch::hill;
      const std::vector<double> searched = moduli_of(analysis::find_constant_modes(
          turning.system, turning.trim.solution, some, PETSC_COMM_SELF, turning.observer));
      for (std::size_t i = 0; i < searched.size(); ++i)
        BOOST_TEST(std::abs(searched[i] / known.at(i) - 1.0) < 1e-8);
      for (const int order : {2, 6}) {
        const int steps = order == 2 ? 360 : 60;
        const analysis::ModeSet set =
            analysis::find_floquet_modes(turning.system, turning.trim.solution,
                                         {steps, analysis::FloquetPeriod::automatic, order},
                                         PETSC_COMM_SELF, turning.observer)
                .set;
        BOOST_TEST(set.degrees_of_freedom == count * of_element);
        BOOST_TEST(set.states == turning.set.states);
        const std::vector<double> moduli = moduli_of(set);
        // Free flap about the shaft axis is once per revolution, where a multiplier of a pair is
        // real.
        std::vector<double> above;
        std::ranges::copy_if(moduli, std::back_inserter(above),
                             [](double modulus) { return modulus > 7.0; });
        const auto first = std::ranges::upper_bound(known, 7.0);
        const auto inside =
            std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(above.size()), 3 * count);
        for (std::ptrdiff_t i = 0; i < inside; ++i)
          BOOST_TEST(std::abs(above[static_cast<std::size_t>(i)] / *(first + i) - 1.0) <
                         (order == 2 ? 4e-2 : 1e-4),
                     "order " << order);
        for (const double modulus : moduli)
          BOOST_TEST(modulus > 1e-3, "order " << order << ": a motion at rest");
      }
    }
}

BOOST_AUTO_TEST_CASE(angles_are_channels_and_pitch_moves_them) {
  // A pitch input turns the blade at its pitch hinge, inboard of the flap hinge.
  const Solved solved(rotor(0.5, "[1, 2, 3]",
                            "  precone_deg: 4\n"
                            "  hinges: [{axis: pitch, joint: locked}, "
                            "{axis: flap, offset: 0.5, joint: free}]\n",
                            2));
  const turbine::TurbineInputOutput signals(solved.system, {"pitch_1"}, {},
                                            {"FlapHinge1", "FlapHinge2", "RootFzb1"});
  const petsc::Handle<Vec> z = solved.system.make_state();
  const petsc::Handle<Vec> z_dot = solved.system.make_state();
  solved.trim.solution.evaluate(0.0, z.get(), z_dot.get());
  const Eigen::VectorXd values = signals.output_values(0.0, z.get(), z_dot.get());
  BOOST_TEST(solved.angle(0) < -0.01);  // against the cone
  BOOST_TEST(std::abs(values(0) - solved.angle(0) * 180.0 / pi) < 1e-12);
  BOOST_TEST(std::abs(values(1) - values(0)) < 1e-9);
  // Half m Omega^2 times the square of the radii, less what the hinge takes.
  const double force = 0.5 * 4.0 * speed * speed * (100.0 - 0.25);
  BOOST_TEST(std::abs(1e3 * values(2) - force) < 0.01 * force);
  const system::OutputTangents tangents = signals.output_tangents(0.0, z.get(), z_dot.get());
  const PetscInt angle = solved.system.layout().hinge(0, 0);
  BOOST_TEST(std::abs(tangents.by_state(0, angle) - 180.0 / pi) < 1e-9);
  BOOST_TEST(tangents.by_input.row(0).norm() == 0.0);
}

BOOST_AUTO_TEST_CASE(a_damper_that_is_out_breaks_the_symmetry) {
  const std::string hinges =
      "  hinges: [{axis: flap, offset: 0.5, joint: free}, {axis: lag, joint: free, damping: "
      "200}]\n";
  const Solved whole(rotor(0.5, "[0, 0, 0]", hinges, 3));
  BOOST_TEST(whole.system.symmetry().sectors == 3);
  const io::Case input = io::parse_case(
      "test", rotor(0.5, "[0, 0, 0]", hinges + "  each: {2: {hinges: {lag: {damping: 0}}}}\n", 3),
      {});
  const turbine::TurbineSystem one_out(model::build_turbine(input.turbine), PETSC_COMM_SELF);
  BOOST_TEST(one_out.symmetry().sectors == 1);
  BOOST_TEST(one_out.symmetry().broken_by == "the blades differ");
  // The same change of all blades keeps it.
  const io::Case all_changed = io::parse_case(
      "test",
      rotor(0.5, "[0, 0, 0]",
            hinges + "  each: {1: {mass_factor: 2}, 2: {mass_factor: 2}, 3: {mass_factor: 2}}\n",
            3),
      {});
  const turbine::TurbineSystem changed(model::build_turbine(all_changed.turbine), PETSC_COMM_SELF);
  BOOST_TEST(changed.symmetry().sectors == 3);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused_with_its_place) {
  const auto fault = [](const std::string& blades) {
    return message_of(rotor(0.5, "[0, 0, 0]", blades));
  };
  const auto has = [](const std::string& text, const std::string& words) {
    return text.find(words) != std::string::npos;
  };
  BOOST_TEST(has(fault("  hinges: [{axis: flap, offset: 0.6, joint: free}]\n"),
                 "blades.hinges: the offsets add to 0.6 m, beyond the root at hub.radius, 0.5 m"));
  BOOST_TEST(has(fault("  hinges: [{axis: flap, joint: free}, {axis: flap, joint: free}]\n"),
                 "given twice"));
  BOOST_TEST(has(fault("  hinges: [{axis: lag, joint: free, delta3_deg: 3}]\n"),
                 "only the axis of a flap hinge is skewed"));
  BOOST_TEST(has(fault("  pitch_link_delta3_deg: 30\n"), "blades.hinges has no free flap hinge"));
  BOOST_TEST(has(fault("  hinges: [{axis: flap, joint: locked}]\n"
                       "  each: {1: {hinges: {flap: {damping: 1}}}}\n"),
                 "no free hinge of blades.hinges"));
  BOOST_TEST(has(fault("  hinges: flap\n"), "expected a list of hinges"));
}

BOOST_AUTO_TEST_SUITE_END()
