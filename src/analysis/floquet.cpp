#include "samara/analysis/floquet.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include "samara/analysis/collocation_step.hpp"
#include "samara/analysis/consistent_subspace.hpp"
#include "samara/analysis/constant_modes.hpp"
#include "samara/analysis/hill.hpp"
#include "samara/analysis/identification.hpp"
#include "samara/analysis/linear_algebra.hpp"
#include "samara/analysis/mode_error.hpp"
#include "samara/analysis/ranks.hpp"
#include "samara/base/error.hpp"
#include "samara/petsc/session.hpp"

#include "energy_coordinates.hpp"
#include "energy_shares.hpp"
#include "massless_states.hpp"
#include "mode_selection.hpp"
#include "mode_sharing.hpp"
#include "sector_motion.hpp"
#include "signal_series.hpp"
#include "state_parts.hpp"

namespace samara::analysis {
namespace {

using Complex = std::complex<double>;
using Index = Eigen::Index;
using namespace std::complex_literals;

constexpr double largest_residual = 1e-6;
/// Relative to the largest multiplier: a smaller one is round-off.
constexpr double least_multiplier = 1e-12;
/// A multiplier below the first value is round-off if the relative round-off error of its exponent
/// exceeds the second value.
constexpr double small_multiplier = 1e-6;
constexpr double largest_round_off = 1e-2;
/// Largest share of the kinetic energy of a resolved mode in harmonics beyond that phase. A mode
/// with a larger share is a mixture of very fast modes, whose multipliers are all near -1 or 1.
constexpr double largest_fast_share = 0.01;
/// Error by the step of a resolved mode, relative to the distance of the exponents of a multiplier,
/// i Q Omega. Where the error is larger, modes mix whose exponents are next to each other up to
/// this distance, and neither their harmonics nor their number below a frequency are known.
constexpr double largest_branch_error = 0.05;
/// Share of the kinetic energy from which a harmonic may become that of the mode
/// (separate_motions() takes twice as much).
constexpr double least_share_of_own = 0.1;
/// Relative to an exponent and the harmonic's frequency: a smaller imaginary part is round-off.
constexpr double least_imaginary = 1e-6;
/// Replaces an exponent that belongs to no free motion.
constexpr double far_from_zero = std::numeric_limits<double>::infinity();
/// Relative to the rotor speed: below this, an exponent may be one of several that are zero in an
/// exact steady state. Exponents nearer to each other than this many changes mix; the factor of a
/// change is that of its estimate.
constexpr double largest_slow = 0.05;
constexpr double mixed = 3.0;
constexpr double solution_safety = 2.0;
/// Relative to the largest change among exponents that mix: another one changes less than this.
/// The error of a growth that is known to be one, relative to the growth.
constexpr double unmoved = 0.01;
constexpr double largest_of_growth = 0.95;
/// Relative to the energy of a state of length 1 in energy coordinates: a smaller energy is
/// round-off. The computed exponent of a motion at rest is the square root of round-off, and so is
/// its speed.
constexpr double rest_energy = 1e-10;
/// Initial states that are advanced at once.
constexpr Index group_states = 128;
/// Largest number of instants of the mode shapes per revolution.
constexpr int shape_samples = 24;
/// Instants per revolution for the name of a mode that is not resolved, at least.
constexpr Index label_samples = 3;

/// Modes that a chosen number of steps resolves where all modes are asked for, those of a verdict.
constexpr int first_modes = 10;
/// Limits of a number of steps that is chosen.
constexpr int least_steps = 36;
constexpr double most_steps = 2000.0;
/// Reach of these steps beyond the frequency of the last of these modes: factor, and multiples of
/// the rotor speed, since the axes in which a mode is identified may turn.
constexpr double reach_factor = 1.25;
constexpr double reach_harmonics = 3.0;
/// Factor of the number of steps from one attempt to the next, and the same where modes are beyond
/// reach.
constexpr double least_increase = 1.15;
constexpr double most_increase = 3.0;
constexpr double usual_increase = 1.6;
/// An estimated number of steps is raised by this factor.
constexpr double step_margin = 1.05;
constexpr int most_attempts = 7;

/// Seconds of one core for each unknown, as measured (docs/performance.md): of a step with its part
/// of the identification, the same for each state; of Hill's method, and for each mode. The
/// eigenproblem takes seconds for each state to the third power.
constexpr double step_of_unknown = 2.5e-5;
constexpr double step_of_unknown_and_state = 2.3e-7;
constexpr double eigenproblem_of_state = 1e-9;
struct HillTime {
  double of_unknown;
  double of_unknown_and_mode;
};
constexpr HillTime hill_in_medium{1.3e-3, 6e-5};
constexpr HillTime hill_of_slow_modes{5e-4, 1e-4};
constexpr HillTime hill_of_slow_decays{0.0, 5e-4};
/// The same without three equal parts or more, where more harmonics are coupled.
constexpr HillTime hill_in_medium_of_few{0.0, 1.5e-3};
constexpr HillTime hill_of_slow_modes_of_few{0.0, 8e-4};
constexpr HillTime hill_of_slow_decays_of_few{0.0, 2e-3};
/// Steps a revolution for each mode asked for in a medium, as measured, and factor of the steps for
/// the slowest decays, which are not the slowest modes.
constexpr double steps_of_mode_in_medium = 4.0;
constexpr double steps_of_slow_decays = 1.5;
/// Beyond this number of unknowns, Hill's method always takes less.
constexpr PetscInt most_unknowns = 10000;

/// Instants of a step at which the motion is identified: its middle for order 2, its start and
/// others for higher orders. They are more than the stages and show motions that are too fast for
/// the step: at the ends of steps these may look like slow ones.
int samples_of_step(int order) { return order == 2 ? 1 : order / 2 + 1; }

class Analysis {
 public:
  /// `rule`: of a number of steps in the period that the sectors divide.
  Analysis(const system::PeriodicSystem& system, const PeriodicSolution& solution, int sectors,
           int steps, const FloquetOptions& options, const Ranks& ranks, Observer& observer)
      : system_(system),
        solution_(solution),
        ranks_(ranks),
        observer_(observer),
        subspace_(system, solution),
        sectors_(sectors),
        rule_{options.order, system.period() / steps},
        accuracy_(options.accuracy.value_or(std::numeric_limits<double>::infinity())),
        steps_(steps / sectors),
        samples_of_step_(samples_of_step(options.order)),
        offset_(options.order == 2 ? 0.5 : 0.0),
        samples_(steps * samples_of_step_),
        span_(samples_ / sectors),
        dt_(system.period() / samples_),
        speed_(2.0 * std::numbers::pi / system.period()),
        states_(subspace_.size()),
        series_(system, sectors, first_samples(), states_, ranks),
        stride_(std::max(1, (samples_ + shape_samples - 1) / shape_samples)) {}

