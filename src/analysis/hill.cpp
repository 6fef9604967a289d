#include "samara/analysis/hill.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>

#include "samara/analysis/harmonic_energy.hpp"
#include "samara/analysis/identification.hpp"
#include "samara/analysis/linear_algebra.hpp"
#include "samara/analysis/mode_error.hpp"
#include "samara/analysis/ranks.hpp"
#include "samara/base/error.hpp"
#include "samara/petsc/session.hpp"

#include "hill_groups.hpp"
#include "hill_participation.hpp"
#include "hill_pencil.hpp"
#include "hill_search.hpp"
#include "least_damped_search.hpp"
#include "mesh_partition.hpp"
#include "mode_selection.hpp"
#include "mode_sharing.hpp"
#include "sector_motion.hpp"
#include "state_parts.hpp"

namespace samara::analysis {
namespace {

using Complex = std::complex<double>;
using Index = Eigen::Index;
using namespace std::complex_literals;

/// Harmonics of the search, where they are not the multiblade coordinates of three identical blades
/// or more: those that couple rotor and tower. The more there are, the more copies the search
/// finds.
constexpr int search_harmonics = 2;
/// Harmonics of the modes: the first attempt, the largest factor from one attempt to the next and
/// the last attempt.
constexpr int least_harmonics = 4;
constexpr double most_increase = 4.0;
constexpr int most_harmonics = 60;
/// Residual of a mode in the time domain that is wanted, and the largest one of a resolved mode.
struct Accuracy {
  double wanted;
  double largest;
};
constexpr Accuracy of_residual{1e-8, 1e-6};
/// The same for the change of an exponent from one number of harmonics to twice as many, with a
/// medium.
constexpr Accuracy of_change{3e-4, 1e-2};
/// The part of it that is wanted of the first change, which is that from the search: this one can
/// be small by chance, because the search has only the harmonics of constant tangents.
constexpr double first_change = 0.1;
constexpr double increase_with_medium = 2.0;
/// Wanted change of a growth, relative to itself or to this part of the exponent.
constexpr double wanted_change = 1e-3;
constexpr double least_growth = 0.01;
/// Relative to an exponent: a smaller imaginary part is less than its changes.
constexpr double least_imaginary = 1e-4;
/// The first shift, relative to the rotor speed: a medium has decays at 0 and 1, where its answer
/// varies fast.
constexpr double between_copies = 1.5;
/// Distance of an edge of a region from such decays, relative to the rotor speed.
constexpr double beside_medium = 0.1;
/// The region of a search without the states of a medium ends between the decays of its pairs, at
/// this factor of the largest one at most.
constexpr double beyond_decays = 1.5;
constexpr int most_edges = 4;  ///< other places of its end where it cannot be counted
/// The parts of the decay of a region between which a narrower one ends, and the number of them.
constexpr double narrowest = 0.2;
constexpr double narrower = 0.6;
constexpr int most_narrower = 4;
/// Distance from an exponent of the medium alone, relative to the decay, up to which a mode may be
/// one of the medium.
constexpr double next_to_medium = 0.2;
/// The highest frequency of a mode of the medium, relative to the rotor speed: its parts decay in
/// axes of the rotor or of the ground.
constexpr double highest_of_medium = 1.5;
/// Damping ratio up to which modes are told from those of the medium.
constexpr double largest_damping_with_medium = 0.9;
/// Least decay at which a region in a medium ends, relative to the rotor speed.
constexpr double least_decay = 0.1;
/// Relative residual of eigenpairs in their truncated series: with the first number of harmonics,
/// which may not be the last, and the one that is wanted. With a medium, the change from one number
/// of harmonics to the next is much larger.
struct Tolerance {
  double first;
  double last;
};
constexpr Tolerance of_series{1e-7, 1e-10};
constexpr Tolerance of_series_with_medium{1e-7, 1e-8};
/// Correlation of the largest harmonics of an eigenpair and of its copy.
constexpr double same_shape = 0.7;
/// Correlation of the series of one motion that was found twice.
constexpr double same_series = 0.95;
/// Harmonics at the edges of a series, and their part in a copy.
constexpr Index edge_harmonics = 2;
constexpr double edge_part = 1e-3;
/// Factor by which a residual falls with each harmonic, at least. (Cancellation in the tangents
/// limits some residuals.)
constexpr double slowest_decay = 0.93;
/// Eigenpairs of a shift.
constexpr int least_pairs = 24;
constexpr int margin_pairs = 6;
constexpr int most_pairs = 100;
constexpr int most_regions = 200;
/// Ranges in a row without a pair, above which no others are expected. Each is about as high as all
/// before it.
constexpr int most_empty = 3;
/// The search ends at this factor of the largest exponent then, with its copies.
constexpr double above_last = 2.0;
/// Relative to the rotor speed: slack of the edges of the region, and distance of a copy in the
/// search from where it should be, and of refined exponents that are the same.
constexpr double edge_slack = 1.0;
constexpr double same_copy = 0.25;
constexpr double same_exponent = 1e-6;
/// Largest distance of copies of a mode with a medium, relative to the exponent or to the rotor
/// speed; their distance relative to their errors, the changes since fewer harmonics.
constexpr double same_with_medium = 1e-2;
constexpr double beyond_errors = 10.0;
/// Distance from the copy of a conjugate up to which both may be coupled, relative to the last
/// change of the exponent.
constexpr double beyond_change = 100.0;
/// A pair is a copy of its own conjugate where these are next to each other, compared with the
/// distance from other pairs.
constexpr double clearly_nearer = 0.1;
/// Relative to the rotor speed: distance of two exponents between which the edge of a region may
/// be.
constexpr double least_gap = 0.01;
/// The highest edge of a region of constant tangents, relative to the lowest one that is enough.
constexpr double highest_edge = 1.3;
/// An exponent of constant tangents below this factor of the square root of its residual, and below
/// this part of the rotor speed (or 1 rad/s), may be that of a double zero.
constexpr double most_split = 3.0;
constexpr double largest_split = 1e-4;
/// Relative to the rotor speed: an exponent below this, in the search, is that of a displacement.
constexpr double at_rest = 2e-3;
constexpr int shape_samples = 24;
/// Smallest piece of a distributed mesh, in blocks, and more of them for each block at a cut. These
/// join the border with all harmonics, and smaller meshes are faster with groups of modes on each
/// rank. In a medium, searches and counts take most of the time and gain from smaller meshes on,
/// but a mode has more harmonics.
constexpr Index least_piece = 150;
constexpr Index of_cut = 150;
constexpr Index least_piece_in_medium = 100;
constexpr Index of_cut_in_medium = 450;
constexpr Index free_of_cut_in_medium = 3;
/// Steps a revolution and multipliers of the search for the slowest decays; the factor of steps
/// where all multipliers were found, but not enough, and that of multipliers; the largest number of
/// steps, and that of attempts.
constexpr int steps_of_decays = 36;
constexpr int least_multipliers = 32;
constexpr double increase_of_all = 2.0;
constexpr double usual_increase = 1.6;
constexpr int most_steps_of_decays = 240;
constexpr int most_attempts = 8;
/// Relative to the rotor speed: distance of exponents of a motion by the steps and by refinement.
constexpr double same_motion = 0.2;
/// A decay is left out where it is larger than the wanted ones by this, beyond the errors of both.
constexpr double clear_difference = 1e-3;

/// An eigenpair with its identification.
struct Candidate {
  HillPair pair;
  Mode mode;
  Eigen::VectorXd participation;
  double residual = std::numeric_limits<double>::infinity();
  bool is_found = false;     ///< an eigenpair of the truncated series
  bool is_own_copy = false;  ///< see Analysis::mark_own_copies()
};

class Analysis {
 public:
  /// `is_constant`: the tangents are constant, and exponents have no copies.
  Analysis(const system::PeriodicSystem& system, const PeriodicSolution& solution,
           const FloquetOptions& options, MPI_Comm comm, bool is_constant)
      : system_(system),
        solution_(solution),
        options_(options),
        all_ranks_(comm),
        is_constant_(is_constant),
        has_medium_(system::has_medium(system.unknowns())),
        mesh_(divided_mesh()),
        ranks_(mesh_ ? Ranks(MPI_COMM_SELF) : all_ranks_),
        speed_(base_rate(system)),
        energy_(system),
        parts_(find_state_parts(system)) {}

