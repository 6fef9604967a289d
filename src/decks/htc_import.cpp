#include "htc_import.hpp"

#include <cmath>

#include "samara/base/number.hpp"

namespace samara::decks {

void HtcImport::use_all(const HtcBlock& block) {
  block.used = true;
  for (const HtcCommand& command : block.commands) command.used = true;
  for (const HtcBlock& part : block.blocks) use_all(part);
}

std::optional<double> HtcImport::number(const HtcCommand& command, std::size_t index) {
  if (index >= command.words.size()) {
    errors.add(command.place, command.name + ": expected at least " + std::to_string(index + 1) +
                                  " values, got " + std::to_string(command.words.size()));
    return {};
  }
  const std::optional<double> value = parse_number(command.words[index]);
  if (!value)
    errors.add(command.place,
               command.name + ": expected a number, got \"" + command.words[index] + "\"");
  return value;
}

std::optional<int> HtcImport::integer(const HtcCommand& command, std::size_t index, int low,
                                      int high) {
  const std::optional<double> value = number(command, index);
  if (!value) return {};
  if (!(*value >= low && *value <= high && *value == std::floor(*value))) {
    errors.add(command.place, command.name + ": expected an integer from " + std::to_string(low) +
                                  " to " + std::to_string(high) + ", got \"" +
                                  command.words[index] + "\"");
    return {};
  }
  return static_cast<int>(*value);
}

std::optional<std::vector<double>> HtcImport::numbers(const HtcCommand& command, std::size_t first,
                                                      std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<double> value = number(command, first + i);
    if (!value) return {};
    values.push_back(*value);
  }
  return values;
}

std::string HtcImport::word(const HtcCommand& command, std::size_t index, const std::string& what) {
  if (index < command.words.size()) return command.words[index];
  errors.add(command.place, command.name + ": " + what + " is missing");
  return {};
}

const HtcCommand* HtcImport::require(const HtcBlock& block, const std::string& name,
                                     const std::string& other) {
  const HtcCommand* command = block.find(name, other);
  if (command == nullptr)
    errors.add(block.place, "begin " + block.name + ": missing command \"" + name + "\"");
  return command;
}

}  // namespace samara::decks
