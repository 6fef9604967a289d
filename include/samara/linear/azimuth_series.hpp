// State-space forms over the azimuth in closed form (docs/theory.md, section 10.3).
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "samara/linear/linear_model.hpp"

namespace samara::linear {

/// Sampling and length of a series.
struct SeriesResolution {
  int azimuths = 24;
  bool automatic_azimuths = true;   ///< as many as the residual needs, instead
  int harmonics = 8;                ///< at most (azimuths - 1)/2
  bool automatic_harmonics = true;  ///< all that are not small, instead
  double tolerance = 1e-6;          ///< residual that is small enough
};

/// A0 + sum_k Ac_k cos(k psi) + As_k sin(k psi), and likewise B, C, D.
class AzimuthSeries {
 public:
  /// Samples `form` at `azimuths` >= 2 `harmonics` + 1 places psi_i = 2 pi i / azimuths, and midway
  /// between some of them for the residual. For a form that does not change, 1 azimuth and 0
  /// harmonics are enough.
  AzimuthSeries(const std::function<StateSpace(double)>& form, int azimuths, int harmonics);

  /// Chooses what `resolution` leaves open. Azimuths: 12, 24, ... at most `most_azimuths`, until
  /// the residual is at most the tolerance, or round-off. Harmonics: the fewest of those that the
  /// azimuths resolve whose tail is below a tenth of it. `form` is asked for the same azimuths
  /// again. `begin` is told the azimuths of each series that is tried.
  static AzimuthSeries resolve(
      const std::function<StateSpace(double)>& form, const SeriesResolution& resolution,
      const std::function<void(int)>& begin = [](int) {});
  static constexpr int most_azimuths = 768;
  /// Places midway between azimuths at which a series is compared with the form.
  static constexpr int comparisons = 4;

  /// Series of given coefficients, A0 Ac_1 As_1 Ac_2 ..., with the residual of their fit.
  explicit AzimuthSeries(std::vector<StateSpace> coefficients, double residual = 0.0)
      : coefficients_(std::move(coefficients)), residual_(residual) {}

  int harmonics() const { return (static_cast<int>(coefficients_.size()) - 1) / 2; }
  /// A0, Ac_1, As_1, Ac_2, ...
  const std::vector<StateSpace>& coefficients() const { return coefficients_; }
  const StateSpace& mean() const { return coefficients_.front(); }
  /// The forms that were sampled, at psi_i.
  const std::vector<StateSpace>& samples() const { return samples_; }
  const std::vector<double>& azimuths() const { return azimuths_; }

  StateSpace at(double psi) const;
  /// A alone.
  Eigen::MatrixXd state_matrix(double psi) const;

  /// Largest difference of an entry of A, B, C, D of the series from the form midway between the
  /// samples, relative to the geometric mean of the largest entries of its row and its column at
  /// any azimuth.
  double residual() const { return residual_; }
  /// Largest part that changes with the azimuth, measured the same way.
  double variation() const;

 private:
  std::vector<double> azimuths_;
  std::vector<StateSpace> samples_;
  std::vector<StateSpace> coefficients_;
  double residual_ = 0.0;

  /// Number of harmonics without those at the end whose sizes, measured as the residual is, add up
  /// to at most `limit`.
  int harmonics_above(double limit) const;
};

}  // namespace samara::linear
