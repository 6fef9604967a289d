// Time series of the verification cases.
#pragma once

#include <functional>
#include <vector>

#include "samara/analysis/transient.hpp"

#include "cases.hpp"

namespace samara::test {

inline Eigen::VectorXd values_of(Vec vector) {
  const petsc::ReadView view(vector);
  PetscInt size = 0;
  VecGetSize(vector, &size);
  return Eigen::Map<const Eigen::VectorXd>(view.data(), size);
}

/// Keeps what `pick` takes of every sample.
template <class Value>
class Keeper final : public analysis::TransientObserver {
 public:
  explicit Keeper(std::function<Value(const analysis::TransientSample&)> pick)
      : pick_(std::move(pick)) {}

  bool sample(const analysis::TransientSample& sample) override {
    times.push_back(sample.t);
    values.push_back(pick_(sample));
    return true;
  }

  std::vector<double> times;
  std::vector<Value> values;

 private:
  std::function<Value(const analysis::TransientSample&)> pick_;
};

inline analysis::TransientOptions steps_of(double step, double duration,
                                           analysis::TransientMethod method) {
  analysis::TransientOptions options;
  options.step = step;
  options.duration = duration;
  options.method = method;
  options.tolerance = 1e-12;
  return options;
}

/// The state after `duration`.
inline Eigen::VectorXd state_after(const system::PeriodicSystem& system,
                                   const analysis::TransientStart& start,
                                   const analysis::TransientOptions& options) {
  Keeper<double> ignore([](const analysis::TransientSample&) { return 0.0; });
  return analysis::run_transient(system, start, options, ignore).end.z;
}

/// The largest difference of the positions of two states.
inline double position_difference(const system::PeriodicSystem& system, const Eigen::VectorXd& a,
                                  const Eigen::VectorXd& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < system.unknowns().size(); ++i)
    if (system.unknowns()[i].role == system::UnknownRole::position)
      largest = std::max(
          largest, std::abs(a(static_cast<Eigen::Index>(i)) - b(static_cast<Eigen::Index>(i))));
  return largest;
}

}  // namespace samara::test
