// Start-up and shut-down of MPI, PETSc and SLEPc.
#pragma once

#include <string>
#include <vector>

namespace samara::petsc {

/// One per process. Takes the arguments that belong to PETSc's options database.
class Session {
 public:
  explicit Session(const std::vector<std::string>& options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  static int rank();
  static int size();

  /// Options that no object asked for, in words; empty if none.
  static std::string unused_options();
};

/// Versions of PETSc, SLEPc and MPI in words.
std::string library_versions();

}  // namespace samara::petsc
