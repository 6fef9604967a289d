// Files that are there as a whole or not at all.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace samara::io {

/// Writes a temporary file in the same folder and gives it the name `path`. Where that fails the
/// temporary file is removed, and what was at `path` stays.
/// @throws InternalError
void write_whole_file(const std::string& path, std::span<const char> content);

/// The bytes of a file of at most `megabytes`; `kind` ("case file") names it in messages.
/// @throws InputError where there is no such file or it cannot be read
std::string read_whole_file(const std::string& path, std::size_t megabytes,
                            const std::string& kind);

/// False: nothing is at `path` yet.
/// @throws InputError where no file can be written there, whatever it holds
bool require_writable(const std::string& path);

}  // namespace samara::io
