// A scalar that holds the quantities on which it depends instead of its value. With it, functions
// that are templates on the scalar give those of their derivatives that may differ from zero.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include <Eigen/Core>

namespace samara::math {

/// A set of up to 64 independent quantities. Constants keep their value, so that a factor of zero
/// removes the quantities that it multiplies. Terms that cancel are not detected: the set may be
/// too large, never too small.
class Dependence {
 public:
  static constexpr int most_quantities = 64;

  /// The constant zero.
  Dependence() = default;
  /// A constant; not-a-number stands for any value.
  Dependence(double value) : value_(value) {}  // NOLINT(google-explicit-constructor): a scalar

  /// The independent quantity number `index`.
  static Dependence on(int index) {
    Dependence quantity(any);
    quantity.quantities_ = std::uint64_t{1} << index;
    return quantity;
  }
  /// Bit `index` is set where the quantity may have a derivative.
  std::uint64_t quantities() const { return quantities_; }
  bool is_on(int index) const { return (quantities_ >> index & 1U) != 0; }
  bool is_zero() const { return value_ == 0.0; }

  Dependence& operator+=(const Dependence& b) { return take(b, value_ + b.value_); }
  Dependence& operator-=(const Dependence& b) { return take(b, value_ - b.value_); }
  Dependence& operator*=(const Dependence& b) {
    return is_zero() || b.is_zero() ? *this = Dependence() : take(b, value_ * b.value_);
  }
  Dependence& operator/=(const Dependence& b) {
    return is_zero() ? *this : take(b, value_ / b.value_);
  }
  friend Dependence operator+(Dependence a, const Dependence& b) { return a += b; }
  friend Dependence operator-(Dependence a, const Dependence& b) { return a -= b; }
  friend Dependence operator*(Dependence a, const Dependence& b) { return a *= b; }
  friend Dependence operator/(Dependence a, const Dependence& b) { return a /= b; }
  friend Dependence operator-(Dependence a) {
    a.value_ = -a.value_;
    return a;
  }
  friend Dependence sin(Dependence a) { return a.take(a, std::sin(a.value_)); }
  friend Dependence cos(Dependence a) { return a.take(a, std::cos(a.value_)); }
  friend Dependence sqrt(Dependence a) { return a.take(a, std::sqrt(a.value_)); }

 private:
  static constexpr double any = std::numeric_limits<double>::quiet_NaN();

  Dependence& take(const Dependence& b, double value) {
    quantities_ |= b.quantities_;
    value_ = value;
    return *this;
  }

  std::uint64_t quantities_ = 0;
  double value_ = 0.0;  ///< not-a-number unless it is a constant
};

}  // namespace samara::math

namespace Eigen {

template <>
struct NumTraits<samara::math::Dependence> : GenericNumTraits<samara::math::Dependence> {
  using Real = samara::math::Dependence;
  using NonInteger = samara::math::Dependence;
  using Nested = samara::math::Dependence;
  // NOLINTNEXTLINE(readability-identifier-naming): Eigen's names
  enum { IsComplex = 0, IsInteger = 0, IsSigned = 1, RequireInitialization = 1 };
};

}  // namespace Eigen
