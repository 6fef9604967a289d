// Damping ratios of beams: mu found from a beam's own modes against the modes of the whole program.
#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"
#include "samara/model/beam_modes.hpp"

#include "cases.hpp"

using namespace samara;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

/// A blade that is clamped and at rest.
model::TurbineDefinition clamped(int elements, int order) {
  BeamCase beam;
  beam.length = 8.0;
  beam.mass = 12.0;
  beam.inertia = Vector3(0.9, 0.4, 0.5);
  beam.stiffness << 4e6, 2e6, 1e6, 3e4, 5e4, 2e5;
  beam.elements = elements;
  beam.order = order;
  return definition_of(beam);
}

/// Everything that couples: a curved line, twist, stiffness and mass couplings, masses on it.
model::TurbineDefinition coupled() {
  model::TurbineDefinition definition = clamped(5, 2);
  model::BeamDefinition& beam = definition.blades.beam;
  beam.reference_line = {Vector3::Zero(), Vector3(4.0, 0.1, 0.05), Vector3(8.0, 0.6, 0.4)};
  beam.length = model::compute_arc_length(beam.reference_line);
  model::SectionDefinition& root = beam.sections.front();
  root.stiffness(3, 4) = root.stiffness(4, 3) = 6e3;
  root.stiffness(0, 5) = root.stiffness(5, 0) = 1e5;
  root.mass(0, 5) = root.mass(5, 0) = -12.0 * 0.05;
  root.mass(2, 3) = root.mass(3, 2) = 12.0 * 0.05;
  root.twist = 0.2;
  model::SectionDefinition tip = root;
  tip.at = 1.0;
  tip.twist = -0.05;
  tip.mass *= 0.5;
  tip.stiffness *= 0.4;
  beam.sections.push_back(tip);
  beam.tip_mass = 3.0;
  beam.point_masses = {{0.37, 4.0, Vector3(0.0, 0.1, -0.2), Vector3(0.3, 0.2, 0.1)}};
  return definition;
}

const analysis::Mode& mode_of(const analysis::ModeSet& set, const std::string& label) {
  for (const analysis::Mode& mode : set.modes)
    if (mode.label == label) return mode;
  throw std::runtime_error("no mode " + label);
}

}  // namespace

BOOST_AUTO_TEST_CASE(modes_of_a_clamped_beam_are_those_of_the_program) {
  for (const model::TurbineDefinition& definition : {clamped(4, 1), clamped(3, 3), coupled()}) {
    const std::vector<double> whole = frequencies(constant_modes_of(definition));
    const std::vector<model::BeamMode> alone =
        model::compute_beam_modes(model::build_turbine(definition).blades.front());
    BOOST_TEST_REQUIRE(alone.size() == whole.size());
    for (std::size_t i = 0; i < 12; ++i)
      BOOST_TEST(alone[i].frequency == whole[i], tolerance(1e-7));
  }
}

BOOST_AUTO_TEST_CASE(first_modes_get_the_ratios_that_were_asked_for) {
  // Exactly, on every mesh, where nothing couples.
  for (const auto& [elements, order] : {std::pair{3, 1}, std::pair{4, 3}}) {
    model::TurbineDefinition definition = clamped(elements, order);
    model::BeamDefinition& beam = definition.blades.beam;
    beam.damping = model::fit_damping(model::build_beam("blade", beam), {0.03, 0.012, 0.05});
    const analysis::ModeSet set = constant_modes_of(definition);
    BOOST_TEST(mode_of(set, "1st blade flap").damping_ratio == 0.03, tolerance(1e-6));
    BOOST_TEST(mode_of(set, "1st blade lead-lag").damping_ratio == 0.012, tolerance(1e-6));
    BOOST_TEST(mode_of(set, "1st blade torsion").damping_ratio == 0.05, tolerance(1e-6));
  }
}

BOOST_AUTO_TEST_CASE(first_modes_of_a_coupled_beam_get_them_to_second_order) {
  std::vector<double> errors;
  for (const double size : {2.0, 0.5}) {
    model::TurbineDefinition definition = coupled();
    model::BeamDefinition& beam = definition.blades.beam;
    beam.damping = model::fit_damping(model::build_beam("blade", beam),
                                      {0.02 * size, 0.025 * size, 0.12 * size});
    const analysis::ModeSet set = constant_modes_of(definition);
    errors.push_back(
        std::abs(mode_of(set, "1st blade flap").damping_ratio / (0.02 * size) - 1.0) +
        std::abs(mode_of(set, "1st blade lead-lag").damping_ratio / (0.025 * size) - 1.0) +
        std::abs(mode_of(set, "1st blade torsion").damping_ratio / (0.12 * size) - 1.0));
  }
  BOOST_TEST(errors[0] < 1e-2);
  BOOST_TEST(errors[1] < 0.1 * errors[0]);  // 1/16
  // The first torsion mode bends, too: less than what it gets from that cannot be had.
  const model::Beam beam = model::build_beam("blade", coupled().blades.beam);
  BOOST_CHECK_THROW(model::fit_damping(beam, {0.02, 0.025, 0.001}), InputError);
}

BOOST_AUTO_TEST_CASE(a_round_beam_has_a_ratio_for_each_of_its_directions) {
  model::TurbineDefinition definition = clamped(4, 2);
  model::BeamDefinition& beam = definition.blades.beam;
  model::SectionDefinition& section = beam.sections.front();
  section.stiffness(4, 4) = section.stiffness(5, 5);
  section.stiffness(1, 1) = section.stiffness(2, 2);
  section.mass(4, 4) = section.mass(5, 5);
  const model::Beam built = model::build_beam("blade", beam);
  const Vector6 mu = model::fit_damping(built, {0.03, 0.012, {}});
  const std::vector<model::BeamMode> modes = model::compute_beam_modes(built);
  BOOST_TEST(modes[0].frequency == modes[1].frequency, tolerance(1e-9));
  BOOST_TEST(mu(4) == 0.06 / modes[0].frequency, tolerance(1e-9));
  BOOST_TEST(mu(5) == 0.024 / modes[0].frequency, tolerance(1e-9));
  BOOST_TEST(mu(3) == 0.0);
}
