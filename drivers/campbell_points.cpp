#include "campbell_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/base/number.hpp"
#include "samara/io/schema.hpp"
#include "samara/petsc/handle.hpp"
#include "samara/petsc/session.hpp"
#include "samara/simulation/steady_state.hpp"

#include "interruption.hpp"
#include "point_origin.hpp"

namespace samara::drivers {
namespace {

using simulation::CampbellPoint;
using simulation::StabilityEdge;
using simulation::SweepPlace;

/// Runs of neighbouring points of a group: points cost unlike time at the ends of a sweep.
constexpr std::size_t runs_of_group = 4;

/// Keeps notes.
class Notes final : public analysis::Observer {
 public:
  void note(const std::string& text) override { texts.push_back(text); }
  std::vector<std::string> texts;
};

/// Points with given values of a key.
class SweepFinder final : public CampbellPointFinder {
 public:
  explicit SweepFinder(const Sweep& sweep) : sweep_(sweep) {}
  void forget() override { last_.reset(); }

 private:
  CampbellPoint find_modes(const SweepPlace& place, const analysis::Ranks& ranks,
                           analysis::Observer& observer) override {
    std::optional<io::Case> read;
    std::optional<turbine::TurbineSystem> built;
    ranks.attempt([&] {
      read.emplace(sweep_.case_at(place));
      built.emplace(model::build_turbine(read->turbine), PETSC_COMM_SELF);
    });
    const io::Case& input = *read;
    const bool is_near = last_ && last_->solution.coefficients().rows() == built->size();
    last_ = simulation::solve_trim(input, *built, simulation::trim_options(input), observer,
                                   ranks.comm, is_near ? &*last_ : nullptr);
    simulation::require_wake_range(*built, *last_);
    simulation::note_doubts(*built, *last_, observer);
    CampbellPoint result =
        simulation::find_campbell_point(*built, *last_, input.floquet, ranks.comm, observer);
    if (input.turbine.wind && input.turbine.aero) result.wind_speed = input.turbine.wind->speed;
    return result;
  }

  const Sweep& sweep_;
  std::optional<analysis::Trim> last_;
};

/// Operating points of the case.
class OperationFinder final : public CampbellPointFinder {
 public:
  OperationFinder(const io::Case& input, const std::vector<simulation::ScheduledPoint>& table)
      : input_(input), table_(table), finder_(std::in_place, input, table) {}
  void forget() override { finder_.emplace(input_, table_); }

 private:
  CampbellPoint find_modes(const SweepPlace& place, const analysis::Ranks& ranks,
                           analysis::Observer& observer) override {
    finder_->find_at(place.value, observer, ranks.comm);
    CampbellPoint result = simulation::find_campbell_point(finder_->system(), finder_->trim(),
                                                           input_.floquet, ranks.comm, observer);
    result.wind_speed = place.value;
    return result;
  }

  const io::Case& input_;
  const std::vector<simulation::ScheduledPoint>& table_;
  std::optional<simulation::OperatingPointFinder> finder_;
};

/// The point at a place; one without modes when the user interrupts the run.
CampbellPoint find_or_stop(CampbellPointFinder& finder, const SweepPlace& place,
                           const analysis::Ranks& ranks) {
  if (ranks.all(!Interruption::is_asked())) return finder.find(place, ranks);
  CampbellPoint none;
  none.failure = "interrupted";
  return none;
}

/// Groups of neighbouring ranks, of equal size but for one rank. The ranks of a group share a task.
class Groups {
 public:
  /// As many as the user wants, else one for each rank, but not more than `tasks`, of which there
  /// are some. @throws InputError
  Groups(std::size_t tasks, const analysis::Ranks& ranks)
      : size_(ranks.size),
        count_(static_cast<int>(std::min(tasks, static_cast<std::size_t>(wanted(ranks.size))))) {}

  std::size_t count() const { return static_cast<std::size_t>(count_); }
  int of_rank(int rank) const { return static_cast<int>(long{rank} * count_ / size_); }
  int of_task(std::size_t task) const { return static_cast<int>(task % count()); }
  int first_rank(int group) const {
    return static_cast<int>((long{group} * size_ + count_ - 1) / count_);
  }

