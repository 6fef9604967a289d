#include "samara/petsc/handle.hpp"

#include <string>

#include "samara/base/error.hpp"

namespace samara::petsc {

void check(PetscErrorCode code, const char* file, int line) {
  if (code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  throw InternalError(std::string("PETSc: ") + (text != nullptr ? text : "unknown error") +
                      " (code " + std::to_string(code) + ") at " + file + ":" +
                      std::to_string(line));
}

Handle<Vec> make_vector(MPI_Comm comm, PetscInt local_size, PetscInt size) {
  Handle<Vec> vector;
  check(VecCreate(comm, vector.fill()));
  check(VecSetSizes(vector.get(), local_size, size));
  check(VecSetType(vector.get(), VECSTANDARD));
  check(VecSet(vector.get(), 0.0));
  return vector;
}

std::vector<double> values_of(Vec vector) {
  PetscInt size = 0;
  check(VecGetLocalSize(vector, &size));
  const ReadView view(vector);
  return {view.data(), view.data() + size};
}

}  // namespace samara::petsc
