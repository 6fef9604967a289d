// Options that PETSc and SLEPc read for an object.
#pragma once

#include <petscsys.h>

namespace samara::petsc {

/// Does nothing if `code`, from a call ...SetFromOptions of `object`, is zero.
/// @throws InputError with the prefix of the options and PETSc's message
void check_options(PetscErrorCode code, PetscObject object);

/// Calls `take`, for example KSPSetFromOptions, for an object.
/// @throws InputError like check_options
template <class Object>
void take_options(PetscErrorCode (*take)(Object), Object object) {
  check_options(take(object), reinterpret_cast<PetscObject>(object));
}

}  // namespace samara::petsc
