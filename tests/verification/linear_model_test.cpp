// The linear model in state-space form: its exponents are those of the other analyses, and small
// inputs do to the nonlinear equations what it says.
#include "samara/linear/linear_model.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include "samara/linear/azimuth_series.hpp"
#include "samara/linear/hill.hpp"
#include "samara/linear/multiblade.hpp"
#include "samara/model/masses.hpp"
#include "samara/turbine/turbine_input_output.hpp"

#include "time_series.hpp"

using namespace samara;
using namespace samara::test;
using analysis::TransientSample;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

namespace {

/// A turbine, its steady state and its linear model.
struct Linearized {
  explicit Linearized(const model::TurbineDefinition& definition,
                      const std::vector<std::string>& inputs = {},
                      const std::vector<std::string>& channels = {}, int harmonics = 4)
      : system(model::build_turbine(definition), PETSC_COMM_SELF),
        ports(system, inputs, {}, channels),
        trim(find(system, harmonics)),
        model(system, ports, trim.solution) {}

  static analysis::Trim find(const system::PeriodicSystem& system, int harmonics) {
    analysis::Observer observer;
    analysis::TrimOptions options;
    options.harmonics = harmonics;
    return analysis::find_trim(system, options, observer);
  }

  turbine::TurbineSystem system;
  turbine::TurbineInputOutput ports;
  analysis::Trim trim;
  linear::LinearModel model;
};

/// Distance of each of `wanted` to the nearest of `found`, relative to the larger of its size and
/// `floor`.
double worst_distance(const std::vector<Complex>& wanted, const std::vector<Complex>& found,
                      double floor) {
  double worst = 0.0;
  for (const Complex& one : wanted) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Complex& other : found) nearest = std::min(nearest, std::abs(one - other));
    worst = std::max(worst, nearest / std::max(std::abs(one), floor));
  }
  return worst;
}

std::vector<Complex> eigenvalues_of(const MatrixXd& matrix) {
  const Eigen::EigenSolver<MatrixXd> solver(matrix, false);
  std::vector<Complex> values(static_cast<std::size_t>(matrix.rows()));
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = solver.eigenvalues()(static_cast<Eigen::Index>(i));
  return values;
}

Complex nearest_exponent(const analysis::ModeSet& set, Complex exponent) {
  Complex best = set.modes.front().exponent;
  for (const analysis::Mode& mode : set.modes)
    if (std::abs(mode.exponent - exponent) < std::abs(best - exponent)) best = mode.exponent;
  return best;
}

/// Exponents up to here [rad/s] are compared where the reference has a step of its own.
constexpr double fastest = 60.0;

struct TimeSeries {
  std::vector<double> times;
  std::vector<VectorXd> values;
};

/// A turbine under u(t) = size (1 - cos(omega t))^2 in one input: at rest at the start.
class Driven final : public system::PeriodicSystem {
 public:
  Driven(const turbine::TurbineSystem& turbine, const turbine::TurbineInputOutput& ports, int input,
         double size, double omega)
      : turbine_(turbine), ports_(ports), input_(input), size_(size), omega_(omega) {}

  double value(double t, int derivative) const {
    const double c = std::cos(omega_ * t);
    const double s = std::sin(omega_ * t);
    if (derivative == 0) return size_ * (1.0 - c) * (1.0 - c);
    if (derivative == 1) return size_ * 2.0 * omega_ * (1.0 - c) * s;
    return size_ * 2.0 * omega_ * omega_ * (s * s + c - c * c);
  }

  turbine::TurbineInputs<double> inputs_at(double t) const {
    const auto count = static_cast<Eigen::Index>(ports_.inputs().size());
    VectorXd values = VectorXd::Zero(count);
    VectorXd rates = VectorXd::Zero(count);
    values(input_) = value(t, 0);
    rates(input_) = value(t, 1);
    return ports_.collect<double>(values, rates);
  }

