// HAWC2 decks: several files in one input, each behind a line `==== its name`; the first one is
// the main file.
#include "samara/base/error.hpp"
#include "samara/decks/import.hpp"
#include "samara/io/case.hpp"

#include "harness.hpp"

namespace {

constexpr std::string_view mark = "==== ";

/// Writes the files; returns the name of the first.
std::string write_deck(const samara::fuzz::Folder& folder, std::string_view text) {
  std::string first;
  while (text.starts_with(mark)) {
    const std::size_t line = std::min(text.find('\n'), text.size());
    const std::string name(text.substr(mark.size(), line - mark.size()));
    text.remove_prefix(std::min(line + 1, text.size()));
    const std::size_t next = text.starts_with(mark) ? 0 : text.find("\n" + std::string(mark));
    const std::size_t end = next == 0 ? 0 : next == std::string_view::npos ? text.size() : next + 1;
    if (name.size() < 100 && name.find('\0') == std::string::npos) {
      folder.write(name, text.substr(0, end));
      if (first.empty()) first = name;
    }
    text.remove_prefix(end);
  }
  return first;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const samara::fuzz::Folder folder;
  folder.clear();
  const std::string main = write_deck(folder, samara::fuzz::text_of(data, size));
  if (main.empty()) return 0;
  const bool tower_only = size % 2 == 0;
  try {
    const samara::decks::Import import =
        samara::decks::import_hawc2(folder / main, {.tower_only = tower_only});
    samara::io::parse_case("case.yaml", import.text, {});
  } catch (const samara::InputError&) {
  } catch (const samara::DomainError&) {
  }
  return 0;
}
