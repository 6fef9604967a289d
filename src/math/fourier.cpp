#include "samara/math/fourier.hpp"

#include <fftw3.h>

namespace samara::math {

struct FourierTransform::Plan {
  Plan(int signals, int samples) : input(signals, samples), output(samples, signals) {
    plan = fftw_plan_many_dft(1, &samples, signals, data(input), nullptr, signals, 1, data(output),
                              nullptr, 1, samples, FFTW_FORWARD, FFTW_ESTIMATE);
  }
  ~Plan() { fftw_destroy_plan(plan); }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  /// FFTW's complex number has the layout of std::complex<double>.
  static fftw_complex* data(Eigen::MatrixXcd& values) {
    return reinterpret_cast<fftw_complex*>(values.data());
  }

  Eigen::MatrixXcd input, output;
  fftw_plan plan = nullptr;
};

FourierTransform::FourierTransform(int signals, int samples)
    : plan_(std::make_unique<Plan>(signals, samples)) {}

FourierTransform::~FourierTransform() = default;

Eigen::MatrixXcd& FourierTransform::input() { return plan_->input; }

const Eigen::MatrixXcd& FourierTransform::run() {
  fftw_execute(plan_->plan);
  plan_->output /= static_cast<double>(plan_->input.cols());
  return plan_->output;
}

const Eigen::MatrixXcd& FourierTransform::output() const { return plan_->output; }

}  // namespace samara::math
