// The rigid bodies between tower and blades (docs/theory.md, section 3; Lee, Hodges & Patil (2002),
// eq. (8), (9)): tower top T, yaw q_y about t3, nacelle Y, tilted shaft bearing, low-speed end L of
// the generator's gear turned by psi + q_g about s2, shaft S turned by q_s relative to L (torsion),
// teeter q_h about the hinge axis e of S and H, hub H. psi is the azimuth at constant speed.
// Relative to the nacelle the generator turns n times as fast as L; n is its gear ratio.
//
// Generalized speeds: U1 = omega_Y.y3, U2 = omega_H.e, U3..5 = omega_T in t1 t2 t3, U6..8 = v_T in
// t1 t2 t3, U_g = omega_L.s2, U_s = omega_S.s2.
#pragma once

#include "samara/elements/rigid_tree.hpp"
#include "samara/elements/torque_line.hpp"

namespace samara::elements {

struct Hinge {
  bool free = false;
  double stiffness = 0.0;  ///< [N m/rad]
  double damping = 0.0;    ///< [N m s/rad]
  /// Stops: a second spring and damper beyond this angle in both senses; 0: no stops [rad].
  double stop_angle = 0.0;
  double stop_stiffness = 0.0;  ///< [N m/rad]
  double stop_damping = 0.0;    ///< [N m s/rad]
};

struct RigidChain {
  double gravity = 0.0;  ///< along -n3 [m/s^2]
  Hinge yaw;
  Hinge generator;              ///< angle of L beside psi
  TorqueLine generator_torque;  ///< against the rotation, over the generator's speed relative to
                                ///< the nacelle
  double brake_torque = 0.0;    ///< on the generator, against its rotation in either sense [N m]
  double gear_ratio = 1.0;  ///< n: generator revolutions per revolution of L; < 0: opposite sense
  TorqueLine rotor_torque;  ///< on H along h2, over omega_H . h2
  Hinge torsion;
  Hinge teeter;
  RigidBody tower_top;                     ///< reference point: tower top; axes t1 t2 t3
  RigidBody nacelle;                       ///< reference point: tower top; axes y1 y2 y3
  double generator_inertia = 0.0;          ///< J_g, about its own axis, which is along s2 [kg m^2]
  RigidBody shaft;                         ///< reference: yaw axis on the shaft; axes s1 s2 s3
  RigidBody hub;                           ///< reference: teeter pin; axes h1 h2 h3
  double height = 0.0;                     ///< tower top to shaft axis, along y3 [m]
  double tilt = 0.0;                       ///< > 0 raises s2 [rad]
  double overhang = 0.0;                   ///< yaw axis to teeter pin along s2 [m]
  double undersling = 0.0;                 ///< teeter pin to apex along h2 [m]
  Vector3 teeter_axis = Vector3::UnitX();  ///< e, fixed in S and in H

  /// Speed of the generator per speed of L, in the generator's own sense of rotation: |n|.
  double gear() const;
};

/// Nodes of the tree of a chain: its base is the tower top.
enum ChainNode { yaw_node, generator_node, torsion_node, teeter_node, chain_nodes };

/// The tree of joints of a chain, with the bodies behind them: nacelle, low-speed end, shaft and
/// hub.
RigidTree tree_of(const RigidChain& chain);

}  // namespace samara::elements
