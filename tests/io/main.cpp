#define BOOST_TEST_MODULE samara_io
#include <boost/test/unit_test.hpp>
