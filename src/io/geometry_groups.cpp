#include "geometry_groups.hpp"

#include <cmath>
#include <numbers>

#include "samara/petsc/handle.hpp"

#include "axes.hpp"

namespace samara::io {
namespace {

constexpr char ground_frame[] = "ground: x downwind at zero yaw, z up, y = z x x";

using Poses = std::vector<elements::Pose<double>>;

Eigen::VectorXd undeformed_state(const turbine::TurbineSystem& system, double t) {
  const petsc::Handle<Vec> z = system.make_state();
  system.reference_state(t, z.get());
  const std::vector<double> values = petsc::values_of(z.get());
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

void append(const Poses& poses, std::vector<double>& places) {
  for (const elements::Pose<double>& pose : poses)
    places.insert(places.end(), pose.place.data(), pose.place.data() + 3);
}

/// Number of a state, or the time and the azimuth of an instant.
void write_instants(Hdf5File& file, const turbine::TurbineSystem& system,
                    const std::vector<TurbineInstant>& instants, const std::string& axis) {
  std::vector<double> times;
  std::vector<double> azimuths;
  for (const TurbineInstant& instant : instants) {
    const double turned = system.turbine().turning_at(instant.time).value;
    times.push_back(instant.time);
    azimuths.push_back(turned -
                       2.0 * std::numbers::pi * std::floor(turned / (2.0 * std::numbers::pi)));
  }
  file.write("/geometry/time", times, {times.size()}, {"s", "none", "times of the states", {axis}});
  file.write("/geometry/azimuth", azimuths, {azimuths.size()},
             {"rad", "about +s2", "azimuth of blade 1 at constant rotor speed", {axis}});
}

void write_nodes(Hdf5File& file, const turbine::TurbineGeometry& geometry) {
  std::vector<std::string> parts;
  std::vector<double> stations, widths, thicknesses;
  for (const turbine::GeometryNode& node : geometry.nodes()) {
    parts.push_back(node.part);
    stations.push_back(node.station);
    widths.push_back(node.width);
    thicknesses.push_back(node.thickness);
  }
  const hsize_t count = parts.size();
  file.write("/geometry/part", parts, {"", "none", "part of each node", {node_axis}});
  file.write("/geometry/station", stations, {count},
             {"1",
              "none",
              "fraction of the length of the beam; not-a-number on a rigid body",
              {node_axis}});
  file.write(
      "/geometry/width", widths, {count},
      {"m",
       "section",
       "size of the section along its second axis: the chord, or else that of a tube with its "
       "radius of gyration; 0 on a rigid body",
       {node_axis}});
  file.write("/geometry/thickness", thicknesses, {count},
             {"m", "section", "the same along its third axis, at most the width", {node_axis}});
  std::vector<double> lines;
  for (const std::array<int, 2>& line : geometry.lines())
    lines.insert(lines.end(), line.begin(), line.end());
  file.write(
      "/geometry/lines", lines, {geometry.lines().size(), 2},
      {"1", "none", "nodes, counted from 0, between which there is a part", {"line", "end"}});
}

}  // namespace

void write_geometry(Hdf5File& file, const turbine::TurbineSystem& system,
                    const std::vector<TurbineInstant>& instants, const std::string& axis) {
  const turbine::TurbineGeometry geometry(system);
  std::vector<double> places, undeformed, axes;
  for (const TurbineInstant& instant : instants) {
    const Poses poses = geometry.poses(instant.time, instant.z);
    append(poses, places);
    append(geometry.poses(instant.time, undeformed_state(system, instant.time)), undeformed);
    // Columns of the matrix are axes: its memory has the order of the file.
    for (const elements::Pose<double>& pose : poses)
      axes.insert(axes.end(), pose.axes.data(), pose.axes.data() + 9);
  }
  const hsize_t count = instants.size();
  const hsize_t nodes = geometry.nodes().size();
  write_instants(file, system, instants, axis);
  write_nodes(file, geometry);
  file.write("/geometry/place", places, {count, nodes, 3},
             {"m", ground_frame, "place of each node", {axis, node_axis, vector_axis}});
  file.write("/geometry/undeformed", undeformed, {count, nodes, 3},
             {"m",
              ground_frame,
              "the same of the undeformed turbine at the same time",
              {axis, node_axis, vector_axis}});
  file.write(
      "/geometry/axes", axes, {count, nodes, 3, 3},
      {"1",
       ground_frame,
       "unit vectors of each node. Beams: tangent, second and third axis of the section; rigid "
       "bodies: their x, y and z",
       {axis, node_axis, "axis", vector_axis}});
}

void write_node_motions(Hdf5File& file, const std::string& group,
                        const turbine::TurbineSystem& system, const analysis::ModeSet& set,
                        const std::vector<TurbineInstant>& instants) {
  if (instants.empty()) return;
  const turbine::TurbineGeometry geometry(system);
  std::vector<turbine::TurbineGeometry::Motions> motions;
  for (const TurbineInstant& instant : instants)
    motions.emplace_back(geometry, instant.time, instant.z);
  const std::size_t nodes = geometry.nodes().size();
  const Hdf5Id dataset = file.make_slices(
      group + "/node_motion", {set.shapes.size(), instants.size(), nodes, 6, 2},
      {"m, rad",
       ground_frame,
       "displacement (x, y, z) and rotation of each node in the shapes of modes, with their scale; "
       "not-a-number for a mode of the air and one that is not resolved",
       {mode_axis, "mode_times", node_axis, motion_axis, complex_axis}});
  std::vector<float> slice;
  for (std::size_t m = 0; m < set.shapes.size(); ++m) {
    if (set.shapes[m].size() == 0 || is_of_medium(set.modes[m])) continue;
    slice.clear();
    for (std::size_t i = 0; i < instants.size(); ++i) {
      const Eigen::MatrixXcd motion =
          motions[i].of(set.shapes[m].col(static_cast<Eigen::Index>(i)));
      for (const std::complex<double>& value : motion.reshaped()) {
        slice.push_back(static_cast<float>(value.real()));
        slice.push_back(static_cast<float>(value.imag()));
      }
    }
    file.write_slice(dataset, m, slice);
  }
}

}  // namespace samara::io
