// Polars of airfoils on a common grid of angles, and the curves made from them
// (docs/theory.md, section 11).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "samara/elements/airfoil.hpp"
#include "samara/model/air_definition.hpp"

namespace samara::model {

/// Returns what is wrong with a polar, or an empty text. Angles may end up to 0.002 rad before -pi
/// and pi (some files hold them with three digits), and coefficients at both ends may differ by up
/// to 0.05.
std::string find_polar_fault(const PolarDefinition& polar);

/// Remarks on a polar without faults: ends that differ, negative drag, splines that leave the range
/// of their neighbouring points by more than 0.02, lift without a zero or slope for the airfoil
/// dynamics.
std::vector<std::string> find_polar_notes(const PolarDefinition& polar);

/// Angles of the common grid [rad]: every 0.25 degrees from -30 to 30, every degree beyond, from
/// -pi to pi.
const std::vector<double>& polar_grid();

/// The polar on the common grid, by linear interpolation. Both ends have the mean of the
/// coefficients at -pi and pi. It is a polar without faults.
PolarDefinition on_grid(const PolarDefinition& polar);

/// (1 - weight) a + weight b of two polars on the common grid. Its Reynolds number is not known.
PolarDefinition blend(const PolarDefinition& a, const PolarDefinition& b, double weight);

/// The polar of an airfoil at a Reynolds number, on the common grid: linear in its logarithm
/// between the polars of the airfoil, constant beyond the first and the last one. Polars without a
/// Reynolds number only count where no polar has one; then, and of several with the same one, the
/// first counts.
PolarDefinition polar_at(const AirfoilDefinition& airfoil, double reynolds);

/// Thickness and name of all airfoils that have a thickness, the thinnest first.
std::vector<std::pair<double, std::string>> sort_by_thickness(
    const std::map<std::string, AirfoilDefinition>& airfoils);

/// The curves of a polar on the common grid. `lift_slope`: replaces that of the polar [1/rad].
elements::AirfoilCurves make_curves(const PolarDefinition& polar,
                                    std::optional<double> lift_slope = std::nullopt);

/// The curves between two airfoils: (1 - weight) a + weight b, at a Reynolds number. A lift slope
/// that one of them states is blended with that of the other one.
elements::AirfoilCurves make_curves(const AirfoilDefinition& a, const AirfoilDefinition& b,
                                    double weight, double reynolds);

}  // namespace samara::model
