// Refinement of eigenpairs in groups of neighbouring exponents (docs/theory.md, section 5.10).
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "samara/analysis/ranks.hpp"

#include "hill_pencil.hpp"
#include "hill_refinement.hpp"
#include "hill_search.hpp"

namespace samara::analysis {

/// Eigenpairs with neighbouring exponents.
struct HillGroup {
  std::vector<HillPair> pairs;
  double truncated_residual = std::numeric_limits<double>::infinity();  ///< in its own harmonics
  /// Of each pair: the residual in the time domain, or in a medium, whose answer to a motion has a
  /// long series, the change of the exponent since fewer harmonics, relative to unit_of_change().
  std::vector<double> residuals;
  std::vector<std::complex<double>> before_exponents;       ///< with fewer harmonics
  double before = std::numeric_limits<double>::infinity();  ///< residual with fewer harmonics
  bool is_neighbour = false;  ///< found with the present harmonics: may be a copy of another

  double residual() const { return *std::max_element(residuals.begin(), residuals.end()); }
};

HillPair conjugate_of(const HillPair& pair);

/// The series of the copy of a motion whose exponent is larger by i `shift` Omega: its harmonic k
/// is harmonic k + `shift` of `series`. Of `rows` harmonics, zero where `series` has none.
Eigen::MatrixXcd shifted_series(const Eigen::MatrixXcd& series, Eigen::Index shift,
                                Eigen::Index rows);

/// The copy of a pair's conjugate next to the pair has the exponent conj(lambda) + i s Omega, s a
/// multiple of Q. @returns s where both are so close to each other that two motions of one
/// frequency may be in their place, whose multipliers are real and negative; else 0
int neighbouring_conjugate(std::complex<double> exponent, int sectors, double speed);

/// The change of an exponent from one number of harmonics to another is relative to this [rad/s].
inline double unit_of_change(std::complex<double> exponent, double speed) {
  return std::max(std::abs(exponent), speed);
}

/// Groups of eigenpairs, with the conjugates of slow ones. `speed`: of the rotor [rad/s].
std::vector<HillGroup> groups_of(std::vector<HillPair> pairs, double speed);

/// Copies the groups of the first rank to all others.
void share_groups(const Ranks& ranks, std::vector<HillGroup>& groups);

/// Refines groups with the harmonics of a pencil. Every rank has all groups and refines some of
/// them; all ranks get the same result.
class HillGroups {
 public:
  /// `ranks`: those that share the groups; one, if the mesh of the pencil is distributed.
  HillGroups(const system::PeriodicSystem& system, const PeriodicSolution& solution,
             HillPencil& pencil, const Ranks& ranks)
      : system_(system),
        solution_(solution),
        pencil_(pencil),
        refinement_(pencil),
        ranks_(ranks),
        speed_(pencil.speed()) {}

  /// Refines all groups. Where the eigenvectors change much, another eigenpair next to it may have
  /// taken the place of the one that was meant: all that are near take the place of the group, or,
  /// with a medium, those that the shift leads to when it follows their exponents.
  void refine(std::vector<HillGroup>& groups, double tolerance);
  /// Refines the groups with enough harmonics to a smaller tolerance.
  void refine_further(std::vector<HillGroup>& groups, double tolerance);

 private:
  std::vector<std::vector<HillPair>> deal(const std::vector<HillGroup*>& groups, double tolerance);
  void replace(std::vector<HillGroup>& kept, const std::vector<HillPair>& before, HillGroup after,
               double tolerance);
  void follow(std::vector<HillGroup>& kept, const std::vector<HillPair>& before, double tolerance);
  void add_partners(std::vector<HillGroup>& groups, double tolerance);
  bool is_other(const HillRefinement::Result& result) const;
  std::vector<HillGroup> neighbours_of(const std::vector<HillPair>& pairs);
  bool has(const HillGroup& group, const HillPair& pair) const;
  void find_residuals(const std::vector<HillGroup*>& groups) const;
  void find_changes(HillGroup& group) const;

  const system::PeriodicSystem& system_;
  const PeriodicSolution& solution_;
  HillPencil& pencil_;
  HillRefinement refinement_;
  Ranks ranks_;
  double speed_;
};

}  // namespace samara::analysis