  MPI_Comm comm() const override { return turbine_.comm(); }
  PetscInt size() const override { return turbine_.size(); }
  double period() const override { return turbine_.period(); }
  const std::vector<system::Unknown>& unknowns() const override { return turbine_.unknowns(); }
  const std::vector<system::RowRole>& rows() const override { return turbine_.rows(); }
  const std::vector<bool>& differential() const override { return turbine_.differential(); }
  bool constraints_are_autonomous() const override { return true; }
  const system::RotorSymmetry& symmetry() const override { return turbine_.symmetry(); }
  const std::vector<system::EnergyGroup>& energy_groups() const override {
    return turbine_.energy_groups();
  }
  const std::vector<system::UnconstrainedCoordinate>& unconstrained_coordinates() const override {
    return turbine_.unconstrained_coordinates();
  }
  void reference_state(double t, Vec z) const override { turbine_.reference_state(t, z); }
  petsc::Handle<Vec> make_state() const override { return turbine_.make_state(); }
  petsc::Handle<Mat> make_jacobian() const override { return turbine_.make_jacobian(); }
  petsc::Handle<Mat> make_mass() const override { return turbine_.make_mass(); }
  std::vector<std::vector<PetscInt>> pattern() const override { return turbine_.pattern(); }
  void residual(double t, Vec z, Vec z_dot, Vec r) const override {
    const auto plain = [this](Vec vector) {
      const petsc::ReadView view(vector);
      return std::vector<double>(view.data(), view.data() + size());
    };
    std::vector<double> result(static_cast<std::size_t>(size()));
    turbine_.equations().evaluate(t, plain(z), plain(z_dot), inputs_at(t), result);
    const petsc::WriteView view(r);
    std::copy(result.begin(), result.end(), view.data());
  }
  /// Those without inputs are near enough for Newton's method.
  void tangents(double t, Vec z, Vec z_dot, double shift, Mat jacobian, Mat mass) const override {
    turbine_.tangents(t, z, z_dot, shift, jacobian, mass);
  }

 private:
  const turbine::TurbineSystem& turbine_;
  const turbine::TurbineInputOutput& ports_;
  int input_;
  double size_;
  double omega_;
};

model::TurbineDefinition small_baseline(double gravity) {
  return lee("baseline",
             {"blades.elements=2", "tower.elements=2", "gravity=" + std::to_string(gravity)})
      .turbine;
}

}  // namespace

BOOST_AUTO_TEST_CASE(eigenvalues_of_constant_state_spaces_are_those_of_modes) {
  const std::vector<model::TurbineDefinition> cases{
      lee("rigid_tower", {"nacelle.yaw={joint: locked}"}).turbine,
      lee("baseline", {"shaft.speed=0", "blades.damping=1e-4", "tower.damping=2e-4"}).turbine,
      lee("baseline", {"shaft.speed=0", "gravity=9.81", "blades.pitch_deg=10",
                       "blades.mass_damping=0.2", "tower.mass_damping=[0, 0.1, 0.3]"})
          .turbine,
  };
  for (const model::TurbineDefinition& definition : cases) {
    const Linearized linear(definition);
    const analysis::ModeSet set =
        analysis::find_constant_modes(linear.system, linear.trim.solution);
    std::vector<Complex> wanted;
    for (const analysis::Mode& mode : set.modes)
      if (mode.exponent != 0.0 && std::abs(mode.exponent) < 1e3) wanted.push_back(mode.exponent);
    const std::vector<Complex> found = eigenvalues_of(linear.model.state_space(0.1).A);
    BOOST_TEST(found.size() == 2u * static_cast<std::size_t>(set.degrees_of_freedom));
    BOOST_TEST(worst_distance(wanted, found, 1.0) < 2e-8);  // round-off: BLAS adds in its own order
  }
}

