#include "samara/io/result_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "samara/base/error.hpp"
#include "samara/io/result_file.hpp"

#include "hdf5_reader.hpp"
#include "held_loads.hpp"

namespace samara::io {
namespace {

constexpr std::string_view setting_start = "# --set ";

/// Removes `count` settings from the top of a case's text (all if `count` is negative) and returns
/// them.
std::vector<std::string> take_settings(std::string& text, long count) {
  std::vector<std::string> settings;
  while (text.starts_with(setting_start) && static_cast<long>(settings.size()) != count) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    settings.push_back(text.substr(setting_start.size(), end - setting_start.size()));
    text.erase(0, end + 1);
  }
  return settings;
}

}  // namespace

ResultKind find_result_kind(const std::string& path) {
  const Hdf5Reader file = Hdf5Reader(require_result(path));
  if (file.has("/transient/time")) return ResultKind::time_series;
  return file.has("/trim/harmonics") ? ResultKind::steady_state : ResultKind::other;
}

Case read_result_case(const std::string& path) {
  const Hdf5Reader file = Hdf5Reader(require_result(path));
  std::string text = file.text("/case");
  // A case may begin with such a comment of its own, so the result also has the number of settings.
  long count = -1;
  if (file.has_attribute("/case", "settings"))
    count = static_cast<long>(file.count_attribute("/case", "settings"));
  const std::vector<std::string> settings = take_settings(text, count);
  Case result = parse_case(path + ":/case", text, settings);
  result.path = file.text_attribute("/", "case_path");
  return result;
}

analysis::Trim read_result_trim(const std::string& path) {
  const Hdf5Reader file = Hdf5Reader(require_result(path));
  hsize_t rows = 0;
  hsize_t columns = 0;
  const std::vector<double> numbers = file.table("/trim/harmonics", rows, columns);
  if (columns % 2 == 0)
    throw InputError(path + ": /trim/harmonics is not [unknown, mean, cos 1, sin 1, ...]");
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const RowMajor> coefficients(numbers.data(), static_cast<Eigen::Index>(rows),
                                                static_cast<Eigen::Index>(columns));
  const double period = file.number("/model/period");
  if (!coefficients.allFinite() || !std::isfinite(period) || period < 0.0)
    throw InputError(path + ": its steady state has values that are no numbers");
  analysis::Trim trim{{coefficients, period}};
  trim.held = read_held_loads(file, "/trim");
  const std::vector<double> residual = file.numbers("/trim/residual");
  if (residual.size() != 2) throw InputError(path + ": /trim/residual does not have two values");
  trim.residual = residual[0];
  trim.residual_between = residual[1];
  trim.load_level = file.number("/trim/load_level");
  // Older results lack these values.
  const auto number_or = [&file](const char* name, double otherwise) {
    return file.has(name) ? file.number(name) : otherwise;
  };
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  trim.harmonic_residual = number_or("/trim/harmonic_residual", unknown);
  trim.state_residual = number_or("/trim/state_residual", 0.0);
  trim.medium_residual = number_or("/trim/medium_residual", 0.0);
  if (file.text_attribute("/trim", "method") == "shooting")
    trim.method = analysis::TrimMethod::shooting;
  return trim;
}

void place_held(const system::PeriodicSystem& system, std::vector<analysis::HeldCoordinate>& held) {
  for (analysis::HeldCoordinate& one : held)
    for (const system::UnconstrainedCoordinate& unconstrained : system.unconstrained_coordinates())
      if (unconstrained.name == one.name) one.unknown = unconstrained.unknown;
}

}  // namespace samara::io
