#include "hill_residual.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <span>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/petsc/handle.hpp"

namespace samara::analysis {
namespace {

using Complex = std::complex<double>;
using Index = Eigen::Index;

using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Modes whose loads are found together.
constexpr std::size_t modes_at_once = 8;

/// The part of the loads that this rank evaluates, and sums over the ranks. Vectors have all
/// unknowns of the system.
class Piece {
 public:
  /// `mesh`: null, if the rank evaluates all of them.
  Piece(const system::PeriodicSystem& system, const MeshPartition* mesh)
      : system_(mesh != nullptr ? mesh->system() : system), mesh_(mesh) {
    if (mesh_ == nullptr) return;
    for (std::size_t i = 0; i < mesh_->owners().size(); ++i)
      if (mesh_->owners()[i] == system::PeriodicSystem::shared)
        shared_.push_back(static_cast<Index>(i));
    find_images();
  }

  const system::PeriodicSystem& system() const { return system_; }

  /// Factors of the rows; zero in those that another rank counts. `rate`: of the motion [rad/s].
  Eigen::VectorXd row_factors(double rate, const Rows& K, const Rows& M) const {
    const Eigen::SparseMatrix<double> sizes = K.cwiseAbs() + rate * M.cwiseAbs();
    const Equilibration scaling =
        scaling_by_role(system_, sizes, rate, 0.0, mesh_ != nullptr ? &mesh_->ranks() : nullptr);
    const petsc::ReadView view(scaling.rows.get());
    Eigen::VectorXd factors = Eigen::Map<const Eigen::VectorXd>(view.data(), system_.size());
    for (Index i = 0; i < factors.size() && mesh_ != nullptr; ++i) {
      const int owner = mesh_->owners()[static_cast<std::size_t>(i)];
      const int counts = owner == system::PeriodicSystem::shared ? 0 : owner;
      if (counts != mesh_->ranks().rank) factors(i) = 0.0;
    }
    return factors;
  }

  /// Values of the sums over k of series and waves, k = -H ... H, of all unknowns that this rank
  /// evaluates; zero for others. A column for each pair and each of its waves.
  Eigen::MatrixXcd values_of(std::span<const HillPair* const> pairs,
                             const std::vector<Eigen::MatrixXcd>& waves) const {
    const Index columns = waves.front().cols();
    const auto count = static_cast<Index>(pairs.size());
    if (mesh_ == nullptr) {
      Eigen::MatrixXcd values(system_.size(), columns * count);
      for (Index m = 0; m < count; ++m)
        values.middleCols(m * columns, columns) = multiply_transpose(
            pairs[static_cast<std::size_t>(m)]->series, waves[static_cast<std::size_t>(m)]);
      return values;
    }
    // Each blade has the series of the first one, its harmonics turned.
    const auto turns = static_cast<Index>(images_.size());
    const Index harmonics = (waves.front().rows() - 1) / 2;
    Eigen::MatrixXcd counted(columns * count * turns, static_cast<Index>(mesh_->counted().size()));
    for (Index m = 0; m < count; ++m) {
      Eigen::MatrixXcd turned = waves[static_cast<std::size_t>(m)];
      for (Index turn = 0; turn < turns; ++turn) {
        counted.middleRows((m * turns + turn) * columns, columns) =
            multiply_transpose(turned, pairs[static_cast<std::size_t>(m)]->series);
        for (Index k = -harmonics; k <= harmonics; ++k)
          turned.row(k + harmonics) *=
              std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k % turns) /
                                  static_cast<double>(turns));
      }
    }
    Eigen::MatrixXcd local(counted.rows(), mesh_->size());
    mesh_->spread(reinterpret_cast<const double*>(counted.data()),
                  Eigen::Map<Eigen::MatrixXd>(reinterpret_cast<double*>(local.data()),
                                              2 * local.rows(), local.cols()));
    Eigen::MatrixXcd values = Eigen::MatrixXcd::Zero(system_.size(), columns * count);
    for (Index turn = 0; turn < turns; ++turn)
      for (const Image& image : images_[static_cast<std::size_t>(turn)])
        for (Index m = 0; m < count; ++m)
          values.row(image.unknown).segment(m * columns, columns) =
              image.sign *
              local.col(image.local).segment((m * turns + turn) * columns, columns).transpose();
    return values;
  }

  /// The ranks' parts of shared rows add up.
  void complete(Eigen::MatrixXcd& loads) const {
    if (mesh_ == nullptr) return;
    Eigen::MatrixXcd rows = loads(shared_, Eigen::all);
    mesh_->ranks().sum(rows);
    loads(shared_, Eigen::all) = rows;
  }

  /// The 2-norm of each column.
  Eigen::VectorXd norms(const Eigen::MatrixXcd& columns) const {
    Eigen::VectorXd squares = columns.colwise().squaredNorm().transpose();
    if (mesh_ != nullptr) mesh_->ranks().sum(squares);
    return squares.cwiseSqrt();
  }

 private:
  /// An unknown that has the value of one on this rank, after some turns by a sector.
  struct Image {
    Index local;
    PetscInt unknown;
    double sign;
  };

  void find_images() {
    const system::RotorSymmetry& symmetry = system_.symmetry();
    images_.resize(static_cast<std::size_t>(mesh_->sector().sectors));
    for (std::size_t i = 0; i < mesh_->kept().size(); ++i) {
      Image image{static_cast<Index>(i), mesh_->kept()[i], 1.0};
      for (std::vector<Image>& turned : images_) {
        turned.push_back(image);
        if (images_.size() == 1) break;
        const auto at = static_cast<std::size_t>(image.unknown);
        image.sign *= symmetry.sign[at];
        image.unknown = symmetry.source[at];
        if (image.unknown == mesh_->kept()[i]) break;
      }
    }
  }

