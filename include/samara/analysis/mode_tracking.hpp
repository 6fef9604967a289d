// The same mode at the points of a sweep, by its shape over a period (docs/theory.md,
// section 5.12).
#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "samara/analysis/mode.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Shapes of the modes of one system, for comparison with those of a similar one. A shape is the
/// factor u(psi) of the motion u(psi) exp(lambda t), with the exponent lambda of Mode::exponent and
/// psi = Omega t, in signals whose sum of squares is twice the energy, kinetic and of strains: one
/// for each unknown.
struct ModeSignatures {
  double rotor_speed = 0.0;                     ///< Omega [rad/s]; 0: shapes are constant
  std::vector<std::size_t> modes;               ///< their indices in ModeSet::modes
  std::vector<std::complex<double>> exponents;  ///< of Mode::exponent
  /// Per mode, signals x harmonics from -H to H of the shape, one column at rest. The mean square
  /// over a revolution is 1.
  std::vector<Eigen::MatrixXcf> shapes;
};

/// The resolved modes of motions: without exponents of the air, and without exponents that count as
/// zero and motions that have no energy. `set` has its shapes.
ModeSignatures find_signatures(const system::PeriodicSystem& system, const ModeSet& set);

/// A mode `from` of one set of signatures that is the mode `to` of another one (indices in
/// ModeSignatures::modes): u_to(psi) is proportional to exp(i shift psi) times u_from(psi), or
/// times its conjugate.
struct ModeLink {
  std::size_t from = 0;
  std::size_t to = 0;
  bool is_conjugate = false;
  int shift = 0;
  /// 1 for the same shape, 0 for a shape that the other one's left eigenvector does not see; that
  /// of modes with equal multipliers adds up.
  double likeness = 0.0;
};

/// Assigns the modes of both sets to each other. The likeness of two modes is the modulus of the
/// product of the left periodic eigenvector of each with the right one of the other, averaged over
/// the azimuth: it does not depend on their scales. The assignment has the largest sum of
/// likenesses; the exponents of a pair are not far from each other. Where one rotor is at rest, the
/// shapes at psi = 0 are compared.
/// `wanted_from`, `wanted_to`: the modes to assign; empty: all.
/// @throws InputError where both sets do not have the same signals
std::vector<ModeLink> link_modes(const ModeSignatures& from, const ModeSignatures& to,
                                 const std::vector<bool>& wanted_from = {},
                                 const std::vector<bool>& wanted_to = {});

/// A mode of a line at one point. The line follows one copy of the exponent:
/// lambda + i shift Omega, or conj(lambda) + i shift Omega, with lambda of Mode::exponent.
struct TrackedMode {
  std::size_t point = 0;  ///< number given to ModeTracker::add
  std::size_t mode = 0;   ///< index in ModeSet::modes
  bool is_conjugate = false;
  int shift = 0;
  double likeness = 1.0;  ///< to the point before on the line; 1 at its first point
};

/// Exponent of the copy that a line follows [rad/s].
std::complex<double> tracked_exponent(std::complex<double> exponent, const TrackedMode& tracked,
                                      double rotor_speed);

/// Damping ratio -Re / |lambda| of that copy; 0 for lambda = 0.
double tracked_damping(std::complex<double> exponent, const TrackedMode& tracked,
                       double rotor_speed);

/// Joins the modes of consecutive points to lines.
class ModeTracker {
 public:
  /// A smaller likeness does not continue a line.
  static constexpr double least_likeness = 0.2;
  /// With a smaller likeness another mode may be as close.
  static constexpr double clear_likeness = 0.6;

  /// Takes the next point. A line that has no mode at the last point may go on from an earlier one.
  /// @throws InputError as link_modes
  void add(std::size_t point, ModeSignatures next);

  /// The lines, each a list of modes at ascending points. The copy that a line follows is the one
  /// of Mode::exponent at most of its points.
  std::vector<std::vector<TrackedMode>> lines() const;

 private:
  struct Point {
    std::size_t number = 0;
    ModeSignatures signatures;
    std::vector<std::size_t> line_of;  ///< per mode
  };
  /// Per mode, whether it is the last one on its line.
  std::vector<bool> ends_at(const Point& point) const;
  void extend(const Point& before, Point& next, const std::vector<ModeLink>& links);

  std::vector<Point> before_;  ///< the last point, and before it others where lines end
  std::vector<std::vector<TrackedMode>> lines_;
};

}  // namespace samara::analysis