  Floquet run() {
    if (states_ == 0)
      throw InputError("floquet: nothing can move, all strains and joints are rigid");
    in_stage("steps", [this] { integrate(); });
    in_stage("eigenproblem", [this] { solve_eigenproblem(); });
    in_stage("identification", [this] {
      identify();
      find_residuals();
      collect_shapes();
    });
    return finish();
  }

 private:
  template <class Work>
  static void in_stage(const char* name, Work work) {
    const petsc::Stage stage(name);
    work();
  }

  // ---- the map over a sector -------------------------------------------------------------------

  /// Each rank integrates some of the steps, for all initial states at the start of its own steps.
  /// A step depends on nothing but the state at its start, so that the map over all steps is the
  /// product of the maps of the ranks. The motion one sector after the first sample shows whether
  /// it repeats: at the end of the last step, or within one step more.
  void integrate() {
    Eigen::MatrixXd start = subspace_.basis(0.0);
    coordinates_ = EnergyCoordinates(system_, start, subspace_.degrees_of_freedom(), speed_);
    if (coordinates_.without_inertia().cols() > 0) {
      const SparseTangents tangents = tangents_on(system_, solution_, 0.0);
      massless_ = MasslessStates(tangents.K, tangents.M, start, coordinates_);
    }
    const long first = first_step(ranks_.rank);
    const long end = first_step(ranks_.rank + 1);
    map_.setIdentity(states_, states_);
    ranks_.attempt([&] {
      if (first == end) return;
      if (first > 0) start = subspace_.basis(static_cast<double>(first) * rule_.step);
      coordinates_.divide(start);
      integrate(first, end, start);
    });
    multiply_maps();
  }

  /// Initial states are advanced in groups, for all samples of a step at once: the groups stay in
  /// the cache.
  void integrate(long first, long end, const Eigen::MatrixXd& start) {
    const long first_sample = first * samples_of_step_;
    const long samples = (std::min(end, steps_) - std::min(first, steps_)) * samples_of_step_;
    for (long i = first_sample; i < first_sample + samples; ++i)
      if (i % stride_ == 0) shape_numbers_.push_back(i / stride_);
    const Index n = start.rows();
    shapes_.resize(n * static_cast<Index>(shape_numbers_.size()), states_);
    if (end == all_steps()) end_.resize(n, states_);
    CollocationStep step(system_, solution_, subspace_, rule_.order, rule_.step);
    std::vector<Eigen::MatrixXd> groups;
    for (Index g = 0; g < states_; g += group_states)
      groups.emplace_back(start.middleCols(g, std::min(group_states, states_ - g)));
    Eigen::MatrixXd states_at_end(states_, states_);
    std::vector<double> fractions;  // of a step, at the samples
    for (int i = 0; i < samples_of_step_; ++i)
      fractions.push_back((i + offset_) / samples_of_step_);
    std::vector<Eigen::MatrixXd> values(fractions.size());
    for (long k = first; k < end; ++k) {
      Index g = 0;
      for (Eigen::MatrixXd& group : groups) {
        step.advance(k, group);
        const Index count = group.cols();
        if (k == steps_) {
          step.sample(fractions.front(), values.front());
          end_.middleCols(g, count) = values.front();
        } else {
          step.sample(fractions, values);
          for (int i = 0; i < samples_of_step_; ++i) {
            const long sample = k * samples_of_step_ + i;
            const Eigen::MatrixXd& at_sample = values[static_cast<std::size_t>(i)];
            series_.take(sample - first_sample, g, at_sample);
            if (sample % stride_ == 0)
              shapes_.block(n * (sample / stride_ - shape_numbers_.front()), g, n, count) =
                  at_sample;
          }
          if (k + 1 == all_steps()) end_.middleCols(g, count) = group;
          if (k + 1 == std::min(end, steps_)) states_at_end.middleCols(g, count) = step.state();
        }
        g += count;
      }
      if (k + 1 == std::min(end, steps_)) map_ = coordinates_.of(states_at_end);
      observer_.progress("floquet", k + 1 - first, end - first);
    }
  }

  /// Steps that are made. A sector has `steps_` of them.
  long all_steps() const { return steps_ + (offset_ > 0.0 ? 1 : 0); }
  /// Number of the first step of a rank.
  long first_step(int rank) const { return all_steps() * rank / ranks_.size; }

  /// Number of the first sample of each rank, and that of all samples.
  std::vector<long> first_samples() const {
    std::vector<long> first;
    for (int r = 0; r <= ranks_.size; ++r)
      first.push_back(std::min(first_step(r), steps_) * samples_of_step_);
    return first;
  }

  /// Columns of the map over a sector, P (eta, eta_dot, xi) in the coordinates of the start, and of
  /// the map from there to the first step of this rank.
  void multiply_maps() {
    const auto count = static_cast<int>(map_.size());
    if (ranks_.rank > 0) {
      before_.resize(states_, states_);
      MPI_Recv(before_.data(), count, MPI_DOUBLE, ranks_.rank - 1, 0, ranks_.comm,
               MPI_STATUS_IGNORE);
      map_ = multiply(map_, before_);
    }
    if (ranks_.rank + 1 < ranks_.size) {
      MPI_Send(map_.data(), count, MPI_DOUBLE, ranks_.rank + 1, 0, ranks_.comm);
    } else {
      map_ = coordinates_.of(turned(coordinates_.states_of(map_)));
    }
    ranks_.share(ranks_.size - 1, map_);
  }

