// How the frequencies of a turbine settle as its mesh is refined.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "cases.hpp"
#include "record.hpp"

namespace samara::test {

/// Frequencies, ascending, on the mesh that the settings make.
using FrequenciesOn = std::function<std::vector<double>(const std::vector<std::string>&)>;

/// The largest relative error of the first eight frequencies falls with the power 2 s of the number
/// of elements in tower and blades, against a mesh whose own error is less than a tenth of the
/// least. Tables of sections are linear between stations, which meshes meet here and there: the
/// slope wanders about 2 s, the more the higher the order.
inline void check_mesh_study(const std::string& name, const FrequenciesOn& frequencies_on) {
  constexpr std::size_t modes = 8;
  const std::vector<double> fine = frequencies_on(mesh(true, 20, 3));
  BOOST_REQUIRE(fine.size() >= modes);
  const Convergence page{name, "largest of the first eight frequencies, relative", "elements"};
  for (const auto& [order, slack, first] : {std::tuple{1, 0.4, 8}, std::tuple{2, 1.0, 4}}) {
    std::vector<std::pair<double, double>> errors;
    for (const int elements : {first, 2 * first, 4 * first}) {
      const std::vector<double> found = frequencies_on(mesh(true, elements, order));
      BOOST_REQUIRE(found.size() >= modes);
      double worst = 0.0;
      for (std::size_t i = 0; i < modes; ++i)
        worst = std::max(worst, std::abs(found[i] / fine[i] - 1.0));
      errors.emplace_back(elements, worst);
    }
    page.check("order " + std::to_string(order), -2.0 * order, slack, errors);
  }
}

}  // namespace samara::test
