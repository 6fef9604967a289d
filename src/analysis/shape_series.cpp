#include "shape_series.hpp"

#include <algorithm>
#include <complex>

#include <Eigen/QR>

namespace samara::analysis {
namespace {

/// Samples for each harmonic in the fit.
constexpr int samples_a_harmonic = 3;

}  // namespace

Eigen::MatrixXcd centred_shape(const ModeSet& set, std::size_t m) {
  Eigen::MatrixXcd shape = set.shapes[m];
  for (Eigen::Index s = 0; s < shape.cols(); ++s)
    shape.col(s) *= std::polar(1.0, -set.modes[m].harmonic * set.rotor_speed *
                                        set.shape_times[static_cast<std::size_t>(s)]);
  return shape;
}

int harmonics_of_samples(std::size_t samples, int most) {
  return std::min(most, (static_cast<int>(samples) - 1) / samples_a_harmonic);
}

Eigen::MatrixXcd harmonics_fit(const std::vector<double>& times, double rotor_speed,
                               int harmonics) {
  Eigen::MatrixXcd waves(2 * harmonics + 1, static_cast<Eigen::Index>(times.size()));
  for (Eigen::Index s = 0; s < waves.cols(); ++s)
    for (int k = -harmonics; k <= harmonics; ++k)
      waves(k + harmonics, s) =
          std::polar(1.0, k * rotor_speed * times[static_cast<std::size_t>(s)]);
  return waves.completeOrthogonalDecomposition().pseudoInverse();
}

}  // namespace samara::analysis
