// Tangents of harmonic balance, kept as samples over a period (docs/theory.md, section 4.2).
#pragma once

#include <array>
#include <complex>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "samara/analysis/periodic_solution.hpp"
#include "samara/petsc/handle.hpp"
#include "samara/system/periodic_system.hpp"

#include "mesh_partition.hpp"
#include "rotor_sector.hpp"

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
/// P Z(t + T/Q) = Z(t), which RotorSector describes. The map of such motions has the unknowns of
/// the first blade and those that P does not move; in rows of the latter, each blade contributes as
/// much as the first one. (The fast Floquet theory of docs/theory.md, section 5.4, for series.)
class HarmonicTangents {
 public:
  /// `by_sector`: motions as above, if the system has identical blades. `may_defer`: rows of
  /// followers may be taken out of the map, see deferred(); fewer instants are evaluated then.
  HarmonicTangents(const system::PeriodicSystem& system, int harmonics, bool by_sector,
                   bool may_defer = false);
  /// The map of the unknowns on this rank, with the terms that this rank evaluates. Sums over the
  /// ranks are those of the whole system. `may_defer`: as above.
  HarmonicTangents(const MeshPartition& partition, const Coordinates& held, int harmonics,
                   bool may_defer);

  /// Evaluates K and M along `solution`; collective. After an error, the samples before remain.
  /// With `may_defer`, all blades are evaluated at the instants of one sector where the solution
  /// repeats from blade to blade. `offset`: of the instants from the start of the period, in
  /// distances between them.
  void sample(const PeriodicSolution& solution, double offset = 0.0);

  /// How often it has sampled.
  int samplings() const { return samplings_; }

  /// The row of a follower that has only its own unknown in the map, with the factor 1. (In the
  /// system it has others.)
  struct Deferred {
    PetscInt number = 0;
    double factor = 1.0;  ///< of the unknown in the row of the system
  };
  /// Of the last samples.
  const std::vector<Deferred>& deferred() const { return deferred_; }

  Eigen::Index size() const { return size_; }      ///< unknowns of the map
  int sectors() const { return sector_.sectors; }  ///< Q; 1: all blades are in the map
  const system::Unknown& unknown(Eigen::Index number) const {
    return system_
        .unknowns()[static_cast<std::size_t>(sector_.kept[static_cast<std::size_t>(number)])];
  }
  /// Whether an unknown has a harmonic k.
  bool has(Eigen::Index unknown, int harmonic) const {
    return sector_.has(static_cast<PetscInt>(unknown), harmonic);
  }
  /// The unknowns of the map and their harmonics, those of followers once sampled.
  const RotorSector& sector() const { return sector_; }
  /// From a series of the map's unknowns, k = -H ... H by row, to all unknowns of the system; and
  /// back.
  Eigen::MatrixXcd whole(const Eigen::MatrixXcd& series) const;
  Eigen::MatrixXcd part(const Eigen::MatrixXcd& whole) const;
  /// Whether the block of an unknown belongs to the border of the chains, or is not complete.
  bool is_border(Eigen::Index unknown) const {
    return is_border_[static_cast<std::size_t>(unknown)] != 0;
  }
  /// Null: the mesh is not distributed.
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
  /// The first of these with the map that HarmonicPreconditioner factors: harmonics are coupled in
  /// rows and columns of the border only; others have the mean tangents in each harmonic.
  void multiply_uncoupled(const Eigen::MatrixXd& x, const Eigen::MatrixXd& w,
                          Eigen::MatrixXd& y) const;
  /// Couplings of the coefficients of exp(i k Omega t), k = -H ... H, at a place: those of
  /// K + M d/dt + `shift` M. Zero for harmonics that the row or the column does not have.
  void coupling(const Place& place, std::complex<double> shift,
                Eigen::Ref<Eigen::MatrixXcd> block) const;
  /// Means of K and M over the period, 2 x places.
  const Eigen::MatrixXd& means() const { return means_; }
  /// The base frequency [rad/s]; without a period 1.
  double rate() const;

  /// Row and column factors of all coefficients from the roles of unknowns (scale_by_role);
  /// `loads`: size of the internal loads, where inertia alone is less; `rate`: of the motions
  /// [rad/s]. The same for the border on all ranks.
  void scale(double loads, double rate, Eigen::VectorXd& rows, Eigen::VectorXd& columns) const;
  /// That of the highest harmonic; without harmonics 1.
  double highest_rate() const { return harmonics_ > 0 ? harmonics_ * rate() : 1.0; }

  /// An AIJ matrix with the pattern of J.
  petsc::Handle<Mat> make_matrix() const;
  /// Fills it with J.
  void fill(Mat matrix) const;

