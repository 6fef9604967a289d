// Schur forms with eigenvalues in a chosen order, and the separation of their two parts.
#pragma once

#include <Eigen/Core>

namespace samara::linear {

/// A = U T U^H with T upper triangular.
struct Schur {
  Eigen::MatrixXcd T, U;
};

/// @throws ConvergenceError
Schur schur_of(const Eigen::MatrixXd& matrix);

/// Exchanges the eigenvalues k and k + 1 of the diagonal.
void exchange(Schur& schur, Eigen::Index k);

/// Moves the eigenvalues for which `stays` is true to the front, in their order, and counts them.
template <class Stays>
Eigen::Index bring_forward(Schur& schur, const Stays& stays) {
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < schur.T.rows(); ++i) {
    if (!stays(schur.T(i, i))) continue;
    for (Eigen::Index k = i; k > count; --k) exchange(schur, k - 1);
    ++count;
  }
  return count;
}

/// X of T11 X - X T22 = -T12, T11 with `first` rows: (1 X; 0 1) makes T block diagonal.
Eigen::MatrixXcd parting(const Eigen::MatrixXcd& T, Eigen::Index first);

/// A real basis of the space of complex columns; this space must be its own conjugate.
Eigen::MatrixXd real_basis(const Eigen::MatrixXcd& columns);

}  // namespace samara::linear
