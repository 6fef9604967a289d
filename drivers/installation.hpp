// Files that belong to the program, in a checkout or installed.
#pragma once

#include <filesystem>
#include <string>

namespace samara::drivers {

/// The folder `name` beside the folder of the program (a checkout), or in share/samara there (an
/// installation); empty: there is none.
std::filesystem::path find_installed(const std::string& name);

}  // namespace samara::drivers
