#include "campbell_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/base/version.hpp"
#include "samara/io/schema.hpp"
#include "samara/petsc/session.hpp"
#include "samara/simulation/steady_state.hpp"

#include "interruption.hpp"

namespace samara::drivers {
namespace {

using simulation::CampbellPoint;
using simulation::StabilityEdge;
using simulation::SweepPlace;

constexpr int exact_digits = 17;

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

 private:
  CampbellPoint find_modes(const SweepPlace& place, analysis::Observer& observer) override {
    const io::Case input = sweep_.case_at(place);
    const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
    const bool is_near = last_ && last_->solution.coefficients().rows() == system.size();
    last_ = simulation::solve_trim(input, system, simulation::trim_options(input), observer,
                                   PETSC_COMM_SELF, is_near ? &*last_ : nullptr);
    simulation::require_wake_range(system, *last_);
    simulation::note_roughness(*last_, observer);
    CampbellPoint result = simulation::find_campbell_point(system, *last_, input.floquet, observer);
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
      : input_(input), finder_(input, table) {}

 private:
  CampbellPoint find_modes(const SweepPlace& place, analysis::Observer& observer) override {
    finder_.find_at(place.value, observer);
    CampbellPoint result =
        simulation::find_campbell_point(finder_.system(), finder_.trim(), input_.floquet, observer);
    result.wind_speed = place.value;
    return result;
  }

  const io::Case& input_;
  simulation::OperatingPointFinder finder_;
};

std::string origin_of(const std::string& case_text, const std::string& value) {
  return std::string("samara ") + version + "\n" + petsc::Session::options() + "\n" + value + "\n" +
         case_text;
}

/// Halves the place of an edge until it is accurate, a point has no modes, or the user interrupts.
void bisect(CampbellPointFinder& finder, StabilityEdge& edge) {
  const double accuracy =
      simulation::edge_accuracy * std::max(std::abs(edge.to), std::abs(edge.from));
  while (std::abs(edge.to - edge.from) > accuracy && !Interruption::is_asked()) {
    const double middle = 0.5 * (edge.from + edge.to);
    const CampbellPoint point = finder.find({middle, edge.second});
    if (!point.failure.empty()) return;
    const int growing = simulation::count_growing(point);
    if (growing == edge.growing_from) {
      edge.from = middle;
    } else {
      edge.to = middle;
      edge.growing_to = growing;
    }
  }
}

}  // namespace

CampbellPoint CampbellPointFinder::find(const SweepPlace& place) {
  Notes notes;
  CampbellPoint result;
  const auto fail = [&](const std::exception& error) {
    result = {};
    result.failure = error.what();
    result.rotor_speed = result.pitch = std::numeric_limits<double>::quiet_NaN();
  };
  try {
    result = find_modes(place, notes);
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
      plan.origins.push_back(origin_of(text, ""));
    plan.origin_at = [&job](const SweepPlace& place) {
      return origin_of(job.sweep.case_at(place).text, "");
    };
    plan.finder = std::make_unique<SweepFinder>(job.sweep);
  } else {
    plan.quantities = {{"wind.speed", "m/s"}};
    std::string rows;
    for (const simulation::ScheduledPoint& row : table)
      for (const double value : {row.wind, row.speed, row.pitch})
        rows += general(value, exact_digits) + " ";
    plan.origin_at = [&job, rows](const SweepPlace& place) {
      return origin_of(job.input.text, rows + general(place.value, exact_digits));
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
  const std::size_t first = missing.size() * rank / size;
  const std::size_t end = missing.size() * (rank + 1) / size;
  for (std::size_t i = first; i < end && !Interruption::is_asked(); ++i) {
    observer.progress("points", static_cast<long>(i - first), static_cast<long>(end - first));
    files.write(missing[i], plan.finder->find(plan.places[missing[i]]));
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
  for (std::size_t i = 0; i < resonances.size(); ++i) {
    if (rank_of(i, ranks) != ranks.rank || Interruption::is_asked()) continue;
    observer.progress("bands of instability", static_cast<long>(i),
                      static_cast<long>(resonances.size()));
    const std::optional<double> place = simulation::find_band(resonances[i], [&plan](double value) {
      if (!Interruption::is_asked()) return plan.finder->find({value});
      CampbellPoint none;
      none.failure = "interrupted";
      return none;
    });
    if (place) places[i] = *place;
  }
  return places;
}

void refine_edges(const CampbellPlan& plan, std::vector<StabilityEdge>& edges,
                  const analysis::Ranks& ranks, analysis::Observer& observer) {
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (rank_of(i, ranks) != ranks.rank) continue;
    observer.progress("edges of instability", static_cast<long>(i),
                      static_cast<long>(edges.size()));
    bisect(*plan.finder, edges[i]);
  }
}

}  // namespace samara::drivers
