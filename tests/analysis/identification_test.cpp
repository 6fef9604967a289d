// Identification of modes whose time series is written down here.
#include "samara/analysis/identification.hpp"

#include <algorithm>
#include <random>

#include <boost/test/unit_test.hpp>

#include "samara/analysis/harmonic_energy.hpp"

#include "small_systems.hpp"

using namespace samara;
using namespace samara::test;
using Complex = std::complex<double>;

namespace {

/// Only what identification asks for: groups and names.
class Described final : public SmallSystem {
 public:
  Described() {
    period_ = 1.0;
    symmetry_.sectors = 1;
    for (int blade = 1; blade <= 2; ++blade) {
      const auto first = static_cast<PetscInt>(unknowns_.size());
      const std::string name = "blade " + std::to_string(blade);
      add_position(name + " u");
      add_velocity(name + " V");
      add(name + " M2", UnknownRole::internal, RowRole::balance);
      add(name + " M3", UnknownRole::internal, RowRole::balance);
      const Owner owner(PartKind::beam, "blade", blade);
      add_energy(EnergyGroup::Kind::kinetic, owner, "", {first + 1}, {2.0});
      add_energy(EnergyGroup::Kind::strain, owner, "flap", {first + 2}, {1.0});
      add_energy(EnergyGroup::Kind::strain, owner, "lead-lag", {first + 3}, {1.0});
    }
    const auto first = static_cast<PetscInt>(unknowns_.size());  // 8
    add_position("tower u");
    add_velocity("tower V");
    add_velocity("tower Omega");
    add("tower M", UnknownRole::internal, RowRole::balance);
    const Owner tower(PartKind::beam, "tower");
    add_energy(EnergyGroup::Kind::kinetic, tower, "", {first + 1, first + 2}, {3.0, 0.5, 0.5, 1.0});
    add_energy(EnergyGroup::Kind::strain, tower, "fore-aft", {first + 3}, {1.0});
    for (const char* joint : {"yaw", "teeter"}) {
      add_position("angle");
      unknowns_.back().owner = Owner(PartKind::joint, joint);
      add_velocity("speed");
      unknowns_.back().owner = Owner(PartKind::joint, joint);
    }
  }
  void tangents_at(double, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd&,
                   Eigen::MatrixXd&) const override {}
};

/// Rows of the time series: V of blade 1, of blade 2, tower V, Omega.
struct Identified {
  analysis::Mode mode;
  Eigen::VectorXd participation;
};

Identified identify(const Described& system, const Eigen::MatrixXcd& series) {
  const std::vector<PetscInt> rows{1, 5, 9, 10};
  Eigen::MatrixXcd states = Eigen::MatrixXcd::Zero(system.size(), series.cols());
  for (std::size_t i = 0; i < rows.size(); ++i)
    states.row(rows[i]) = series.row(static_cast<Eigen::Index>(i));
  Identified result;
  Eigen::MatrixXd energies;
  for (int share = 0; share < 2; ++share) {  // together the whole
    analysis::HarmonicEnergy energy(system, 1, share, 2);
    Eigen::MatrixXd real(energy.signals(), series.cols());
    Eigen::MatrixXd imaginary(energy.signals(), series.cols());
    energy.take(states.real(), real);
    energy.take(states.imag(), imaginary);
    const Eigen::MatrixXd part =
        energy.energies(real.data(), imaginary.data(), Eigen::VectorXcd::Ones(series.cols()));
    energies = share == 0 ? part : energies + part;
    describe_energy(energies, energy.part_names(), -1, result.mode, result.participation);
  }
  return result;
}

Complex wave(int k, Eigen::Index sample, Eigen::Index samples) {
  return std::polar(1.0, 2.0 * pi * k * static_cast<double>(sample) / static_cast<double>(samples));
}

double share_of(const analysis::Mode& mode, const std::string& part) {
  for (const analysis::PartShare& share : mode.parts)
    if (share.part == part) return share.share;
  return -1.0;
}

}  // namespace

BOOST_AUTO_TEST_CASE(one_harmonic_is_found_at_its_place_with_odd_and_even_samples) {
  const Described system;
  for (const Eigen::Index samples : {12, 13, 250, 501}) {
    for (const int k : {0, 1, -1, 3, -5, 5, -6}) {
      Eigen::MatrixXcd series = Eigen::MatrixXcd::Zero(4, samples);
      for (Eigen::Index s = 0; s < samples; ++s)
        series(0, s) = Complex(0.3, 2.0) * wave(k, s, samples);
      const Identified found = identify(system, series);
      BOOST_TEST(found.mode.harmonic == k, samples << " samples");
      BOOST_TEST(found.participation.sum() == 1.0, boost::test_tools::tolerance(1e-12));
      // participation is listed from k = -floor(samples / 2)
      BOOST_TEST(found.participation(samples / 2 + k) == 1.0, boost::test_tools::tolerance(1e-12));
      // Mean energy: weight 2, half of it, of |0.3 + 2 i|^2.
      BOOST_TEST(found.mode.kinetic_energy == 4.09, boost::test_tools::tolerance(1e-12));
    }
  }
}

