// The contract of every part of a turbine: its equations are functions of some unknowns, their
// rates and the values of ports. Each function is stated once, as a template on its scalar; the
// residual, the tangents and their pattern are made of it.
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

  /// Asks for unknowns and ports: twice, of a registry that counts and of one that places.
  virtual void place(Registry& registry) = 0;
  /// When all have their places: what the unknowns and rows are, and how the functions are tied to
  /// them.
  virtual void describe(Registry& registry) = 0;
  /// True where it neither dissipates nor feeds energy (PeriodicSystem::is_conservative).
  virtual bool is_conservative() const = 0;
  /// True where its constraint rows do not depend on time other than through the unknowns.
  virtual bool has_autonomous_constraints() const { return true; }

  virtual void add_to(Residual<double>& residual) const = 0;
  virtual void add_to(Residual<std::complex<double>>& residual) const = 0;
  virtual void add_to(Pattern& pattern) const = 0;
  virtual void add_to(Tangents& tangents) const = 0;
};

/// Makes them from `template <class System> void Self::state(System& system) const`, which states
/// the same functions in the same order at all times, to `system.add`. A component's header
/// declares `extern template class Stated<Self>`, its source makes it.
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
