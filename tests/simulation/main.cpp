#define BOOST_TEST_MODULE samara_simulation
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/petsc/session.hpp"

namespace {

/// PETSc for the length of the program.
struct PetscFixture {
  samara::petsc::Session session{std::vector<std::string>{}};
};

}  // namespace

BOOST_TEST_GLOBAL_FIXTURE(PetscFixture);
