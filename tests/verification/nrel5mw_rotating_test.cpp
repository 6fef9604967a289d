// The NREL 5 MW turbine at 12 rpm, under gravity, with tilt and cone, against OpenFAST with BeamDyn
// blades and ElastoDyn's tower; and what the discretization of those two does to the frequencies.
#include <boost/test/unit_test.hpp>

#include "samara/math/quadrature.hpp"

#include "mesh_study.hpp"
#include "multiblade.hpp"
#include "record.hpp"

using namespace samara;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

io::Case beam_blades(const std::vector<std::string>& settings) {
  return io::read_case(std::string(SAMARA_SOURCE_DIR) + "/inputs/nrel5mw/beam_blades.yaml",
                       settings);
}

std::vector<std::string> coarse() {
  return {"blades.elements=2", "blades.order=2", "tower.elements=2", "tower.order=2"};
}

/// Converged to 0.1 % in the first modes of the blades.
std::vector<std::string> fine() { return {"blades.elements=12", "blades.order=3"}; }

/// Places and weights of Gauss rules between the stations of a beam.
struct Span {
  explicit Span(const model::BeamDefinition& beam) {
    const math::QuadratureRule rule = math::gauss_rule(6);
    for (std::size_t s = 1; s < beam.sections.size(); ++s) {
      const double from = beam.sections[s - 1].at;
      const double to = beam.sections[s].at;
      for (std::size_t q = 0; q < rule.points.size(); ++q) {
        at.push_back(from + (to - from) * rule.points[q]);
        length.push_back((to - from) * rule.weights[q] * beam.length);
        section.push_back(model::interpolate_section(beam, at.back()));
      }
    }
  }
  std::vector<double> at, length;
  std::vector<model::SectionDefinition> section;
};

using Polynomial = std::vector<double>;  ///< coefficients of x^0, x^1, ...

/// The derivative of order d at x.
double value(const Polynomial& p, double x, int d) {
  double sum = 0.0;
  for (int i = static_cast<int>(p.size()) - 1; i >= d; --i) {
    double factor = p[static_cast<std::size_t>(i)];
    for (int j = 0; j < d; ++j) factor *= i - j;
    sum = sum * x + factor;
  }
  return sum;
}

/// x^power times Legendre's polynomials of 2 x - 1, `count` of them.
std::vector<Polynomial> polynomials(int power, int count) {
  std::vector<Polynomial> legendre{{1.0}, {-1.0, 2.0}};
  for (int k = 1; k + 1 < count; ++k) {
    const Polynomial& last = legendre[static_cast<std::size_t>(k)];
    const Polynomial& before = legendre[static_cast<std::size_t>(k - 1)];
    Polynomial next(last.size() + 1, 0.0);
    for (std::size_t i = 0; i < last.size(); ++i) {
      next[i] -= (2.0 * k + 1.0) / (k + 1.0) * last[i];
      next[i + 1] += 2.0 * (2.0 * k + 1.0) / (k + 1.0) * last[i];
    }
    for (std::size_t i = 0; i < before.size(); ++i) next[i] -= k / (k + 1.0) * before[i];
    legendre.push_back(next);
  }
  legendre.resize(static_cast<std::size_t>(count));
  for (Polynomial& p : legendre) p.insert(p.begin(), static_cast<std::size_t>(power), 0.0);
  return legendre;
}

std::vector<double> hertz(const Eigen::VectorXd& squares) {
  std::vector<double> found;
  for (const double square : squares) found.push_back(std::sqrt(square) / (2.0 * pi));
  return found;
}

/// A blade that turns, its root clamped, in polynomials of one degree for displacements u2, u3 and
/// rotations t2, t3 over the whole length: Ritz's method for what BeamDyn's one element spans.
struct RitzBlade {
  Eigen::VectorXd squares;   ///< omega^2
  Eigen::VectorXd momentum;  ///< of a mode of mass 1: int m r u2 (in the plane of rotation)
  double polar = 0.0;        ///< int m r^2
  double mass = 0.0;

