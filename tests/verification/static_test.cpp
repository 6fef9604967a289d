// Beams and turbines at rest under large loads, against closed forms, figures of others, and global
// equilibrium in the deformed place.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include "samara/analysis/static_path.hpp"
#include "samara/base/error.hpp"
#include "samara/math/quadrature.hpp"
#include "samara/math/rotation.hpp"

#include "cases.hpp"

namespace {

using namespace samara;
using namespace samara::test;
using analysis::StaticMethod;
using analysis::StaticPath;

StaticPath statics_of(const system::TurbineSystem& system, int steps = 10,
                      StaticMethod method = StaticMethod::load) {
  analysis::Observer observer;
  return analysis::find_static_path(system, {method, steps, 1e-10, 1000}, observer);
}

model::LoadDefinition force_at(double place, const Vector3& force) {
  model::LoadDefinition load;
  load.from = place;
  load.to = place;
  load.force = force;
  return load;
}

/// What people compare: at the end of a beam.
struct End {
  Vector3 u;
  double angle = 0.0;  ///< of its rotation [rad]
};

End end_of(const Eigen::VectorXd& z, const system::TurbineSystem& system) {
  const Vector6 tip = z.segment<6>(system.layout().blade_tip(0));
  return {tip.head<3>(), 2.0 * std::atan(0.5 * tip.tail<3>().norm())};
}

End end_of(const BeamCase& beam, const std::vector<model::LoadDefinition>& loads, int steps = 10,
           StaticMethod method = StaticMethod::load) {
  model::TurbineDefinition definition = definition_of(beam);
  definition.loads = loads;
  const system::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  return end_of(statics_of(system, steps, method).states.back().z, system);
}

/// A cantilever that only bends, EI = L = 1.
BeamCase elastica(int elements, int order) {
  BeamCase beam;
  beam.stiffness << 0.0, 0.0, 0.0, 0.0, 1.0, 0.0;
  beam.elements = elements;
  beam.order = order;
  return beam;
}

/// Large deflection of a cantilever under a dead force P across its end, from elliptic integrals:
/// P L^2 / EI, -u/L, w/L, angle [rad]. Mattiasson, Int. J. Numer. Methods Eng. 17 (1981) 145-153.
struct ElasticaFigure {
  double load, u, w, angle;
};
constexpr std::array<ElasticaFigure, 6> elastica_figures{{
    {0.5, 0.015918962, 0.162143576, 0.244533647},
    {1.0, 0.056433236, 0.301720774, 0.461351950},
    {2.0, 0.160641721, 0.493457480, 0.781749832},
    {4.0, 0.328941242, 0.669964181, 1.121239347},
    {8.0, 0.504827732, 0.784982375, 1.374431507},
    {16.0, 0.646772585, 0.852746978, 1.510072139},
}};

/// Length of a lemniscate of unit radius over two: the integral of 1/sqrt(sin) over a right angle.
constexpr double lemniscate = 2.62205755429211981;

/// Stiffness of a composite section with couplings, in the program's order of strains.
Matrix6 composite_stiffness() {
  Matrix6 S = Vector6(1368.17e3, 88.56e3, 38.78e3, 16.96e3, 59.12e3, 141.47e3).asDiagonal();
  S(3, 4) = S(4, 3) = 17.61e3;
  S(3, 5) = S(5, 3) = -0.351e3;
  S(4, 5) = S(5, 4) = -0.370e3;
  return S;
}

model::TurbineDefinition composite_beam(int elements, int order) {
  BeamCase beam;
  beam.length = 10.0;
  beam.elements = elements;
  beam.order = order;
  model::TurbineDefinition definition = definition_of(beam);
  model::SectionDefinition& section = definition.blades.beam.sections[0];
  section.stiffness = composite_stiffness();
  section.rigid = {};
  return definition;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(large_deflections)

BOOST_AUTO_TEST_CASE(a_dead_force_bends_a_cantilever_into_the_elastica) {
  for (const ElasticaFigure& figure : elastica_figures) {
    const End end = end_of(elastica(8, 3), {force_at(1.0, Vector3(0.0, 0.0, figure.load))}, 10);
    BOOST_TEST(std::abs(-end.u(0) - figure.u) < 1e-5);
    BOOST_TEST(std::abs(end.u(2) - figure.w) < 1e-5);
    BOOST_TEST(std::abs(end.u(1)) < 1e-12);
    BOOST_TEST(std::abs(end.angle - figure.angle) < 1e-5);
  }
}

BOOST_AUTO_TEST_CASE(deflections_converge_with_twice_the_order) {
  // Meshes whose errors are above the last digit of the figures.
  const ElasticaFigure& figure = elastica_figures[3];
  for (const auto& [order, elements] : {std::pair(1, 16), std::pair(2, 6), std::pair(3, 3)}) {
    const auto error = [&, s = order](int n) {
      const End end = end_of(elastica(n, s), {force_at(1.0, Vector3(0.0, 0.0, figure.load))});
      return std::hypot(end.u(0) + figure.u, end.u(2) - figure.w);
    };
    const double coarse = error(elements);
    const double fine = error(2 * elements);
    const double slope = std::log2(coarse / fine);
    BOOST_TEST(fine > 5e-9);
    BOOST_TEST(std::abs(slope - 2.0 * order) < 0.3,
               "order " << order << ": slope " << slope << ", errors " << coarse << " " << fine);
  }
}

BOOST_AUTO_TEST_CASE(a_moment_rolls_a_cantilever_up_into_a_circle) {
  constexpr double length = 12.0;
  constexpr double EI = 30e6 / 12.0;
  BeamCase beam;
  beam.length = length;
  beam.stiffness << 30e6, 12.5e6, 12.5e6, 4.2e6, EI, EI;
  beam.elements = 6;
  beam.order = 3;
  for (const bool follower : {false, true}) {
    for (const double part : {0.4, 0.8}) {  // of half a turn
      model::LoadDefinition load = force_at(1.0, Vector3::Zero());
      load.moment = Vector3(0.0, -part * pi * EI / length, 0.0);
      load.follower = follower;
      const End end = end_of(beam, {load});
      const double radius = length / (part * pi);
      BOOST_TEST(std::abs(end.u(0) - (radius * std::sin(part * pi) - length)) < 1e-3 * length);
      BOOST_TEST(std::abs(end.u(2) - radius * (1.0 - std::cos(part * pi))) < 1e-3 * length);
      BOOST_TEST(std::abs(end.u(1)) < 1e-9 * length);
      BOOST_TEST(std::abs(end.angle - part * pi) < 1e-3);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_rotation_beyond_170_degrees_is_named_with_the_load_reached) {
  BeamCase beam = elastica(6, 3);
  model::LoadDefinition load = force_at(1.0, Vector3::Zero());
  load.moment = Vector3(0.0, pi, 0.0);  // half a turn
  for (const StaticMethod method : {StaticMethod::load, StaticMethod::arc_length}) {
    try {
      end_of(beam, {load}, 10, method);
      BOOST_TEST(false, "180 degrees were reached");
    } catch (const DomainError& error) {
      const std::string words = error.what();
      BOOST_TEST(words.find("blade 1 tip: rotation beyond 170 degrees") != std::string::npos);
      const std::string before = "stopped at load factor ";
      BOOST_TEST_REQUIRE(words.find(before) != std::string::npos);
      const double reached = std::stod(words.substr(words.find(before) + before.size()));
      BOOST_TEST(std::abs(reached - 170.0 / 180.0) < 1e-3);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_follower_force_across_the_end_turns_it_by_a_right_angle) {
  // From the end inward EI alpha'' = P cos(alpha), alpha = alpha' = 0 there, so that
  // alpha' = sqrt(2 P sin(alpha) / EI): a turn of 90 degrees over the length asks for
  // P L^2 / EI = (integral of 1/sqrt(sin))^2 / 2, and leaves the end at (pi, 2 c)/c^2 L.
  const double c = lemniscate;
  const double load = 0.5 * c * c;
  const auto end_with = [&](int elements, int order) {
    model::LoadDefinition follower = force_at(1.0, Vector3(0.0, 0.0, load));
    follower.follower = true;
    return end_of(elastica(elements, order), {follower});
  };
  const End end = end_with(8, 3);
  BOOST_TEST(std::abs(end.angle - 0.5 * pi) < 1e-7);
  BOOST_TEST(std::abs(end.u(0) - (pi / (c * c) - 1.0)) < 1e-7);
  BOOST_TEST(std::abs(end.u(2) - 2.0 / c) < 1e-7);
  const double slope = std::log2(std::abs(end_with(4, 2).angle - 0.5 * pi) /
                                 std::abs(end_with(8, 2).angle - 0.5 * pi));
  BOOST_TEST(std::abs(slope - 4.0) < 0.3, slope);
}

BOOST_AUTO_TEST_CASE(a_composite_beam_with_couplings_deflects_as_published) {
  // BeamDyn's composite cantilever: Wang et al., Wind Energy 20 (2017) 1439-1462.
  model::TurbineDefinition definition = composite_beam(5, 3);
  definition.loads = {force_at(1.0, Vector3(0.0, 0.0, 150.0))};
  const system::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  const End end = end_of(statics_of(system).states.back().z, system);
  constexpr std::array<double, 3> published{-0.09027266, -0.06474885, 1.22973648};
  for (int i = 0; i < 3; ++i)
    BOOST_TEST(std::abs(end.u(i) - published[static_cast<std::size_t>(i)]) < 1e-4,
               end.u(i) << " of " << published[static_cast<std::size_t>(i)]);
}

BOOST_AUTO_TEST_CASE(a_load_on_a_part_of_a_cantilever_deflects_it_as_beam_theory_says) {
  // q on a stretch between a and b from the free end, linear theory.
  constexpr double EI = 1e9;
  constexpr double q = 1000.0;
  constexpr double a = 0.3;
  constexpr double b = 0.55;
  BeamCase beam = elastica(4, 3);
  beam.stiffness(4) = EI;
  model::LoadDefinition load = force_at(1.0 - b, Vector3(0.0, 0.0, q));
  load.to = 1.0 - a;
  const auto part = [](double x) { return std::pow(1.0 - x, 3) * (3.0 + x); };
  const double expected = q / (24.0 * EI) * (part(a) - part(b));
  const End end = end_of(beam, {load}, 1);
  BOOST_TEST(std::abs(end.u(2) / expected - 1.0) < 1e-6, end.u(2) / expected - 1.0);

  load = force_at(0.3, Vector3(0.0, 0.0, q));
  load.to = 0.7;
  const double middle = q / (24.0 * EI) * (part(0.3) - part(0.7));
  BOOST_TEST(std::abs(end_of(beam, {load}, 1).u(2) / middle - 1.0) < 1e-6);
}

BOOST_AUTO_TEST_SUITE_END()
