// Aligned tables for people.
#pragma once

#include <string>
#include <vector>

#include "samara/base/format.hpp"

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

}  // namespace samara::drivers
