// A torque of the generator that is given as a function of time.
#pragma once

#include <functional>

#include "samara/turbine/extension.hpp"

namespace samara::turbine {

/// Acts on a free generator against its turning, beside its other laws. A lost generator has no
/// such torque.
class TorqueInTime final : public Extension {
 public:
  /// `torque`: behind the gear [N m], over the time [s].
  explicit TorqueInTime(std::function<double(double)> torque);

  std::unique_ptr<components::Component> make(const model::Turbine& turbine,
                                              const TurbineLayout& layout) const override;
  bool keeps_rotor_symmetry() const override { return true; }

 private:
  std::function<double(double)> torque_;
};

}  // namespace samara::turbine
