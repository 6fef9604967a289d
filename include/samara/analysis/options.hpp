// Options of the analyses (the keys `trim`, `floquet`, `static` and `transient` of a
// case file).
#pragma once

#include <optional>

namespace samara::analysis {

enum class TrimMethod { harmonic_balance, shooting };

struct TrimOptions {
  TrimMethod method = TrimMethod::harmonic_balance;
  int harmonics = 4;             ///< H >= 0 of (15)
  int least_harmonics = 0;       ///< highest harmonic of the prescribed loads, lower limit of H
  bool automatic = false;        ///< raise H until the residual between the samples is small
  double tolerance = 1e-10;      ///< of the nonlinear solve, relative
  double auto_tolerance = 1e-6;  ///< of the residual between the samples, relative to the loads
  int steps = 500;               ///< steps per revolution of the shooting method
  /// Next to a known steady state, leaves out the residuals beside the equations that are solved,
  /// which then are 0, and with `automatic` the check of the number of harmonics: for the steps of
  /// a search. Its result needs a trim that is no draft.
  bool is_draft = false;
};

enum class FloquetPeriod { automatic, full, blade };

/// The way to some modes: Hill's method for these alone, or all modes, of which they are taken.
enum class ModeSearch { automatic, all, hill };

struct FloquetOptions {
  /// Per revolution; 0: as many as the ten slowest modes need, and at least some (theory 5.1).
  int steps = 0;
  FloquetPeriod period = FloquetPeriod::automatic;
  int order = 6;  ///< of the steps: 2, 4 or 6; 2 is (19)
  /// Largest error by the time steps of a resolved mode, relative.
  std::optional<double> accuracy = {};
  int modes = 0;                       ///< number of modes; 0: all, by integration over a period
  std::optional<double> near_hz = {};  ///< the modes nearest to this frequency, not the slowest
  /// Number of modes of slowest decay. Hill's method alone finds them by integration of a block of
  /// columns, but in a medium by a search without its states.
  int least_damped = 0;
  ModeSearch search = ModeSearch::automatic;  ///< of `modes` or `least_damped`
};

/// Whether not all modes are asked for.
inline bool asks_for_some(const FloquetOptions& options) {
  return options.modes > 0 || options.least_damped > 0;
}

enum class StaticMethod { load, arc_length };

struct StaticOptions {
  StaticMethod method = StaticMethod::load;
  int steps = 10;           ///< of the load factor from 0 to 1; arc length: the first is 1/steps
  double tolerance = 1e-9;  ///< of the last Newton correction, relative to the solution
  int most_steps = 1000;    ///< largest number on the path, cut ones included
};

enum class TransientMethod { bdf2, midpoint };

struct TransientOptions {
  TransientMethod method = TransientMethod::bdf2;
  double duration = 0.0;      ///< [s], > 0
  double step = 0.0;          ///< [s], > 0; with a step_tolerance: the longest step
  double tolerance = 1e-9;    ///< of the last Newton correction's error, relative to the state
  long checkpoint_steps = 0;  ///< steps between checkpoints; 0: none
  /// Tolerance of a step's error in every position, absolute [m, rad] and relative; 0: constant
  /// steps.
  double step_tolerance = 0.0;
  std::optional<double> stop_at;  ///< [s], time of an earlier end of the run
};

}  // namespace samara::analysis