  std::optional<Floquet> run() {
    {
      const petsc::Stage stage("Hill: search");
      ranks_.attempt([&] { search(); });
      if (!pencil_) return std::nullopt;
      if ((options_.least_damped == 0 || is_by_region()) && !counts_refined()) count_missing();
    }
    {
      const petsc::Stage stage("Hill: refinement");
      refine();
    }
    const petsc::Stage stage("Hill: identification");
    choose();
    return finish();
  }

 private:
  /// The mesh over the ranks, where it is large enough. The search for the slowest decays by
  /// integration needs it whole.
  std::optional<MeshPartition> divided_mesh() const {
    std::optional<MeshPartition> mesh;
    if (all_ranks_.size == 1 || (options_.least_damped > 0 && !is_by_region())) return mesh;
    MeshPartition::Limits limits;
    limits.is_for_all = true;
    limits.keeps_medium = true;
    if (!is_constant_) {
      limits.least_piece = has_medium_ ? least_piece_in_medium : least_piece;
      limits.of_cut = has_medium_ ? of_cut_in_medium : of_cut;
      limits.free_of_cut = has_medium_ ? free_of_cut_in_medium : 0;
    }
    mesh.emplace(system_, Coordinates{}, !is_constant_, all_ranks_.comm, limits);
    if (!mesh->is_distributed()) mesh.reset();
    return mesh;
  }

  /// The pencil with a number of harmonics, which is kept until another one is asked for. Shapes
  /// get the samples that it needs.
  HillPencil& pencil_of(int harmonics) {
    if (pencil_ && pencil_->harmonics() != harmonics) pencil_.reset();
    if (!pencil_ && mesh_)
      pencil_.emplace(*mesh_, solution_, harmonics);
    else if (!pencil_)
      pencil_.emplace(system_, solution_, harmonics, !is_constant_);
    const Index least = is_constant_ ? 1 : std::max(shape_samples, 4 * harmonics + 2);
    samples_ = std::max(samples_, least);
    return *pencil_;
  }
  /// Of the refinement.
  int first_harmonics() const {
    if (is_constant_) return 0;
    return std::max(least_harmonics, has_medium_ ? 2 * search_harmonics_ : solution_.harmonics());
  }

  /// Finds approximate exponents with few harmonics, from the real axis upwards, or from
  /// `near_hz` to both sides. There is no pencil where the structure of the system does not serve.
  void search() {
    const int sectors = system_.symmetry().sectors;
    const int of_turning = sectors > 2 ? sectors / 2 : search_harmonics;
    const int harmonics = is_constant_ ? 0 : of_turning;
    HillPencil& pencil = pencil_of(harmonics);
    if (!pencil.is_solvable()) {
      pencil_.reset();
      return;
    }
    if (has_medium_) medium_exponents_ = pencil.exponents_of_medium();
    search_harmonics_ = harmonics;
    sectors_ = pencil.sectors();
    nearest_ = sectors_ / 2;
    if (options_.least_damped > 0 && !is_by_region()) {
      search_decays();
      return;
    }
    HillSearch search(pencil);
    if (options_.near_hz)
      search_near(search, 2.0 * std::numbers::pi * *options_.near_hz);
    else
      search_upwards(search);
    if (!options_.near_hz) lower_edge();
    if (has_medium_) lower_decay();
    // Slow modes have no larger decay: those of strong damping are left out.
    region_.decay = std::min(region_.decay, region_.high);
    region_.growth = std::min(region_.growth, region_.high);
    std::erase_if(found_, [this](const Candidate& candidate) {
      return candidate.pair.exponent.imag() > region_.high || !is_in_width(candidate);
    });
    expected_ = centred(options_.least_damped > 0 ? std::numeric_limits<double>::infinity()
                                                  : region_.high - slack());
  }

  /// Counts the eigenvalues in the region, that of the first rank.
  void count_missing() {
    for (double* value : {&region_.low, &region_.high, &region_.decay, &region_.growth})
      all_ranks_.share(0, *value);
    all_ranks_.share(0, all_found_);
    all_ranks_.share(0, expected_);
    all_ranks_.share(0, needed_decay_);
    all_ranks_.share(0, decays_);
    HillSearch search(*pencil_);
    region_is_counted_ = is_complete(search, region_);
    if (!has_medium_) return;
    // Next to exponents of the medium, the preconditioner may not serve.
    const double first = region_.decay;
    for (int i = 0; i < most_edges && !region_is_counted_; ++i) {
      const double width = (beyond_decays - 1.0) * needed_decay_ / most_edges;
      region_.decay = middle_of_gap(needed_decay_ + i * width, needed_decay_ + (i + 1) * width);
      region_is_counted_ = is_complete(search, region_);
    }
    if (!region_is_counted_) region_.decay = first;
    // Modes of strong damping may not be told from those of the medium. A missing mode of weaker
    // damping and one of the medium may cancel: a narrower region is to be complete as well.
    HillRegion part = region_;
    for (int i = 0; i < most_narrower; ++i) {
      part.decay = middle_of_gap(narrowest * part.decay, narrower * part.decay);
      if (part.decay < least_decay * speed_) return;
      if (!is_complete(search, part)) continue;
      if (!region_is_counted_) region_.decay = part.decay;
      region_is_counted_ = true;
      return;
    }
    region_is_counted_ = false;
  }

  bool is_complete(HillSearch& search, const HillRegion& region) const {
    const HillSearch::Missing missing = search.count_missing(region, all_found_, ranks_);
    return missing.eigenvalues == 0 && missing.contraction < 1.0;
  }

  /// Finds the motions of slowest decay by integration, with as many steps as these need.
  void search_decays() {
    const int wanted = options_.least_damped;
    int steps = whole_sectors(steps_of_decays, sectors_);
    int count = std::max(least_multipliers, 2 * (std::min(wanted, most_pairs) + margin_pairs));
    int most = 0;
    std::optional<LeastDampedSearch> search;
    for (int attempt = 1;; ++attempt) {
      if (!search) search.emplace(system_, solution_, steps);
      search->find(count);
      found_.clear();
      std::vector<Complex> exponents;
      for (std::size_t i = 0; i < search->count(); ++i) {
        found_.push_back(centred_motion(*search, i));
        exponents.push_back(exponent_of(found_.back()));
      }
      const LeastDampedSearch::Region region = search->region_of(exponents, wanted, speed_);
      const bool has_all = region.certain >= wanted;
      double more = region.more_steps;
      // More steps do not help where they have not found more.
      if (!has_all && more == 1.0 && search->is_exhausted() && region.certain > most)
        more = increase_of_all;
      more = std::min(more, static_cast<double>(most_steps_of_decays) / steps);
      most = std::max(most, region.certain);
      const bool is_last =
          attempt == most_attempts || (more <= 1.0 && (has_all || search->is_exhausted()));
      if (is_last && region.motions.empty())
        throw ConvergenceError(
            "floquet.least_damped: no motion decays slowly enough to be told from others; hint: "
            "floquet.modes");
      if (is_last) {
        take_decays(region);
        return;
      }
      if (more > 1.0) {
        steps = whole_sectors(steps * more, sectors_);
        search.reset();
      } else {
        count = static_cast<int>(count * usual_increase);
      }
    }
  }

  /// Keeps the motions of a region.
  void take_decays(const LeastDampedSearch::Region& region) {
    region_ = {0.0, region.high + margin(), region.decay, region.decay, false, {}};
    std::vector<Candidate> inside;
    for (const std::size_t motion : region.motions) {
      sought_.push_back(found_[motion].pair.exponent);
      inside.push_back(std::move(found_[motion]));
    }
    found_ = std::move(inside);
    expected_ = static_cast<int>(found_.size());
  }

