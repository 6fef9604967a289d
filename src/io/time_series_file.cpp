#include "samara/io/time_series_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "samara/base/error.hpp"
#include "samara/io/whole_file.hpp"

#include "hdf5_reader.hpp"
#include "held_loads.hpp"
#include "time_series_datasets.hpp"

namespace samara::io {
namespace {

namespace fs = std::filesystem;

/// Longest time for which rows are only in memory.
constexpr std::chrono::seconds segment_time{2};
/// Most values that are collected in memory (64 MB).
constexpr std::size_t segment_values = std::size_t{8} << 20;

/// Ending of the file that reserves disk space, behind the run's name.
constexpr const char* room_ending = ".room";
constexpr std::uintmax_t least_room = std::uintmax_t{1} << 20;

/// True for RUN-000001.h5, with RUN of eight hexadecimal digits.
bool is_segment_name(std::string_view name) {
  constexpr std::string_view hexadecimal = "0123456789abcdef";
  constexpr std::string_view ending = ".h5";
  const std::size_t dash = name.find_first_not_of(hexadecimal);
  if (dash != 8 || name[dash] != '-' || !name.ends_with(ending)) return false;
  name.remove_prefix(dash + 1);
  name.remove_suffix(std::min(name.size(), ending.size()));
  return name.size() >= 6 && name.find_first_not_of(hexadecimal.substr(0, 10)) == name.npos;
}

std::string new_run_name() {
  std::random_device random;
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%08x", static_cast<unsigned>(random()));
  return text.data();
}

}  // namespace

TimeSeriesFile::TimeSeriesFile(const std::string& path, const Case& input, RunRecord record,
                               TimeSeriesContent content,
                               std::function<void(ResultFile&)> write_rest)
    : path_(resolved_path(path)),
      input_(input),
      record_(std::move(record)),
      write_rest_(std::move(write_rest)),
      content_(std::move(content)),
      run_(new_run_name()),
      due_(std::chrono::steady_clock::now() + segment_time) {
  content_.model = input.model_text;
  content_.status = "running";
  const std::size_t longest = longest_name_in(folder_of(path_));
  if (folder_name().size() > longest)
    throw InputError(path_ + ": the name of its folder " + folder_name() + " would have " +
                     std::to_string(folder_name().size()) + " bytes, the limit is " +
                     std::to_string(longest) + "; hint: -o gives the result a shorter name");
  note_replaced();
}

TimeSeriesFile::~TimeSeriesFile() { give_room(); }

void TimeSeriesFile::resume() {
  const TimeSeriesReader before(path_);
  const TimeSeriesContent& old = before.content();
  const auto name_of = [](const turbine::Channel& channel) { return channel.name; };
  if (!std::ranges::equal(old.channels, content_.channels, {}, name_of, name_of))
    throw InputError(path_ +
                     ": has other channels than this run; hint: -o gives the result another name");
  if (old.checkpoints.empty()) throw InternalError(path_ + ": has no checkpoint to resume from");
  content_.checkpoints = old.checkpoints;
  const std::size_t reached = old.checkpoints.back().rows;
  if (old.segments.empty()) {
    content_.time = before.read_time(0, reached);
    content_.values = before.read_values(0, reached);
    rows_ = reached;
    return;
  }
  for (const TimeSeriesSegment& segment : old.segments) {
    if (rows_ + segment.rows > reached) break;
    content_.segments.push_back(segment);
    rows_ += segment.rows;
  }
  if (rows_ != reached) throw InputError(path_ + ": its segments do not end at its checkpoint");
}

void TimeSeriesFile::append(double t, std::span<const double> values) {
  content_.time.push_back(t);
  content_.values.insert(content_.values.end(), values.begin(), values.end());
  ++rows_;
  if (content_.values.size() < segment_values && std::chrono::steady_clock::now() < due_) return;
  close_segment();
  publish();
}

void TimeSeriesFile::write_checkpoint(const analysis::TransientStart& point) {
  close_segment();
  add_checkpoint(point);
  publish();
}

void TimeSeriesFile::add_checkpoint(const analysis::TransientStart& point) {
  std::vector<TimeSeriesCheckpoint>& kept = content_.checkpoints;
  if (!kept.empty() && kept.back().rows == rows_) kept.pop_back();
  kept.push_back({point, rows_, events_});
  if (kept.size() > kept_checkpoints) kept.erase(kept.begin());
}

void TimeSeriesFile::finish(const std::string& status, const analysis::TransientStart* end) {
  give_room();
  if (!content_.segments.empty()) close_segment();
  content_.status = status;
  if (end != nullptr) add_checkpoint(*end);
  publish();
}

bool TimeSeriesFile::finish_failed(const std::string& status) noexcept {
  give_room();
  try {
    content_.status = status;
    if (!content_.segments.empty()) {
      publish();
      close_segment();
    }
    publish();
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

std::string TimeSeriesFile::folder_name() const {
  return fs::path(path_).filename().string() + ".parts";
}

fs::path TimeSeriesFile::folder() const { return fs::path(path_).parent_path() / folder_name(); }

void TimeSeriesFile::close_segment() {
  due_ = std::chrono::steady_clock::now() + segment_time;
  if (content_.time.empty()) return;
  std::error_code error;
  fs::create_directory(folder(), error);
  if (error) throw InternalError(folder().string() + ": cannot be created: " + error.message());
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "-%06d.h5", next_segment_++);
  const std::string name = run_ + number.data();
  Hdf5File file;
  const hsize_t rows = content_.time.size();
  file.write(series_time, content_.time, {rows}, meaning_of_series_time());
  file.write(series_values, content_.values, {rows, content_.channels.size()},
             {"see the result", "see the result", "the rows", {"time", "channel"}});
  write_whole_file((folder() / name).string(), file.image());
  content_.segments.push_back({folder_name() + "/" + name, content_.time.size()});
  content_.time.clear();
  content_.values.clear();
}

void TimeSeriesFile::publish() {
  ResultFile file(path_, input_, record_);
  write_rest_(file);
  file.write_series(content_);
  file.publish();
  if (content_.status == "running") keep_room();
  remove_replaced();
}

/// Notes the runs whose segments the existing result at the path has.
void TimeSeriesFile::note_replaced() {
  if (!is_result(path_)) return;
  try {
    const Hdf5Reader file(path_);
    if (!file.has(series_segment_file)) return;
    for (const std::string& segment : file.texts(series_segment_file))
      if (const fs::path name(segment);
          name.parent_path() == folder_name() && is_segment_name(name.filename().string()))
        replaced_.insert(name.filename().string().substr(0, run_.size()));
  } catch (const InputError&) {
    // The segments of a damaged result cannot be told from others.
  }
}

/// Removes the segments that this result no longer names, of runs that the previous result at its
/// path named. Nothing else in the folder is changed.
void TimeSeriesFile::remove_replaced() {
  if (replaced_.empty()) return;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder(), error)) {
    const std::string name = entry.path().filename().string();
    const std::string run = name.substr(0, run_.size());
    if (!replaced_.contains(run) || !(is_segment_name(name) || name == run + room_ending)) continue;
    const std::string listed = folder_name() + "/" + name;
    const bool is_named = std::ranges::any_of(
        content_.segments, [&listed](const TimeSeriesSegment& one) { return one.file == listed; });
    std::error_code ignored;
    if (!is_named) fs::remove(entry.path(), ignored);
  }
  replaced_.clear();
  fs::remove(folder(), error);  // only where it is empty
}

