#include "samara/analysis/linear_algebra.hpp"

#include <algorithm>
#include <random>

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"

#include "small_systems.hpp"

using namespace samara;
using namespace samara::test;
using Complex = std::complex<double>;

namespace {

petsc::Handle<Mat> to_petsc(const Eigen::MatrixXd& values) {
  petsc::Handle<Mat> matrix;
  const auto rows = static_cast<PetscInt>(values.rows());
  const auto columns = static_cast<PetscInt>(values.cols());
  petsc::check(MatCreateSeqAIJ(PETSC_COMM_SELF, rows, columns, columns, nullptr, matrix.fill()));
  for (PetscInt i = 0; i < rows; ++i)
    for (PetscInt j = 0; j < columns; ++j)
      petsc::check(MatSetValue(matrix.get(), i, j, values(i, j), INSERT_VALUES));
  petsc::check(MatAssemblyBegin(matrix.get(), MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(matrix.get(), MAT_FINAL_ASSEMBLY));
  return matrix;
}

/// Chains of blocks with a border at the end, and with a closed loop, which causes fill-in.
struct Chains {
  static constexpr PetscInt rows = 12;
  static constexpr PetscInt usual_size = 5;

  explicit Chains(unsigned seed, PetscInt of_block = usual_size)
      : size(of_block), values(Eigen::MatrixXd::Zero(size * rows, size * rows)) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> entry(-1.0, 1.0);
    for (PetscInt i = 0; i < rows; ++i)
      for (PetscInt j = 0; j < rows; ++j) {
        if (!is_block(i, j)) continue;
        for (PetscInt r = 0; r < size; ++r)
          for (PetscInt c = 0; c < size; ++c) values(i * size + r, j * size + c) = entry(random);
      }
    values.diagonal().array() += 1.6 * size;
  }

  static bool is_block(PetscInt i, PetscInt j) {
    const bool is_chain = i == j || (std::abs(i - j) == 1 && std::max(i, j) != 6);
    const bool is_border = std::max(i, j) == rows - 1;
    const bool is_loop = std::min(i, j) == 1 && std::max(i, j) == 5;
    return is_chain || is_border || is_loop;
  }

  petsc::Handle<Mat> matrix() const {
    petsc::Handle<Mat> matrix;
    const auto n = static_cast<PetscInt>(values.rows());
    petsc::check(MatCreateSeqBAIJ(PETSC_COMM_SELF, size, n, n, rows, nullptr, matrix.fill()));
    for (PetscInt i = 0; i < n; ++i)
      for (PetscInt j = 0; j < n; ++j)
        if (is_block(i / size, j / size))
          petsc::check(MatSetValue(matrix.get(), i, j, values(i, j), INSERT_VALUES));
    petsc::check(MatAssemblyBegin(matrix.get(), MAT_FINAL_ASSEMBLY));
    petsc::check(MatAssemblyEnd(matrix.get(), MAT_FINAL_ASSEMBLY));
    return matrix;
  }

  /// Largest error of solutions for random columns.
  double error_of(analysis::DirectSolver& solver, Eigen::Index columns = 7) const {
    const petsc::Handle<Mat> held = matrix();
    const Eigen::MatrixXd exact = Eigen::MatrixXd::Random(values.rows(), columns);
    Eigen::MatrixXd right = values * exact;
    solver.factor(held.get());
    solver.solve(right);
    return (right - exact).cwiseAbs().maxCoeff();
  }

  PetscInt size;  ///< of a block
  Eigen::MatrixXd values;
};

/// Diagonally dominant, then rows and columns stretched by six decades up and down.
struct BadlyScaled {
  BadlyScaled(Eigen::Index n, unsigned seed) : core(n, n), rows(n), columns(n) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> entry(-1.0, 1.0);
    std::uniform_real_distribution<double> decade(-6.0, 6.0);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) core(i, j) = entry(random);
    core.diagonal().array() += static_cast<double>(n);
    for (Eigen::Index i = 0; i < n; ++i) rows(i) = std::pow(10.0, decade(random));
    for (Eigen::Index i = 0; i < n; ++i) columns(i) = std::pow(10.0, decade(random));
  }
  Eigen::MatrixXd matrix() const { return rows.asDiagonal() * core * columns.asDiagonal(); }

  Eigen::MatrixXd core;
  Eigen::VectorXd rows, columns;
};

/// The largest distance of a value of `a` to what is left of `b`, each of which serves once.
double distance_of_sets(const std::vector<Complex>& a, std::vector<Complex> b) {
  double worst = 0.0;
  for (const Complex value : a) {
    if (b.empty()) return 1e300;
    const auto best = std::min_element(b.begin(), b.end(), [value](Complex x, Complex y) {
      return std::abs(x - value) < std::abs(y - value);
    });
    worst = std::max(worst, std::abs(*best - value));
    b.erase(best);
  }
  return b.empty() ? worst : 1e300;
}

