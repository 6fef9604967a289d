// Common parts of the importers' aerodynamics: names and polars of airfoils, places of sections.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "samara/math/types.hpp"
#include "samara/model/definition.hpp"

namespace samara::decks {

using Airfoils = std::map<std::string, model::AirfoilDefinition>;

/// A name that a case may have, made from that of a deck; other than those of `others`.
std::string name_airfoil(const std::string& text, const Airfoils& others);

/// Where the aerodynamic centre of a section is and where its leading edge points, in the axes b1
/// b2 b3 of the blade's root.
struct AeroPoint {
  Vector3 center = Vector3::Zero();    ///< [m]
  Vector3 forward = Vector3::UnitY();  ///< unit vector along the chord
};

/// Places sections on the reference line of a blade: each is in the plane across the line that
/// contains its aerodynamic centre. Chord and airfoil stay as they are.
class SectionPlacement {
 public:
  explicit SectionPlacement(const model::BeamDefinition& blade);
  void place(const AeroPoint& point, model::AeroSectionDefinition& section) const;

 private:
  const model::BeamDefinition& blade_;
};

/// Angles in rising order, each once: those that are the same to round-off count as one.
std::vector<double> merge_angles(std::vector<double> angles);

/// (1 - weight) a + weight b at all angles of both, linear between them.
model::PolarDefinition mix_polars(const model::PolarDefinition& a, const model::PolarDefinition& b,
                                  double weight);

/// The same for airfoils: at all their Reynolds numbers.
model::AirfoilDefinition mix_airfoils(const model::AirfoilDefinition& a,
                                      const model::AirfoilDefinition& b, double weight);

}  // namespace samara::decks
