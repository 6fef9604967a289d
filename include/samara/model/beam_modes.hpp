// Small vibrations of a beam that is clamped at its root and carries only its own masses. Modal
// damping ratios refer to these vibrations (docs/theory.md, section 2.8).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "samara/model/beam.hpp"

namespace samara::model {

struct BeamMode {
  double frequency = 0.0;           ///< without damping [rad/s]
  Vector6 share = Vector6::Zero();  ///< shares of the strain energy by strain component
  int direction = 0;  ///< direction with the largest share, in the order of ModalDamping

  /// The damping ratio that mu [s] per strain component gives, to first order in it.
  double damping_ratio(const Vector6& mu) const { return 0.5 * frequency * mu.dot(share); }
};

/// All modes, with the strains of the beam's points as coordinates, by ascending frequency. Modes
/// with equal frequencies (round beams) are separated by direction.
std::vector<BeamMode> compute_beam_modes(const Beam& beam);

/// The first and the second mode of each direction, if they exist.
std::array<std::vector<BeamMode>, 3> first_modes(const Beam& beam);

/// mu per strain component for which the first mode of each direction has its damping ratio; zero
/// for a direction without a ratio. The mu of a bending strain is also the mu of its shear strain.
/// @throws InputError if a direction has no mode, or if no mu >= 0 gives these ratios.
Vector6 fit_damping(const Beam& beam, const ModalDamping& ratios);

}  // namespace samara::model
