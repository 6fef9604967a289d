// Linear models as a MAT-file of level 5, which MATLAB, Octave and scipy.io.loadmat read ("MAT-File
// Format", The MathWorks; header of 128 bytes, then one element per variable, not compressed).
#pragma once

#include <string>

#include "samara/linear/linearization.hpp"

namespace samara::io {

/// Writes rotor_speed and, for each form FORM, the variables FORM_A, _B, _C, _D (rows x columns;
/// with a third index over mean, cos 1, sin 1, ... if the form changes with the azimuth),
/// FORM_states, _inputs, _outputs (rows of characters, padded) and FORM_scale.
/// @throws InternalError if the file cannot be written
void write_mat_file(const std::string& path, const linear::Linearization& linearization);

/// @throws InputError if `path` cannot be written, or has another file than such a MAT-file
void require_mat_path(const std::string& path);

}  // namespace samara::io
