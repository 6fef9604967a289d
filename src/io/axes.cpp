#include "axes.hpp"

namespace samara::io {

std::vector<std::string> words_of_axis(const std::string& axis) {
  if (axis == complex_axis) return {"re", "im"};
  if (axis == vector_axis) return {"x", "y", "z"};
  if (axis == motion_axis) return {"x", "y", "z", "about x", "about y", "about z"};
  return {};
}

std::vector<std::string> harmonic_names(int harmonics) {
  std::vector<std::string> names{"mean"};
  for (int k = 1; k <= harmonics; ++k) {
    names.push_back("cos " + std::to_string(k));
    names.push_back("sin " + std::to_string(k));
  }
  return names;
}

}  // namespace samara::io