  /// Leaves the wanted modes of slowest decay, and all others that do not decay faster than these:
  /// the exponents of the steps have errors. The range becomes theirs.
  void leave_slowest_decays() {
    // Neighbours of those that the search has found.
    if (!is_by_region())
      std::erase_if(modes_, [this](const Candidate& mode) {
        const Complex exponent = principal(mode.pair.exponent);
        return std::none_of(sought_.begin(), sought_.end(), [&](Complex other) {
          return std::abs(exponent - principal(other)) < same_motion * speed_;
        });
      });
    region_is_counted_ = (region_is_counted_ || !is_by_region()) &&
                         static_cast<double>(modes_.size()) + left_out_ >= expected_;
    if (is_by_region())  // the set of those above is not complete
      std::erase_if(modes_, [this](const Candidate& mode) {
        return modulus_of(mode) >= region_.high - margin();
      });
    std::vector<double> decays;
    double growth = 0.0;
    for (const Candidate& mode : modes_) {
      decays.push_back(-mode.pair.exponent.real());
      growth = std::max(growth, mode.pair.exponent.real());
    }
    std::ranges::sort(decays);
    const std::size_t last =
        std::min(decays.size(), static_cast<std::size_t>(options_.least_damped));
    if (last > 0)
      region_.decay = std::min(region_.decay,
                               std::max(decays[last - 1], growth) + 2.0 * zero_exponent * speed_);
    std::erase_if(modes_, [this](const Candidate& mode) {
      return -mode.pair.exponent.real() > region_.decay;
    });
  }

  /// That of the copies of a motion, and of its conjugate, that is next to its own harmonic.
  Candidate centred_motion(const LeastDampedSearch& search, std::size_t number) {
    const Eigen::MatrixXcd shape = search.shape(number);
    Candidate candidate{search.pair(number, shape, 0, sectors_), {}, {}};
    describe_shape(shape, candidate);
    settle_rest(candidate.pair.series, candidate, at_rest);
    const int shift = shift_to_own(candidate.mode.harmonic);
    candidate.mode.harmonic -= shift;
    candidate.pair = search.pair(number, shape, shift, least_harmonics);
    if (candidate.pair.exponent.imag() < 0.0) {
      candidate.pair = conjugate_of(candidate.pair);
      candidate.mode.harmonic = -candidate.mode.harmonic;
    }
    return candidate;
  }

  void search_upwards(HillSearch& search) {
    region_.decay = std::numeric_limits<double>::infinity();
    region_.growth = region_.decay;
    int steps = 0;
    int empty = 0;
    double frequency = has_medium_ ? between_copies * speed_ : speed_;
    const int wanted = wanted_modes(options_);
    int count = std::max(least_pairs, std::min(wanted + margin_pairs, most_pairs));
    while (!is_enough(region_.high)) {
      if (++steps > most_regions)
        throw ConvergenceError("floquet: Hill's method does not find as many modes in " +
                               std::to_string(most_regions) +
                               " ranges of frequencies; hint: fewer, or all modes");
      HillRegion region = search.find(frequency, count, region_.high);
      if (region.low > region_.high || region.decay <= 0.0) {
        if (region.low > region_.high) frequency = 0.5 * (frequency + region_.high);
        count += least_pairs / 2;
        continue;
      }
      const std::size_t known = all_found_.size();
      take(region, region_.high, region.high);
      region_.decay = std::min(region_.decay, region.decay);
      region_.growth = std::min(region_.growth, region.growth);
      const double length = region.high - std::max(region_.high, region.low);
      region_.high = region.high;
      empty = all_found_.size() == known ? empty + 1 : 0;
      if (region.is_whole || empty == most_empty) break;
      if (empty > 0) count = least_pairs;
      frequency = region_.high + 0.4 * length;
    }
    if (empty < most_empty || all_found_.empty()) return;
    double largest = 0.0;
    for (const Complex exponent : all_found_) largest = std::max(largest, std::abs(exponent));
    region_.high = std::min(region_.high, above_last * (largest + margin()));
  }

  void search_near(HillSearch& search, double frequency) {
    for (int count = std::max(least_pairs, options_.modes + margin_pairs);; count *= 2) {
      const std::size_t known = all_found_.size();
      found_.clear();
      all_found_.clear();
      HillRegion region = search.find(frequency, count);
      take(region, region.low, region.high);
      region_ = {region.low, region.high, region.decay, region.growth, region.is_whole, {}};
      if ((centred() >= options_.modes && region.decay > 0.0) || region.is_whole ||
          (all_found_.size() == known && known > 0) || count > 4 * most_pairs)
        return;
    }
  }

  /// Takes the pairs of a region from `low` to `high`.
  void take(HillRegion& region, double low, double high) {
    const auto known = static_cast<std::ptrdiff_t>(all_found_.size());  // of regions before
    std::vector<Candidate> candidates;
    for (HillPair& pair : region.pairs) {
      const double frequency = pair.exponent.imag();
      const bool is_new = std::none_of(
          all_found_.begin(), all_found_.begin() + known,
          [&](Complex other) { return std::abs(other - pair.exponent) < same_found * speed_; });
      // The first range also has those below it, which change the phase along its edge.
      if ((frequency > low || low == 0.0 || known == 0) && is_new)
        all_found_.push_back(pair.exponent);
      if (frequency > high || (frequency <= low && low > 0.0)) continue;
      candidates.push_back({std::move(pair), {}, {}});
    }
    // With the whole mesh, each rank has searched for itself.
    if (mesh_)
      describe(pointers_to(candidates));
    else
      for (Candidate& candidate : candidates) describe(candidate.pair.series, at_rest, candidate);
    for (Candidate& candidate : candidates)
      if (std::abs(candidate.mode.harmonic) <= nearest_ + 1) found_.push_back(std::move(candidate));
    mark_own_copies(pointers_to(found_));
  }

  /// Whether the slowest decays are found as all modes of a region are: a medium has many decays of
  /// its own, and constant tangents need no integration.
  bool is_by_region() const { return has_medium_ || is_constant_; }
  /// Largest distance of the frequency of a mode from that of its eigenpair.
  double margin() const { return is_constant_ ? 0.0 : (nearest_ + 1) * speed_; }
  /// Slack of the edges of the region. The search has the exponents of constant tangents.
  double slack() const { return is_constant_ ? same_exponent * speed_ : edge_slack * speed_; }

  /// Exponent of the mode of an eigenpair, by its energy.
  Complex exponent_of(const Candidate& candidate) const {
    return candidate.pair.exponent + Complex(0.0, candidate.mode.harmonic * speed_);
  }
  /// Whether an exponent is between the largest decay and growth of the region.
  bool is_in_width(Complex exponent) const {
    return -exponent.real() <= region_.decay && exponent.real() <= region_.growth;
  }
  bool is_in_width(const Candidate& candidate) const {
    return is_in_width(candidate.pair.exponent);
  }
  /// With a medium, the change from one number of harmonics to the next is the error.
  bool is_by_change() const { return has_medium_ && !is_constant_; }
  const Accuracy& accuracy() const { return is_by_change() ? of_change : of_residual; }
  double modulus_of(const Candidate& candidate) const { return std::abs(exponent_of(candidate)); }

  /// With an even number of blades, a mode in which they move in opposite directions has two pairs.
  /// Round-off splits a double zero into two real exponents or into a pair: both count once.
  double weight_of(const Candidate& candidate) const {
    const Complex exponent = candidate.pair.exponent;
    if (is_constant_ && exponent.imag() == 0.0 && std::abs(exponent) < largest_split * speed_)
      return 0.5;
    return 2 * std::abs(candidate.mode.harmonic) == sectors_ ? 0.5 : 1.0;
  }
  /// Modes that the search has found, with moduli of exponents from the lower edge to `high`, less
  /// the margin, but not those that may be modes of the medium.
  std::vector<const Candidate*> centred_below(double high) const {
    std::vector<const Candidate*> below;
    for (const Candidate& candidate : found_) {
      const double modulus = modulus_of(candidate);
      if (is_centred(candidate) && is_in_width(candidate) && modulus < high - margin() &&
          !may_be_of_medium(candidate) && (region_.low == 0.0 || modulus > region_.low + margin()))
        below.push_back(&candidate);
    }
    return below;
  }
  /// Their approximate number.
  int centred(double high) const {
    double count = 0.0;
    for (const Candidate* candidate : centred_below(high)) count += weight_of(*candidate);
    return static_cast<int>(count);
  }
  int centred() const { return centred(region_.high); }

