// Numbers as text for the user.
#pragma once

#include <string>

namespace samara {

/// "12.300"; a value that rounds to zero has no sign.
std::string fixed(double value, int digits);

/// "1.23e-04" with the given digits behind the point.
std::string scientific(double value, int digits);

/// The shortest of both forms with the given significant digits: "67.58", "1.2e+07".
std::string general(double value, int digits);

/// "1 mode", "3 modes".
std::string count(int number, const std::string& noun);

/// "1st", "2nd", "3rd", "11th".
std::string ordinal(int number);

/// The shortest text of a number that reads as the same; a whole number has no exponent.
std::string shortest(double value);

}  // namespace samara
