// Inputs and outputs of a turbine by their names (docs/case_file.md, "Linearize"). Outputs are
// channels.
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "samara/system/input_output.hpp"
#include "samara/system/turbine_channels.hpp"
#include "samara/system/turbine_system.hpp"

namespace samara::system {

class TurbineInputOutput final : public InputOutput {
 public:
  /// `inputs` empty: all that the turbine has; `channels` empty: all but those of the stations.
  /// `system` must live on.
  /// @throws InputError where a name is not one of this turbine's, with the nearest one
  TurbineInputOutput(const TurbineSystem& system, const std::vector<std::string>& inputs,
                     const ChannelStations& stations, const std::vector<std::string>& channels);

  /// All inputs that this turbine has.
  static std::vector<Signal> available_inputs(const TurbineSystem& system);

  const std::vector<Signal>& inputs() const override { return inputs_; }
  const std::vector<Signal>& outputs() const override { return outputs_; }
  InputTangents input_tangents(double t, Vec z, Vec z_dot) const override;
  OutputTangents output_tangents(double t, Vec z, Vec z_dot) const override;
  Eigen::VectorXd output_values(double t, Vec z, Vec z_dot) const override;

  /// Values of the turbine's inputs where those of inputs() are `values` and `rates`.
  template <class T>
  TurbineInputs<T> collect(const Eigen::Matrix<T, Eigen::Dynamic, 1>& values,
                           const Eigen::Matrix<T, Eigen::Dynamic, 1>& rates) const;

 private:
  using Complex = std::complex<double>;
  std::vector<Complex> complex_of(Vec vector) const;

  const TurbineSystem& system_;
  TurbineChannels channels_;
  std::vector<Signal> inputs_;
  std::vector<Signal> outputs_;
};

}  // namespace samara::system