BOOST_AUTO_TEST_CASE(exponents_of_periodic_state_spaces_are_those_of_floquet) {
  for (const double gravity : {0.0, 9.81}) {
    const model::TurbineDefinition definition = small_baseline(gravity);
    const Linearized linear(definition, {"yaw_torque"}, {"NacYaw"});
    // The step's error is one of even powers: two extrapolations.
    std::vector<analysis::ModeSet> sets;
    for (const int steps : {500, 1000, 2000}) sets.push_back(floquet_of(definition, steps).set);
    std::vector<Complex> wanted;
    for (const analysis::Mode& mode : sets[2].modes) {
      // Round-off splits a double zero by its root.
      if (std::abs(mode.exponent) < 1e-4 || std::abs(mode.exponent) > fastest) continue;
      const Complex middle = nearest_exponent(sets[1], mode.exponent);
      const Complex coarse = nearest_exponent(sets[0], middle);
      const Complex once = (4.0 * middle - coarse) / 3.0;
      const Complex twice = (4.0 * mode.exponent - middle) / 3.0;
      wanted.push_back((16.0 * twice - once) / 15.0);
    }
    BOOST_TEST(wanted.size() >= 7u);
    const linear::AzimuthSeries series(
        [&linear](double psi) {
          return linear.model.state_space(psi / linear.system.turbine().speed);
        },
        31, 15);
    BOOST_TEST(series.residual() < 1e-5);
    const MatrixXd hill = linear::hill_matrix(series, linear.system.turbine().speed, 8);
    BOOST_TEST(worst_distance(wanted, eigenvalues_of(hill), 1.0) < 1e-6);
  }
}

