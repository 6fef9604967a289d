#include "hill_pencil.hpp"

#include <algorithm>

namespace samara::analysis {

using Index = Eigen::Index;

HillPencil::HillPencil(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                       int harmonics)
    : tangents_(system, {}, harmonics, true), preconditioner_(tangents_) {
  tangents_.sample(solution);
  tangents_.scale(0.0, rows_, columns_);
}

/// exp(i k Omega t) = cos + i sin: the coefficient of cos is z_k + z_-k, that of sin i (z_k -
/// z_-k).
void HillPencil::to_coefficients(Complex s, const Vector& x) {
  const Eigen::Map<const Eigen::MatrixXcd> series(x.data(), width(), unknowns());
  const Index H = harmonics();
  for (Parts* parts : {&values_, &rates_}) {
    parts->real.resize(width(), unknowns());
    parts->imaginary.resize(width(), unknowns());
  }
  const auto put = [](Complex forward, Complex backward, Index k, Index i, Parts& parts) {
    const Complex sum = forward + backward;
    const Complex difference = forward - backward;
    parts.real(2 * k - 1, i) = sum.real();
    parts.imaginary(2 * k - 1, i) = sum.imag();
    parts.real(2 * k, i) = -difference.imag();
    parts.imaginary(2 * k, i) = difference.real();
  };
  for (Index i = 0; i < unknowns(); ++i) {
    const double factor = columns_(i * width());
    const Complex mean = factor * series(H, i);
    values_.real(0, i) = mean.real();
    values_.imaginary(0, i) = mean.imag();
    rates_.real(0, i) = (s * mean).real();
    rates_.imaginary(0, i) = (s * mean).imag();
    for (Index k = 1; k <= H; ++k) {
      const Complex turn(0.0, static_cast<double>(k) * speed());
      const Complex forward = factor * series(H + k, i);
      const Complex backward = factor * series(H - k, i);
      put(forward, backward, k, i, values_);
      put((s + turn) * forward, (s - turn) * backward, k, i, rates_);
    }
  }
}

namespace {

/// Series from coefficients of mean, cosines and sines: z_k = (c - i s) / 2, z_-k = (c + i s) / 2.
void add_series(const Eigen::MatrixXd& real, const Eigen::MatrixXd& imaginary,
                const Eigen::VectorXd& rows, std::complex<double> factor, Eigen::VectorXcd& y) {
  const Index width = real.rows();
  const Index H = (width - 1) / 2;
  for (Index i = 0; i < real.cols(); ++i) {
    const std::complex<double> scale = factor * rows(i * width);
    auto series = y.segment(i * width, width);
    series(H) += scale * std::complex<double>(real(0, i), imaginary(0, i));
    for (Index k = 1; k <= H; ++k) {
      const std::complex<double> cosine(real(2 * k - 1, i), imaginary(2 * k - 1, i));
      const std::complex<double> turned(-imaginary(2 * k, i), real(2 * k, i));  // i times the sine
      series(H + k) += scale * 0.5 * (cosine - turned);
      series(H - k) += scale * 0.5 * (cosine + turned);
    }
  }
}

}  // namespace

void HillPencil::multiply(Complex s, const Vector& x, Vector& y) {
  to_coefficients(s, x);
  tangents_.multiply(values_.real, rates_.real, products_.real);
  tangents_.multiply(values_.imaginary, rates_.imaginary, products_.imaginary);
  y.setZero(size());
  add_series(products_.real, products_.imaginary, rows_, 1.0, y);
}

void HillPencil::multiply_mass(const Vector& x, Vector& y) {
  to_coefficients(0.0, x);
  tangents_.multiply_mass(values_.real, products_.real);
  tangents_.multiply_mass(values_.imaginary, products_.imaginary);
  y.setZero(size());
  add_series(products_.real, products_.imaginary, rows_, 1.0, y);
}

HillPencil::Complex HillPencil::exponent_of(const Vector& x) {
  Vector stiffness;
  Vector mass;
  multiply(0.0, x, stiffness);
  multiply_mass(x, mass);
  return -mass.dot(stiffness) / mass.squaredNorm();
}

void HillPencil::precondition(const Vector& right, Vector& x) {
  Eigen::MatrixXcd solution;
  preconditioner_.solve(Eigen::Map<const Eigen::MatrixXcd>(right.data(), width(), unknowns()),
                        solution);
  x = Eigen::Map<const Vector>(solution.data(), solution.size());
}

void HillPencil::drop_absent(Vector& x) const {
  if (sectors() == 1) return;
  for (Index i = 0; i < unknowns(); ++i)
    for (int k = -harmonics(); k <= harmonics(); ++k)
      if (!tangents_.has(i, k)) x(i * width() + k + harmonics()) = 0.0;
}

Eigen::MatrixXcd HillPencil::series_of(const Vector& x) const {
  Eigen::MatrixXcd series = Eigen::Map<const Eigen::MatrixXcd>(x.data(), width(), unknowns());
  for (Index i = 0; i < unknowns(); ++i) series.col(i) *= columns_(i * width());
  return tangents_.whole(series);
}

HillPencil::Vector HillPencil::vector_of(const Eigen::MatrixXcd& whole) const {
  const Eigen::MatrixXcd series = tangents_.part(whole);
  const Index other = (series.rows() - 1) / 2;
  const Index common = std::min<Index>(other, harmonics());
  Vector x = Vector::Zero(size());
  for (Index i = 0; i < unknowns(); ++i)
    x.segment(i * width() + harmonics() - common, 2 * common + 1) =
        series.col(i).segment(other - common, 2 * common + 1) / columns_(i * width());
  return x;
}

}  // namespace samara::analysis
