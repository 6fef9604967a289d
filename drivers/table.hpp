// Aligned tables and clean numbers for people.
#pragma once

#include <string>
#include <vector>

namespace samara::drivers {

enum class Align { left, right };

/// Rows of words under a head of names and, where there are any, units.
class Table {
 public:
  void add_column(const std::string& name, const std::string& unit, Align align = Align::right);
  /// One word a column.
  void add_row(const std::vector<std::string>& words);
  std::string text() const;

 private:
  struct Column {
    std::string name;
    std::string unit;
    Align align;
  };
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// "12.300"; what rounds to zero has no sign.
std::string fixed(double value, int digits);

/// "1.23e-04" with the given digits behind the point.
std::string scientific(double value, int digits);

/// The shortest of both forms with the given significant digits: "67.58", "1.2e+07".
std::string general(double value, int digits);

/// "1 mode", "3 modes".
std::string count(int number, const std::string& noun);

}  // namespace samara::drivers
