// Campbell diagrams: the points of a sweep as files while it runs, then the lines in a result and
// as comma-separated values (docs/case_file.md, "Results").
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "samara/io/result_file.hpp"
#include "samara/simulation/campbell.hpp"

namespace samara::io {

class Hdf5Reader;

/// The swept quantity.
struct SweptQuantity {
  std::string key;  ///< of the case file; "wind.speed" along the operating points
  std::string unit;
};

/// The points of a sweep, each a file of its own in the folder RESULT.h5.points from the moment
/// when it is found: a run that was ended goes on with the points that are there. The name of a
/// file comes from its origin, so that a finer sweep finds the points of a coarser one. Ranks may
/// write different points at the same time.
class CampbellPointFiles {
 public:
  /// `origins`: for each point a text that is equal only for the same case and options.
  CampbellPointFiles(const std::string& result_path, std::vector<std::string> origins);

  const std::string& folder() const { return folder_; }

  /// Whether the point has a file of its origin. @throws InputError if its file is not one of a
  /// point, or cannot be read
  bool has(std::size_t point) const;
  /// @throws InternalError if the file cannot be written
  void write(std::size_t point, const simulation::CampbellPoint& content) const;
  /// The point; none as in has(). @throws InputError as has(), and if the file is damaged
  std::optional<simulation::CampbellPoint> read(std::size_t point) const;
  /// Removes the files of points, also those of earlier runs that were ended, and the folder if
  /// nothing else is in it.
  void remove() const;

 private:
  std::string path_of(std::size_t point) const;
  /// The file of the point, if it has one of its origin; else null.
  std::unique_ptr<Hdf5Reader> open(std::size_t point) const;

  std::string folder_;
  std::vector<std::string> origins_;
};

/// Beginning of the table of comma-separated values.
inline constexpr std::string_view campbell_table_start = "value,mode,";

/// /campbell. `quantities`: one, or the two of a map.
void write_campbell(ResultFile& file, const std::vector<SweptQuantity>& quantities,
                    const std::vector<simulation::CampbellPoint>& points,
                    const std::vector<simulation::CampbellLine>& lines,
                    const std::vector<simulation::StabilityEdge>& edges, bool is_complete);

/// One line for each mode at each point.
void write_campbell_table(const std::string& path,
                          const std::vector<simulation::CampbellPoint>& points,
                          const std::vector<simulation::CampbellLine>& lines);

}  // namespace samara::io
