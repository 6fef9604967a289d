#include "samara/base/number.hpp"

#include <charconv>
#include <cmath>

namespace samara {

std::optional<double> parse_number(const std::string& word) {
  std::string text = word;
  for (char& c : text)
    if (c == 'd' || c == 'D') c = 'e';
  const char* first = text.data();
  const char* last = first + text.size();
  if (first != last && *first == '+') {
    ++first;
    if (first != last && *first == '-') return {};
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(first, last, value);
  if (error != std::errc{} || end != last || !std::isfinite(value)) return {};
  return value;
}

}  // namespace samara
