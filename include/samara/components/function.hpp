// Connections between a function of a component and the unknowns and rows of a system. Residual,
// tangents and their pattern come from the same function, evaluated with other scalars
// (residual.hpp, tangents.hpp, pattern.hpp).
#pragma once

#include <vector>

#include "samara/base/error.hpp"
#include "samara/math/rotation.hpp"
#include "samara/math/scalar.hpp"
#include "samara/math/types.hpp"

namespace samara::components {

/// Consecutive arguments of a function.
struct Argument {
  enum class Kind {
    unknowns,
    rates,  ///< rates of unknowns
    port,   ///< all values of a port
    zeros,  ///< constants, where there is no unknown
  };
  Kind kind = Kind::zeros;
  int first = 0;  ///< unknown, or number of the port
  int count = 0;
};

inline Argument unknowns(int first, int count) { return {Argument::Kind::unknowns, first, count}; }
inline Argument rates(int first, int count) { return {Argument::Kind::rates, first, count}; }
inline Argument port_values(int port, int count) { return {Argument::Kind::port, port, count}; }
inline Argument zeros(int count) { return {Argument::Kind::zeros, 0, count}; }

/// Row `row` + i receives weight y(value + i) + other_weight y(other + i); y: values of the
/// function.
struct Share {
  int row = 0;
  int count = 0;  ///< 1 to 3, in one block
  int value = 0;
  double weight = 1.0;
  int other = 0;
  double other_weight = 0.0;
};

/// Row `row` + i receives weight z(column + i): a constant entry of K.
struct LinearShare {
  int row = 0;
  int column = 0;
  int count = 0;
  double weight = 1.0;
};

/// Value i of the port receives y(value + i). A port is the sum of all its provisions.
struct Provision {
  int port = 0;
  int value = 0;
};

/// Arguments, shares and provisions of a function in a system.
struct Connections {
  std::vector<Argument> arguments;
  std::vector<Share> shares;
  std::vector<Provision> provisions;
};

/// @throws DomainError if three rotation parameters are beyond 170 degrees; `place()`: their place
/// in the message
template <class T, class Place>
void require_rotation(const T* parameters, const Place& place) {
  Vector3 theta;
  for (int i = 0; i < 3; ++i) theta(i) = math::plain_value(parameters[i]);
  if (!(theta.norm() < math::largest_rodrigues_length))
    throw DomainError(place() + ": rotation beyond 170 degrees");
}

/// Condition for keeping tangents while the arguments are the same.
enum class Memory {
  none,          ///< the function depends on time as well
  of_arguments,  ///< the function depends on its arguments alone
};

}  // namespace samara::components
