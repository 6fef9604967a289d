// Start-up and shut-down of MPI, PETSc and SLEPc.
#pragma once

#include <string>
#include <vector>

#include <mpi.h>

namespace samara::petsc {

/// Starts MPI, PETSc and SLEPc where they do not run yet, and ends only those that it started:
/// other sessions, and callers that have started them, keep them. `options` are arguments for
/// PETSc's options database.
class Session {
 public:
  explicit Session(const std::vector<std::string>& options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  static int rank();
  static int size();

  /// True where a launcher (mpirun, srun) started this process as one of several. This is known
  /// before a session starts, and so is the rank that the process will have (0 without a launcher).
  static bool is_launched();
  static int launch_rank();

  /// Common exit code of all ranks: the largest of theirs. Every rank calls it at the same points
  /// of its work; the first one that failed prints its message to stderr in whole lines. If the
  /// others do not call it within some seconds (they wait for this rank in a collective call), the
  /// failed rank prints its message and ends them all.
  int agree(int code, const std::string& message) const;

  /// Options that no object has read, as text; empty if there are none.
  static std::string unused_options();

  /// All options in force: of the command line, of PETSC_OPTIONS and of .petscrc.
  static std::string options();

 private:
  void adopt(const std::vector<std::string>& options);

  bool has_slepc_ = false;              ///< this session started SLEPc
  MPI_Comm agreement_ = MPI_COMM_NULL;  ///< separate from all communication of the analyses
};

/// The smallest value of all ranks. One that waits for others sleeps between tests, after a moment:
/// MPI's busy waiting would take processor time and memory bandwidth from the ranks that work.
int find_smallest(int value, MPI_Comm comm);

/// A stage of the work in the table of PETSc's `-log_view`, for the length of a scope.
class Stage {
 public:
  explicit Stage(const char* name);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;
};

/// Versions of PETSc, SLEPc, MPI and BLAS as text, a line each.
std::string library_versions();

}  // namespace samara::petsc
