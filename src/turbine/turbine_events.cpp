#include "samara/turbine/turbine_events.hpp"

namespace samara::turbine {

model::Turbine apply_event(const model::Turbine& turbine, const TurbineEvent& event, double t) {
  model::Turbine changed = turbine;
  if (event.pitch) {
    changed.operation.pitch.resize(turbine.blades.size());
    for (std::size_t k = 0; k < turbine.blades.size(); ++k) {
      if (event.pitch->blade != 0 && event.pitch->blade != static_cast<int>(k) + 1) continue;
      changed.operation.pitch[k] = math::TimeCurve::ramp(t, turbine.pitch_at(k, t).value,
                                                         event.pitch->to, event.pitch->rate);
    }
  }
  if (event.generator_off) {
    changed.chain.generator_torque = {};
    changed.operation.generator_off = true;
  }
  changed.chain.brake_torque += event.brake;
  return changed;
}

}  // namespace samara::turbine
