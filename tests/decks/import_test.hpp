// Common parts of the importers' tests: decks, folders, independent integrals.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"
#include "samara/decks/import.hpp"
#include "samara/io/case.hpp"

#include "../io/folder.hpp"

namespace samara::test {

namespace fs = std::filesystem;

inline const fs::path deck_files = fs::path(SAMARA_SOURCE_DIR) / "tests/decks/files";

inline std::string read_file(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A copy of a folder of decks, which goes with the test.
struct DeckFolder {
  Folder around;
  fs::path path;
  explicit DeckFolder(const std::string& name) : path(around.path / name) {
    fs::copy(deck_files / name, path, fs::copy_options::recursive);
  }

  std::string text(const std::string& file) const { return read_file(path / file); }
  void write(const std::string& file, const std::string& content) const {
    std::ofstream(path / file, std::ios::binary) << content;
  }
  void replace(const std::string& file, const std::string& from, const std::string& to) const {
    std::string content = text(file);
    const std::size_t place = content.find(from);
    BOOST_REQUIRE_MESSAGE(place != std::string::npos, from);
    write(file, content.replace(place, from.size(), to));
  }
  std::string operator/(const std::string& file) const { return (path / file).string(); }
};

inline io::Case parse(const decks::Import& import) {
  return io::parse_case("case.yaml", import.text, {});
}

/// The message of the InputError that the work ends with; the test fails where it does not.
template <class Work>
std::string message_of(const Work& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  BOOST_ERROR("nothing was refused");
  return {};
}

inline bool holds(const std::string& text, const std::string& word) {
  return text.find(word) != std::string::npos;
}

/// Integrals over the length of f, x f and x^2 f, with f linear between its points: closed form.
struct Moments {
  double zeroth = 0.0;
  double first = 0.0;
  double second = 0.0;
};

inline Moments integrate(const std::vector<double>& at, const std::vector<double>& f,
                         double length) {
  Moments m;
  for (std::size_t i = 1; i < at.size(); ++i) {
    const double a = at[i - 1] * length;
    const double h = at[i] * length - a;
    const double p = f[i - 1];
    const double q = f[i] - p;  // f = p + q s, x = a + h s
    m.zeroth += h * (p + q / 2.0);
    m.first += h * (a * (p + q / 2.0) + h * (p / 2.0 + q / 3.0));
    m.second += h * (a * a * (p + q / 2.0) + 2.0 * a * h * (p / 2.0 + q / 3.0) +
                     h * h * (p / 3.0 + q / 4.0));
  }
  return m;
}

/// The same of an entry of the mass matrices of a beam of a case.
inline Moments integrate(const model::BeamDefinition& beam, int row, int column) {
  std::vector<double> at;
  std::vector<double> f;
  for (const model::SectionDefinition& section : beam.sections) {
    at.push_back(section.at);
    f.push_back(section.mass(row, column));
  }
  return integrate(at, f, beam.length);
}

/// Masses and moments survive an import to this, relative.
constexpr double mass_tolerance = 1e-10;

inline void require_same(const Moments& a, const Moments& b, double scale = 1.0) {
  const double limit = mass_tolerance * scale;
  BOOST_TEST(std::abs(a.zeroth - b.zeroth) <= limit * std::abs(b.zeroth));
  BOOST_TEST(std::abs(a.first - b.first) <= limit * std::abs(b.first));
  BOOST_TEST(std::abs(a.second - b.second) <= limit * std::abs(b.second));
}

}  // namespace samara::test
