// Tangents of harmonic balance, kept as samples over a period (docs/theory.md, section 4.2).
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "samara/analysis/periodic_solution.hpp"
#include "samara/petsc/handle.hpp"
#include "samara/system/periodic_system.hpp"

#include "mesh_partition.hpp"

namespace samara::analysis {

/// Samples of a period, a multiple of the sectors of a symmetric rotor: with another number,
/// aliasing breaks the symmetry of the solution. Products of three factors, times the azimuth's own
/// cosine, do not alias; the equations of a medium, which are no polynomials, have more samples.
int sample_count(const system::PeriodicSystem& system, int harmonics);

/// Fourier weights of a sample at t: mean, then 2/N cos, 2/N sin (N `samples`, 2 H + 1 entries).
Eigen::VectorXd fourier_weights(int harmonics, double period, double t, int samples);

/// The linear map from coefficients x to those of K(t) x(t) + M(t) x_dot(t). Coefficient c of
/// unknown i has number i (2 H + 1) + c: mean, then cosine and sine of each harmonic. The load that
/// holds a coordinate is in the place of the coordinate's mean.
///
/// Among Q identical blades, every Floquet motion z(t) = exp(lambda t) Z(t) has an exponent with
/// P Z(t + T/Q) = Z(t), P of system::RotorSymmetry: each blade has the motion of the first one, T/Q
/// later or earlier, and unknowns that P does not move have the harmonics k = 0, Q, -Q, ... only
/// (k = Q/2, -Q/2, ... where P changes their sign). The map of such motions has the unknowns of the
/// first blade and those that P does not move; in rows of the latter, each blade contributes as
/// much as the first one. (The fast Floquet theory of docs/theory.md, section 5.4, for series.)
class HarmonicTangents {
 public:
  /// `by_sector`: motions as above, if the system has identical blades.
  HarmonicTangents(const system::PeriodicSystem& system, int harmonics, bool by_sector);
  /// The map of the unknowns on this rank, with the terms that this rank evaluates. Sums over the
  /// ranks are those of the whole system.
  HarmonicTangents(const MeshPartition& partition, const Coordinates& held, int harmonics);

  /// Evaluates K and M along `solution`.
  void sample(const PeriodicSolution& solution);

  Eigen::Index size() const { return size_; }  ///< unknowns of the map
  int sectors() const { return sectors_; }     ///< Q; 1: all blades are in the map
  const system::Unknown& unknown(Eigen::Index number) const {
    return system_.unknowns()[static_cast<std::size_t>(kept_[static_cast<std::size_t>(number)])];
  }
  /// Whether an unknown has a harmonic k.
  bool has(Eigen::Index unknown, int harmonic) const {
    const int remainder = remainder_[static_cast<std::size_t>(unknown)];
    return remainder == every || (harmonic - remainder) % sectors_ == 0;
  }
  /// From a series of the map's unknowns, k = -H ... H by row, to all unknowns of the system; and
  /// back.
  Eigen::MatrixXcd whole(const Eigen::MatrixXcd& series) const;
  Eigen::MatrixXcd part(const Eigen::MatrixXcd& whole) const;
  /// Whether the block of an unknown belongs to the border of the chains, or is not complete.
  bool is_border(Eigen::Index unknown) const {
    return is_border_[static_cast<std::size_t>(unknown)] != 0;
  }
  /// Null: one rank has the whole mesh.
  const MeshPartition* partition() const { return partition_; }
  int width() const { return width_; }  ///< coefficients of an unknown, 2 H + 1
  int harmonics() const { return harmonics_; }
  PetscInt block_size() const { return block_size_; }  ///< of the system's tangents; 1: none
  bool is_held(PetscInt unknown) const;
  /// Whether the load of this row holds the unknown; of a distributed mesh, a term of the first
  /// rank.
  bool holds(PetscInt row, PetscInt unknown) const;

  struct Place {
    PetscInt row = 0;
    PetscInt column = 0;
    PetscInt number = 0;  ///< in the pattern
  };
  const std::vector<Place>& places() const { return places_; }

  /// y = J x, both of size() width() coefficients. The rows of the border are complete.
  void multiply(const double* x, double* y) const;
  /// Coefficients of K(t) x(t) + M(t) w(t), for one or several x and w: each has size() columns.
  void multiply(const Eigen::MatrixXd& x, const Eigen::MatrixXd& w, Eigen::MatrixXd& y) const;
  /// Coefficients of M(t) w(t), in the same way.
  void multiply_mass(const Eigen::MatrixXd& w, Eigen::MatrixXd& y) const;
  /// Couplings of the coefficients of exp(i k Omega t), k = -H ... H, at a place: those of
  /// K + M d/dt + `shift` M. Zero for harmonics that the row or the column does not have.
  Eigen::MatrixXcd coupling(const Place& place, std::complex<double> shift) const;
  /// Means of K and M over the period, 2 x places.
  Eigen::MatrixXd means() const;
  /// The base frequency [rad/s]; without a period 2 pi.
  double rate() const;

  /// Row and column factors of all coefficients from the roles of unknowns (scale_by_role);
  /// `loads`: size of the internal loads, where inertia alone is less. The same for the border on
  /// all ranks.
  void scale(double loads, Eigen::VectorXd& rows, Eigen::VectorXd& columns) const;

  /// An AIJ matrix with the pattern of J.
  petsc::Handle<Mat> make_matrix() const;
  /// Fills it with J.
  void fill(Mat matrix) const;

 private:
  double period() const { return system_.period() > 0.0 ? system_.period() : 1.0; }
  bool is_moved(PetscInt unknown) const {
    return remainder_[static_cast<std::size_t>(unknown)] == every;
  }
  void make_map(TangentPattern& whole);
  void find_sectors(const TangentPattern& whole);
  void mark_border(const std::vector<char>& blocks);
  void find_followers();
  void count_operations(int parts, Eigen::Index columns) const;
  /// Sets the coefficients of harmonics that an unknown's row does not have to zero.
  void drop_absent(Eigen::MatrixXd& rows) const;
  /// Places of the entries of a tangent, in the order of MatrixEntries.
  std::vector<PetscInt> places_of(Mat tangent) const;
  void take_entries(Mat tangent, const std::vector<PetscInt>& places,
                    Eigen::Ref<Eigen::VectorXd> sample) const;

  const system::PeriodicSystem& system_;
  const MeshPartition* partition_ = nullptr;
  Coordinates held_;  ///< with numbers of the map
  int harmonics_;
  int width_;
  Eigen::Index size_;
  PetscInt block_size_ = 1;
  int sectors_ = 1;
  std::vector<PetscInt> kept_;    ///< unknowns of the system that are in the map
  std::vector<PetscInt> number_;  ///< of each unknown of the system in the map; -1: none
  static constexpr int every = -1;
  /// k mod Q of the harmonics of each unknown of the map that P does not move; `every` for others.
  std::vector<int> remainder_;
  std::vector<char> is_border_;
  TangentPattern pattern_;  ///< of K and M together
  std::vector<Place> places_;
  Eigen::MatrixXd values_of_;   ///< samples x width: the harmonics at the samples
  Eigen::MatrixXd projection_;  ///< width x samples: Fourier weights
  /// (2 width) x samples: weights of the real, then of the imaginary parts of the complex Fourier
  /// coefficients 0 ... 2 H.
  Eigen::MatrixXd to_series_;
  Eigen::MatrixXd sampled_;  ///< 2 samples x places: K, then M; rows of all blades summed
};

}  // namespace samara::analysis
