// Tangents of a turbine in multiblade coordinates (Coleman's), independent of the Floquet analysis:
// what the blades do is the sum of a collective and two cyclic motions,
//     z_blade k = a0 + ac cos psi_k + as sin psi_k,      psi_k = psi + 2 pi (k - 1)/3,
// with components that stand still. z = B(psi) zeta in M z_dot + K z = 0 gives
//     B^-1 M B zeta_dot + B^-1 (K B + Omega M dB/dpsi) zeta = 0,
// constant for three equal blades without gravity and tilt. Tower, nacelle and drivetrain are
// written in axes that do not turn with the rotor and stay as they are; the rows are turned like
// the unknowns.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <boost/test/unit_test.hpp>

#include "samara/analysis/sparse_parts.hpp"

#include "cases.hpp"

namespace samara::test {

struct MultibladeSystem {
  Eigen::SparseMatrix<double> K, M;  ///< K zeta + M zeta_dot = 0
};

/// An exponent and its vector.
struct MultibladeMode {
  Complex exponent;
  Eigen::VectorXcd shape;
  double residual = 0.0;  ///< of (K + exponent M) zeta, relative to its terms, scaled
};

class Multiblade {
 public:
  static constexpr int blades = 3;

  explicit Multiblade(const turbine::TurbineSystem& system) : system_(system) {
    const turbine::TurbineLayout& layout = system.layout();
    // The speed of a locked teeter has a component in turning axes, and is in no row but its own;
    // the angle is zero, as the padding is.
    std::vector<bool> left_out(static_cast<std::size_t>(system.size()), false);
    for (const int i : layout.padding()) left_out[static_cast<std::size_t>(i)] = true;
    for (const int i : {0, 1}) left_out[static_cast<std::size_t>(layout.teeter() + i)] = true;
    std::vector<bool> of_blade(left_out.size(), false);
    for (int k = 0; k < blades; ++k) {
      std::vector<int>& own = blade_[static_cast<std::size_t>(k)];
      for (int i = 0; i < static_cast<int>(left_out.size()); ++i)
        if (system.unknowns()[static_cast<std::size_t>(i)].owner.instance == k + 1)
          own.push_back(i);
      for (const int i : own) of_blade[static_cast<std::size_t>(i)] = true;
    }
    for (int i = 0; i < static_cast<int>(left_out.size()); ++i)
      if (!left_out[static_cast<std::size_t>(i)] && !of_blade[static_cast<std::size_t>(i)])
        fixed_.push_back(i);
  }

  /// Unknowns of a blade: zeta is (a0, ac, as), each of this size, then the rest.
  int blade_size() const { return static_cast<int>(blade_[0].size()); }
  int size() const { return blades * blade_size() + static_cast<int>(fixed_.size()); }

  /// Place in zeta of an unknown of tower or joints.
  int place_of(int unknown) const {
    const auto found = std::find(fixed_.begin(), fixed_.end(), unknown);
    return blades * blade_size() + static_cast<int>(found - fixed_.begin());
  }

  /// The system in multiblade coordinates at the time t of `solution`.
  MultibladeSystem at(double t, const analysis::PeriodicSolution& solution) const {
    const auto [K, M] = analysis::tangents_on(system_, solution, t);
    const double psi = system_.turbine().turning_at(t).value;
    const auto functions = [](double angle) {
      return Eigen::Vector3d(1.0, std::cos(angle), std::sin(angle));
    };
    const auto slopes = [](double angle) {
      return Eigen::Vector3d(0.0, -std::sin(angle), std::cos(angle));
    };
    // Mean, and twice the mean of the products with cosine and sine.
    const auto inverse = [&functions](double angle) {
      return Eigen::Vector3d(functions(angle).cwiseProduct(Eigen::Vector3d(1.0, 2.0, 2.0)) /
                             blades);
    };
    const Eigen::SparseMatrix<double> B = transformation(psi, functions, 1.0);
    const Eigen::SparseMatrix<double> B_slope = transformation(psi, slopes, 0.0);
    const Eigen::SparseMatrix<double> rows = transformation(psi, inverse, 1.0).transpose();
    MultibladeSystem result;
    result.K = rows * (K * B + system_.turbine().speed * (M * B_slope));
    result.M = rows * (M * B);
    return result;
  }

  /// The mean over `count` azimuths of a revolution.
  MultibladeSystem mean(int count, const analysis::PeriodicSolution& solution) const {
    MultibladeSystem sum = at(0.0, solution);
    for (int i = 1; i < count; ++i) {
      const MultibladeSystem more = at(system_.period() * i / count, solution);
      sum.K += more.K;
      sum.M += more.M;
    }
    sum.K /= count;
    sum.M /= count;
    return sum;
  }

 private:
  /// Unknowns of the turbine from zeta = (a0, ac, as, fixed).
  template <class Functions>
  Eigen::SparseMatrix<double> transformation(double psi, Functions functions,
                                             double of_fixed) const {
    std::vector<Eigen::Triplet<double>> entries;
    for (int k = 0; k < blades; ++k) {
      const Eigen::Vector3d value = functions(psi + 2.0 * pi * k / blades);
      for (int i = 0; i < blade_size(); ++i)
        for (int j = 0; j < blades; ++j)
          entries.emplace_back(blade_[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)],
                               j * blade_size() + i, value(j));
    }
    for (const int unknown : fixed_) entries.emplace_back(unknown, place_of(unknown), of_fixed);
    Eigen::SparseMatrix<double> matrix(system_.size(), size());
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }

