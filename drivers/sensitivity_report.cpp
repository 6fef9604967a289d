#include "sensitivity_report.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <set>
#include <sstream>

#include "samara/base/error.hpp"
#include "samara/io/case_numbers.hpp"
#include "samara/io/schema.hpp"

#include "table.hpp"

namespace samara::drivers {
namespace {

using Complex = std::complex<double>;
using simulation::Parameter;
using simulation::Sensitivity;

/// Change of a number to which those of the modes in the tables belong.
constexpr double relative_change = 0.01;

constexpr double two_pi = 2.0 * std::numbers::pi;

/// A change of an exponent, with the estimate of its error.
struct Change {
  Complex value;
  double error = 0.0;
  std::size_t largest = 0;  ///< number with the largest part
  double part = 0.0;        ///< modulus of this part
};

bool is_zero(const ParameterGroup& group) {
  return std::ranges::all_of(group.parameters,
                             [](const Parameter& parameter) { return parameter.value == 0.0; });
}

/// Of the exponent of mode m.
Change change_of(const ParameterGroup& group, const std::vector<Sensitivity>& found,
                 std::size_t m) {
  const bool is_absolute = is_zero(group);
  Change change;
  for (std::size_t i = 0; i < group.parameters.size(); ++i) {
    const double step = is_absolute ? 1.0 : relative_change * group.parameters[i].value;
    if (step == 0.0) continue;
    const Complex own = step * found[i].rates[m];
    change.value += own;
    change.error += std::abs(step) * found[i].errors[m];
    if (std::abs(own) <= change.part) continue;
    change.part = std::abs(own);
    change.largest = i;
  }
  return change;
}

/// Change of -Re / abs of an exponent.
double damping_change(Complex exponent, Complex change) {
  const double size = std::abs(exponent);
  const double growth = exponent.real();
  return -change.real() / size +
         growth * (exponent.real() * change.real() + exponent.imag() * change.imag()) /
             (size * size * size);
}

/// A number with the digits that its error leaves, four at most; `scale`: of what it changes.
std::string known(double value, double error, double scale) {
  constexpr int most_digits = 4;
  constexpr double nothing = 1e-7;
  if (!std::isfinite(value)) return "-";
  if (std::max(std::abs(value), error) < nothing * scale) return "0";
  if (!(error < std::abs(value))) return "0 +- " + general(error, 1);
  const double ratio = std::abs(value) / std::max(error, 1e-300);
  const int digits = std::clamp(static_cast<int>(std::floor(std::log10(ratio))), 1, most_digits);
  return general(value, digits);
}

}  // namespace

std::vector<ParameterGroup> find_parameters(const Job& job) {
  std::vector<ParameterGroup> groups;
  std::set<std::string> keys;
  std::istringstream patterns(job.sensitivity);
  for (std::string pattern; std::getline(patterns, pattern, ',');) {
    ParameterGroup group{pattern, {}};
    const std::vector<io::CaseNumber> numbers =
        at_place("--sensitivity", [&] { return io::find_numbers(job.input, pattern); });
    for (const io::CaseNumber& number : numbers) {
      if (!keys.insert(number.key).second)
        throw InputError("--sensitivity: " + number.key +
                         " is named twice; hint: patterns that have no key in common");
      group.parameters.push_back({number.key, number.value, io::unit_of_key(number.key)});
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

std::string sensitivity_tables(const analysis::ModeSet& set, const Sensitivities& sensitivities) {
  std::string text;
  for (std::size_t g = 0; g < sensitivities.groups.size(); ++g) {
    const ParameterGroup& group = sensitivities.groups[g];
    const bool is_one = group.parameters.size() == 1;
    const bool is_absolute = is_zero(group);
    Table table;
    table.add_column("#", "");
    table.add_column("mode", "", Align::left);
    table.add_column("frequency", "Hz");
    table.add_column("change", "Hz");
    table.add_column("damping", "%");
    table.add_column("change", "%");
    table.add_column("growth", "1/s");
    table.add_column("change", "1/s");
    if (!is_one) table.add_column("largest part", "", Align::left);
    for (std::size_t i = 0; i < sensitivities.modes.size(); ++i) {
      const std::size_t m = sensitivities.modes[i];
      const analysis::Mode& mode = set.modes[m];
      const Change change = change_of(group, sensitivities.found[g], i);
      const double size = std::abs(mode.exponent);
      std::vector<std::string> words{
          std::to_string(m + 1),
          mode.label,
          fixed(mode.exponent.imag() / two_pi, 5),
          known(change.value.imag() / two_pi, change.error / two_pi, size / two_pi),
          fixed(100.0 * mode.damping_ratio, 4),
          known(100.0 * damping_change(mode.exponent, change.value), 100.0 * change.error / size,
                100.0),
          scientific(mode.exponent.real(), 2),
          known(change.value.real(), change.error, size)};
      if (!is_one)
        words.push_back(std::isfinite(change.part) && change.part > 0.0
                            ? group.parameters[change.largest].key
                            : "-");
      table.add_row(words);
    }
    const std::string numbers =
        is_one
            ? group.parameters.front().key + " = " + general(group.parameters.front().value, 6) +
                  (group.parameters.front().unit == "1" ? "" : " " + group.parameters.front().unit)
            : group.pattern + ", " + count(static_cast<int>(group.parameters.size()), "number") +
                  " together";
    text += "\nsensitivity to " + numbers + ", " +
            (is_absolute ? "per unit" : "for an increase of 1 %") + "\n\n" + table.text();
  }
  return text + "- : at rest, one of equal exponents, or not found by Hill's method\n";
}

void write_sensitivities(io::ResultFile& file, const analysis::ModeSet& set,
                         const Sensitivities& sensitivities) {
  std::vector<std::string> keys;
  std::vector<std::string> units;
  std::vector<double> values;
  for (const ParameterGroup& group : sensitivities.groups)
    for (const Parameter& parameter : group.parameters) {
      keys.push_back(parameter.key);
      units.push_back(parameter.unit);
      values.push_back(parameter.value);
    }
  const std::size_t count = keys.size();
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> rates(set.modes.size() * count * 2, none);
  std::vector<double> errors(set.modes.size() * count, none);
  std::size_t column = 0;
  for (const std::vector<Sensitivity>& group : sensitivities.found)
    for (const Sensitivity& one : group) {
      for (std::size_t i = 0; i < sensitivities.modes.size(); ++i) {
        const std::size_t at = sensitivities.modes[i] * count + column;
        rates[2 * at] = one.rates[i].real();
        rates[2 * at + 1] = one.rates[i].imag();
        errors[at] = one.errors[i];
      }
      ++column;
    }
  const std::string group = "/floquet/sensitivity";
  file.write_texts(group + "/key", keys,
                   {"", "none", "numbers of the case, as --set takes them", {"key"}});
  file.write_texts(group + "/unit", units, {"", "none", "their units", {"key"}});
  file.write_values(group + "/value", values, {"see unit", "none", "their values", {"key"}});
  file.write_array(group + "/exponent_rate", rates, {set.modes.size(), count, 2},
                   {"rad/s per unit of the key",
                    "as /floquet/exponents",
                    "derivatives of the exponents, the change of the steady state included; "
                    "not-a-number where there is none",
                    {"mode", "key", "re_im"}});
  file.write_array(group + "/error", errors, {set.modes.size(), count},
                   {"rad/s per unit of the key",
                    "none",
                    "estimated error of the modulus of a derivative",
                    {"mode", "key"}});
}

}  // namespace samara::drivers