BOOST_AUTO_TEST_CASE(small_inputs_move_the_nonlinear_turbine_as_the_linear_model_says) {
  // Gravity, tilt, pitch, cone: nothing is constant and nothing symmetric. The steady state needs
  // many harmonics, as the rotor speed swings.
  constexpr double step = 0.0005;
  constexpr int steps = 700;
  constexpr double omega = 9.0;
  constexpr double largest_difference = 0.01;
  const model::TurbineDefinition definition =
      lee("baseline",
          {"blades.elements=2", "tower.elements=2", "gravity=9.81", "blades.pitch_deg=8",
           "blades.precone_deg=3", "shaft.tilt_deg=4", "nacelle.yaw.stiffness=1e6",
           "nacelle.yaw.damping=1e4", "blades.damping=2e-3", "tower.damping=2e-3",
           "shaft.generator={joint: free, own_inertia: 20, torque: 1e3, torque_slope: 30}",
           "shaft.gear_ratio=-10", "shaft.rotor={torque: 1e4, torque_slope: -1e3}"})
          .turbine;
  const std::vector<std::string> inputs{"generator_torque", "yaw_torque",   "top_force_n1",
                                        "top_force_n2",     "top_force_n3", "pitch",
                                        "pitch_1",          "base_n1",      "base_n2",
                                        "base_n3",          "base_rot_n1",  "base_rot_n2",
                                        "base_rot_n3"};
  const std::vector<std::string> channels{
      "RootMxb1", "RootMyb2",  "RootMzb1",  "RootMyc1", "TipDxb1",  "TTDspFA", "TTDspSS",
      "TwrBsMyt", "TwrBsMxt",  "NacYaw",    "RotSpeed", "TeetDefl", "RotTorq", "GenSpeed",
      "GenTq",    "LSSTipMys", "YawBrTAxp", "TipALxb1", "YawBrMzp"};
  const Linearized linear(definition, inputs, channels, 14);
  const auto outputs = static_cast<Eigen::Index>(channels.size());
  const auto n = static_cast<Eigen::Index>(linear.model.states().size());
  std::vector<linear::StateSpace> forms;
  for (int k = 0; k <= steps; ++k) forms.push_back(linear.model.state_space(step * k));
  const turbine::TurbineChannels measured(linear.system, {}, channels);
  const auto series_of = [&](const Driven& system) {
    Keeper<VectorXd> keeper([&](const TransientSample& sample) {
      VectorXd y(outputs);
      const VectorXd z = values_of(sample.z);
      const VectorXd z_dot = values_of(sample.z_dot);
      measured.evaluate<double>(sample.t, {z.begin(), z.end()}, {z_dot.begin(), z_dot.end()},
                                std::span<double>(y.data(), channels.size()),
                                system.inputs_at(sample.t));
      return y;
    });
    analysis::run_transient(system, analysis::start_on(linear.system, linear.trim, 0.0),
                            steps_of(step, step * steps, analysis::TransientMethod::bdf2), keeper);
    return TimeSeries{keeper.times, keeper.values};
  };
  for (int i = 0; i < static_cast<int>(inputs.size()); ++i) {
    const bool is_motion = linear.ports.inputs()[static_cast<std::size_t>(i)].is_motion;
    const double size = is_motion ? 1e-3 : 300.0;
    const Driven up(linear.system, linear.ports, i, size, omega);
    const Driven down(linear.system, linear.ports, i, -size, omega);
    const TimeSeries above = series_of(up);
    const TimeSeries below = series_of(down);
    const auto input_at = [&](int k) {
      VectorXd u = VectorXd::Zero(forms[0].B.cols());
      for (std::size_t c = 0; c < linear.model.input_columns().size(); ++c) {
        const linear::InputColumn& column = linear.model.input_columns()[c];
        if (static_cast<int>(column.input) == i)
          u(static_cast<Eigen::Index>(c)) = up.value(step * k, column.derivative);
      }
      return u;
    };
    VectorXd x = VectorXd::Zero(n);
    VectorXd before = x;
    std::vector<VectorXd> y{forms[0].D * input_at(0)};
    for (int k = 1; k <= steps; ++k) {
      const linear::StateSpace& form = forms[static_cast<std::size_t>(k)];
      const MatrixXd left = 1.5 * MatrixXd::Identity(n, n) - step * form.A;
      const VectorXd right = 2.0 * x - 0.5 * before + step * (form.B * input_at(k));
      before = x;
      x = left.partialPivLu().solve(right);
      y.push_back(form.C * x + form.D * input_at(k));
    }
    VectorXd largest = VectorXd::Zero(outputs);
    VectorXd difference = VectorXd::Zero(outputs);
    for (std::size_t s = 0; s < above.times.size(); ++s) {
      const double at = above.times[s] / step;
      const auto k = static_cast<std::size_t>(std::lround(at));
      if (std::abs(at - std::round(at)) > 1e-6) continue;
      std::size_t other = 0;
      while (std::abs(below.times[other] - above.times[s]) > 1e-9) ++other;
      const VectorXd found = 0.5 * (above.values[s] - below.values[other]);
      largest = largest.cwiseMax(y[k].cwiseAbs());
      difference = difference.cwiseMax((found - y[k]).cwiseAbs());
    }
    // Relative to the largest response in the same unit: some of the others nearly vanish.
    std::map<std::string, double> sizes;
    for (Eigen::Index o = 0; o < outputs; ++o) {
      double& unit_size = sizes[linear.ports.outputs()[static_cast<std::size_t>(o)].unit];
      unit_size = std::max(unit_size, largest(o));
    }
    for (Eigen::Index o = 0; o < outputs; ++o) {
      const auto at = static_cast<std::size_t>(o);
      const double scale = sizes[linear.ports.outputs()[at].unit];
      BOOST_TEST(difference(o) <= largest_difference * scale,
                 inputs[static_cast<std::size_t>(i)] << " to " << channels[at] << ": "
                                                     << difference(o) << " of " << scale);
    }
  }
}

