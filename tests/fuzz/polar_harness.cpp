// Polar files: read, and checked.
#include "samara/base/error.hpp"
#include "samara/io/polar_file.hpp"
#include "samara/model/airfoil.hpp"

#include "harness.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string text(samara::fuzz::text_of(data, size));
    for (const samara::model::PolarDefinition& polar : samara::io::parse_polars("polar", text))
      if (samara::model::find_polar_fault(polar).empty()) samara::model::find_polar_notes(polar);
  } catch (const samara::InputError&) {
  }
  return 0;
}
