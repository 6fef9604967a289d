// A file that takes its name when it is complete.
#pragma once

#include <string>

namespace samara::io {

class NewFile {
 public:
  explicit NewFile(const std::string& path);
  /// Removes the temporary file where publish() was not reached.
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Where to write: in the same folder, so that a rename suffices.
  const std::string& temporary() const { return temporary_; }
  const std::string& path() const { return path_; }

  /// @throws InternalError
  void publish();

 private:
  std::string path_;
  std::string temporary_;
  bool published_ = false;
};

}  // namespace samara::io