  /// Lowers the edge of the region to what the slowest modes need, to the middle between two
  /// exponents. Those of constant tangents may be close to each other relative to their size: the
  /// widest gap within a range is taken.
  void lower_edge() {
    double lowest = 0.0;
    double widest = 0.0;
    double chosen = region_.high;
    std::vector<double> frequencies;
    for (const Complex exponent : all_found_) frequencies.push_back(exponent.imag());
    std::sort(frequencies.begin(), frequencies.end());
    for (std::size_t i = 1; i < frequencies.size(); ++i) {
      const double edge = 0.5 * (frequencies[i - 1] + frequencies[i]);
      if (frequencies[i] - frequencies[i - 1] < least_gap * speed_ || edge > region_.high ||
          is_next_to_medium(edge) || !is_enough(edge))
        continue;
      if (lowest == 0.0) lowest = edge;
      if (edge > (is_constant_ ? highest_edge : 1.0) * lowest) break;
      if (frequencies[i] - frequencies[i - 1] <= widest) continue;
      widest = frequencies[i] - frequencies[i - 1];
      chosen = edge;
    }
    region_.high = chosen;
  }

  /// Whether copies of the decays of a medium are next to an edge.
  bool is_next_to_medium(double edge) const {
    return has_medium_ && edge < (search_harmonics_ + 1) * speed_ &&
           std::abs(std::remainder(edge, speed_)) < beside_medium * speed_;
  }

  /// Whether the search has found what is wanted below an edge.
  bool is_enough(double high) const {
    if (options_.least_damped == 0) return centred(high) >= options_.modes;
    const std::optional<SlowestDecays> slowest = slowest_decays(high);
    if (!slowest) return false;
    const bool has_slower = std::ranges::any_of(found_, [&](const Candidate& candidate) {
      return is_centred(candidate) && modulus_of(candidate) >= high - margin() &&
             -candidate.pair.exponent.real() < slowest->decay;
    });
    return knows_slowest_decays(
        slowest->found, options_.least_damped,
        has_slower ? std::numeric_limits<double>::infinity() : slowest->highest, high - margin());
  }

  /// The wanted modes of slowest decay among those that the search has found below an edge.
  struct SlowestDecays {
    double decay = 0.0;    ///< of the last one [1/s]
    double highest = 0.0;  ///< modulus of an exponent [rad/s]
    double found = 0.0;    ///< number of all modes
  };
  std::optional<SlowestDecays> slowest_decays(double high) const {
    std::vector<const Candidate*> below = centred_below(high);
    std::ranges::stable_sort(below, {},
                             [](const Candidate* one) { return -one->pair.exponent.real(); });
    SlowestDecays slowest;
    for (const Candidate* candidate : below) {
      if (slowest.found < options_.least_damped) {
        slowest.decay = -candidate->pair.exponent.real();
        slowest.highest = std::max(slowest.highest, modulus_of(*candidate));
      }
      slowest.found += weight_of(*candidate);
    }
    if (slowest.found < options_.least_damped) return std::nullopt;
    return slowest;
  }

  /// Lowers the decay of the region to what the modes need, to the middle of the widest gap. (Next
  /// to an exponent of the medium alone, the determinant varies fast.)
  void lower_decay() {
    double needed = least_decay * speed_;
    const std::optional<SlowestDecays> slowest =
        options_.least_damped > 0 ? slowest_decays(region_.high) : std::nullopt;
    for (const Candidate& candidate : found_) {
      const double decay = -candidate.pair.exponent.real();
      if (is_centred(candidate) && is_in_width(candidate) && modulus_of(candidate) < region_.high &&
          (!slowest || decay <= slowest->decay))
        needed = std::max(needed, decay);
    }
    needed_decay_ = std::min(needed, region_.decay / beyond_decays);
    for (const Complex exponent : all_found_) decays_.push_back(-exponent.real());
    for (const Complex exponent : medium_exponents_) decays_.push_back(-exponent.real());
    std::ranges::sort(decays_);
    region_.decay = middle_of_gap(needed_decay_, beyond_decays * needed_decay_);
  }

  /// Of the widest one between neighbours among `decays_`, in a range.
  double middle_of_gap(double least, double largest) const {
    double widest = 0.0;
    double middle = largest;
    double last = least;
    const auto pass = [&](double decay) {
      if (decay - last > widest) {
        widest = decay - last;
        middle = 0.5 * (decay + last);
      }
      last = decay;
    };
    for (const double decay : decays_)
      if (decay > least && decay < largest) pass(decay);
    pass(largest);
    return middle;
  }

  /// Whether a pair is that of its copies that is identified next to its own harmonic. (With an
  /// even number of blades there are two of them if the blades move in opposite directions.)
  bool is_centred(const Candidate& candidate) const {
    return is_next_to_own(candidate) || candidate.is_own_copy;
  }
  bool is_next_to_own(const Candidate& candidate) const {
    return std::abs(candidate.mode.harmonic) <= nearest_;
  }
  /// Harmonics from a pair to its copy next to its own harmonic.
  int shift_to_own(int harmonic) const {
    const int copies = (std::abs(harmonic) + (sectors_ - 1) / 2) / sectors_;
    return (harmonic < 0 ? -copies : copies) * sectors_;
  }
  /// The exponent of this copy.
  Complex centred_exponent(const Candidate& candidate) const {
    return candidate.pair.exponent + Complex(0.0, shift_to_own(candidate.mode.harmonic) * speed_);
  }
  /// Motions whose multiplier is real and negative are copies of their own conjugates: two of them,
  /// one that may grow and one that decays, have one frequency, half of Q Omega but for multiples
  /// of it. Both harmonics have the same energy, and round-off decides which of them is identified.
  void mark_own_copies(const std::vector<Candidate*>& candidates) const {
    if (is_constant_) return;
    for (Candidate* one : candidates) {
      one->is_own_copy = false;
      if (is_next_to_own(*one)) continue;
      const Complex copy = std::conj(centred_exponent(*one));
      const double distance = std::abs(copy - one->pair.exponent);
      one->is_own_copy = distance < same_copy * speed_ &&
                         std::ranges::none_of(candidates, [&](const Candidate* other) {
                           return other != one && is_next_to_own(*other) &&
                                  clearly_nearer * std::abs(copy - other->pair.exponent) < distance;
                         });
    }
  }

  /// Refines the eigenpairs that are identified at their own harmonic, and those that should have a
  /// copy with this property in the region but have none. Modes beyond the part of the region that
  /// is reported are left out.
  void refine() {
    const auto is_chosen = [this](const Candidate& candidate) {
      if (options_.least_damped > 0) return true;
      const double modulus = modulus_of(candidate);
      // Few harmonics give it approximately.
      if (modulus > region_.high - margin() + slack() ||
          (region_.low > 0.0 && modulus < region_.low + margin() - slack()))
        return false;
      if (is_centred(candidate)) return true;
      const Complex own = candidate.pair.exponent;
      const Complex copy = centred_exponent(candidate);
      const double same = same_copy * speed_;
      return std::abs(copy.imag()) < region_.high - same &&
             std::none_of(found_.begin(), found_.end(), [&](const Candidate& other) {
               const Complex exponent = other.pair.exponent;
               // At the same place may be another motion.
               return is_centred(other) && std::abs(own - exponent) >= same &&
                      std::min(std::abs(copy - exponent), std::abs(copy - std::conj(exponent))) <
                          same;
             });
    };
    std::vector<HillPair> pairs;
    for (const Candidate& candidate : found_)
      if (is_chosen(candidate)) pairs.push_back(candidate.pair);
    found_.clear();
    std::vector<HillGroup> groups = groups_of(std::move(pairs), speed_);
    if (has_medium_)  // the search has eigenpairs with its number of harmonics
      for (HillGroup& group : groups)
        for (const HillPair& pair : group.pairs) group.before_exponents.push_back(pair.exponent);
    refine(std::move(groups));
  }

