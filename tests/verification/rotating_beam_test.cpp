// A single uniform beam, at rest and turning, by the modes of constant tangents: closed forms,
// published tables (R1-R4) and Ritz's method; the order of convergence.
#include <array>

#include <boost/test/unit_test.hpp>

#include "cases.hpp"
#include "record.hpp"
#include "ritz.hpp"

using namespace samara;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

/// By name: the two planes of bending must not have equal frequencies, for then any mixture of
/// them is a mode and has no such name.
std::vector<double> flap(const BeamCase& beam) {
  return frequencies(constant_modes_of(definition_of(beam)), "blade flap");
}

RitzBeam ritz_of(const BeamCase& beam, bool lag) {
  return {beam.length,     beam.hub_radius, beam.speed,      beam.mass,
          beam.inertia(0), beam.inertia(1), beam.inertia(2), beam.stiffness(lag ? 5 : 4)};
}

/// The cantilever's: cos(b) cosh(b) = -1, omega = b^2 sqrt(EI / (m l^4)).
constexpr std::array<double, 3> cantilever{3.5160152685, 22.0344915647, 61.6972144118};

/// The second frequencies of flap and lead-lag converge with slope 2 s from meshes of `first`
/// elements on, for s = 1, 2, 3.
void check_second_frequencies(const std::string& name, BeamCase beam, double exact_flap,
                              double exact_lag, const std::array<int, 3>& first) {
  const auto error = [](const std::vector<double>& found, double exact) {
    return std::abs(nearest(found, exact) / exact - 1.0);
  };
  for (const int order : {1, 2, 3}) {
    std::vector<std::pair<double, double>> flap_errors;
    std::vector<std::pair<double, double>> lag_errors;
    for (const int finer : {1, 2, 4}) {
      beam.order = order;
      beam.elements = finer * first[static_cast<std::size_t>(order - 1)];
      const analysis::ModeSet set = constant_modes_of(definition_of(beam));
      flap_errors.emplace_back(beam.elements, error(frequencies(set, "blade flap"), exact_flap));
      lag_errors.emplace_back(beam.elements, error(frequencies(set, "blade lead-lag"), exact_lag));
    }
    const std::string curve = "order " + std::to_string(order);
    const double slack = 0.08 * order;
    Convergence{name, "second flap frequency, relative", "elements"}.check(curve, -2.0 * order,
                                                                           slack, flap_errors);
    Convergence{name, "second lead-lag frequency, relative", "elements"}.check(curve, -2.0 * order,
                                                                               slack, lag_errors);
  }
}

/// The largest error of many, or that which is no number.
void keep_worst(double& worst, double error) {
  if (!(error <= worst)) worst = error;
}

}  // namespace

BOOST_AUTO_TEST_CASE(ritz_reproduces_the_cantilever_and_the_published_tables) {
  // The oracle first: against the closed form and R1, R2, all printed digits.
  RitzBeam beam;
  const std::vector<double> rest = ritz_frequencies(beam, false);
  for (std::size_t i = 0; i < 3; ++i) BOOST_TEST(rest[i] == cantilever[i], tolerance(1e-9));
  beam.speed = 12.0;
  const std::vector<double> fast = ritz_frequencies(beam, false);
  BOOST_TEST(fast[0] == 13.1702, tolerance(5e-6));
  BOOST_TEST(fast[1] == 37.6031, tolerance(5e-6));
  BOOST_TEST(fast[2] == 79.615, tolerance(1e-5));
  beam.hub_radius = 0.1;
  const std::vector<double> away = ritz_frequencies(beam, false);
  BOOST_TEST(away[0] == 13.96920, tolerance(1e-6));
  BOOST_TEST(away[1] == 39.18289, tolerance(1e-6));
  BOOST_TEST(away[2] == 81.75091, tolerance(1e-6));
}

BOOST_AUTO_TEST_CASE(cantilever_at_rest_bends_at_its_closed_form) {
  // 16 elements of order 3: error of the third mode some (61.7 / 22)^3.5 of the second's, 1e-8.
  BeamCase beam;
  beam.elements = 16;
  beam.stiffness(5) = 2.0;
  const analysis::ModeSet set = constant_modes_of(definition_of(beam));
  BOOST_TEST(set.degrees_of_freedom == 2 * 48);
  for (const auto& [label, factor] :
       {std::pair{"blade flap", 1.0}, std::pair{"blade lead-lag", std::sqrt(2.0)}}) {
    const std::vector<double> found = frequencies(set, label);
    BOOST_REQUIRE(found.size() == 48U);
    for (std::size_t i = 0; i < 3; ++i)
      BOOST_TEST(found[i] == factor * cantilever[i], tolerance(1e-6));
  }
}

