#include "sector_motion.hpp"

namespace samara::analysis {
namespace {

using Index = Eigen::Index;

/// (P y)_i = sign_i y_source(i).
Eigen::MatrixXcd turned_back(const system::RotorSymmetry& symmetry, const Eigen::MatrixXcd& z) {
  Eigen::MatrixXcd result(z.rows(), z.cols());
  for (Index i = 0; i < z.rows(); ++i) {
    const auto unknown = static_cast<std::size_t>(i);
    result.row(symmetry.source[unknown]) = symmetry.sign[unknown] * z.row(i);
  }
  return result;
}

}  // namespace

Eigen::MatrixXd turned(const system::RotorSymmetry& symmetry, const Eigen::MatrixXd& z) {
  Eigen::MatrixXd result(z.rows(), z.cols());
  for (Index i = 0; i < z.rows(); ++i) {
    const auto unknown = static_cast<std::size_t>(i);
    result.row(i) = symmetry.sign[unknown] * z.row(symmetry.source[unknown]);
  }
  return result;
}

Eigen::MatrixXd real_and_imaginary(const Eigen::MatrixXcd& columns) {
  Eigen::MatrixXd result(columns.rows(), 2 * columns.cols());
  for (Index i = 0; i < columns.cols(); ++i) {
    result.col(2 * i) = columns.col(i).real();
    result.col(2 * i + 1) = columns.col(i).imag();
  }
  return result;
}

Eigen::MatrixXcd shape_over_period(const system::RotorSymmetry& symmetry, int sectors,
                                   const SectorMotion& motion, std::complex<double> exponent) {
  const Index instants = motion.instants;
  const Eigen::Map<const Eigen::MatrixXd> real(motion.values, motion.unknowns, instants);
  const Eigen::Map<const Eigen::MatrixXd> imaginary(motion.values + real.size(), motion.unknowns,
                                                    instants);
  Eigen::MatrixXcd part(motion.unknowns, instants);
  for (Index k = 0; k < instants; ++k) {
    const double t = motion.first + static_cast<double>(k) * motion.distance;
    const std::complex<double> factor = std::exp(-exponent * t);
    part.col(k).real() = factor.real() * real.col(k) - factor.imag() * imaginary.col(k);
    part.col(k).imag() = factor.imag() * real.col(k) + factor.real() * imaginary.col(k);
  }
  if (sectors == 1) return part;
  Eigen::MatrixXcd whole(motion.unknowns, instants * sectors);
  for (int q = 0; q < sectors; ++q) {
    whole.middleCols(q * instants, instants) = part;
    if (q + 1 < sectors) part = turned_back(symmetry, part);
  }
  return whole;
}

}  // namespace samara::analysis
