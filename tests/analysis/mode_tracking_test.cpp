// Modes of a sweep keep their identity through crossings, a veering, a change of the copy that is
// printed, and zero frequency: the frequencies are known in closed form.
#include "samara/analysis/mode_tracking.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include <boost/test/unit_test.hpp>

#include "samara/analysis/constant_modes.hpp"
#include "samara/analysis/floquet.hpp"
#include "samara/base/error.hpp"

#include "small_systems.hpp"

using namespace samara;
using namespace samara::test;
using Complex = std::complex<double>;

namespace {

/// Two coupled masses in fixed axes, with stiffness [p^2 e; e 16], and a mass on springs of
/// stiffness k1 and k2 in fixed directions, described in axes that turn with `speed`: periodic
/// coefficients, and exponents of the springs plus or minus i speed. The mass has a gyroscopic load
/// of `gyro` times its velocity.
class CrossingMasses final : public SmallSystem {
 public:
  static constexpr double coupling = 1.0;
  static constexpr double stiffness = 16.0;

  CrossingMasses(double p, double k1, double k2, double gyro, double speed)
      : p_(p), k1_(k1), k2_(k2), gyro_(gyro), speed_(speed) {
    period_ = speed > 0.0 ? 2.0 * pi / speed : 0.0;
    autonomous_ = false;
    const std::vector<std::string> names{"a", "d", "x", "y"};
    for (const std::string& name : names) add(name, UnknownRole::position, RowRole::constraint);
    for (const std::string& name : names)
      add(name + " speed", UnknownRole::velocity, RowRole::kinematic);
    for (const std::string& name : names)
      add(name + " load", UnknownRole::internal, RowRole::balance);
    for (PetscInt i = 4; i < 8; ++i) {
      const Owner owner{PartKind::body, names[static_cast<std::size_t>(i - 4)]};
      add_energy(EnergyGroup::Kind::kinetic, owner, "", {i}, {1.0});
      add_energy(EnergyGroup::Kind::strain, owner, "", {i + 4}, {1.0});
    }
  }

  /// Rows: f - B q, w - q' - S q, w' + (S + G) w + B^T f, with B^T B the stiffness.
  void tangents_at(double t, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    const double c = std::cos(speed_ * t);
    const double s = std::sin(speed_ * t);
    Eigen::Matrix4d B = Eigen::Matrix4d::Zero();
    B.topLeftCorner<2, 2>() << p_, coupling / p_, 0.0,
        std::sqrt(stiffness - coupling * coupling / (p_ * p_));
    B.bottomRightCorner<2, 2>() << std::sqrt(k1_) * c, -std::sqrt(k1_) * s, std::sqrt(k2_) * s,
        std::sqrt(k2_) * c;
    Eigen::Matrix4d S = Eigen::Matrix4d::Zero();
    S(2, 3) = -speed_;
    S(3, 2) = speed_;
    const Eigen::Matrix4d I = Eigen::Matrix4d::Identity();
    K.block<4, 4>(0, 0) = -B;
    K.block<4, 4>(0, 8) = I;
    K.block<4, 4>(4, 0) = -S;
    K.block<4, 4>(4, 4) = I;
    M.block<4, 4>(4, 0) = -I;
    K.block<4, 4>(8, 4) = S;
    K(10, 7) -= gyro_;
    K(11, 6) += gyro_;
    M.block<4, 4>(8, 4) = I;
    K.block<4, 4>(8, 8) = B.transpose();
  }

  /// The frequencies of the coupled masses, the lower one first, then of both springs, or of the
  /// whirl where they are alike: w^2 - gyro w - k = 0.
  std::vector<double> frequencies() const {
    const double mean = 0.5 * (p_ * p_ + stiffness);
    const double root = std::hypot(0.5 * (p_ * p_ - stiffness), coupling);
    if (gyro_ == 0.0)
      return {std::sqrt(mean - root), std::sqrt(mean + root), std::sqrt(k1_), std::sqrt(k2_)};
    const double whirl = std::hypot(std::sqrt(k1_), 0.5 * gyro_);
    return {std::sqrt(mean - root), std::sqrt(mean + root), whirl - 0.5 * gyro_,
            whirl + 0.5 * gyro_};
  }

