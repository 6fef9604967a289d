// Linear models as a MAT-file of level 5, which MATLAB, Octave and scipy.io.loadmat read ("MAT-File
// Format", The MathWorks; header of 128 bytes, then one element a variable, not compressed).
#pragma once

#include <string>

#include "samara/linear/linearization.hpp"

namespace samara::io {

/// For each form FORM the variables FORM_A, _B, _C, _D (rows x columns, and with a third index over
/// mean, cos 1, sin 1, ... where it changes with the azimuth), FORM_states, _inputs, _outputs
/// (rows of characters, padded), FORM_scale; and rotor_speed.
/// @throws InternalError where the environment fails
void write_mat_file(const std::string& path, const linear::Linearization& linearization);

/// @throws InputError where it cannot be written, or something else is there
void require_mat_path(const std::string& path);

}  // namespace samara::io
