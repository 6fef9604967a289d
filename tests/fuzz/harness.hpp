// Common parts of the harnesses. A harness is one function that reads bytes as the program would
// read them, and takes refusals (InputError, DomainError) as right answers: anything else is a
// finding.
//
// The function has libFuzzer's name. Built with clang it is driven by libFuzzer, else by
// driver.cpp, with the same options.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// Changes the input in place, to at most `most` bytes, and returns its new size; where a harness
/// has one it is taken in place of the driver's own changes.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed)
    __attribute__((weak));

/// The driver's own changes.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace samara::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A folder of this process below TMPDIR, which goes with it.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  /// Writes a file; the name may have folders, and nothing outside this one is touched.
  void write(const std::string& name, std::string_view content) const;
  /// Takes out all that was written.
  void clear() const;
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

/// Writes a deck, several files in one input, each behind a line `==== its name`; returns the name
/// of the first, which is the main file.
std::string write_deck(const Folder& folder, std::string_view text);

}  // namespace samara::fuzz
