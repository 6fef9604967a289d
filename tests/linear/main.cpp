#define BOOST_TEST_MODULE samara_linear
#include <boost/test/unit_test.hpp>

#include "samara/petsc/session.hpp"

struct Start {
  samara::petsc::Session session{{}};
};
BOOST_TEST_GLOBAL_FIXTURE(Start);
