#include "samara/petsc/session.hpp"

#include <cstdlib>
#include <string>

#include "samara/base/error.hpp"
#include "samara/petsc/handle.hpp"

namespace samara::petsc {
namespace {

/// Without a launcher there is nobody to talk to: the transports that Open MPI would look for cost
/// more time than many a run.
void prepare_single_process() {
  if (std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMIX_RANK") != nullptr ||
      std::getenv("PMI_RANK") != nullptr || std::getenv("SLURM_PROCID") != nullptr)
    return;
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  setenv("OMPI_MCA_btl", "self", 0);
  setenv("OMPI_MCA_pml", "ob1", 0);
}

}  // namespace

Session::Session(const std::vector<std::string>& options) {
  prepare_single_process();
  std::vector<std::string> words{"samara"};
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
