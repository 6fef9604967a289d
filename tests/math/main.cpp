#define BOOST_TEST_MODULE samara_math
#include <boost/test/unit_test.hpp>
