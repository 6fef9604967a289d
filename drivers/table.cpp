#include "table.hpp"

#include <algorithm>

namespace samara::drivers {
namespace {

/// Columns on the screen. Bytes that continue a UTF-8 character take none.
std::size_t width_of(const std::string& word) {
  return static_cast<std::size_t>(std::count_if(word.begin(), word.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  }));
}

}  // namespace

void Table::add_column(const std::string& name, const std::string& unit, Align align) {
  columns_.push_back({name, unit, align});
}

void Table::add_row(const std::vector<std::string>& words) { rows_.push_back(words); }

std::string Table::text() const {
  std::vector<std::vector<std::string>> lines(2);
  for (const Column& column : columns_) {
    lines[0].push_back(column.name);
    lines[1].push_back(column.unit.empty() ? "" : "[" + column.unit + "]");
  }
  const bool has_units = std::any_of(columns_.begin(), columns_.end(),
                                     [](const Column& column) { return !column.unit.empty(); });
  if (!has_units) lines.pop_back();
  lines.insert(lines.end(), rows_.begin(), rows_.end());
  std::vector<std::size_t> widths(columns_.size(), 0);
  for (const auto& line : lines)
    for (std::size_t i = 0; i < columns_.size(); ++i)
      widths[i] = std::max(widths[i], width_of(line[i]));
  std::string text;
  for (const auto& line : lines) {
    std::string row;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const std::string gap(widths[i] - width_of(line[i]), ' ');
      if (i > 0) row += "  ";
      row += columns_[i].align == Align::left ? line[i] + gap : gap + line[i];
    }
    text += row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace samara::drivers