  RitzBlade(const model::TurbineDefinition& turbine, int degree, double speed) {
    const Span span(turbine.blades.beam);
    const double l = turbine.blades.beam.length;
    const std::vector<Polynomial> shapes = polynomials(1, degree);
    const int n = degree;
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(4 * n, 4 * n);
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(4 * n, 4 * n);
    Eigen::VectorXd in_plane = Eigen::VectorXd::Zero(4 * n);
    double tension = 0.0;  // summed from the tip
    for (std::size_t q = span.at.size(); q-- > 0;) {
      const model::SectionDefinition& section = span.section[q];
      const double r = turbine.hub.radius + span.at[q] * l;
      const double line_mass = section.mass(0, 0);
      const double dm = line_mass * span.length[q];
      mass += dm;
      polar += dm * r * r;
      tension += 0.5 * dm * r * speed * speed;
      // Rows: u2, u3, t2, t3 and derivatives.
      Eigen::MatrixXd f = Eigen::MatrixXd::Zero(4, 4 * n);
      Eigen::MatrixXd f1 = Eigen::MatrixXd::Zero(4, 4 * n);
      for (int k = 0; k < n; ++k)
        for (int c = 0; c < 4; ++c) {
          f(c, c * n + k) = value(shapes[static_cast<std::size_t>(k)], span.at[q], 0);
          f1(c, c * n + k) = value(shapes[static_cast<std::size_t>(k)], span.at[q], 1) / l;
        }
      // The section's axes are turned by the twist about -b1.
      Eigen::Matrix2d turn;
      turn << std::cos(section.twist), -std::sin(section.twist), std::sin(section.twist),
          std::cos(section.twist);
      Eigen::MatrixXd shear(2, 4 * n);
      shear << f1.row(0) - f.row(3), f1.row(1) + f.row(2);
      const auto add = [&](Eigen::MatrixXd& to, const Eigen::MatrixXd& rows, double first,
                           double second) {
        const Eigen::DiagonalMatrix<double, 2> weight(first * span.length[q],
                                                      second * span.length[q]);
        to += rows.transpose() * weight * rows;
      };
      add(K, turn * shear, section.stiffness(1, 1), section.stiffness(2, 2));
      add(K, turn * f1.bottomRows(2), section.stiffness(4, 4), section.stiffness(5, 5));
      add(K, f1.topRows(2), tension, tension);
      add(K, f.topRows(2), -line_mass * speed * speed, 0.0);
      add(M, f.topRows(2), line_mass, line_mass);
      add(M, turn * f.bottomRows(2), section.mass(4, 4), section.mass(5, 5));
      in_plane += dm * r * f.row(0).transpose();
      tension += 0.5 * dm * r * speed * speed;
    }
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> pairs(K, M);
    squares = pairs.eigenvalues();
    momentum = pairs.eigenvectors().transpose() * in_plane;
  }
};

/// Bodies on the tower top as they turn about one horizontal axis.
struct Top {
  double mass = 0.0, height = 0.0, side = 0.0, inertia = 0.0;  ///< inertia about the tower top

  void add(double m, double up, double aside, double own) {
    height = (height * mass + up * m) / (mass + m);
    side = (side * mass + aside * m) / (mass + m);
    mass += m;
    inertia += own + m * (up * up + aside * aside);
  }
};

/// ElastoDyn's tower shapes of the 5 MW turbine (its deck; x^2 to x^6): two fore-aft, two
/// side-side.
std::vector<Polynomial> fore_aft_shapes() {
  return {{0.0, 0.0, 0.7004, 2.1963, -5.6202, 6.2275, -2.504},
          {0.0, 0.0, -70.5319, -63.7623, 289.737, -176.513, 22.0706}};
}
std::vector<Polynomial> side_side_shapes() {
  return {{0.0, 0.0, 1.385, -1.7684, 3.0871, -2.2395, 0.5357},
          {0.0, 0.0, -121.21, 184.415, -224.904, 298.536, -135.838}};
}