  /// Applies P to (eta, eta_dot, xi). Their entries are unknowns, each divided by its own scale; P
  /// renames unknowns and changes signs.
  Eigen::MatrixXd turned(const Eigen::MatrixXd& reduced) const {
    if (sectors_ == 1) return reduced;
    const system::RotorSymmetry& symmetry = system_.symmetry();
    const Eigen::Index d = subspace_.degrees_of_freedom();
    Eigen::MatrixXd result(reduced.rows(), reduced.cols());
    const auto turn = [&](const std::vector<PetscInt>& unknowns, const std::vector<double>& scale,
                          const std::vector<Eigen::Index>& places) {
      for (std::size_t i = 0; i < unknowns.size(); ++i) {
        const auto unknown = static_cast<std::size_t>(unknowns[i]);
        const auto found = std::find(unknowns.begin(), unknowns.end(), symmetry.source[unknown]);
        if (found == unknowns.end()) throw InternalError("a coordinate without its image");
        const auto source = static_cast<std::size_t>(found - unknowns.begin());
        const double factor = symmetry.sign[unknown] * scale[source] / scale[i];
        for (const Eigen::Index place : places)
          result.row(place + static_cast<Eigen::Index>(i)) =
              factor * reduced.row(place + static_cast<Eigen::Index>(source));
      }
    };
    turn(subspace_.coordinates(), subspace_.scale(), {0, d});
    turn(subspace_.states(), subspace_.state_scale(), {2 * d});
    return result;
  }

  Complex principal_exponent(Complex multiplier) const {
    return std::log(multiplier) * static_cast<double>(sectors_) / system_.period();
  }

  /// Decay of a multiplier of this size [1/s].
  double decay_of(double size) const {
    return -std::log(size) * static_cast<double>(sectors_) / system_.period();
  }

  bool is_zero(Complex exponent) const { return std::abs(exponent) < zero_exponent * speed_; }

  /// Whether the step resolves an exponent lambda of the motion.
  bool in_reach(Complex exponent) const {
    return std::abs(exponent.imag()) <= rule_.reach() && std::abs(exponent.real()) <= rule_.reach();
  }
  /// The same for the harmonic k of the principal exponent of the steps.
  bool in_reach_at(Complex principal, int k) const {
    const Complex s = principal + Complex(0.0, k * speed_);
    return rule_.may_reach(s) && in_reach(unwarped(s, rule_));
  }

  /// All ranks use the result of the first one.
  void solve_eigenproblem() {
    const StateParts parts = find_state_parts(system_);
    ranks_.attempt([&] {
      if (ranks_.rank > 0) return;
      find_slow_exponents_of_shift();
      find_multipliers(parts);
    });
    ranks_.share(0, of_shift_);
    ranks_.share(0, set_.deflated);
    ranks_.share(0, set_.deflated_rate);
    ranks_.share(0, multipliers_);
    ranks_.share(0, conditions_);
    ranks_.share(0, leading_states_);
    ranks_.share(0, weights_);
    if (ranks_.rank > 0) weights_ = multiply(before_, weights_);
    before_.resize(0, 0);
    set_.modes.resize(multipliers_.size());
    for (std::size_t i = 0; i < set_.modes.size(); ++i) {
      exponents_.push_back(principal_exponent(multipliers_[i]));
      set_.modes[i].multiplier = std::pow(multipliers_[i], sectors_);
      if (leading_states_[i] >= 0)
        set_.modes[i].state = parts.owners[static_cast<std::size_t>(leading_states_[i])];
    }
  }

  void find_multipliers(const StateParts& parts) {
    Eigen::VectorXd conditions;
    const Eigenpairs pairs = massless_.eigenpairs_of(map_, "floquet_", &conditions);
    const std::vector<int> states =
        leading_states(pairs, 2 * subspace_.degrees_of_freedom(), parts);
    Eigen::MatrixXcd vectors(states_, states_);  // of the modes
    const auto keep = [&](Complex multiplier, const Eigen::VectorXcd& vector, std::size_t pair) {
      vectors.col(static_cast<Index>(multipliers_.size())) = vector;
      multipliers_.push_back(multiplier);
      conditions_.push_back(conditions(static_cast<Index>(pair)));
      leading_states_.push_back(states[pair]);
    };
    double largest = 1.0;
    for (const Complex value : pairs.values) largest = std::max(largest, std::abs(value));
    for (std::size_t i = 0; i < pairs.values.size(); ++i) {
      if (std::abs(pairs.values[i]) < least_multiplier * largest) {
        ++set_.deflated;
        set_.deflated_rate = std::min(set_.deflated_rate, decay_of(least_multiplier * largest));
        continue;
      }
      if (pairs.values[i].imag() < 0.0) continue;  // its conjugate is kept
      const Eigen::VectorXcd vector = pairs.vectors.col(static_cast<Eigen::Index>(i));
      const Complex exponent = principal_exponent(pairs.values[i]);
      const bool is_split = pairs.values[i].imag() > 0.0;
      if (is_split && is_zero(exponent)) {
        // Round-off has split a double zero into a complex pair. It is kept as two real modes, like
        // a double zero that round-off splits into two real exponents.
        keep(pairs.values[i].real(), real_part(vector), i);
        keep(pairs.values[i].real(), real_part(vector), i);
      } else if (is_split &&
                 std::abs(exponent.imag()) < least_imaginary * std::abs(exponent.real())) {
        // The same of a double decay, such as those of equal states of the air.
        const auto [one, other] = real_parts(vector);
        keep(pairs.values[i].real(), one, i);
        keep(pairs.values[i].real(), other, i);
      } else {
        keep(pairs.values[i], vector, i);
      }
    }
    weights_ = real_and_imaginary(vectors.leftCols(static_cast<Index>(multipliers_.size())));
  }

  /// Two real vectors in the plane of a complex one; the same one where there is no plane.
  static std::pair<Eigen::VectorXd, Eigen::VectorXd> real_parts(const Eigen::VectorXcd& vector) {
    constexpr double least = 1e-6;
    Index largest = 0;
    const double size = vector.cwiseAbs().maxCoeff(&largest);
    const Eigen::VectorXcd turned = vector * (std::conj(vector(largest)) / size);
    const Eigen::VectorXd one = turned.real();
    const Eigen::VectorXd other = turned.imag();
    return {one, other.norm() > least * one.norm() ? other : one};
  }

  /// Where the azimuth of the rotor is free and nothing else depends on the time, the rate of the
  /// steady state is a motion that the exact map leaves as it is; that of a few harmonics does not.
  /// The smallest change of the map that makes it do so moves the exponents by about the error of
  /// the steady state. Keeps those next to zero: several motions that nothing restores have next to
  /// equal vectors, and small errors move their exponents far.
  void find_slow_exponents_of_shift() {
    // Of several free coordinates in the rotor, the azimuth is the one that changes least.
    Eigen::MatrixXd shift;
    Eigen::MatrixXd defect;
    for (const PetscInt unknown : find_shifts_in_time(system_)) {
      const Eigen::MatrixXd one = shift_in_time(unknown);
      const Eigen::MatrixXd own = one - map_ * one;
      if (shift.size() > 0 && own.norm() / one.norm() >= defect.norm() / shift.norm()) continue;
      shift = one;
      defect = own;
    }
    if (shift.size() == 0) return;
    const Eigen::MatrixXd map = map_ + defect * shift.transpose() / shift.squaredNorm();
    for (const Complex multiplier : dense_eigenvalues(massless_.without(map)))
      if (const Complex exponent = principal_exponent(multiplier); is_slow(exponent))
        of_shift_.push_back(exponent);
  }

