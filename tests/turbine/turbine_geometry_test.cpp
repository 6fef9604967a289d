// Places of a turbine's nodes: their rates are the velocities of the equations of motion.
#include "samara/turbine/turbine_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "sample_turbine.hpp"

namespace {

using namespace samara;
using turbine::TurbineGeometry;
using Poses = std::vector<elements::Pose<double>>;

/// Differences of fourth order over steps of 1e-3 with rates of some ten per second.
constexpr double difference_tolerance = 1e-7;
constexpr double time_step = 1e-3;

/// Components in n1 n2 n3 of a vector in x y z.
Vector3 inertial(const Vector3& ground) { return {-ground(1), ground(0), ground(2)}; }

/// A moderate state whose velocities are the rates of its positions.
sample::RandomState moving_state(const turbine::TurbineSystem& system, double t, unsigned seed) {
  sample::RandomState state = sample::random_state(system, seed);
  state.z *= 0.3;
  const std::vector<system::Unknown>& unknowns = system.unknowns();
  const std::vector<system::RowRole>& rows = system.rows();
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    if (unknowns[i].role != system::UnknownRole::position)
      state.z_dot(static_cast<Eigen::Index>(i)) = 0.0;
  // Joints that do not move freely stay where they are prescribed: their rows are constraints.
  const Eigen::VectorXd reference = sample::reference_state_of(system, t);
  constexpr double step = 1e-5;
  const Eigen::VectorXd later = sample::reference_state_of(system, t + step);
  const Eigen::VectorXd before = sample::reference_state_of(system, t - step);
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (rows[i] != system::RowRole::constraint || unknowns[i].owner.kind != system::PartKind::joint)
      continue;
    state.z(at) = reference(at);
    state.z_dot(at) = (later(at) - before(at)) / (2.0 * step);
  }
  // Kinematic rows are linear in the velocities; the other columns stay out.
  const auto kinematic = [&](Eigen::VectorXd r) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (rows[i] != system::RowRole::kinematic) r(static_cast<Eigen::Index>(i)) = 0.0;
    return r;
  };
  Eigen::MatrixXd K = sample::tangents_of(system, t, state.z, state.z_dot).K;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (rows[i] != system::RowRole::kinematic) K.row(at).setZero();
    if (unknowns[i].role != system::UnknownRole::velocity) K.col(at).setZero();
  }
  const Eigen::VectorXd r = kinematic(sample::residual_of(system, t, state.z, state.z_dot));
  state.z -= K.completeOrthogonalDecomposition().solve(r);
  const Eigen::VectorXd left = kinematic(sample::residual_of(system, t, state.z, state.z_dot));
  BOOST_REQUIRE(left.cwiseAbs().maxCoeff() < 1e-9);
  return state;
}

/// Poses a time `dt` after t, with constant rates.
Poses poses_after(const TurbineGeometry& geometry, const sample::RandomState& state, double t,
                  double dt) {
  return geometry.poses(t + dt, state.z + dt * state.z_dot);
}

/// Compares small motions about a random state with central differences.
void compare_small_motions(const model::TurbineDefinition& definition) {
  constexpr double t = 0.21;
  constexpr double step = 1e-5;
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  const TurbineGeometry geometry(system);
  const Eigen::VectorXd z = 0.3 * sample::random_state(system, 3).z;
  const Eigen::VectorXd re = sample::random_state(system, 4).z;
  const Eigen::VectorXd im = sample::random_state(system, 5).z;
  const Eigen::MatrixXcd motions =
      TurbineGeometry::Motions(geometry, t, z)
          .of(re.cast<std::complex<double>>() + std::complex<double>(0.0, 1.0) * im);
  const Poses now = geometry.poses(t, z);
  const auto compare = [&](const Eigen::VectorXd& way, const Eigen::MatrixXd& expected) {
    const Poses ahead = geometry.poses(t, z + step * way);
    const Poses behind = geometry.poses(t, z - step * way);
    const double scale = expected.cwiseAbs().maxCoeff();
    for (std::size_t i = 0; i < now.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const Vector3 moved = (ahead[i].place - behind[i].place) / (2.0 * step);
      const Matrix3 spin =
          (ahead[i].axes - behind[i].axes) * now[i].axes.transpose() / (2.0 * step);
      const Vector3 turned(spin(2, 1), spin(0, 2), spin(1, 0));
      // The error of central differences is of the order of the square of the step.
      BOOST_TEST((moved - expected.col(at).head<3>()).norm() < 1e-7 * scale);
      BOOST_TEST((turned - expected.col(at).tail<3>()).norm() < 1e-7 * scale);
    }
  };
  compare(re, motions.real());
  compare(im, motions.imag());
}

}  // namespace

