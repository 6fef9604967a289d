// The records of Bladed's controller interface, numbered from 1 as in its manual.
#pragma once

#include <set>
#include <span>
#include <string>
#include <vector>

#include "samara/simulation/stepped_controller.hpp"

namespace samara::io {

/// Lengths of the texts that a library gets, without their ends.
struct BladedTexts {
  std::size_t input = 0;
  std::size_t output = 0;
  std::size_t room = 0;  ///< of each text
};

class BladedRecords {
 public:
  explicit BladedRecords(bool is_individual) : is_individual_(is_individual) {}

  /// Writes what the library reads. Other records keep what it wrote in earlier calls.
  void write(const simulation::ControlMeasurement& measured, const BladedTexts& texts,
             std::span<float> records) const;

  /// Reads the demands. A demand that is not followed gives a note, once.
  /// @throws ConvergenceError for values that are no numbers
  simulation::ControlDemand read(std::span<const float> records, std::size_t blades);

 private:
  bool is_individual_;
  std::set<int> noted_;
};

}  // namespace samara::io