  /// The rate of the steady state with its azimuth, in energy coordinates.
  Eigen::MatrixXd shift_in_time(PetscInt azimuth) const {
    const int harmonics = solution_.harmonics();
    const Eigen::MatrixXd& series = solution_.coefficients();
    Eigen::VectorXd second = -PeriodicSolution::basis(harmonics, system_.period(), 0.0);
    for (Index i = 0; i < second.size(); ++i) {
      const Index harmonic = (i + 1) / 2;
      const double rate = static_cast<double>(harmonic) * speed_;
      second(i) *= rate * rate;
    }
    Eigen::MatrixXd rate = series * PeriodicSolution::basis_rate(harmonics, system_.period(), 0.0);
    rate(azimuth, 0) += speed_;
    const Index d = subspace_.degrees_of_freedom();
    Eigen::MatrixXd state(states_, 1);
    state.topRows(d) = subspace_.coordinates_of(rate);
    state.middleRows(d, d) = subspace_.coordinates_of(series * second);
    state.bottomRows(subspace_.first_order()) = subspace_.states_of(rate);
    return coordinates_.of(state);
  }

  bool is_slow(Complex exponent) const { return std::abs(exponent) < largest_slow * speed_; }

  /// Change of a slow exponent by the correction of the map.
  double change_of(Complex exponent) const {
    double change = std::numeric_limits<double>::infinity();
    for (const Complex exact : of_shift_)
      change =
          std::min({change, std::abs(exponent - exact), std::abs(std::conj(exponent) - exact)});
    return change;
  }

  static double real_parts(Complex exponent) {  // of a pair, of which one is listed
    return (exponent.imag() == 0.0 ? 1.0 : 2.0) * exponent.real();
  }

  /// Change of the sum of all slow exponents. Errors of the steady state change a sum of exponents
  /// in proportion, also where these are next to each other and move far.
  double change_of_sum() const {
    double sum = 0.0;
    double count = 0.0;
    for (const Complex exponent : exponents_)
      if (is_slow(exponent)) {
        sum += real_parts(exponent);
        count += exponent.imag() == 0.0 ? 1.0 : 2.0;
      }
    for (const Complex exact : of_shift_) sum -= exact.real();
    // One beyond the limit of slow ones tells nothing.
    return count == static_cast<double>(of_shift_.size()) ? std::abs(sum)
                                                          : std::numeric_limits<double>::infinity();
  }

  /// Largest change among the slow exponents that are not clearly apart from that of mode m.
  double mixed_change(std::size_t m) const {
    double change = 0.0;
    for (const Complex other : exponents_)
      if (is_slow(other) && std::abs(other - exponents_[m]) <= mixed * change_of(other))
        change = std::max(change, change_of(other));
    return change;
  }

  /// Error of the exponent of mode m by the steady state [1/s]; 0: not known.
  double error_of_solution(std::size_t m) const {
    return of_shift_.empty() || !is_slow(exponents_[m]) ? 0.0 : solution_safety * mixed_change(m);
  }

  /// Whether the sum of the exponents that mix with a growing one is known to be positive: one of
  /// them grows, whatever the error of each.
  bool is_known_to_grow(std::size_t m) const {
    if (of_shift_.empty() || !is_slow(exponents_[m]) || !(exponents_[m].real() > 0.0)) return false;
    const double largest = mixed_change(m);
    double sum = 0.0;
    for (const Complex other : exponents_)
      if (is_slow(other) && std::abs(other - exponents_[m]) <= mixed * largest &&
          change_of(other) > unmoved * largest)
        sum += real_parts(other);
    return solution_safety * change_of_sum() < sum;
  }

  /// The errors of the steady state do not hide a growth that is known.
  void limit_errors_of_solution() {
    for (std::size_t m = 0; m < set_.modes.size(); ++m) {
      Mode& mode = set_.modes[m];
      if (!is_known_to_grow(m)) continue;
      const double others = mode.growth_error - error_of_solution(m);
      mode.growth_error =
          std::min(mode.growth_error, std::max(others, largest_of_growth * mode.exponent.real()));
    }
  }

  // ---- identification --------------------------------------------------------------------------

  /// Weights of the states at the first step of this rank in the given modes: real part and
  /// imaginary part of one mode after the other.
  Eigen::MatrixXd weights_of(const std::vector<Index>& modes) const {
    Eigen::MatrixXd weights(states_, 2 * static_cast<Index>(modes.size()));
    for (std::size_t i = 0; i < modes.size(); ++i)
      weights.middleCols<2>(static_cast<Index>(2 * i)) = weights_.middleCols<2>(2 * modes[i]);
    return weights;
  }

  void identify() {
    const EnergyShares::Samples at{offset_ * dt_, dt_, samples_of_step_, steps_, sectors_};
    sampled_shares_ =
        EnergyShares(series_, at, ranks_)
            .describe({exponents_, leading_states_,
                       [this](const std::vector<Index>& modes) { return weights_of(modes); },
                       [this](std::size_t m, const Eigen::VectorXd& shares) {
                         return fast_share(m, shares);
                       }},
                      set_);
    find_displacements();
  }

  /// Finds displacements at rest that nothing restores: their kinetic energy is round-off, and at
  /// the middle of the first step they have their full size. (This is not so for a decay or a
  /// vibration too fast for the step.)
  void find_displacements() {
    std::vector<Eigen::Index> modes;
    for (std::size_t m = 0; m < set_.modes.size(); ++m)
      if (is_zero(exponents_[m]) && set_.modes[m].kinetic_energy < rest_energy &&
          !set_.modes[m].state)
        modes.push_back(static_cast<Eigen::Index>(m));
    if (modes.empty()) return;
    Eigen::MatrixXd first = shapes_of(modes, 1);
    ranks_.sum(first);
    Eigen::MatrixXd states = Eigen::MatrixXd::Zero(states_, first.cols());
    states.topRows(subspace_.degrees_of_freedom()) = subspace_.coordinates_of(first);
    states = coordinates_.of(states);
    for (std::size_t i = 0; i < modes.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(2 * i);
      if (states.middleCols<2>(column).squaredNorm() > 0.5) settle_rest(modes[i]);
    }
  }

