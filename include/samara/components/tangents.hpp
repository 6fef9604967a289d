// The tangents K = dr/dz and M = dr/dz_dot of the components' functions, by automatic
// differentiation, at zero inputs.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "samara/base/error.hpp"
#include "samara/components/block_matrix.hpp"
#include "samara/components/function.hpp"
#include "samara/components/pattern.hpp"
#include "samara/math/autodiff.hpp"

namespace samara::components {

/// The workspace of one caller; several may share the plan.
class Tangents {
 public:
  explicit Tangents(std::shared_ptr<const TangentPlan> plan);

  /// Called before the functions are stated at (t, z, z_dot). The vectors must stay valid until
  /// then. Sets K and M to their constant entries.
  void start(double t, const std::vector<double>& z, const std::vector<double>& z_dot);

  BlockMatrix& K() { return K_; }
  const BlockMatrix& M() const { return M_; }

  static constexpr bool has_inputs = false;  ///< inputs are zero
  double time() const { return t_; }
  static double varying(double value) { return value; }
  /// @throws DomainError beyond 170 degrees; `place()`: the place in the message
  template <class Place>
  void require_rotation(int first, const Place& place) const {
    const auto block = static_cast<std::size_t>(first / BlockMatrix::block);
    if (!plan_->blocks[block].empty())  // else another rank has it
      components::require_rotation(z_->data() + first, place);
  }

  static void add(const std::vector<LinearShare>&) {}

  template <int n, int m, class Function>
  void add(const Connections& connections, const Function& function, Memory memory = Memory::none) {
    const TangentPlan::Call& call = plan_->calls.at(next_);
    Derivatives& at = derivatives_[next_++];
    if (call.arguments != n || call.values != m)
      throw InternalError("the order of the functions differs from that of the plan");
    if (call.is_idle) return;
    gather(connections, n);
    if (memory == Memory::none ||
        !std::equal(at.x.begin(), at.x.end(), arguments_.begin(), arguments_.begin() + n)) {
      Eigen::Matrix<math::Dual<n>, n, 1> x;
      for (int i = 0; i < n; ++i)
        x(i) = math::independent<n>(arguments_[static_cast<std::size_t>(i)], i);
      const Eigen::Matrix<math::Dual<n>, m, 1> y = function(x);
      for (int i = 0; i < m; ++i) {
        at.y(i) = y(i).value();
        at.J.row(i) = y(i).derivatives().transpose();
      }
      std::copy_n(arguments_.begin(), n, at.x.begin());
    }
    scatter(connections, call, at);
  }

 private:
  struct Derivatives {
    std::vector<double> x;  ///< arguments
    Eigen::VectorXd y;
    Eigen::MatrixXd J;  ///< values x arguments
  };
  struct Port {
    Eigen::VectorXd values;
    Eigen::MatrixXd J;  ///< values x columns
  };

  void gather(const Connections& connections, int n);
  void scatter(const Connections& connections, const TangentPlan::Call& call,
               const Derivatives& at);
  void add_share(const Share& share, const TangentPlan::SharePlan& plan, const Eigen::MatrixXd& J);
  void add_provision(const Provision& provision, const TangentPlan::ProvisionPlan& plan,
                     const Derivatives& at);

  std::shared_ptr<const TangentPlan> plan_;
  BlockMatrix K_;
  BlockMatrix M_;                         ///< with the same blocks as K
  std::vector<Derivatives> derivatives_;  ///< derivatives of each call
  std::vector<Port> ports_;
  std::vector<double> arguments_;  ///< arguments of the present function
  Eigen::Matrix<double, 3, Eigen::Dynamic> through_;
  std::size_t next_ = 0;  ///< call
  double t_ = 0.0;
  const std::vector<double>* z_ = nullptr;
  const std::vector<double>* z_dot_ = nullptr;
};

}  // namespace samara::components
