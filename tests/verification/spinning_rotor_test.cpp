// A rigid rotor of three blades on a flexible tower. It is isotropic: in fixed axes the
// coefficients are constant, and Ritz's method in displacements gives the exponents with the
// gyroscopic moments. Nothing here comes from the program or from the paper.
#include <array>

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include "samara/math/quadrature.hpp"

#include "cases.hpp"

using namespace samara;
using namespace samara::test;
using analysis::FloquetPeriod;
using boost::test_tools::tolerance;

namespace {

constexpr double tower_length = 27.0;
constexpr double line_mass = 67.5772;
constexpr double inertia1 = 5.0;
constexpr double inertia2 = 1.0;
constexpr double inertia3 = 4.0;
constexpr double tower_EI2 = 1e9;  // fore-aft
constexpr double tower_EI3 = 2e9;  // lateral
constexpr double tower_GJ = 1.5e9;
constexpr double nacelle_mass = 6900.0;
constexpr double nacelle_inertia = 16599.0;  // about y3
constexpr double overhang = 2.388;
constexpr double hub_radius = 1.8;
constexpr double blade_length = 8.42;
constexpr double hub_inertia = 50.0;  // about h1 and h3
constexpr double hub_polar = 70.0;

constexpr int n = 10;  // Ritz functions of a motion

/// `blade_rigidity` 0: rigid blades.
model::TurbineDefinition definition(bool free_yaw, double speed, double blade_rigidity = 0.0) {
  model::SectionDefinition tower;
  tower.rigid = {true, true, true, false, false, false};
  tower.stiffness.diagonal() << 0.0, 0.0, 0.0, tower_GJ, tower_EI2, tower_EI3;
  tower.mass.diagonal() << line_mass, line_mass, line_mass, inertia1, inertia2, inertia3;
  model::SectionDefinition blade = tower;
  blade.stiffness.diagonal() << 0.0, 0.0, 0.0, blade_rigidity, blade_rigidity, blade_rigidity;
  if (blade_rigidity == 0.0) blade.rigid.fill(true);
  model::TurbineDefinition turbine;
  turbine.gravity = 0.0;
  turbine.has_tower = true;
  turbine.tower.length = tower_length;
  turbine.tower.elements = 3;
  turbine.tower.order = 4;
  turbine.tower.sections = {tower};
  turbine.has_nacelle = true;
  turbine.nacelle.mass = nacelle_mass;
  turbine.nacelle.inertia = Vector3(0.0, 0.0, nacelle_inertia);
  if (free_yaw) turbine.nacelle.yaw.kind = model::JointKind::free;
  turbine.shaft.speed = speed;
  turbine.shaft.overhang = overhang;
  turbine.hub.inertia = Vector3(hub_inertia, hub_polar, hub_inertia);
  turbine.hub.radius = hub_radius;
  turbine.blades.count = 3;
  turbine.blades.beam.length = blade_length;
  turbine.blades.beam.elements = 1;
  turbine.blades.beam.order = 2;  // Gauss: the moment of inertia of a straight blade is exact
  turbine.blades.beam.sections = {blade};
  return turbine;
}

/// Frequencies [rad/s] by Ritz. Coordinates: fore-aft w along n2, lateral v along n1, twist f about
/// n3, all polynomials of the height, and with a free yaw the rotation q of nacelle and rotor about
/// n3 against the top. Rotation of the top: (-w', v', f); the rotor's centre is at overhang n2.
std::vector<double> exact_frequencies(bool free_yaw, double speed) {
  const int size = 3 * n + (free_yaw ? 1 : 0);
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(size, size);
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(size, size);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(size, size);
  const double l = tower_length;
  // Bending x^2 P_k, twist x P_k with Legendre's polynomials P_k of 2 x - 1, x = height / l.
  struct Shape {
    Eigen::VectorXd value, slope, curvature;
  };
  const auto shapes = [](int power, double x) {
    Shape shape{Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n)};
    std::array<double, n + 1> p{1.0, 2.0 * x - 1.0};
    std::array<double, n + 1> p1{0.0, 2.0};
    std::array<double, n + 1> p2{};
    for (std::size_t k = 1; k < n; ++k) {
      const double c = static_cast<double>(2 * k + 1) / static_cast<double>(k + 1);
      const double e = static_cast<double>(k) / static_cast<double>(k + 1);
      p[k + 1] = c * (2.0 * x - 1.0) * p[k] - e * p[k - 1];
      p1[k + 1] = c * (2.0 * p[k] + (2.0 * x - 1.0) * p1[k]) - e * p1[k - 1];
      p2[k + 1] = c * (4.0 * p1[k] + (2.0 * x - 1.0) * p2[k]) - e * p2[k - 1];
    }
    const double f = std::pow(x, power);
    const double f1 = power * std::pow(x, power - 1);
    const double f2 = power == 2 ? 2.0 : 0.0;
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      shape.value(i) = f * p[k];
      shape.slope(i) = (f * p1[k] + f1 * p[k]) / tower_length;
      shape.curvature(i) =
          (f * p2[k] + 2.0 * f1 * p1[k] + f2 * p[k]) / (tower_length * tower_length);
    }
    return shape;
  };
  const math::QuadratureRule rule = math::gauss_rule(n + 4);
  const auto square = [](const Eigen::VectorXd& y) { return Eigen::MatrixXd(y * y.transpose()); };
  for (std::size_t q = 0; q < rule.points.size(); ++q) {
    const double dx = l * rule.weights[q];
    const Shape bend = shapes(2, rule.points[q]);
    const Shape twist = shapes(1, rule.points[q]);
    M.block(0, 0, n, n) += dx * (line_mass * square(bend.value) + inertia2 * square(bend.slope));
    M.block(n, n, n, n) += dx * (line_mass * square(bend.value) + inertia3 * square(bend.slope));
    M.block(2 * n, 2 * n, n, n) += dx * inertia1 * square(twist.value);
    K.block(0, 0, n, n) += dx * tower_EI2 * square(bend.curvature);
    K.block(n, n, n, n) += dx * tower_EI3 * square(bend.curvature);
    K.block(2 * n, 2 * n, n, n) += dx * tower_GJ * square(twist.slope);
  }
  // Displacements and rotations of the top.
  Eigen::VectorXd w = Eigen::VectorXd::Zero(size);
  Eigen::VectorXd v = Eigen::VectorXd::Zero(size);
  Eigen::VectorXd tilt = Eigen::VectorXd::Zero(size);  // about n1
  Eigen::VectorXd roll = Eigen::VectorXd::Zero(size);  // about n2
  Eigen::VectorXd turn = Eigen::VectorXd::Zero(size);  // of the nacelle about n3
  const Shape top = shapes(2, 1.0);
  w.head(n) = top.value;
  tilt.head(n) = -top.slope;
  v.segment(n, n) = top.value;
  roll.segment(n, n) = top.slope;
  if (free_yaw)
    turn(size - 1) = 1.0;  // a free yaw's coordinate is the absolute rotation
  else
    turn.segment(2 * n, n) = shapes(1, 1.0).value;
  const double root = hub_radius;
  const double tip = hub_radius + blade_length;
  const double second = line_mass * (tip * tip * tip - root * root * root) / 3.0;
  const double polar = hub_polar + 3.0 * (second + inertia3 * blade_length);
  const double lateral = hub_inertia + 1.5 * (second + (inertia1 + inertia2) * blade_length);
  const double rotor_mass = 3.0 * line_mass * blade_length;
  const auto add = [&M](double mass, const Eigen::VectorXd& motion) {
    M += mass * motion * motion.transpose();
  };
  add(nacelle_mass, w);
  add(nacelle_mass, v);
  add(nacelle_inertia, turn);
  add(rotor_mass, w);
  add(rotor_mass, v - overhang * turn);
  add(rotor_mass, overhang * tilt);
  add(lateral, tilt);
  add(polar, roll);
  add(lateral, turn);
  // Moment of the turning rotor: d/dt of polar Omega s2, s2 = n2 + (-turn, ., tilt).
  G += polar * speed * (turn * tilt.transpose() - tilt * turn.transpose());
  Eigen::MatrixXd first = Eigen::MatrixXd::Zero(2 * size, 2 * size);
  const Eigen::LLT<Eigen::MatrixXd> llt(M);
  const auto whiten = [&llt](const Eigen::MatrixXd& matrix) {
    const Eigen::MatrixXd half = llt.matrixL().solve(matrix);
    return Eigen::MatrixXd(llt.matrixL().solve(half.transpose()).transpose());
  };
  first.topRightCorner(size, size).setIdentity();
  first.bottomLeftCorner(size, size) = -whiten(K);
  first.bottomRightCorner(size, size) = -whiten(G);
  std::vector<double> found;
  for (const Complex& value : first.eigenvalues())
    if (value.imag() > 1e-3) found.push_back(value.imag());  // without the zeros of a free yaw
  std::sort(found.begin(), found.end());
  return found;
}