 private:
  double period() const;
  void make_map(TangentPattern& whole);
  void set_instants(double offset);
  int samples() const { return samples_; }
  double instant(int sample) const { return period() * (sample + offset_) / samples(); }
  void mark_border(const std::vector<char>& blocks);
  void find_followers();
  void keep_samples();
  void list_entries();
  using Series = Eigen::Matrix<std::complex<double>, Eigen::Dynamic, 2>;
  Series find_series(const Place& place) const;
  /// Entries by row that are not zero at all samples.
  struct Entries {
    std::vector<PetscInt> begin;  ///< the first one of each row, and their number
    std::vector<PetscInt> columns;
    std::vector<PetscInt> numbers;  ///< among the samples that are kept
    PetscInt count() const { return static_cast<PetscInt>(columns.size()); }
    /// The places come by row. Rows without entries have places as well. `sampled`: the number, or
    /// -1 where there are no values.
    void add(const Place& place, PetscInt sampled) {
      begin.resize(static_cast<std::size_t>(place.row) + 1, count());
      if (sampled < 0) return;
      columns.push_back(place.column);
      numbers.push_back(sampled);
    }
  };
  using EntriesOfBoth = std::array<Entries, 2>;  ///< of K and of M
  /// The samples of a tangent, without entries that are zero throughout: a product reads them one
  /// after the other.
  struct Samples {
    Eigen::MatrixXd values;        ///< samples x entries
    std::vector<PetscInt> number;  ///< of each place, among these entries; -1: zero
    bool has(const Place& place) const { return entry(place) >= 0; }
    auto of(const Place& place) const { return values.col(entry(place)); }
    PetscInt entry(const Place& place) const {
      return number[static_cast<std::size_t>(place.number)];
    }
  };
  void add_products(const EntriesOfBoth& both, int part, const Eigen::MatrixXd& values,
                    Eigen::MatrixXd& sums) const;
  void project(const Eigen::MatrixXd& values, Eigen::MatrixXd& y) const;
  void multiply(const EntriesOfBoth& entries, const Eigen::MatrixXd& x, const Eigen::MatrixXd& w,
                Eigen::MatrixXd& y) const;
  /// Of the entries of a tangent, by their numbers in the order of MatrixEntries, after some turns
  /// by a sector. Others are in no row or column of the map.
  struct EntryPlaces {
    struct Inside {
      PetscInt entry;
      PetscInt place;  ///< in the pattern of the map
      double factor;   ///< 1 or -1
    };
    struct Outside {
      PetscInt entry;
      PetscInt row;
      double scale;  ///< of the unknown
    };
    std::vector<Inside> inside;
    std::vector<Outside> outside;  ///< the pattern of the map
  };
  EntryPlaces places_of(Mat tangent, int turn) const;
  void take_entries(Mat tangent, const EntryPlaces& places,
                    Eigen::Ref<Eigen::VectorXd> sample) const;
  void require_pattern(Mat tangent, const EntryPlaces& places) const;
  void sample_all(const PeriodicSolution& solution, int turns, Eigen::MatrixXd& likeness);
  Eigen::MatrixXd likeness_of(Mat tangent, const std::vector<EntryPlaces>& places,
                              const Eigen::Ref<const Eigen::VectorXd>& turned) const;
  std::vector<PetscInt> unlike_rows(Eigen::MatrixXd likeness) const;
  bool defer(const std::vector<PetscInt>& rows);

  const system::PeriodicSystem& system_;
  const MeshPartition* partition_ = nullptr;
  Coordinates held_;  ///< with numbers of the map
  int harmonics_;
  int width_;
  int samples_ = 0;  ///< instants
  int samplings_ = 0;
  double offset_ = 0.0;  ///< of the instants, in distances between them
  Eigen::Index size_ = 0;
  PetscInt block_size_ = 1;
  RotorSector sector_;    ///< the unknowns of the map
  bool repeats_ = false;  ///< all blades at one instant are the first blade at several ones
  std::vector<char> is_follower_;  ///< of the unknowns of the map; empty: all blades are in it
  std::vector<Deferred> deferred_;
  std::vector<EntryPlaces> of_jacobian_;  ///< one for each turn
  std::vector<EntryPlaces> of_mass_;
  std::vector<char> is_border_;
  TangentPattern pattern_;  ///< of K and M together
  std::vector<Place> places_;
  Eigen::MatrixXd values_of_;   ///< samples x width: the harmonics at the samples
  Eigen::MatrixXd projection_;  ///< width x samples: Fourier weights
  /// (2 width) x samples: weights of the real, then of the imaginary parts of the complex Fourier
  /// coefficients 0 ... 2 H.
  Eigen::MatrixXd to_series_;
  /// 2 samples x places: K, then M; rows of all blades summed. Empty but while it samples.
  Eigen::MatrixXd sampled_;
  std::array<Samples, 2> kept_;  ///< of K and of M
  EntriesOfBoth all_;
  EntriesOfBoth of_border_;
  std::vector<Place> interior_;  ///< places of others that are not zero
  Eigen::MatrixXd means_;        ///< 2 x places
  Eigen::MatrixXcd series_;      ///< (2 width - 1) x 2 for each border place, by find_series()
  std::vector<Eigen::Index> series_of_;  ///< their first column, for each place; -1: not kept
};

}  // namespace samara::analysis
