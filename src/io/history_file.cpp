#include "samara/io/history_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/io/whole_file.hpp"

#include "hdf5_reader.hpp"
#include "held_loads.hpp"
#include "history_datasets.hpp"

namespace samara::io {
namespace {

namespace fs = std::filesystem;

/// Rows are lost for no longer than this.
constexpr std::chrono::seconds segment_time{2};
/// Values that are gathered at the most (64 MB).
constexpr std::size_t segment_values = std::size_t{8} << 20;

std::string new_run_name() {
  std::random_device random;
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%08x", static_cast<unsigned>(random()));
  return text.data();
}

}  // namespace

HistoryFile::HistoryFile(std::string path, const Case& input, RunRecord record,
                         HistoryContent content, std::function<void(ResultFile&)> write_rest)
    : path_(std::move(path)),
      input_(input),
      record_(std::move(record)),
      write_rest_(std::move(write_rest)),
      content_(std::move(content)),
      run_(new_run_name()),
      due_(std::chrono::steady_clock::now() + segment_time) {
  content_.model = input.model_text;
  content_.status = "running";
}

void HistoryFile::resume() {
  const HistoryReader before(path_);
  const HistoryContent& old = before.content();
  const auto name_of = [](const system::Channel& channel) { return channel.name; };
  if (!std::ranges::equal(old.channels, content_.channels, {}, name_of, name_of))
    throw InputError(path_ +
                     ": has other channels than this run; hint: -o gives the result another name");
  content_.checkpoint = old.checkpoint;
  content_.checkpoint_rows = old.checkpoint_rows;
  content_.checkpoint_events = old.checkpoint_events;
  if (old.segments.empty()) {
    content_.time = before.read_time(0, old.checkpoint_rows);
    content_.values = before.read_values(0, old.checkpoint_rows);
    rows_ = old.checkpoint_rows;
    return;
  }
  for (const HistorySegment& segment : old.segments) {
    if (rows_ + segment.rows > old.checkpoint_rows) break;
    content_.segments.push_back(segment);
    rows_ += segment.rows;
  }
  if (rows_ != old.checkpoint_rows)
    throw InputError(path_ + ": its segments do not end at its checkpoint");
}

void HistoryFile::append(double t, std::span<const double> values) {
  content_.time.push_back(t);
  content_.values.insert(content_.values.end(), values.begin(), values.end());
  ++rows_;
  if (content_.values.size() < segment_values && std::chrono::steady_clock::now() < due_) return;
  close_segment();
  publish();
}

void HistoryFile::write_checkpoint(const analysis::TransientStart& point) {
  close_segment();
  content_.checkpoint = point;
  content_.checkpoint_rows = rows_;
  content_.checkpoint_events = events_;
  publish();
}

void HistoryFile::finish(const std::string& status, const analysis::TransientStart* end) {
  if (!content_.segments.empty()) close_segment();
  content_.status = status;
  if (end != nullptr) {
    content_.checkpoint = *end;
    content_.checkpoint_rows = rows_;
    content_.checkpoint_events = events_;
  }
  publish();
  remove_strangers();
}

std::string HistoryFile::folder_name() const { return fs::path(path_).stem().string() + ".parts"; }

void HistoryFile::close_segment() {
  due_ = std::chrono::steady_clock::now() + segment_time;
  if (content_.time.empty()) return;
  const fs::path folder = fs::path(path_).parent_path() / folder_name();
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InternalError(folder.string() + ": cannot be made: " + error.message());
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "-%06d.h5", next_segment_++);
  const std::string name = folder_name() + "/" + run_ + number.data();
  Hdf5File file;
  const hsize_t rows = content_.time.size();
  file.write(history_time, content_.time, {rows}, meaning_of_history_time());
  file.write(history_values, content_.values, {rows, content_.channels.size()},
             {"see the result", "see the result", "[row, channel]"});
  write_whole_file((fs::path(path_).parent_path() / name).string(), file.image());
  content_.segments.push_back({name, content_.time.size()});
  content_.time.clear();
  content_.values.clear();
}

void HistoryFile::publish() {
  ResultFile file(path_, input_, record_);
  write_rest_(file);
  file.write_history(content_);
  file.publish();
}

