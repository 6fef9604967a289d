// The residual of the components' functions, with real numbers, or with complex numbers for
// derivatives by a complex step.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "samara/base/index.hpp"
#include "samara/components/function.hpp"
#include "samara/components/inputs.hpp"
#include "samara/components/portion.hpp"

namespace samara::components {

template <class T>
class Residual {
 public:
  /// Computes r(t, z, z_dot, u) into `r`, which must be zero. All vectors have the same size.
  /// `port_sizes`: number of values of each port. `portion`: the functions that count; null: all.
  Residual(double t, const std::vector<T>& z, const std::vector<T>& z_dot,
           const TurbineInputs<T>& inputs, const std::vector<int>& port_sizes, std::vector<T>& r,
           const Portion* portion = nullptr)
      : t_(t), z_(z), z_dot_(z_dot), inputs_(inputs), r_(r), portion_(portion) {
    for (const int size : port_sizes)
      ports_.push_back(Eigen::Matrix<T, Eigen::Dynamic, 1>::Zero(size));
  }

  static constexpr bool has_inputs = true;
  double time() const { return t_; }
  /// Marks a number that changes with time.
  static double varying(double value) { return value; }
  const TurbineInputs<T>& inputs() const { return inputs_; }

  /// @throws DomainError beyond 170 degrees; `place()`: the place in the message
  template <class Place>
  void require_rotation(int first, const Place& place) const {
    if (portion_ == nullptr || portion_->has_unknown(first))
      components::require_rotation(z_.data() + first, place);
  }

  /// The sum of all provisions to a port.
  const Eigen::Matrix<T, Eigen::Dynamic, 1>& port(int number) const { return ports_[at(number)]; }

  void add(const std::vector<LinearShare>& shares) {
    for (const LinearShare& share : shares) {
      if (portion_ != nullptr && !portion_->has_entry(share.row, share.column)) continue;
      for (int i = 0; i < share.count; ++i)
        r_[at(share.row + i)] += z_[at(share.column + i)] * share.weight;
    }
  }

  /// `function`: has n arguments and m values.
  template <int n, int m, class Function>
  void add(const Connections& connections, const Function& function, Memory = Memory::none) {
    const std::size_t call = next_++;
    if (portion_ != nullptr && !portion_->needs(call)) return;
    const Eigen::Matrix<T, m, 1> y = function(gather<n>(connections));
    for (const Share& share : connections.shares) {
      if (portion_ != nullptr && !portion_->has_share(call, share.row)) continue;
      for (int i = 0; i < share.count; ++i)
        r_[at(share.row + i)] += y(share.value + i) * share.weight;
      if (share.other_weight == 0.0) continue;
      for (int i = 0; i < share.count; ++i)
        r_[at(share.row + i)] += y(share.other + i) * share.other_weight;
    }
    for (const Provision& provision : connections.provisions) {
      auto& port = ports_[at(provision.port)];
      port += y.segment(provision.value, port.size());
    }
  }

  template <int n>
  Eigen::Matrix<T, n, 1> gather(const Connections& connections) const {
    Eigen::Matrix<T, n, 1> x;
    int place = 0;
    for (const Argument& argument : connections.arguments)
      for (int i = 0; i < argument.count; ++i) x(place++) = value_of(argument, i);
    return x;
  }

 private:
  T value_of(const Argument& argument, int i) const {
    switch (argument.kind) {
      case Argument::Kind::unknowns:
        return z_[at(argument.first + i)];
      case Argument::Kind::rates:
        return z_dot_[at(argument.first + i)];
      case Argument::Kind::port:
        return ports_[at(argument.first)](i);
      case Argument::Kind::zeros:
        break;
    }
    return T(0);
  }

  double t_;
  const std::vector<T>& z_;
  const std::vector<T>& z_dot_;
  const TurbineInputs<T>& inputs_;
  std::vector<T>& r_;
  const Portion* portion_;
  std::size_t next_ = 0;  ///< call
  std::vector<Eigen::Matrix<T, Eigen::Dynamic, 1>> ports_;
};

}  // namespace samara::components
