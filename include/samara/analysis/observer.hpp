// Notes and progress of a long analysis.
#pragma once

#include <string>

namespace samara::analysis {

class Observer {
 public:
  Observer() = default;
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;
  virtual ~Observer() = default;
  /// A fact that the user should know.
  virtual void note(const std::string& text) { (void)text; }
  /// `done` of `all` steps of a stage are complete; called often.
  virtual void progress(const std::string& stage, long done, long all) {
    (void)stage;
    (void)done;
    (void)all;
  }
};

}  // namespace samara::analysis
