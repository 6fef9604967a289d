// Which loads a command can take.
#include "samara/base/error.hpp"

#include "commands.hpp"

namespace samara::drivers {

void require_repeating_loads(const io::Case& input) {
  const analysis::TrimOptions& trim = input.trim;
  const bool truncates = input.turbine.shaft.speed > 0.0 && !trim.automatic &&
                         trim.method == analysis::TrimMethod::harmonic_balance;
  for (std::size_t i = 0; i < input.turbine.loads.size(); ++i) {
    const model::LoadHistory& history = input.turbine.loads[i].history;
    const std::string place = input.path + ": loads[" + std::to_string(i) + "]";
    if (!history.is_constant() && (!history.table.empty() || history.per_rev == 0))
      throw InputError(place +
                       " does not repeat with the rotor; hint: harmonic: {per_rev: ...}, or samara "
                       "static, which takes the loads at t = 0");
    if (truncates && history.per_rev > trim.harmonics)
      throw InputError(place + ".harmonic.per_rev is " + std::to_string(history.per_rev) +
                       ", more than trim.harmonics; hint: --set trim.harmonics=" +
                       std::to_string(history.per_rev));
  }
}

}  // namespace samara::drivers
