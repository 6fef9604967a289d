// A value with one derivative whose parts may be jets again: Jet<Jet<double>> carries the exact
// mixed second derivative. The tests derive velocities, accelerations and Lagrange's equations from
// positions with it, by no code of the program's own.
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace samara {

template <class T>
struct Jet {
  T value{0.0};
  T rate{0.0};

  Jet() = default;
  Jet(double constant) : value(constant) {}  // NOLINT: scalars convert
  Jet(const T& v, const T& r) : value(v), rate(r) {}

  Jet& operator+=(const Jet& b) { return *this = *this + b; }
  Jet& operator-=(const Jet& b) { return *this = *this - b; }
  Jet& operator*=(const Jet& b) { return *this = *this * b; }
  friend Jet operator-(const Jet& a) { return {-a.value, -a.rate}; }
  friend Jet operator+(const Jet& a, const Jet& b) { return {a.value + b.value, a.rate + b.rate}; }
  friend Jet operator-(const Jet& a, const Jet& b) { return {a.value - b.value, a.rate - b.rate}; }
  friend Jet operator*(const Jet& a, const Jet& b) {
    return {a.value * b.value, a.value * b.rate + a.rate * b.value};
  }
  friend Jet operator/(const Jet& a, const Jet& b) {
    const T quotient = a.value / b.value;
    return {quotient, (a.rate - quotient * b.rate) / b.value};
  }
  friend Jet sin(const Jet& a) {
    using std::cos;
    using std::sin;
    return {sin(a.value), cos(a.value) * a.rate};
  }
  friend Jet cos(const Jet& a) {
    using std::cos;
    using std::sin;
    return {cos(a.value), -(sin(a.value) * a.rate)};
  }
};

/// The value and the rate of a matrix of jets.
template <class T, int rows, int columns>
Eigen::Matrix<T, rows, columns> value_of(const Eigen::Matrix<Jet<T>, rows, columns>& m) {
  Eigen::Matrix<T, rows, columns> result;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) result(i, j) = m(i, j).value;
  return result;
}

template <class T, int rows, int columns>
Eigen::Matrix<T, rows, columns> rate_of(const Eigen::Matrix<Jet<T>, rows, columns>& m) {
  Eigen::Matrix<T, rows, columns> result;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) result(i, j) = m(i, j).rate;
  return result;
}

/// The vector v of skew(v) = S, for a skew matrix.
template <class T>
Eigen::Matrix<T, 3, 1> axial(const Eigen::Matrix<T, 3, 3>& S) {
  return Eigen::Matrix<T, 3, 1>((S(2, 1) - S(1, 2)) * T(0.5), (S(0, 2) - S(2, 0)) * T(0.5),
                                (S(1, 0) - S(0, 1)) * T(0.5));
}

/// The matrix that turns vectors by theta = 2 tan(phi / 2) n, by the quaternion (1, theta / 2).
template <class T>
Eigen::Matrix<T, 3, 3> turned_by(const Eigen::Matrix<T, 3, 1>& theta) {
  const T x = theta(0) * T(0.5);
  const T y = theta(1) * T(0.5);
  const T z = theta(2) * T(0.5);
  const T norm = T(1.0) + x * x + y * y + z * z;
  Eigen::Matrix<T, 3, 3> m;
  m << T(1.0) + x * x - y * y - z * z, (x * y - z) * T(2.0), (x * z + y) * T(2.0),
      (x * y + z) * T(2.0), T(1.0) - x * x + y * y - z * z, (y * z - x) * T(2.0),
      (x * z - y) * T(2.0), (y * z + x) * T(2.0), T(1.0) - x * x - y * y + z * z;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = m(i, j) / norm;
  return m;
}

/// The parameters theta of a matrix that turns vectors (less than half a turn).
inline Eigen::Vector3d parameters_of(const Eigen::Matrix3d& turn) {
  return 4.0 / (1.0 + turn.trace()) * axial<double>(turn);
}

}  // namespace samara

namespace Eigen {

template <class T>
struct NumTraits<samara::Jet<T>> : NumTraits<double> {
  using Real = samara::Jet<T>;
  using NonInteger = samara::Jet<T>;
  using Nested = samara::Jet<T>;
  using Literal = double;
  enum { RequireInitialization = 1 };  // NOLINT: Eigen's name
};

}  // namespace Eigen
