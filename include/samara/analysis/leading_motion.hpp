// Which motion of the turbine a mode is named after, and at which harmonic it moves
// (docs/theory.md, section 5.6).
#pragma once

#include <string>
#include <vector>

#include "samara/analysis/mode.hpp"
#include "samara/analysis/periodic_solution.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Number of equal parts, the blades, that have motions.
int count_instances(const std::vector<system::Motion>& motions);

/// The motion that a mode is named after: that with most kinetic and strain energy.
struct LeadingMotion {
  system::Motion motion;
  /// How the blades do it together: in n each is 2 pi n / B ahead of the one behind it, -1: none of
  /// them clearly.
  int component = -1;
  int harmonic = 0;      ///< in which it has its energy, as Mode::harmonic
  bool is_clear = true;  ///< most of its energy is in this harmonic
};

/// One for each mode; none where the system does not know its motions. Needs the shapes, each of a
/// number of instants of every one of `sectors` parts of the period, of `set.shape_times` the
/// first: empty where there are none.
std::vector<LeadingMotion> find_leading_motions(const system::PeriodicSystem& system,
                                                const PeriodicSolution& solution,
                                                const ModeSet& set, int sectors = 1);

}  // namespace samara::analysis