std::vector<Complex> eigen_values(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXcd values = matrix.eigenvalues();
  return {values.data(), values.data() + values.size()};
}

}  // namespace

BOOST_AUTO_TEST_CASE(equilibrated_rows_and_columns_have_a_largest_entry_near_one) {
  const Eigen::MatrixXd matrix = BadlyScaled(30, 7).matrix();
  const petsc::Handle<Mat> held = to_petsc(matrix);
  const analysis::Equilibration scaling = analysis::equilibrate(held.get());
  petsc::check(MatDiagonalScale(held.get(), scaling.rows.get(), scaling.columns.get()));
  const Eigen::MatrixXd scaled = analysis::to_sparse(held.get());
  // Ruiz's sweeps halve the logarithm of the spread: 24 decades / 2^6 is less than half a decade.
  for (Eigen::Index i = 0; i < scaled.rows(); ++i) {
    BOOST_TEST(scaled.row(i).cwiseAbs().maxCoeff() < 3.0);
    BOOST_TEST(scaled.row(i).cwiseAbs().maxCoeff() > 0.3);
    BOOST_TEST(scaled.col(i).cwiseAbs().maxCoeff() < 3.0);
    BOOST_TEST(scaled.col(i).cwiseAbs().maxCoeff() > 0.3);
  }
}

BOOST_AUTO_TEST_CASE(direct_solver_solves_all_columns_of_badly_scaled_matrices) {
  // One scaling serves two matrices of the same pattern.
  analysis::DirectSolver solver("test_", analysis::equilibrate);
  BadlyScaled system(40, 3);
  for (int round = 0; round < 2; ++round) {
    if (round == 1) system.core.array() *= 1.0 + 0.3 * Eigen::ArrayXXd::Random(40, 40);
    const petsc::Handle<Mat> held = to_petsc(system.matrix());
    const Eigen::MatrixXd exact = Eigen::MatrixXd::Random(40, 7);  // each in a unit of its own
    Eigen::MatrixXd right = system.rows.asDiagonal() * (system.core * exact);
    solver.factor(held.get());
    solver.solve(right);
    // The core's condition is about 2: what scaling cannot mend is lost to no digit.
    const Eigen::MatrixXd found = system.columns.asDiagonal() * right;
    BOOST_TEST((found - exact).cwiseAbs().maxCoeff() < 1e-13);
  }
}

BOOST_AUTO_TEST_CASE(block_matrices_are_solved_with_fill_in) {
  analysis::DirectSolver solver("test_", analysis::equilibrate);
  for (const unsigned seed : {1U, 2U, 3U}) BOOST_TEST(Chains(seed).error_of(solver) < 1e-13);
}

/// From 64 columns on, triangles of 18 rows are inverted where they are well conditioned: whole and
/// broken groups of rows and of columns, and a block with a small pivot.
BOOST_AUTO_TEST_CASE(many_columns_are_solved_as_few) {
  for (const PetscInt size : {1, 17, 18, 19, 37, 54}) {
    analysis::DirectSolver solver("test_", analysis::equilibrate);
    Chains chains(4, size);
    for (const Eigen::Index columns : {63, 64, 128, 129, 300})
      BOOST_TEST(chains.error_of(solver, columns) < 1e-12);
    auto second = chains.values.block(size, size, size, size);
    second.row(size - 1) = second.row(0) + 1e-6 * second.row(size - 1);
    BOOST_TEST(chains.error_of(solver, 129) < 1e-7);
  }
}

// Rows are interchanged within diagonal blocks only. A matrix whose solution needs more is solved
// by another solver: a diagonal block that is zero, or singular but for 1e-9, or alone singular
// after the elimination of the blocks before it.
BOOST_AUTO_TEST_CASE(block_matrices_with_singular_diagonal_blocks_are_solved) {
  constexpr PetscInt n = Chains::usual_size;
  for (const double left : {0.0, 1e-9}) {
    Chains chains(4);
    chains.values.block(3 * n, 3 * n, n, n) = left * Eigen::MatrixXd::Identity(n, n);
    const double condition = chains.values.jacobiSvd().singularValues().maxCoeff() /
                             chains.values.jacobiSvd().singularValues().minCoeff();
    BOOST_TEST(condition < 1e3);
    analysis::DirectSolver solver("test_", analysis::equilibrate);
    BOOST_TEST(Chains(5).error_of(solver) < 1e-13);
    BOOST_TEST(chains.error_of(solver) < 1e-10);
    BOOST_TEST(Chains(6).error_of(solver) < 1e-12);
  }
  Chains chains(7);
  const Eigen::MatrixXd first = chains.values.topLeftCorner(n, n);
  chains.values.block(n, n, n, n) =
      chains.values.block(n, 0, n, n) * first.inverse() * chains.values.block(0, n, n, n);
  analysis::DirectSolver solver("test_", analysis::equilibrate);
  BOOST_TEST(chains.error_of(solver) < 1e-12);
}