BOOST_AUTO_TEST_SUITE(turbine_geometry)

BOOST_AUTO_TEST_CASE(places_move_with_the_velocities_of_the_equations_of_motion) {
  constexpr double t = 0.37;
  for (const sample::Choice& choice : sample::choices()) {
    const turbine::TurbineSystem system(model::build_turbine(sample::turbine_definition(choice)),
                                        PETSC_COMM_SELF);
    const TurbineGeometry geometry(system);
    const sample::RandomState state = moving_state(system, t, 7);
    const Poses now = geometry.poses(t, state.z);
    const Poses ahead = poses_after(geometry, state, t, time_step);
    const Poses behind = poses_after(geometry, state, t, -time_step);
    const Poses far_ahead = poses_after(geometry, state, t, 2.0 * time_step);
    const Poses far_behind = poses_after(geometry, state, t, -2.0 * time_step);
    std::size_t seen = 0;
    const turbine::TurbineLayout& layout = system.layout();
    const auto compare = [&](std::size_t i, int first) {
      const auto rate = [&](const auto& value) {
        return ((8.0 * (value(ahead[i]) - value(behind[i])) -
                 (value(far_ahead[i]) - value(far_behind[i]))) /
                (12.0 * time_step))
            .eval();
      };
      const Vector3 velocity = rate([](const auto& pose) { return pose.place; });
      const Matrix3 turning = rate([](const auto& pose) { return pose.axes; });
      const Matrix3 spin = now[i].axes.transpose() * turning;
      const Vector3 omega(spin(2, 1), spin(0, 2), spin(1, 0));
      const Vector3 own = now[i].axes.transpose() * velocity;
      const Vector3 V = state.z.segment<3>(first + 6);
      const Vector3 Omega = state.z.segment<3>(first + 9);
      BOOST_TEST((own - V).norm() < difference_tolerance * (1.0 + V.norm()));
      BOOST_TEST((omega - Omega).norm() < difference_tolerance * (1.0 + Omega.norm()));
      ++seen;
    };
    // Gauss points of all beams: their velocities are in the axes of their nodes.
    const auto first_of = [&](const std::string& part) {
      const auto& nodes = geometry.nodes();
      return static_cast<std::size_t>(
          std::find_if(nodes.begin(), nodes.end(),
                       [&](const turbine::GeometryNode& node) { return node.part == part; }) -
          nodes.begin());
    };
    for (std::size_t k = 0; k < layout.beams().size(); ++k) {
      const components::PlacedBeam& beam = layout.beams()[k];
      const std::size_t first = first_of(beam.beam->name);
      BOOST_REQUIRE(first < geometry.nodes().size());
      for (std::size_t p = 0; p < beam.points.size(); ++p) compare(first + 1 + p, beam.points[p]);
    }
    BOOST_TEST(seen > 3U);
  }
}

BOOST_AUTO_TEST_CASE(small_motions_are_the_differences_of_places_and_axes) {
  std::vector<model::TurbineDefinition> definitions;
  for (const sample::Choice& choice : sample::choices())
    definitions.push_back(sample::turbine_definition(choice));
  // Actuators turn the blades about their pitch axes.
  definitions.push_back(definitions.front());
  definitions.back().blades.actuator = model::PitchActuatorDefinition{6.0, 0.7};
  for (const model::TurbineDefinition& definition : definitions) compare_small_motions(definition);
}

BOOST_AUTO_TEST_CASE(an_undeformed_turbine_has_its_lengths) {
  const sample::Choice choice{3, 2, true, true, false, true, false};
  const model::TurbineDefinition definition = sample::turbine_definition(choice);
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  const TurbineGeometry geometry(system);
  const Poses poses = geometry.poses(0.0, sample::reference_state_of(system, 0.0));
  double total = 0.0;
  for (const std::array<int, 2>& line : geometry.lines())
    total += (poses[static_cast<std::size_t>(line[1])].place -
              poses[static_cast<std::size_t>(line[0])].place)
                 .norm();
  const double expected = definition.tower.length + definition.shaft.height +
                          definition.shaft.overhang + std::abs(definition.hub.undersling) +
                          3.0 * (definition.hub.radius + definition.blades.beam.length);
  BOOST_TEST(std::abs(total - expected) < 1e-12 * expected);
  // Above its foot stands the tower; the shaft points against the wind of a rotor upwind.
  const Vector3 top = inertial(poses[definition.tower.elements * 2U + 1U].place);
  BOOST_TEST(top(2) > 0.0);
}

BOOST_AUTO_TEST_SUITE_END()
