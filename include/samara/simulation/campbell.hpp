// A Campbell diagram: the modes at the points of a sweep, joined to lines.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "samara/analysis/mode_tracking.hpp"
#include "samara/analysis/observer.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/simulation/scenario.hpp"
#include "samara/simulation/stability.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace samara::simulation {

/// Harmonics of a mode's energy on either side of its exponent.
inline constexpr int campbell_harmonics = 8;

/// Values of the swept quantities: of one, or of the two of a map.
struct SweepPlace {
  double value = 0.0;
  double second = std::numeric_limits<double>::quiet_NaN();  ///< not-a-number: of one quantity
};

/// Whether both belong to one row of a map, or to a sweep of one quantity.
bool are_in_a_row(const SweepPlace& a, const SweepPlace& b);

/// A mode at a point; values as those of analysis::Mode.
struct CampbellMode {
  std::complex<double> exponent;
  double fixed_frame_frequency = std::numeric_limits<double>::quiet_NaN();
  double error = 0.0;         ///< total_error
  double growth_error = 0.0;  ///< [1/s]
  Motion motion = Motion::decaying;
  bool is_rough = false;
  std::string name;
  int number = 0;  ///< among the modes of its name; 0: none
  /// Shares of the mean kinetic energy in the harmonics -campbell_harmonics ... of the rotor speed,
  /// counted from `exponent`; the sum may be less than 1.
  std::vector<double> participation;
};

/// The modes at a point of a sweep. Where there is no steady state, or its modes were not found,
/// `failure` is the reason, and there are no modes.
struct CampbellPoint {
  SweepPlace place;
  double rotor_speed = 0.0;                                      ///< [rad/s]
  double wind_speed = std::numeric_limits<double>::quiet_NaN();  ///< [m/s]; none without air
  double pitch = 0.0;                                            ///< [rad]
  int sectors = 1;  ///< identical ones of the rotor (system::RotorSymmetry)
  std::string failure;
  Stability stability = Stability::unknown;
  std::vector<std::string> notes;
  std::vector<CampbellMode> modes;  ///< those of `signatures`
  analysis::ModeSignatures signatures;
};

/// The modes about a steady state: all of them or as many as `options` want; at rest all. Sets
/// everything but `place`, `wind_speed` and `notes`. The ranks of `comm`, each with the whole
/// `system` and the same `trim`, share the work. The first one gets the point, others get its modes
/// without names, errors and shares of harmonics.
/// @throws ConvergenceError, DomainError, InputError from the analyses
CampbellPoint find_campbell_point(const turbine::TurbineSystem& system, const analysis::Trim& trim,
                                  const analysis::FloquetOptions& options, MPI_Comm comm,
                                  analysis::Observer& observer);

/// A mode over the points of a sweep.
struct CampbellLine {
  /// Most frequent number and name of its modes; shorter lines with the same have "(2)" behind it.
  std::string name;
  std::vector<analysis::TrackedMode> modes;
};

/// True for a mode that grows by more than its error, which is not too large.
bool is_growing(const CampbellMode& mode);
/// Number of such modes.
int count_growing(const CampbellPoint& point);

/// A place between two values of the first quantity where the number of growing modes changes.
struct StabilityEdge {
  double from = 0.0;
  double to = 0.0;
  double second = std::numeric_limits<double>::quiet_NaN();  ///< as in SweepPlace
  int growing_from = 0;
  int growing_to = 0;
  /// Modes of the point behind the edge that begin to grow here, or of the point before it that
  /// cease; -1: no further one, or one that is not known there.
  std::array<int, 4> modes{-1, -1, -1, -1};
};

/// Distance of the sides of a refined edge, relative to the larger value of the points beside it.
inline constexpr double edge_accuracy = 2e-5;

/// Indices of neighbouring points of a row. Points that failed are left out, and pairs with a point
/// at rest, where the modes change at once.
std::vector<std::pair<std::size_t, std::size_t>> find_neighbours(
    const std::vector<CampbellPoint>& points);

/// A range in which the mode of a line grows.
struct GrowthRange {
  double from = 0.0;  ///< refined edge, or value of the first point that grows
  double to = 0.0;
};

/// The ranges of a line of a sweep of one quantity, in the order of its points. A refined edge
/// applies if it has the mode of the line, or if it is the only one between two points and the
/// growing modes at both its sides are as many as at the points.
std::vector<GrowthRange> find_growth(const std::vector<CampbellPoint>& points,
                                     const CampbellLine& line,
                                     const std::vector<StabilityEdge>& edges);

/// Names the lines and sorts them: by the frequency in the middle of each line, those of the same
/// name in their order. A point at rest has no influence on a name, if the line has others: modes
/// that differ only in the phase between the blades have equal exponents there.
std::vector<CampbellLine> name_lines(const std::vector<CampbellPoint>& points,
                                     const std::vector<std::vector<analysis::TrackedMode>>& lines);

}  // namespace samara::simulation