  /// Adds harmonics until the residuals are small, or do not become smaller.
  void refine(std::vector<HillGroup> groups) {
    share_groups(ranks_, groups);
    std::vector<Candidate> doubtful;
    harmonics_ = first_harmonics();
    int added = 0;  // harmonics, since the attempt before
    const Tolerance& tolerances = is_by_change() ? of_series_with_medium : of_series;
    double tolerance = is_constant_ ? tolerances.last : tolerances.first;
    while (!groups.empty()) {
      HillGroups all(system_, solution_, pencil_of(harmonics_), ranks_);
      all.refine(groups, tolerance);
      if (tolerance > tolerances.last) all.refine_further(groups, tolerances.last);
      tolerance = tolerances.last;
      std::vector<std::vector<Candidate>> members;
      std::vector<Candidate*> all_members;
      for (HillGroup& group : groups) {
        members.push_back(take_members(group));
        std::ranges::copy(pointers_to(members.back()), std::back_inserter(all_members));
      }
      describe(all_members);
      std::ranges::copy(pointers_to(modes_), std::back_inserter(all_members));
      mark_own_copies(all_members);
      std::vector<char> is_done;
      for (std::size_t g = 0; g < groups.size(); ++g)
        is_done.push_back(is_last(groups[g], members[g], added) ? 1 : 0);
      // All ranks follow the first one.
      all_ranks_.share(0, is_done);
      double largest = 0.0;
      std::vector<HillGroup> left;
      std::vector<std::vector<Decay>> decays;  // of these
      for (std::size_t g = 0; g < groups.size(); ++g) {
        const double residual = groups[g].residual();
        if (is_done[g] != 0) {
          for (Candidate& member : members[g])
            (member.residual <= accuracy().largest ? modes_ : doubtful)
                .push_back(std::move(member));
        } else {
          largest = std::max(largest, residual);
          groups[g].before = residual;
          groups[g].before_exponents.clear();
          decays.emplace_back();
          for (const Candidate& member : members[g]) {
            groups[g].before_exponents.push_back(member.pair.exponent);
            decays.back().push_back(decay_of(member));
          }
          for (Candidate& member : members[g]) groups[g].pairs.push_back(std::move(member.pair));
          left.push_back(std::move(groups[g]));
        }
      }
      groups = std::move(left);
      if (has_medium_ && options_.least_damped > 0) leave_stronger_decays(groups, decays);
      // The residual falls by the same factor with each harmonic.
      if (!groups.empty()) {
        const double factor =
            has_medium_ ? increase_with_medium
                        : std::log(0.3 * accuracy().wanted) / std::log(std::min(largest, 0.9));
        int next = std::min(
            most_harmonics,
            static_cast<int>(
                std::ceil(std::clamp(factor, 1.0 + 1.0 / harmonics_, most_increase) * harmonics_)));
        all_ranks_.share(0, next);  // pow and log may differ by round-off
        added = next - harmonics_;
        harmonics_ = next;
      }
    }
    std::vector<Eigen::VectorXcd> of_modes;
    for (Candidate& candidate : doubtful) {
      bool is_kept =
          !candidate.is_found || (is_centred(candidate) && !is_copy(candidate, of_modes));
      all_ranks_.share(0, is_kept);
      if (is_kept) modes_.push_back(std::move(candidate));
    }
  }

  /// A decay with its error, the change since fewer harmonics.
  struct Decay {
    double value;
    double error;
    Complex exponent;
    /// 0: no mode of the range that is reported, not at its own harmonic, or one of the medium.
    double weight;
  };
  /// Of an exponent in a medium, since fewer harmonics [1/s].
  double last_change(const Candidate& mode) const {
    return mode.residual * unit_of_change(mode.pair.exponent, speed_);
  }
  Decay decay_of(const Candidate& mode) const {
    const Complex exponent = mode.pair.exponent;
    const bool counts =
        is_centred(mode) && modulus_of(mode) < region_.high - margin() && !may_be_of_medium(mode);
    return {-exponent.real(), last_change(mode), exponent, counts ? weight_of(mode) : 0.0};
  }

  /// Takes out groups of one mode that decays faster than the wanted ones, and than the range that
  /// is reported, with all errors. `own`: of the pairs of each group.
  void leave_stronger_decays(std::vector<HillGroup>& groups,
                             const std::vector<std::vector<Decay>>& own) {
    std::vector<Decay> all;
    for (const Candidate& mode : modes_) all.push_back(decay_of(mode));
    for (const std::vector<Decay>& decays : own)
      all.insert(all.end(), decays.begin(), decays.end());
    std::erase_if(all, [](const Decay& one) { return one.weight == 0.0; });
    std::ranges::sort(all, {}, [](const Decay& one) { return one.value + one.error; });
    // A mode counts once with its copies, whose exponents differ by a multiple of i Omega, and with
    // others of nearly the same exponent.
    std::vector<Complex> slowest;
    double found = 0.0;
    double limit = std::numeric_limits<double>::infinity();
    for (const Decay& one : all) {
      const double apart = 2.0 * one.error + same_with_medium * speed_;
      if (std::ranges::any_of(slowest, [&](Complex other) {
            const Complex change = one.exponent - other;
            return std::hypot(change.real(), std::remainder(change.imag(), speed_)) < apart;
          }))
        continue;
      slowest.push_back(one.exponent);
      found += one.weight;
      if (found < options_.least_damped) continue;
      limit = one.value + one.error;
      break;
    }
    for (const Decay& one : all) limit = std::max(limit, one.error - one.value);  // a growth
    limit += clear_difference * speed_;
    std::vector<char> is_left;
    for (const std::vector<Decay>& decays : own)
      is_left.push_back(decays.size() == 1 && decays[0].weight > 0.0 &&
                                decays[0].value - decays[0].error > limit
                            ? 1
                            : 0);
    all_ranks_.share(0, is_left);
    std::vector<HillGroup> others;
    for (std::size_t g = 0; g < groups.size(); ++g)
      if (is_left[g] == 0)
        others.push_back(std::move(groups[g]));
      else
        left_out_ += own[g][0].weight;
    groups = std::move(others);
  }

  /// Takes the eigenpairs of a group from it.
  std::vector<Candidate> take_members(HillGroup& group) {
    const bool is_found = group.truncated_residual <= of_residual.largest;
    std::vector<Candidate> members;
    for (std::size_t i = 0; i < group.pairs.size(); ++i)
      members.push_back({std::move(group.pairs[i]), {}, {}, group.residuals[i], is_found});
    group.pairs.clear();
    return members;
  }

  /// Whether more harmonics are not needed, or of no use. `added`: since the attempt before.
  bool is_last(const HillGroup& group, const std::vector<Candidate>& members, int added) const {
    if (harmonics_ < most_harmonics && is_by_change() &&
        std::ranges::any_of(members, [this](const Candidate& one) { return lacks_partner(one); }))
      return false;
    const double residual = group.residual();
    const double wanted = accuracy().wanted * (is_by_change() && added == 0 ? first_change : 1.0);
    if ((residual <= wanted && (!is_by_change() || know_growth(members))) ||
        harmonics_ == most_harmonics || is_constant_)
      return true;
    const bool is_own = std::any_of(members.begin(), members.end(), [this](const Candidate& one) {
      return is_centred(one);  // next to its own harmonic
    });
    // A neighbour is known by its harmonic as soon as it is resolved.
    const bool is_known = !group.is_neighbour || residual <= accuracy().largest;
    return (!is_own && is_known) || !members.front().is_found ||
           (residual <= accuracy().largest &&
            residual > std::pow(slowest_decay, added) * group.before);
  }

  /// Whether a motion next to the copy of its conjugate needs more harmonics to be coupled with it.
  /// Couplings fall with the harmonic: those of missing ones are no larger than the last change.
  bool lacks_partner(const Candidate& one) const {
    const Complex exponent = one.pair.exponent;
    const int shift = neighbouring_conjugate(exponent, sectors_, speed_);
    if (!is_centred(one) || std::abs(shift) < harmonics_ || std::abs(shift) >= most_harmonics)
      return false;
    const double apart = std::abs(exponent.imag() - 0.5 * shift * speed_);
    return apart < beyond_change * last_change(one);
  }