  const turbine::TurbineSystem& system_;
  std::array<std::vector<int>, blades> blade_;
  std::vector<int> fixed_;
};

/// The modes with exponents nearest to the real `shift` > 0 and Im >= 0, up to the modulus
/// `fastest`, by Arnoldi's method for (K + shift M)^-1 M, whose eigenvalues are
/// 1/(shift - exponent); constraints have 0 there. Sorted by frequency.
inline std::vector<MultibladeMode> slow_modes(const MultibladeSystem& system, double shift,
                                              double fastest, int dimension = 120) {
  Eigen::SparseMatrix<double> shifted = system.K + shift * system.M;
  Eigen::SparseMatrix<double> mass = system.M;
  const Eigen::Index n = shifted.rows();
  // Rows and columns with largest entries of one.
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(n);
  for (int pass = 0; pass < 3; ++pass)
    for (const bool of_rows : {true, false}) {
      Eigen::VectorXd largest = Eigen::VectorXd::Zero(n);
      for (Eigen::Index j = 0; j < n; ++j)
        for (Eigen::SparseMatrix<double>::InnerIterator it(shifted, j); it; ++it) {
          double& entry = largest(of_rows ? it.row() : j);
          entry = std::max(entry, std::abs(it.value()));
        }
      const Eigen::VectorXd factor = largest.cwiseInverse();
      if (of_rows) {
        shifted = factor.asDiagonal() * shifted;
        mass = factor.asDiagonal() * mass;
      } else {
        shifted = shifted * factor.asDiagonal();
        mass = mass * factor.asDiagonal();
        scale = scale.cwiseProduct(factor);
      }
    }
  Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(shifted);
  const auto image = [&lu, &mass](const Eigen::VectorXd& v) {
    return Eigen::VectorXd(lu.solve(mass * v));
  };
  Eigen::MatrixXd basis(n, dimension + 1);
  Eigen::MatrixXd projection = Eigen::MatrixXd::Zero(dimension + 1, dimension);
  // Any start; two images of it obey the constraints and their rates.
  const Eigen::VectorXd start = Eigen::VectorXd::LinSpaced(n, 1.0, 30.0).array().sin();
  basis.col(0) = image(image(start)).normalized();
  for (int j = 0; j < dimension; ++j) {
    Eigen::VectorXd next = image(basis.col(j));
    for (int twice = 0; twice < 2; ++twice) {
      const Eigen::VectorXd along = basis.leftCols(j + 1).transpose() * next;
      next -= basis.leftCols(j + 1) * along;
      projection.col(j).head(j + 1) += along;
    }
    projection(j + 1, j) = next.norm();
    basis.col(j + 1) = next / projection(j + 1, j);
  }
  const Eigen::EigenSolver<Eigen::MatrixXd> pairs(projection.topRows(dimension));
  std::vector<MultibladeMode> modes;
  for (int i = 0; i < dimension; ++i) {
    const Complex exponent = shift - 1.0 / pairs.eigenvalues()(i);
    if (exponent.imag() < 0.0 || std::abs(exponent) > fastest) continue;
    MultibladeMode mode;
    mode.exponent = exponent;
    const Eigen::VectorXcd shape = basis.leftCols(dimension) * pairs.eigenvectors().col(i);
    const Eigen::VectorXcd change = (exponent - shift) * (mass * shape);
    mode.residual = (shifted * shape + change).norm() / change.norm();
    mode.shape = scale.cwiseProduct(shape);
    modes.push_back(mode);
  }
  std::sort(modes.begin(), modes.end(), [](const MultibladeMode& a, const MultibladeMode& b) {
    return a.exponent.imag() < b.exponent.imag();
  });
  return modes;
}

/// Frequencies [Hz] in fixed axes, ascending, of the mean over the azimuth. `sideways`: of each,
/// the motion of the tower top along n1 relative to that along n1 and n2.
inline std::vector<double> mean_frequencies(const io::Case& input,
                                            std::vector<double>* sideways = nullptr) {
  const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::Trim trim = analysis::find_trim(system, input.trim, observer);
  const Multiblade multiblade(system);
  const MultibladeSystem mean = system.period() > 0.0 ? multiblade.mean(12, trim.solution)
                                                      : multiblade.at(0.0, trim.solution);
  std::vector<double> found;
  for (const MultibladeMode& mode : slow_modes(mean, 2.0, 15.0)) {
    BOOST_TEST(mode.residual < 1e-8);
    if (mode.exponent.imag() < 0.1) continue;
    found.push_back(mode.exponent.imag() / (2.0 * pi));
    const int top = multiblade.place_of(system.layout().tower_tip());  // u_hat along n3, n1, n2
    if (sideways != nullptr)
      sideways->push_back(std::abs(mode.shape(top + 1)) / mode.shape.segment<2>(top + 1).norm());
  }
  return found;
}

}  // namespace samara::test
