// The declared places of the tangents, against the tangents of turbines in which any quantity may
// be absent.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <set>

#include <boost/test/unit_test.hpp>

#include "sample_turbine.hpp"

using namespace samara;

namespace {

using Places = std::set<std::pair<PetscInt, PetscInt>>;

/// A shift beside which K is nothing, so that K + shift M has the places of M at its large entries.
constexpr double large_shift = 1e200;
constexpr double between = 1e100;

/// Places of at most this share beside those that states fill: they cost time in factorizations.
constexpr double largest_excess = 1.3;

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  bool one_in(int count) { return std::uniform_int_distribution<int>(1, count)(random_) == 1; }
  double any() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  /// Now and then none.
  double some(double value) { return one_in(3) ? 0.0 : value * (1.0 + 0.5 * any()); }

 private:
  std::minstd_rand random_;
};

void vary(model::BeamDefinition& beam, Draw& draw, bool can_hold_end) {
  const bool straight = draw.one_in(3);
  const bool round = draw.one_in(3);
  const bool no_rotary = draw.one_in(4);
  for (model::SectionDefinition& section : beam.sections) {
    if (straight) section.twist = 0.0;
    if (round) section.stiffness = Vector6(section.stiffness.diagonal()).asDiagonal();
    if (round) section.mass = sample::section_mass(2.0, 0.0, 0.0, Vector3(0.5, 0.2, 0.3));
    if (round && no_rotary && section.rigid[0]) {  // as ElastoDyn has it
      section.mass.bottomRightCorner<3, 3>().setZero();
      section.rigid[3] = true;
      section.stiffness(3, 3) = 0.0;
    }
  }
  beam.damping *= draw.one_in(3) ? 0.0 : 1.0;
  for (int i = 0; i < 6; ++i)
    if (draw.one_in(5) || beam.sections.front().rigid[static_cast<std::size_t>(i)])
      beam.damping(i) = 0.0;
  beam.mass_damping = Vector3(draw.some(0.1), draw.some(0.3), draw.some(0.2));
  beam.tip_mass = draw.some(0.7);
  if (draw.one_in(3))
    beam.point_masses = {{0.55, 0.6, Vector3(0.0, draw.some(0.1), 0.0), Vector3(0.1, 0.05, 0.08)}};
  if (!draw.one_in(3)) return;
  beam.support.rigid = {};
  beam.support.stiffness = sample::section_stiffness(Vector6::Constant(3e3), draw.some(0.1));
  beam.support.mass = 1.3;
  beam.support.center = Vector3(draw.some(0.1), draw.some(0.2), 0.0);
  beam.support.inertia = Vector3(0.3, 0.4, 0.5);
  beam.support.damping.setConstant(draw.some(0.02));
  beam.support.added_mass << 2.0, draw.some(3.0), 0.0, 0.5, 0.0, draw.some(0.2);
  if (!can_hold_end) return;
  beam.end_support.free[2] = false;
  beam.end_support.stiffness(2, 2) = 90.0;
  beam.end_support.free[4] = false;
  beam.end_support.stiffness(4, 4) = 70.0;
}

void add_mass_dampers(model::TurbineDefinition& d, Draw& draw) {
  using Carrier = model::MassDamperDefinition::Carrier;
  for (const Carrier carrier : {Carrier::blade, Carrier::nacelle, Carrier::tower}) {
    if (carrier != Carrier::blade && !d.has_tower) continue;
    model::MassDamperDefinition damper;
    damper.carrier = carrier;
    const model::BeamDefinition& beam = carrier == Carrier::tower ? d.tower : d.blades.beam;
    const bool is_held = carrier == Carrier::blade && !beam.end_support.is_none();
    damper.at = !is_held && draw.one_in(2)  ? 1.0
                : beam.point_masses.empty() ? 0.55
                                            : beam.point_masses.front().at;
    if (is_held && damper.at == 1.0) continue;
    damper.position = Vector3(draw.some(0.3), draw.some(0.2), draw.some(0.4));
    damper.mass = 1.5;
    const bool has_stops = draw.one_in(2);
    damper.axes.push_back({draw.one_in(2) ? 1 : 2, 30.0, draw.some(2.0), 0.0, 0.0, 0.0});
    if (has_stops) {
      damper.axes[0].stop = 0.01;
      damper.axes[0].stop_stiffness = 400.0;
      damper.axes[0].stop_damping = draw.some(3.0);
    }
    if (draw.one_in(2)) damper.axes.push_back({0, 50.0, 0.0, 0.0, 0.0, 0.0});
    d.mass_dampers.push_back(damper);
  }
}