  /// A mode that has no energy in any part. `harmonic`: of its positions.
  void settle_rest(Eigen::Index mode, int harmonic = 0) {
    Mode& at_rest = set_.modes[static_cast<std::size_t>(mode)];
    at_rest.parts.clear();
    at_rest.harmonic = harmonic;
    for (Eigen::MatrixXd* shares : {&set_.participation, &sampled_shares_}) {
      shares->row(mode).setZero();
      for (const int k : {-harmonic, harmonic}) (*shares)(mode, samples_ / 2 + k) += 0.5;
    }
  }

  /// |P z(T/Q) - mu z(0)| / |z(0)| in positions (times Omega), velocities and states, at the first
  /// sample and one sector later.
  double closure(const Eigen::Ref<const Eigen::VectorXcd>& begin,
                 const Eigen::Ref<const Eigen::VectorXcd>& end, Complex multiplier) const {
    double size = 0.0;
    double defect = 0.0;
    for (Eigen::Index i = 0; i < system_.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      const system::Unknown& unknown = system_.unknowns()[at];
      if (unknown.role == system::UnknownRole::internal || !system_.differential()[at]) continue;
      const double weight = unknown.role == system::UnknownRole::position
                                ? speed_ * speed_
                                : std::pow(unknown.scale, -2);
      size += weight * std::norm(begin(i));
      const Complex image =
          sectors_ == 1 ? end(i) : system_.symmetry().sign[at] * end(system_.symmetry().source[at]);
      defect += weight * std::norm(image - multiplier * begin(i));
    }
    return size > 0.0 ? std::sqrt(defect / size) : 0.0;
  }

  void find_residuals() {
    std::vector<Eigen::Index> modes(set_.modes.size());
    std::iota(modes.begin(), modes.end(), 0);
    first_ = shapes_of(modes, 1);
    Eigen::MatrixXd last = Eigen::MatrixXd::Zero(first_.rows(), first_.cols());
    if (end_.size() > 0) last = multiply(end_, weights_of(modes));
    ranks_.sum_on(0, first_);
    ranks_.sum_on(0, last);
    Eigen::VectorXd residuals = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(modes.size()));
    if (ranks_.rank == 0)
      for (const Eigen::Index m : modes)
        residuals(m) = closure(first_.col(2 * m) + 1i * first_.col(2 * m + 1),
                               last.col(2 * m) + 1i * last.col(2 * m + 1),
                               multipliers_[static_cast<std::size_t>(m)]);
    ranks_.sum(residuals);
    for (const Eigen::Index m : modes)
      set_.modes[static_cast<std::size_t>(m)].residual = residuals(m);
  }

  /// Whether the whole shape of mode m is needed: where the mode may count as resolved, where it
  /// may be at rest, and where a harmonic within reach, other than the identified one, has so much
  /// energy that it may be the one whose frequency is listed.
  bool needs_shape(std::size_t m) const {
    const Complex exponent = exponents_[m];
    if (set_.modes[m].residual > largest_residual) return false;
    if (is_zero(exponent)) return true;
    const bool is_fast = is_too_fast(m);
    if (exponent.imag() == 0.0 || is_drift(exponent, speed_)) return !is_fast;
    const int own = set_.modes[m].harmonic;
    for (Index i = 0; i < samples_; ++i) {
      const auto other = static_cast<int>(i - samples_ / 2);
      if (other != own && set_.participation(static_cast<Index>(m), i) > least_share_of_own &&
          in_reach_at(exponent, other))
        return true;
    }
    return !is_fast && in_reach_at(exponent, own) && spread_at(m, own).modulus <= most_spread();
  }

  /// Collects the whole shapes of the modes that need them; for the other modes only as many
  /// instants as their names need.
  void collect_shapes() {
    std::vector<Index> trusted;
    std::vector<Index> others;
    for (std::size_t m = 0; m < set_.modes.size(); ++m)
      (needs_shape(m) ? trusted : others).push_back(static_cast<Index>(m));
    ranks_.share(0, trusted);  // limits may differ by round-off
    ranks_.share(0, others);
    const Index instants = (span_ + stride_ - 1) / stride_;
    set_.shapes.resize(ranks_.rank == 0 ? set_.modes.size() : 0);
    expand_shapes(trusted, instants);
    expand_shapes(others, std::min(instants, (label_samples + sectors_ - 1) / sectors_));
    first_.resize(0, 0);
    settle_rigid_body_modes();
  }

  /// The modes at the first `instants` of the shapes: real part and imaginary part of one mode
  /// after the other. Zero where another rank has integrated them.
  Eigen::MatrixXd shapes_of(const std::vector<Eigen::Index>& modes, Eigen::Index instants) const {
    const Eigen::Index n = system_.size();
    Eigen::MatrixXd values =
        Eigen::MatrixXd::Zero(n * instants, 2 * static_cast<Eigen::Index>(modes.size()));
    const auto count = std::lower_bound(shape_numbers_.begin(), shape_numbers_.end(), instants) -
                       shape_numbers_.begin();
    if (count == 0) return values;
    Eigen::MatrixXd own;
    multiply(shapes_.topRows(n * count), weights_of(modes), own);
    values.middleRows(n * shape_numbers_.front(), n * count) = own;
    return values;
  }

  /// The first `instants` of a sector, continued over the period.
  void expand_shapes(const std::vector<Eigen::Index>& modes, Eigen::Index instants) {
    const Eigen::Index n = system_.size();
    Eigen::MatrixXd values;
    if (instants > 1) {
      values = shapes_of(modes, instants);
      ranks_.sum_on(0, values);
    }
    if (ranks_.rank != 0) return;
    if (instants == 1) {
      values.resize(n, 2 * static_cast<Index>(modes.size()));
      for (std::size_t i = 0; i < modes.size(); ++i)
        values.middleCols<2>(2 * static_cast<Index>(i)) = first_.middleCols<2>(2 * modes[i]);
    }
    for (std::size_t i = 0; i < modes.size(); ++i) {
      const auto m = static_cast<std::size_t>(modes[i]);
      const SectorMotion motion{values.col(2 * static_cast<Eigen::Index>(i)).data(), n, instants,
                                offset_ * dt_, static_cast<double>(stride_) * dt_};
      set_.shapes[m] = shape_over_period(system_.symmetry(), sectors_, motion, exponents_[m]);
    }
  }