  /// Whether the changes of exponents are small beside their growth.
  bool know_growth(const std::vector<Candidate>& members) const {
    return std::ranges::all_of(members, [this](const Candidate& one) {
      const Complex exponent = one.pair.exponent;
      const double growth = std::max(std::abs(exponent.real()), least_growth * std::abs(exponent));
      return one.residual * unit_of_change(exponent, speed_) <= wanted_change * growth;
    });
  }

  /// Whether an eigenpair is a copy of a mode at the edge of a series, where its harmonics are cut
  /// off: the positions in the largest harmonics are the same. `of_modes`: those of the modes,
  /// which are added where they are missing.
  bool is_copy(const Candidate& candidate, std::vector<Eigen::VectorXcd>& of_modes) const {
    const auto largest = [this](const Eigen::MatrixXcd& series, int harmonic) {
      const Index harmonics = (series.rows() - 1) / 2;
      Eigen::VectorXcd positions = Eigen::VectorXcd::Zero(system_.size());
      for (Index i = 0; i < system_.size(); ++i)
        if (system_.unknowns()[static_cast<std::size_t>(i)].role == system::UnknownRole::position)
          positions(i) = series(harmonics + std::clamp<Index>(harmonic, -harmonics, harmonics), i);
      return Eigen::VectorXcd(positions.normalized());
    };
    const Eigen::MatrixXcd series = whole_series(candidate.pair.series);
    const double tail =
        series.topRows(edge_harmonics).norm() + series.bottomRows(edge_harmonics).norm();
    if (tail < edge_part * series.norm()) return false;
    const Eigen::VectorXcd own = largest(series, candidate.mode.harmonic);
    for (std::size_t m = of_modes.size(); m < modes_.size(); ++m)
      of_modes.push_back(largest(whole_series(modes_[m].pair.series), modes_[m].mode.harmonic));
    return std::ranges::any_of(of_modes, [&](const Eigen::VectorXcd& other) {
      return std::max(std::abs(other.dot(own)), std::abs(other.conjugate().dot(own))) > same_shape;
    });
  }

  /// A series with the unknowns of all ranks, on all of them.
  Eigen::MatrixXcd whole_series(const Eigen::MatrixXcd& series) const {
    if (!mesh_) return series;
    Eigen::MatrixXcd whole = mesh_->own_series(series);
    all_ranks_.sum(whole);
    return whole;
  }
  /// The same on one rank only; empty on the others.
  Eigen::MatrixXcd series_on(int rank, const Eigen::MatrixXcd& series) const {
    const bool is_there = all_ranks_.rank == rank;
    if (!mesh_) return is_there ? series : Eigen::MatrixXcd();
    Eigen::MatrixXcd whole = mesh_->own_series(series);
    all_ranks_.sum_on(rank, whole);
    if (!is_there) whole.resize(0, 0);
    return whole;
  }

  /// Values of a series at equal distances over a period.
  Eigen::MatrixXcd shape_of(const Eigen::MatrixXcd& series) const {
    const Index harmonics = (series.rows() - 1) / 2;
    Eigen::MatrixXcd waves(series.rows(), samples_);
    for (Index i = 0; i < samples_; ++i)
      for (Index k = -harmonics; k <= harmonics; ++k)
        waves(k + harmonics, i) =
            std::polar(1.0, 2.0 * std::numbers::pi * static_cast<double>(k * i % samples_) /
                                static_cast<double>(samples_));
    return multiply_transpose(series, waves);
  }

  static std::vector<Candidate*> pointers_to(std::vector<Candidate>& candidates) {
    std::vector<Candidate*> pointers;
    for (Candidate& candidate : candidates) pointers.push_back(&candidate);
    return pointers;
  }

  /// Identifies candidates; the ranks share them. `rest`, relative to the rotor speed: an exponent
  /// below it is that of a displacement.
  void describe(const std::vector<Candidate*>& candidates, double rest = at_rest) {
    const auto size = static_cast<std::size_t>(all_ranks_.size);
    for (std::size_t first = 0; first < candidates.size(); first += size) {
      const int count = static_cast<int>(std::min(size, candidates.size() - first));
      Eigen::MatrixXcd own;
      for (int rank = 0; rank < count; ++rank) {
        const Candidate& candidate = *candidates[first + static_cast<std::size_t>(rank)];
        Eigen::MatrixXcd series = series_on(rank, candidate.pair.series);
        if (rank == all_ranks_.rank) own = std::move(series);
      }
      if (all_ranks_.rank < count)
        describe(own, rest, *candidates[first + static_cast<std::size_t>(all_ranks_.rank)]);
      for (int rank = 0; rank < count; ++rank) {
        Candidate& candidate = *candidates[first + static_cast<std::size_t>(rank)];
        share_mode(all_ranks_, rank, candidate.mode);
        Eigen::MatrixXd shares = candidate.participation;
        all_ranks_.share(rank, shares);
        candidate.participation = shares.reshaped();
      }
    }
  }

  /// By the series of the whole system.
  void describe(const Eigen::MatrixXcd& series, double rest, Candidate& candidate) {
    describe_shape(shape_of(series), candidate);
    settle_rest(series, candidate, rest);
  }

  /// A displacement at rest has no energy: its harmonic is that of the positions.
  void settle_rest(const Eigen::MatrixXcd& series, Candidate& candidate, double rest) const {
    const Index at = largest_harmonic(series);
    if (std::abs(candidate.pair.exponent + Complex(0.0, static_cast<double>(at) * speed_)) <
        rest * speed_)
      candidate.mode.harmonic = static_cast<int>(at);
  }

  /// By its shape over a revolution.
  void describe_shape(const Eigen::MatrixXcd& shape, Candidate& candidate) {
    Eigen::MatrixXd real(energy_.signals(), shape.cols());
    Eigen::MatrixXd imaginary(energy_.signals(), shape.cols());
    energy_.take(shape.real(), real);
    energy_.take(shape.imag(), imaginary);
    const int state = leading_state(shape);
    describe_energy(
        energy_.energies(real.data(), imaginary.data(), Eigen::VectorXcd::Ones(shape.cols())),
        energy_.part_names(), state, candidate.mode, candidate.participation);
    candidate.mode.state.reset();
    if (state >= 0) candidate.mode.state = parts_.owners[static_cast<std::size_t>(state)];
  }

  /// Place in `parts_.owners` of the part with the largest state, relative to its scale, where this
  /// is more than the largest position; else -1. (It stands in place of the participation factors,
  /// which need the left eigenvectors.)
  int leading_state(const Eigen::MatrixXcd& shape) const {
    double largest = 0.0;
    int leading = -1;
    std::size_t state = 0;
    for (Index i = 0; i < system_.size() && !parts_.owners.empty(); ++i) {
      const system::Unknown& unknown = system_.unknowns()[static_cast<std::size_t>(i)];
      const bool is_state = unknown.role == system::UnknownRole::state;
      const std::size_t number = state;
      if (is_state) ++state;
      // The search leaves out the modes of a medium: its states only answer the other parts.
      if (unknown.is_of_medium()) continue;
      if (!is_state && unknown.role != system::UnknownRole::position) continue;
      const double size = shape.row(i).cwiseAbs().maxCoeff() / unknown.scale;
      if (size <= largest) continue;
      largest = size;
      leading = is_state ? static_cast<int>(parts_.part_of[number]) : -1;
    }
    return leading;
  }

  /// The harmonic with the largest positions.
  Index largest_harmonic(const Eigen::MatrixXcd& series) const {
    Eigen::VectorXd sizes = Eigen::VectorXd::Zero(series.rows());
    for (Index i = 0; i < system_.size(); ++i)
      if (system_.unknowns()[static_cast<std::size_t>(i)].role == system::UnknownRole::position)
        sizes += series.col(i).cwiseAbs2();
    Index largest = 0;
    sizes.maxCoeff(&largest);
    return largest - (series.rows() - 1) / 2;
  }

  /// The exponent up to multiples of i Q Omega and up to its conjugate.
  Complex principal(Complex exponent) const {
    if (is_constant_) return {exponent.real(), std::abs(exponent.imag())};
    return {exponent.real(), std::abs(std::remainder(exponent.imag(), sectors_ * speed_))};
  }

