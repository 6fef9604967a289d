#include "samara/simulation/output_channels.hpp"

#include <numbers>
#include <string>

#include <Eigen/Geometry>

namespace samara::simulation {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr const char* axes[] = {"x", "y", "z"};
constexpr char ground[] = "ground";

}  // namespace

std::size_t channels_of_places(const turbine::TurbineSystem& system) {
  return 6 * turbine::TurbineGeometry(system).nodes().size();
}

OutputChannels::OutputChannels(const turbine::TurbineSystem& system,
                               const TransientSetup& transient)
    : channels_(system, transient.stations, transient.channels), all_(channels_.channels()) {
  if (!transient.has_places) return;
  geometry_.emplace(system);
  for (std::size_t i = 0; i < geometry_->nodes().size(); ++i) {
    const std::string node = "Node" + std::to_string(i + 1);
    const std::string part = geometry_->nodes()[i].part + ", node " + std::to_string(i + 1);
    for (const char* axis : axes)
      all_.push_back({node + "P" + axis, "m", ground, part + ": place, " + axis});
    for (const char* axis : axes)
      all_.push_back(
          {node + "R" + axis, "deg", ground, part + ": rotation vector of the axes, " + axis});
  }
}

void OutputChannels::evaluate(double t, Vec z, Vec z_dot, std::span<double> values) const {
  const std::size_t own = channels_.channels().size();
  channels_.evaluate(t, z, z_dot, values.first(own));
  if (!geometry_) return;
  const std::vector<double> state = petsc::values_of(z);
  const Eigen::Map<const Eigen::VectorXd> whole(state.data(),
                                                static_cast<Eigen::Index>(state.size()));
  std::size_t at = own;
  for (const elements::Pose<double>& pose : geometry_->poses(t, whole)) {
    const Eigen::AngleAxisd turn(pose.axes);
    const Vector3 rotation = turn.angle() / degree * turn.axis();
    for (int i = 0; i < 3; ++i) values[at++] = pose.place(i);
    for (int i = 0; i < 3; ++i) values[at++] = rotation(i);
  }
}

}  // namespace samara::simulation
