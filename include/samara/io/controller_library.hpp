// A controller library with the interface of Bladed (DISCON), in a process of its own: what a
// library does to its process - it may crash, exit, hang, or print - does not reach the run.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "samara/simulation/stepped_controller.hpp"

namespace samara::io {

/// Names that the run gives to a library.
struct ControllerFiles {
  std::filesystem::path folder;  ///< of the case: relative paths count from there
  std::string output;            ///< argument OUTNAME: beginning of the names of its output files
  /// The helper program; empty: samara-controller-host in the folder of this program.
  std::string helper;
};

class ControllerLibrary final : public simulation::SteppedController {
 public:
  /// Starts the helper, which loads the library.
  /// @throws InputError where library, procedure or input file cannot be used, after the name of
  /// the key
  ControllerLibrary(const simulation::ControllerSetup& setup, const ControllerFiles& files);
  ~ControllerLibrary() override;

  /// @throws ConvergenceError if the library fails, ends its process, is too slow, or gives no
  /// numbers
  simulation::ControlDemand call(const simulation::ControlMeasurement& measured) override;

 private:
  class Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace samara::io
