// A key of the case file: its unit, its range, its meaning.
#pragma once

#include <limits>
#include <numbers>
#include <string_view>

namespace samara::fields {

/// The unit in which a file states a quantity; memory has SI and radians.
struct Unit {
  const char* name = "";  ///< as documents print it
  double factor = 1.0;    ///< SI = value factor / divisor
  double divisor = 1.0;

  constexpr explicit Unit(const char* unit_name, double by = 1.0, double over = 1.0)
      : name(unit_name), factor(by), divisor(over) {}

  constexpr double to_si(double value) const { return value * factor / divisor; }
  constexpr double from_si(double value) const { return value * divisor / factor; }
};

inline constexpr Unit deg{"deg", std::numbers::pi, 180.0};
inline constexpr Unit deg_per_s{"deg/s", std::numbers::pi, 180.0};
inline constexpr Unit rpm{"rev/min", 2.0 * std::numbers::pi, 60.0};

/// Which numbers are accepted, in the unit of the file, and how to say so.
struct Range {
  const char* words = "a finite number";
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool open = false;  ///< the limits themselves are refused
};

inline constexpr Range any_number{};
inline constexpr Range positive{"a number > 0", 0.0, std::numeric_limits<double>::infinity(), true};
inline constexpr Range non_negative{"a number >= 0", 0.0};
/// Beyond it nothing converges; below it round-off decides.
inline constexpr Range tolerance{"a number from 1e-14 to 1e-3", 1e-14, 1e-3};
inline constexpr Range fraction_of_one{"a number from 0 to 1", 0.0, 1.0};
inline constexpr Range beyond_the_root{"a number above 0, to 1", std::numeric_limits<double>::min(),
                                       1.0};
inline constexpr Range quarter_turn{"an angle between -90 and 90 degrees", -90.0, 90.0, true};
inline constexpr Range half_turn{"an angle from -180 to 180 degrees", -180.0, 180.0};

constexpr Range integers(int low, int high) {
  return {"an integer", static_cast<double>(low), static_cast<double>(high)};
}

/// Sizes of numbers, in SI units: beyond them squares and products leave what a double holds.
inline constexpr double largest_number = 1e30;
inline constexpr double least_number = 1e-30;

struct Field {
  std::string_view key;
  Unit unit;
  Range range;
  std::string_view text;           ///< its meaning, beside what the range says
  std::string_view fallback = {};  ///< words for the default, where the value does not tell it
  bool has_fallback = false;       ///< those words count, if they are empty too
  std::string_view hint = {};      ///< for whoever leaves out a compulsory key
  bool is_compulsory = false;
  bool zero_is_none = false;      ///< the value 0 stands for a key that is left out
  bool infinity_is_none = false;  ///< so does an infinite one

  constexpr Field(std::string_view name, const Unit& in, const Range& accepted,
                  std::string_view meaning)
      : key(name), unit(in), range(accepted), text(meaning) {}
  constexpr Field(std::string_view name, const char* in, const Range& accepted,
                  std::string_view meaning)
      : Field(name, Unit(in), accepted, meaning) {}
  constexpr Field(std::string_view name, const Unit& in, std::string_view meaning)
      : Field(name, in, any_number, meaning) {}
  constexpr Field(std::string_view name, const char* in, std::string_view meaning)
      : Field(name, Unit(in), any_number, meaning) {}
  constexpr Field(std::string_view name, std::string_view meaning) : Field(name, "", meaning) {}

  /// Compulsory, or not.
  constexpr Field required(std::string_view why = {}, bool is = true) const {
    Field field = *this;
    field.is_compulsory = is;
    field.hint = why;
    return field;
  }
  constexpr Field or_else(std::string_view words) const {
    Field field = *this;
    field.fallback = words;
    field.has_fallback = true;
    return field;
  }
  /// Left out where it is 0, or infinite.
  constexpr Field none_at_zero(std::string_view words = "none") const {
    Field field = or_else(words);
    field.zero_is_none = true;
    return field;
  }
  constexpr Field none_at_infinity(std::string_view words = "none") const {
    Field field = or_else(words);
    field.infinity_is_none = true;
    return field;
  }
};

}  // namespace samara::fields
