#include "samara/system/periodic_system.hpp"

#include <numeric>

namespace samara::system {

std::vector<std::vector<PetscInt>> PeriodicSystem::pattern() const {
  std::vector<PetscInt> all(static_cast<std::size_t>(size()));
  std::iota(all.begin(), all.end(), PetscInt{0});
  return std::vector<std::vector<PetscInt>>(all.size(), all);
}

}  // namespace samara::system
