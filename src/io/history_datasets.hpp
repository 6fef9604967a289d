// Names and meanings of the datasets of a history that change when its segments are joined.
#pragma once

#include <array>
#include <vector>

#include "samara/io/history_file.hpp"
#include "samara/io/result_file.hpp"

#include "axes.hpp"
#include "hdf5_file.hpp"

namespace samara::io {

inline constexpr char history_time[] = "/transient/time";
inline constexpr char history_values[] = "/transient/values";
inline constexpr char history_segment_file[] = "/transient/segment_file";
inline constexpr char history_segment_rows[] = "/transient/segment_rows";

/// Of the last checkpoint, and of the one before.
inline constexpr std::array<const char*, kept_checkpoints> history_checkpoints{
    "/transient/checkpoint", "/transient/checkpoint_before"};

/// `checkpoints` in the order of time.
void write_checkpoints(Hdf5File& file, const std::vector<HistoryCheckpoint>& checkpoints);

inline Meaning meaning_of_history_time() { return {"s", "none", "of each row", {"time"}}; }
inline Meaning meaning_of_history_values() {
  return {"of channel_unit", "of channel_frame", "the rows", {"time", channel_axis}};
}
inline Meaning meaning_of_segment_file() {
  return {"",
          "none",
          "files that hold the rows, in the folder of this one; none: all here",
          {"segment_file"}};
}
inline Meaning meaning_of_segment_rows() {
  return {"1", "none", "rows of each segment", {"segment_file"}};
}

}  // namespace samara::io
