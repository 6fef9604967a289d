// Figures of docs/verification.md. A call asserts a figure, and the same call writes it down where
// the environment variable SAMARA_VERIFICATION names a folder, from which scripts/verify takes it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <boost/test/unit_test.hpp>

namespace samara::test {

/// Appends a line to a file of that folder: words in quotes, then numbers.
inline void record(const std::string& file, const std::vector<std::string>& words,
                   const std::vector<double>& numbers) {
  const char* folder = std::getenv("SAMARA_VERIFICATION");
  if (folder == nullptr) return;
  std::ofstream stream(std::filesystem::path(folder) / file, std::ios::app);
  for (const std::string& word : words) stream << std::quoted(word, '"', '"') << ',';
  stream << std::setprecision(12);
  for (std::size_t i = 0; i < numbers.size(); ++i) stream << (i == 0 ? "" : ",") << numbers[i];
  stream << '\n';
  BOOST_REQUIRE_MESSAGE(stream.flush(), "cannot write " << file << " to " << folder);
}

/// A number as in the title of a row: 0.4
inline std::string in_short(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

inline std::string mesh_name(int elements, int order) {
  return std::to_string(elements) + (elements == 1 ? " element" : " elements") + " of order " +
         std::to_string(order);
}

/// Figures of one case, from one source, found on one mesh.
struct Figures {
  std::string name;    ///< of the case: S1
  std::string source;  ///< of the references, in words
  std::string mesh;

  /// |found - reference| < tolerance
  void check_absolute(const std::string& quantity, double found, double reference,
                      double tolerance) const {
    check(quantity, "absolute", found, {reference, reference}, std::abs(found - reference),
          tolerance);
  }
  /// |found / reference - 1| < tolerance
  void check_relative(const std::string& quantity, double found, double reference,
                      double tolerance) const {
    check(quantity, "relative", found, {reference, reference}, std::abs(found / reference - 1.0),
          tolerance);
  }
  /// With two references: distance beyond the nearer one, relative to it; 0 between them.
  void check_spread(const std::string& quantity, double found, std::pair<double, double> references,
                    double tolerance) const {
    const auto [low, high] = std::minmax(references.first, references.second);
    const double beyond = std::max(1.0 - found / low, found / high - 1.0);
    check(quantity, "beyond", found, references, beyond < 0.0 ? 0.0 : beyond, tolerance);
  }

 private:
  void check(const std::string& quantity, const std::string& kind, double found,
             std::pair<double, double> references, double error, double tolerance) const {
    BOOST_TEST(error < tolerance, name << ", " << quantity << ": found " << found << ", reference "
                                       << references.first << ", " << kind << " error " << error
                                       << ", tolerance " << tolerance);
    record("figures.csv", {name, source, mesh, quantity, kind},
           {references.first, references.second, found, error, tolerance});
  }
};

/// Errors that follow a power of something: of the number of elements, of steps.
struct Convergence {
  std::string name;      ///< of the case: S1
  std::string quantity;  ///< whose error it is
  std::string abscissa;

  /// From each point (abscissa, error) to the next the slope is `exponent` to within `slack`.
  void check(const std::string& curve, double exponent, double slack,
             const std::vector<std::pair<double, double>>& points) const {
    BOOST_REQUIRE(points.size() > 1U);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto& [x, error] = points[i];
      if (i > 0) {
        const double slope =
            std::log(error / points[i - 1].second) / std::log(x / points[i - 1].first);
        BOOST_TEST(std::abs(slope - exponent) < slack,
                   name << ", " << quantity << ", " << curve << ": slope " << slope << " up to "
                        << x << " " << abscissa << ", errors " << points[i - 1].second << " "
                        << error);
      }
      record("convergence.csv", {name, quantity, abscissa, curve}, {exponent, x, error});
    }
  }
};

}  // namespace samara::test