  /// A real growth or decay of the joints alone, a slow drift, or an exponent that counts as zero,
  /// is no oscillation: its harmonics in rotor axes come from the rotation of these axes. A
  /// motion that changes sign with every step, or nearly so, is excluded: it is a decay too fast
  /// for the step.
  void settle_rigid_body_modes() {
    Eigen::VectorXd harmonics = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(set_.modes.size()));
    if (ranks_.rank == 0) {
      for (std::size_t m = 0; m < set_.modes.size(); ++m) {
        Mode mode = set_.modes[m];
        mode.exponent = exponents_[m];
        const bool real = exponents_[m].imag() == 0.0 && !mode.state &&
                          is_rigid_body(system_, set_.shapes[m], mode);
        const bool is_slow = !mode.state && is_drift(exponents_[m], speed_);
        if ((is_zero(exponents_[m]) || real || is_slow) && !is_too_fast(m))
          harmonics(static_cast<Eigen::Index>(m)) = harmonic_of_positions(system_, set_.shapes[m]);
        else
          harmonics(static_cast<Eigen::Index>(m)) = set_.modes[m].harmonic;
      }
    }
    ranks_.sum(harmonics);
    for (std::size_t m = 0; m < set_.modes.size(); ++m) {
      Mode& mode = set_.modes[m];
      mode.harmonic = static_cast<int>(std::lround(harmonics(static_cast<Eigen::Index>(m))));
      if (mode.harmonic != 0 && mode.parts.empty())
        settle_rest(static_cast<Eigen::Index>(m), mode.harmonic);
    }
  }

  // ---- the result ------------------------------------------------------------------------------

  /// Share of the energy of mode m in harmonics that the step does not resolve.
  double fast_share(std::size_t m, const Eigen::VectorXd& shares) const {
    double share = 0.0;
    for (Index i = 0; i < samples_; ++i)
      if (!in_reach_at(exponents_[m], static_cast<int>(i - samples_ / 2))) share += shares(i);
    return share;
  }

  bool is_too_fast(std::size_t m) const {
    return fast_share(m, sampled_shares_.row(static_cast<Index>(m))) > largest_fast_share;
  }

  WarpingSpread spread_at(std::size_t m, int harmonic) const {
    return warping_spread(exponents_[m], set_.participation.row(static_cast<Index>(m)),
                          -static_cast<int>(samples_ / 2), harmonic, speed_, rule_);
  }
  double most_spread() const { return largest_branch_error * sectors_ * speed_; }

  /// Adds the harmonic of mode m to the exponent, maps the warping by the step back and chooses the
  /// conjugate with Im >= 0. May be called again with another harmonic.
  void settle(std::size_t m) {
    Mode& mode = set_.modes[m];
    const bool slow = !is_too_fast(m);
    const WarpingSpread spread = spread_at(m, mode.harmonic);
    mode.step_exponent = exponents_[m] + Complex(0.0, mode.harmonic * speed_);
    mode.exponent = unwarped(mode.step_exponent, rule_);
    if (mode.exponent.imag() < -zero_exponent * speed_) conjugate(m);
    const double size = std::abs(mode.exponent);
    mode.damping_ratio = is_zero(mode.exponent) ? 0.0 : -mode.exponent.real() / size;
    if (!is_zero(mode.exponent)) {
      mode.step_error = spread.modulus / size;
      mode.round_off_error = conditions_[m] * relative_residual(m) /
                             (size * system_.period() / static_cast<double>(sectors_));
    }
    const double noise = least_imaginary * (size + std::abs(mode.harmonic) * speed_);
    if (std::abs(mode.exponent.imag()) < noise) {  // real in the axes that k belongs to
      mode.exponent.imag(0.0);
      mode.step_exponent.imag(0.0);
    }
    set_growth_error(mode, spread, may_be_free(m) ? exponents_[m] : far_from_zero, conditions_[m]);
    if (!is_zero(mode.exponent)) mode.growth_error += error_of_solution(m);
    mode.resolved = slow && in_reach_at(exponents_[m], mode.harmonic) &&
                    mode.residual <= largest_residual && mode.step_error <= accuracy_ &&
                    spread.modulus <= most_spread();
  }

  /// Replaces mode m by its conjugate, which represents the pair from then on.
  void conjugate(std::size_t m) {
    exponents_[m] = std::conj(exponents_[m]);
    conjugate_mode(set_, m);
    mirror_harmonics(static_cast<Eigen::Index>(m), sampled_shares_);
  }

  /// Whether a mode may be a motion that nothing restores: its multiplier is among those nearest to
  /// one, two for each of these motions.
  bool may_be_free(std::size_t m) const {
    const std::size_t most = 2 * system_.unconstrained_coordinates().size();
    const auto nearer = std::count_if(exponents_.begin(), exponents_.end(), [&](Complex other) {
      return std::abs(other) < std::abs(exponents_[m]);
    });
    return static_cast<std::size_t>(nearer) < most;
  }

  double relative_residual(std::size_t m) const {
    return set_.modes[m].residual / std::abs(multipliers_[m]);
  }

  /// Whether a multiplier is small enough, and its error large enough, to be round-off.
  bool is_round_off(std::size_t m) const {
    return std::abs(multipliers_[m]) < small_multiplier &&
           set_.modes[m].round_off_error > largest_round_off;
  }

  /// Counts modes that are round-off as deflated, and removes them.
  void drop_round_off() {
    std::vector<Eigen::Index> kept;
    for (std::size_t m = 0; m < set_.modes.size(); ++m) {
      if (is_round_off(m)) {
        set_.deflated += multipliers_[m].imag() == 0.0 ? 1 : 2;
        set_.deflated_rate = std::min(set_.deflated_rate, decay_of(std::abs(multipliers_[m])));
        continue;
      }
      const std::size_t at = kept.size();
      multipliers_[at] = multipliers_[m];
      exponents_[at] = exponents_[m];
      conditions_[at] = conditions_[m];
      if (at != m) set_.modes[at] = std::move(set_.modes[m]);
      if (at != m && !set_.shapes.empty()) set_.shapes[at] = std::move(set_.shapes[m]);
      kept.push_back(static_cast<Eigen::Index>(m));
    }
    multipliers_.resize(kept.size());
    exponents_.resize(kept.size());
    conditions_.resize(kept.size());
    set_.modes.resize(kept.size());
    if (!set_.shapes.empty()) set_.shapes.resize(kept.size());
    set_.participation = set_.participation(kept, Eigen::all).eval();
    sampled_shares_ = sampled_shares_(kept, Eigen::all).eval();
  }

