// What the user asks of the analyses (the keys `trim` and `floquet` of a case file).
#pragma once

namespace samara::analysis {

enum class TrimMethod { harmonic_balance, shooting };

struct TrimOptions {
  TrimMethod method = TrimMethod::harmonic_balance;
  int harmonics = 4;             ///< H >= 0 of (15)
  bool automatic = false;        ///< raise H until the residual between the samples is small
  double tolerance = 1e-10;      ///< relative, of the nonlinear solve
  double auto_tolerance = 1e-6;  ///< of the residual between the samples, relative to the loads
  int steps = 500;               ///< steps a revolution of the shooting method
};

enum class FloquetPeriod { automatic, full, blade };

struct FloquetOptions {
  int steps = 500;  ///< steps of (19) a revolution
  FloquetPeriod period = FloquetPeriod::automatic;
};

}  // namespace samara::analysis