BOOST_AUTO_TEST_CASE(cantilever_errors_are_those_of_the_weak_form) {
  // docs/theory.md, section 2.2: relative errors of the first two bending modes of this weak form,
  // found by another program and printed to two digits, which leaves 5 % of a figure.
  struct Row {
    int order, elements;
    double first, second;
  };
  for (const Row& row :
       {Row{1, 4, 2.0e-2, 2.9e-1}, Row{1, 8, 4.9e-3, 6.3e-2}, Row{2, 4, 1.3e-4, 4.9e-3},
        Row{3, 2, 6.8e-6, 2.8e-3}, Row{3, 4, 1.1e-7, 5.1e-5}}) {
    BeamCase beam;
    beam.stiffness(5) = 2.0;
    beam.order = row.order;
    beam.elements = row.elements;
    const std::vector<double> found = flap(beam);
    BOOST_TEST(std::abs(found[0] / cantilever[0] - 1.0) == row.first, tolerance(0.06));
    BOOST_TEST(std::abs(found[1] / cantilever[1] - 1.0) == row.second, tolerance(0.06));
  }
}

BOOST_AUTO_TEST_CASE(cantilever_converges_with_slope_two_s) {
  // Meshes on which the second mode's error is between 1e-1 and 1e-8, where the slope shows.
  const Convergence page{"R1", "second flap frequency at rest, relative", "elements"};
  for (const auto& [order, first] : {std::pair{1, 16}, std::pair{2, 4}, std::pair{3, 3}}) {
    std::vector<std::pair<double, double>> errors;
    for (const int elements : {first, 2 * first, 4 * first}) {
      BeamCase beam;
      beam.stiffness(5) = 2.0;
      beam.order = order;
      beam.elements = elements;
      errors.emplace_back(elements, std::abs(flap(beam)[1] / cantilever[1] - 1.0));
    }
    page.check("order " + std::to_string(order), -2.0 * order, 0.06 * order, errors);
  }
}

BOOST_AUTO_TEST_CASE(turning_beam_converges_with_slope_two_s) {
  BeamCase beam;
  beam.speed = 6.0;
  beam.hub_radius = 0.1;
  beam.inertia = Vector3(3e-3, 1e-3, 2e-3);  // torsion stays rigid: it would couple with flap
  check_second_frequencies("R2", beam, ritz_frequencies(ritz_of(beam, false), false)[1],
                           ritz_frequencies(ritz_of(beam, true), true)[1], {16, 4, 3});
}

BOOST_AUTO_TEST_CASE(torsion_of_the_lowest_order_has_the_box_formula) {
  // (2 N / l) tan((2 j - 1) pi / (4 N)) sqrt(GJ / I1), exact for s = 1 at rest.
  BeamCase beam;
  beam.length = 3.0;
  beam.inertia = Vector3(0.7, 0.3, 0.4);
  beam.stiffness << 0.0, 0.0, 0.0, 11.0, 1e5, 1e5;
  beam.order = 1;
  for (const int elements : {1, 2, 5, 12}) {
    beam.elements = elements;
    const std::vector<double> found =
        frequencies(constant_modes_of(definition_of(beam)), "blade torsion");
    BOOST_REQUIRE(found.size() == static_cast<std::size_t>(elements));
    for (int j = 1; j <= elements; ++j) {
      const double wanted = 2.0 * elements / beam.length *
                            std::tan((2 * j - 1) * pi / (4.0 * elements)) * std::sqrt(11.0 / 0.7);
      BOOST_TEST(found[static_cast<std::size_t>(j - 1)] == wanted, tolerance(1e-9));
    }
  }
}

