// Mode shapes as Fourier series (docs/theory.md, sections 5.12 and 5.13).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "samara/analysis/mode.hpp"

namespace samara::analysis {

/// The shape of mode m without the wave of its identified harmonic: size x samples. Its harmonics
/// count from the exponent of the mode.
Eigen::MatrixXcd centred_shape(const ModeSet& set, std::size_t m);

/// Number of harmonics that as many samples determine by least squares, `most` at most.
int harmonics_of_samples(std::size_t samples, int most);

/// samples x (2 H + 1): values at `times` times this matrix are the harmonics from -H to H, by
/// least squares (the samples need not be at equal distances).
Eigen::MatrixXcd harmonics_fit(const std::vector<double>& times, double rotor_speed, int harmonics);

}  // namespace samara::analysis
