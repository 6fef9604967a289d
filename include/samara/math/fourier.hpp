// Discrete Fourier transform of many signals of any length (FFTW).
#pragma once

#include <Eigen/Core>
#include <memory>

namespace samara::math {

class FourierTransform {
 public:
  /// For `signals` signals of `samples` >= 1 samples each.
  FourierTransform(int signals, int samples);
  ~FourierTransform();
  FourierTransform(const FourierTransform&) = delete;
  FourierTransform& operator=(const FourierTransform&) = delete;

  /// Coefficients (1/n) sum_m x_m exp(-2 pi i k m / n), k = 0 .. n - 1 (k > n/2 is k - n).
  /// `history`: signals x samples; result: samples x signals.
  Eigen::MatrixXcd operator()(const Eigen::MatrixXcd& history);

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

}  // namespace samara::math
