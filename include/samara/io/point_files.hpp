// The points of a sweep, each a file of its own in the folder RESULT.h5.points from the moment when
// it is found: a run that was ended goes on with the points that are there.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace samara::io {

class Hdf5File;
class Hdf5Reader;

/// What all kinds of points have in common. The name of a file comes from the origin of its point,
/// so that a finer sweep finds the points of a coarser one. Ranks may write different points at the
/// same time.
class PointFiles {
 public:
  /// `origins`: for each point a text that is equal only for the same case and options.
  PointFiles(const std::string& result_path, std::vector<std::string> origins);

  const std::string& folder() const { return folder_; }

  /// Whether the point has a file of its origin. @throws InputError if its file is not one of a
  /// point, or cannot be read
  bool has(std::size_t point) const;
  /// Removes the files of points, also those of earlier runs that were ended, and the folder if
  /// nothing else is in it.
  void remove() const;

 protected:
  /// The file of the point, if it has one of its origin; else null. @throws InputError as has()
  std::unique_ptr<Hdf5Reader> open(std::size_t point) const;
  /// Adds the origin. @throws InternalError if the file cannot be written
  void save(std::size_t point, Hdf5File& file) const;
  /// @throws InputError
  [[noreturn]] void refuse(std::size_t point) const;

 private:
  std::string path_of(std::size_t point) const;

  std::string folder_;
  std::vector<std::string> origins_;
};

}  // namespace samara::io