/// The tower in given shapes with what stands on it, by Ritz, weight included. `blade` adds the
/// lowest three collective modes of three blades, whose edgewise part turns against the roll.
std::vector<double> tower_frequencies(const model::TurbineDefinition& turbine,
                                      const std::vector<Polynomial>& shapes, Top top,
                                      const RitzBlade* blade) {
  const Span span(turbine.tower);
  const double h = turbine.tower.length;
  const double g = turbine.gravity;
  const auto n = static_cast<Eigen::Index>(shapes.size());
  const Eigen::Index of_blade = blade != nullptr ? 3 : 0;
  const auto row = [&](double x, int d) {
    Eigen::VectorXd v(n);
    for (Eigen::Index i = 0; i < n; ++i)
      v(i) = value(shapes[static_cast<std::size_t>(i)], x, d) / std::pow(h, d);
    return v;
  };
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n + of_blade, n + of_blade);
  Eigen::MatrixXd K = M;
  const auto add = [n](Eigen::MatrixXd& to, double weight, const Eigen::VectorXd& v) {
    to.topLeftCorner(n, n) += weight * v * v.transpose();
  };
  double above = top.mass;
  for (std::size_t q = span.at.size(); q-- > 0;) {
    const double dm = span.section[q].mass(0, 0) * span.length[q];
    above += 0.5 * dm;
    add(M, dm, row(span.at[q], 0));
    add(K, span.section[q].stiffness(4, 4) * span.length[q], row(span.at[q], 2));
    add(K, -above * g * span.length[q], row(span.at[q], 1));
    above += 0.5 * dm;
  }
  const Eigen::VectorXd moves = row(1.0, 0);
  const Eigen::VectorXd turns = row(1.0, 1);
  add(M, top.mass, moves + top.height * turns);
  add(M, top.inertia - top.mass * top.height * top.height, turns);
  add(K, -top.mass * g * top.height, turns);
  for (Eigen::Index k = 0; k < of_blade; ++k) {
    M(n + k, n + k) = 3.0;
    K(n + k, n + k) = 3.0 * blade->squares(k);
    M.block(0, n + k, n, 1) = 3.0 * blade->momentum(k) * turns;
    M.block(n + k, 0, 1, n) = 3.0 * blade->momentum(k) * turns.transpose();
  }
  return hertz(Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M).eigenvalues());
}

/// Nacelle, hub and rigid blades, about the lateral axis (fore-aft motion) or the downwind one.
Top top_of(const model::TurbineDefinition& turbine, bool fore_aft, const RitzBlade* blade) {
  const double up = turbine.shaft.height + turbine.shaft.overhang * std::sin(turbine.shaft.tilt);
  const double back = turbine.shaft.overhang * std::cos(turbine.shaft.tilt);
  const model::NacelleDefinition& nacelle = turbine.nacelle;
  Top top;
  top.add(nacelle.mass, nacelle.center_of_mass.z(), fore_aft ? nacelle.center_of_mass.y() : 0.0,
          0.0);
  top.add(turbine.hub.mass, up, fore_aft ? back : 0.0, fore_aft ? 0.0 : turbine.hub.inertia.y());
  if (blade != nullptr)
    top.add(3.0 * blade->mass, up, fore_aft ? back : 0.0, (fore_aft ? 1.5 : 3.0) * blade->polar);
  return top;
}

constexpr double rpm12 = 12.0 * pi / 30.0;
/// Polynomials of the whole blade and tower that are as good as converged, to 0.3 %.
constexpr int many = 14;
constexpr int beamdyn_order = 5;  // order_elem of the deck

}  // namespace

