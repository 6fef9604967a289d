#define BOOST_TEST_MODULE samara_loads
#include <boost/test/unit_test.hpp>