void add_controls(model::TurbineDefinition& d, Draw& draw) {
  d.shaft.rotor_pitch_slope = draw.some(-40.0);
  if (draw.one_in(2)) {
    d.blades.actuator = {5.0, 0.7};
    if (draw.one_in(2)) d.blades.actuator->rate_limit = 0.1;
    if (draw.one_in(2)) d.blades.actuator->highest = 0.3;
  }
  if (d.shaft.generator.kind != model::JointKind::free) return;
  model::ControllerDefinition controller;
  controller.filter = 2.0;
  controller.set_point = d.shaft.generator_speed();
  if (draw.one_in(2)) controller.torque = {3.0, draw.some(2.0)};
  if (!controller.torque || draw.one_in(2)) controller.pitch = {0.1, 0.0};
  if (!controller.has_integral() && controller.pitch) controller.pitch->integral = draw.some(0.2);
  controller.schedule = draw.some(2.0);
  d.controller = controller;
}

/// An airfoil that stalls.
model::AirfoilDefinition airfoil() {
  model::PolarDefinition polar;
  constexpr int last = 90;
  for (int i = -last; i <= last; ++i) {
    const double angle =
        std::abs(i) == last ? std::copysign(std::numbers::pi, i) : i * std::numbers::pi / last;
    const double bump = std::exp(-std::pow(angle / 0.3, 2));
    polar.angles.push_back(angle);
    polar.lift.push_back(4.0 * (angle + 0.05) * bump + std::sin(2.0 * angle));
    polar.drag.push_back(0.01 + 1.2 * std::pow(std::sin(angle), 2));
    polar.moment.push_back(-0.2 * std::sin(angle) - 0.05 * bump);
  }
  polar.lift.back() = polar.lift.front();
  polar.moment.back() = polar.moment.front();
  model::AirfoilDefinition airfoil;
  airfoil.polars = {polar};
  return airfoil;
}

template <class Choice, std::size_t count>
Choice one_of(Draw& draw, const std::array<Choice, count>& choices) {
  std::size_t i = 0;
  while (i + 1 < count && !draw.one_in(static_cast<int>(count - i))) ++i;
  return choices[i];
}

void add_air(model::TurbineDefinition& d, Draw& draw) {
  using namespace elements;
  model::WindDefinition wind;
  wind.speed = draw.one_in(4) ? 0.0 : 6.0;
  wind.height = 4.0;
  wind.profile =
      one_of(draw, std::array{WindProfile::uniform, WindProfile::power, WindProfile::logarithmic});
  wind.exponent = 0.2;
  wind.roughness = 0.05;
  wind.shear_left = draw.some(0.1);
  wind.shear_length = 5.0;
  wind.direction = draw.one_in(3) ? 0.5 * std::numbers::pi : draw.some(0.5);  // also edgewise
  wind.veer = draw.some(0.02);
  wind.upflow = draw.some(0.2);
  if (d.has_tower && draw.one_in(3)) {  // random blades are inside the tower now and then
    wind.tower = model::TowerFlowDefinition{{0.0, 3.0}, {0.2, 0.1}, {0.6, 0.7}};
    wind.tower->potential = TowerPotential::none;
  }
  if (d.has_tower && draw.one_in(3))
    wind.nacelle = model::NacelleDragDefinition{{0.4, 0.2, 0.3}, {1.0, 0.8, 0.0}, {0.1, -0.2, 0.3}};
  d.wind = wind;
  model::AeroDefinition aero;
  aero.induction = one_of(draw, std::array{Induction::full, Induction::axial, Induction::none});
  aero.inflow =
      one_of(draw, std::array{Inflow::oye, Inflow::peters_he, Inflow::equilibrium, Inflow::frozen});
  if (draw.one_in(2)) aero.wake_shapes = {2, 1, 0, 1};
  aero.closure = one_of(draw, std::array{MomentumLoad::equilibrium, MomentumLoad::actual});
  aero.thrust = one_of(draw, std::array{ThrustLaw::glauert_skew, ThrustLaw::buhl, ThrustLaw::buhl_f,
                                        ThrustLaw::madsen});
  aero.dynamics =
      one_of(draw, std::array{AirfoilDynamics::hgm, AirfoilDynamics::oye, AirfoilDynamics::peters,
                              AirfoilDynamics::quasi_steady, AirfoilDynamics::static_polar});
  if (aero.dynamics == AirfoilDynamics::peters && aero.inflow == Inflow::oye)
    aero.inflow = Inflow::equilibrium;
  if (d.hub.radius == 0.0) aero.induction = Induction::none;
  aero.tau1 = 2.0;
  aero.added_mass = draw.one_in(3);
  d.aero = aero;
  d.blades.airfoils["A"] = airfoil();
  d.blades.aero_sections = {{0.0, 0.3, 0.2, "A", {0.02, 0.0}}, {1.0, 0.1, 0.0, "A", {}}};
}