BOOST_AUTO_TEST_CASE(options_choose_the_solver_of_block_matrices) {
  petsc::check(PetscOptionsSetValue(nullptr, "-blocks_pc_type", "none"));
  analysis::DirectSolver solver("blocks_", analysis::equilibrate);
  BOOST_CHECK_THROW(Chains(1).error_of(solver), ConvergenceError);
  petsc::check(PetscOptionsClearValue(nullptr, "-blocks_pc_type"));
}

BOOST_AUTO_TEST_CASE(direct_solver_accepts_no_columns) {
  analysis::DirectSolver solver("test_", analysis::equilibrate);
  const petsc::Handle<Mat> held = to_petsc(BadlyScaled(5, 1).matrix());
  solver.factor(held.get());
  Eigen::MatrixXd none(5, 0);
  solver.solve(none);
  BOOST_TEST(none.cols() == 0);
}

BOOST_AUTO_TEST_CASE(singular_matrix_is_never_a_silent_result) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(4, 4) + 0.1 * Eigen::MatrixXd::Ones(4, 4);
  matrix.row(3) = matrix.row(2) + matrix.row(1);
  analysis::DirectSolver solver("test_", analysis::equilibrate);
  const petsc::Handle<Mat> held = to_petsc(matrix);
  Eigen::MatrixXd right(4, 1);
  right << 1.0, 2.0, 3.0, -4.0;  // not in the range
  const auto attempt = [&] {
    solver.factor(held.get());
    solver.solve(right);
  };
  BOOST_CHECK_THROW(attempt(), std::runtime_error);
}

BOOST_AUTO_TEST_CASE(product_is_that_of_the_definition) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(5, 3);
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(3, 4);
  const Eigen::MatrixXd product = analysis::multiply(a, b);
  BOOST_REQUIRE(product.rows() == 5);
  BOOST_REQUIRE(product.cols() == 4);
  for (Eigen::Index i = 0; i < 5; ++i)
    for (Eigen::Index j = 0; j < 4; ++j)
      BOOST_TEST(std::abs(product(i, j) - a.row(i).dot(b.col(j).transpose())) < 1e-14);
  BOOST_TEST(analysis::multiply(a, Eigen::MatrixXd(3, 0)).cols() == 0);
  BOOST_TEST(analysis::multiply(Eigen::MatrixXd(2, 0), Eigen::MatrixXd(0, 3)).norm() == 0.0);
}

BOOST_AUTO_TEST_CASE(sparse_copy_has_every_entry) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(6, 4);
  matrix(2, 1) = 0.0;
  const petsc::Handle<Mat> held = to_petsc(matrix);
  const Eigen::SparseMatrix<double> sparse = analysis::to_sparse(held.get());
  BOOST_TEST((Eigen::MatrixXd(sparse) - matrix).norm() == 0.0);
  BOOST_TEST(sparse.nonZeros() == 23);
}

BOOST_AUTO_TEST_CASE(eigenpairs_of_random_matrices_are_those_of_eigen) {
  for (const Eigen::Index n : {1, 2, 5, 40}) {
    const Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(n, n);
    const analysis::Eigenpairs pairs = analysis::dense_eigenpairs(matrix, "test_");
    BOOST_TEST(distance_of_sets(pairs.values, eigen_values(matrix)) < 1e-12);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::VectorXcd v = pairs.vectors.col(i);
      const Complex value = pairs.values[static_cast<std::size_t>(i)];
      BOOST_TEST(v.norm() == 1.0, boost::test_tools::tolerance(1e-12));
      const double defect = (matrix * v - value * v).norm();
      BOOST_TEST(defect < 1e-12);
      BOOST_TEST(std::abs(pairs.residuals[static_cast<std::size_t>(i)] - defect) < 1e-13);
    }
  }
  BOOST_TEST(analysis::dense_eigenpairs(Eigen::MatrixXd(0, 0), "test_").values.empty());
}

