// HAWC2 decks.
#include "deck_harness.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return samara::fuzz::import_input(data, size, samara::decks::import_hawc2);
}