  const system::PeriodicSystem& system_;
  const MeshPartition* mesh_;
  std::vector<Index> shared_;
  std::vector<std::vector<Image>> images_;  ///< for each number of turns
};

/// Real and imaginary parts are columns of their own.
Eigen::MatrixXcd product(const Rows& matrix, const Eigen::MatrixXcd& vectors) {
  Eigen::MatrixXd parts(vectors.rows(), 2 * vectors.cols());
  parts << vectors.real(), vectors.imag();
  Eigen::MatrixXd products;
  multiply(matrix, parts, products);
  Eigen::MatrixXcd result(products.rows(), vectors.cols());
  result.real() = products.leftCols(vectors.cols());
  result.imag() = products.rightCols(vectors.cols());
  return result;
}

}  // namespace

std::vector<double> find_hill_residuals(const system::PeriodicSystem& system,
                                        const PeriodicSolution& solution,
                                        const std::vector<const HillPair*>& pairs,
                                        const Ranks& ranks, const MeshPartition* mesh) {
  if (pairs.empty()) return {};
  const Piece piece(system, mesh);
  const double speed = system::base_rate(system);
  const int harmonics = static_cast<int>((pairs.front()->series.rows() - 1) / 2);
  const int instants = system.period() > 0.0 ? 4 * harmonics + 5 : 1;
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const petsc::Handle<Mat> jacobian = piece.system().make_jacobian();
  const petsc::Handle<Mat> mass = piece.system().make_mass();
  std::vector<double> largest(pairs.size(), 0.0);
  std::vector<double> scale(pairs.size(), 0.0);
  // By the tangents at the first instant, on all ranks, for each rate. Loads of constant tangents,
  // which have one instant, are as large as the exponent says.
  std::map<double, Eigen::VectorXd> rows_of_rates;
  const auto rate_of = [&](Complex exponent) {
    if (instants > 1) return speed;
    return speed * std::exp2(std::ceil(std::log2(std::max(1.0, std::abs(exponent) / speed))));
  };
  const auto waves_of = [&](const HillPair& pair, double t) {  // and those of the rates
    Eigen::MatrixXcd waves(2 * harmonics + 1, 2);
    for (int k = -harmonics; k <= harmonics; ++k) {
      waves(k + harmonics, 0) = std::polar(1.0, k * speed * t);
      waves(k + harmonics, 1) = waves(k + harmonics, 0) * (pair.exponent + Complex(0.0, k * speed));
    }
    return waves;
  };
  const auto add_instant = [&](int j) {
    const double t = system.period() * (j + 0.37) / instants;
    Rows K;
    Rows M;
    const auto evaluate = [&] {
      solution.evaluate(t, z.get(), z_dot.get());
      piece.system().tangents(t, z.get(), z_dot.get(), 0.0, jacobian.get(), mass.get());
      K = to_sparse_rows(jacobian.get());
      M = to_sparse_rows(mass.get());
    };
    if (mesh != nullptr)
      mesh->ranks().attempt(evaluate);
    else
      evaluate();
    if (rows_of_rates.empty())
      for (const HillPair* pair : pairs)
        if (const double rate = rate_of(pair->exponent); !rows_of_rates.contains(rate))
          rows_of_rates.emplace(rate, piece.row_factors(rate, K, M));
    if (j % ranks.size != ranks.rank) return;
    for (std::size_t first = 0; first < pairs.size(); first += modes_at_once) {
      const auto some =
          std::span(pairs).subspan(first, std::min(modes_at_once, pairs.size() - first));
      const auto count = static_cast<Index>(some.size());
      std::vector<Eigen::MatrixXcd> waves;
      for (const HillPair* pair : some) waves.push_back(waves_of(*pair, t));
      const Eigen::MatrixXcd both = piece.values_of(some, waves);
      const Eigen::MatrixXcd values = both(Eigen::all, Eigen::seqN(0, count, 2));
      const Eigen::MatrixXcd rates = both(Eigen::all, Eigen::seqN(1, count, 2));
      Eigen::MatrixXcd loads(system.size(), 3 * count);  // residual, inertia, that at the speed
      loads.middleCols(count, count) = product(M, rates);
      loads.leftCols(count) = loads.middleCols(count, count) + product(K, values);
      loads.rightCols(count) = speed * product(M, values);
      piece.complete(loads);
      for (Index m = 0; m < loads.cols(); ++m)
        loads.col(m).array() *=
            rows_of_rates.at(rate_of(some[static_cast<std::size_t>(m % count)]->exponent)).array();
      const Eigen::VectorXd norms = piece.norms(loads);
      for (Index m = 0; m < count; ++m) {
        const std::size_t pair = first + static_cast<std::size_t>(m);
        largest[pair] = std::max(largest[pair], norms(m));
        scale[pair] = std::max({scale[pair], norms(count + m), norms(2 * count + m)});
      }
    }
  };
  ranks.attempt([&] {
    for (int j = 0; j < instants; ++j)
      if (j == 0 || j % ranks.size == ranks.rank) add_instant(j);
  });
  ranks.find_largest(largest);
  ranks.find_largest(scale);
  std::vector<double> residuals;
  for (std::size_t m = 0; m < pairs.size(); ++m) residuals.push_back(largest[m] / scale[m]);
  return residuals;
}

}  // namespace samara::analysis
