// The text of decks, their files, and the faults that are found in them.
#pragma once

#include <cstddef>
#include <string>
#include <unordered_set>
#include <vector>

namespace samara::decks {

/// Faults of a deck of several files, in the order found.
class DeckErrors {
 public:
  void add(const std::string& place, const std::string& what);
  /// Adds a complete message.
  void add_message(const std::string& message);
  bool empty() const { return messages_.empty(); }
  std::size_t size() const { return messages_.size(); }
  const std::string& first() const { return messages_.front(); }
  /// @throws InputError with one error a line, if there are any.
  void throw_if_any() const;

 private:
  std::vector<std::string> messages_;
  std::unordered_set<std::string> known_;  ///< the same messages
};

/// The text of a file of at most 64 MB, without a byte order mark.
/// @throws InputError where the file cannot be read or is no text
std::string read_deck_text(const std::string& path);

/// Whether the last line has an end. Otherwise the file may have been cut off.
bool ends_with_line(const std::string& text);

/// The path whose names differ from this one by upper and lower case alone; empty where there is
/// none.
std::string find_in_other_case(const std::string& path);

}  // namespace samara::decks
