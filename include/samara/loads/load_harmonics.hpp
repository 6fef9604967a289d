// Harmonics of the rotor speed in the channels of a time series (docs/theory.md, section 8.2).
#pragma once

#include "samara/loads/load_series.hpp"

namespace samara::loads {

/// y = sum_k amplitude_k cos(k azimuth + phase_k), harmonic x channel.
struct LoadHarmonics {
  Eigen::MatrixXd amplitudes;  ///< in the unit of the channel; >= 0 but for k = 0, the mean
  Eigen::MatrixXd phases;      ///< [rad], -pi to pi; 0 for k = 0
  int revolutions = 0;         ///< number of revolutions used, the last whole ones
  Eigen::Index first_row = 0;  ///< of these revolutions, which end with the time series
};

/// Harmonics 0 ... `harmonics` by least squares over the last whole revolutions, weighted by
/// azimuth (trapezoidal rule); the azimuth may advance unevenly. The result is exact for a sum of
/// these harmonics, and close to Fourier's integrals if there are others. `azimuth_deg` [deg] has
/// one value for each row and grows; it may jump back by 360 deg, if no step is larger than 180
/// deg. Rows before the azimuth begins to grow are left out. A periodic time series is one
/// revolution.
/// @throws InputError where there is not one whole revolution, or too few rows for the harmonics;
/// otherwise as `check` of the time series.
LoadHarmonics compute_harmonics(const LoadSeries& series, const Eigen::VectorXd& azimuth_deg,
                                int harmonics);

}  // namespace samara::loads