model::TurbineDefinition random_turbine(unsigned seed) {
  Draw draw(seed);
  const std::vector<sample::Choice> choices = sample::choices();
  sample::Choice choice = choices[seed % choices.size()];
  choice.blades = 1 + static_cast<int>(seed % 5);
  if (choice.blades > 2) choice.teeter = false;
  model::TurbineDefinition d = sample::turbine_definition(choice);
  if (choice.blades > 2) d.hub.teeter.kind = model::JointKind::locked;
  d.gravity = draw.some(9.81);
  d.shaft.speed = draw.one_in(6) ? 0.0 : 3.0;
  d.shaft.azimuth = draw.some(0.7);
  d.shaft.overhang = draw.some(1.1);
  d.shaft.tilt = draw.some(0.15);
  d.shaft.height = draw.some(0.4);
  d.shaft.mass = draw.some(2.0);
  d.shaft.center_of_mass = draw.some(0.6);
  d.hub.radius = draw.some(0.35);
  d.hub.undersling = draw.some(-0.25);
  d.hub.center_of_mass = draw.some(0.2);
  d.hub.teeter.stiffness = draw.some(200.0);
  d.hub.teeter.damping = draw.some(10.0);
  d.nacelle.yaw.stiffness = draw.some(300.0);
  d.nacelle.yaw.damping = draw.some(20.0);
  d.nacelle.center_of_mass = Vector3(draw.some(0.1), draw.some(0.3), draw.some(0.4));
  if (d.nacelle.yaw.kind == model::JointKind::prescribed)
    d.nacelle.yaw.motion = {draw.some(0.5), draw.some(0.2), 2, 0.0, 0.7};
  d.blades.precone = draw.some(0.08);
  d.blades.pitch = draw.some(0.2);
  if (draw.one_in(4)) d.blades.each[1].pitch = 0.05;
  if (draw.one_in(4)) d.hub.teeter_stops = {0.02, 500.0, draw.some(5.0)};
  if (draw.one_in(4) && d.hub.teeter.kind != model::JointKind::free) d.hub.teeter_stops = {};
  if (draw.one_in(3)) d.shaft.rotor = {5.0, 0.0, {{0.0, 1.0}, {2.0, 1.0}, {6.0, 9.0}}};
  if (draw.one_in(3))
    d.shaft.generator = {model::JointKind::free, draw.some(1.5), {6.0, draw.some(4.0), {}}};
  if (draw.one_in(3)) d.shaft.torsion = {model::JointKind::free, 900.0, draw.some(7.0), {}};
  if (draw.one_in(3)) d.shaft.gear_ratio = -3.7;
  if (draw.one_in(3)) {
    for (const model::HingeAxis axis :
         {model::HingeAxis::flap, model::HingeAxis::pitch, model::HingeAxis::lag})
      if (!draw.one_in(4)) {
        model::HingeDefinition hinge;
        hinge.axis = axis;
        hinge.offset = draw.one_in(2) ? 0.0 : 0.2 * d.hub.radius;
        hinge.joint = {draw.one_in(5) ? model::JointKind::locked : model::JointKind::free,
                       draw.some(60.0),
                       draw.some(2.0),
                       {}};
        if (axis == model::HingeAxis::flap) hinge.delta3 = draw.some(0.3);
        d.blades.hinges.push_back(hinge);
      }
    d.blades.pitch_link = draw.some(0.4);
  }
  vary(d.tower, draw, false);
  vary(d.blades.beam, draw, true);
  if (draw.one_in(3)) add_mass_dampers(d, draw);
  if (draw.one_in(3)) add_controls(d, draw);
  if (draw.one_in(2)) {
    model::LoadDefinition load;
    load.from = draw.one_in(2) ? 1.0 : 0.2;
    load.force = Vector3(draw.some(1.0), draw.some(2.0), draw.some(3.0));
    load.moment = Vector3(draw.some(1.0), 0.0, draw.some(3.0));
    load.follower = !draw.one_in(3);
    load.variation.amplitude = draw.some(1.0);
    load.variation.per_rev = 1;
    d.loads = {load};
  }
  if (draw.one_in(2)) add_air(d, draw);
  return d;
}

