#define BOOST_TEST_MODULE samara_decks
#include <boost/test/unit_test.hpp>
