// Names of the axes that datasets have, and of the entries along them (docs/case_file.md, Results).
#pragma once

#include <string>
#include <vector>

namespace samara::io {

inline constexpr char complex_axis[] = "re_im";
inline constexpr char vector_axis[] = "xyz";
inline constexpr char motion_axis[] = "displacement_rotation";
inline constexpr char node_axis[] = "node";
inline constexpr char mode_axis[] = "mode";
inline constexpr char unknown_axis[] = "unknown";
inline constexpr char channel_axis[] = "channel_name";

/// Names of the entries of an axis that has the same ones everywhere; empty: they have numbers.
std::vector<std::string> words_of_axis(const std::string& axis);

/// Names of the coefficients of a real Fourier series: mean, cos 1, sin 1, ...
std::vector<std::string> harmonic_names(int harmonics);

}  // namespace samara::io
