#define BOOST_TEST_MODULE samara_model
#include <boost/test/unit_test.hpp>
