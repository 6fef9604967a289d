// Rotations that count from a rotation of each element's own: the same mechanics in other numbers.
#include <memory>
#include <random>

#include <boost/test/unit_test.hpp>

#include "sample_turbine.hpp"

using namespace samara;

namespace {

struct Recounted {
  std::unique_ptr<system::PeriodicSystem> system;
  Eigen::VectorXd z;
};

/// The system that counts from `z`, and that state in its numbers.
Recounted recounted(const system::PeriodicSystem& system, const Eigen::VectorXd& z) {
  const petsc::Handle<Vec> state = sample::to_petsc(system, z);
  Recounted result;
  result.system = system.counted_from(state.get());
  result.z = sample::to_dense(state.get());
  return result;
}

/// A state whose blades have turned so far that counting anew pays.
Eigen::VectorXd far_turned(const system::PeriodicSystem& system, Eigen::VectorXd z) {
  for (Eigen::Index i = 0; i < z.size(); ++i)
    if (system.unknowns()[static_cast<std::size_t>(i)].role == system::UnknownRole::position)
      z(i) *= 4.0;
  return z;
}

/// A state of small rotations, and the system that counts from those of another one.
struct Sample {
  explicit Sample(const sample::Choice& choice)
      : system(model::build_turbine(sample::turbine_definition(choice)), PETSC_COMM_SELF),
        state(sample::random_state(system, 5)),
        counted(recounted(system, far_turned(system, sample::random_state(system, 6).z))) {
    for (Eigen::Index i = 0; i < state.z.size(); ++i)
      if (system.unknowns()[static_cast<std::size_t>(i)].role == system::UnknownRole::position)
        state.z(i) *= 0.1;
  }

  /// The random state as the recounted system has it, in two steps: its own numbers are those of
  /// `system` composed with the references.
  Eigen::VectorXd anew() const {
    const auto& target = dynamic_cast<const turbine::TurbineSystem&>(*counted.system);
    Eigen::VectorXd z = state.z;
    const auto rewrite = [&z](int first, const Matrix3& reference) {
      const Matrix3 attitude =
          math::direction_cosines<double>(Vector3(z.segment<3>(first + 3))).transpose();
      z.segment<3>(first + 3) = math::parameters_of(attitude * reference.transpose());
    };
    for (const components::PlacedBeam& placed : target.equations().beams()) {
      const model::Beam& beam = *placed.beam;
      for (int p = 0; p < beam.point_count(); ++p)
        rewrite(placed.points[static_cast<std::size_t>(p)], beam.reference(p / beam.order));
      for (std::size_t m = 0; m < placed.masses.size(); ++m)
        rewrite(placed.masses[m], beam.reference(beam.mass_nodes[m].end - 1));
      rewrite(placed.tip, beam.reference(beam.elements - 1));
    }
    return z;
  }

  turbine::TurbineSystem system;
  sample::RandomState state;
  Recounted counted;
};

constexpr double round_off = 1e-11;

}  // namespace

BOOST_AUTO_TEST_SUITE(turning)

BOOST_AUTO_TEST_CASE(small_rotations_keep_their_count) {
  const turbine::TurbineSystem system(model::build_turbine(sample::turbine_definition({})),
                                      PETSC_COMM_SELF);
  BOOST_TEST(!recounted(system, sample::random_state(system, 1).z).system);
}

BOOST_AUTO_TEST_CASE(counting_back_gives_the_state) {
  for (const sample::Choice& choice : sample::choices()) {
    const turbine::TurbineSystem system(model::build_turbine(sample::turbine_definition(choice)),
                                        PETSC_COMM_SELF);
    const Eigen::VectorXd z = far_turned(system, sample::random_state(system, 2).z);
    const Recounted first = recounted(system, z);
    BOOST_TEST_REQUIRE(bool(first.system));
    BOOST_TEST((first.z - z).cwiseAbs().maxCoeff() > 0.5);
    const petsc::Handle<Vec> state = sample::to_petsc(system, first.z);
    first.system->count_from_undeformed(state.get());
    BOOST_TEST((sample::to_dense(state.get()) - z).cwiseAbs().maxCoeff() < round_off);
  }
}

BOOST_AUTO_TEST_CASE(forces_momenta_and_strains_do_not_know_how_rotations_are_counted) {
  for (const sample::Choice& choice : sample::choices()) {
    const Sample sample(choice);
    BOOST_TEST_REQUIRE(bool(sample.counted.system));
    // At rest: rates of parameters are other numbers for the same motion.
    const Eigen::VectorXd still = Eigen::VectorXd::Zero(sample.system.size());
    const Eigen::VectorXd plain = sample::residual_of(sample.system, 0.4, sample.state.z, still);
    const Eigen::VectorXd anew =
        sample::residual_of(*sample.counted.system, 0.4, sample.anew(), still);
    Eigen::VectorXd difference = (anew - plain).cwiseAbs();
    double changed = 0.0;
    for (const components::PlacedBeam& placed : sample.system.equations().beams()) {
      std::vector<int> blocks = placed.points;
      blocks.insert(blocks.end(), placed.masses.begin(), placed.masses.end());
      blocks.push_back(placed.tip);
      for (const int first : blocks) {  // balances of curvature, in parameters
        changed = std::max(changed, difference.segment<3>(first + 3).maxCoeff());
        difference.segment<3>(first + 3).setZero();
      }
    }
    BOOST_TEST(difference.maxCoeff() < round_off * plain.cwiseAbs().maxCoeff());
    BOOST_TEST(changed > 1e-3);
  }
}

BOOST_AUTO_TEST_CASE(tangents_are_the_complex_step_with_any_references) {
  for (const sample::Choice& choice : sample::choices()) {
    const Sample sample(choice);
    const auto& system = dynamic_cast<const turbine::TurbineSystem&>(*sample.counted.system);
    const sample::RandomState state = sample::random_state(system, 7);
    BOOST_TEST(sample::tangent_error(system, 0.9, state) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(the_undeformed_state_is_one_in_any_count) {
  model::TurbineDefinition definition = sample::turbine_definition({3, 2, true, false, false});
  definition.gravity = 0.0;
  definition.shaft.speed = 0.0;
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  const Recounted counted =
      recounted(system, far_turned(system, sample::random_state(system, 8).z));
  const Eigen::VectorXd z = sample::reference_state_of(*counted.system, 0.0);
  BOOST_TEST(z.cwiseAbs().maxCoeff() > 0.5);
  const Eigen::VectorXd r =
      sample::residual_of(*counted.system, 0.0, z, Eigen::VectorXd::Zero(z.size()));
  BOOST_TEST(r.cwiseAbs().maxCoeff() < round_off);
}

BOOST_AUTO_TEST_SUITE_END()
