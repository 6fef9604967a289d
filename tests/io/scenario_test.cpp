// A definition that is built in C++ is the one that a file with the same figures gives.
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"
#include "samara/io/case.hpp"
#include "samara/model/turbine.hpp"
#include "samara/simulation/validation.hpp"

using namespace samara;

namespace {

/// Damping ratios, masses out of order, a matrix with print's asymmetry, no set point.
const std::string text = R"(samara: 1
shaft:
  speed: 6
  gear_ratio: 20
  generator: {joint: free, own_inertia: 0.5, torque: 30}
  rotor: {torque: 900, torque_pitch_slope: -400}
hub: {mass: 100, inertia: [10, 20, 10], radius: 1}
controller:
  speed_filter: 2
  pitch: {proportional: 0.01, integral: 0.002}
blades:
  count: 2
  length: 10
  elements: 5
  damping: {flap: 0.02, lead_lag: 0.01}
  point_masses:
    - {at: 0.8, mass: 3}
    - {at: 0.4, mass: 5}
  sections:
    - mass: 8
      inertia: [0.2, 0.1, 0.1]
      stiffness_matrix:
        - [1e8, 0, 0, 0, 0, 1000.0000000001]
        - [0, 1e7, 0, 0, 0, 0]
        - [0, 0, 1e7, 0, 0, 0]
        - [0, 0, 0, 1e5, 0, 0]
        - [0, 0, 0, 0, 2e5, 0]
        - [1000, 0, 0, 0, 0, 4e5]
transient: {duration: 2, step: 0.02, start: undeformed}
)";

simulation::Scenario built() {
  simulation::Scenario scenario;
  model::TurbineDefinition& turbine = scenario.turbine;
  turbine.shaft.speed = 6.0;
  turbine.shaft.gear_ratio = 20.0;
  turbine.shaft.generator.kind = model::JointKind::free;
  turbine.shaft.generator.inertia = 0.5;
  turbine.shaft.generator.law.torque = 30.0;
  turbine.shaft.rotor.torque = 900.0;
  turbine.shaft.rotor_pitch_slope = -400.0;
  turbine.hub.mass = 100.0;
  turbine.hub.inertia = Vector3(10.0, 20.0, 10.0);
  turbine.hub.radius = 1.0;
  model::ControllerDefinition& controller = turbine.controller.emplace();
  controller.filter = 2.0;
  controller.pitch = {0.01, 0.002};
  turbine.blades.count = 2;
  model::BeamDefinition& blade = turbine.blades.beam;
  blade.length = 10.0;
  blade.elements = 5;
  blade.modal_damping = {0.02, 0.01, {}};
  model::PointMassDefinition outer;
  outer.at = 0.8;
  outer.mass = 3.0;
  model::PointMassDefinition inner;
  inner.at = 0.4;
  inner.mass = 5.0;
  blade.point_masses = {outer, inner};
  model::SectionDefinition section;
  section.stiffness.diagonal() << 1e8, 1e7, 1e7, 1e5, 2e5, 4e5;
  section.stiffness(0, 5) = 1000.0000000001;
  section.stiffness(5, 0) = 1000.0;
  section.mass.diagonal() << 8.0, 8.0, 8.0, 0.2, 0.1, 0.1;
  blade.sections = {section};
  scenario.transient.options.duration = 2.0;
  scenario.transient.options.step = 0.02;
  scenario.transient.start = simulation::TransientOrigin::undeformed;
  return scenario;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(scenarios)

BOOST_AUTO_TEST_CASE(a_file_and_a_program_state_the_same_turbine) {
  const io::Case read = io::parse_case("case.yaml", text, {});
  model::TurbineDefinition turbine = built().turbine;
  BOOST_TEST(!(turbine == read.turbine));
  BOOST_TEST(model::complete(turbine).empty());
  BOOST_TEST((turbine == read.turbine));
  BOOST_TEST(turbine.blades.beam.damping(4) > 0.0);
  BOOST_TEST(*turbine.controller->set_point == 120.0);
  const model::TurbineDefinition once = turbine;
  BOOST_TEST(model::complete(turbine).empty());
  BOOST_TEST((turbine == once));  // nothing is left to be found
  const model::Turbine from_file = model::build_turbine(read.turbine);
  const model::Turbine from_program = model::build_turbine(built().turbine);
  for (std::size_t p = 0; p < from_file.blades[0].points.size(); ++p)
    BOOST_TEST(from_program.blades[0].points[p].damping == from_file.blades[0].points[p].damping);
}

BOOST_AUTO_TEST_CASE(both_are_refused_with_the_same_words) {
  struct Change {
    std::vector<std::string> settings;
    void (*apply)(model::TurbineDefinition&);
  };
  const std::vector<Change> changes{
      {{"blades.count=3", "hub.teeter={joint: free}"},
       [](model::TurbineDefinition& t) {
         t.blades.count = 3;
         t.hub.teeter.kind = model::JointKind::free;
       }},
      {{"shaft.gear_ratio=0"}, [](model::TurbineDefinition& t) { t.shaft.gear_ratio = 0.0; }},
      {{"shaft.rotor.torque_pitch_slope=0"},
       [](model::TurbineDefinition& t) { t.shaft.rotor_pitch_slope = 0.0; }},
      {{"controller.set_point=100"},
       [](model::TurbineDefinition& t) { t.controller->set_point = 100.0; }},
      {{"blades.sections.0.stiffness_matrix.3.3=-1"},
       [](model::TurbineDefinition& t) { t.blades.beam.sections[0].stiffness(3, 3) = -1.0; }},
      {{"blades.hinges=[{axis: lag, joint: free, offset: 2}]"},
       [](model::TurbineDefinition& t) {
         model::HingeDefinition hinge;
         hinge.axis = model::HingeAxis::lag;
         hinge.joint.kind = model::JointKind::free;
         hinge.offset = 2.0;
         t.blades.hinges = {hinge};
       }},
      {{"loads=[{beam: tower, at: 1, force: [1, 0, 0]}]"}, [](model::TurbineDefinition& t) {
         model::LoadDefinition load;
         load.on_tower = true;
         t.loads = {load};
       }}};
  for (const Change& change : changes) {
    simulation::Scenario scenario = built();
    change.apply(scenario.turbine);
    const std::vector<Fault> faults = simulation::validate(scenario, simulation::Analysis::check);
    BOOST_TEST_REQUIRE(faults.size() == 1U);
    BOOST_CHECK_EXCEPTION(io::parse_case("case.yaml", text, change.settings), InputError,
                          [&](const InputError& error) {
                            const std::string words = error.what();
                            BOOST_TEST_MESSAGE(words);
                            return words.find(faults[0].text) != std::string::npos &&
                                   words.find('\n') == std::string::npos;
                          });
  }
}

BOOST_AUTO_TEST_CASE(faults_of_an_analysis_have_places) {
  const io::Case read = io::parse_case("case.yaml", text, {"gravity=0"});
  BOOST_CHECK_EXCEPTION(
      io::require_valid(read, simulation::validate(read, simulation::Analysis::statics)),
      InputError, [](const InputError& error) {
        return std::string(error.what()).starts_with("case.yaml:3:3: shaft.speed: must be 0");
      });
}

BOOST_AUTO_TEST_SUITE_END()