/// Motions of the blades and other changes in time, without any value at t = 0.
void operate(model::Turbine& turbine, Draw& draw) {
  const math::TimeCurve curve = math::TimeCurve::through({{0.0, 0.0}, {1.0, 0.0}, {2.0, 0.3}});
  if (draw.one_in(4)) turbine.operation.pitch.assign(turbine.blades.size(), curve);
  if (draw.one_in(4) && !turbine.chain.yaw.free) turbine.operation.yaw = curve;
  if (draw.one_in(4) && !turbine.chain.teeter.free) turbine.operation.teeter = curve;
  if (draw.one_in(4) && !turbine.chain.generator.free)
    turbine.operation.turning = math::IntegratedCurve(curve, 2.0);
  if (draw.one_in(3) && turbine.chain.generator.free) turbine.chain.brake_torque = 4.0;
}

Places to_places(const std::vector<std::vector<PetscInt>>& rows) {
  Places places;
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (const PetscInt j : rows[i]) places.emplace(static_cast<PetscInt>(i), j);
  return places;
}

/// Places of entries larger than `above`.
void collect(Mat matrix, double above, Places& places) {
  const Eigen::MatrixXd values = sample::to_dense(matrix);
  BOOST_TEST(values.allFinite());
  for (Eigen::Index j = 0; j < values.cols(); ++j)
    for (Eigen::Index i = 0; i < values.rows(); ++i)
      if (std::abs(values(i, j)) > above)
        places.emplace(static_cast<PetscInt>(i), static_cast<PetscInt>(j));
}

/// Stored places, whatever is in them.
Places stored_places(Mat matrix) {
  Places places;
  PetscInt rows = 0;
  petsc::check(MatGetSize(matrix, &rows, nullptr));
  for (PetscInt i = 0; i < rows; ++i) {
    PetscInt count = 0;
    const PetscInt* columns = nullptr;
    petsc::check(MatGetRow(matrix, i, &count, &columns, nullptr));
    for (PetscInt c = 0; c < count; ++c) places.emplace(i, columns[c]);
    petsc::check(MatRestoreRow(matrix, i, &count, &columns, nullptr));
  }
  return places;
}

struct FoundPlaces {
  Places K, M;
};

/// Entries that the tangents fill at some states and times, from the undeformed one on.
FoundPlaces fill(const turbine::TurbineSystem& system) {
  FoundPlaces found;
  const petsc::Handle<Mat> jacobian = system.make_jacobian();
  for (unsigned trial = 0; trial < 4; ++trial) {
    const double t = trial == 0 ? 0.0 : 0.31 + 0.83 * trial;
    sample::RandomState state = sample::random_state(system, trial + 1);
    if (trial == 0) state = {sample::reference_state_of(system, t), 0.0 * state.z_dot};
    const petsc::Handle<Vec> z = sample::to_petsc(system, state.z);
    const petsc::Handle<Vec> z_dot = sample::to_petsc(system, state.z_dot);
    system.tangents(t, z.get(), z_dot.get(), 0.0, jacobian.get(), nullptr);
    collect(jacobian.get(), 0.0, found.K);
    system.tangents(t, z.get(), z_dot.get(), large_shift, jacobian.get(), nullptr);
    collect(jacobian.get(), between, found.M);
  }
  return found;
}

/// The first place of `inner` that `outer` lacks, in words; empty where there is none.
std::string find_outside(const Places& inner, const Places& outer,
                         const system::PeriodicSystem& system) {
  for (const auto& [i, j] : inner)
    if (outer.count({i, j}) == 0)
      return "row of " + system.unknowns()[static_cast<std::size_t>(i)].name() + ", column of " +
             system.unknowns()[static_cast<std::size_t>(j)].name();
  return "";
}