  /// Keeps one eigenpair of each mode among copies. Copies of one mode, or of modes with equal
  /// exponents, lie at the same places: the place with most eigenpairs is kept, and among these the
  /// one with the lowest harmonics.
  void choose() {
    std::erase_if(modes_, [this](const Candidate& mode) {
      return mode.pair.exponent.imag() < -zero_exponent * speed_;
    });
    for (Candidate& mode : modes_)  // round-off has split a double zero
      if (std::abs(mode.pair.exponent) < zero_exponent * speed_) mode.pair.exponent.imag(0.0);
    describe(pointers_to(modes_), zero_exponent);  // with the samples of all
    std::vector<Candidate> chosen;
    std::vector<char> taken(modes_.size(), 0);
    for (std::size_t i = 0; i < modes_.size(); ++i) {
      if (taken[i]) continue;
      std::vector<std::vector<std::size_t>> places;
      for (std::size_t j = i; j < modes_.size(); ++j) {
        const Complex exponent = modes_[j].pair.exponent;
        if (taken[j] || !is_copy_of(modes_[j], modes_[i])) continue;
        taken[j] = 1;
        auto place = std::find_if(places.begin(), places.end(), [&](const auto& other) {
          const Candidate& one = modes_[other.front()];
          return std::abs(one.pair.exponent - exponent) < apart(one, modes_[j]);
        });
        if (place == places.end()) place = places.insert(places.end(), std::vector<std::size_t>{});
        place->push_back(j);
      }
      const auto cost = [&](const std::vector<std::size_t>& place) {
        int sum = 0;
        for (const std::size_t j : place) sum += std::abs(modes_[j].mode.harmonic);
        // Of an exponent halfway between two places, the one nearest to the real axis.
        const double frequency = std::abs(modes_[place.front()].pair.exponent.imag());
        return std::tuple(-static_cast<int>(place.size()), sum, frequency);
      };
      const auto best =
          std::min_element(places.begin(), places.end(),
                           [&](const auto& a, const auto& b) { return cost(a) < cost(b); });
      for (const std::size_t j : *best) chosen.push_back(std::move(modes_[j]));
    }
    modes_ = std::move(chosen);
    if (is_constant_) choose_among_equals();
    if (counts_refined()) {
      take_refined();
      count_missing();
    }
    if (has_medium_) leave_modes_of_medium();
    pencil_.reset();
    if (options_.least_damped > 0) leave_slowest_decays();
  }

  /// Whether a mode may be one of the medium: its exponent is near one of those of the medium
  /// alone, which are known up to multiples of i Omega.
  bool may_be_of_medium(const Candidate& mode) const {
    const Complex exponent = exponent_of(mode);
    return std::abs(exponent.imag()) < highest_of_medium * speed_ &&
           std::ranges::any_of(medium_exponents_, [&](Complex other) {
             const Complex apart = other - exponent;
             return std::hypot(apart.real(), std::remainder(apart.imag(), speed_)) <
                    next_to_medium * -exponent.real();
           });
  }

  /// Takes out modes of the medium, which the search may find next to those of the parts.
  void leave_modes_of_medium() {
    std::vector<char> is_of_medium(modes_.size(), 0);
    all_ranks_.attempt([&] {
      HillPencil& pencil = pencil_of(harmonics_);
      for (std::size_t m = 0; m < modes_.size(); ++m) {
        if (!may_be_of_medium(modes_[m])) continue;
        try {
          const int part = leading_part(pencil, system_, parts_, modes_[m].pair);
          if (part < 0) continue;
          const system::PartKind kind = parts_.owners[static_cast<std::size_t>(part)].kind;
          is_of_medium[m] = kind == system::PartKind::medium ? 1 : 0;
        } catch (const ConvergenceError&) {
          continue;  // it stays
        }
      }
    });
    all_ranks_.share(0, is_of_medium);
    std::vector<Candidate> kept;
    for (std::size_t m = 0; m < modes_.size(); ++m)
      if (is_of_medium[m] == 0) kept.push_back(std::move(modes_[m]));
    modes_ = std::move(kept);
  }

  /// Whether the exponents that the count leaves out are the refined ones. Of several double zeros,
  /// the search finds some.
  bool counts_refined() const { return is_constant_ && !has_medium_; }
  /// In the region only the refined exponents count: approximations may be rough, and one that the
  /// refinement has lost is missing.
  void take_refined() {
    std::erase_if(all_found_, [this](Complex other) {
      if (region_.low <= other.imag() && other.imag() <= region_.high && is_in_width(other))
        return true;
      return std::ranges::any_of(modes_, [&](const Candidate& mode) {
        return std::abs(mode.pair.exponent - other) < same_found * unit_of_change(other, speed_);
      });
    });
    for (const Candidate& mode : modes_) {
      Complex exponent = mode.pair.exponent;
      if (std::abs(exponent.imag()) < zero_exponent * speed_) exponent.imag(0.0);
      all_found_.push_back(exponent);
    }
  }

  /// Motions of equal exponents: combinations of these that have names.
  void choose_among_equals() {
    std::vector<Complex> exponents;
    std::vector<Eigen::MatrixXcd> shapes;
    for (const Candidate& mode : modes_) {
      exponents.push_back(mode.pair.exponent);
      shapes.emplace_back(whole_series(mode.pair.series).transpose());
    }
    choose_shapes(system_, exponents, shapes);
    for (std::size_t i = 0; i < modes_.size(); ++i) {
      // Round-off splits a double zero by its square root.
      const double split = most_split * std::sqrt(modes_[i].residual) * speed_;
      if (std::abs(exponents[i]) < std::min(split, largest_split * speed_)) exponents[i] = 0.0;
      modes_[i].pair = {exponents[i], mesh_ ? mesh_->counted_series(shapes[i].transpose())
                                            : Eigen::MatrixXcd(shapes[i].transpose())};
    }
    describe(pointers_to(modes_), zero_exponent);
  }

  /// Whether two pairs have exponents that are equal up to multiples of i Q Omega and up to their
  /// conjugates, or with a medium, where these have larger errors, also series with this property.
  /// At one place, series of two motions may be similar.
  bool is_copy_of(const Candidate& a, const Candidate& b) const {
    const Complex first = a.pair.exponent;
    const Complex second = b.pair.exponent;
    if (std::abs(principal(first) - principal(second)) < apart(a, b)) return true;
    if (!is_by_change()) return false;
    const auto error_of = [this](const Candidate& one) {
      return std::max(last_change(one),
                      accuracy().wanted * unit_of_change(one.pair.exponent, speed_));
    };
    const double error = std::min(same_with_medium * std::max(std::abs(first), speed_),
                                  beyond_errors * (error_of(a) + error_of(b)));
    const auto are_copies = [&](const HillPair& one, const HillPair& other) {
      const double between = (other.exponent.imag() - one.exponent.imag()) / speed_;
      const auto shift = static_cast<Index>(std::lround(between / sectors_)) * sectors_;
      if (std::abs(other.exponent - one.exponent -
                   Complex(0.0, static_cast<double>(shift) * speed_)) > error)
        return false;
      const Eigen::MatrixXcd copy = shifted_series(one.series, shift, other.series.rows());
      const bool is_one_place = shift == 0 || std::abs(first - second) < same_copy * speed_;
      return pencil_->correlation(copy, other.series) > (is_one_place ? same_series : same_shape);
    };
    return are_copies(a.pair, b.pair) || are_copies(a.pair, conjugate_of(b.pair));
  }

  /// Distance of exponents that are the same, but for multiples of i Q Omega. Round-off splits a
  /// double zero by its square root, in each copy by another amount.
  double apart(const Candidate& a, const Candidate& b) const {
    const auto split = [this](const Candidate& one) {
      const double most = std::min(most_split * std::sqrt(one.residual), largest_split) * speed_;
      return std::abs(principal(one.pair.exponent)) < most ? most : 0.0;
    };
    const double of_a = split(a);
    const double of_b = split(b);
    const bool are_zero = of_a > 0.0 && of_b > 0.0;
    return std::max(are_zero ? 2.0 * std::max(of_a, of_b) : 0.0, same_exponent * speed_);
  }

