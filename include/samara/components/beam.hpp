// A beam in a system (docs/theory.md, section 2).
//
// Rows, block by block. A Gauss point's block has the strain and curvature balance of the node
// before it, its own kinematic rows and the force and moment balance of the node behind it; a beam
// end has the strain and curvature of the last node, its kinematic rows and what its load must be;
// the root reactions have the force and moment of the first node.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "samara/components/component.hpp"
#include "samara/model/beam.hpp"

namespace samara::components {

/// Where the rotations of two neighbours count from different references: the start of an element,
/// whose balance of curvature asks for the rotation of what is before it, expressed anew.
struct ReferenceChange {
  int element = 0;
  int row = 0;                     ///< of the balance
  int mass = -1;                   ///< first unknown of the mass node before it; -1: none
  Vector3 turn = Vector3::Zero();  ///< reference before it, as seen from the one behind it
};

/// Attachment at the end of a beam.
enum class BeamEnd {
  free,     ///< its tip mass and end support: the balance is the beam's own
  carries,  ///< bodies: another component has the rows of the balance
};

/// Data of a beam in a system.
struct BeamSetting {
  const model::Beam* mesh = nullptr;  ///< must live on
  system::Owner owner;
  system::Frame frame = system::Frame::fixed;
  BeamEnd end = BeamEnd::free;
  const char* end_name = "tip";
  /// Motions that strains and curvatures restore; shear counts to the bending that it causes.
  std::array<const char*, 6> directions{};
  std::string support_part;                         ///< of the root's springs
  std::array<const char*, 6> support_directions{};  ///< the motions they restore
  int rank = 0;                                     ///< of elimination: of its blocks
  int shared_rank = 0;                              ///< of the root's reactions
  double speed = 0.0;       ///< of the rotor, which prescribed loads may follow [rad/s]
  bool root_moves = false;  ///< other than as prescribed
};

/// Where the unknowns of a beam are.
struct PlacedBeam {
  const model::Beam* beam = nullptr;
  std::vector<int> points;  ///< first unknown of each point
  std::vector<int> masses;  ///< first unknown of each mass node
  int tip = 0;
  int root = 0;       ///< first of F_hat_0, M_hat_0
  int root_port = 0;  ///< of the motion of the root and the gravity there: v_a, omega_a, g

  /// First row of the strain and curvature balance of local node a of the element of point p. A
  /// mass node has a balance of its own for the element before it.
  int strain_rows(int p, int a) const;
  /// First row of the force and moment balance. A mass node has one for the element behind it.
  int force_rows(int p, int a) const;
  /// Weights of point p in the balances of local node a: w N_a' and w L N_a.
  std::array<double, 2> node_weights(int a, int p) const;
  /// The mass node at end e of the elements, -1 where there is none.
  int mass_at(int e) const;

  /// First row of the force and moment balance of the root: its own, or that of the mass between
  /// the beam and the springs of its support.
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

  /// A load as one function turns it: a dead one at all its places, a follower at one.
  struct LoadPart {
    const model::BeamLoad* load = nullptr;
    Matrix3 C_ab = Matrix3::Identity();  ///< of the section that a follower turns with
    Connections connections;
  };

  BeamSetting setting_;
  PlacedBeam placed_;
  std::vector<ReferenceChange> changes_;
  Vector3 end_reference_ = Vector3::Zero();  ///< parameters of that of the tip
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
