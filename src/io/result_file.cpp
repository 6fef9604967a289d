#include "samara/io/result_file.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include <unistd.h>

#include "samara/base/error.hpp"
#include "samara/base/version.hpp"
#include "samara/io/campbell_file.hpp"
#include "samara/io/load_result.hpp"
#include "samara/io/operation_table.hpp"
#include "samara/io/time_series_export.hpp"
#include "samara/io/time_series_file.hpp"
#include "samara/io/whole_file.hpp"

#include "axes.hpp"
#include "geometry_groups.hpp"
#include "hdf5_file.hpp"
#include "hdf5_trial.hpp"
#include "held_loads.hpp"
#include "linear_groups.hpp"
#include "time_series_datasets.hpp"

namespace samara::io {
namespace {

namespace fs = std::filesystem;
using analysis::Mode;
using analysis::ModeSet;

constexpr char schema_attribute[] = "samara_schema";
constexpr std::string_view mode_table_start = "number,label,";
constexpr std::string_view trim_table_start = "name,unit,mean";
constexpr std::string_view static_table_start = "factor,newton_steps,";
constexpr std::array<std::string_view, 7> table_starts{
    mode_table_start, trim_table_start,      static_table_start,  series_table_start,
    load_table_start, operation_table_start, campbell_table_start};

/// Harmonics of the participation are kept up to the last ones in which a mode has this share.
constexpr double smallest_share = 1e-9;

/// Instants of a revolution at which the places of the nodes are written.
constexpr int geometry_instants = 24;

constexpr char no_frame[] = "none";
constexpr char mode_frame[] = "frame of each part: tower, nacelle fixed; blades, hub rotating";
constexpr char unknown_frame[] =
    "u, theta: axes of the beam's root; V, Omega, F, M: deformed section; root F, M: axes of the "
    "root; tower top V, Omega: axes of the top; joints: about their axis";

std::string now_in_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

double per_rev(const Mode& mode, double rotor_speed) { return mode.exponent.imag() / rotor_speed; }

double hertz(const Mode& mode) { return mode.exponent.imag() / (2.0 * std::numbers::pi); }

/// True if the frequency in the fixed frame is known and differs from that in the rotor's frame.
bool has_fixed_frame(const ModeSet& set) { return set.rotor_speed > 0.0 && set.instances > 2; }

double fixed_frame_hertz(const Mode& mode) {
  return mode.fixed_frame_frequency / (2.0 * std::numbers::pi);
}

template <class Value>
std::vector<double> collect(const ModeSet& set, const Value& value) {
  std::vector<double> values;
  for (const Mode& mode : set.modes) values.push_back(value(mode));
  return values;
}

/// [mode, re/im]
template <class Value>
std::vector<double> collect_complex(const ModeSet& set, const Value& value) {
  std::vector<double> values;
  for (const Mode& mode : set.modes) {
    values.push_back(value(mode).real());
    values.push_back(value(mode).imag());
  }
  return values;
}

std::vector<std::string> part_names(const ModeSet& set) {
  std::vector<std::string> names;
  for (const Mode& mode : set.modes)
    for (const analysis::PartShare& part : mode.parts)
      if (std::find(names.begin(), names.end(), part.part) == names.end())
        names.push_back(part.part);
  std::sort(names.begin(), names.end());
  return names;
}

/// Writes the data that Floquet modes and constant modes have in common below `group`.
void write_mode_set(Hdf5File& file, const std::string& group, const ModeSet& set) {
  const hsize_t count = set.modes.size();
  file.write(group + "/exponents", collect_complex(set, [](const Mode& m) { return m.exponent; }),
             {count, 2},
             {"rad/s",
              mode_frame,
              "lambda + i k Omega with the identified harmonic k, im >= 0",
              {mode_axis, complex_axis}});
  file.write(group + "/error", collect(set, [](const Mode& m) { return total_error(m); }), {count},
             {"1",
              mode_frame,
              "estimated error of the exponent, relative to its modulus: the sum of error_step, "
              "error_mesh and error_round_off",
              {mode_axis}});
  file.write(group + "/error_step", collect(set, [](const Mode& m) { return m.step_error; }),
             {count}, {"1", mode_frame, "error from the time step", {mode_axis}});
  file.write(group + "/error_mesh", collect(set, [](const Mode& m) { return m.mesh_error; }),
             {count},
             {"1", mode_frame, "error from the mesh; 0 if the mode is not resolved", {mode_axis}});
  file.write(group + "/error_round_off",
             collect(set, [](const Mode& m) { return m.round_off_error; }), {count},
             {"1", mode_frame, "error from round-off", {mode_axis}});
  file.write(group + "/error_growth", collect(set, [](const Mode& m) { return m.growth_error; }),
             {count},
             {"1/s", mode_frame, "estimated error of the real part of the exponent", {mode_axis}});
  file.write(group + "/frequency_hz", collect(set, hertz), {count},
             {"Hz", mode_frame, "imaginary part of the exponent over 2 pi", {mode_axis}});
  if (set.rotor_speed > 0.0)
    file.write(
        group + "/frequency_per_rev",
        collect(set, [&](const Mode& m) { return per_rev(m, set.rotor_speed); }), {count},
        {"1/rev", mode_frame, "imaginary part of the exponent over the rotor speed", {mode_axis}});
  if (has_fixed_frame(set))
    file.write(group + "/fixed_frame_frequency_hz", collect(set, fixed_frame_hertz), {count},
               {"Hz",
                "fixed",
                "frequency in the fixed frame; not-a-number if it is not a single one",
                {mode_axis}});
  file.write(
      group + "/damping_ratio", collect(set, [](const Mode& m) { return m.damping_ratio; }),
      {count},
      {"1", no_frame, "- re / abs of the exponent; 0 if the exponent counts as zero", {mode_axis}});
  file.write(group + "/residual", collect(set, [](const Mode& m) { return m.residual; }), {count},
             {"1", no_frame, "relative norm of the error with which the mode closes", {mode_axis}});
  std::vector<std::string> labels;
  std::vector<int> resolved;
  for (const Mode& mode : set.modes) {
    labels.push_back(mode.label + (mode.resolved ? "" : " (unresolved)"));
    resolved.push_back(mode.resolved ? 1 : 0);
  }
  file.write(group + "/label", labels,
             {"", no_frame, "name of the mode; (unresolved): not reliable", {mode_axis}});
  file.write(
      group + "/resolved", resolved,
      {"1", no_frame, "1: resolved by the time step, with a small residual; 0: not", {mode_axis}});
  const std::vector<std::string> parts = part_names(set);
  std::vector<double> shares(set.modes.size() * parts.size(), 0.0);
  for (std::size_t m = 0; m < set.modes.size(); ++m)
    for (const analysis::PartShare& part : set.modes[m].parts)
      shares[m * parts.size() +
             static_cast<std::size_t>(std::find(parts.begin(), parts.end(), part.part) -
                                      parts.begin())] = part.share;
  file.write(group + "/part", parts, {"", no_frame, "names of the parts in part_share", {"part"}});
  file.write(group + "/part_share", shares, {count, parts.size()},
             {"1", mode_frame, "share of the mean kinetic energy", {mode_axis, "part"}});
  file.set_attribute(group, "degrees_of_freedom", set.degrees_of_freedom);
  file.set_attribute(group, "rotor_speed", set.rotor_speed);
  file.set_attribute(group, "states", set.states);
  file.set_attribute(group, "states_found", set.found);
  file.set_attribute(group, "states_deflated", set.deflated);
  file.set_attribute(group, "deflated_rate", set.deflated_rate);
  file.set_attribute(group, "reach_hz", set.reach / (2.0 * std::numbers::pi));
  if (!set.searched) return;
  file.set_attribute(group, "searched_from_hz", set.searched->low / (2.0 * std::numbers::pi));
  file.set_attribute(group, "searched_to_hz", set.searched->high / (2.0 * std::numbers::pi));
  file.set_attribute(group, "searched_decay", set.searched->decay);
  file.set_attribute(group, "searched_growth", set.searched->growth);
  file.set_attribute(group, "searched_is_counted", set.searched->is_counted ? 1 : 0);
}

void write_shapes(Hdf5File& file, const std::string& group, const ModeSet& set) {
  const auto some = std::find_if(set.shapes.begin(), set.shapes.end(),
                                 [](const Eigen::MatrixXcd& shape) { return shape.size() > 0; });
  if (some == set.shapes.end()) return;
  const auto size = static_cast<std::size_t>(some->rows());
  const auto samples = static_cast<std::size_t>(some->cols());
  file.write(group + "/mode_times", set.shape_times, {set.shape_times.size()},
             {"s", no_frame, "times of the samples of modes", {"mode_times"}});
  const Hdf5Id dataset = file.make_slices(
      group + "/modes", {set.shapes.size(), samples, size, 2},
      {"see /model/unknowns/unit",
       unknown_frame,
       "periodic mode shapes Z(t) exp(-lambda t), lambda without the harmonic; the largest "
       "position is 1; not-a-number if the mode is not resolved",
       {mode_axis, "mode_times", unknown_axis, complex_axis}});
  std::vector<float> slice(samples * size * 2);
  for (std::size_t m = 0; m < set.shapes.size(); ++m) {
    if (set.shapes[m].size() == 0) continue;
    // Columns of the matrix are samples: its memory has the order of the file.
    const std::complex<double>* value = set.shapes[m].data();
    for (std::size_t i = 0; i < samples * size; ++i) {
      slice[2 * i] = static_cast<float>(value[i].real());
      slice[2 * i + 1] = static_cast<float>(value[i].imag());
    }
    file.write_slice(dataset, m, slice);
  }
}

void write_participation(Hdf5File& file, const std::string& group, const ModeSet& set) {
  const Eigen::Index columns = set.participation.cols();
  if (columns == 0) return;
  const Eigen::VectorXd largest = set.participation.colwise().maxCoeff();
  Eigen::Index first = 0;
  Eigen::Index last = columns;
  while (first + 1 < last && largest(first) < smallest_share) ++first;
  while (last - 1 > first && largest(last - 1) < smallest_share) --last;
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> kept =
      set.participation.middleCols(first, last - first);
  std::vector<int> harmonics;
  for (Eigen::Index i = first; i < last; ++i)
    harmonics.push_back(set.first_harmonic + static_cast<int>(i));
  file.write(group + "/participation_harmonic", harmonics,
             {"1",
              no_frame,
              "harmonics k of the columns of participation, counted as in /floquet/harmonic",
              {"participation_harmonic"}});
  file.write(group + "/participation",
             std::span<const double>(kept.data(), static_cast<std::size_t>(kept.size())),
             {static_cast<hsize_t>(kept.rows()), static_cast<hsize_t>(kept.cols())},
             {"1",
              mode_frame,
              "share of the mean kinetic energy, up to the harmonics beyond which no share reaches "
              "1e-9",
              {mode_axis, "participation_harmonic"}});
}

std::vector<TurbineInstant> instants_at(const std::vector<double>& times,
                                        const analysis::PeriodicSolution& solution) {
  std::vector<TurbineInstant> instants;
  for (const double t : times)
    instants.push_back(
        {t, solution.coefficients() *
                analysis::PeriodicSolution::basis(solution.harmonics(), solution.period(), t)});
  return instants;
}

bool has_hdf5_signature(const std::string& path) {
  constexpr std::string_view signature("\x89HDF\r\n\x1a\n", 8);
  std::array<char, 8> start{};
  std::ifstream stream(path, std::ios::binary);
  stream.read(start.data(), start.size());
  return stream && std::string_view(start.data(), start.size()) == signature;
}

/// The schema of a result; -1: an HDF5 file of another program, -2: a file that cannot be opened.
int read_schema(const std::string& path) {
  const Hdf5Id file = open_for_reading(path).file;
  if (!file) return -2;
  const Hdf5Id attribute(
      H5Aopen_by_name(file.get(), "/", schema_attribute, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!attribute) return -1;
  const Hdf5Id type(H5Aget_type(attribute.get()), H5Tclose);
  const Hdf5Id space(H5Aget_space(attribute.get()), H5Sclose);
  int schema = 0;
  const bool is_one_integer =
      H5Tget_class(type.get()) == H5T_INTEGER && H5Sget_simple_extent_npoints(space.get()) == 1;
  if (!is_one_integer || H5Aread(attribute.get(), H5T_NATIVE_INT, &schema) < 0 || schema < 1)
    return -1;
  return schema;
}

/// The reason why a file did not pass its trial, after a colon; empty if it is not known.
std::string why_not(const std::string& path) {
  const std::string ending = open_for_reading(path).trial->ending;
  return ending.empty() ? ending : ": " + ending;
}

/// A stream that writes all digits of a double.
std::ostringstream exact_text() {
  std::ostringstream text;
  text.precision(17);
  return text;
}

}  // namespace

class ResultFile::Storage {
 public:
  explicit Storage(std::string target) : path(std::move(target)) {}
  std::string path;
  Hdf5File file;
};

ResultFile::ResultFile(const std::string& path, const Case& input, const RunRecord& record)
    : storage_(std::make_unique<Storage>(path)) {
  Hdf5File& file = storage_->file;
  file.set_attribute("/", schema_attribute, result_schema);
  file.set_attribute("/", "program", std::string("samara ") + version);
  file.set_attribute("/", "title", input.turbine.title);
  file.set_attribute("/", "case_path", input.path);
  file.set_attribute("/", "command_line", record.command_line);
  file.set_attribute("/", "petsc_options", record.petsc_options);
  file.set_attribute("/", "libraries", record.libraries);
  file.set_attribute("/", "ranks", record.ranks);
  file.set_attribute("/", "time", now_in_utc());
  file.write("/case", input.text,
             {"", no_frame, "the case as run; comments at its top list the --set arguments"});
  file.set_attribute("/case", "settings",
                     static_cast<int>(input.settings.size() + input.polar_settings.size()));
}

ResultFile::~ResultFile() = default;

void ResultFile::write_value(const std::string& name, double value, const Meaning& meaning) {
  storage_->file.write(name, std::span<const double>(&value, 1), {}, meaning);
}

void ResultFile::write_values(const std::string& name, const std::vector<double>& values,
                              const Meaning& meaning) {
  storage_->file.write(name, values, {values.size()}, meaning);
}

void ResultFile::write_array(const std::string& name, const std::vector<double>& values,
                             const std::vector<std::size_t>& shape, const Meaning& meaning) {
  storage_->file.write(name, values, Hdf5File::Shape(shape.begin(), shape.end()), meaning);
}

void ResultFile::write_texts(const std::string& name, const std::vector<std::string>& texts,
                             const Meaning& meaning) {
  storage_->file.write(name, texts, meaning);
}

void ResultFile::set_attribute(const std::string& object, const std::string& name,
                               const std::string& text) {
  storage_->file.set_attribute(object, name, text);
}

void ResultFile::set_attribute(const std::string& object, const std::string& name, double value) {
  storage_->file.set_attribute(object, name, value);
}

void ResultFile::write_model(const turbine::TurbineSystem& system) {
  std::vector<std::string> names;
  std::vector<std::string> units;
  std::vector<std::string> roles;
  for (const system::Unknown& unknown : system.unknowns()) {
    names.push_back(unknown.name());
    units.push_back(unknown.unit);
    roles.emplace_back(system::word_of(unknown.role));
  }
  Hdf5File& file = storage_->file;
  file.write("/model/unknowns/name", names,
             {"", no_frame, "the unknowns in their order", {unknown_axis}});
  file.write("/model/unknowns/unit", units, {"", no_frame, "unit of each unknown", {unknown_axis}});
  file.write("/model/unknowns/role", roles,
             {"",
              no_frame,
              "position, velocity, internal (force, moment), state or auxiliary",
              {unknown_axis}});
  write_value("/model/rotor_speed", system.turbine().speed, {"rad/s", "about +s2", "Omega"});
  write_value("/model/azimuth", system.turbine().azimuth,
              {"rad", "about +s2", "azimuth of blade 1 at t = 0"});
  write_value("/model/period", system.period(),
              {"s", no_frame, "period of one revolution; 0 if the rotor stands still"});
  file.set_attribute("/model", "degrees_of_freedom", system.turbine().degrees_of_freedom);
  file.set_attribute("/model", "unknowns", static_cast<int>(names.size()));
  file.set_attribute("/model", "blades", static_cast<int>(system.turbine().blades.size()));
  file.set_attribute("/model", "sectors", system.symmetry().sectors);
}

void ResultFile::write_trim(const analysis::Trim& trim) {
  Hdf5File& file = storage_->file;
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> coefficients =
      trim.solution.coefficients();
  file.write("/trim/harmonic_name", harmonic_names(trim.solution.harmonics()),
             {"", no_frame, "names of the columns of harmonics", {"harmonic_name"}});
  file.write(
      "/trim/harmonics",
      std::span<const double>(coefficients.data(), static_cast<std::size_t>(coefficients.size())),
      {static_cast<hsize_t>(coefficients.rows()), static_cast<hsize_t>(coefficients.cols())},
      {"see /model/unknowns/unit",
       unknown_frame,
       "z(t) = mean + sum of cos k * cos(k Omega t) + sin k * sin(k Omega t)",
       {unknown_axis, "harmonic_name"}});
  write_texts("/trim/residual_place", {"at the samples of the trim", "between them"},
              {"", no_frame, "places of the entries of residual", {"residual_place"}});
  write_values(
      "/trim/residual", {trim.residual, trim.residual_between},
      {"N, N m", no_frame, "largest entry of the force and moment balances", {"residual_place"}});
  write_value("/trim/load_level", trim.load_level,
              {"N, N m", no_frame, "largest internal load, to compare the residual with"});
  write_value(
      "/trim/harmonic_residual", trim.harmonic_residual,
      {"N, N m", no_frame,
       "largest harmonic of the force and moment balances among those that must vanish; the "
       "rest of the residual comes from harmonics that were left out"});
  write_value("/trim/state_residual", trim.state_residual,
              {"1", no_frame, "largest residual of the first-order states, relative to its terms"});
  write_value("/trim/medium_residual", trim.medium_residual,
              {"1", no_frame, "the same of the air at its stations; it is rough beyond 0.01"});
  write_value("/trim/imbalance", trim.imbalance(),
              {"1", no_frame,
               "the larger residual relative to the largest internal load; a steady state is rough "
               "beyond 1e-4"});
  write_held_loads(file, "/trim", trim.held,
                   "unconstrained coordinates: their mean is set to zero");
  file.set_attribute(
      "/trim", "method",
      std::string(trim.method == analysis::TrimMethod::shooting ? "shooting" : "harmonic_balance"));
  file.set_attribute("/trim", "harmonics", trim.solution.harmonics());
  file.set_attribute("/trim", "newton_steps", trim.newton_steps);
  file.set_attribute("/trim", "convergence", trim.convergence);
  file.set_attribute("/trim", "linear_solver", trim.linear_solver);
}

void ResultFile::write_static(const analysis::StaticPath& path) {
  Hdf5File& file = storage_->file;
  std::vector<double> factors;
  std::vector<double> residuals;
  std::vector<double> states;
  std::vector<int> newton_steps;
  for (const analysis::StaticState& state : path.states) {
    factors.push_back(state.factor);
    residuals.push_back(state.residual);
    newton_steps.push_back(state.newton_steps);
    states.insert(states.end(), state.z.data(), state.z.data() + state.z.size());
  }
  const hsize_t count = path.states.size();
  write_values("/static/factor", factors,
               {"1",
                no_frame,
                "factor of gravity and prescribed loads, in the order of the path",
                {"state"}});
  file.write("/static/states", states, {count, states.size() / count},
             {"see /model/unknowns/unit",
              unknown_frame,
              "equilibrium at each factor",
              {"state", unknown_axis}});
  write_values("/static/residual", residuals,
               {"N, N m", no_frame, "largest entry of the force and moment balances", {"state"}});
  file.write("/static/newton_steps", newton_steps,
             {"1", no_frame, "Newton steps of each state", {"state"}});
  write_values(
      "/static/limit_points", path.limit_points,
      {"1", no_frame, "factors of the states next to which the factor turned", {"limit_points"}});
  write_value("/static/load_level", path.load_level,
              {"N, N m", no_frame, "largest internal load of the last state"});
  file.set_attribute(
      "/static", "method",
      std::string(path.method == analysis::StaticMethod::load ? "load" : "arc_length"));
  file.set_attribute("/static", "cuts", path.cuts);
  file.set_attribute("/static", "convergence",
                     std::string("the last Newton correction of every state was below the "
                                 "tolerance"));
}

void ResultFile::write_channels(const std::string& group,
                                const std::vector<turbine::Channel>& channels) {
  const auto write = [&](const std::string& name, const auto& member,
                         const std::string& description) {
    std::vector<std::string> texts;
    for (const turbine::Channel& channel : channels) texts.push_back(channel.*member);
    write_texts(group + "/channel_" + name, texts, {"", no_frame, description, {channel_axis}});
  };
  write("name", &turbine::Channel::name, "the channels, by OpenFAST's names");
  write("unit", &turbine::Channel::unit, "unit of each channel");
  write("frame", &turbine::Channel::frame, "axes of each channel");
  write("description", &turbine::Channel::description, "description of each channel");
}

void ResultFile::write_series(const TimeSeriesContent& series) {
  Hdf5File& file = storage_->file;
  write_channels("/transient", series.channels);
  std::vector<std::string> files;
  std::vector<std::size_t> rows;
  std::vector<int> counts;
  hsize_t all = series.time.size();
  for (const TimeSeriesSegment& segment : series.segments) {
    files.push_back(segment.file);
    rows.push_back(segment.rows);
    counts.push_back(static_cast<int>(segment.rows));
    all += segment.rows;
  }
  const hsize_t width = series.channels.size();
  if (files.empty()) {
    write_values(series_time, series.time, meaning_of_series_time());
    file.write(series_values, series.values, {all, width}, meaning_of_series_values());
  } else {
    file.write_joined(series_time, files, rows, {all}, meaning_of_series_time());
    file.write_joined(series_values, files, rows, {all, width}, meaning_of_series_values());
  }
  file.write(series_segment_file, files, meaning_of_segment_file());
  file.write(series_segment_rows, counts, meaning_of_segment_rows());
  file.write("/transient/model", series.model,
             {"", no_frame, "the keys of the case that define the model"});
  file.set_attribute("/transient", "status", series.status);
  if (series.azimuth) file.set_attribute("/transient", "azimuth", *series.azimuth);
  file.set_attribute("/transient", "brake_torque", series.brake_torque);
  file.set_attribute("/transient", "generator_lost", series.is_generator_lost ? 1 : 0);
  write_checkpoints(file, series.checkpoints);
}

void write_checkpoints(Hdf5File& file, const std::vector<TimeSeriesCheckpoint>& checkpoints) {
  const std::size_t count = std::min(checkpoints.size(), series_checkpoints.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::string group = series_checkpoints.at(i);
    const TimeSeriesCheckpoint& checkpoint = checkpoints[checkpoints.size() - 1 - i];
    const analysis::TransientStart& point = checkpoint.point;
    const std::span<const double> state(point.z.data(), static_cast<std::size_t>(point.z.size()));
    file.write(group + "/state", state, {state.size()},
               {"see /model/unknowns/unit",
                unknown_frame,
                "state from which the run can be restarted",
                {unknown_axis}});
    const std::span<const double> rate(point.z_dot.data(),
                                       static_cast<std::size_t>(point.z_dot.size()));
    if (!rate.empty())
      file.write(
          group + "/rate", rate, {rate.size()},
          {"see /model/unknowns/unit, per s", unknown_frame, "rate of the state", {unknown_axis}});
    file.write(
        group + "/event_time", checkpoint.events, {checkpoint.events.size()},
        {"s", no_frame, "time of each of transient.events; not-a-number: not yet", {"event"}});
    write_held_loads(file, group, point.held, "coordinates on which a constant load acts");
    file.set_attribute(group, "time", point.time);
    file.set_attribute(group, "origin", point.origin);
    file.set_attribute(group, "step", static_cast<double>(point.step));
    file.set_attribute(group, "rows", static_cast<double>(checkpoint.rows));
  }
}

void ResultFile::write_floquet(const analysis::Floquet& floquet) {
  Hdf5File& file = storage_->file;
  const ModeSet& set = floquet.set;
  file.write(
      "/floquet/multipliers", collect_complex(set, [](const Mode& m) { return m.multiplier; }),
      {set.modes.size(), 2},
      {"1",
       no_frame,
       "multipliers over one revolution; im >= 0 before they are raised to the number of sectors",
       {mode_axis, complex_axis}});
  file.write("/floquet/step_exponents",
             collect_complex(set, [](const Mode& m) { return m.step_exponent; }),
             {set.modes.size(), 2},
             {"rad/s",
              mode_frame,
              "exponents of the sequence of steps, before (2/dt) tanh(. dt/2) maps them to "
              "/floquet/exponents",
              {mode_axis, complex_axis}});
  std::vector<int> harmonics;
  for (const Mode& mode : set.modes) harmonics.push_back(mode.harmonic);
  file.write("/floquet/harmonic", harmonics,
             {"1",
              mode_frame,
              "the identified harmonic k of the rotor speed, counted from the principal exponent",
              {mode_axis}});
  write_mode_set(file, "/floquet", set);
  write_participation(file, "/floquet", set);
  write_shapes(file, "/floquet", set);
  if (floquet.harmonics > 0) file.set_attribute("/floquet", "harmonics", floquet.harmonics);
  file.set_attribute("/floquet", "steps", floquet.steps);
  file.set_attribute("/floquet", "order", floquet.order);
  file.set_attribute("/floquet", "sectors", floquet.sectors);
  file.set_attribute("/floquet", "step", floquet.step);
}

void ResultFile::write_modes(const ModeSet& set) {
  write_mode_set(storage_->file, "/modes", set);
  write_shapes(storage_->file, "/modes", set);
}

void ResultFile::write_geometry(const turbine::TurbineSystem& system, const analysis::Trim& trim) {
  std::vector<double> times{0.0};
  const bool turns = system.period() > 0.0;
  for (int i = 1; turns && i < geometry_instants; ++i)
    times.push_back(system.period() * i / geometry_instants);
  io::write_geometry(storage_->file, system, instants_at(times, trim.solution), "instant");
}

void ResultFile::write_geometry(const turbine::TurbineSystem& system, const analysis::Trim& trim,
                                const std::string& group, const ModeSet& set) {
  if (set.shapes.empty()) return write_geometry(system, trim);
  const std::vector<TurbineInstant> instants = instants_at(set.shape_times, trim.solution);
  io::write_geometry(storage_->file, system, instants, "instant");
  write_node_motions(storage_->file, group, system, set, instants);
}

void ResultFile::write_geometry(const turbine::TurbineSystem& system, double t,
                                const Eigen::VectorXd& z) {
  io::write_geometry(storage_->file, system, {{t, z}}, "instant");
}

void ResultFile::write_geometry(const turbine::TurbineSystem& system,
                                const analysis::StaticPath& path) {
  std::vector<TurbineInstant> instants;
  for (const analysis::StaticState& state : path.states) instants.push_back({0.0, state.z});
  io::write_geometry(storage_->file, system, instants, "state");
}

void ResultFile::write_linearization(const linear::Linearization& linearization) {
  write_linear_groups(storage_->file, linearization);
}

void ResultFile::publish() { write_whole_file(storage_->path, storage_->file.image()); }

bool is_result(const std::string& path) {
  return has_hdf5_signature(path) && read_schema(path) >= 1;
}

std::string require_result(const std::string& path) {
  require_readable(path, "result of samara");
  if (!has_hdf5_signature(path))
    throw InputError(path +
                     ": is no result of samara; hint: expected a file that -o wrote, RESULT.h5");
  const int schema = read_schema(path);
  if (schema == -2)
    throw InputError(path + ": cannot be opened as HDF5" + why_not(path) +
                     "; hint: it is damaged or in use");
  if (schema < 1)
    throw InputError(
        path +
        ": is an HDF5 file of another program, no result of samara; hint: expected a file that "
        "-o wrote, RESULT.h5");
  if (schema > result_schema)
    throw InputError(path + ": is the result of a newer samara (schema " + std::to_string(schema) +
                     ", this one reads up to " + std::to_string(result_schema) +
                     "); hint: run that samara");
  return path;
}

void require_result_path(const std::string& path) {
  if (!require_writable(path)) return;
  const std::string hint = "; hint: -o gives the result another name";
  if (!has_hdf5_signature(path))
    throw InputError(path + ": exists and is no result of samara, it would be lost" + hint);
  const int schema = read_schema(path);
  if (schema == -2)
    throw InputError(path + ": exists and cannot be opened, damaged or in use" + why_not(path) +
                     hint);
  if (schema < 1)
    throw InputError(path + ": exists and is an HDF5 file of another program, it would be lost" +
                     hint);
  if (schema > result_schema)
    throw InputError(path + ": exists and is the result of a newer samara (schema " +
                     std::to_string(schema) + ", this one writes " + std::to_string(result_schema) +
                     ")" + hint);
}

bool is_table(const std::string& path) {
  std::string line;
  std::ifstream stream(path, std::ios::binary);
  std::getline(stream, line);
  return std::ranges::any_of(table_starts,
                             [&line](std::string_view start) { return line.starts_with(start); });
}

void require_table_path(const std::string& path) {
  if (require_writable(path) && !is_table(path))
    throw InputError(path +
                     ": exists and is no table of samara, it would be lost; hint: --csv "
                     "gives the table another name");
}

void write_mode_table(const std::string& path, const ModeSet& set) {
  const bool turns = set.rotor_speed > 0.0;
  const bool periodic = set.participation.size() > 0;
  std::ostringstream text = exact_text();
  text << mode_table_start << (turns ? "frequency_per_rev," : "")
       << "frequency_hz,damping_ratio,logarithmic_decrement,exponent_re,exponent_im,"
       << (periodic ? "multiplier_re,multiplier_im,harmonic," : "")
       << "resolved,residual,error,error_growth"
       << (has_fixed_frame(set) ? ",fixed_frame_frequency_hz" : "") << '\n';
  int number = 0;
  for (const Mode& mode : set.modes) {
    text << ++number << ',' << mode.label << ',';
    if (turns) text << per_rev(mode, set.rotor_speed) << ',';
    text << hertz(mode) << ',' << mode.damping_ratio << ',' << logarithmic_decrement(mode) << ','
         << mode.exponent.real() << ',' << mode.exponent.imag() << ',';
    if (periodic)
      text << mode.multiplier.real() << ',' << mode.multiplier.imag() << ',' << mode.harmonic
           << ',';
    text << (mode.resolved ? 1 : 0) << ',' << mode.residual << ',' << total_error(mode) << ','
         << mode.growth_error;
    if (has_fixed_frame(set)) text << ',' << fixed_frame_hertz(mode);
    text << '\n';
  }
  write_whole_file(path, text.str());
}

void write_trim_table(const std::string& path, const system::PeriodicSystem& system,
                      const analysis::Trim& trim) {
  std::ostringstream text = exact_text();
  text << "name,unit";
  for (const std::string& name : harmonic_names(trim.solution.harmonics())) text << ',' << name;
  text << '\n';
  for (std::size_t i = 0; i < system.unknowns().size(); ++i) {
    text << system.unknowns()[i].name() << ',' << system.unknowns()[i].unit;
    for (Eigen::Index k = 0; k < trim.solution.coefficients().cols(); ++k)
      text << ',' << trim.solution.coefficients()(static_cast<Eigen::Index>(i), k);
    text << '\n';
  }
  write_whole_file(path, text.str());
}

void write_static_table(const std::string& path, const system::PeriodicSystem& system,
                        const analysis::StaticPath& states) {
  std::ostringstream text = exact_text();
  text << static_table_start << "residual";
  for (const system::Unknown& unknown : system.unknowns()) text << ',' << unknown.name();
  text << '\n';
  for (const analysis::StaticState& state : states.states) {
    text << state.factor << ',' << state.newton_steps << ',' << state.residual;
    for (Eigen::Index i = 0; i < state.z.size(); ++i) text << ',' << state.z(i);
    text << '\n';
  }
  write_whole_file(path, text.str());
}

std::string file_library_version() {
  unsigned major = 0;
  unsigned minor = 0;
  unsigned release = 0;
  H5get_libversion(&major, &minor, &release);
  return "HDF5 " + std::to_string(major) + "." + std::to_string(minor) + "." +
         std::to_string(release);
}

}  // namespace samara::io
