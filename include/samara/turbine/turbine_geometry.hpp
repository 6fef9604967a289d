// The places of a turbine's parts in space: nodes along its beams and at its joints, joined by
// lines, for pictures and animations. Components in x y z of the ground, as the channels have them:
// x downwind at zero yaw, z up, y = z x x; the origin is the foot of the tower, or the tower top of
// a turbine without a tower.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "samara/turbine/turbine_system.hpp"

namespace samara::turbine {

struct GeometryNode {
  std::string part;  ///< "tower", "nacelle", "shaft", "hub", "blade 1"
  /// Fraction of the length of the beam; not-a-number on a rigid body.
  double station = std::numeric_limits<double>::quiet_NaN();
  /// Size of the section along its second and third axis, 0 on a rigid body [m]: the chord, where
  /// the blade has airfoils; otherwise that of a thin tube with the section's radii of gyration, of
  /// its stiffness, or of its mass where it does not bend or stretch, or a fiftieth of the length.
  double width = 0.0;
  double thickness = 0.0;
};

class TurbinePose;

class TurbineGeometry {
 public:
  /// The system must outlive the object.
  explicit TurbineGeometry(const TurbineSystem& system);

  /// Tower (foot, Gauss points, top), nacelle (tower top, bearing), shaft (bearing, teeter pin),
  /// hub (pin, apex), each blade (root, Gauss points, tip).
  const std::vector<GeometryNode>& nodes() const { return nodes_; }
  /// Nodes between which there is a part; from the apex to each root too.
  const std::vector<std::array<int, 2>>& lines() const { return lines_; }

  /// Places [m] and axes of the nodes in a state z at t. The axes are columns: on a beam its
  /// tangent, then the second and third axis of the section; of a body those that point as x y z
  /// at zero angles of the joints do.
  std::vector<elements::Pose<double>> poses(double t, const Eigen::VectorXd& z) const;

  /// Small motions about a state.
  class Motions {
   public:
    Motions(const TurbineGeometry& geometry, double t, const Eigen::VectorXd& steady);
    Motions(Motions&&) noexcept;
    ~Motions();
    /// Displacement [m] and rotation [rad] of each node, a column, for a small change of the state.
    Eigen::MatrixXcd of(const Eigen::Ref<const Eigen::VectorXcd>& z) const;

   private:
    const TurbineGeometry& geometry_;
    double t_;
    Eigen::VectorXd steady_;
    std::unique_ptr<const TurbinePose> pose_;
  };

 private:
  struct Place {
    int beam = -1;                          ///< blades, then tower; -1: a rigid body
    int node = -1;                          ///< in BeamPose::nodes; -1: the root on its base
    Matrix3 section = Matrix3::Identity();  ///< in the axes of the node
  };
  void add_beam(std::size_t beam, const model::Beam& definition);
  int add_body(const std::string& part);
  double width_of_air(std::size_t beam, int point) const;

  const TurbineSystem& system_;
  std::vector<GeometryNode> nodes_;
  std::vector<Place> places_;
  std::vector<std::array<int, 2>> lines_;
};

}  // namespace samara::turbine
