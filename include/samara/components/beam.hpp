// A beam in a system (docs/theory.md, section 2).
//
// Rows, block by block. The block of a Gauss point has the strain and curvature balance of the node
// before it, its own kinematic rows, and the force and moment balance of the node behind it. The
// block of a beam end has the strain and curvature balance of the last node, its kinematic rows and
// the rows of its load. The root reactions have the force and moment balance of the first node.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "samara/components/component.hpp"
#include "samara/model/beam.hpp"

namespace samara::components {

/// A place where the rotations of two neighbours count from different references: the start of an
/// element. The curvature balance of the element needs the rotation before it in its own reference.
struct ReferenceChange {
  int element = 0;
  int row = 0;                     ///< first row of the curvature balance
  int mass = -1;                   ///< first unknown of the mass node before it; -1: none
  Vector3 turn = Vector3::Zero();  ///< reference before it relative to the one behind it
};

/// Attachment at the end of a beam.
enum class BeamEnd {
  free,     ///< has its tip mass and end support; the rows of the balance are the beam's own
  carries,  ///< carries bodies; another component has the rows of the balance
};

/// Data of a beam in a system.
struct BeamSetting {
  const model::Beam* mesh = nullptr;  ///< must outlive the component
  system::Owner owner;
  system::Frame frame = system::Frame::fixed;
  BeamEnd end = BeamEnd::free;
  const char* end_name = "tip";
  /// Directions of the motions that strains and curvatures restore. A shear strain has the
  /// direction of the bending that it causes.
  std::array<const char*, 6> directions{};
  std::string support_part;                         ///< name of the springs at the root
  std::array<const char*, 6> support_directions{};  ///< directions of the motions that they restore
  int rank = 0;                                     ///< elimination rank of the blocks
  int shared_rank = 0;                              ///< elimination rank of the root's reactions
  double speed = 0.0;       ///< rotor speed, which prescribed loads may follow [rad/s]
  bool root_moves = false;  ///< other than by a prescribed motion
  bool has_air = false;     ///< each point has a block for the unknowns of the air
};

/// Places of the unknowns of a beam.
struct PlacedBeam {
  const model::Beam* beam = nullptr;
  std::vector<int> points;  ///< first unknown of each point
  std::vector<int> masses;  ///< first unknown of each mass node
  std::vector<int> air;     ///< first unknown of the air at each point; empty: none
  int tip = 0;
  int root = 0;       ///< first of F_hat_0, M_hat_0
  int root_port = 0;  ///< motion of the root and gravity there: v_a, omega_a, g

  /// First row of the strain and curvature balance of local node a of the element of point p. A
  /// mass node has a separate balance for the element before it.
  int strain_rows(int p, int a) const;
  /// First row of the force and moment balance. A mass node has a separate balance for the element
  /// behind it.
  int force_rows(int p, int a) const;
  /// Weights of point p in the balances of local node a: w N_a' and w L N_a.
  std::array<double, 2> node_weights(int a, int p) const;
  /// Index of the mass node at end e of the elements; -1: none.
  int mass_at(int e) const;

  /// First row of the force and moment balance of the root, or of the mass between the beam and the
  /// springs of its support.
  int root_rows() const { return force_rows(0, 0); }
  /// First row of the force and moment balance of the end.
  int end_rows() const { return force_rows(beam->point_count() - 1, beam->order); }

  /// The places where references change.
  std::vector<ReferenceChange> find_changes() const;
};

class Beam final : public Stated<Beam> {
 public:
  explicit Beam(const BeamSetting& setting);

  const PlacedBeam& placed() const { return placed_; }

  void place(Registry& registry) override;
  void describe(Registry& registry) override;
  bool is_conservative() const override;

  template <class System>
  void state(System& system) const;

 private:
  template <class System>
  void state_points(System& system) const;
  template <class System>
  void state_ends(System& system) const;
  template <class System>
  void state_support(System& system) const;
  template <class System>
  void state_changes(System& system) const;
  template <class System>
  void state_loads(System& system) const;
  template <class System>
  void state_drag(System& system) const;

  void describe_unknowns(Registry& registry, int first, const std::string& place,
                         int from = 0) const;
  void describe_support(Registry& registry, int first) const;
  void describe_end_support(Registry& registry) const;
  void describe_mass(Registry& registry, int first, const Matrix6& mass) const;
  void describe_energies(Registry& registry, int p) const;

  void connect_points();
  void connect_ends();
  Connections connect_end(int first, int point, bool has_balance);
  void connect_support();
  void connect_changes();
  void connect_loads();
  void connect_drag();
  Argument motion_of_root() const { return port_values(placed_.root_port, 9); }

  /// Places of a load that one function serves: all places of a dead load, one place of a follower.
  struct LoadPart {
    const model::BeamLoad* load = nullptr;
    Matrix3 C_ab = Matrix3::Identity();  ///< section that a follower turns with
    Connections connections;
  };

  BeamSetting setting_;
  PlacedBeam placed_;
  std::vector<ReferenceChange> changes_;
  Vector3 end_reference_ = Vector3::Zero();  ///< rotation parameters of the tip's reference
  std::vector<Connections> points_;
  std::vector<Connections> masses_;
  Connections tip_;
  std::vector<Connections> change_connections_;
  std::vector<LoadPart> loads_;
  Connections end_force_;
  std::vector<Connections> drag_;
  std::vector<LinearShare> linear_;
};

extern template class Stated<Beam>;

}  // namespace samara::components
