#include "deck_text.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "samara/base/error.hpp"
#include "samara/base/words.hpp"
#include "samara/io/whole_file.hpp"

namespace samara::decks {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_megabytes = 64;

/// Largest number of errors of a deck that are shown.
constexpr std::size_t most_shown = 100;

}  // namespace

std::string read_deck_text(const std::string& path) {
  std::string text = io::read_whole_file(path, max_megabytes, "deck");
  if (text.find('\0') != std::string::npos)
    throw InputError(path + ": not a plain text file; hint: UTF-16 must be saved as UTF-8");
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  return text;
}

bool ends_with_line(const std::string& text) {
  return text.empty() || text.back() == '\n' || text.back() == '\r';
}

std::string find_in_other_case(const std::string& path) {
  fs::path found;
  for (const fs::path& part : fs::path(path)) {
    std::error_code error;
    if (fs::exists(found / part, error)) {
      found /= part;
      continue;
    }
    std::string match;
    for (fs::directory_iterator entry(found.empty() ? fs::path(".") : found, error), end;
         !error && entry != end; entry.increment(error)) {
      const std::string name = entry->path().filename().string();
      const auto same = [](char a, char b) { return to_lower(a) == to_lower(b); };
      if (std::equal(name.begin(), name.end(), part.native().begin(), part.native().end(), same))
        match = name;
    }
    if (match.empty()) return "";
    found /= match;
  }
  return found.string();
}

void DeckErrors::add(const std::string& place, const std::string& what) {
  add_message(place + ": " + what);
}

void DeckErrors::add_message(const std::string& message) {
  if (known_.insert(message).second) messages_.push_back(message);
}

void DeckErrors::throw_if_any() const {
  if (messages_.empty()) return;
  std::string text;
  const std::size_t shown = std::min(messages_.size(), most_shown);
  for (std::size_t i = 0; i < shown; ++i) text += (i == 0 ? "" : "\n") + messages_[i];
  if (messages_.size() > shown)
    text += "\nand " + std::to_string(messages_.size() - shown) + " more errors";
  throw InputError(text);
}

}  // namespace samara::decks