/// Returns the number of places declared, and of those that states fill.
std::pair<double, double> check_pattern(const turbine::TurbineSystem& system) {
  const FoundPlaces found = fill(system);
  const Places declared = to_places(system.pattern());
  const Places mass = stored_places(system.make_mass().get());
  BOOST_TEST(find_outside(found.K, declared, system) == "");
  BOOST_TEST(find_outside(found.M, mass, system) == "");
  BOOST_TEST(find_outside(mass, declared, system) == "");
  // A derivative whose place is not declared is missing in the tangents.
  BOOST_TEST(sample::tangent_error(system, 1.7, sample::random_state(system, 11)) < 1e-11);
  std::vector<bool> has_rate(static_cast<std::size_t>(system.size()), false);
  for (const auto& [i, j] : found.M) has_rate[static_cast<std::size_t>(j)] = true;
  for (std::size_t i = 0; i < has_rate.size(); ++i)
    BOOST_TEST(system.differential()[i] == has_rate[i], system.unknowns()[i].name());
  Places filled = found.K;
  filled.insert(found.M.begin(), found.M.end());
  return {static_cast<double>(declared.size()), static_cast<double>(filled.size())};
}

/// Owners of the unknowns in two pieces of about equal size: blocks that many others refer to are
/// shared, and so is the later one of two coupled blocks of unlike pieces.
std::vector<int> owners_of(const turbine::TurbineSystem& system) {
  constexpr PetscInt block = turbine::TurbineLayout::block;
  constexpr std::size_t many = 8;
  const std::vector<std::vector<PetscInt>> rows = system.pattern();
  std::set<std::pair<PetscInt, PetscInt>> coupled;
  std::vector<std::set<PetscInt>> users(rows.size() / block);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (const PetscInt j : rows[i]) {
      const auto row = static_cast<PetscInt>(i) / block;
      coupled.insert({std::min(row, j / block), std::max(row, j / block)});
      users[static_cast<std::size_t>(j / block)].insert(row);
    }
  std::vector<int> of_blocks;
  for (std::size_t b = 0; b < users.size(); ++b)
    of_blocks.push_back(users[b].size() > many ? system::PeriodicSystem::shared
                                               : static_cast<int>(2 * b / users.size()));
  for (const PetscInt i : system.common_unknowns())
    of_blocks[static_cast<std::size_t>(i / block)] = system::PeriodicSystem::shared;
  for (const auto& [one, other] : coupled) {
    const int first = of_blocks[static_cast<std::size_t>(one)];
    int& second = of_blocks[static_cast<std::size_t>(other)];
    if (first >= 0 && second >= 0 && first != second) second = system::PeriodicSystem::shared;
  }
  std::vector<int> owners;
  for (std::size_t i = 0; i < rows.size(); ++i) owners.push_back(of_blocks[i / block]);
  return owners;
}

/// The state as a rank has it: unknowns of other ranks are no numbers.
sample::RandomState state_of(const sample::RandomState& all, const std::vector<int>& owners,
                             int rank) {
  sample::RandomState own = all;
  for (Eigen::Index i = 0; i < own.z.size(); ++i) {
    const int owner = owners[static_cast<std::size_t>(i)];
    if (owner == system::PeriodicSystem::shared || owner == rank) continue;
    own.z(i) = std::nan("");
    own.z_dot(i) = std::nan("");
  }
  return own;
}

double largest_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

}  // namespace

BOOST_AUTO_TEST_SUITE(turbine_pattern)

