// Discrete Fourier transform of many signals of any length (FFTW).
#pragma once

#include <memory>

#include <Eigen/Core>

namespace samara::math {

class FourierTransform {
 public:
  /// For `signals` signals of `samples` >= 1 samples each.
  FourierTransform(int signals, int samples);
  ~FourierTransform();
  FourierTransform(const FourierTransform&) = delete;
  FourierTransform& operator=(const FourierTransform&) = delete;

  /// signals x samples, to be filled before every run.
  Eigen::MatrixXcd& input();

  /// Coefficients (1/n) sum_m x_m exp(-2 pi i k m / n), k = 0 .. n - 1 (k > n/2 is k - n), samples
  /// x signals; they are valid until the next run.
  const Eigen::MatrixXcd& run();
  const Eigen::MatrixXcd& output() const;

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

}  // namespace samara::math
