// Tangents of harmonic balance, kept as samples over a period (docs/theory.md, section 4.2).
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "samara/analysis/periodic_solution.hpp"
#include "samara/petsc/handle.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Samples of a period with which products of three factors, times the azimuth's own cosine, do not
/// alias.
int sample_count(int harmonics);

/// Fourier weights of a sample at t: mean, then 2/N cos, 2/N sin (N samples, 2 H + 1 entries).
Eigen::VectorXd fourier_weights(int harmonics, double period, double t);

/// The linear map from coefficients x to those of K(t) x(t) + M(t) x_dot(t). Coefficient c of
/// unknown i has number i (2 H + 1) + c: mean, then cosine and sine of each harmonic. The load that
/// holds a coordinate is in the place of the coordinate's mean.
class HarmonicTangents {
 public:
  using Coordinates = std::vector<system::UnconstrainedCoordinate>;
  using Pattern = Eigen::SparseMatrix<double, Eigen::RowMajor, PetscInt>;

  HarmonicTangents(const system::PeriodicSystem& system, const Coordinates& held, int harmonics);

  /// Evaluates K and M along `solution`.
  void sample(const PeriodicSolution& solution);

  Eigen::Index size() const { return size_; }  ///< unknowns of the system
  int width() const { return width_; }         ///< coefficients of an unknown, 2 H + 1
  int harmonics() const { return harmonics_; }
  PetscInt block_size() const { return block_size_; }  ///< of the system's tangents; 1: none
  const Coordinates& held() const { return held_; }

  struct Place {
    PetscInt row = 0;
    PetscInt column = 0;
    PetscInt number = 0;  ///< in the pattern
  };
  const std::vector<Place>& places() const { return places_; }

  /// y = J x, both of size() width() coefficients; `places`: those that count.
  void multiply(const std::vector<Place>& places, const double* x, double* y) const;
  void multiply(const double* x, double* y) const { multiply(places_, x, y); }
  /// The width x width entries of J at a place of K and M.
  Eigen::MatrixXd block(const Place& place) const;
  /// Coefficients of the same harmonic: 1 x places for the mean, else 4 x places, in the order row
  /// cosine column cosine, row cosine column sine, row sine column cosine, row sine column sine.
  /// Without the loads that hold coordinates.
  Eigen::MatrixXd harmonic_part(int harmonic) const;

  /// Row and column factors of all coefficients from the roles of unknowns (scale_by_role);
  /// `loads`: size of the internal loads, where inertia alone is less.
  void scale(double loads, Eigen::VectorXd& rows, Eigen::VectorXd& columns) const;

  /// An AIJ matrix with the pattern of J.
  petsc::Handle<Mat> make_matrix() const;
  /// Fills it with J.
  void fill(Mat matrix) const;

 private:
  double period() const { return system_.period() > 0.0 ? system_.period() : 1.0; }
  bool is_held(PetscInt unknown) const;
  bool holds(PetscInt row, PetscInt unknown) const;
  /// Places of the entries of a tangent, in the order of MatrixEntries.
  std::vector<PetscInt> places_of(Mat tangent) const;
  void take_entries(Mat tangent, const std::vector<PetscInt>& places,
                    Eigen::Ref<Eigen::VectorXd> sample) const;

  const system::PeriodicSystem& system_;
  Coordinates held_;
  int harmonics_;
  int width_;
  Eigen::Index size_;
  PetscInt block_size_ = 1;
  Pattern pattern_;  ///< of K and M together; its values have no meaning
  std::vector<Place> places_;
  Eigen::MatrixXd values_of_;   ///< samples x width: the harmonics at the samples
  Eigen::MatrixXd rates_of_;    ///< samples x width: their rates
  Eigen::MatrixXd projection_;  ///< width x samples: Fourier weights
  /// width^2 x 2 samples: from the samples of an entry of K and M to its block, row by row.
  Eigen::MatrixXd to_block_;
  Eigen::MatrixXd sampled_;  ///< 2 samples x places: K, then M
};

}  // namespace samara::analysis
