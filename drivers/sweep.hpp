// Values of a key of the case, as --sweep gives them.
#pragma once

#include <string>
#include <vector>

#include "samara/io/case.hpp"

namespace samara::drivers {

class Sweep {
 public:
  /// No sweep.
  Sweep() = default;
  /// Reads "KEY=FROM:TO:STEP", up to the last value that is not beyond TO, or "KEY=V1,V2,...".
  /// Reads and validates the case `path` with `settings` at each value.
  /// @throws InputError with the correct form, or with the faults of the first value that has some
  Sweep(const std::string& text, std::string path, std::vector<std::string> settings);

  bool is_given() const { return !key_.empty(); }
  const std::string& key() const { return key_; }
  const std::vector<double>& values() const { return values_; }
  /// The text of the case at each value, as Case::text.
  const std::vector<std::string>& case_texts() const { return case_texts_; }
  /// @throws InputError
  io::Case case_at(double value) const;

 private:
  std::string path_;
  std::vector<std::string> settings_;
  std::string key_;
  std::vector<double> values_;
  std::vector<std::string> case_texts_;
};

}  // namespace samara::drivers
