#include "hill_pencil.hpp"

#include <algorithm>

namespace samara::analysis {
namespace {

/// Ratio of rates whose scales are alike.
constexpr double most_unlike = 2.0;

}  // namespace

using Index = Eigen::Index;

HillPencil::HillPencil(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                       int harmonics, bool by_sector)
    : tangents_(system, harmonics, by_sector),
      preconditioner_(tangents_),
      medium_(tangents_, rows_, columns_) {
  tangents_.sample(solution);
  take_rate(tangents_.highest_rate());
}

void HillPencil::take_rate(double rate) {
  rate_ = rate;
  tangents_.scale(0.0, rate, rows_, columns_);
  shift_.reset();
}

void HillPencil::fit_scales(double rate) {
  const double wanted = std::max(rate, speed());
  if (harmonics() == 0 && std::max(wanted / rate_, rate_ / wanted) > most_unlike) take_rate(wanted);
}

/// exp(i k Omega t) = cos + i sin: the coefficient of cos is z_k + z_-k, that of sin i (z_k -
/// z_-k). Real parts come first, then imaginary parts.
void HillPencil::to_coefficients(Input x, bool is_rate, Eigen::MatrixXd& to) const {
  const Index H = harmonics();
  const Index count = x.cols() * unknowns();
  const Eigen::Map<const Eigen::MatrixXcd> series(x.data(), width(), count);
  for (Index i = 0; i < count; ++i) {
    const double factor = columns_(i % unknowns() * width());
    auto real = to.col(i);
    auto imaginary = to.col(count + i);
    if (!is_rate) {
      real(0) += factor * series(H, i).real();
      imaginary(0) += factor * series(H, i).imag();
    }
    for (Index k = 1; k <= H; ++k) {
      // d/dt is i k Omega for z_k and -i k Omega for z_-k.
      const double scale = is_rate ? factor * static_cast<double>(k) * speed() : factor;
      const Complex plus = scale * (series(H + k, i) + series(H - k, i));
      const Complex minus = scale * (series(H + k, i) - series(H - k, i));
      const Complex cosine = is_rate ? Complex(-minus.imag(), minus.real()) : plus;
      const Complex sine = is_rate ? -plus : Complex(-minus.imag(), minus.real());
      real(2 * k - 1) += cosine.real();
      imaginary(2 * k - 1) += cosine.imag();
      real(2 * k) += sine.real();
      imaginary(2 * k) += sine.imag();
    }
  }
}

/// z_k = (c - i s) / 2, z_-k = (c + i s) / 2.
void HillPencil::to_series(const Eigen::MatrixXd& coefficients, Output y) const {
  const Index H = harmonics();
  const Index count = coefficients.cols() / 2;
  Eigen::Map<Eigen::MatrixXcd> series(y.data(), width(), count);
  for (Index i = 0; i < count; ++i) {
    const double scale = rows_(i % unknowns() * width());
    const auto real = coefficients.col(i);
    const auto imaginary = coefficients.col(count + i);
    series(H, i) = scale * Complex(real(0), imaginary(0));
    for (Index k = 1; k <= H; ++k) {
      const Complex cosine(real(2 * k - 1), imaginary(2 * k - 1));
      const Complex turned(-imaginary(2 * k), real(2 * k));  // i times the sine
      series(H + k, i) = scale * 0.5 * (cosine - turned);
      series(H - k, i) = scale * 0.5 * (cosine + turned);
    }
  }
}

/// Those of x, and of its rate d/dt x plus w.
void HillPencil::take_coefficients(Input x, Input w) {
  values_.setZero(width(), 2 * x.cols() * unknowns());
  rates_.setZero(values_.rows(), values_.cols());
  to_coefficients(x, false, values_);
  to_coefficients(x, true, rates_);
  to_coefficients(w, false, rates_);
}

/// Sets the evolution rows of the medium's states to zero.
// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the columns
void HillPencil::drop_states(Output y) const {
  for (const Index state : medium_.states()) y.middleRows(state * width(), width()).setZero();
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the columns
void HillPencil::multiply(Input x, Input w, Output y) {
  take_coefficients(x, w);
  tangents_.multiply(values_, rates_, products_);
  to_series(products_, y);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the columns
void HillPencil::multiply_uncoupled(Input x, Input w, Output y) {
  take_coefficients(x, w);
  tangents_.multiply_uncoupled(values_, rates_, products_);
  to_series(products_, y);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the columns
void HillPencil::multiply_mass(Input w, Output y) {
  rates_.setZero(width(), 2 * w.cols() * unknowns());
  to_coefficients(w, false, rates_);
  tangents_.multiply_mass(rates_, products_);
  to_series(products_, y);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the columns
void HillPencil::multiply_mass_of_others(Input w, Output y) {
  multiply_mass(w, y);
  drop_states(y);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the columns
void HillPencil::multiply_uncoupled_mass_of_others(Input w, Output y) {
  multiply_uncoupled(Matrix::Zero(w.rows(), w.cols()), w, y);
  drop_states(y);
}

void HillPencil::multiply_eliminated(const Vector& x, Vector& y) {
  Vector product(size());
  const auto multiply_shifted = [&](const Vector& from) {
    multiply(from, *shift_ * from, product);
  };
  multiply_shifted(x);
  medium_.solve(product);
  Vector whole = -product;  // of the medium
  medium_.drop(product);
  whole += product;
  whole += x;
  multiply_shifted(whole);
  medium_.drop(product);
  y.resize(size());
  precondition(product, y);
  medium_.drop(y);
}

HillPencil::Complex HillPencil::log_determinant() const {
  Complex sum = preconditioner_.log_determinant();
  if (has_medium()) sum -= medium_.log_determinant_of_means(*shift_);
  return sum;
}

HillPencil::Complex HillPencil::exponent_of(const Vector& x) {
  Vector stiffness(size());
  Vector mass(size());
  multiply(x, Vector::Zero(size()), stiffness);
  multiply_mass(x, mass);
  return -mass.dot(stiffness) / mass.squaredNorm();
}

void HillPencil::take_scales(const HillPencil& other) {
  rows_ = other.rows_;
  columns_ = other.columns_;
}

bool HillPencil::set_shift(Complex s) {
  shift_.reset();
  if (preconditioner_.factor(rows_, columns_, s)) shift_ = s;
  return shift_.has_value();
}

void HillPencil::precondition(Input right, Output x) {
  preconditioner_.solve(Eigen::Map<const Matrix>(right.data(), width(), right.cols() * unknowns()),
                        Eigen::Map<Matrix>(x.data(), width(), right.cols() * unknowns()));
}

void HillPencil::drop_absent(Output x) const {
  if (sectors() == 1) return;
  for (Index column = 0; column < x.cols(); ++column)
    for (Index i = 0; i < unknowns(); ++i)
      for (int k = -harmonics(); k <= harmonics(); ++k)
        if (!tangents_.has(i, k)) x(i * width() + k + harmonics(), column) = 0.0;
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
