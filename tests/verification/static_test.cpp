// Beams and turbines at rest under large loads, against closed forms, figures of others, and global
// equilibrium in the deformed place.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include "samara/analysis/static_path.hpp"
#include "samara/base/error.hpp"
#include "samara/math/quadrature.hpp"
#include "samara/math/rotation.hpp"

#include "cases.hpp"
#include "record.hpp"

namespace {

using namespace samara;
using namespace samara::test;
using analysis::StaticMethod;
using analysis::StaticPath;

StaticPath statics_of(const turbine::TurbineSystem& system, int steps = 10,
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

/// Compared values: at the end of a beam.
struct End {
  Vector3 u;
  double angle = 0.0;  ///< of its rotation [rad]
};

End end_of(const Eigen::VectorXd& z, const turbine::TurbineSystem& system) {
  const Vector6 tip = z.segment<6>(system.layout().blade_tip(0));
  return {tip.head<3>(), 2.0 * std::atan(0.5 * tip.tail<3>().norm())};
}

End end_of(const BeamCase& beam, const std::vector<model::LoadDefinition>& loads, int steps = 10,
           StaticMethod method = StaticMethod::load) {
  model::TurbineDefinition definition = definition_of(beam);
  definition.loads = loads;
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
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

/// A clamped beam, straight or an arc, under a dead force P at its end. F = P and M = M_0 - (r -
/// r_0) x P everywhere; from the root r' = R (e1 + gamma), R' = R skew(k + kappa).
struct DeadForceBeam {
  double length;
  Matrix6 compliance;
  Vector3 force;
  Vector3 curvature = Vector3::Zero();  ///< k, without load

  using Line = Eigen::Matrix<double, 3, 4>;  ///< r, R

  /// At the end, by Runge-Kutta. `part` is of the load.
  Line integrate(const Vector3& root_moment, double part = 1.0) const {
    const auto rate = [&](const Line& y) {
      const Matrix3 R = y.rightCols<3>();
      const Vector3 M = root_moment - y.col(0).cross(part * force);
      Vector6 load;
      load << R.transpose() * part * force, R.transpose() * M;
      const Vector6 strain = compliance * load;
      Line dy;
      dy.col(0) = R * (Vector3::UnitX() + strain.head<3>());
      dy.rightCols<3>() = R * math::skew<double>(curvature + strain.tail<3>());
      return dy;
    };
    constexpr int steps = 2000;
    const double h = length / steps;
    Line y = Line::Zero();
    y.rightCols<3>().setIdentity();
    for (int i = 0; i < steps; ++i) {
      const Line k1 = rate(y);
      const Line k2 = rate(y + 0.5 * h * k1);
      const Line k3 = rate(y + 0.5 * h * k2);
      const Line k4 = rate(y + h * k3);
      y += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    return y;
  }

  /// Moment that is left at the end.
  Vector3 compute_rest(const Vector3& root_moment, double part = 1.0) const {
    return root_moment - integrate(root_moment, part).col(0).cross(part * force);
  }

  /// Position of the end, by Newton's method for the moment of the root.
  Vector3 compute_deflection() const {
    const double scale = length * force.norm();
    constexpr int parts = 5;
    Vector3 moment = Vector3::Zero();
    for (int i = 1; i <= parts; ++i) {
      const double part = static_cast<double>(i) / parts;
      Vector3 rest = compute_rest(moment, part);
      for (int iteration = 0; rest.norm() > 1e-12 * scale; ++iteration) {
        BOOST_REQUIRE(iteration < 20);
        Matrix3 slope;
        for (int j = 0; j < 3; ++j) {
          const Vector3 step = 1e-5 * scale * Vector3::Unit(j);
          slope.col(j) = (compute_rest(moment + step, part) - compute_rest(moment - step, part)) /
                         (2e-5 * scale);
        }
        moment -= slope.inverse() * rest;
        rest = compute_rest(moment, part);
      }
    }
    return integrate(moment).col(0) - integrate(Vector3::Zero(), 0.0).col(0);
  }
};

/// Errors of the deflection of an end against another solution, over the number of elements.
template <class Deflection>
std::vector<std::pair<double, double>> errors_of(Deflection&& deflection, int order,
                                                 const std::vector<int>& elements,
                                                 const Vector3& exact) {
  std::vector<std::pair<double, double>> errors;
  for (const int n : elements) errors.emplace_back(n, (deflection(n, order) - exact).norm());
  return errors;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(large_deflections)

BOOST_AUTO_TEST_CASE(a_dead_force_bends_a_cantilever_into_the_elastica) {
  const Figures page{"S2", "Mattiasson (1981), elliptic integrals", "8 elements of order 3"};
  for (const ElasticaFigure& figure : elastica_figures) {
    const End end = end_of(elastica(8, 3), {force_at(1.0, Vector3(0.0, 0.0, figure.load))}, 10);
    const std::string load = ", load " + in_short(figure.load);
    page.check_absolute("-u/L" + load, -end.u(0), figure.u, 1e-5);
    page.check_absolute("w/L" + load, end.u(2), figure.w, 1e-5);
    page.check_absolute("angle" + load, end.angle, figure.angle, 1e-5);
    BOOST_TEST(std::abs(end.u(1)) < 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(deflections_converge_with_twice_the_order) {
  // Against the differential equations, which have more digits than the figures.
  const ElasticaFigure& figure = elastica_figures[3];
  const Vector3 force(0.0, 0.0, figure.load);
  Matrix6 compliance = Matrix6::Zero();
  compliance(4, 4) = 1.0;
  const Vector3 exact = DeadForceBeam{1.0, compliance, force}.compute_deflection();
  BOOST_TEST((exact - Vector3(-figure.u, 0.0, figure.w)).norm() < 1e-9);
  const auto deflection = [&](int elements, int order) {
    return end_of(elastica(elements, order), {force_at(1.0, force)}).u;
  };
  const Convergence page{"S2", "deflection of the end over L, load 4", "elements"};
  for (const auto& [order, elements] :
       {std::pair(1, std::vector{8, 16, 32}), std::pair(2, std::vector{3, 6, 12, 24}),
        std::pair(3, std::vector{3, 6, 12})})
    page.check("order " + std::to_string(order), -2.0 * order, 0.2,
               errors_of(deflection, order, elements, exact));
}

BOOST_AUTO_TEST_CASE(a_moment_rolls_a_cantilever_up_into_a_circle) {
  constexpr double length = 12.0;
  constexpr double EI = 30e6 / 12.0;
  BeamCase beam;
  beam.length = length;
  beam.stiffness << 30e6, 12.5e6, 12.5e6, 4.2e6, EI, EI;
  beam.elements = 6;
  beam.order = 3;
  const Figures page{"S1", "closed form, an arc", "6 elements of order 3"};
  for (const auto& [follower, method] :
       {std::pair(false, StaticMethod::load), std::pair(true, StaticMethod::load),
        std::pair(false, StaticMethod::arc_length)}) {
    for (const double part : {0.4, 0.8, 1.2, 1.6, 2.0}) {  // of half a turn
      model::LoadDefinition load = force_at(1.0, Vector3::Zero());
      load.moment = Vector3(0.0, -part * pi * EI / length, 0.0);
      load.follower = follower;
      const End end = end_of(beam, {load}, 10, method);
      const double radius = length / (part * pi);
      const double attitude = std::min(part, 2.0 - part) * pi;
      const std::string what = ", lambda " + in_short(part) + (follower ? ", follower" : ", dead") +
                               (method == StaticMethod::load ? "" : ", arc length");
      page.check_absolute("u [m]" + what, end.u(0), radius * std::sin(part * pi) - length,
                          1e-3 * length);
      page.check_absolute("w [m]" + what, end.u(2), radius * (1.0 - std::cos(part * pi)),
                          1e-3 * length);
      page.check_absolute("angle [rad]" + what, end.angle, attitude, 1e-3);
      BOOST_TEST(std::abs(end.u(1)) < 1e-9 * length);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_roll_up_converges_with_twice_the_order) {
  for (const double part : {0.8, 1.7}) {  // of half a turn
    const double turn = part * pi;        // EI = L = 1: the moment is the angle
    const Vector3 exact(std::sin(turn) / turn - 1.0, 0.0, (1.0 - std::cos(turn)) / turn);
    const auto deflection = [&](int elements, int order) {
      model::LoadDefinition load = force_at(1.0, Vector3::Zero());
      load.moment = Vector3(0.0, -turn, 0.0);
      return end_of(elastica(elements, order), {load}, 12).u;
    };
    const Convergence page{"S1", "deflection of the end over L, lambda " + in_short(part),
                           "elements"};
    for (const auto& [order, elements] :
         {std::pair(1, std::vector{8, 16, 32}), std::pair(2, std::vector{4, 8, 16}),
          std::pair(3, std::vector{6, 12, 24})})
      page.check("order " + std::to_string(order), -2.0 * order, 0.2,
                 errors_of(deflection, order, elements, exact));
  }
}

BOOST_AUTO_TEST_CASE(a_beam_rolls_up_twice) {
  // Twice round: 45 degrees an element.
  model::LoadDefinition load = force_at(1.0, Vector3::Zero());
  load.moment = Vector3(0.0, 0.0, 4.0 * pi);
  BeamCase beam;
  beam.stiffness << 0.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  beam.elements = 16;
  beam.order = 3;
  const End end = end_of(beam, {load}, 20);
  BOOST_TEST((end.u - Vector3(-1.0, 0.0, 0.0)).norm() < 1e-5);
  BOOST_TEST(end.angle < 1e-4);
}

BOOST_AUTO_TEST_CASE(a_tower_top_beyond_170_degrees_is_named_with_the_load_reached) {
  model::TurbineDefinition definition = definition_of(elastica(1, 1));
  definition.has_tower = true;
  definition.tower = definition_of(elastica(6, 3)).blades.beam;
  model::LoadDefinition load = force_at(1.0, Vector3::Zero());
  load.on_tower = true;
  load.moment = Vector3(0.0, pi, 0.0);  // half a turn
  definition.loads = {load};
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  for (const StaticMethod method : {StaticMethod::load, StaticMethod::arc_length}) {
    try {
      statics_of(system, 10, method);
      BOOST_TEST(false, "180 degrees were reached");
    } catch (const DomainError& error) {
      const std::string words = error.what();
      BOOST_TEST(words.find("tower top: rotation beyond 170 degrees") != std::string::npos, words);
      const std::string before = "stopped at load factor ";
      BOOST_TEST_REQUIRE(words.find(before) != std::string::npos, words);
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
  // Section and load of BeamDyn's composite cantilever (Wang et al., Wind Energy 20 (2017)
  // 1439-1462); the deflection is that of another public code of geometrically exact beams.
  const Vector3 force(0.0, 0.0, 150.0);
  const auto deflection = [&](int elements, int order) {
    model::TurbineDefinition definition = composite_beam(elements, order);
    definition.loads = {force_at(1.0, force)};
    const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
    return end_of(statics_of(system).states.back().z, system).u;
  };
  const Vector3 found = deflection(5, 3);
  const Vector3 published(-0.09027266, -0.06474885, 1.22973648);
  const Vector3 exact =
      DeadForceBeam{10.0, composite_stiffness().inverse(), force}.compute_deflection();
  const Figures page{"S4", "another public program of geometrically exact beams",
                     "5 elements of order 3"};
  const Figures own{"S4", "the differential equations by Runge-Kutta", "5 elements of order 3"};
  for (int i = 0; i < 3; ++i) {
    const std::string quantity = "u" + std::to_string(i + 1) + " [m]";
    page.check_absolute(quantity, found(i), published(i), 1e-7);
    own.check_absolute(quantity, found(i), exact(i), 1e-7);
  }
  const Convergence convergence{"S4", "deflection of the end [m]", "elements"};
  for (const auto& [order, elements] :
       {std::pair(1, std::vector{4, 8, 16, 32}), std::pair(2, std::vector{2, 4, 8, 16}),
        std::pair(3, std::vector{1, 2, 4, 8})})
    convergence.check("order " + std::to_string(order), -2.0 * order, 0.2,
                      errors_of(deflection, order, elements, exact));
}

BOOST_AUTO_TEST_CASE(a_composite_beam_obeys_the_differential_equations) {
  // Integrated with the moment that the program finds at the root, nothing is left at the end.
  const double force = 4e3;  // a third of the length, where the couplings show
  model::TurbineDefinition definition = composite_beam(6, 4);
  const Vector3 P(0.0, 0.0, force);
  definition.loads = {force_at(1.0, P)};
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  const Eigen::VectorXd z = statics_of(system).states.back().z;
  const End end = end_of(z, system);

  const Vector3 root_moment = z.segment<3>(system.layout().blade_root(0) + 3);
  const DeadForceBeam exact{10.0, composite_stiffness().inverse(), P};
  const Vector3 left = exact.compute_rest(root_moment);
  BOOST_TEST(left.norm() < 1e-6 * root_moment.norm(), left.norm() / root_moment.norm());
  const Vector3 place = exact.integrate(root_moment).col(0);
  BOOST_TEST((place - Vector3(10.0, 0.0, 0.0) - end.u).norm() < 1e-6 * 10.0);
  BOOST_TEST(end.u(2) > 3.0);
}

BOOST_AUTO_TEST_CASE(a_bend_of_45_degrees_leaves_its_plane_as_published) {
  // Bathe and Bolourchi, Int. J. Numer. Methods Eng. 14 (1979) 961-986: radius 100, section 1 x 1,
  // E = 1e7, nu = 0, 600 across the plane at the end; their end is at (-23.5, -13.4, 53.4).
  // GXBeam, 16 elements of lowest order with straight chords: the second line of figures.
  constexpr double radius = 100.0;
  constexpr double E = 1e7;
  model::TurbineDefinition definition = definition_of(BeamCase{});
  model::BeamDefinition& beam = definition.blades.beam;
  constexpr int pieces = 1024;  // the natural ends of the spline reach no further than one or two
  for (int i = 0; i <= pieces; ++i) {
    const double angle = 0.25 * pi * i / pieces;
    beam.reference_line.emplace_back(radius * std::sin(angle), radius * (1.0 - std::cos(angle)),
                                     0.0);
  }
  beam.length = model::compute_arc_length(beam.reference_line);
  BOOST_TEST(std::abs(beam.length - 0.25 * pi * radius) < 1e-6 * radius);
  beam.sections[0].stiffness =
      Vector6(E, 0.5 * E, 0.5 * E, E / 12.0, E / 12.0, E / 12.0).asDiagonal();
  beam.sections[0].rigid = {};
  definition.loads = {force_at(1.0, Vector3(0.0, 0.0, 600.0))};
  const auto end_with = [&](int elements, int order) {
    beam.elements = elements;
    beam.order = order;
    const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
    return end_of(statics_of(system).states.back().z, system).u;
  };
  const Vector3 coarse = end_with(16, 1);
  const Vector3 fine = end_with(8, 3);
  const Vector3 bathe(-23.5, -13.4, 53.4);
  const Vector3 chords(-23.545303, -13.577384, 53.458008);
  BOOST_TEST((fine - bathe).norm() < 0.25);
  BOOST_TEST((coarse - chords).norm() < 5e-3);  // chords against arcs: O(L^2), L^2/(8 R) = 0.03
  BOOST_TEST((fine - chords).norm() < 0.04);    // their error, which is ours of order 1
  const DeadForceBeam arc{beam.length, beam.sections[0].stiffness.inverse(),
                          Vector3(0.0, 0.0, 600.0), Vector3(0.0, 0.0, 1.0 / radius)};
  const Vector3 exact = arc.compute_deflection();
  const std::string fine_mesh = "8 elements of order 3";
  for (int i = 0; i < 3; ++i) {
    const std::string quantity = "u" + std::to_string(i + 1) + " [m]";
    Figures{"S3", "Bathe and Bolourchi (1979)", fine_mesh}.check_absolute(quantity, fine(i),
                                                                          bathe(i), 0.25);
    Figures{"S3", "GXBeam, 16 elements of lowest order, straight chords", "16 elements of order 1"}
        .check_absolute(quantity, coarse(i), chords(i), 5e-3);
    Figures{"S3", "the differential equations by Runge-Kutta", fine_mesh}.check_absolute(
        quantity, fine(i), exact(i), 1e-4);
  }
  const Convergence page{"S3", "deflection of the end [m]", "elements"};
  for (const auto& [order, elements] :
       {std::pair(1, std::vector{4, 8, 16, 32}), std::pair(2, std::vector{4, 8, 16}),
        std::pair(3, std::vector{2, 4, 8})})
    page.check("order " + std::to_string(order), -2.0 * order, 0.3,
               errors_of(end_with, order, elements, exact));
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
  const Figures page{"S5", "beam theory", "4 elements of order 3"};
  page.check_relative("w [m], 0.3 to 0.55 from the end", end_of(beam, {load}, 1).u(2), expected,
                      1e-6);

  load = force_at(0.3, Vector3(0.0, 0.0, q));
  load.to = 0.7;
  const double middle = q / (24.0 * EI) * (part(0.3) - part(0.7));
  page.check_relative("w [m], 0.3 to 0.7 from the end", end_of(beam, {load}, 1).u(2), middle, 1e-6);

  // Exact on any mesh of order 2 or 3; of order 1 but for the two elements in which the load ends,
  // L^3 of each, if not in their middle. On these meshes it ends at 0.4 or 0.6 of an element.
  const auto end_with = [&](int elements, int order) {
    beam.elements = elements;
    beam.order = order;
    return end_of(beam, {load}, 1).u(2);
  };
  for (const int order : {2, 3})
    Figures{"S5", "beam theory", mesh_name(1, order)}.check_relative(
        "w [m], 0.3 to 0.7 from the end", end_with(1, order), middle, 1e-10);
  std::vector<std::pair<double, double>> errors;
  for (const int elements : {2, 8, 32})
    errors.emplace_back(elements, std::abs(end_with(elements, 1) / middle - 1.0));
  Convergence{"S5", "deflection of the end, relative", "elements"}.check("order 1", -3.0, 0.02,
                                                                         errors);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(global_equilibrium)

BOOST_AUTO_TEST_CASE(the_root_carries_all_loads_and_their_moments_in_the_deformed_place) {
  // From the state alone: tangents t_j = R_j (e1 + gamma_j) at the Gauss points give the place
  // r(xi) = L sum_j t_j int_0^xi l_j, and sum_j l_j(xi) R_j the turn of follower loads.
  constexpr double tolerance = 1e-9;
  for (const int order : {1, 2, 4}) {
    model::TurbineDefinition definition = composite_beam(3, order);
    definition.blades.beam.sections[0].twist = 0.2;
    model::LoadDefinition dead = force_at(0.37, Vector3(200.0, -100.0, 600.0));
    dead.moment = Vector3(300.0, 100.0, -200.0);
    model::LoadDefinition spread = force_at(0.2, Vector3(10.0, 40.0, 120.0));
    spread.to = 0.9;
    spread.moment = Vector3(30.0, 20.0, -40.0);
    model::LoadDefinition follower = spread;
    follower.follower = true;
    model::LoadDefinition end_follower = force_at(1.0, Vector3(-100.0, 80.0, 400.0));
    end_follower.moment = Vector3(150.0, 60.0, 90.0);
    end_follower.follower = true;
    definition.loads = {dead, spread, follower, end_follower};
    const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
    const model::Beam& beam = system.turbine().blades[0];
    const Eigen::VectorXd z = statics_of(system).states.back().z;
    const int tip = system.layout().blade_tip(0);
    BOOST_TEST(z.segment<3>(tip).norm() > 2.0);

    const Matrix6 compliance = composite_stiffness().inverse();
    const math::QuadratureRule points = math::gauss_rule(order);
    const math::QuadratureRule fine = math::gauss_rule(order + 3);
    const auto turn = [](const Vector3& theta, double twist) {
      return Matrix3(math::direction_cosines<double>(theta).transpose() *
                     math::turn_about<double>(-Vector3::UnitX(), twist));
    };
    std::vector<Matrix3> R;
    std::vector<Vector3> tangent;
    for (int p = 0; p < beam.point_count(); ++p) {
      const int first = system.layout().blade_point(0, p);
      R.push_back(turn(z.segment<3>(first + 3), 0.2));
      const Vector6 strain = compliance * z.segment<6>(first + 12);
      tangent.push_back(R.back() * (Vector3::UnitX() + strain.head<3>()));
    }
    const double length = beam.element_length(0);
    const auto integral_of = [&](int j, double xi) {  // of l_j from 0 to xi
      double sum = 0.0;
      for (std::size_t q = 0; q < fine.points.size(); ++q)
        sum += xi * fine.weights[q] * math::lagrange(points.points, j, xi * fine.points[q]);
      return sum;
    };
    const auto place = [&](double fraction) {
      Vector3 r = Vector3::Zero();
      for (int e = 0; e < 3; ++e) {
        const double xi = std::clamp(3.0 * fraction - e, 0.0, 1.0);
        for (int j = 0; j < order; ++j)
          r += length * integral_of(j, xi) * tangent[static_cast<std::size_t>(e * order + j)];
      }
      return r;
    };
    Vector3 force = Vector3::Zero();
    Vector3 moment = Vector3::Zero();
    const auto add = [&](double fraction, const Matrix3& R_at, const model::LoadDefinition& load,
                         double weight) {
      const Vector3 f = R_at * load.force * weight;
      force += f;
      moment += R_at * load.moment * weight + place(fraction).cross(f);
    };
    add(0.37, Matrix3::Identity(), dead, 1.0);
    add(1.0, turn(z.segment<3>(tip + 3), 0.2), end_follower, 1.0);
    for (int e = 0; e < 3; ++e) {
      const double low = std::max(0.2, e / 3.0);
      const double span = std::min(0.9, (e + 1) / 3.0) - low;
      for (std::size_t q = 0; q < fine.points.size(); ++q) {
        const double fraction = low + span * fine.points[q];
        const double weight = 10.0 * span * fine.weights[q];
        Matrix3 R_at = Matrix3::Zero();
        for (int j = 0; j < order; ++j)
          R_at += math::lagrange(points.points, j, 3.0 * fraction - e) *
                  R[static_cast<std::size_t>(e * order + j)];
        add(fraction, Matrix3::Identity(), spread, weight);
        add(fraction, R_at, follower, weight);
      }
    }
    const Vector6 root = z.segment<6>(system.layout().blade_root(0));
    BOOST_TEST((root.head<3>() - force).norm() < tolerance * force.norm());
    BOOST_TEST((root.tail<3>() - moment).norm() < tolerance * moment.norm());
  }
}

BOOST_AUTO_TEST_CASE(a_parked_turbine_stands_as_its_steady_state_says) {
  // Harmonic balance of a standing rotor is another solver of the same equations, in one step.
  io::Case input = lee("baseline", with(mesh(true, 3, 2),
                                        {"shaft.speed=0", "gravity=9.81", "shaft.azimuth_deg=30"}));
  for (const bool stiff : {true, false}) {
    if (!stiff) input.turbine.tower.sections[0].stiffness *= 0.05;  // the tower leans
    const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
    analysis::Observer observer;
    const analysis::Trim trim = analysis::find_trim(system, {}, observer);
    for (const StaticMethod method : {StaticMethod::load, StaticMethod::arc_length}) {
      const StaticPath path = statics_of(system, 4, method);
      const Eigen::VectorXd expected = trim.solution.coefficients().col(0);
      const Eigen::VectorXd& found = path.states.back().z;
      BOOST_TEST(path.states.back().factor == 1.0);
      BOOST_TEST((found - expected).norm() < 1e-8 * expected.norm());
      BOOST_TEST_REQUIRE(path.held.size() == 2u);
      for (std::size_t i = 0; i < 2; ++i) {
        BOOST_TEST(path.held[i].name == trim.held[i].name);
        BOOST_TEST(std::abs(path.held[i].load - trim.held[i].load) < 1e-8 * path.load_level);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_tower_that_buckles_leans_the_same_way_by_both_methods) {
  // Euler's load of the tower, pi^2 EI / (4 l^2), is 0.7 of what it carries; the rotor's overhang
  // is the imperfection. There are more equilibria at the end: upright, and leaning forward.
  io::Case input = lee("baseline", with(mesh(true, 4, 2), {"shaft.speed=0", "gravity=9.81"}));
  model::SectionDefinition& section = input.turbine.tower.sections[0];
  section.stiffness *= 0.02;
  const double euler = pi * pi * section.stiffness(4, 4) / (4.0 * 27.0 * 27.0);
  const double weight = 9.81 * (6900.0 + 67.5772 * 2.0 * 8.42);  // and a third of the tower's own
  BOOST_TEST(euler < 0.9 * weight);
  const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
  const StaticPath by_load = statics_of(system, 10, StaticMethod::load);
  const StaticPath by_arc = statics_of(system, 4, StaticMethod::arc_length);
  const Eigen::VectorXd& leaning = by_arc.states.back().z;
  BOOST_TEST((by_load.states.back().z - leaning).norm() < 1e-7 * leaning.norm());
  BOOST_TEST(leaning(system.layout().tower_tip() + 2) > 0.5 * 27.0);  // downwind, as the overhang
}

BOOST_AUTO_TEST_CASE(the_foot_of_a_tower_carries_weight_and_wind) {
  io::Case input = lee("baseline", with(mesh(true, 3, 2), {"shaft.speed=0", "gravity=9.81"}));
  model::LoadDefinition wind = force_at(0.0, Vector3(0.0, 0.0, 300.0));
  wind.to = 1.0;
  wind.on_tower = true;
  model::LoadDefinition thrust = force_at(1.0, Vector3(0.0, 500.0, 9000.0));
  thrust.on_tower = true;
  thrust.moment = Vector3(4e3, 0.0, 0.0);
  input.turbine.loads = {wind, thrust};
  const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
  const StaticPath path = statics_of(system);
  const Vector6 root = path.states.back().z.segment<6>(system.layout().tower_root());
  const double weight = 9.81 * (67.5772 * (27.0 + 2.0 * 8.42) + 6900.0);
  const Vector3 expected(-weight, 500.0, 9000.0 + 300.0 * 27.0);
  BOOST_TEST((root.head<3>() - expected).norm() < 1e-9 * weight);
}

BOOST_AUTO_TEST_SUITE_END()
