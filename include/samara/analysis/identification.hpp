// From the history of a mode over a period to its frequency, its parts and its name
// (docs/theory.md, section 5; Lee, Hodges & Patil (2002), eq. (20), (21)).
#pragma once

#include "samara/analysis/mode.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// The unknowns that kinetic energies need, each once.
std::vector<PetscInt> kinetic_unknowns(const system::PeriodicSystem& system);

/// Mean kinetic energy by part and harmonic.
class HarmonicEnergy {
 public:
  /// `unknowns`: rows of the histories, as kinetic_unknowns gives them.
  HarmonicEnergy(const system::PeriodicSystem& system, const std::vector<PetscInt>& unknowns);

  /// `history`: unknowns x samples of Z(t) exp(-lambda t) over one period. Finds the dominant
  /// harmonic of the part with most energy, the parts' shares (in the order of part_names) and
  /// `participation`, the share of every harmonic k = -floor(samples/2) ...
  const std::vector<std::string>& part_names() const { return parts_; }

  void identify(const Eigen::MatrixXcd& history, Mode& mode, Eigen::VectorXd& participation) const;

 private:
  struct Group {
    std::size_t part;
    std::vector<Eigen::Index> rows;
    Eigen::MatrixXd weight;
  };
  std::vector<std::string> parts_;
  std::vector<Group> groups_;
};

/// True where almost nothing strains: a rigid-body motion of the free joints. A strain's damping
/// counts with it: an overdamped motion of a beam is none of its joints.
bool is_rigid_body(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape,
                   const Mode& mode);

/// What modes are sorted by: |lambda| [rad/s], and 0 for real exponents slower than the rotor (or
/// 1 rad/s), which come in pairs that rounding must not sort.
double sorting_frequency(std::complex<double> exponent, double rotor_speed);

/// Scales every shape so that its largest position is 1, and its kinetic energy with it.
void scale_shapes(const system::PeriodicSystem& system, ModeSet& set);

/// Names modes by where their strain energy is, or by the joint that moves where nothing strains,
/// with symmetric or antisymmetric for two blades, numbered by frequency. Needs the shapes: where
/// there are none, labels stay empty.
void label_modes(const system::PeriodicSystem& system, ModeSet& set);

}  // namespace samara::analysis
