#define BOOST_TEST_MODULE samara_elements
#include <boost/test/unit_test.hpp>
