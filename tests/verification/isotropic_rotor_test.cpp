// Rotors of different numbers of blades with the same mass and stiffness in all: what does not see
// the single blade is the same.
#include <boost/test/unit_test.hpp>

#include "cases.hpp"

using namespace samara;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

/// `count` blades that share the mass and the stiffness of one rotor.
model::TurbineDefinition shared_among(int count, double speed) {
  BeamCase beam;
  beam.length = 3.0;
  beam.hub_radius = 0.3;
  beam.speed = speed;
  beam.mass = 12.0 / count;
  beam.inertia = Vector3(0.3, 0.1, 0.2) / count;
  beam.stiffness << 0.0, 0.0, 0.0, 300.0, 2e3, 3e3;
  beam.stiffness /= count;
  beam.elements = 2;
  beam.order = 2;
  model::TurbineDefinition definition = definition_of(beam);
  definition.blades.count = count;
  definition.hub.inertia = Vector3(2.0, 3.0, 2.0);
  definition.shaft.torsion = {model::JointKind::free, 900.0, 0.0};
  definition.shaft.generator.inertia = 4.0;
  return definition;
}

model::TurbineDefinition on_a_tower(model::TurbineDefinition definition) {
  model::SectionDefinition tower;
  tower.rigid = {true, true, true, false, false, false};
  tower.stiffness.diagonal() << 0.0, 0.0, 0.0, 4e4, 6e4, 8e4;
  tower.mass.diagonal() << 9.0, 9.0, 9.0, 0.4, 0.2, 0.2;
  definition.has_tower = true;
  definition.tower.length = 8.0;
  definition.tower.elements = 2;
  definition.tower.order = 2;
  definition.tower.sections = {tower};
  definition.has_nacelle = true;
  definition.nacelle.mass = 20.0;
  definition.nacelle.inertia = Vector3(5.0, 4.0, 6.0);
  definition.shaft.overhang = 0.8;
  return definition;
}

}  // namespace

BOOST_AUTO_TEST_CASE(collective_modes_do_not_count_the_blades) {
  // On a hub that only the shaft's torsion lets move, the modes that move it are collective.
  for (const double speed : {0.0, 6.0}) {
    std::vector<double> reference;
    for (const int count : {2, 3, 4, 5}) {
      const std::vector<double> all = frequencies(constant_modes_of(shared_among(count, speed)));
      if (reference.empty()) {
        reference = frequencies(constant_modes_of(shared_among(1, speed)));
        BOOST_REQUIRE(reference.size() == 13u);
      }
      BOOST_REQUIRE(all.size() == static_cast<std::size_t>(12 * count + 1));
      for (const double omega : reference)
        BOOST_TEST(nearest(all, omega) == omega, tolerance(1e-8));
    }
  }
}

BOOST_AUTO_TEST_CASE(three_four_and_five_blades_look_alike_from_the_tower) {
  // Isotropic rotors: collective and both cyclic motions are all that the tower sees. The same
  // number of steps, so that even the error of (19) is the same.
  const auto modes_of = [](int count) {
    return floquet_of(on_a_tower(shared_among(count, 6.0)), 600).set;
  };
  const analysis::ModeSet three = modes_of(3);
  const std::vector<analysis::ModeSet> others{modes_of(4), modes_of(5)};
  int seen = 0;
  for (const analysis::Mode& mode : three.modes) {
    if (!mode.resolved || mode.exponent.imag() > 60.0) continue;
    ++seen;
    for (const analysis::ModeSet& other : others) {
      double off = 1e9;
      for (const analysis::Mode& candidate : other.modes)
        off = std::min({off, std::abs(candidate.multiplier - mode.multiplier),
                        std::abs(std::conj(candidate.multiplier) - mode.multiplier)});
      BOOST_TEST(off < 1e-8, mode.label << " " << mode.exponent << " " << off);
    }
  }
  BOOST_TEST(seen >= 10);
}