 private:
  double p_, k1_, k2_, gyro_, speed_;
};

struct Sweep {
  std::vector<analysis::ModeSet> sets;
  std::vector<std::vector<double>> frequencies;  ///< closed form
  std::vector<std::vector<analysis::TrackedMode>> lines;
};

analysis::ModeSet modes_of(const CrossingMasses& system) {
  if (system.period() == 0.0) return find_constant_modes(system, rest(system));
  analysis::Observer observer;
  return find_floquet_modes(system, rest(system), {240, analysis::FloquetPeriod::full, 6, {}},
                            PETSC_COMM_SELF, observer)
      .set;
}

Sweep run(const std::vector<CrossingMasses*>& systems) {
  Sweep sweep;
  analysis::ModeTracker tracker;
  for (const CrossingMasses* system : systems) {
    const analysis::ModeSet set = modes_of(*system);
    tracker.add(sweep.sets.size(), find_signatures(*system, set));
    sweep.sets.push_back(set);
    sweep.frequencies.push_back(system->frequencies());
  }
  sweep.lines = tracker.lines();
  return sweep;
}

Complex exponent_of(const Sweep& sweep, const analysis::TrackedMode& tracked) {
  const analysis::ModeSet& set = sweep.sets[tracked.point];
  return tracked_exponent(set.modes[tracked.mode].exponent, tracked, set.rotor_speed);
}

/// Each line must be one branch, in one copy: sign times frequency plus m times the rotor speed.
/// Returns the branches of the lines.
std::vector<std::size_t> require_branches(const Sweep& sweep) {
  std::vector<std::size_t> branches;
  for (const auto& line : sweep.lines) {
    std::size_t best = 0;
    double error = 1e300;
    for (std::size_t branch = 0; branch < sweep.frequencies.front().size(); ++branch)
      for (const double sign : {1.0, -1.0})
        for (int m = -4; m <= 4; ++m) {
          double largest = 0.0;
          for (const analysis::TrackedMode& tracked : line)
            largest = std::max(largest, std::abs(exponent_of(sweep, tracked).imag() -
                                                 sign * sweep.frequencies[tracked.point][branch] -
                                                 m * sweep.sets[tracked.point].rotor_speed));
          if (largest < error) {
            error = largest;
            best = branch;
          }
        }
    BOOST_TEST(error < 1e-6, "line of " << line.size() << " points from point "
                                        << line.front().point << ": " << error);
    branches.push_back(best);
  }
  return branches;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(mode_tracking)

BOOST_AUTO_TEST_CASE(lines_cross_twice_and_veer_as_the_closed_form_says) {
  // The frequency p of the first mass crosses those of the springs, 2 and 3, to which it is not
  // coupled, and veers from that of the second mass, 4. The modes of the springs change the copy
  // that is printed where their energies in two harmonics are equal.
  constexpr double speed = 0.7;
  std::deque<CrossingMasses> all;
  std::vector<CrossingMasses*> systems;
  for (int i = 0; i <= 40; ++i)
    systems.push_back(&all.emplace_back(1.0 + 0.1 * i, 4.0, 9.0, 0.0, speed));
  const Sweep sweep = run(systems);
  BOOST_TEST_REQUIRE(sweep.lines.size() == 4U);
  std::vector<std::size_t> branches = require_branches(sweep);
  std::ranges::sort(branches);
  const std::vector<std::size_t> each{0, 1, 2, 3};
  BOOST_TEST(branches == each);
  for (const auto& line : sweep.lines) {
    BOOST_TEST(line.size() == systems.size());
    for (const analysis::TrackedMode& tracked : line)
      BOOST_TEST(tracked.likeness > analysis::ModeTracker::clear_likeness);
  }
}

BOOST_AUTO_TEST_CASE(a_whirl_mode_passes_zero_frequency) {
  // Springs that are alike: whirl with w - speed in the turning axes, which passes zero and is
  // printed as speed - w beyond.
  std::deque<CrossingMasses> all;
  std::vector<CrossingMasses*> systems;
  for (int i = 0; i <= 30; ++i) systems.push_back(&all.emplace_back(1.0, 4.0, 4.0, 0.3, 0.1 * i));
  const Sweep sweep = run(systems);
  BOOST_TEST_REQUIRE(sweep.lines.size() == 4U);
  require_branches(sweep);
  int passed = 0;
  for (const auto& line : sweep.lines) {
    BOOST_TEST(line.size() == systems.size());
    if (exponent_of(sweep, line.front()).imag() * exponent_of(sweep, line.back()).imag() < 0.0)
      ++passed;
  }
  BOOST_TEST(passed == 1);
}

BOOST_AUTO_TEST_CASE(modes_of_equal_multipliers_stay_on_lines) {
  // Without the gyroscopic load both whirl modes have the same multiplier, and the modes that are
  // found are any mixture of them. (No speed is a part of twice their frequency: the multiplier of
  // both and their conjugates would be 1 or -1.)
  std::deque<CrossingMasses> all;
  std::vector<CrossingMasses*> systems;
  for (int i = 1; i <= 19; ++i)
    systems.push_back(&all.emplace_back(1.0, 4.0, 4.0, 0.0, 0.013 + 0.1 * i));
  const Sweep sweep = run(systems);
  BOOST_TEST(sweep.lines.size() == 4U);
  for (const auto& line : sweep.lines) BOOST_TEST(line.size() == systems.size());
}

BOOST_AUTO_TEST_CASE(any_copy_of_a_mode_at_each_point_is_the_same_motion) {
  // u exp(lambda t) = (u exp(i s psi)) exp((lambda - i s Omega) t), and the conjugate. Each point
  // has another copy of each mode, in any order and of any scale.
  constexpr double speed = 0.9;
  constexpr int most = 8;  // harmonics
  constexpr int own = 2;   // of a mode, so that its copies have no others
  constexpr int signals = 12;
  const std::vector<Complex> exponents{{-0.1, 1.3}, {-0.2, 2.15}, {0.05, 3.0}, {-0.4, 4.4}};
  std::mt19937 random(5);
  std::uniform_real_distribution<float> real(-1.0F, 1.0F);
  std::vector<Eigen::MatrixXcf> modes;
  for (std::size_t m = 0; m < exponents.size(); ++m) {
    Eigen::MatrixXcf shape = Eigen::MatrixXcf::Zero(signals, 2 * most + 1);
    for (auto& value : shape.middleCols(most - own, 2 * own + 1).reshaped())
      value = {real(random), real(random)};
    modes.push_back(shape / shape.norm());
  }
  analysis::ModeTracker tracker;
  std::vector<std::vector<Complex>> printed;
  for (std::size_t point = 0; point < 40; ++point) {
    std::vector<std::size_t> order{0, 1, 2, 3};
    std::shuffle(order.begin(), order.end(), random);
    analysis::ModeSignatures signatures;
    signatures.rotor_speed = speed;
    for (std::size_t place = 0; place < order.size(); ++place) {
      const std::size_t m = order[place];
      const bool is_conjugate = random() % 2 == 1;
      const int shift = static_cast<int>(random() % 5) - 2;
      Eigen::MatrixXcf copy = Eigen::MatrixXcf::Zero(signals, 2 * most + 1);
      for (int k = -own; k <= own; ++k) {
        const Eigen::VectorXcf part = modes[m].col(most + k);
        if (is_conjugate)
          copy.col(most - k + shift) = part.conjugate();
        else
          copy.col(most + k + shift) = part;
      }
      signatures.modes.push_back(place);
      signatures.shapes.emplace_back(copy * std::polar(1.0F, 3.0F * real(random)));
      signatures.exponents.push_back((is_conjugate ? std::conj(exponents[m]) : exponents[m]) -
                                     Complex(0.0, shift * speed));
    }
    printed.push_back(signatures.exponents);
    tracker.add(point, signatures);
  }
  const auto lines = tracker.lines();
  BOOST_TEST_REQUIRE(lines.size() == exponents.size());
  for (const auto& line : lines) {
    BOOST_TEST(line.size() == printed.size());
    const auto at = [&](const analysis::TrackedMode& tracked) {
      return tracked_exponent(printed[tracked.point][tracked.mode], tracked, speed);
    };
    for (const analysis::TrackedMode& tracked : line) {
      BOOST_TEST(std::abs(at(tracked) - at(line.front())) < 1e-12, tracked.point);
      BOOST_TEST(std::abs(tracked.likeness - 1.0) < 1e-2);
    }
  }
}

BOOST_AUTO_TEST_CASE(integration_and_hill_find_the_same_shapes) {
  const CrossingMasses system(1.3, 4.0, 9.0, 0.0, 0.7);
  const analysis::ModeSet all = modes_of(system);
  analysis::Observer observer;
  analysis::FloquetOptions options;
  options.modes = 4;
  options.search = analysis::ModeSearch::hill;
  const analysis::ModeSet some =
      find_floquet_modes(system, rest(system), options, PETSC_COMM_SELF, observer).set;
  const std::vector<analysis::ModeLink> links =
      link_modes(find_signatures(system, all), find_signatures(system, some));
  BOOST_TEST_REQUIRE(links.size() == 4U);
  for (const analysis::ModeLink& link : links) {
    BOOST_TEST(std::abs(link.likeness - 1.0) < 1e-3);
    const analysis::TrackedMode tracked{0, 0, link.is_conjugate,
                                        link.is_conjugate ? -link.shift : link.shift};
    const Complex wanted = all.modes[link.from].exponent;
    BOOST_TEST(std::abs(tracked_exponent(some.modes[link.to].exponent, tracked, 0.7) - wanted) <
               1e-5 * std::abs(wanted));
  }
}

BOOST_AUTO_TEST_CASE(modes_of_different_meshes_are_refused) {
  const CrossingMasses system(1.3, 4.0, 9.0, 0.0, 0.7);
  const Mathieu other(2.5, 1.0);
  analysis::Observer observer;
  const analysis::ModeSet set =
      find_floquet_modes(other, rest(other), {240, analysis::FloquetPeriod::full, 6, {}},
                         PETSC_COMM_SELF, observer)
          .set;
  BOOST_CHECK_THROW(
      link_modes(find_signatures(system, modes_of(system)), find_signatures(other, set)),
      InputError);
}

BOOST_AUTO_TEST_SUITE_END()
