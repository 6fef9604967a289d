// What a turbine's unknowns are called and stand for: names, roles, symmetry, energies.
#pragma once

#include <vector>

#include "samara/model/layout.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::system {

struct TurbineDescription {
  std::vector<Unknown> unknowns;
  std::vector<RowRole> rows;
  RotorSymmetry symmetry;
  std::vector<EnergyGroup> groups;
  std::vector<NeutralCoordinate> neutral;
};

TurbineDescription describe(const model::Turbine& turbine, const model::Layout& layout);

}  // namespace samara::system
