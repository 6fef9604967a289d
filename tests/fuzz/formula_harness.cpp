// Formulas of time: parsed, and evaluated before, at and after t = 0.
#include "samara/base/error.hpp"
#include "samara/math/time_curve.hpp"

#include "harness.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const samara::math::TimeCurve curve =
        samara::math::TimeCurve::formula(std::string(samara::fuzz::text_of(data, size)));
    for (const double t : {-1.0, 0.0, 1e-9, 0.5, 1e6}) curve.at(t);
  } catch (const samara::InputError&) {
  } catch (const samara::DomainError&) {
  }
  return 0;
}
