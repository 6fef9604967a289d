// Inputs and outputs of a periodic system for analyses (docs/theory.md, section 10):
// r(t, z, z_dot, u, u_dot) = 0, y = y(t, z, z_dot, u).
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "samara/system/periodic_system.hpp"

namespace samara::system {

/// An input or an output.
struct Signal {
  std::string name;
  std::string unit;
  std::string frame;
  std::string description;
  std::string family;  ///< common name of this signal of all blades; empty: not of a blade
  int blade = 0;       ///< from 1; 0 = no blade
  /// A prescribed motion as an input: it acts with its value, its rate and its acceleration.
  bool is_motion = false;
};

struct InputTangents {
  Eigen::MatrixXd by_value;  ///< dr/du, size x inputs
  Eigen::MatrixXd by_rate;   ///< dr/du_dot, nonzero only for inputs that are motions
};

struct OutputTangents {
  Eigen::MatrixXd by_state;  ///< dy/dz, outputs x size
  Eigen::MatrixXd by_rate;   ///< dy/dz_dot
  Eigen::MatrixXd by_input;  ///< dy/du, outputs x inputs
};

class InputOutput {
 public:
  InputOutput() = default;
  InputOutput(const InputOutput&) = delete;
  InputOutput& operator=(const InputOutput&) = delete;
  virtual ~InputOutput() = default;

  virtual const std::vector<Signal>& inputs() const = 0;
  virtual const std::vector<Signal>& outputs() const = 0;

  /// At a state where all inputs are zero. No constraint row contains inputs. Serial.
  virtual InputTangents input_tangents(double t, Vec z, Vec z_dot) const = 0;
  virtual OutputTangents output_tangents(double t, Vec z, Vec z_dot) const = 0;
  /// y at a state where all inputs are zero.
  virtual Eigen::VectorXd output_values(double t, Vec z, Vec z_dot) const = 0;
};

}  // namespace samara::system
