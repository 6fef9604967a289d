// Reduced forms: error bound, neutral and unstable modes, static answer.
#include "samara/linear/model_reduction.hpp"

#include <complex>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"

using namespace samara;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using linear::ReductionMethod;
using linear::StateSpace;

namespace {

/// A chain of `masses` with springs and dampers to the ground and between them, pushed at one end;
/// positions of both ends are seen. `stiffness` of the ground 0: it floats.
StateSpace chain(int masses, double ground) {
  const Eigen::Index n = masses;
  MatrixXd K = MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    K(i, i) += 4.0;
    K(i + 1, i + 1) += 4.0;
    K(i, i + 1) -= 4.0;
    K(i + 1, i) -= 4.0;
  }
  K(0, 0) += ground;
  StateSpace form;
  form.A = MatrixXd::Zero(2 * n, 2 * n);
  form.A.topRightCorner(n, n).setIdentity();
  form.A.bottomLeftCorner(n, n) = -K;
  form.A.bottomRightCorner(n, n) = -0.05 * K;
  form.B = MatrixXd::Zero(2 * n, 1);
  form.B(n, 0) = 1.0;
  form.C = MatrixXd::Zero(2, 2 * n);
  form.C(0, 0) = 1.0;
  form.C(1, n - 1) = 1.0;
  form.D = MatrixXd::Zero(2, 1);
  return form;
}

MatrixXcd response(const StateSpace& form, double omega) {
  const std::complex<double> s(0.0, omega);
  const MatrixXcd left =
      s * MatrixXcd::Identity(form.A.rows(), form.A.rows()) - form.A.cast<std::complex<double>>();
  return form.C * left.partialPivLu().solve(form.B.cast<std::complex<double>>()) + form.D;
}

double largest_error(const StateSpace& a, const StateSpace& b) {
  double worst = 0.0;
  for (double omega = 0.01; omega < 20.0; omega *= 1.03)
    worst = std::max(worst, (response(a, omega) - response(b, omega)).norm());
  return worst;
}

}  // namespace

BOOST_AUTO_TEST_CASE(balanced_truncation_stays_below_its_bound) {
  const StateSpace whole = chain(8, 2.0);
  for (const int order : {4, 6, 10}) {
    const linear::ReducedForm reduced = linear::reduce(whole, order, ReductionMethod::balanced);
    BOOST_TEST(reduced.form.A.rows() == order);
    BOOST_TEST(reduced.kept == 0);
    const double error = largest_error(whole, reduced.form);
    BOOST_TEST(error <= reduced.error_bound);
    // The largest error is at least the first singular value that was left out.
    BOOST_TEST(error >= 0.5 * reduced.hankel(order));
  }
}

BOOST_AUTO_TEST_CASE(a_floating_chain_keeps_its_rigid_motion) {
  // A double zero, defective: the response at low frequencies is that of one mass of 8.
  const StateSpace whole = chain(8, 0.0);
  for (const ReductionMethod method : {ReductionMethod::balanced, ReductionMethod::modal}) {
    const linear::ReducedForm reduced = linear::reduce(whole, 8, method);
    BOOST_TEST(reduced.kept == 2);
    const double omega = 0.01;
    const double expected = 1.0 / (8.0 * omega * omega);
    BOOST_TEST(std::abs(response(reduced.form, omega)(0, 0)) == expected,
               boost::test_tools::tolerance(1e-3));
    const double error = largest_error(whole, reduced.form);
    BOOST_TEST(error < 0.2);
    if (method == ReductionMethod::balanced)
      // Round-off of 1/omega^2 beside it.
      BOOST_TEST(error <= reduced.error_bound + 1e-6);
  }
  BOOST_CHECK_THROW(linear::reduce(whole, 1, ReductionMethod::modal), InputError);
}

BOOST_AUTO_TEST_CASE(modal_truncation_keeps_slow_modes_and_the_static_answer) {
  const StateSpace whole = chain(8, 2.0);
  const linear::ReducedForm reduced = linear::reduce(whole, 7, ReductionMethod::modal);
  BOOST_TEST(reduced.form.A.rows() == 6);  // pairs are not parted
  BOOST_TEST((response(reduced.form, 0.0) - response(whole, 0.0)).norm() < 1e-10);
  const Eigen::EigenSolver<MatrixXd> all(whole.A);
  const Eigen::EigenSolver<MatrixXd> some(reduced.form.A);
  for (Eigen::Index i = 0; i < 6; ++i)
    BOOST_TEST((all.eigenvalues().array() - some.eigenvalues()(i)).abs().minCoeff() < 1e-9);
}
