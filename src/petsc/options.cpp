#include "samara/petsc/options.hpp"

#include <string>

#include "samara/base/error.hpp"
#include "samara/petsc/handle.hpp"

namespace samara::petsc {

void check_options(PetscErrorCode code, PetscObject object) {
  if (code == 0 || code == PETSC_ERR_MEM) {
    check(code);
    return;
  }
  const char* general = nullptr;
  char* particular = nullptr;  // of the error that was raised last
  const char* prefix = nullptr;
  PetscErrorMessage(code, &general, &particular);
  PetscObjectGetOptionsPrefix(object, &prefix);
  std::string text = particular != nullptr && *particular != '\0' ? particular
                     : general != nullptr                         ? general
                                                                  : "unknown error";
  if (const std::size_t end = text.find('\n'); end != std::string::npos) text.resize(end);
  throw InputError(std::string("options -") + (prefix != nullptr ? prefix : "") +
                   "...: PETSc refuses one of them: " + text +
                   "; hint: PETSc's manual lists the values");
}

}  // namespace samara::petsc
