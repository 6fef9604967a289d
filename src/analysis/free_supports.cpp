#include "samara/analysis/free_supports.hpp"

namespace samara::analysis {

std::vector<system::NeutralCoordinate> find_free_supports(const system::PeriodicSystem& system) {
  std::vector<system::NeutralCoordinate> found;
  for (std::size_t i = 0; i < system.unknowns().size(); ++i) {
    const system::Unknown& unknown = system.unknowns()[i];
    const auto at = static_cast<PetscInt>(i);
    if (unknown.is_free) found.push_back({unknown.name(), at, at, unknown.load_unit()});
  }
  return found;
}

}  // namespace samara::analysis
