#include "held_columns.hpp"

#include <algorithm>
#include <utility>

#include "samara/petsc/session.hpp"

namespace samara::analysis {

void hold_coordinates(Mat tangent, const std::vector<system::UnconstrainedCoordinate>& held) {
  if (held.empty()) return;
  PetscInt rows = 0;
  petsc::check(MatGetSize(tangent, &rows, nullptr));
  std::vector<std::pair<PetscInt, PetscInt>> entries;
  for (PetscInt i = 0; i < rows; ++i) {
    PetscInt count = 0;
    const PetscInt* columns = nullptr;
    petsc::check(MatGetRow(tangent, i, &count, &columns, nullptr));
    for (const system::UnconstrainedCoordinate& coordinate : held)
      if (std::find(columns, columns + count, coordinate.unknown) != columns + count)
        entries.emplace_back(i, coordinate.unknown);
    petsc::check(MatRestoreRow(tangent, i, &count, &columns, nullptr));
  }
  for (const auto& [row, column] : entries)
    petsc::check(MatSetValue(tangent, row, column, 0.0, INSERT_VALUES));
  for (const system::UnconstrainedCoordinate& coordinate : held)
    petsc::check(MatSetValue(tangent, coordinate.row, coordinate.unknown, 1.0, INSERT_VALUES));
  petsc::check(MatAssemblyBegin(tangent, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(tangent, MAT_FINAL_ASSEMBLY));
}

}  // namespace samara::analysis
