// A periodic state-space form as a constant one by harmonic lifting (docs/theory.md, section 10.5;
// G. W. Hill 1886; N. M. Wereley, "Analysis and control of linear periodically time varying
// systems", thesis, MIT, 1991).
#pragma once

#include "samara/linear/azimuth_series.hpp"

namespace samara::linear {

/// x = x0 + sum_j xc_j cos(j psi) + xs_j sin(j psi), j = 1 ... `harmonics`, with coefficients that
/// change in time, and likewise u and y. The result is the constant form of (x0, xc_1, xs_1, ...).
/// Products beyond the last harmonic are left out.
StateSpace hill_form(const AzimuthSeries& series, double rotor_speed, int harmonics);

/// Its A alone.
Eigen::MatrixXd hill_matrix(const AzimuthSeries& series, double rotor_speed, int harmonics);

}  // namespace samara::linear