BOOST_AUTO_TEST_CASE(dominant_harmonic_is_that_of_the_part_with_most_energy) {
  // The tower has the largest single harmonic (k = 1), the blades most energy, at 4 and 5.
  const Described system;
  constexpr Eigen::Index samples = 32;
  Eigen::MatrixXcd series(4, samples);
  for (Eigen::Index s = 0; s < samples; ++s) {
    series(0, s) = 1.0 * wave(4, s, samples) + 0.9 * wave(5, s, samples);
    series(1, s) = 1.0 * wave(4, s, samples) - 0.9 * wave(5, s, samples);
    series(2, s) = 1.2 * wave(1, s, samples);
    series(3, s) = 0.0;
  }
  const Identified found = identify(system, series);
  const double blades = 2.0 * (1.0 + 0.81);  // 2 blades, weight 2, half
  const double tower = 0.5 * 3.0 * 1.44;
  BOOST_TEST(tower > 2.0);  // more than either harmonic of the blades
  BOOST_TEST(found.mode.harmonic == 4);
  BOOST_TEST(found.mode.kinetic_energy == blades + tower, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(share_of(found.mode, "blade") == blades / (blades + tower),
             boost::test_tools::tolerance(1e-12));
  BOOST_TEST(share_of(found.mode, "tower") == tower / (blades + tower),
             boost::test_tools::tolerance(1e-12));
  BOOST_TEST(found.participation(samples / 2 + 5) == 1.62 / (blades + tower),
             boost::test_tools::tolerance(1e-12));
  BOOST_TEST(found.participation(samples / 2 + 1) == tower / (blades + tower),
             boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(coupled_weights_count_both_ways) {
  // e = (3 V^2 + 2 * 0.5 V W + W^2) / 2 with V = 2 i, W = i - 1: V W* has real part 2.
  const Described system;
  Eigen::MatrixXcd series = Eigen::MatrixXcd::Zero(4, 1);
  series(2, 0) = Complex(0.0, 2.0);
  series(3, 0) = Complex(-1.0, 1.0);
  const Identified found = identify(system, series);
  BOOST_TEST(found.mode.kinetic_energy == 0.5 * (3.0 * 4.0 + 2.0 * 0.5 * 2.0 + 2.0),
             boost::test_tools::tolerance(1e-13));
}

/// One kinetic group of six unknowns with a given weight.
class Body final : public SmallSystem {
 public:
  explicit Body(const Eigen::MatrixXd& weight) {
    std::vector<PetscInt> unknowns;
    for (int i = 0; i < 6; ++i) {
      unknowns.push_back(static_cast<PetscInt>(unknowns_.size()));
      add_velocity("V" + std::to_string(i));
    }
    add_energy(EnergyGroup::Kind::kinetic, {PartKind::body, "body"}, "", unknowns,
               {weight.data(), weight.data() + weight.size()});
  }
  void tangents_at(double, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd&,
                   Eigen::MatrixXd&) const override {}
};

BOOST_AUTO_TEST_CASE(energy_of_a_body_is_that_of_its_mass_matrix) {
  std::minstd_rand random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto fill = [&](const Eigen::MatrixXd& m) {
    return m.unaryExpr([&](double) { return uniform(random); }).eval();
  };
  std::vector<Eigen::MatrixXd> weights;
  for (int rank = 1; rank <= 6; ++rank)  // semi-definite, pivots in any order
    for (int trial = 0; trial < 5; ++trial) {
      const Eigen::MatrixXd root = fill(Eigen::MatrixXd(rank, 6));
      weights.push_back(root.transpose() * root);
    }
  Eigen::Matrix<double, 6, 1> diagonal;
  diagonal << 6900.0, 6900.0, 6900.0, 0.0, 0.0, 16599.0;
  weights.push_back(diagonal.asDiagonal());
  for (const Eigen::MatrixXd& weight : weights) {
    const Body body(weight);
    analysis::HarmonicEnergy energy(body);
    const Eigen::MatrixXd v = fill(Eigen::MatrixXd(6, 2));
    Eigen::MatrixXd real(energy.signals(), 1);
    Eigen::MatrixXd imaginary(energy.signals(), 1);
    energy.take(v.col(0), real);
    energy.take(v.col(1), imaginary);
    const double found =
        energy.energies(real.data(), imaginary.data(), Eigen::VectorXcd::Ones(1)).sum();
    const double expected = 0.5 * (v.transpose() * weight * v).trace();
    BOOST_TEST(found == expected, boost::test_tools::tolerance(1e-11));
  }
}

BOOST_AUTO_TEST_CASE(ties_go_to_the_smallest_harmonic_that_is_not_negative) {
  const Described system;
  constexpr Eigen::Index samples = 40;
  struct Case {
    std::vector<int> equal;
    int wanted;
  };
  for (const Case& c : {Case{{-1, 1}, 1}, Case{{-3, 2}, 2}, Case{{-4, -2}, -2}, Case{{0, -1}, 0},
                        Case{{5, 3, -1}, 3}}) {
    Eigen::MatrixXcd series = Eigen::MatrixXcd::Zero(4, samples);
    for (Eigen::Index s = 0; s < samples; ++s)
      for (const int k : c.equal) series(1, s) += wave(k, s, samples);
    BOOST_TEST(identify(system, series).mode.harmonic == c.wanted);
    // Round-off breaks no tie; a part in a thousand does.
    for (Eigen::Index s = 0; s < samples; ++s)
      series(1, s) += 1e-9 * wave(c.equal.front(), s, samples);
    BOOST_TEST(identify(system, series).mode.harmonic == c.wanted);
    for (Eigen::Index s = 0; s < samples; ++s)
      series(1, s) += 1e-3 * wave(c.equal.front(), s, samples);
    BOOST_TEST(identify(system, series).mode.harmonic == c.equal.front());
  }
}

BOOST_AUTO_TEST_CASE(nothing_that_moves_is_no_error) {
  const Described system;
  const Identified found = identify(system, Eigen::MatrixXcd::Zero(4, 8));
  BOOST_TEST(found.mode.harmonic == 0);
  BOOST_TEST(found.mode.kinetic_energy == 0.0);
  BOOST_TEST(found.participation.sum() == 0.0);
}

BOOST_AUTO_TEST_CASE(a_system_that_does_not_know_its_motions_is_named_by_its_strains) {
  const Described system;
  analysis::ModeSet set;
  set.rotor_speed = 1.0;
  set.shape_times = {0.0};
  const auto add = [&set](const std::vector<std::pair<int, double>>& values, double kinetic,
                          Complex exponent = Complex(0.0, 2.0)) {
    analysis::Mode mode;
    mode.exponent = exponent;
    mode.kinetic_energy = kinetic;
    set.modes.push_back(mode);
    Eigen::MatrixXcd shape = Eigen::MatrixXcd::Zero(16, 1);
    for (const auto& [unknown, value] : values) shape(unknown, 0) = value;
    set.shapes.push_back(shape);
  };
  // Strain as large as the kinetic energy, as in an elastic mode.
  add({{2, 1.0}, {6, 1.0}}, 1.0);
  add({{2, 1.0}, {6, -1.0}}, 1.0);
  add({{3, 1.0}, {7, 1.0}, {2, 0.5}}, 1.0);
  add({{3, 1.0}}, 0.5);
  add({{11, 1.0}, {2, 0.2}}, 0.5);             // the tower
  add({{2, 1.0}, {6, 1.0}}, 1.0);              // again
  add({{12, 1.0}, {14, 0.2}, {2, 0.1}}, 1.0);  // hardly a strain: a joint
  add({{12, 0.1}, {14, 0.2}}, 1.0);
  add({{12, 1.0}, {2, 1.0}}, 1.0, Complex(1e-9, 0.0));    // counts as zero: at rest in the joint
  for (std::size_t i = 0; i + 1 < set.modes.size(); ++i)  // equal exponents would be degenerate
    set.modes[i].exponent.imag(2.0 + static_cast<double>(i));
  const analysis::PeriodicSolution rest(Eigen::MatrixXd::Zero(16, 1), 1.0);
  name_modes(system, find_leading_motions(system, rest, set), set);
  arrange_modes(set);
  const std::vector<std::string> wanted{"1st yaw",
                                        "1st blade flap",
                                        "2nd blade flap",
                                        "1st blade lead-lag",
                                        "2nd blade lead-lag",
                                        "tower fore-aft",
                                        "3rd blade flap",
                                        "2nd yaw",
                                        "teeter"};
  for (std::size_t i = 0; i < wanted.size(); ++i) BOOST_TEST(set.modes[i].label == wanted[i]);
}

/// Both eigenvectors of a double exponent may have more of one direction than of the other.
BOOST_AUTO_TEST_CASE(equal_modes_beyond_the_number_of_parts_have_no_direction) {
  const Described system;
  for (const bool is_second_aside : {false, true}) {
    analysis::ModeSet set;
    set.rotor_speed = 1.0;
    set.shape_times = {0.0};
    std::vector<analysis::LeadingMotion> leading;
    for (int m = 0; m < 2; ++m) {
      analysis::Mode mode;
      mode.exponent = Complex(0.0, m == 1 && is_second_aside ? 2.1 : 2.0);
      set.modes.push_back(mode);
      set.shapes.push_back(Eigen::MatrixXcd::Zero(16, 1));
      analysis::LeadingMotion one;
      one.motion = {{system::PartKind::beam, "tower"}, "fore-aft"};
      one.motion.bends = true;
      leading.push_back(one);
    }
    name_modes(system, leading, set);
    arrange_modes(set);
    BOOST_TEST(set.modes[0].label ==
               (is_second_aside ? "1st tower fore-aft" : "1st tower bending"));
    BOOST_TEST(set.modes[1].label ==
               (is_second_aside ? "2nd tower fore-aft" : "1st tower bending (2)"));
  }
}

namespace {

analysis::Mode mode_of(const std::string& name, Complex exponent, bool resolved = true) {
  analysis::Mode mode;
  mode.name = name;
  mode.exponent = exponent;
  mode.resolved = resolved;
  return mode;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_order_of_modes_is_that_of_their_exponents_whatever_the_eigensolver_found) {
  // A real pair of one modulus, a double zero that round-off has split, a slow real exponent beside
  // frequencies, two modes of one exponent, one that the step does not resolve.
  const std::vector<analysis::Mode> wanted{mode_of("yaw", Complex(1e-9, 0.0)),
                                           mode_of("yaw", Complex(0.0, 0.0)),
                                           mode_of("rotor rotation", Complex(-0.0557, 0.0)),
                                           mode_of("teeter", Complex(0.2127, 0.0)),
                                           mode_of("teeter", Complex(-0.2127, 0.0)),
                                           mode_of("tower side-side", Complex(0.0, 0.7)),
                                           mode_of("blade flap", Complex(-0.01, 3.0)),
                                           mode_of("tower fore-aft", Complex(-0.01, 3.0)),
                                           mode_of("blade lead-lag", Complex(0.0, 5.0)),
                                           mode_of("blade lead-lag", Complex(-3.0, 4.0)),
                                           mode_of("tower side-side", Complex(0.0, 0.1), false)};
  const std::vector<std::string> names{"1st yaw",
                                       "2nd yaw",
                                       "rotor rotation",
                                       "1st teeter",
                                       "2nd teeter",
                                       "tower side-side",
                                       "blade flap",
                                       "tower fore-aft",
                                       "1st blade lead-lag",
                                       "2nd blade lead-lag",
                                       "2nd tower side-side"};
  std::minstd_rand random(1);
  std::uniform_real_distribution<double> round_off(-1e-10, 1e-10);
  for (int trial = 0; trial < 50; ++trial) {
    analysis::ModeSet set;
    set.rotor_speed = 1.0;
    set.modes = wanted;
    std::shuffle(set.modes.begin(), set.modes.end(), random);
    for (analysis::Mode& mode : set.modes) {
      const double size = std::abs(mode.exponent);
      if (size < 1e-6) continue;
      mode.exponent += Complex(size * round_off(random), 0.0);
      if (mode.exponent.imag() != 0.0) mode.exponent += Complex(0.0, size * round_off(random));
    }
    arrange_modes(set);
    for (std::size_t i = 0; i < names.size(); ++i) {
      BOOST_TEST(set.modes[i].label == names[i], trial << " " << i);
      BOOST_TEST(std::abs(set.modes[i].exponent - wanted[i].exponent) < 1e-8);
    }
  }
}

BOOST_AUTO_TEST_CASE(shapes_are_scaled_to_a_largest_position_of_one) {
  const Described system;
  analysis::ModeSet set;
  set.modes.emplace_back();
  set.modes[0].kinetic_energy = 8.0;
  Eigen::MatrixXcd shape = Eigen::MatrixXcd::Zero(16, 2);
  shape(0, 0) = Complex(0.0, 1.0);
  shape(8, 1) = Complex(1.2, -1.6);  // 2
  shape(1, 0) = 100.0;               // a velocity does not count
  set.shapes.push_back(shape);
  scale_shapes(system, set);
  BOOST_TEST((set.shapes[0] - 0.5 * shape).norm() < 1e-15);
  BOOST_TEST(set.modes[0].kinetic_energy == 2.0, boost::test_tools::tolerance(1e-14));
}