/// Reserves disk space for the last version of the result, which states how the run ended.
void TimeSeriesFile::keep_room() {
  if (content_.segments.empty()) return;
  std::error_code error;
  const auto size =
      static_cast<off_t>(std::max<std::uintmax_t>(least_room, 5 * fs::file_size(path_, error) / 2));
  if (error || size <= room_) return;
  const std::string place = (folder() / (run_ + room_ending)).string();
  const int file = ::open(place.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) return;
  if (::posix_fallocate(file, 0, size) == 0) room_ = size;
  ::close(file);
}

void TimeSeriesFile::give_room() noexcept {
  if (room_ > 0) ::unlink((folder() / (run_ + room_ending)).c_str());
  room_ = 0;
}

class TimeSeriesReader::Storage {
 public:
  explicit Storage(const std::string& path) : file(path) {}
  Hdf5Reader file;
};

TimeSeriesReader::TimeSeriesReader(const std::string& path) : path_(path) {
  storage_ = std::make_unique<Storage>(require_result(path));
  const Hdf5Reader& file = storage_->file;
  if (!file.has(series_time)) throw InputError(path + ": has no time series");
  const std::vector<std::string> names = file.texts("/transient/channel_name");
  const std::vector<std::string> units = file.texts("/transient/channel_unit");
  const std::vector<std::string> frames = file.texts("/transient/channel_frame");
  const std::vector<std::string> words = file.texts("/transient/channel_description");
  const std::size_t count = names.size();
  if (count == 0 || units.size() != count || frames.size() != count || words.size() != count)
    throw InputError(path + ": /transient/channel_name, _unit, _frame and _description differ");
  for (std::size_t i = 0; i < count; ++i)
    content_.channels.push_back({names[i], units[i], frames[i], words[i]});
  content_.status = file.text_attribute("/transient", "status");
  content_.model = file.text("/transient/model");
  if (file.has_attribute("/transient", "azimuth"))
    content_.azimuth = file.number_attribute("/transient", "azimuth");
  if (file.has_attribute("/transient", "brake_torque"))
    content_.brake_torque = file.number_attribute("/transient", "brake_torque");
  if (file.has_attribute("/transient", "generator_lost"))
    content_.is_generator_lost = file.number_attribute("/transient", "generator_lost") != 0.0;
  read_segments();
  read_checkpoints();
}

