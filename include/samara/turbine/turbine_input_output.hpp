// Inputs and outputs of a turbine by their names (docs/case_file.md, "Linearize"). Outputs are
// channels.
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "samara/system/input_output.hpp"
#include "samara/turbine/turbine_channels.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace samara::turbine {

class TurbineInputOutput final : public system::InputOutput {
 public:
  /// `inputs` empty: all that the turbine has; `channels` empty: all but those of the stations.
  /// `system` must live on.
  /// @throws InputError where a name is not one of this turbine's, with the nearest one
  TurbineInputOutput(const TurbineSystem& system, const std::vector<std::string>& inputs,
                     const ChannelStations& stations, const std::vector<std::string>& channels);

  /// All inputs that this turbine has.
  static std::vector<system::Signal> available_inputs(const TurbineSystem& system);

  const std::vector<system::Signal>& inputs() const override { return inputs_; }
  const std::vector<system::Signal>& outputs() const override { return outputs_; }
  system::InputTangents input_tangents(double t, Vec z, Vec z_dot) const override;
  system::OutputTangents output_tangents(double t, Vec z, Vec z_dot) const override;
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
  std::vector<system::Signal> inputs_;
  std::vector<system::Signal> outputs_;
};

}  // namespace samara::turbine
