// Aligned tables for the terminal.
#pragma once

#include <string>
#include <vector>

#include "samara/base/format.hpp"

namespace samara::drivers {

enum class Align { left, right };

/// Rows of words below a head of names and units, if there are any.
class Table {
 public:
  void add_column(const std::string& name, const std::string& unit, Align align = Align::right);
  /// One word per column.
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
