// Components that a program adds to a turbine.
#pragma once

#include <memory>

#include "samara/components/component.hpp"
#include "samara/model/turbine.hpp"
#include "samara/turbine/turbine_layout.hpp"

namespace samara::turbine {

/// Makes an added component. It is called each time that equations are made of the turbine: for
/// each leg of a transient and on each rank. Member of `model::TurbineDefinition::extensions`.
class Extension {
 public:
  Extension() = default;
  Extension(const Extension&) = delete;
  Extension& operator=(const Extension&) = delete;
  virtual ~Extension() = default;

  /// `turbine` and `layout` outlive the component. The layout is complete from describe() on.
  virtual std::unique_ptr<components::Component> make(const model::Turbine& turbine,
                                                      const TurbineLayout& layout) const = 0;

  /// True if the turbine repeats when each blade moves to the place of the next one: all blades
  /// have equal components, or the component does not rotate.
  virtual bool keeps_rotor_symmetry() const = 0;
};

/// Rank for the unknowns of extensions: eliminated after all others (Registry::add_shared).
inline constexpr int extension_rank = 3;

}  // namespace samara::turbine