 private:
  static int wanted(int ranks) {
    constexpr const char* option = "-samara_groups";
    PetscBool is_given = PETSC_FALSE;
    PetscBool has_word = PETSC_FALSE;
    std::array<char, 64> word{};
    petsc::check(PetscOptionsHasName(nullptr, nullptr, option, &is_given));
    if (is_given == PETSC_FALSE) return ranks;
    petsc::check(
        PetscOptionsGetString(nullptr, nullptr, option, word.data(), word.size(), &has_word));
    const double groups = parse_number(word.data()).value_or(0.0);
    if (groups < 1.0 || groups > ranks || groups != std::floor(groups))
      throw InputError(std::string(option) + " " + word.data() + ": the run has " +
                       samara::count(ranks, "rank") +
                       "; hint: a whole number of groups from 1 to " + std::to_string(ranks));
    return static_cast<int>(groups);
  }

  int size_;
  int count_;
};

/// The ranks of the group of this rank.
class GroupRanks {
 public:
  GroupRanks(const Groups& groups, const analysis::Ranks& all) {
    MPI_Comm_split(all.comm, groups.of_rank(all.rank), all.rank, &comm_);
  }
  GroupRanks(const GroupRanks&) = delete;
  GroupRanks& operator=(const GroupRanks&) = delete;
  ~GroupRanks() { MPI_Comm_free(&comm_); }

  analysis::Ranks get() const { return analysis::Ranks(comm_); }

 private:
  MPI_Comm comm_ = MPI_COMM_NULL;
};

/// Calls `call(task, ranks)` for the tasks of this group. Ranks that share a task have the same
/// steady states. Stops when the user interrupts the run.
template <class Call>
void deal(CampbellPointFinder& finder, std::size_t count, const analysis::Ranks& all,
          const std::string& what, analysis::Observer& observer, const Call& call) {
  if (count == 0) return;
  const Groups groups(count, all);
  const GroupRanks sharing(groups, all);
  const analysis::Ranks ranks = sharing.get();
  if (ranks.size > 1) finder.forget();
  for (std::size_t task = 0; task < count; ++task) {
    if (groups.of_task(task) != groups.of_rank(all.rank)) continue;
    if (!ranks.all(!Interruption::is_asked())) return;
    observer.progress(what, static_cast<long>(task), static_cast<long>(count));
    call(task, ranks);
  }
}

}  // namespace

CampbellPoint CampbellPointFinder::find(const SweepPlace& place, const analysis::Ranks& ranks) {
  Notes notes;
  CampbellPoint result;
  const auto fail = [&](const std::exception& error) {
    result = {};
    result.failure = error.what();
    result.rotor_speed = result.pitch = std::numeric_limits<double>::quiet_NaN();
  };
  try {
    result = find_modes(place, ranks, notes);
  } catch (const InputError& error) {
    fail(error);
  } catch (const ConvergenceError& error) {
    fail(error);
  } catch (const DomainError& error) {
    fail(error);
  }
  result.place = place;
  result.notes = std::move(notes.texts);
  return result;
}

CampbellPlan plan_campbell(const Job& job, const std::vector<simulation::ScheduledPoint>& table) {
  CampbellPlan plan;
  if (job.sweep.is_given()) {
    for (const std::string& key : job.sweep.keys())
      plan.quantities.push_back({key, io::unit_of_key(key)});
    plan.places = job.sweep.places();
    for (const std::string& text : job.sweep.case_texts())
      plan.origins.push_back(point_origin(text, ""));
    plan.origin_at = [&job](const SweepPlace& place) {
      return point_origin(job.sweep.case_at(place).text, "");
    };
    plan.finder = std::make_unique<SweepFinder>(job.sweep);
  } else {
    plan.quantities = {{"wind.speed", "m/s"}};
    const std::string rows = row_words(table);
    plan.origin_at = [&job, rows](const SweepPlace& place) {
      return point_origin(job.input.text, rows + exact_words({place.value}));
    };
    for (const double wind : simulation::operating_winds(job.input, table)) {
      plan.places.push_back({wind});
      plan.origins.push_back(plan.origin_at(plan.places.back()));
    }
    plan.finder = std::make_unique<OperationFinder>(job.input, table);
  }
  return plan;
}

void find_points(const CampbellPlan& plan, const io::CampbellPointFiles& files,
                 const analysis::Ranks& ranks, analysis::Observer& observer) {
  std::vector<std::size_t> missing;
  for (std::size_t point = 0; point < plan.places.size(); ++point)
    if (!files.has(point)) missing.push_back(point);
  // No rank writes before all have looked.
  MPI_Barrier(ranks.comm);
  ranks.share(0, missing);
  if (missing.empty()) return;
  const Groups groups(missing.size(), ranks);
  const std::size_t runs = runs_of_group * groups.count();
  const std::size_t in_run = std::max<std::size_t>(1, (missing.size() + runs - 1) / runs);
  std::vector<std::size_t> own;
  for (std::size_t i = 0; i < missing.size(); ++i)
    if (groups.of_task(i / in_run) == groups.of_rank(ranks.rank)) own.push_back(missing[i]);
  const GroupRanks sharing(groups, ranks);
  const analysis::Ranks group = sharing.get();
  if (group.size > 1) plan.finder->forget();  // other groups may have been before
  for (std::size_t i = 0; i < own.size() && group.all(!Interruption::is_asked()); ++i) {
    observer.progress("points", static_cast<long>(i), static_cast<long>(own.size()));
    const CampbellPoint point = plan.finder->find(plan.places[own[i]], group);
    group.attempt([&] {
      if (group.rank == 0) files.write(own[i], point);
    });
  }
}

int rank_of(std::size_t number, std::size_t count, const analysis::Ranks& ranks) {
  const Groups groups(count, ranks);
  return groups.first_rank(groups.of_task(number));
}

void CampbellPlan::insert(const std::vector<double>& values) {
  for (const double value : values)
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
      const auto [low, high] = std::minmax(places[i].value, places[i + 1].value);
      if (!(low < value && value < high)) continue;
      const auto behind = static_cast<std::ptrdiff_t>(i) + 1;
      places.insert(places.begin() + behind, {value});
      origins.insert(origins.begin() + behind, origin_at({value}));
      break;
    }
}