// A turbine on a stiff tower feels a foot that turns as a rigid body would: its weight to the side,
// its inertia, and the gyroscopic moment of its rotor. Loads are those of the turbine on the
// ground, in the axes of the foot.
BOOST_AUTO_TEST_CASE(a_turning_foot_loads_the_tower_as_a_rigid_body_does) {
  const std::vector<std::string> loads{"TwrBsFxt", "TwrBsFyt", "TwrBsFzt",
                                       "TwrBsMxt", "TwrBsMyt", "TwrBsMzt"};
  const std::vector<std::string> inputs{"base_rot_n1", "base_rot_n2", "base_rot_n3", "base_n2"};
  const std::vector<std::string> settings{"nacelle.yaw={joint: locked}",
                                          "hub.teeter={joint: locked}", "shaft.overhang=2.388"};
  // The response to a constant input is quasi-static: x = -A^-1 B u.
  const auto answer_of = [](const linear::StateSpace& form) -> MatrixXd {
    const MatrixXd deflection = form.A.partialPivLu().solve(form.B);
    return 1e3 * (form.D - form.C * deflection);  // kN, kN m
  };
  const auto small = [&](std::vector<std::string> more) {
    more.insert(more.end(), settings.begin(), settings.end());
    more.insert(more.end(),
                {"blades.elements=2", "blades.order=2", "tower.elements=2", "tower.order=2"});
    return lee("baseline", more).turbine;
  };

  // At rest: so little gravity that no deflection matters.
  constexpr double g = 1e-3;
  const model::TurbineDefinition parked = small({"shaft.speed=0", "gravity=0.001"});
  const Linearized still(parked, inputs, loads);
  const MatrixXd rest = answer_of(still.model.state_space(0.0));
  const model::MassProperties whole = model::compute_masses(parked, still.system.turbine()).whole;
  const Vector3 S = whole.moment;  // n1 lateral, n2 downwind, n3 up
  // The channels' axes: x downwind (n2), y lateral (-n1), z up.
  const auto channels_of = [](const Vector3& n) { return Vector3(n(1), -n(0), n(2)); };
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 e = Vector3::Unit(axis);
    const auto compare = [&](Eigen::Index column, const Vector3& force, const Vector3& moment,
                             double force_size, double moment_size) {
      Vector6 expected;
      expected << channels_of(force), channels_of(moment);
      for (Eigen::Index i = 0; i < 6; ++i)
        BOOST_TEST(
            std::abs(rest(i, column) - expected(i)) < 1e-5 * (i < 3 ? force_size : moment_size),
            loads[static_cast<std::size_t>(i)] << " about " << axis + 1 << ": " << rest(i, column)
                                               << " and " << expected(i));
    };
    // Turned by phi e, the weight -M g n3 has the components of -M g (n3 - phi e x n3).
    const Vector3 sideways = g * e.cross(Vector3::UnitZ());
    compare(3 * axis, whole.mass * sideways, S.cross(sideways), g * whole.mass, g * S.norm());
    // d'Alembert: - phi_ddot e x S, and minus the inertia about the foot.
    compare(3 * axis + 2, -e.cross(S), -(whole.inertia * e), S.norm(), whole.inertia.norm());
  }
  BOOST_TEST(std::abs(rest(0, 11) + whole.mass) < 1e-5 * whole.mass);  // base_n2's acceleration

  // A balanced rotor that turns: rates give the gyroscopic moment, angles nothing.
  const model::TurbineDefinition turning = small({"gravity=0", "blades.count=3"});
  const Linearized spun(turning, inputs, loads);
  MatrixXd spinning = MatrixXd::Zero(6, 12);
  constexpr int azimuths = 6;
  for (int i = 0; i < azimuths; ++i) {
    const double psi = 2.0 * std::numbers::pi * i / azimuths;
    const linear::Multiblade multiblade(spun.model);
    spinning += answer_of(multiblade.transform(
                    psi, spun.model.state_space(psi / spun.system.turbine().speed))) /
                azimuths;
  }
  const model::MassProperties rotor =
      model::compute_masses(turning, spun.system.turbine()).meshed_rotor;
  const double spin = rotor.inertia(1, 1) * spun.system.turbine().speed;  // along n2
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 moment = channels_of(-Vector3::Unit(axis).cross(spin * Vector3::UnitY()));
    for (int i = 0; i < 3; ++i) {
      BOOST_TEST(std::abs(spinning(3 + i, 3 * axis)) < 1e-6 * spin);
      BOOST_TEST(std::abs(spinning(3 + i, 3 * axis + 1) - moment(i)) < 1e-2 * spin,
                 loads[static_cast<std::size_t>(3 + i)] << " rate about " << axis + 1 << ": "
                                                        << spinning(3 + i, 3 * axis + 1) << " and "
                                                        << moment(i));
    }
  }
}
