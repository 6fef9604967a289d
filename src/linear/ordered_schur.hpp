// Schur forms whose eigenvalues stand in an order of one's choice, and what their two parts are.
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

/// Brings the eigenvalues that are to stay to the front, in their order, and counts them.
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

/// X of T11 X - X T22 = -T12, T11 with `first` rows: (1 X; 0 1) parts the two.
Eigen::MatrixXcd parting(const Eigen::MatrixXcd& T, Eigen::Index first);

/// A real basis of the space of complex columns that is its own conjugate.
Eigen::MatrixXd real_basis(const Eigen::MatrixXcd& columns);

}  // namespace samara::linear
