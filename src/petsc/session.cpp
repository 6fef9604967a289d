#include "samara/petsc/session.hpp"

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include <unistd.h>

#include "samara/base/error.hpp"
#include "samara/petsc/blas_kernels.hpp"
#include "samara/petsc/handle.hpp"

namespace samara::petsc {
namespace {

/// Time that a failed rank waits for the others, which may be in the middle of a computation [s].
constexpr double patience = 5.0;
/// Time during which a waiting rank polls without a pause [s].
constexpr double spinning = 1e-3;
/// Length of a pause between two tests after that time.
constexpr std::chrono::microseconds rest{200};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A pause, if the rank has waited longer than it polls without one. `waited` [s].
void rest_after(double waited) {
  if (waited > spinning) std::this_thread::sleep_for(rest);
}

/// PETSc does not handle signals: a reader that ends early (samara ... | head) is not a crash. The
/// only file of options is that of the home folder: PETSc would also read `.petscrc` and `petscrc`
/// of the current folder, which may belong to anybody and can load code (-dll_prepend).
constexpr std::array<const char*, 2> own_options{"-no_signal_handler", "-skip_petscrc"};

/// Puts the options of the home folder's `.petscrc` in front of those of the environment.
void take_home_options() {
  const char* home = std::getenv("HOME");
  if (home == nullptr) return;
  const std::string path = std::string(home) + "/.petscrc";
  if (path.find_first_of(" \t\n") != std::string::npos || ::access(path.c_str(), R_OK) != 0) return;
  const char* others = std::getenv("PETSC_OPTIONS");
  const std::string all =
      "-options_file " + path + (others == nullptr ? "" : " ") + (others == nullptr ? "" : others);
  setenv("PETSC_OPTIONS", all.c_str(), 1);
}

/// A number that one of the launchers sets in the environment, or `otherwise`.
int launcher_number(std::initializer_list<const char*> names, int otherwise) {
  for (const char* name : names)
    if (const char* value = std::getenv(name)) return std::atoi(value);
  return otherwise;
}

/// Open MPI looks for networks that a single machine does not need; this takes longer than many
/// runs (0.38 s against 0.07 s). Settings of the user in the environment have priority.
void prepare_transport() {
  const auto set = [](const char* name, const char* value) { setenv(name, value, 0); };
  const char* size = std::getenv("OMPI_COMM_WORLD_SIZE");
  const char* local_size = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
  if (size != nullptr) {
    if (local_size == nullptr || std::string(size) != local_size) return;
    set("OMPI_MCA_pml", "ob1");
    set("OMPI_MCA_btl", "self,vader");
    return;
  }
  if (std::getenv("PMIX_RANK") != nullptr || std::getenv("PMI_RANK") != nullptr) return;
  set("OMPI_MCA_ess_singleton_isolated", "1");
  set("OMPI_MCA_orte_create_session_dirs", "0");  // otherwise simultaneous runs share a folder
  set("OMPI_MCA_pml", "ob1");
  set("OMPI_MCA_btl", "self");
  set("OMPI_MCA_sharedfp", "^sm");  // it needs the folder that is not made
}

}  // namespace

Session::Session(const std::vector<std::string>& options) {
  PetscBool is_running = PETSC_FALSE;
  PetscInitialized(&is_running);
  if (is_running != PETSC_FALSE) {
    adopt(options);
    return;
  }
  int has_ended = 0;
  MPI_Finalized(&has_ended);
  if (has_ended != 0)
    throw InternalError(
        "MPI has ended in this process, and cannot start again; hint: use one "
        "Session for the whole program");
  int has_mpi = 0;
  MPI_Initialized(&has_mpi);
  if (has_mpi == 0) prepare_transport();
  take_home_options();
  choose_blas_kernels();
  std::vector<std::string> words{"samara"};
  words.insert(words.end(), own_options.begin(), own_options.end());
  words.insert(words.end(), options.begin(), options.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  int argc = static_cast<int>(words.size());
  char** pointer = argv.data();
  if (SlepcInitialize(&argc, &pointer, nullptr, nullptr) != 0)
    throw InternalError("PETSc and SLEPc do not start");
  has_slepc_ = true;
  // Errors come back as codes and become exceptions; the default handler would print a page.
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  if (size() > 1) MPI_Comm_dup(PETSC_COMM_WORLD, &agreement_);
}

/// Adds to the options of a PETSc that runs already. Libraries not started here are not ended here.
void Session::adopt(const std::vector<std::string>& options) {
  std::string text;
  for (const std::string& word : options) text += (text.empty() ? "" : " ") + word;
  check(PetscOptionsInsertString(nullptr, text.c_str()));
  PetscBool has_slepc = PETSC_FALSE;
  SlepcInitialized(&has_slepc);
  if (has_slepc == PETSC_FALSE) {
    check(SlepcInitializeNoArguments());
    has_slepc_ = true;
  }
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  if (size() > 1) MPI_Comm_dup(PETSC_COMM_WORLD, &agreement_);
}

Session::~Session() {
  if (agreement_ != MPI_COMM_NULL) MPI_Comm_free(&agreement_);
  PetscPopErrorHandler();
  if (has_slepc_) SlepcFinalize();  // ends PETSc if it started it; likewise PETSc ends MPI
}

int Session::rank() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}

int Session::size() {
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return size;
}

bool Session::is_launched() {
  return launcher_number({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_NTASKS"}, 1) > 1 &&
         launcher_number({"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"}, -1) >= 0;
}

int Session::launch_rank() {
  return launcher_number({"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"}, 0);
}

int Session::agree(int code, const std::string& message) const {
  const int ticket = code == 0 ? 0 : size() - rank();  // largest on the first that failed
  const std::array<int, 2> own{code, ticket};
  std::array<int, 2> all = own;
  if (size() > 1) {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallreduce(own.data(), all.data(), 2, MPI_INT, MPI_MAX, agreement_, &request);
    const auto start = std::chrono::steady_clock::now();
    int done = 0;
    while (done == 0) {
      MPI_Test(&request, &done, MPI_STATUS_IGNORE);
      const double waited = seconds_since(start);
      if (done == 0 && code != 0 && waited > patience) {
        std::fputs(message.c_str(), stderr);
        std::fflush(stderr);
        MPI_Abort(MPI_COMM_WORLD, code);
      }
      if (done == 0) rest_after(waited);
    }
    MPI_Wait(&request, MPI_STATUS_IGNORE);  // ended: returns at once
  }
  if (ticket > 0 && ticket == all[1]) {
    std::fputs(message.c_str(), stderr);
    std::fflush(stderr);
  }
  return all[0];
}

std::string Session::unused_options() {
  PetscInt count = 0;
  char** names = nullptr;
  char** values = nullptr;
  check(PetscOptionsLeftGet(nullptr, &count, &names, &values));
  std::string text;
  for (PetscInt i = 0; i < count; ++i) text += std::string(text.empty() ? "-" : " -") + names[i];
  check(PetscOptionsLeftRestore(nullptr, &count, &names, &values));
  return text;
}

std::string Session::options() {
  char* all = nullptr;
  check(PetscOptionsGetAll(nullptr, &all));
  std::string text(all);
  PetscFree(all);
  for (const std::string word : own_options)
    if (const std::size_t at = text.find(word); at != std::string::npos)
      text.erase(at, word.size() + 1);  // and the blank behind it
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

int find_smallest(int value, MPI_Comm comm) {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Iallreduce(MPI_IN_PLACE, &value, 1, MPI_INT, MPI_MIN, comm, &request);
  const auto start = std::chrono::steady_clock::now();
  for (int done = 0; done == 0;) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done == 0) rest_after(seconds_since(start));
  }
  MPI_Wait(&request, MPI_STATUS_IGNORE);  // ended: returns at once
  return value;
}

Stage::Stage(const char* name) {
  PetscLogStage stage = -1;
  check(PetscLogStageGetId(name, &stage));
  if (stage < 0) check(PetscLogStageRegister(name, &stage));
  check(PetscLogStagePush(stage));
}

Stage::~Stage() { PetscLogStagePop(); }

std::string library_versions() {
  char petsc[256];
  char slepc[256];
  char mpi[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  check(PetscGetVersion(petsc, sizeof petsc));
  check(SlepcGetVersion(slepc, sizeof slepc));
  MPI_Get_library_version(mpi, &length);
  const std::string whole(mpi, static_cast<std::size_t>(length));
  const auto line = [](const std::string& text) {
    return text.substr(0, text.find_last_not_of(" \n") + 1);
  };
  return line(petsc) + "\n" + line(slepc) + "\n" + whole.substr(0, whole.find(',')) + "\n" +
         blas_version();
}

}  // namespace samara::petsc