BOOST_AUTO_TEST_CASE(largest_eigenvalues_are_those_of_the_whole_spectrum) {
  // Eigenvalues 1/(1 - i omega) of an inverse, as those of modes are, in coordinates that are not
  // orthogonal.
  for (const auto& [size, count] : {std::pair{500, 30}, std::pair{60, 20}}) {
    const Eigen::Index n = size;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> entry(-0.2, 0.2);
    Eigen::MatrixXd vectors = Eigen::MatrixXd::Identity(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) vectors(i, j) += entry(random) / std::sqrt(1.0 * size);
    Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(n, n);
    std::vector<double> wanted;
    for (Eigen::Index i = 0; i + 1 < n; i += 2) {
      const double omega = 0.3 * std::pow(1.02, static_cast<double>(i));
      const Complex value = 1.0 / Complex(1.0 + 0.01 * omega, -omega);
      blocks.block(i, i, 2, 2) << value.real(), value.imag(), -value.imag(), value.real();
      wanted.insert(wanted.end(), 2, std::abs(value));
    }
    const Eigen::MatrixXd matrix = vectors * blocks * vectors.inverse();
    std::vector<double> found;
    const auto map = [&matrix](const Eigen::VectorXd& x) { return Eigen::VectorXd(matrix * x); };
    for (const Complex value : analysis::largest_eigenvalues(n, map, count, 1e-7))
      found.push_back(std::abs(value));
    std::sort(found.rbegin(), found.rend());
    BOOST_REQUIRE(found.size() >= static_cast<std::size_t>(count));
    BOOST_TEST(found.size() <= wanted.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      BOOST_TEST(std::abs(found[i] / wanted[i] - 1.0) < 1e-6);
    if (size == 500) BOOST_TEST(found.size() < 60u);
  }
}

BOOST_AUTO_TEST_CASE(equal_complex_pairs_of_identical_blades_have_independent_vectors) {
  // Two, then four copies of one block, hidden by a random basis: complete eigenvectors exist and
  // must be found, or the modes of one blade are lost.
  Eigen::Matrix2d block;
  block << 0.3, 0.9, -0.8, 0.2;
  for (const Eigen::Index copies : {2, 4}) {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(2 * copies, 2 * copies);
    for (Eigen::Index c = 0; c < copies; ++c) matrix.block<2, 2>(2 * c, 2 * c) = block;
    const Eigen::MatrixXd basis =
        Eigen::HouseholderQR<Eigen::MatrixXd>(Eigen::MatrixXd::Random(2 * copies, 2 * copies))
            .householderQ();
    matrix = (basis * matrix * basis.transpose()).eval();
    const analysis::Eigenpairs pairs = analysis::dense_eigenpairs(matrix, "test_");
    BOOST_TEST(distance_of_sets(pairs.values, eigen_values(matrix)) < 1e-12);
    for (const double residual : pairs.residuals) BOOST_TEST(residual < 1e-12);
    // The smallest singular value tells independence; round-off chooses the basis inside the equal
    // eigenvalues, which makes it small but not 1e-8.
    const Eigen::VectorXd singular = pairs.vectors.jacobiSvd().singularValues();
    BOOST_TEST(singular(singular.size() - 1) > 1e-6);
  }
}

BOOST_AUTO_TEST_CASE(exactly_equal_blocks_keep_their_own_vectors) {
  Eigen::Matrix2d block;
  block << 0.3, 0.9, -0.8, 0.2;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(6, 6);
  for (Eigen::Index c = 0; c < 3; ++c) matrix.block<2, 2>(2 * c, 2 * c) = block;
  const analysis::Eigenpairs pairs = analysis::dense_eigenpairs(matrix, "test_");
  BOOST_TEST(distance_of_sets(pairs.values, eigen_values(matrix)) < 1e-14);
  const Eigen::VectorXd singular = pairs.vectors.jacobiSvd().singularValues();
  BOOST_TEST(singular(5) > 0.1);
}

BOOST_AUTO_TEST_CASE(defective_matrix_splits_by_the_root_of_rounding_only) {
  // A Jordan block of two, as the free yaw makes: mu = 1 twice with one vector.
  Eigen::Matrix3d matrix;
  matrix << 1.0, 1.0, 0.0,  //
      0.0, 1.0, 0.0,        //
      0.0, 0.0, 0.5;
  const Eigen::Matrix3d basis =
      Eigen::HouseholderQR<Eigen::Matrix3d>(Eigen::Matrix3d::Random()).householderQ();
  const Eigen::Matrix3d hidden = basis * matrix * basis.transpose();
  const analysis::Eigenpairs pairs = analysis::dense_eigenpairs(hidden, "test_");
  BOOST_TEST(distance_of_sets(pairs.values, {1.0, 1.0, 0.5}) < 1e-7);  // sqrt(1e-16) and a few
  for (const double residual : pairs.residuals) BOOST_TEST(residual < 1e-13);
}
