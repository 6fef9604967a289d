// The columns of the time series of a transient.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "samara/simulation/scenario.hpp"
#include "samara/turbine/turbine_channels.hpp"
#include "samara/turbine/turbine_geometry.hpp"

namespace samara::simulation {

/// Number of the channels of places.
std::size_t channels_of_places(const turbine::TurbineSystem& system);

/// The channels that a setup names, then, if it asks for places, those of each node of
/// turbine::TurbineGeometry: Node1Px, Node1Py, Node1Pz, its place [m], and Node1Rx, Node1Ry,
/// Node1Rz, the rotation vector of its axes from x y z [deg], in the ground.
class OutputChannels {
 public:
  /// `system` must outlive the object. @throws InputError for an unknown name
  OutputChannels(const turbine::TurbineSystem& system, const TransientSetup& transient);

  const std::vector<turbine::Channel>& channels() const { return all_; }
  /// Values in the units of the channels.
  void evaluate(double t, Vec z, Vec z_dot, std::span<double> values) const;

 private:
  turbine::TurbineChannels channels_;
  std::optional<turbine::TurbineGeometry> geometry_;
  std::vector<turbine::Channel> all_;
};

}  // namespace samara::simulation