std::vector<double> search_bands(const CampbellPlan& plan,
                                 const std::vector<simulation::Resonance>& resonances,
                                 const analysis::Ranks& ranks, analysis::Observer& observer) {
  std::vector<double> places(resonances.size(), std::numeric_limits<double>::quiet_NaN());
  deal(*plan.finder, resonances.size(), ranks, "bands of instability", observer,
       [&](std::size_t i, const analysis::Ranks& sharing) {
         const std::optional<double> place = simulation::find_band(
             resonances[i],
             [&](double value) { return find_or_stop(*plan.finder, {value}, sharing); });
         if (place) places[i] = *place;
       });
  return places;
}

std::vector<std::vector<StabilityEdge>> search_edges(
    const CampbellPlan& plan, const io::CampbellPointFiles& files,
    const std::vector<std::pair<std::size_t, std::size_t>>& pairs, const analysis::Ranks& ranks,
    analysis::Observer& observer) {
  std::vector<std::vector<StabilityEdge>> edges(pairs.size());
  deal(*plan.finder, pairs.size(), ranks, "edges of instability", observer,
       [&](std::size_t i, const analysis::Ranks& sharing) {
         std::optional<CampbellPoint> from;
         std::optional<CampbellPoint> to;
         sharing.attempt([&] {
           from = files.read(pairs[i].first);
           to = files.read(pairs[i].second);
         });
         if (!sharing.all(from && to)) return;
         edges[i] = simulation::find_edges(*from, *to, [&](double value) {
           return find_or_stop(*plan.finder, {value, from->place.second}, sharing);
         });
       });
  return edges;
}

}  // namespace samara::drivers
