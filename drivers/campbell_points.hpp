// The points of a Campbell diagram: found by all ranks, kept in files.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "samara/analysis/observer.hpp"
#include "samara/analysis/ranks.hpp"
#include "samara/io/campbell_file.hpp"
#include "samara/simulation/campbell.hpp"
#include "samara/simulation/edge_search.hpp"
#include "samara/simulation/operation.hpp"
#include "samara/simulation/resonance.hpp"

#include "job.hpp"

namespace samara::drivers {

/// Finds points one after the other, each steady state from the one before.
class CampbellPointFinder {
 public:
  CampbellPointFinder() = default;
  CampbellPointFinder(const CampbellPointFinder&) = delete;
  CampbellPointFinder& operator=(const CampbellPointFinder&) = delete;
  virtual ~CampbellPointFinder() = default;

  /// The point at a place. Where it has no steady state, or its modes are not found, it has the
  /// reason. `ranks`: that share the work, with the same points before.
  simulation::CampbellPoint find(const simulation::SweepPlace& place, const analysis::Ranks& ranks);
  /// The next steady state does not start from the one before.
  virtual void forget() = 0;

 private:
  /// @throws InputError, ConvergenceError, DomainError on all ranks
  virtual simulation::CampbellPoint find_modes(const simulation::SweepPlace& place,
                                               const analysis::Ranks& ranks,
                                               analysis::Observer& observer) = 0;
};

/// The points to find: at the places of job.sweep, or at the operating points of the case.
struct CampbellPlan {
  std::vector<io::SweptQuantity> quantities;  ///< one, or the two of a map
  std::vector<simulation::SweepPlace> places;
  std::vector<std::string> origins;  ///< of io::CampbellPointFiles
  std::function<std::string(const simulation::SweepPlace&)> origin_at;
  std::unique_ptr<CampbellPointFinder> finder;

  /// Adds points of a sweep of one quantity where they are between two others.
  void insert(const std::vector<double>& values);
};

/// `job` and `table`, the rows of operation.table, must outlive the plan.
CampbellPlan plan_campbell(const Job& job, const std::vector<simulation::ScheduledPoint>& table);

/// Finds the points that no file has, those of this group of ranks. Groups take neighbouring points
/// in turn. Stops when the user interrupts the run.
/// @throws InputError for an option -samara_groups out of range, on all ranks
void find_points(const CampbellPlan& plan, const io::CampbellPointFiles& files,
                 const analysis::Ranks& ranks, analysis::Observer& observer);

/// Searches bands of instability at resonances. Stops when the user interrupts the run.
/// @returns for each resonance of this group a place in a band; not-a-number where there is none
std::vector<double> search_bands(const CampbellPlan& plan,
                                 const std::vector<simulation::Resonance>& resonances,
                                 const analysis::Ranks& ranks, analysis::Observer& observer);

/// Finds the edges of instability between pairs of points of the plan, which have files. Stops when
/// the user interrupts the run.
/// @returns for each pair of this group its edges, refined to simulation::edge_accuracy relative to
/// the larger value
std::vector<std::vector<simulation::StabilityEdge>> search_edges(
    const CampbellPlan& plan, const io::CampbellPointFiles& files,
    const std::vector<std::pair<std::size_t, std::size_t>>& pairs, const analysis::Ranks& ranks,
    analysis::Observer& observer);

/// The rank that has the result of a pair or a resonance, of so many: the first one of its group.
int rank_of(std::size_t number, std::size_t count, const analysis::Ranks& ranks);

}  // namespace samara::drivers