/// Reads the segments before the last ones that are missing or damaged. A crash of the machine may
/// cause that.
void TimeSeriesReader::read_segments() {
  const std::string& path = path_;
  const Hdf5Reader& file = storage_->file;
  const std::vector<hsize_t> times = file.shape(series_time);
  if (times.size() != 1 ||
      file.shape(series_values) != std::vector<hsize_t>{times[0], content_.channels.size()})
    throw InputError(path + ": " + series_values + " does not have a row for each of " +
                     series_time + " with a value of each channel");
  rows_ = times[0];
  const std::vector<std::string> segments = file.texts(series_segment_file);
  const std::vector<std::size_t> counts = file.counts(series_segment_rows);
  if (counts.size() != segments.size())
    throw InputError(path + ": " + series_segment_file + " and " + series_segment_rows +
                     " differ in length");
  for (const char* name : {series_time, series_values})
    for (const std::string& source : file.sources(name))
      if (std::ranges::find(segments, source) == segments.end())
        throw InputError(path + ": " + name + " shows " + source +
                         ", which is not one of its segments");
  if (segments.empty()) return;
  const std::size_t all = rows_;
  const fs::path folder = fs::path(resolved_path(path)).parent_path();
  rows_ = 0;
  std::vector<ExpectedFile> expected;
  for (std::size_t i = 0; i < segments.size(); ++i)
    expected.push_back(
        {(folder / segments[i]).string(),
         {{series_time, {counts[i]}}, {series_values, {counts[i], content_.channels.size()}}}});
  const std::vector<bool> whole = find_whole(expected);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::size_t rows = counts[i];
    const fs::path place = folder / segments[i];
    const bool is_whole = whole[i];
    if (is_whole && damage_.empty()) {
      content_.segments.push_back({segments[i], rows});
      rows_ += rows;
    } else if (damage_.empty()) {
      damage_ = path + ": its segment " + place.string() + " is missing or damaged";
    } else if (is_whole) {
      rows_ = 0;  // a gap
    }
    if (!damage_.empty() && rows_ == 0)
      throw InputError(damage_ + "; hint: the folder " +
                       fs::path(segments[i]).parent_path().string() +
                       " belongs to the file; samara export joins both in one file");
  }
  if (rows_ > all) throw InputError(path + ": its segments have more rows than the result itself");
  if (!damage_.empty())
    damage_ += ": " + std::to_string(rows_) + " of " + std::to_string(all) + " rows are left";
}

/// Reads the checkpoints that the rows reach, the oldest first.
void TimeSeriesReader::read_checkpoints() {
  const Hdf5Reader& file = storage_->file;
  for (const std::string group : series_checkpoints) {
    if (!file.has(group + "/state")) continue;
    TimeSeriesCheckpoint checkpoint;
    analysis::TransientStart& point = checkpoint.point;
    point.time = file.number_attribute(group, "time");
    point.origin = file.number_attribute(group, "origin");
    point.step = static_cast<long>(file.count_attribute(group, "step"));
    const std::vector<double> state = file.numbers(group + "/state");
    point.z =
        Eigen::Map<const Eigen::VectorXd>(state.data(), static_cast<Eigen::Index>(state.size()));
    if (file.has(group + "/rate")) {
      const std::vector<double> rate = file.numbers(group + "/rate");
      point.z_dot =
          Eigen::Map<const Eigen::VectorXd>(rate.data(), static_cast<Eigen::Index>(rate.size()));
    }
    if (!point.z.allFinite() || !point.z_dot.allFinite() || !std::isfinite(point.time) ||
        !std::isfinite(point.origin) ||
        (point.z_dot.size() > 0 && point.z_dot.size() != point.z.size()))
      throw InputError(path_ + ": " + group + " is not a valid state for a restart");
    point.held = read_held_loads(file, group);
    checkpoint.events = file.numbers(group + "/event_time");
    checkpoint.rows = file.count_attribute(group, "rows");
    if (checkpoint.rows <= rows_)
      content_.checkpoints.insert(content_.checkpoints.begin(), checkpoint);
  }
}

TimeSeriesReader::~TimeSeriesReader() = default;

std::vector<double> TimeSeriesReader::read_time(std::size_t first, std::size_t count) const {
  return storage_->file.slice(series_time, first, count);
}

std::vector<double> TimeSeriesReader::read_values(std::size_t first, std::size_t count) const {
  return storage_->file.slice(series_values, first, count, content_.channels.size());
}

}  // namespace samara::io