BOOST_AUTO_TEST_CASE(ritz_in_their_shapes_finds_what_beamdyn_and_elastodyn_find_alone) {
  // frequencies.txt of case 5MW_Land_BD_Linear of OpenFAST's regression tests, 12.1 rpm: each of
  // the three BeamDyn blades alone (their mean here: gravity makes them differ by 1 %), and
  // ElastoDyn without blades.
  const model::TurbineDefinition turbine = beam_blades({}).turbine;
  const double speed = 12.1 * pi / 30.0;
  const RitzBlade blade(turbine, beamdyn_order, speed);
  const std::vector<double> found = hertz(blade.squares);
  BOOST_TEST(found[0] == (0.738975804 + 0.747847739 + 0.740438615) / 3.0, tolerance(5e-3));
  BOOST_TEST(found[2] == (2.087324059 + 2.096841543 + 2.088817603) / 3.0, tolerance(5e-3));
  BOOST_TEST(found[3] == (3.785142507 + 3.789916179 + 3.785403199) / 3.0, tolerance(5e-3));
  BOOST_TEST(found[4] == (4.953143272 + 4.960876364 + 4.954502781) / 3.0, tolerance(5e-3));
  // The edgewise figure has no -Omega^2: there the motion is seen in axes that stand still (issue
  // 3394 of OpenFAST).
  const double edge = (1.110355322 + 1.115626950 + 1.111274933) / 3.0;
  const double in_turning_axes = std::sqrt(edge * edge - std::pow(speed / (2.0 * pi), 2));
  BOOST_TEST(found[1] == in_turning_axes, tolerance(5e-3));

  const std::vector<double> fore_aft =
      tower_frequencies(turbine, fore_aft_shapes(), top_of(turbine, true, nullptr), nullptr);
  const std::vector<double> side_side =
      tower_frequencies(turbine, side_side_shapes(), top_of(turbine, false, nullptr), nullptr);
  BOOST_TEST(side_side[0] == 0.349716321, tolerance(1e-2));
  BOOST_TEST(fore_aft[0] == 0.354365494, tolerance(1e-2));
  BOOST_TEST(fore_aft[1] == 2.882901234, tolerance(1e-2));
  BOOST_TEST(side_side[1] == 2.965064506, tolerance(1e-2));
}

BOOST_AUTO_TEST_CASE(nrel5mw_at_12_rpm_has_the_frequencies_of_openfast) {
  // OpenFAST with BeamDyn blades (one element of order 5) and ElastoDyn's tower (two shapes a
  // direction), the mean of 36 azimuths in multiblade coordinates (issue 3394, pull request 3400 of
  // OpenFAST): tower side-side and fore-aft; flap backward, collective; edge backward; flap
  // forward; edge collective, forward; second flap backward. Hz, to be met within 2 %. Side-side is
  // that of a rerun of the public code, the others were the same there to 2e-4.
  const std::vector<double> published{0.3179, 0.3250, 0.5429, 0.7575, 0.9001,
                                      0.9389, 1.0455, 1.3049, 1.8562};
  const model::TurbineDefinition turbine = beam_blades({}).turbine;
  std::vector<double> sideways;
  const std::vector<double> found = mean_frequencies(beam_blades(fine()), &sideways);
  BOOST_REQUIRE(found.size() >= published.size());
  BOOST_TEST(sideways[0] > std::sqrt(0.5));  // the spin mixes the two, 0.3 % apart
  BOOST_TEST(sideways[1] < std::sqrt(0.5));
  const std::vector<std::string> names{"tower side-side", "tower fore-aft", "flap backward",
                                       "flap collective", "edge backward",  "flap forward",
                                       "edge collective", "edge forward",   "second flap backward"};
  const std::string source = "OpenFAST, BeamDyn blades, ElastoDyn tower";
  const std::string mesh = "blades 12 elements of order 3, tower 4 of order 3";
  const Figures page{"N2", source, mesh};
  // The first modes of the blades are met as they are, the others not: 6 % is a bound, no claim.
  for (std::size_t i = 0; i < published.size(); ++i) {
    const bool is_met = i >= 2 && i <= 7 && i != 6;
    page.check_relative(names[i] + " [Hz]", found[i], published[i], is_met ? 0.02 : 0.06);
  }
  // The reason: two shapes are too stiff for the tower, on which the locked rotor rolls
  // with its collective edge mode, and one element of order 5 for the second flap. Ritz's method in
  // the published code's shapes and in many, without a figure of this program, says by how much:
  // then all agree to 0.5 %.
  const RitzBlade theirs(turbine, beamdyn_order, rpm12);
  const RitzBlade converged(turbine, many, rpm12);
  const auto stiffer = [&](int mode) {
    return std::sqrt(theirs.squares(mode) / converged.squares(mode));
  };
  const std::vector<Polynomial> plenty = polynomials(2, 9);
  const Top pitching = top_of(turbine, true, &converged);
  const Top rolling = top_of(turbine, false, &converged);
  const double fore_aft = tower_frequencies(turbine, fore_aft_shapes(), pitching, nullptr)[0] /
                          tower_frequencies(turbine, plenty, pitching, nullptr)[0];
  const std::vector<double> roll_theirs =
      tower_frequencies(turbine, side_side_shapes(), rolling, &theirs);
  const std::vector<double> roll = tower_frequencies(turbine, plenty, rolling, &converged);
  const double turn = rpm12 / (2.0 * pi);  // between fixed and turning axes
  const std::vector<double> expected{
      found[0] * roll_theirs[0] / roll[0],   found[1] * fore_aft,
      (found[2] + turn) * stiffer(0) - turn, found[3] * stiffer(0),
      (found[4] + turn) * stiffer(1) - turn, (found[5] - turn) * stiffer(0) + turn,
      found[6] * roll_theirs[2] / roll[2],   (found[7] - turn) * stiffer(1) + turn,
      (found[8] + turn) * stiffer(2) - turn};
  for (std::size_t i = 0; i < published.size(); ++i)
    page.check_relative(names[i] + ", in its shapes [Hz]", expected[i], published[i], 0.005);

  // The tower does not droop as the rotor turns.
  const std::vector<double> still =
      mean_frequencies(beam_blades(with(fine(), {"shaft.speed_rpm=0"})));
  for (const std::size_t i : {0u, 1u}) BOOST_TEST(found[i] == still[i], tolerance(0.02));
}

