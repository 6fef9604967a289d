// Case files: read, and the turbine built where it is of usual size.
#include "samara/base/error.hpp"
#include "samara/io/case.hpp"
#include "samara/model/turbine.hpp"

#include "harness.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const samara::io::Case input =
        samara::io::parse_case("case.yaml", std::string(samara::fuzz::text_of(data, size)), {});
    samara::model::build_turbine(input.turbine);
  } catch (const samara::InputError&) {
  } catch (const samara::DomainError&) {
  }
  return 0;
}
