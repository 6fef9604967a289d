// windIO turbines: imported, and the case read that came of them.
#include "samara/base/error.hpp"
#include "samara/decks/import.hpp"
#include "samara/io/case.hpp"

#include "harness.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const samara::fuzz::Folder folder;
  folder.write("turbine.yaml", samara::fuzz::text_of(data, size));
  const bool tower_only = size % 2 == 0;
  try {
    const samara::decks::Import import =
        samara::decks::import_windio(folder / "turbine.yaml", {.tower_only = tower_only});
    samara::io::parse_case("case.yaml", import.text, {});
  } catch (const samara::InputError&) {
  } catch (const samara::DomainError&) {
  }
  return 0;
}
