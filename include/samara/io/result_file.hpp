// Results of a run in one HDF5 file, and its tables as comma-separated values. The names are those
// of docs/case_file.md, "Results". Nothing is on the disk before all is complete: a run that fails
// leaves what was there before.
//
// Serial: one rank writes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "samara/analysis/floquet.hpp"
#include "samara/analysis/mode.hpp"
#include "samara/analysis/static_path.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/io/case.hpp"
#include "samara/linear/linearization.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace samara::io {

/// Version of the names and shapes below, the attribute `samara_schema` of the root.
inline constexpr int result_schema = 1;

/// Meaning of a dataset for its readers: its attributes, and a name for each of its axes. An axis
/// is an HDF5 dimension scale: the dataset of that name in the same group or one above, which lists
/// its entries; numbers from 1 are written where there is none. A list with its own name as its
/// axis becomes such a scale.
struct Meaning {
  std::string unit;  ///< "1" for a pure number
  std::string frame;
  std::string description;
  std::vector<std::string> axes{};
};

/// How a result came about: attributes of the root.
struct RunRecord {
  std::string command_line;
  std::string petsc_options;
  std::string libraries;
  int ranks = 1;
};

struct TimeSeriesContent;

class ResultFile {
 public:
  /// Starts the file with /case and the attributes of the root.
  ResultFile(const std::string& path, const Case& input, const RunRecord& record);
  ~ResultFile();
  ResultFile(const ResultFile&) = delete;
  ResultFile& operator=(const ResultFile&) = delete;

  /// /model: speed, period, unknowns.
  void write_model(const turbine::TurbineSystem& system);
  /// /trim
  void write_trim(const analysis::Trim& trim);
  /// /static
  void write_static(const analysis::StaticPath& path);
  /// /transient
  void write_series(const TimeSeriesContent& series);
  /// /floquet
  void write_floquet(const analysis::Floquet& floquet);
  /// /modes: what /floquet has, without what belongs to a period.
  void write_modes(const analysis::ModeSet& set);

  /// /linearize
  void write_linearization(const linear::Linearization& linearization);

  /// One number or a list of them; the groups of `name` are made.
  void write_value(const std::string& name, double value, const Meaning& meaning);
  void write_values(const std::string& name, const std::vector<double>& values,
                    const Meaning& meaning);
  /// Numbers of several axes, the last one running fastest; its groups are made.
  void write_array(const std::string& name, const std::vector<double>& values,
                   const std::vector<std::size_t>& shape, const Meaning& meaning);
  /// `group`/channel_name, channel_unit, channel_frame, channel_description.
  void write_channels(const std::string& group, const std::vector<turbine::Channel>& channels);
  void write_texts(const std::string& name, const std::vector<std::string>& texts,
                   const Meaning& meaning);
  /// Attributes of a group or dataset that exists.
  void set_attribute(const std::string& object, const std::string& name, const std::string& text);
  void set_attribute(const std::string& object, const std::string& name, double value);

  /// Writes the file. Call it last.
  /// @throws InternalError where the environment fails, e.g. the disk is full
  void publish();

 private:
  class Storage;
  std::unique_ptr<Storage> storage_;
};

/// @throws InputError where a result cannot be written at `path`: no such folder, no permission, or
/// something there that is not a result of this program.
void require_result_path(const std::string& path);

/// The same for a table.
void require_table_path(const std::string& path);

/// True for a file that begins like a table of this program.
bool is_table(const std::string& path);

/// `path` itself. @throws InputError where no result stands there that this version reads
std::string require_result(const std::string& path);

/// True for an HDF5 file that has the schema attribute of a result.
bool is_result(const std::string& path);

/// One line a mode, all digits; the columns have the names and units of /floquet.
void write_mode_table(const std::string& path, const analysis::ModeSet& set);

/// One line an unknown: name, unit, mean, cos 1, sin 1, ...
void write_trim_table(const std::string& path, const system::PeriodicSystem& system,
                      const analysis::Trim& trim);

/// One line a state: factor, Newton steps, residual and all unknowns by name.
void write_static_table(const std::string& path, const system::PeriodicSystem& system,
                        const analysis::StaticPath& states);

/// Name and version of the HDF5 library.
std::string file_library_version();

}  // namespace samara::io
