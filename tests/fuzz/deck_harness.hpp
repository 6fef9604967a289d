// Harnesses of decks.
#pragma once

#include "samara/base/error.hpp"
#include "samara/decks/import.hpp"
#include "samara/io/case.hpp"

#include "harness.hpp"

namespace samara::fuzz {

/// Imports the deck of an input with `import`, and reads the case. Returns 0.
inline int import_input(const std::uint8_t* data, std::size_t size,
                        decks::Import (*import)(const std::string&, const decks::ImportOptions&)) {
  static const Folder folder;
  folder.clear();
  const std::string main = write_deck(folder, text_of(data, size));
  if (main.empty()) return 0;
  const bool tower_only = size % 2 == 0;
  try {
    io::parse_case("case.yaml", import(folder / main, {.tower_only = tower_only}).text, {});
  } catch (const InputError&) {
  } catch (const DomainError&) {
  }
  return 0;
}

}  // namespace samara::fuzz