  // ---- the result ------------------------------------------------------------------------------

  /// Adds the identified harmonic to the exponent, and chooses the conjugate with Im >= 0.
  void settle(std::size_t m) {
    Mode& mode = set_.modes[m];
    mode.exponent = modes_[m].pair.exponent + Complex(0.0, mode.harmonic * speed_);
    if (mode.exponent.imag() < -zero_exponent * speed_) {
      modes_[m].pair.exponent = std::conj(modes_[m].pair.exponent);
      conjugate_mode(set_, m);
    }
    const double size = std::abs(mode.exponent);
    const double noise = is_by_change() ? least_imaginary * size : 0.0;
    if (std::abs(mode.exponent.imag()) < std::max(zero_exponent * speed_, noise))
      mode.exponent.imag(0.0);
    mode.step_exponent = mode.exponent;
    const bool is_zero = size < zero_exponent * speed_;
    mode.damping_ratio = is_zero ? 0.0 : -mode.exponent.real() / size;
    // A change is relative to the exponent of the pair, or to the rotor speed.
    const double unit = is_by_change() ? unit_of_change(modes_[m].pair.exponent, speed_) : size;
    const double error = is_zero ? 0.0 : mode.residual * unit;
    mode.step_error = is_zero ? 0.0 : error / size;
    set_growth_error(mode, {error, error}, modes_[m].pair.exponent);
  }

  /// The first rank finds the modes of the eigenpairs, and has their shapes.
  Floquet finish() {
    std::vector<Eigen::MatrixXcd> shapes;
    for (Candidate& found : modes_) {
      const Eigen::MatrixXcd series = series_on(0, found.pair.series);
      found.pair.series.resize(0, 0);  // of a large mesh as large as the shape
      if (all_ranks_.rank == 0) shapes.push_back(shape_of(series));
    }
    all_ranks_.attempt([&] {
      if (all_ranks_.rank == 0) take_modes(std::move(shapes));
    });
    share_modes(all_ranks_, set_);
    Floquet result;
    result.harmonics = harmonics_;
    result.set = std::move(set_);
    return result;
  }

  void take_modes(std::vector<Eigen::MatrixXcd> shapes) {
    const auto count = static_cast<Index>(modes_.size());
    set_ = {};
    set_.rotor_speed = system_.period() > 0.0 ? speed_ : 0.0;
    set_.conservative = system_.is_conservative();
    set_.first_harmonic = -static_cast<int>(samples_ / 2);
    if (!is_constant_) set_.participation.resize(count, samples_);
    for (Index i = 0; i < samples_; ++i)
      set_.shape_times.push_back(system_.period() * static_cast<double>(i) /
                                 static_cast<double>(samples_));
    for (std::size_t m = 0; m < modes_.size(); ++m) {
      Candidate& found = modes_[m];
      Mode mode = found.mode;
      mode.residual = found.residual;
      mode.resolved = found.residual <= accuracy().largest;
      if (!is_constant_) mode.multiplier = std::exp(found.pair.exponent * system_.period());
      set_.shapes.push_back(std::move(shapes[m]));
      if (!is_constant_) set_.participation.row(static_cast<Index>(m)) = found.participation;
      const bool is_real = std::abs(found.pair.exponent.imag()) < zero_exponent * speed_;
      mode.exponent = found.pair.exponent;
      if (is_real) mode.exponent.imag(0.0);
      if (!is_constant_ && !mode.state &&
          (is_drift(mode.exponent, speed_) ||
           (is_real && is_rigid_body(system_, set_.shapes.back(), mode))))
        mode.harmonic = harmonic_of_positions(system_, set_.shapes.back());
      set_.modes.push_back(mode);
      settle(m);
      // A displacement has no energy in any part.
      if (!is_constant_ && std::abs(set_.modes[m].exponent) < zero_exponent * speed_)
        set_.modes[m].parts.clear();
    }
    const std::vector<LeadingMotion> leading = separate_motions(system_, solution_, set_);
    for (std::size_t m = 0; m < leading.size(); ++m) {
      if (is_constant_ || leading[m].harmonic == set_.modes[m].harmonic) continue;
      set_.modes[m].harmonic = leading[m].harmonic;
      settle(m);
    }
    if (region_.low == 0.0 && !is_constant_) take_shift_in_time(system_, set_);
    const std::vector<system::MeshError> elements = system_.mesh_errors();
    for (std::size_t m = 0; m < set_.modes.size(); ++m) {
      Mode& mode = set_.modes[m];
      if (mode.resolved && std::abs(mode.exponent) > zero_exponent * speed_)
        add_mesh_error(mode, find_mesh_error(system_, elements, mode, set_.shapes[m]));
    }
    name_modes(system_, leading, set_, sectors_);
    arrange_modes(set_);
    scale_shapes(system_, set_);
    // In terms of the modes' frequencies, which differ from those of the eigenpairs.
    const double low = region_.low > 0.0 ? region_.low + margin() : 0.0;
    const double high = region_.high - margin();
    set_.reach = std::min(high, region_.decay);
    for (const Mode& mode : set_.modes)
      if (!mode.resolved && !is_of_medium(mode))
        set_.reach = std::min(set_.reach, std::abs(mode.exponent));
    // The search and the refinement may differ in what lies at the edges, but no mode gets lost.
    const auto kept = std::count_if(set_.modes.begin(), set_.modes.end(), [&](const Mode& mode) {
      const double modulus = std::abs(mode.exponent);
      return modulus < high && modulus > low - slack();
    });
    set_.searched =
        SearchedRegion{low,
                       high,
                       region_.decay,
                       region_.growth,
                       region_is_counted_ && (kept >= expected_ || options_.least_damped > 0),
                       wanted_modes(options_),
                       options_.least_damped > 0,
                       has_medium_ ? largest_damping_with_medium : 1.0};
    for (const Mode& mode : set_.modes) set_.found += mode.exponent.imag() == 0.0 ? 1 : 2;
  }

  const system::PeriodicSystem& system_;
  const PeriodicSolution& solution_;
  const FloquetOptions& options_;
  Ranks all_ranks_;
  bool is_constant_;
  bool has_medium_;
  std::optional<MeshPartition> mesh_;  ///< where it is distributed
  Ranks ranks_;   ///< those that share independent work: one, where the mesh is distributed
  double speed_;  ///< of the rotor; at rest 1 rad/s
  std::optional<HillPencil> pencil_;
  int search_harmonics_ = 0;
  HarmonicEnergy energy_;
  StateParts parts_;
  Index samples_ = 0;             ///< of a shape
  int sectors_ = 1;               ///< copies of an eigenpair are this number of harmonics apart
  int nearest_ = 0;               ///< harmonics of a pair that belong to no other copy
  std::vector<Candidate> found_;  ///< by the search
  std::vector<Candidate> modes_;
  int harmonics_ = 0;  ///< of modes_, at most
  HillRegion region_;
  double needed_decay_ = 0.0;   ///< of the modes, in a medium
  std::vector<double> decays_;  ///< of exponents by the search and of the medium alone, ascending
  bool region_is_counted_ = false;
  int expected_ = 0;       ///< modes, by the search, not next to the edge of the region
  double left_out_ = 0.0;  ///< modes of decays that are not wanted
  std::vector<Complex> medium_exponents_;  ///< with the other parts at rest
  std::vector<Complex> sought_;            ///< exponents of the slowest decays
  std::vector<Complex> all_found_;         ///< exponents by the search, also outside the region
  ModeSet set_;
};

}  // namespace

std::optional<Floquet> find_hill_modes(const system::PeriodicSystem& system,
                                       const PeriodicSolution& solution,
                                       const FloquetOptions& options, MPI_Comm comm) {
  return Analysis(system, solution, options, comm, false).run();
}

std::optional<ModeSet> find_hill_constant_modes(const system::PeriodicSystem& system,
                                                const PeriodicSolution& solution,
                                                const FloquetOptions& options, MPI_Comm comm) {
  std::optional<Floquet> found = Analysis(system, solution, options, comm, true).run();
  if (!found) return std::nullopt;
  return std::move(found->set);
}

}  // namespace samara::analysis
