#include "campbell_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/io/schema.hpp"
#include "samara/petsc/session.hpp"
#include "samara/simulation/steady_state.hpp"

#include "interruption.hpp"
#include "point_origin.hpp"

namespace samara::drivers {
namespace {

using simulation::CampbellPoint;
using simulation::StabilityEdge;
using simulation::SweepPlace;

/// Groups of neighbouring points of a rank: points cost unlike time at the ends of a sweep.
constexpr std::size_t groups_of_rank = 4;

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
      const io::Case& own = read.emplace(sweep_.case_at(place));
      const turbine::TurbineSystem& system =
          built.emplace(model::build_turbine(own.turbine), PETSC_COMM_SELF);
      const bool is_near = last_ && last_->solution.coefficients().rows() == system.size();
      last_ = simulation::solve_trim(own, system, simulation::trim_options(own), observer,
                                     PETSC_COMM_SELF, is_near ? &*last_ : nullptr);
      simulation::require_wake_range(system, *last_);
      simulation::note_roughness(*last_, observer);
    });
    const io::Case& input = *read;
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
    ranks.attempt([&] { finder_->find_at(place.value, observer); });
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

/// Deals tasks to the ranks: some to each, or one task to several ranks.
class Tasks {
 public:
  Tasks(std::size_t count, const analysis::Ranks& ranks)
      : count_(count),
        all_(ranks),
        own_(rank_of(static_cast<std::size_t>(all_.rank), count_, all_)) {
    MPI_Comm_split(all_.comm, own_, all_.rank, &comm_);
  }
  Tasks(const Tasks&) = delete;
  Tasks& operator=(const Tasks&) = delete;
  ~Tasks() { MPI_Comm_free(&comm_); }

  bool has(std::size_t task) const { return rank_of(task, count_, all_) == own_; }
  analysis::Ranks ranks() const { return analysis::Ranks(comm_); }

 private:
  std::size_t count_;
  analysis::Ranks all_;
  int own_;  ///< the first one of the ranks that share the tasks of this one
  MPI_Comm comm_ = MPI_COMM_NULL;
};

/// Calls `call(task, ranks)` for the tasks of this rank. Ranks that share a task have the same
/// steady states. Stops when the user interrupts the run.
template <class Call>
void deal(CampbellPointFinder& finder, std::size_t count, const analysis::Ranks& all,
          const std::string& what, analysis::Observer& observer, const Call& call) {
  if (count == 0) return;
  const Tasks tasks(count, all);
  const analysis::Ranks ranks = tasks.ranks();
  if (ranks.size > 1) finder.forget();
  for (std::size_t task = 0; task < count; ++task) {
    if (!tasks.has(task)) continue;
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
  const auto rank = static_cast<std::size_t>(ranks.rank);
  const auto size = static_cast<std::size_t>(ranks.size);
  std::vector<std::size_t> missing;
  for (std::size_t point = 0; point < plan.places.size(); ++point)
    if (!files.has(point)) missing.push_back(point);
  // No rank writes before all have looked.
  MPI_Barrier(ranks.comm);
  const std::size_t groups = groups_of_rank * size;
  const std::size_t in_group = std::max<std::size_t>(1, (missing.size() + groups - 1) / groups);
  std::vector<std::size_t> own;
  for (std::size_t i = 0; i < missing.size(); ++i)
    if (i / in_group % size == rank) own.push_back(missing[i]);
  const analysis::Ranks alone(PETSC_COMM_SELF);
  for (std::size_t i = 0; i < own.size() && !Interruption::is_asked(); ++i) {
    observer.progress("points", static_cast<long>(i), static_cast<long>(own.size()));
    files.write(own[i], plan.finder->find(plan.places[own[i]], alone));
  }
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