  Floquet finish() {
    for (std::size_t m = 0; m < set_.modes.size(); ++m) settle(m);
    drop_round_off();
    set_.degrees_of_freedom = subspace_.degrees_of_freedom() - massless_.directions();
    set_.rotor_speed = speed_;
    set_.step = rule_.step;
    set_.conservative = system_.is_conservative();
    set_.first_harmonic = -samples_ / 2;
    set_.states = static_cast<int>(states_) - massless_.count();
    for (const Complex multiplier : multipliers_) set_.found += multiplier.imag() == 0.0 ? 1 : 2;
    if (set_.found + set_.deflated != set_.states)
      throw InternalError("floquet: " + std::to_string(set_.found) + " exponents found and " +
                          std::to_string(set_.deflated) + " deflated of " +
                          std::to_string(set_.states));
    const Eigen::Index columns = (span_ + stride_ - 1) / stride_;
    for (int q = 0; q < sectors_; ++q)
      for (Eigen::Index k = 0; k < columns; ++k)
        set_.shape_times.push_back((static_cast<double>(q * span_ + k * stride_) + offset_) * dt_);
    const std::vector<LeadingMotion> leading = separate_motions(system_, solution_, set_, sectors_);
    move_to_leading(leading);
    set_.reach = rule_.reach();
    for (const Mode& mode : set_.modes)
      if (!mode.resolved && !is_of_medium(mode))
        set_.reach = std::min(set_.reach, std::abs(mode.exponent));
    find_mesh_errors();
    limit_errors_of_solution();
    name_modes(system_, leading, set_, sectors_);
    share_names();
    arrange_modes(set_);
    scale_shapes(system_, set_);
    for (std::size_t m = 0; m < set_.shapes.size(); ++m) {
      if (!set_.modes[m].resolved)
        set_.shapes[m].resize(0, 0);
      else if (set_.shapes[m].cols() != static_cast<Index>(set_.shape_times.size()))
        throw InternalError("floquet: mode " + std::to_string(m + 1) +
                            " is resolved, but its shape has few instants");
    }
    Floquet result;
    result.steps = static_cast<int>(steps_) * sectors_;
    result.order = rule_.order;
    result.sectors = sectors_;
    result.step = rule_.step;
    result.set = std::move(set_);
    return result;
  }

  /// The frequency of a mode is that of the motion it is named after, which may have another
  /// harmonic than the part with most kinetic energy. Only the first rank knows these motions.
  void move_to_leading(const std::vector<LeadingMotion>& leading) {
    Eigen::VectorXd shifts = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(set_.modes.size()));
    for (std::size_t m = 0; m < leading.size(); ++m)
      shifts(static_cast<Eigen::Index>(m)) = leading[m].harmonic - set_.modes[m].harmonic;
    ranks_.sum(shifts);
    for (std::size_t m = 0; m < set_.modes.size(); ++m) {
      const auto shift = static_cast<int>(std::lround(shifts(static_cast<Eigen::Index>(m))));
      if (shift == 0) continue;
      set_.modes[m].harmonic += shift;
      settle(m);
    }
  }

  /// Finds the mesh errors from the shapes, which only the first rank has.
  void find_mesh_errors() {
    const std::vector<system::MeshError> elements = system_.mesh_errors();
    Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(2, static_cast<Eigen::Index>(set_.modes.size()));
    for (std::size_t m = 0; m < set_.shapes.size(); ++m)
      if (set_.modes[m].resolved && !is_zero(set_.modes[m].exponent))
        errors.block<2, 1>(0, static_cast<Eigen::Index>(m)) =
            find_mesh_error(system_, elements, set_.modes[m], set_.shapes[m]);
    ranks_.sum(errors);
    for (std::size_t m = 0; m < set_.modes.size(); ++m)
      add_mesh_error(set_.modes[m], errors.col(static_cast<Eigen::Index>(m)));
  }

  /// Names come from the shapes, which only the first rank has.
  void share_names() {
    ranks_.share(0, set_.instances);
    for (Mode& mode : set_.modes) share_mode(ranks_, 0, mode);
  }

  const system::PeriodicSystem& system_;
  const PeriodicSolution& solution_;
  Ranks ranks_;
  Observer& observer_;
  ConsistentSubspace subspace_;
  int sectors_;
  TimeRule rule_;
  double accuracy_;  ///< largest error by the step of a resolved mode
  long steps_;       ///< in a sector
  int samples_of_step_;
  double offset_;  ///< of the first sample, in distances between samples
  int samples_;    ///< in a period
  long span_;      ///< samples in a sector
  double dt_;      ///< between samples [s]
  double speed_;
  Eigen::Index states_;
  SignalSeries series_;
  long stride_;
  std::vector<long> shape_numbers_;  ///< of the shapes in shapes_, ascending
  Eigen::MatrixXd shapes_;  ///< all unknowns at every stride-th sample of this rank x states
  Eigen::MatrixXd
      end_;  ///< all unknowns at the first sample after the sector; empty on other ranks
  Eigen::MatrixXd first_;   ///< all modes at the first sample, on the first rank: see shapes_of()
  Eigen::MatrixXd before_;  ///< map from the start to the first step of this rank
  EnergyCoordinates coordinates_;     ///< of the states at the start
  MasslessStates massless_;           ///< the same
  std::vector<Complex> of_shift_;     ///< see find_slow_exponents_of_shift()
  Eigen::MatrixXd map_;               ///< over a sector, in these coordinates
  std::vector<Complex> multipliers_;  ///< of the sector
  std::vector<double> conditions_;    ///< of the multipliers
  std::vector<int> leading_states_;   ///< see leading_states(); with those of dropped modes
  std::vector<Complex> exponents_;    ///< principal
  Eigen::MatrixXd weights_;           ///< of all modes, see weights_of()
  Eigen::MatrixXd sampled_shares_;    ///< of the harmonics, at all samples; modes x harmonics
  ModeSet set_;                       ///< the result; only the first rank has the shapes
};

}  // namespace

