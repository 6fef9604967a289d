// Files that are there as a whole or not at all.
#pragma once

#include <span>
#include <string>

namespace samara::io {

/// Writes a temporary file in the same folder and gives it the name `path`. Where that fails the
/// temporary file is removed, and what was at `path` stays.
/// @throws InternalError
void write_whole_file(const std::string& path, std::span<const char> content);

/// False: nothing is at `path` yet.
/// @throws InputError where no file can be written there, whatever it holds
bool require_writable(const std::string& path);

}  // namespace samara::io
