// Interface of every part of a turbine. The equations of a part are functions of some unknowns,
// their rates and the values of ports. Each function is stated once, as a template on its scalar;
// the residual, the tangents and their pattern follow from it.
#pragma once

#include <complex>

#include "samara/components/pattern.hpp"
#include "samara/components/registry.hpp"
#include "samara/components/residual.hpp"
#include "samara/components/tangents.hpp"

namespace samara::components {

class Component {
 public:
  Component() = default;
  Component(const Component&) = delete;
  Component& operator=(const Component&) = delete;
  virtual ~Component() = default;

  /// Requests unknowns and ports. It is called twice: with a registry that counts and with one that
  /// places.
  virtual void place(Registry& registry) = 0;
  /// Called when all places are known: describes the unknowns and rows, and connects the functions
  /// to them.
  virtual void describe(Registry& registry) = 0;
  /// True if the component neither dissipates nor feeds energy (PeriodicSystem::is_conservative).
  virtual bool is_conservative() const = 0;
  /// True if its constraint rows depend on time only through the unknowns.
  virtual bool has_autonomous_constraints() const { return true; }

  virtual void add_to(Residual<double>& residual) const = 0;
  virtual void add_to(Residual<std::complex<double>>& residual) const = 0;
  virtual void add_to(Pattern& pattern) const = 0;
  virtual void add_to(Tangents& tangents) const = 0;
};

/// Implements add_to with `template <class System> void Self::state(System& system) const`, which
/// passes the same functions in the same order to `system.add` at every call. The header of a
/// component declares `extern template class Stated<Self>`; its source file instantiates it.
template <class Self>
class Stated : public Component {
 public:
  void add_to(Residual<double>& residual) const final;
  void add_to(Residual<std::complex<double>>& residual) const final;
  void add_to(Pattern& pattern) const final;
  void add_to(Tangents& tangents) const final;

 private:
  const Self& self() const { return static_cast<const Self&>(*this); }
};

template <class Self>
void Stated<Self>::add_to(Residual<double>& residual) const {
  self().state(residual);
}
template <class Self>
void Stated<Self>::add_to(Residual<std::complex<double>>& residual) const {
  self().state(residual);
}
template <class Self>
void Stated<Self>::add_to(Pattern& pattern) const {
  self().state(pattern);
}
template <class Self>
void Stated<Self>::add_to(Tangents& tangents) const {
  self().state(tangents);
}

}  // namespace samara::components
