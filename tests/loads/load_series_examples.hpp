// Common parts of the tests of loads.
#pragma once

#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"
#include "samara/loads/load_series.hpp"

namespace samara::test {

inline Eigen::VectorXd column(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// One channel, "load".
inline loads::LoadSeries one_channel(const Eigen::VectorXd& times, const Eigen::VectorXd& values) {
  return {{"load"}, times, values, 0.0};
}

/// `call` throws an InputError whose message has `part` in it.
template <class Call>
void check_refused(const Call& call, const std::string& part) {
  BOOST_CHECK_EXCEPTION(call(), InputError, [&part](const InputError& error) {
    BOOST_TEST_INFO(error.what());
    return std::string(error.what()).find(part) != std::string::npos;
  });
}

}  // namespace samara::test
