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
  /// `inputs` empty: all inputs of the turbine; `channels` empty: all channels except those of the
  /// stations. `system` must outlive the object.
  /// @throws InputError for a name that this turbine does not have; the message has the nearest
  /// name
  TurbineInputOutput(const TurbineSystem& system, const std::vector<std::string>& inputs,
                     const ChannelStations& stations, const std::vector<std::string>& channels);

  /// All inputs of this turbine.
  static std::vector<system::Signal> available_inputs(const TurbineSystem& system);

  const std::vector<system::Signal>& inputs() const override { return inputs_; }
  const std::vector<system::Signal>& outputs() const override { return outputs_; }
  system::InputTangents input_tangents(double t, Vec z, Vec z_dot) const override;
  system::OutputTangents output_tangents(double t, Vec z, Vec z_dot) const override;
  Eigen::VectorXd output_values(double t, Vec z, Vec z_dot) const override;

  /// The turbine's inputs; `values` and `rates` are those of inputs().
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