/// The same motion has the frequency f on the tower and f +- speed in the rotor; identification
/// takes that of the part with most energy. All three.
std::vector<double> seen_from_both_frames(const analysis::ModeSet& set) {
  std::vector<double> found;
  for (const double f : frequencies(set))
    for (const double shift : {-set.rotor_speed, 0.0, set.rotor_speed})
      found.push_back(std::abs(f + shift));
  return found;
}

}  // namespace

BOOST_AUTO_TEST_CASE(parked_rotor_on_a_tower_has_the_frequencies_of_ritz) {
  // To 1e-6; the sixth mode needs more than this mesh.
  const analysis::ModeSet set = constant_modes_of(definition(false, 0.0));
  BOOST_TEST(set.degrees_of_freedom == 3 * 12);
  const std::vector<double> found = frequencies(set);
  const std::vector<double> exact = exact_frequencies(false, 0.0);
  for (std::size_t i = 0; i < 5; ++i)
    BOOST_TEST(nearest(found, exact[i]) == exact[i], tolerance(1e-6));
}

BOOST_AUTO_TEST_CASE(turning_rotor_on_a_tower_precesses_as_ritz_says) {
  // The coefficients are constant in fixed axes, not in those of the rotor: (19) has its error of
  // O(dt^2) in a form of its own, so two steps are extrapolated. Fast: the rotor's spin changes the
  // tower's modes by tenths.
  constexpr double speed = 12.0;
  for (const bool free_yaw : {false, true}) {
    const std::vector<double> exact = exact_frequencies(free_yaw, speed);
    const std::vector<double> still = exact_frequencies(free_yaw, 0.0);
    const std::vector<double> coarse =
        seen_from_both_frames(floquet_of(definition(free_yaw, speed), 300).set);
    const std::vector<double> fine =
        seen_from_both_frames(floquet_of(definition(free_yaw, speed), 600).set);
    double split = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double a = nearest(coarse, exact[i]);
      const double b = nearest(fine, exact[i]);
      BOOST_TEST(b + (b - a) / 3.0 == exact[i], tolerance(1e-6));
      split = std::max(split, std::abs(exact[i] / still[i] - 1.0));
    }
    BOOST_TEST(split > 0.05);  // the gyroscopic moments are seen
  }
}

