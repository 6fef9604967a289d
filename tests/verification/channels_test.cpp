// Channels: frames and signs by statics, reactions by the momentum of all that moves.
#include <array>
#include <cmath>
#include <map>

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"
#include "samara/turbine/turbine_channels.hpp"

#include "../turbine/bodies.hpp"
#include "time_series.hpp"

using namespace samara;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

using Values = std::map<std::string, double>;

/// The last sample of a short time series from the undeformed state, and its channels.
struct Instant {
  double t = 0.0;
  Eigen::VectorXd z;
  Eigen::VectorXd z_dot;
  Values values;
};

Values channels_at(const turbine::TurbineSystem& system, const Instant& instant) {
  const petsc::Handle<Vec> z = sample::to_petsc(system, instant.z);
  const petsc::Handle<Vec> z_dot = sample::to_petsc(system, instant.z_dot);
  const turbine::TurbineChannels channels(system, {}, {});
  std::vector<double> numbers(channels.channels().size());
  channels.evaluate(instant.t, z.get(), z_dot.get(), numbers);
  Values values;
  for (std::size_t i = 0; i < numbers.size(); ++i) values[channels.channels()[i].name] = numbers[i];
  return values;
}

Instant moving(const turbine::TurbineSystem& system) {
  Instant instant;
  Keeper<double> keeper([&](const analysis::TransientSample& sample) {
    instant.t = sample.t;
    instant.z = values_of(sample.z);
    instant.z_dot = values_of(sample.z_dot);
    return 0.0;
  });
  analysis::run_transient(system, analysis::start_undeformed(system, 0.3),
                          steps_of(1e-3, 0.02, analysis::TransientMethod::bdf2), keeper);
  instant.values = channels_at(system, instant);
  return instant;
}

/// A turbine that stands still, by the statics of its trim.
Values resting(const std::string& text) {
  const io::Case input = io::parse_case("test", text, {});
  const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::TransientStart start =
      analysis::start_on(system, analysis::find_trim(system, {}, observer), 0.0);
  return channels_at(system, {0.0, start.z, start.z_dot, {}});
}

/// Two massless stiff blades on a rigid tower: what weighs is what the keys add.
const char frame_of_a_turbine[] = R"(samara: 1
gravity: 10
tower:
  length: 20
  elements: 1
  sections:
    - mass: 1e-9
      inertia: [1e-9, 5e-10, 5e-10]
      stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: 1e15, EI2: 1e15, EI3: 1e15}
blades:
  count: 2
  length: 10
  elements: 1
  sections:
    - mass: 1e-9
      inertia: [1e-9, 5e-10, 5e-10]
      stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: 1e15, EI2: 1e15, EI3: 1e15}
)";

/// Force and moment about the origin that hold what moves: -d/dt of momentum less gravity, of the
/// pieces that `choose` takes. Momenta by plain geometry, differenced along the path (order 4).
template <class Choose>
Vector6 load_of(const model::TurbineDefinition& constant, const turbine::TurbineSystem& system,
                const Instant& instant, const Choose& choose) {
  // The definition with the pitch, speed and azimuth of an instant.
  const auto at_instant = [&](double t) {
    model::TurbineDefinition definition = constant;
    const math::TimeCurve::Value turning = system.turbine().turning_at(t);
    definition.blades.pitch = system.turbine().pitch_at(0, t).value;
    definition.shaft.speed = turning.rate;
    definition.shaft.azimuth = turning.value - turning.rate * t;
    return definition;
  };
  const model::TurbineDefinition definition = at_instant(instant.t);
  const auto momentum = [&](double offset) {
    const sample::Bodies bodies =
        sample::bodies_at(at_instant(instant.t + offset), system, instant.t + offset,
                          Eigen::VectorXd(instant.z + offset * instant.z_dot));
    Vector6 sum = Vector6::Zero();
    for (const sample::Piece& piece : bodies.pieces) {
      if (!choose(piece)) continue;
      sum.head<3>() += piece.momentum;
      sum.tail<3>() += piece.moment_of_momentum;
    }
    return sum;
  };
  constexpr double h = 2e-4;
  Vector6 load =
      -(8.0 * (momentum(h) - momentum(-h)) - (momentum(2.0 * h) - momentum(-2.0 * h))) / (12.0 * h);
  const sample::Bodies now = sample::bodies_at(definition, system, instant.t, instant.z);
  for (const sample::Piece& piece : now.pieces) {
    if (!choose(piece)) continue;
    const Vector3 weight(0.0, 0.0, -definition.gravity * piece.mass);
    load.head<3>() += weight;
    load.tail<3>() += piece.center.cross(weight);
  }
  return load;
}

