#include "arnoldi.hpp"

#include <cmath>

namespace samara::analysis {

Arnoldi::Arnoldi(const Vector& start, Index most, const Ranks& ranks)
    : ranks_(ranks), basis_(start / ranks.norm(start)), small_(Matrix::Zero(most + 1, most)) {}

bool Arnoldi::extend(Vector image, double least) {
  const Index step = size();
  for (int repeat = 0; repeat < 2; ++repeat) {
    Matrix parts = basis_.adjoint() * image;
    ranks_.sum(parts);
    image -= basis_ * parts;
    small_.col(step).head(step + 1) += parts;
  }
  const double norm = ranks_.norm(image);
  const bool is_new = norm > least;
  basis_.conservativeResize(Eigen::NoChange, step + 2);
  if (is_new) {
    small_(step + 1, step) = norm;
    image /= norm;
  }
  basis_.col(step + 1) = image;
  return is_new;
}

double Arnoldi::residual(const Vector& in_basis) const {
  const Index count = size();
  return std::abs(small_(count, count - 1) * in_basis(count - 1));
}

}  // namespace samara::analysis
