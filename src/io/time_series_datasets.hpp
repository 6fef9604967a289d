// Names and meanings of the datasets of a time series that change when its segments are joined.
#pragma once

#include <array>
#include <vector>

#include "samara/io/result_file.hpp"
#include "samara/io/time_series_file.hpp"

#include "axes.hpp"
#include "hdf5_file.hpp"

namespace samara::io {

inline constexpr char series_time[] = "/transient/time";
inline constexpr char series_values[] = "/transient/values";
inline constexpr char series_segment_file[] = "/transient/segment_file";
inline constexpr char series_segment_rows[] = "/transient/segment_rows";

/// Groups of the last checkpoint, and of the one before.
inline constexpr std::array<const char*, kept_checkpoints> series_checkpoints{
    "/transient/checkpoint", "/transient/checkpoint_before"};

/// `checkpoints` in the order of time.
void write_checkpoints(Hdf5File& file, const std::vector<TimeSeriesCheckpoint>& checkpoints);

inline Meaning meaning_of_series_time() { return {"s", "none", "time of each row", {"time"}}; }
inline Meaning meaning_of_series_values() {
  return {"see channel_unit", "see channel_frame", "the rows", {"time", channel_axis}};
}
inline Meaning meaning_of_segment_file() {
  return {"",
          "none",
          "files with the rows, relative to the folder of this one; empty: all rows are here",
          {"segment_file"}};
}
inline Meaning meaning_of_segment_rows() {
  return {"1", "none", "number of rows of each segment", {"segment_file"}};
}

}  // namespace samara::io
