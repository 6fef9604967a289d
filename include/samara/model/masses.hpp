// Masses, centres and inertias of a turbine from its definition. Beams are integrated by Gauss
// quadrature from station to station (exact for properties that are linear between stations).
#pragma once

#include <vector>

#include "samara/model/definition.hpp"
#include "samara/model/turbine.hpp"

namespace samara::model {

/// Mass, first and second moments about the origin of some axes.
struct MassProperties {
  double mass = 0.0;                  ///< [kg]
  Vector3 moment = Vector3::Zero();   ///< mass times centre [kg m]
  Matrix3 inertia = Matrix3::Zero();  ///< [kg m^2]

  Vector3 center() const { return mass > 0.0 ? Vector3(moment / mass) : Vector3::Zero(); }
  /// The same in the axes that C maps to, about a point from which the origin is at r (in those
  /// axes).
  MassProperties placed(const Matrix3& C, const Vector3& r) const;
  MassProperties& operator+=(const MassProperties& other);
};

struct Masses {
  MassProperties tower;                ///< n1 n2 n3, about the foot
  MassProperties nacelle;              ///< y1 y2 y3, about the tower top
  MassProperties shaft;                ///< s1 s2 s3, about the yaw axis
  MassProperties hub;                  ///< h1 h2 h3, about the teeter pin
  std::vector<MassProperties> blades;  ///< b1 b2 b3 of the root, about the root
  MassProperties rotor;                ///< hub and blades, h1 h2 h3, about the teeter pin
  MassProperties meshed_rotor;  ///< the same, with the masses of elements at their Gauss points
  MassProperties whole;         ///< n1 n2 n3, about the foot, at rest
};

Masses compute_masses(const TurbineDefinition& definition, const Turbine& turbine);

}  // namespace samara::model
