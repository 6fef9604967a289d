#include "samara/system/periodic_system.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace samara::system {
namespace {

std::string words_of(const PeriodicSystem& system, std::size_t row) {
  return std::string("the ") + word_of(system.rows()[row]) + " row of \"" +
         system.unknowns()[row].name() + '"';
}

std::string words_of(const Unknown& unknown) {
  return std::string("the ") + word_of(unknown.role) + " \"" + unknown.name() + '"';
}

void require_counts(const PeriodicSystem& system) {
  const auto unknowns = [&system](UnknownRole role) {
    return std::ranges::count(system.unknowns(), role, &Unknown::role);
  };
  const auto rows = [&system](RowRole role) { return std::ranges::count(system.rows(), role); };
  if (unknowns(UnknownRole::velocity) != rows(RowRole::kinematic))
    throw InternalError(std::to_string(rows(RowRole::kinematic)) + " kinematic rows for " +
                        std::to_string(unknowns(UnknownRole::velocity)) +
                        " velocities; hint: a first-order equation needs a state and an "
                        "evolution row");
  for (std::size_t i = 0; i < system.rows().size(); ++i) {
    const Unknown& unknown = system.unknowns()[i];
    const RowRole row = system.rows()[i];
    if ((unknown.role == UnknownRole::state) != (row == RowRole::evolution) ||
        (unknown.role == UnknownRole::auxiliary) != (row == RowRole::definition))
      throw InternalError(words_of(unknown) + " has " + words_of(system, i) + " at the same index");
    if (!(unknown.scale > 0.0) || !std::isfinite(unknown.scale))
      throw InternalError(words_of(unknown) + " must have a positive scale");
    const bool has_rate = system.differential()[i];
    if (unknown.role == UnknownRole::state && !has_rate)
      throw InternalError(words_of(unknown) + " has no rate in any row");
    if (unknown.role == UnknownRole::auxiliary && has_rate)
      throw InternalError("the rate of " + words_of(unknown) + " appears in a row");
  }
}

}  // namespace

double base_rate(const PeriodicSystem& system) {
  return system.period() > 0.0 ? 2.0 * std::numbers::pi / system.period() : 1.0;
}

void require_roles(const PeriodicSystem& system) {
  require_counts(system);
  const std::vector<std::vector<PetscInt>> pattern = system.pattern();
  if (pattern.empty()) {
    if (std::ranges::count(system.rows(), RowRole::evolution) +
            std::ranges::count(system.rows(), RowRole::definition) >
        0)
      throw InternalError("a system with states or auxiliaries must declare its pattern");
    return;
  }
  const auto unknown_at = [&system](PetscInt i) -> const Unknown& {
    return system.unknowns()[static_cast<std::size_t>(i)];
  };
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const RowRole row = system.rows()[i];
    if (row != RowRole::constraint && row != RowRole::kinematic) continue;
    for (const PetscInt j : pattern[i]) {
      const Unknown& unknown = unknown_at(j);
      const bool is_constraint = row == RowRole::constraint;
      const bool is_refused =
          unknown.role == UnknownRole::auxiliary ||
          unknown.role == (is_constraint ? UnknownRole::velocity : UnknownRole::internal);
      if (is_refused)
        throw InternalError(words_of(system, i) + " must not contain " + words_of(unknown));
      if (!is_constraint || unknown.role != UnknownRole::state) continue;
      for (const PetscInt k : pattern[static_cast<std::size_t>(j)]) {
        const UnknownRole role = unknown_at(k).role;
        if (role == UnknownRole::velocity || role == UnknownRole::internal ||
            role == UnknownRole::auxiliary)
          throw InternalError(words_of(system, i) + " must not contain " + words_of(unknown) +
                              ", because its evolution row contains " + words_of(unknown_at(k)));
      }
    }
  }
}

}  // namespace samara::system