BOOST_AUTO_TEST_CASE(parts_of_any_turbine_add_up_to_it) {
  int divided = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    model::Turbine turbine = model::build_turbine(random_turbine(seed));
    Draw draw(seed + 1000);
    operate(turbine, draw);
    const turbine::TurbineSystem system(turbine, PETSC_COMM_SELF);
    const std::vector<int> owners = owners_of(system);
    const sample::RandomState state = sample::random_state(system, seed + 1);
    Eigen::VectorXd r = Eigen::VectorXd::Zero(system.size());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(system.size(), system.size());
    Eigen::MatrixXd M = K;
    for (int rank = 0; rank < 2; ++rank) {
      const std::unique_ptr<system::PeriodicSystem> part = system.part_of(rank, owners);
      BOOST_TEST_REQUIRE(bool(part));
      const sample::RandomState own = state_of(state, owners, rank);
      r += sample::residual_of(*part, 1.7, own.z, own.z_dot);
      const sample::Tangents tangents = sample::tangents_of(*part, 1.7, own.z, own.z_dot);
      K += tangents.K;
      M += tangents.M;
    }
    const sample::Tangents whole = sample::tangents_of(system, 1.7, state.z, state.z_dot);
    BOOST_TEST_CONTEXT("seed " << seed) {
      BOOST_TEST(largest_difference(r, sample::residual_of(system, 1.7, state.z, state.z_dot)) <
                 1e-13);
      BOOST_TEST(largest_difference(K, whole.K) < 1e-13);
      BOOST_TEST(largest_difference(M, whole.M) < 1e-13);
    }
    divided += std::count(owners.begin(), owners.end(), 0) > 0 &&
                       std::count(owners.begin(), owners.end(), 1) > 0
                   ? 1
                   : 0;
  }
  BOOST_TEST(divided >= 40);
}

BOOST_AUTO_TEST_CASE(terms_of_two_ranks_cannot_be_divided) {
  const model::TurbineDefinition definition = sample::turbine_definition(sample::choices().front());
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  std::vector<int> owners(static_cast<std::size_t>(system.size()), 0);
  std::fill(owners.begin() + static_cast<std::ptrdiff_t>(owners.size()) / 36 * 18, owners.end(), 1);
  BOOST_TEST(!system.part_of(0, owners));
}

BOOST_AUTO_TEST_CASE(tangents_of_any_turbine_are_inside_and_fill_most_of_it) {
  for (unsigned seed = 0; seed < 120; ++seed) {
    const model::TurbineDefinition definition = random_turbine(seed);
    model::Turbine turbine = model::build_turbine(definition);
    Draw draw(seed + 1000);
    operate(turbine, draw);
    const turbine::TurbineSystem system(turbine, PETSC_COMM_SELF);
    BOOST_TEST_CONTEXT("seed " << seed) {
      const auto [declared, filled] = check_pattern(system);
      BOOST_TEST(declared <= largest_excess * filled);
    }
  }
}

BOOST_AUTO_TEST_CASE(tangents_are_inside_after_large_rotations) {
  for (const sample::Choice& choice : sample::choices()) {
    const model::TurbineDefinition definition = sample::turbine_definition(choice);
    const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
    Eigen::VectorXd z = sample::random_state(system, 5).z;
    for (Eigen::Index i = 0; i < z.size(); ++i)
      if (system.unknowns()[static_cast<std::size_t>(i)].role == system::UnknownRole::position)
        z(i) *= 4.0;
    const std::unique_ptr<system::PeriodicSystem> counted =
        system.counted_from(sample::to_petsc(system, z).get());
    BOOST_TEST_REQUIRE(bool(counted));
    check_pattern(dynamic_cast<const turbine::TurbineSystem&>(*counted));
  }
}

BOOST_AUTO_TEST_CASE(a_controller_measures_the_speed_of_the_generator) {
  // On a tower that moves under a nacelle that yaws and is tilted: the row of the speed error
  // against what the bodies report.
  sample::Choice choice = sample::choices().front();
  model::TurbineDefinition d = sample::turbine_definition(choice);
  d.shaft.generator.kind = model::JointKind::free;
  d.shaft.gear_ratio = -3.7;
  d.controller = {2.0, 11.0, model::ControlLoop{1.0, 0.5}, {}, 0.0};
  const turbine::TurbineSystem system(model::build_turbine(d), PETSC_COMM_SELF);
  std::size_t row = 0;
  for (std::size_t i = 0; i < system.unknowns().size(); ++i)
    if (system.unknowns()[i].quantity == "speed error") row = i;
  const sample::RandomState state = sample::random_state(system, 3);
  const std::vector<double> z(state.z.begin(), state.z.end());
  const std::vector<double> z_dot(state.z_dot.begin(), state.z_dot.end());
  std::vector<double> r(z.size());
  system.equations().evaluate(0.4, z, z_dot, r);
  const double speed = 11.0 + z[row] + (z_dot[row] - r[row]) / 2.0;
  const double wanted = system.equations().report<double>(0.4, z, z_dot, {}).generator_rate;
  BOOST_TEST(std::abs(speed - wanted) < 1e-12 * std::abs(wanted));
}

BOOST_AUTO_TEST_SUITE_END()