/// Segments that no result names: of runs that this one has taken the place of.
void HistoryFile::remove_strangers() const {
  const fs::path folder = fs::path(path_).parent_path() / folder_name();
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = folder_name() + "/" + entry.path().filename().string();
    const bool is_named = std::ranges::any_of(
        content_.segments, [&name](const HistorySegment& one) { return one.file == name; });
    std::error_code ignored;
    if (!is_named && entry.path().extension() == ".h5") fs::remove(entry.path(), ignored);
  }
  fs::remove(folder, error);  // only where it is empty
}

class HistoryReader::Storage {
 public:
  explicit Storage(const std::string& path) : file(path) {}
  Hdf5Reader file;
};

HistoryReader::HistoryReader(const std::string& path) {
  if (!fs::exists(path)) throw InputError(path + ": no such file");
  if (!is_result(path)) throw InputError(path + ": is no result of samara");
  storage_ = std::make_unique<Storage>(path);
  const Hdf5Reader& file = storage_->file;
  if (!file.has(history_time)) throw InputError(path + ": has no time history");
  const std::vector<std::string> names = file.texts("/transient/channel_name");
  const std::vector<std::string> units = file.texts("/transient/channel_unit");
  const std::vector<std::string> frames = file.texts("/transient/channel_frame");
  const std::vector<std::string> words = file.texts("/transient/channel_description");
  for (std::size_t i = 0; i < names.size(); ++i)
    content_.channels.push_back({names[i], units.at(i), frames.at(i), words.at(i)});
  content_.status = file.text_attribute("/transient", "status");
  content_.model = file.text("/transient/model");
  if (file.has_attribute("/transient", "azimuth"))
    content_.azimuth = file.number_attribute("/transient", "azimuth");
  if (file.has_attribute("/transient", "brake_torque"))
    content_.brake_torque = file.number_attribute("/transient", "brake_torque");
  if (file.has_attribute("/transient", "generator_lost"))
    content_.is_generator_lost = file.number_attribute("/transient", "generator_lost") != 0.0;
  const std::vector<std::string> segments = file.texts("/transient/segment_file");
  const std::vector<double> counts = file.numbers("/transient/segment_rows");
  for (std::size_t i = 0; i < segments.size(); ++i) {
    content_.segments.push_back({segments[i], static_cast<std::size_t>(counts.at(i))});
    const fs::path place = fs::path(path).parent_path() / segments[i];
    const bool is_whole =
        fs::exists(place) && Hdf5Reader(place.string()).has(history_values) &&
        Hdf5Reader(place.string()).shape(history_values).at(0) == content_.segments.back().rows;
    if (!is_whole)
      throw InputError(path + ": its segment " + place.string() +
                       " is missing or damaged; hint: the folder " +
                       fs::path(segments[i]).parent_path().string() +
                       " belongs to the file, samara export makes one of both");
  }
  rows_ = file.shape(history_time).at(0);
  if (!file.has("/transient/checkpoint/state")) return;
  analysis::TransientStart point;
  point.time = file.number_attribute("/transient/checkpoint", "time");
  point.origin = file.number_attribute("/transient/checkpoint", "origin");
  point.step = std::lround(file.number_attribute("/transient/checkpoint", "step"));
  const std::vector<double> state = file.numbers("/transient/checkpoint/state");
  point.z =
      Eigen::Map<const Eigen::VectorXd>(state.data(), static_cast<Eigen::Index>(state.size()));
  if (file.has("/transient/checkpoint/rate")) {
    const std::vector<double> rate = file.numbers("/transient/checkpoint/rate");
    point.z_dot =
        Eigen::Map<const Eigen::VectorXd>(rate.data(), static_cast<Eigen::Index>(rate.size()));
  }
  point.held = read_held_loads(file, "/transient/checkpoint");
  content_.checkpoint = point;
  content_.checkpoint_events = file.numbers("/transient/checkpoint/event_time");
  content_.checkpoint_rows =
      static_cast<std::size_t>(file.number_attribute("/transient/checkpoint", "rows"));
}

HistoryReader::~HistoryReader() = default;

std::vector<double> HistoryReader::read_time(std::size_t first, std::size_t count) const {
  return storage_->file.slice(history_time, first, count);
}

std::vector<double> HistoryReader::read_values(std::size_t first, std::size_t count) const {
  return storage_->file.slice(history_values, first, count);
}

}  // namespace samara::io
