// Results of a run in one HDF5 file, and its tables as comma-separated values. The names are those
// of docs/case_file.md, "Results". A file appears on the disk only when it is complete: a run that
// fails leaves the previous file unchanged.
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

/// Version of the names and shapes below; it is the attribute `samara_schema` of the root.
inline constexpr int result_schema = 1;

/// Meaning of a dataset for its readers: its attributes, and a name for each of its axes. An axis
/// is an HDF5 dimension scale: the dataset of that name in the same group or a group above, which
/// lists the entries of the axis. If there is none, one with numbers from 1 is written. A list with
/// its own name as its axis becomes such a scale.
struct Meaning {
  std::string unit;  ///< "1" for a pure number
  std::string frame;
  std::string description;
  std::vector<std::string> axes{};
};

/// Origin of a result: attributes of the root.
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
  /// /modes: the datasets of /floquet, except those that belong to a period.
  void write_modes(const analysis::ModeSet& set);

  /// /geometry in a periodic steady state, over a revolution.
  void write_geometry(const turbine::TurbineSystem& system, const analysis::Trim& trim);
  /// The same at the times of the shapes of modes, and the motions of its nodes in them, in `group`
  /// ("/floquet", "/modes").
  void write_geometry(const turbine::TurbineSystem& system, const analysis::Trim& trim,
                      const std::string& group, const analysis::ModeSet& set);
  /// The same in one state.
  void write_geometry(const turbine::TurbineSystem& system, double t, const Eigen::VectorXd& z);
  /// The same in the states of a path.
  void write_geometry(const turbine::TurbineSystem& system, const analysis::StaticPath& path);

  /// /linearize
  void write_linearization(const linear::Linearization& linearization);

  /// Writes one number or a list of numbers. Missing groups of `name` are created.
  void write_value(const std::string& name, double value, const Meaning& meaning);
  void write_values(const std::string& name, const std::vector<double>& values,
                    const Meaning& meaning);
  /// Writes numbers with several axes; the last axis runs fastest. Missing groups are created.
  void write_array(const std::string& name, const std::vector<double>& values,
                   const std::vector<std::size_t>& shape, const Meaning& meaning);
  /// Writes `group`/channel_name, channel_unit, channel_frame, channel_description.
  void write_channels(const std::string& group, const std::vector<turbine::Channel>& channels);
  void write_texts(const std::string& name, const std::vector<std::string>& texts,
                   const Meaning& meaning);
  /// Sets an attribute of an existing group or dataset.
  void set_attribute(const std::string& object, const std::string& name, const std::string& text);
  void set_attribute(const std::string& object, const std::string& name, double value);

  /// Writes the file. Call it last.
  /// @throws InternalError if the file cannot be written, e.g. because the disk is full
  void publish();

 private:
  class Storage;
  std::unique_ptr<Storage> storage_;
};

/// @throws InputError if a result cannot be written at `path`: no such folder, no permission, or a
/// file there that is not a result of this program.
void require_result_path(const std::string& path);

/// The same for a table.
void require_table_path(const std::string& path);

/// True for a file that begins like a table of this program.
bool is_table(const std::string& path);

/// Returns `path`. @throws InputError if it has no result that this version reads
std::string require_result(const std::string& path);

/// True for an HDF5 file that has the schema attribute of a result.
bool is_result(const std::string& path);

/// Writes one line per mode, with all digits; the columns have the names and units of /floquet.
void write_mode_table(const std::string& path, const analysis::ModeSet& set);

/// Writes one line per unknown: name, unit, mean, cos 1, sin 1, ...
void write_trim_table(const std::string& path, const system::PeriodicSystem& system,
                      const analysis::Trim& trim);

/// Writes one line per state: factor, Newton steps, residual and all unknowns by name.
void write_static_table(const std::string& path, const system::PeriodicSystem& system,
                        const analysis::StaticPath& states);

/// Name and version of the HDF5 library.
std::string file_library_version();

}  // namespace samara::io
