// Multiblade coordinates (R. P. Coleman and A. M. Feingold, NACA report 1351, 1958) of a
// state-space form with three or more blades (docs/theory.md, section 10.4):
//     x_k = a0 + sum_n ac_n cos(n psi_k) + as_n sin(n psi_k) [+ ad (-1)^(k - 1)],
//     psi_k = psi + 2 pi (k - 1)/Q.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "samara/linear/linear_model.hpp"

namespace samara::linear {

class Multiblade {
 public:
  /// `model` must outlive this object.
  /// @throws InputError for fewer than three blades, or blades that do not have the same states
  explicit Multiblade(const LinearModel& model);

  /// `form` at the azimuth psi of the first blade, in multiblade coordinates.
  StateSpace transform(double psi, const StateSpace& form) const;

  const std::vector<ModelState>& states() const { return states_; }
  const std::vector<system::Signal>& inputs() const { return inputs_; }
  const std::vector<system::Signal>& outputs() const { return outputs_; }

 private:
  /// One quantity of all blades, in the order of their numbers, or its `derivative` in time.
  struct Family {
    std::vector<int> members;
    std::vector<double> scales;
    int derivative = 0;
    int first = -1;  ///< family of the quantity itself, of which this is a derivative
  };

  using SignalKey = std::pair<std::string, int>;  ///< family (empty: none), derivative

  void find_state_families();
  void add_state_families(const std::vector<PetscInt>& unknowns, int first, int rates);
  void find_signal_families(const std::vector<SignalKey>& keys,
                            std::vector<system::Signal>& signals,
                            std::vector<Family>& families) const;
  static std::vector<std::string> words(int blades);
  /// The functions of all blades, Q x Q, differentiated by psi.
  Eigen::MatrixXd functions(double psi, int derivative) const;
  Eigen::MatrixXd matrix(const std::vector<Family>& families, Eigen::Index size, double psi,
                         int extra) const;

  const LinearModel& model_;
  int blades_ = 0;
  double speed_ = 0.0;
  std::vector<Family> state_families_, input_families_, output_families_;
  std::vector<ModelState> states_;
  std::vector<system::Signal> inputs_, outputs_;
};

/// Inputs of the state-space form: a motion gives three, with its rate and its acceleration.
std::vector<system::Signal> column_signals(const LinearModel& model);

}  // namespace samara::linear
