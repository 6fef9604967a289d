#include "point_origin.hpp"

#include "samara/base/format.hpp"
#include "samara/base/version.hpp"
#include "samara/petsc/session.hpp"

namespace samara::drivers {
namespace {

constexpr int exact_digits = 17;

/// Of the files of points: files of another one are found again.
constexpr int point_format = 2;

}  // namespace

std::string point_origin(const std::string& case_text, const std::string& value) {
  return std::string("samara ") + version + ", points " + std::to_string(point_format) + "\n" +
         petsc::Session::options() + "\n" + value + "\n" + case_text;
}

std::string exact_words(const std::vector<double>& values) {
  std::string words;
  for (const double value : values) words += general(value, exact_digits) + " ";
  return words;
}

std::string row_words(const std::vector<simulation::ScheduledPoint>& table) {
  std::string words;
  for (const simulation::ScheduledPoint& row : table)
    words += exact_words({row.wind, row.speed, row.pitch});
  return words;
}

}  // namespace samara::drivers