namespace {

/// Number of the slowest modes that the steps are to resolve.
int count_to_resolve(const FloquetOptions& options) {
  return asks_for_some(options) ? wanted_modes(options) : first_modes;
}

/// Number of steps in a revolution whose reach is beyond the slowest modes, as the tangents at the
/// start have them.
double choose_steps(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                    const FloquetOptions& options) {
  const int count = count_to_resolve(options);
  const std::vector<double> moduli = find_moduli_at_start(system, solution, count);
  if (moduli.empty()) return least_steps;
  const double speed = 2.0 * std::numbers::pi / system.period();
  const double last = moduli[std::min(moduli.size(), static_cast<std::size_t>(count)) - 1];
  const double reach = reach_factor * (last + reach_harmonics * speed);
  double steps = reach / TimeRule{options.order, system.period()}.reach();
  // Slow exponents of a medium are among these moduli, but not among the modes asked for.
  if (asks_for_some(options) && system::has_medium(system.unknowns()))
    steps = std::max(steps, steps_of_mode_in_medium * count);
  if (options.least_damped > 0) steps *= steps_of_slow_decays;
  return std::clamp(steps, static_cast<double>(least_steps), most_steps);
}

HillTime hill_time(const system::PeriodicSystem& system, const FloquetOptions& options) {
  const bool has_few = system.symmetry().sectors < 3;
  if (system::has_medium(system.unknowns()))
    return has_few ? hill_in_medium_of_few : hill_in_medium;
  if (options.least_damped > 0) return has_few ? hill_of_slow_decays_of_few : hill_of_slow_decays;
  return has_few ? hill_of_slow_modes_of_few : hill_of_slow_modes;
}

/// Whether all modes, with this number of steps in a sector, take less time than some by Hill's
/// method, as far as it can be foreseen.
bool all_modes_take_less(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                         const FloquetOptions& options, double steps) {
  const auto states = static_cast<double>(ConsistentSubspace(system, solution).size());
  const auto unknowns = static_cast<double>(system.size());
  const double integration =
      steps * unknowns * (step_of_unknown + step_of_unknown_and_state * states) +
      eigenproblem_of_state * states * states * states;
  const auto [of_unknown, of_unknown_and_mode] = hill_time(system, options);
  return integration < unknowns * (of_unknown + of_unknown_and_mode * count_to_resolve(options));
}

/// Factor of the number of steps that resolves the slowest modes, with the accuracy where one is
/// asked for, or so many that those asked for are among them; 1 where they are.
double increase_of(const ModeSet& set, const FloquetOptions& options) {
  std::vector<const Mode*> modes;
  for (const Mode& mode : set.modes)
    if (!is_of_medium(mode)) modes.push_back(&mode);
  std::sort(modes.begin(), modes.end(), [](const Mode* a, const Mode* b) {
    return std::abs(a->exponent) < std::abs(b->exponent);
  });
  modes.resize(std::min(modes.size(), static_cast<std::size_t>(count_to_resolve(options))));
  double factor = 1.0;
  if (const std::optional<double> reach = lacking_reach(set, options))
    factor = std::clamp(*reach / set.reach, least_increase, most_increase);
  // Frequencies of bending grow at most with the square of their number.
  const auto resolved =
      std::count_if(modes.begin(), modes.end(), [](const Mode* mode) { return mode->resolved; });
  const double lacking =
      static_cast<double>(modes.size()) / std::max(1.0, static_cast<double>(resolved));
  const double increase = std::clamp(lacking * lacking, usual_increase, most_increase);
  for (const Mode* mode : modes) {
    if (mode->resolved) continue;
    const bool is_known =
        options.accuracy && mode->step_error > *options.accuracy && mode->step_error < 1.0;
    const double wanted =
        is_known ? step_margin * std::pow(mode->step_error / *options.accuracy, 1.0 / options.order)
                 : increase;
    factor = std::max(factor, std::clamp(wanted, least_increase, most_increase));
  }
  return factor;
}

}  // namespace

Floquet find_floquet_modes(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                           const FloquetOptions& options, MPI_Comm comm, Observer& observer) {
  if (system.period() == 0.0)
    throw InputError("floquet: the rotor stands still; hint: use samara modes");
  const int repeats = system.symmetry().sectors;
  const int sectors = options.period == FloquetPeriod::full ? 1 : repeats;
  const Ranks ranks(comm);
  std::optional<double> chosen;  // steps a revolution
  const auto steps_for_modes = [&] {
    if (!chosen) {
      double steps = options.steps > 0 ? options.steps : choose_steps(system, solution, options);
      ranks.share(0, steps);  // estimates may differ by round-off
      chosen = steps;
    }
    return *chosen;
  };
  if (asks_for_some(options) && options.search != ModeSearch::all) {
    bool takes_less = false;
    if (options.search == ModeSearch::automatic && !options.near_hz &&
        system.size() <= most_unknowns)
      takes_less = all_modes_take_less(system, solution, options, steps_for_modes() / sectors);
    ranks.share(0, takes_less);
    if (!takes_less) {
      if (std::optional<Floquet> found = find_hill_modes(system, solution, options, comm))
        return std::move(*found);
      observer.note("floquet: all modes, because the mesh is too coarse for Hill's method");
    }
  }
  if (options.period == FloquetPeriod::blade && repeats < 2)
    throw InputError(
        "floquet.period: blade needs two or more identical blades" +
        (system.symmetry().broken_by.empty() ? "" : ": " + system.symmetry().broken_by) +
        "; hint: auto");
  const std::string& broken_by = system.symmetry().broken_by;
  if (options.period == FloquetPeriod::automatic && !broken_by.empty())
    observer.note("floquet: full period, because " + broken_by);
  const auto run = [&](int steps) {
    return Analysis(system, solution, sectors, steps, options, ranks, observer).run();
  };
  const auto wanted_of = [&options](Floquet found) {
    if (asks_for_some(options)) leave_wanted(found.set, options);
    return found;
  };
  const auto whole = [sectors](double steps) { return whole_sectors(steps, sectors); };
  if (options.steps > 0) {
    const int steps = whole(options.steps);
    if (steps != options.steps)
      observer.note("floquet: " + std::to_string(steps) +
                    " steps a revolution, a multiple of the " + std::to_string(sectors) +
                    " blades");
    return wanted_of(run(steps));
  }
  int steps = whole(steps_for_modes());
  for (int attempt = 1;; ++attempt) {
    Floquet found = run(steps);
    const double factor = increase_of(found.set, options);
    if (factor <= 1.0 || attempt == most_attempts || steps >= most_steps)
      return wanted_of(std::move(found));
    steps = std::max(whole(std::min(steps * factor, most_steps)), steps + sectors);
    observer.note("floquet: the " +
                  (asks_for_some(options) ? "wanted" : std::string("ten slowest")) +
                  " modes need more steps, " + std::to_string(steps) + " a revolution");
  }
}

}  // namespace samara::analysis