Vector3 three(const Values& values, const std::string& start, const std::string& end) {
  return 1e3 * Vector3(values.at(start + "x" + end), values.at(start + "y" + end),
                       values.at(start + "z" + end));
}

}  // namespace

namespace {

/// Tower-base and root loads are those that momenta and weights ask for, to `small` of all forces.
void check_reactions(const model::TurbineDefinition& definition,
                     const turbine::TurbineSystem& system, double small) {
  const Instant instant = moving(system);
  const auto all = [](const sample::Piece&) { return true; };
  Vector6 whole = load_of(definition, system, instant, all);
  model::TurbineDefinition now = definition;
  const math::TimeCurve::Value turning = system.turbine().turning_at(instant.t);
  now.blades.pitch = system.turbine().pitch_at(0, instant.t).value;
  now.shaft.speed = turning.rate;
  now.shaft.azimuth = turning.value - turning.rate * instant.t;
  const sample::Bodies bodies = sample::bodies_at(now, system, instant.t, instant.z);
  whole.tail<3>() += definition.shaft.rotor.torque * bodies.R_H.col(1);
  const double force_level = whole.head<3>().norm();
  const double moment_level = force_level * definition.tower.length;
  if (definition.has_tower) {
    const Vector3 force = three(instant.values, "TwrBsF", "t");
    const Vector3 moment = three(instant.values, "TwrBsM", "t");
    BOOST_TEST((force - Vector3(whole(1), -whole(0), whole(2))).norm() < small * force_level);
    BOOST_TEST((moment - Vector3(whole(4), -whole(3), whole(5))).norm() < small * moment_level);
  }
  for (int k = 0; k < definition.blades.count; ++k) {
    const auto own = [k](const sample::Piece& piece) { return piece.blade == k; };
    const Vector6 load = load_of(definition, system, instant, own);
    const Matrix3& axes = bodies.axes[static_cast<std::size_t>(k)];
    const Vector3 arm = bodies.roots[static_cast<std::size_t>(k)];
    const Vector3 force = axes.transpose() * load.head<3>();
    const Vector3 moment = axes.transpose() * (load.tail<3>() - arm.cross(load.head<3>()));
    const std::string n = std::to_string(k + 1);
    const Values& v = instant.values;
    const Vector3 root_force(v.at("RootFxb" + n), v.at("RootFyb" + n), v.at("RootFzc" + n));
    const Vector3 root_moment(v.at("RootMxb" + n), v.at("RootMyb" + n), v.at("RootMzc" + n));
    BOOST_TEST((1e3 * root_force - Vector3(force(2), -force(1), force(0))).norm() <
               small * force_level);
    BOOST_TEST((1e3 * root_moment - Vector3(moment(2), -moment(1), moment(0))).norm() <
               small * moment_level);
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(reactions_are_what_all_applied_and_inertial_forces_ask_for) {
  for (const sample::Choice& choice : sample::choices()) {
    model::TurbineDefinition definition = sample::turbine_definition(choice);
    definition.shaft.rotor.slope = 0.0;
    const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
    // Rates of prescribed joints are exact in the equations, and BDF2's in the path.
    check_reactions(definition, system, choice.prescribed ? 1e-4 : 1e-9);
  }
}

BOOST_AUTO_TEST_CASE(reactions_follow_blades_that_pitch_and_a_rotor_that_speeds_up) {
  for (const sample::Choice& choice : sample::choices()) {
    if (choice.prescribed) continue;
    model::TurbineDefinition definition = sample::turbine_definition(choice);
    definition.shaft.rotor.slope = 0.0;
    if (definition.shaft.generator.kind == model::JointKind::free) continue;
    model::Turbine turbine = model::build_turbine(definition);
    turbine.operation.pitch.assign(turbine.blades.size(),
                                   math::TimeCurve::formula("0.2 + 0.3*sin(4*t)"));
    turbine.operation.turning.emplace(math::TimeCurve::formula("3 + 2*t - cos(3*t)"), 1.0);
    const turbine::TurbineSystem system(turbine, PETSC_COMM_SELF);
    check_reactions(definition, system, 1e-8);
    BOOST_TEST(sample::tangent_error(system, 0.4, sample::random_state(system, 8)) < 1e-10);
  }
}

BOOST_AUTO_TEST_CASE(nacelle_that_is_heavy_behind_the_yaw_axis_tips_the_tower_about_its_own_y) {
  // x downwind, y = z x x: a weight m g at d on x has the moment +m g d about y.
  const Values v = resting(std::string(frame_of_a_turbine) +
                           "nacelle: {mass: 1000, center_of_mass: [0, 3, 0], inertia: [1, 1, 1], "
                           "yaw: {joint: prescribed, angle_deg: 30}}\n");
  const double mgd = 30.0;  // kN m
  BOOST_TEST(v.at("YawBrFzp") == -10.0, tolerance(1e-6));
  BOOST_TEST(v.at("YawBrMyn") == mgd, tolerance(1e-6));
  BOOST_TEST(std::abs(v.at("YawBrMxn")) < 1e-6);
  BOOST_TEST(v.at("YawBrMyp") == mgd * std::cos(pi / 6.0), tolerance(1e-6));
  BOOST_TEST(v.at("YawBrMxp") == -mgd * 0.5, tolerance(1e-6));
  BOOST_TEST(v.at("TwrBsMyt") == mgd * std::cos(pi / 6.0), tolerance(1e-6));
  BOOST_TEST(v.at("TwrBsMxt") == -mgd * 0.5, tolerance(1e-6));
  BOOST_TEST(v.at("TwrBsFzt") == -10.0, tolerance(1e-6));
  BOOST_TEST(v.at("NacYaw") == 30.0, tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(shaft_axes_turn_with_the_azimuth_and_bearing_axes_do_not) {
  const Values v = resting(std::string(frame_of_a_turbine) +
                           "shaft: {azimuth_deg: 90, tilt_deg: 20}\n"
                           "hub: {mass: 1000, center_of_mass: 2, inertia: [1, 1, 1]}\n");
  const double weight = 10.0;  // kN
  const double across = weight * std::cos(pi / 9.0);
  const double along = -weight * std::sin(pi / 9.0);  // the downwind end is up
  BOOST_TEST(v.at("Azimuth") == 90.0, tolerance(1e-12));
  BOOST_TEST(v.at("RotThrust") == along, tolerance(1e-6));
  BOOST_TEST(v.at("LSShftFzs") == -across, tolerance(1e-6));
  BOOST_TEST(std::abs(v.at("LSShftFys")) < 1e-6);
  // za has turned from up to -ys, ya from ys to up.
  BOOST_TEST(v.at("LSShftFya") == -across, tolerance(1e-6));
  BOOST_TEST(std::abs(v.at("LSShftFza")) < 1e-6);
  BOOST_TEST(v.at("LSSTipMys") == 2.0 * across, tolerance(1e-6));
  BOOST_TEST(v.at("LSSTipMza") == -2.0 * across, tolerance(1e-6));
}

BOOST_AUTO_TEST_CASE(blade_that_points_up_or_sideways_loads_its_root_by_its_weight) {
  const std::string heavy = "hub: {radius: 1}\n";
  const io::Case input =
      io::parse_case("test", std::string(frame_of_a_turbine) + "shaft: {azimuth_deg: 90}\n" + heavy,
                     {"blades.tip_mass=100", "blades.pitch_deg=30"});
  const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::TransientStart start =
      analysis::start_on(system, analysis::find_trim(system, {}, observer), 0.0);
  const Values v = channels_at(system, {0.0, start.z, start.z_dot, {}});
  // Blade 1 lies toward n1 = -y; its leading edge points down, so that yc, to the trailing edge,
  // is up: the weight pulls along -yc, and its moment z x (-y) L is about +xc.
  const double weight = 1.0;  // kN
  BOOST_TEST(v.at("RootFyc1") == -weight, tolerance(1e-6));
  BOOST_TEST(v.at("RootMxc1") == 10.0 * weight, tolerance(1e-6));
  BOOST_TEST(std::abs(v.at("RootFxc1")) < 1e-6);
  BOOST_TEST(std::abs(v.at("RootFzc1")) < 1e-6);
  // Blade 2 on the other side goes up.
  BOOST_TEST(v.at("RootFyc2") == weight, tolerance(1e-6));
  // Pitch turns the leading edge upwind: xb tips toward +yc, yb toward -xc.
  BOOST_TEST(v.at("BldPitch1") == 30.0, tolerance(1e-12));
  BOOST_TEST(v.at("RootFyb1") == -weight * std::cos(pi / 6.0), tolerance(1e-6));
  BOOST_TEST(std::abs(v.at("RootFxb1")) == weight * 0.5, tolerance(1e-6));
  // The torque of both on the shaft cancels.
  BOOST_TEST(std::abs(v.at("RotTorq")) < 1e-6);
}

BOOST_AUTO_TEST_CASE(section_channels_stand_at_their_stations_and_unknown_names_are_refused) {
  const io::Case input =
      io::parse_case("test", std::string(frame_of_a_turbine) + "shaft: {azimuth_deg: 0}\n",
                     {"blades.tip_mass=100", "blades.elements=3", "blades.order=2"});
  const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::TransientStart start =
      analysis::start_on(system, analysis::find_trim(system, {}, observer), 0.0);
  turbine::ChannelStations stations;
  stations.blade = {0.0, 0.5, 1.0};
  const turbine::TurbineChannels channels(system, stations, {"B1N1FLz", "B1N2FLz", "B2N3FLz"});
  std::array<double, 3> values{};
  const petsc::Handle<Vec> z = sample::to_petsc(system, start.z);
  const petsc::Handle<Vec> z_dot = sample::to_petsc(system, start.z_dot);
  channels.evaluate(0.0, z.get(), z_dot.get(), values);
  BOOST_TEST(values[0] == -1.0, tolerance(1e-6));
  BOOST_TEST(values[1] == -1.0, tolerance(1e-6));
  BOOST_TEST(values[2] == 1.0, tolerance(1e-6));
  const auto suggests = [](const InputError& error) {
    return std::string(error.what()).find("did you mean \"TwrBsMyt\"") != std::string::npos;
  };
  BOOST_CHECK_EXCEPTION(turbine::TurbineChannels(system, {}, {"TwrBsMty"}), InputError, suggests);
}

BOOST_AUTO_TEST_CASE(root_moment_converges_with_the_order_of_the_element) {
  // A coned blade that turns and bends back into the plane of rotation: its root carries what the
  // centrifugal forces along the bent line leave, an integral that each mesh sums in its own way.
  for (const int order : {1, 2}) {
    std::vector<double> moments;
    for (const int elements : {2, 4, 8, 16}) {
      BeamCase beam;
      beam.length = 10.0;
      beam.speed = 6.0;
      beam.stiffness << 0.0, 0.0, 0.0, 8e3, 1e4, 1e4;
      beam.inertia = Vector3(2e-4, 1e-4, 1e-4);
      beam.elements = elements;
      beam.order = order;
      model::TurbineDefinition definition = definition_of(beam);
      definition.blades.precone = 0.1;
      const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
      analysis::Observer observer;
      const analysis::TransientStart start =
          analysis::start_on(system, analysis::find_trim(system, {}, observer), 0.0);
      const Instant instant{0.0, start.z, start.z_dot, {}};
      moments.push_back(1e3 * channels_at(system, instant).at("RootMyb1"));
      // On every mesh it is the sum of that mesh's forces.
      const Vector6 load =
          load_of(definition, system, instant, [](const sample::Piece&) { return true; });
      const Matrix3 axes = sample::bodies_at(definition, system, 0.0, start.z).axes[0];
      const double sum = -(axes.transpose() * load.tail<3>())(1);
      BOOST_TEST(moments.back() == sum, tolerance(1e-9));
    }
    const double expected = order == 1 ? 2.0 : 4.0;
    const double coarse = std::abs(moments[0] - moments[1]);
    const double middle = std::abs(moments[1] - moments[2]);
    const double fine = std::abs(moments[2] - moments[3]);
    BOOST_TEST_MESSAGE("order " << order << ": " << moments[3] << " N m, slopes "
                                << std::log2(coarse / middle) << " " << std::log2(middle / fine));
    BOOST_TEST(std::log2(middle / fine) == expected, tolerance(0.15));
  }
}
