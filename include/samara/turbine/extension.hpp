// Components that a program adds to a turbine.
#pragma once

#include <memory>

#include "samara/components/component.hpp"
#include "samara/model/turbine.hpp"
#include "samara/turbine/turbine_layout.hpp"

namespace samara::turbine {

/// Makes a component of one's own, as often as equations are made of the turbine: of each leg of a
/// transient, of each rank. It stands in `model::TurbineDefinition::extensions`.
class Extension {
 public:
  Extension() = default;
  Extension(const Extension&) = delete;
  Extension& operator=(const Extension&) = delete;
  virtual ~Extension() = default;

  /// `turbine` and `layout` live as long as the component; the layout is known from describe() on.
  virtual std::unique_ptr<components::Component> make(const model::Turbine& turbine,
                                                      const TurbineLayout& layout) const = 0;

  /// Whether the turbine repeats itself as a blade comes to the place of the next one: where all
  /// blades have the same of it, or where it does not turn with the rotor.
  virtual bool keeps_rotor_symmetry() const = 0;
};

/// For the unknowns of extensions: eliminated behind all others (Registry::add_shared).
inline constexpr int extension_rank = 3;

}  // namespace samara::turbine