BOOST_AUTO_TEST_CASE(fast_modes_do_not_pass_for_resolved_slow_ones) {
  // Blades of bending modes at 1e4 rad/s and more, far beyond the step, on the same tower: what is
  // called resolved must be one of Ritz's modes, undamped. The step is 1/300 revolution; its warp
  // of the modes below 0.7 / (dt/2) is undone in proportion.
  constexpr double speed = 12.0;
  const std::vector<double> exact = exact_frequencies(false, speed);
  for (const double rigidity : {1e11, 1e12, 1e13, 1e14}) {
    const analysis::Floquet floquet = floquet_of(definition(false, speed, rigidity), 300);
    for (const analysis::Mode& mode : floquet.set.modes) {
      if (!mode.resolved || mode.exponent.imag() > 70.0) continue;
      analysis::ModeSet alone;
      alone.rotor_speed = speed;
      alone.modes = {mode};
      double off = std::numeric_limits<double>::infinity();
      for (const double frequency : exact)
        off = std::min(off, std::abs(nearest(seen_from_both_frames(alone), frequency) - frequency));
      BOOST_TEST(off < 0.1, rigidity << " " << mode.label << " " << mode.exponent);
      // The impulses after a step leave a growth of a higher order than the step's error.
      BOOST_TEST(std::abs(mode.exponent.real()) < 2e-5,
                 rigidity << " " << mode.label << " " << mode.exponent);
    }
  }
}
