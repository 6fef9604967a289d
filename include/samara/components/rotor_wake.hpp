// The finite-state wake of a rotor in a system (docs/theory.md, section 11.9): its states follow
// the loads on all blades and give the induced velocity along the rotor's axis at each point.
//
// A part of the wake is the cosine or the sine of a shape. It has the state alpha (or beta), and
// the auxiliary t = (L^-1 alpha) of that part.
#pragma once

#include <vector>

#include "samara/components/beam.hpp"
#include "samara/components/blade_root.hpp"
#include "samara/components/component.hpp"
#include "samara/elements/rotor_wake.hpp"
#include "samara/model/turbine.hpp"

namespace samara::components {

class RotorWake final : public Stated<RotorWake> {
 public:
  /// The turbine must have air with a finite-state wake. Turbine and blades must outlive the
  /// component.
  RotorWake(const model::Turbine& turbine, std::vector<const Beam*> blades, int rank);

  /// Ports of the poses of the hub and of the blades' roots.
  void tie(int hub_port, const std::vector<int>& root_ports);

  void place(Registry& registry) override;
  void describe(Registry& registry) override;
  bool is_conservative() const override { return false; }

  template <class System>
  void state(System& system) const;

  /// The flow through the disk. `residual`: where the ports of the poses have been provided.
  elements::DiskFlow<double> flow(const Residual<double>& residual) const;

  /// Sets the states in `values` to those of the mean loads there in a steady flow, without
  /// harmonics, and the induced velocities at the points to theirs. `residual`: where the ports of
  /// the poses have been provided.
  void settle(const Residual<double>& residual, std::vector<double>& values) const;

 private:
  /// Pose of the hub; t of the uniform load.
  static constexpr int flow_arguments = hub_pose_values + 1;
  /// z1, z2, V_T, carrying speed.
  static constexpr int flow_values = 4;
  /// Flow; t and the rates of both parts.
  static constexpr int evolution_arguments = flow_values + 4;
  /// Flow; t of both parts.
  static constexpr int coupling_arguments = flow_values + 2;
  /// Shapes that one function of a point serves.
  static constexpr int batch = 5;
  /// u of the point; force per length; poses of root and hub; states.
  static constexpr int at_force = 3;
  static constexpr int at_root = 6;
  static constexpr int at_hub = at_root + root_pose_values;
  static constexpr int at_states = at_hub + hub_pose_values;
  static constexpr int point_arguments = at_states + 2 * batch;
  /// Loads of the shapes; induced velocity against the thrust.
  static constexpr int point_values = 2 * batch + 1;

  struct Coupling {
    std::size_t row = 0;
    std::size_t column = 0;
    Connections connections;
  };
  struct PointBatch {
    std::size_t blade = 0;
    int point = 0;
    std::size_t first_shape = 0;
    Connections connections;
  };

  const elements::AirRotor& rotor() const { return turbine_.air->rotor; }
  /// First unknown of a part of a shape: its state, then its auxiliary.
  int part(std::size_t shape, int sine) const;
  Argument part_or_zero(std::size_t shape, int sine, bool is_auxiliary, bool is_rate = false) const;
  void describe_part(Registry& registry, std::size_t shape, int sine);
  void connect_points();
  template <class T>
  Vec3<T> wind_at(const Eigen::Matrix<T, flow_arguments, 1>& x, double t,
                  const elements::WindInputs<T>* change) const;
  template <class T>
  Eigen::Matrix<T, point_values, 1> point_terms(const PointBatch& batch,
                                                const Eigen::Matrix<T, point_arguments, 1>& x,
                                                double t,
                                                const elements::WindInputs<T>* change) const;

  const model::Turbine& turbine_;
  std::vector<const Beam*> blades_;
  int rank_;
  Vector3 upward_;  ///< e1 is its part in the plane of the disk
  std::vector<elements::WakeShape> shapes_;
  std::vector<int> first_of_shape_;  ///< number of its first part
  std::vector<int> blocks_;          ///< first unknown of each group of parts
  int hub_port_ = -1;
  std::vector<int> root_ports_;
  int flow_port_ = -1;
  Connections flow_;
  std::vector<Connections> evolutions_;  ///< of each shape
  std::vector<Coupling> couplings_;
  std::vector<PointBatch> points_;
  std::vector<LinearShare> linear_;
};

extern template class Stated<RotorWake>;

}  // namespace samara::components
