#include "samara/simulation/steady_state.hpp"

#include <algorithm>
#include <cmath>

#include "samara/base/format.hpp"

namespace samara::simulation {
namespace {

/// Of the largest load: loads out of balance by more make a steady state rough.
constexpr double rough_imbalance = 1e-4;

}  // namespace

analysis::Trim find_trim(const Scenario& scenario, const turbine::TurbineSystem& system,
                         analysis::Observer& observer) {
  analysis::Trim trim = analysis::find_trim(system, trim_options(scenario), observer);
  note_roughness(trim, observer);
  return trim;
}

std::string roughness(const analysis::Trim& trim) {
  if (trim.imbalance() <= rough_imbalance) return "";
  const std::string part = general(trim.imbalance(), 2) + " of the largest load";
  const std::string bound = " (more than " + general(rough_imbalance, 1) + ")";
  if (trim.method == analysis::TrimMethod::shooting)
    return "loads are out of balance by " + part + bound + "; hint: more trim.steps";
  if (std::isnan(trim.harmonic_residual))
    return "loads are out of balance by " + part + bound +
           "; hint: more trim.harmonics, or a smaller trim.tolerance";
  const bool is_newton =
      trim.harmonic_residual > 0.5 * std::max(trim.residual, trim.residual_between);
  return "loads are out of balance by " + part + bound +
         (is_newton ? "; hint: a smaller trim.tolerance" : "; hint: more trim.harmonics");
}

void note_roughness(const analysis::Trim& trim, analysis::Observer& observer,
                    const std::string& source) {
  const std::string words = roughness(trim);
  if (!words.empty()) observer.note(source + ": the steady state is rough: " + words);
}

}  // namespace samara::simulation
