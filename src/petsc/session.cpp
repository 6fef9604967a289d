#include "samara/petsc/session.hpp"

#include <cstdlib>
#include <string>

#include "samara/base/error.hpp"
#include "samara/petsc/handle.hpp"

namespace samara::petsc {
namespace {

/// Open MPI looks for networks that a single machine does not need; that takes longer than many a
/// run (0.38 s against 0.07 s). What the user sets in the environment stands.
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
  set("OMPI_MCA_orte_create_session_dirs", "0");  // or runs at the same time share one folder
  set("OMPI_MCA_pml", "ob1");
  set("OMPI_MCA_btl", "self");
  set("OMPI_MCA_sharedfp", "^sm");  // it asks for the folder that is not made
}

}  // namespace

Session::Session(const std::vector<std::string>& options) {
  prepare_transport();
  // A reader that leaves (samara ... | head) is no crash: signals stay with the system.
  std::vector<std::string> words{"samara", "-no_signal_handler"};
  words.insert(words.end(), options.begin(), options.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  int argc = static_cast<int>(words.size());
  char** pointer = argv.data();
  if (SlepcInitialize(&argc, &pointer, nullptr, nullptr) != 0)
    throw InternalError("PETSc and SLEPc do not start");
  // Errors come back as codes and become exceptions; the default handler would print a page.
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
}

Session::~Session() {
  PetscPopErrorHandler();
  SlepcFinalize();
}

int Session::rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int Session::size() {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

std::string Session::unused_options() {
  PetscInt count = 0;
  char** names = nullptr;
  char** values = nullptr;
  check(PetscOptionsLeftGet(nullptr, &count, &names, &values));
  std::string text;
  for (PetscInt i = 0; i < count; ++i)
    text += std::string(text.empty() ? "-" : " -") + names[i];
  check(PetscOptionsLeftRestore(nullptr, &count, &names, &values));
  return text;
}

std::string library_versions() {
  char petsc[256];
  char slepc[256];
  char mpi[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  check(PetscGetVersion(petsc, sizeof petsc));
  check(SlepcGetVersion(slepc, sizeof slepc));
  MPI_Get_library_version(mpi, &length);
  const std::string whole(mpi, static_cast<std::size_t>(length));
  return std::string(petsc) + "\n" + slepc + "\n" + whole.substr(0, whole.find(','));
}

}  // namespace samara::petsc