BOOST_AUTO_TEST_CASE(frequencies_of_nrel5mw_at_12_rpm_converge_with_slope_two_s) {
  check_mesh_study("N2", [](const std::vector<std::string>& mesh) {
    return mean_frequencies(beam_blades(mesh));
  });
}

BOOST_AUTO_TEST_CASE(floquet_of_nrel5mw_under_gravity_is_near_the_mean_over_the_azimuth) {
  // What the mean leaves out, three per revolution of the weight, changes frequencies by 1e-4.
  const io::Case input = beam_blades(coarse());
  const std::vector<double> mean = mean_frequencies(input);
  const analysis::Floquet floquet =
      floquet_of(input.turbine, 450, analysis::FloquetPeriod::automatic, input.trim);
  std::vector<double> seen;
  for (const analysis::Mode& mode : floquet.set.modes) {
    const double omega = mode.exponent.imag();
    for (const double k : {-1.0, 0.0, 1.0})
      seen.push_back(std::abs(omega + k * floquet.set.rotor_speed) / (2.0 * pi));
  }
  BOOST_REQUIRE(mean.size() >= 9u);
  for (std::size_t i = 0; i < 9; ++i)
    BOOST_TEST(nearest(seen, mean[i]) == mean[i], tolerance(5e-4));
}

BOOST_AUTO_TEST_CASE(edge_modes_of_the_nrel5mw_blade_are_flap_modes_less_the_speed) {
  // ElastoDyn's blade, which bends alone, without twist and cone: pitched by 90 degrees it flaps in
  // its edge modes. In the plane of rotation the centrifugal force follows the motion:
  // omega_edge^2 = omega_flap^2 - Omega^2.
  model::TurbineDefinition turbine =
      io::read_case(std::string(SAMARA_SOURCE_DIR) + "/inputs/nrel5mw/land.yaml", coarse()).turbine;
  turbine.has_tower = false;
  turbine.has_nacelle = false;
  turbine.gravity = 0.0;
  turbine.shaft.torsion.kind = model::JointKind::locked;
  turbine.blades.count = 1;
  turbine.blades.precone = 0.0;
  turbine.blades.beam.damping.setZero();
  for (model::SectionDefinition& section : turbine.blades.beam.sections) section.twist = 0.0;
  const std::vector<double> edge = frequencies(constant_modes_of(turbine), "blade lead-lag");
  turbine.blades.pitch = 0.5 * pi;
  const std::vector<double> pitched = frequencies(constant_modes_of(turbine));
  const double speed = turbine.shaft.speed;
  BOOST_REQUIRE(edge.size() >= 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const double flap = std::sqrt(edge[i] * edge[i] + speed * speed);
    BOOST_TEST(nearest(pitched, flap) == flap, tolerance(1e-8));
  }
}
