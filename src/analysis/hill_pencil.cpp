#include "hill_pencil.hpp"

#include <algorithm>

namespace samara::analysis {
namespace {

/// Ratio of rates whose scales are alike.
constexpr double most_unlike = 2.0;

}  // namespace

HillPencil::HillPencil(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                       int harmonics, bool by_sector, bool may_defer)
    : tangents_(system, harmonics, by_sector, may_defer),
      ranks_(MPI_COMM_SELF),
      preconditioner_(tangents_),
      medium_(tangents_, rows_, columns_) {
  tangents_.sample(solution);
  take_rate(tangents_.highest_rate());
  list_medium();
}

HillPencil::HillPencil(const MeshPartition& mesh, const PeriodicSolution& solution, int harmonics)
    : tangents_(mesh, {}, harmonics, false),
      ranks_(mesh.ranks()),
      preconditioner_(tangents_),
      medium_(tangents_, rows_, columns_) {
  tangents_.sample(solution);
  take_rate(tangents_.highest_rate());
  list_medium();
}

void HillPencil::sample(const PeriodicSolution& solution, double offset) {
  tangents_.sample(solution, offset);
  shift_.reset();
}

/// That of an unknown of a vector, among those of the tangents.
HillPencil::Index HillPencil::number_of(Index unknown) const {
  return mesh() != nullptr ? mesh()->counted()[static_cast<std::size_t>(unknown)] : unknown;
}

/// Vectors with all unknowns of the tangents, where necessary in `storage`.
// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the columns
Eigen::Map<const HillPencil::Matrix> HillPencil::spread(Input x, Matrix& storage) const {
  if (mesh() == nullptr) return {x.data(), x.rows(), x.cols()};
  storage.resize(width() * tangents_.size(), x.cols());
  for (Index column = 0; column < x.cols(); ++column)
    mesh()->spread(
        reinterpret_cast<const double*>(x.col(column).data()),
        Eigen::Map<Eigen::MatrixXd>(reinterpret_cast<double*>(storage.col(column).data()),
                                    2 * width(), tangents_.size()));
  return {storage.data(), storage.rows(), storage.cols()};
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
  const Index count = x.cols() * tangents_.size();
  const Eigen::Map<const Eigen::MatrixXcd> series(x.data(), width(), count);
  for (Index i = 0; i < count; ++i) {
    const double factor = columns_(i % tangents_.size() * width());
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
    const double scale = rows_(i % tangents_.size() * width());
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
  const Eigen::Map<const Matrix> all_x = spread(x, spread_x_);
  const Eigen::Map<const Matrix> all_w = spread(w, spread_w_);
  values_.setZero(width(), 2 * x.cols() * tangents_.size());
  rates_.setZero(values_.rows(), values_.cols());
  to_coefficients(all_x, false, values_);
  to_coefficients(all_x, true, rates_);
  to_coefficients(all_w, false, rates_);
}

/// The series of the products. The ranks' parts of the border add up.
// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the columns
void HillPencil::give_products(Output y) {
  if (mesh() == nullptr) {
    to_series(products_, y);
    return;
  }
  const Index count = tangents_.size();
  for (Index first = 0; first < products_.cols(); first += count)
    mesh()->sum_border(products_.middleCols(first, count));
  spread_x_.resize(width() * count, y.cols());
  to_series(products_, spread_x_);
  collect(spread_x_, y);
}

/// The unknowns of a vector on this rank.
// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the columns
void HillPencil::collect(const Matrix& all, Output y) const {
  for (Index column = 0; column < y.cols(); ++column)
    mesh()->collect(
        Eigen::Map<const Eigen::MatrixXd>(reinterpret_cast<const double*>(all.col(column).data()),
                                          2 * width(), tangents_.size()),
        reinterpret_cast<double*>(y.col(column).data()));
}

void HillPencil::list_medium() {
  for (Index i = 0; i < unknowns(); ++i) {
    const system::Unknown& unknown = tangents_.unknown(number_of(i));
    if (!unknown.is_of_medium()) continue;
    of_medium_.push_back(i);
    if (unknown.role == system::UnknownRole::state) states_of_medium_.push_back(i);
  }
}

/// Sets unknowns, or rows of the same numbers, to zero.
// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the columns
void HillPencil::drop(const std::vector<Index>& unknowns, Output y) const {
  for (const Index i : unknowns) y.middleRows(i * width(), width()).setZero();
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the columns
void HillPencil::drop_deferred(Output y) const {
  std::vector<Index> deferred;
  for (const HarmonicTangents::Deferred& one : tangents_.deferred()) deferred.push_back(one.number);
  drop(deferred, y);
}

void HillPencil::solve_medium(Vector& x) {
  if (mesh() == nullptr) {
    medium_.solve(x);
    return;
  }
  spread(x, spread_x_);
  medium_.solve(spread_x_);
  collect(spread_x_, x);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the columns
void HillPencil::multiply(Input x, Input w, Output y) {
  take_coefficients(x, w);
  tangents_.multiply(values_, rates_, products_);
  give_products(y);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the columns
void HillPencil::multiply_uncoupled(Input x, Input w, Output y) {
  take_coefficients(x, w);
  tangents_.multiply_uncoupled(values_, rates_, products_);
  give_products(y);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the columns
void HillPencil::multiply_mass(Input w, Output y) {
  const Eigen::Map<const Matrix> all_w = spread(w, spread_w_);
  rates_.setZero(width(), 2 * w.cols() * tangents_.size());
  to_coefficients(all_w, false, rates_);
  tangents_.multiply_mass(rates_, products_);
  give_products(y);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the columns
void HillPencil::multiply_mass_of_others(Input w, Output y) {
  multiply_mass(w, y);
  drop(states_of_medium_, y);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a reference to the columns
void HillPencil::multiply_uncoupled_mass_of_others(Input w, Output y) {
  multiply_uncoupled(Matrix::Zero(w.rows(), w.cols()), w, y);
  drop(states_of_medium_, y);
}

void HillPencil::multiply_eliminated(const Vector& x, Vector& y) {
  Vector product(size());
  const auto multiply_shifted = [&](const Vector& from) {
    multiply(from, *shift_ * from, product);
  };
  multiply_shifted(x);
  solve_medium(product);
  Vector whole = -product;  // of the medium
  drop(of_medium_, product);
  whole += product;
  whole += x;
  multiply_shifted(whole);
  drop(of_medium_, product);
  y.resize(size());
  precondition(product, y);
  drop(of_medium_, y);
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
  return -product(mass, stiffness)(0) / product(mass, mass)(0);
}

void HillPencil::take_scales(const HillPencil& other) {
  for (Index i = 0; i < tangents_.size(); ++i) {
    rows_.segment(i * width(), width()).setConstant(other.rows_(i * other.width()));
    columns_.segment(i * width(), width()).setConstant(other.columns_(i * other.width()));
  }
}

bool HillPencil::set_shift(Complex s) {
  shift_.reset();
  if (preconditioner_.factor(rows_, columns_, s)) shift_ = s;
  return shift_.has_value();
}

void HillPencil::precondition(Input right, Output x) {
  const Eigen::Map<const Matrix> given = spread(right, spread_w_);
  const Index count = right.cols() * tangents_.size();
  const Eigen::Map<const Matrix> series(given.data(), width(), count);
  if (mesh() == nullptr) {
    preconditioner_.solve(series, Eigen::Map<Matrix>(x.data(), width(), count));
    return;
  }
  spread_x_.resize(width() * tangents_.size(), right.cols());
  preconditioner_.solve(series, Eigen::Map<Matrix>(spread_x_.data(), width(), count));
  collect(spread_x_, x);
}

void HillPencil::drop_absent(Output x) const {
  if (sectors() == 1) return;
  for (Index column = 0; column < x.cols(); ++column)
    for (Index i = 0; i < unknowns(); ++i)
      for (int k = -harmonics(); k <= harmonics(); ++k)
        if (!tangents_.has(number_of(i), k)) x(i * width() + k + harmonics(), column) = 0.0;
}

Eigen::MatrixXcd HillPencil::series_of(const Vector& x) const {
  Eigen::MatrixXcd series = Eigen::Map<const Eigen::MatrixXcd>(x.data(), width(), unknowns());
  for (Index i = 0; i < unknowns(); ++i) series.col(i) *= columns_(number_of(i) * width());
  return mesh() != nullptr ? series : tangents_.whole(series);
}

HillPencil::Vector HillPencil::vector_of(const Eigen::MatrixXcd& whole) const {
  const Eigen::MatrixXcd series = mesh() != nullptr ? whole : tangents_.part(whole);
  const Index other = (series.rows() - 1) / 2;
  const Index common = std::min<Index>(other, harmonics());
  Vector x = Vector::Zero(size());
  for (Index i = 0; i < unknowns(); ++i)
    x.segment(i * width() + harmonics() - common, 2 * common + 1) =
        series.col(i).segment(other - common, 2 * common + 1) / columns_(number_of(i) * width());
  return x;
}

}  // namespace samara::analysis
