#include "samara/base/format.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace samara {
namespace {

std::string print(const char* format, int digits, double value) {
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(), format, digits, value);
  const std::string word(text.data());
  const bool is_zero = word.find_first_of("123456789ni") >= word.find('e');
  return is_zero && word[0] == '-' ? word.substr(1) : word;
}

}  // namespace

std::string fixed(double value, int digits) { return print("%.*f", digits, value); }

std::string scientific(double value, int digits) { return print("%.*e", digits, value); }

std::string general(double value, int digits) { return print("%.*g", digits, value); }

std::string count(int number, const std::string& noun) {
  return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
}

std::string ordinal(int number) {
  const int last = number % 10;
  const bool is_teen = number / 10 % 10 == 1;
  const char* ending = is_teen || last == 0 || last > 3 ? "th"
                       : last == 1                      ? "st"
                       : last == 2                      ? "nd"
                                                        : "rd";
  return std::to_string(number) + ending;
}

std::string shortest(double value) {
  constexpr double most_exact = 1e15;
  std::array<char, 32> text{};
  const bool is_whole = value == std::floor(value) && std::abs(value) < most_exact;
  const auto [end, error] = is_whole ? std::to_chars(text.data(), text.data() + text.size(), value,
                                                     std::chars_format::fixed)
                                     : std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

}  // namespace samara
