// Values of one or two keys of the case, as --sweep gives them.
#pragma once

#include <string>
#include <vector>

#include "samara/io/case.hpp"
#include "samara/simulation/campbell.hpp"

namespace samara::drivers {

class Sweep {
 public:
  /// No sweep.
  Sweep() = default;
  /// Reads one or two texts "KEY=FROM:TO:STEP", up to the last value that is not beyond TO, or
  /// "KEY=V1,V2,...". Reads and validates the case `path` with `settings` at each place.
  /// @throws InputError with the correct form, or with the faults of the first place that has some
  Sweep(const std::vector<std::string>& texts, std::string path, std::vector<std::string> settings);

  bool is_given() const { return !keys_.empty(); }
  const std::vector<std::string>& keys() const { return keys_; }
  /// All values of the first key; of a map for each of the second one, there and back in turn, so
  /// that neighbours on the list differ in one key.
  const std::vector<simulation::SweepPlace>& places() const { return places_; }
  /// The text of the case at each place, as Case::text.
  const std::vector<std::string>& case_texts() const { return case_texts_; }
  /// @throws InputError
  io::Case case_at(const simulation::SweepPlace& place) const;

 private:
  std::string path_;
  std::vector<std::string> settings_;
  std::vector<std::string> keys_;
  std::vector<simulation::SweepPlace> places_;
  std::vector<std::string> case_texts_;
};

}  // namespace samara::drivers