BOOST_AUTO_TEST_CASE(torsion_of_a_turning_blade_is_stiffened_by_its_flatness) {
  // I1 omega^2 = GJ (pi / 2 l)^2 + (I3 - I2) Omega^2: the tennis-racket effect.
  BeamCase beam;
  beam.length = 3.0;
  beam.speed = 2.5;
  beam.inertia = Vector3(0.7, 0.1, 0.6);
  beam.stiffness << 0.0, 0.0, 0.0, 11.0, 0.0, 0.0;  // rigid in bending
  const double wanted = std::sqrt(11.0 / 0.7 * std::pow(pi / 6.0, 2) + 0.5 / 0.7 * 6.25);
  const std::vector<double> found =
      frequencies(constant_modes_of(definition_of(beam)), "blade torsion");
  BOOST_TEST(found[0] == wanted, tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(r1_turning_beam_of_wright) {
  // Wright et al. (1982), hub radius 0, to 1e-4; and Ritz to 1e-6.
  struct Row {
    double speed;
    std::vector<double> flap;
  };
  const std::vector<Row> rows{{0.0, {3.5160, 22.0345, 61.697}},
                              {1.0, {3.6816}},
                              {2.0, {4.1373, 22.6149, 62.273}},
                              {3.0, {4.7973}},
                              {4.0, {5.5850}},
                              {5.0, {6.4495}},
                              {6.0, {7.3604, 26.8091, 66.684}},
                              {12.0, {13.1702, 37.6031, 79.615}}};
  for (const Row& row : rows) {
    BeamCase beam;
    beam.speed = row.speed;
    beam.stiffness(5) = 2.0;
    beam.elements = 16;
    const std::vector<double> found = flap(beam);
    const std::vector<double> exact = ritz_frequencies(ritz_of(beam, false), false);
    for (std::size_t i = 0; i < row.flap.size(); ++i)
      Figures{"R1", "Wright et al. (1982)", "16 elements of order 3"}.check_relative(
          "flap " + std::to_string(i + 1) + ", Omega " + in_short(row.speed), found[i], row.flap[i],
          1e-4);
    for (std::size_t i = 0; i < 3; ++i) BOOST_TEST(found[i] == exact[i], tolerance(1e-6));
  }
}

BOOST_AUTO_TEST_CASE(lead_lag_is_flap_less_the_speed) {
  // omega_lag^2 = omega_flap^2 - Omega^2 for equal stiffness and no rotary inertia, on any mesh:
  // the terms that differ are those of the mass alone.
  for (const auto& [order, elements] : {std::pair{1, 6}, std::pair{2, 3}, std::pair{3, 8}}) {
    double worst = 0.0;
    for (const double speed : {1.0, 3.0, 12.0}) {
      BeamCase beam;
      beam.speed = speed;
      beam.hub_radius = 0.1;
      beam.order = order;
      beam.elements = elements;
      const analysis::ModeSet set = constant_modes_of(definition_of(beam));
      const std::vector<double> out = frequencies(set, "blade flap");
      const std::vector<double> in = frequencies(set, "blade lead-lag");
      // The fastest pairs differ by less than round-off, and bend any way.
      const std::vector<double> any = frequencies(set, "blade bending");
      BOOST_REQUIRE(out.size() == in.size());
      BOOST_REQUIRE(out.size() >= 3U);
      BOOST_TEST(out.size() + in.size() + any.size() ==
                 2 * static_cast<std::size_t>(order * elements));
      for (std::size_t i = 0; i < 3; ++i)
        keep_worst(worst, std::abs(in[i] * in[i] / (out[i] * out[i] - speed * speed) - 1.0));
    }
    Figures{"R1", "an identity", mesh_name(elements, order)}.check_absolute(
        "omega_lag^2 / (omega_flap^2 - Omega^2) - 1, largest", worst, 0.0, 1e-8);
  }
}

BOOST_AUTO_TEST_CASE(r2_beam_on_a_hub) {
  for (const auto& [speed, wanted] : {std::pair{6.0, std::array{7.72603, 27.37965, 67.34620}},
                                      std::pair{12.0, std::array{13.96920, 39.18289, 81.75091}}}) {
    BeamCase beam;
    beam.speed = speed;
    beam.hub_radius = 0.1;
    beam.elements = 16;
    const std::vector<double> found = flap(beam);
    for (std::size_t i = 0; i < 3; ++i)
      Figures{"R2", "known figures, which Ritz's method confirms to all digits",
              "16 elements of order 3"}
          .check_relative("flap " + std::to_string(i + 1) + ", Omega " + in_short(speed), found[i],
                          wanted[i], 1e-6);
  }
}

BOOST_AUTO_TEST_CASE(r3_string_limit) {
  // omega = Omega sqrt(k (2 k - 1)). A clamp adds a boundary layer of length l sqrt(2 e),
  // e = EI / (m Omega^2 l^4), and its energy omega_1 / Omega - 1 = 3 / (2 sqrt 2) sqrt(e) + O(e):
  // 1.0607 (1.07 has been found numerically). The layer is 0.014 long at e = 1e-4,
  // an element of order 3 0.031.
  std::vector<double> rates;
  std::vector<std::pair<double, double>> excess_of_first;
  for (const double e : {4e-4, 1e-4, 2.5e-5}) {
    BeamCase beam;
    beam.speed = 1.0;
    beam.stiffness(4) = e;
    beam.stiffness(5) = 2.0 * e;
    beam.elements = 32;
    const std::vector<double> found = flap(beam);
    for (int k = 1; k <= 3; ++k) {
      const double string = std::sqrt(k * (2.0 * k - 1.0));
      const double excess = found[static_cast<std::size_t>(k - 1)] / string - 1.0;
      BOOST_TEST(excess > 0.0);
      BOOST_TEST(excess < 2.0 * k * std::sqrt(e));  // vanishes as the layer does
    }
    rates.push_back((found[0] - 1.0) / std::sqrt(e));
    excess_of_first.emplace_back(e, found[0] - 1.0);
  }
  Figures{"R3", "energy of the boundary layer at the clamp, in closed form",
          "32 elements of order 3"}
      .check_relative("(omega_1 / Omega - 1) / sqrt(e), e to 0", 2.0 * rates[1] - rates[0],
                      1.5 / std::sqrt(2.0), 2e-3);
  Convergence{"R3", "first frequency against the string's, relative", "e = EI / (m Omega^2 L^4)"}
      .check("clamped", 0.5, 0.02, excess_of_first);
}

BOOST_AUTO_TEST_CASE(r3_hinged_rotor_flaps_once_a_revolution) {
  // A rotor that teeters at the shaft's axis tilts as a plane at exactly 1/rev, whatever the
  // stiffness, in any mesh: it turns on in its tilted plane. So does a hub that is a flat disc,
  // I2 = I1 + I3, without which one coordinate had no mass at all.
  for (const auto& [order, elements] : {std::pair{1, 5}, std::pair{3, 4}}) {
    for (const double stiffness : {1e-2, 1.0, 50.0}) {
      const Figures page{"R3", "once a revolution", mesh_name(elements, order)};
      const std::string what = ", EI " + in_short(stiffness);
      BeamCase beam;
      beam.speed = 1.7;
      beam.stiffness(4) = stiffness;
      beam.stiffness(5) = 1.3 * stiffness;
      beam.order = order;
      beam.elements = elements;
      model::TurbineDefinition definition = definition_of(beam);
      definition.blades.count = 2;
      definition.hub.inertia = Vector3(0.01, 0.02, 0.01);
      definition.hub.teeter.kind = model::JointKind::free;
      const analysis::ModeSet set = constant_modes_of(definition);
      page.check_relative("teeter, constant tangents" + what,
                          nearest(frequencies(set, "teeter"), 1.7), 1.7, 1e-9);
      const analysis::Floquet floquet = floquet_of(definition, 100);
      page.check_relative("teeter, Floquet, 100 steps" + what,
                          nearest(frequencies(floquet.set, "teeter"), 1.7), 1.7, 1e-9);
    }
  }
}

BOOST_AUTO_TEST_CASE(r4_beam_that_stretches_and_shears) {
  BeamCase beam;
  beam.length = 10.0;
  beam.inertia = Vector3(2e-4, 1e-4, 1e-4);
  beam.stiffness << 1e8, 4e7, 4e7, 8e3, 1e4, 1e4;
  beam.elements = 12;
  ShearBeam exact{10.0, 0.0, 1.0, 2e-4, 1e-4, 1e-4, 1e8, 4e7, 8e3, 1e4};
  // BeamDyn, one element of order 12, to 1e-4: Ritz, another formulation than either, differs from
  // its first edge mode by 1.8e-5 and from this program by 2e-6 at most.
  struct Row {
    double speed;
    std::array<double, 3> edge, flap;
  };
  for (const Row& row : {Row{6.0, {4.26292, 26.1274, 66.4042}, {7.36022, 26.8075, 66.6747}},
                         Row{12.0, {5.42599, 35.6345, 78.6940}, {13.16989, 37.6010, 79.6038}}}) {
    beam.speed = row.speed;
    exact.speed = row.speed;
    const analysis::ModeSet set = constant_modes_of(definition_of(beam));
    BOOST_TEST(set.degrees_of_freedom == 6 * 36);
    const std::vector<double> edge = frequencies(set, "blade lead-lag");
    const std::vector<double> out = frequencies(set, "blade flap");
    const std::vector<double> exact_edge = shear_beam_frequencies(exact, true);
    const std::vector<double> exact_flap = shear_beam_frequencies(exact, false);
    const std::string mesh = "12 elements of order 3";
    const Figures other{"R4", "BeamDyn, one element of order 12", mesh};
    const Figures own{"R4", "Ritz's method with stretch, shear and rotary inertia", mesh};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string what = " " + std::to_string(i + 1) + ", Omega " + in_short(row.speed);
      other.check_relative("lead-lag" + what, nearest(edge, row.edge[i]), row.edge[i], 1e-4);
      other.check_relative("flap" + what, nearest(out, row.flap[i]), row.flap[i], 1e-4);
      own.check_relative("lead-lag" + what, nearest(edge, exact_edge[i]), exact_edge[i], 2e-6);
      own.check_relative("flap" + what, nearest(out, exact_flap[i]), exact_flap[i], 2e-6);
    }
  }
}

BOOST_AUTO_TEST_CASE(r4_converges_with_slope_two_s) {
  BeamCase beam;
  beam.length = 10.0;
  beam.speed = 6.0;
  beam.inertia = Vector3(2e-4, 1e-4, 1e-4);
  beam.stiffness << 1e8, 4e7, 4e7, 8e3, 1e4, 1e4;
  const ShearBeam ritz{10.0, 6.0, 1.0, 2e-4, 1e-4, 1e-4, 1e8, 4e7, 8e3, 1e4};
  check_second_frequencies("R4", beam, shear_beam_frequencies(ritz, false)[1],
                           shear_beam_frequencies(ritz, true)[1], {8, 4, 2});
}

BOOST_AUTO_TEST_CASE(modes_of_a_beam_with_all_strains_elastic_are_resolved) {
  // The lowest frequencies sit beside those of shear and stretch, 1e5 times as high: `resolved`
  // asks for 1e-6.
  BeamCase beam;
  beam.length = 10.0;
  beam.speed = 6.0;
  beam.inertia = Vector3(2e-4, 1e-4, 1e-4);
  beam.stiffness << 1e8, 4e7, 4e7, 8e3, 1e4, 1e4;
  for (const int elements : {4, 8, 16}) {
    beam.elements = elements;
    const analysis::ModeSet set = constant_modes_of(definition_of(beam));
    for (std::size_t i = 0; i < 6; ++i)
      BOOST_TEST(set.modes[i].resolved, elements << " elements, " << set.modes[i].exponent.imag()
                                                 << " residual " << set.modes[i].residual);
  }
}

BOOST_AUTO_TEST_CASE(beam_of_soft_section_agrees_with_ritz_in_all_its_couplings) {
  // Stretch of some per cent, shear that matters, and gyroscopic coupling of flap and twist.
  BeamCase beam;
  beam.speed = 3.0;
  beam.inertia = Vector3(0.05, 0.03, 0.01);
  beam.stiffness << 60.0, 40.0, 40.0, 2.0, 1.0, 1.0;
  beam.elements = 8;
  beam.order = 5;
  const ShearBeam soft{1.0, 3.0, 1.0, 0.05, 0.03, 0.01, 60.0, 40.0, 2.0, 1.0};
  const std::vector<double> found = frequencies(constant_modes_of(definition_of(beam)));
  for (const bool lag : {false, true}) {
    const std::vector<double> exact = shear_beam_frequencies(soft, lag);
    for (std::size_t i = 0; i < 5; ++i)
      BOOST_TEST(nearest(found, exact[i]) == exact[i], tolerance(1e-8));
  }
}

BOOST_AUTO_TEST_CASE(uniform_damping_gives_half_of_mu_omega) {
  // Section force F + mu F_dot with one mu: every mode at rest has lambda^2 + mu w^2 lambda + w^2
  // = 0, w that of the undamped mesh. Overdamped ones become real.
  constexpr double mu = 0.01;
  BeamCase beam;
  beam.order = 2;
  beam.elements = 4;
  beam.stiffness(5) = 2.0;
  const std::vector<double> undamped = frequencies(constant_modes_of(definition_of(beam)));
  BOOST_REQUIRE(undamped.size() == 16U);
  beam.damping << 0.0, 0.0, 0.0, 0.0, mu, mu;
  const analysis::ModeSet set = constant_modes_of(definition_of(beam));
  BOOST_TEST(set.degrees_of_freedom == 16);
  for (const double w : undamped) {
    const Complex root = std::sqrt(Complex(0.25 * mu * mu * std::pow(w, 4) - w * w, 0.0));
    const Complex wanted = -0.5 * mu * w * w + root;
    double distance = std::numeric_limits<double>::infinity();
    for (const analysis::Mode& mode : set.modes)
      distance = std::min(distance, std::abs(mode.exponent - wanted));
    BOOST_TEST(distance < 1e-8 * std::abs(wanted), "undamped " << w << " wanted " << wanted);
  }
}
