// Campbell diagrams: the points of a sweep as files while it runs, then the lines in a result and
// as comma-separated values (docs/case_file.md, "Results").
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "samara/io/point_files.hpp"
#include "samara/io/result_file.hpp"
#include "samara/simulation/campbell.hpp"

namespace samara::io {

/// The swept quantity.
struct SweptQuantity {
  std::string key;  ///< of the case file; "wind.speed" along the operating points
  std::string unit;
};

/// The points of a diagram as files.
class CampbellPointFiles : public PointFiles {
 public:
  using PointFiles::PointFiles;

  /// @throws InternalError if the file cannot be written
  void write(std::size_t point, const simulation::CampbellPoint& content) const;
  /// The point; none as in has(). @throws InputError as has(), and if the file is damaged
  std::optional<simulation::CampbellPoint> read(std::size_t point) const;
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
