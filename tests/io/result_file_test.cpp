#include "samara/io/result_file.hpp"

#include <algorithm>
#include <complex>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>
#include <hdf5.h>

#include "samara/base/error.hpp"
#include "samara/petsc/session.hpp"

#include "folder.hpp"

namespace {

using namespace samara;
using namespace samara::io;
using samara::test::Folder;

namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

/// Values that the file must give back to the last bit.
constexpr double exact = 0.0;

/// Turbine systems need PETSc.
struct Started {
  petsc::Session session{{}};
};
BOOST_TEST_GLOBAL_FIXTURE(Started);

std::size_t count_files(const Folder& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()));
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string read_text(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

const Case& baseline() {
  static const Case input =
      read_case(std::string(SAMARA_SOURCE_DIR) + "/inputs/lee2002/baseline.yaml", {"gravity=9.81"});
  return input;
}

const RunRecord record{"samara floquet x.yaml", "-floquet_ksp_view", "PETSc; HDF5", 2};

/// Two modes: a complex pair in the harmonic 1, and a real exponent that is not resolved.
analysis::Floquet small_floquet() {
  analysis::Floquet floquet;
  floquet.steps = 8;
  floquet.sectors = 2;
  floquet.step = 0.125;
  analysis::ModeSet& set = floquet.set;
  set.degrees_of_freedom = 2;
  set.rotor_speed = 2.0;
  analysis::Mode pair;
  pair.multiplier = {0.5, 0.25};
  pair.exponent = {-0.1, 3.0};
  pair.harmonic = 1;
  pair.damping_ratio = 1.0 / 30.0;
  pair.label = "1st blade flap";
  pair.residual = 1e-12;
  pair.parts = {{"blade", 0.9}, {"tower", 0.1}};
  analysis::Mode real;
  real.multiplier = 1.5;
  real.exponent = 0.2;
  real.damping_ratio = -1.0;
  real.label = "yaw";
  real.resolved = false;
  real.parts = {{"tower", 0.75}, {"blade", 0.25}};
  set.modes = {real, pair};
  set.first_harmonic = -3;
  set.participation.setZero(2, 7);
  set.participation(0, 3) = 1.0;  // k = 0
  set.participation(1, 4) = 0.8;  // k = 1
  set.participation(1, 2) = 0.2;  // k = -1
  Eigen::MatrixXcd shape(3, 2);   // 3 unknowns, 2 samples
  shape << std::complex(1.0, 2.0), std::complex(7.0, 8.0), std::complex(3.0, 4.0),
      std::complex(9.0, 10.0), std::complex(5.0, 6.0), std::complex(11.0, 12.0);
  set.shapes = {Eigen::MatrixXcd(), shape};
  set.shape_times = {0.0, 0.5};
  return floquet;
}

analysis::Trim make_trim(const Eigen::MatrixXd& coefficients) {
  return {analysis::PeriodicSolution(coefficients, 1.0),
          analysis::TrimMethod::harmonic_balance,
          3,
          "CONVERGED_FNORM_RELATIVE",
          1e-9,
          1e-3,
          100.0,
          {{"yaw", "N m", 7.5}},
          {}};
}

/// A published result, to be read.
class Reader {
 public:
  explicit Reader(const std::string& path)
      : file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {
    BOOST_REQUIRE_GE(file_, 0);
  }
  ~Reader() { H5Fclose(file_); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  bool has(const std::string& name) const {
    return H5Lexists(file_, name.substr(0, name.rfind('/') + 1).c_str(), H5P_DEFAULT) >= 0 &&
           H5Lexists(file_, name.c_str(), H5P_DEFAULT) > 0;
  }

  std::vector<hsize_t> shape(const std::string& name) const {
    const hid_t set = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    BOOST_REQUIRE_MESSAGE(set >= 0, name + " is missing");
    const hid_t space = H5Dget_space(set);
    std::vector<hsize_t> result(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, result.data(), nullptr);
    H5Sclose(space);
    H5Dclose(set);
    return result;
  }

  std::vector<double> values(const std::string& name) const {
    std::size_t count = 1;
    for (const hsize_t n : shape(name)) count *= n;
    std::vector<double> result(count);
    const hid_t set = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    BOOST_REQUIRE_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, result.data()),
                     0);
    H5Dclose(set);
    return result;
  }

  /// A list of words of any length.
  Strings words(const std::string& name) const {
    const std::size_t count = shape(name).at(0);
    const hid_t set = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    const hid_t type = H5Dget_type(set);
    BOOST_REQUIRE(H5Tis_variable_str(type) > 0);
    std::vector<char*> pieces(count, nullptr);
    BOOST_REQUIRE_GE(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pieces.data()), 0);
    H5Tclose(type);
    H5Dclose(set);
    Strings result;
    for (char* piece : pieces) {
      result.emplace_back(piece);
      H5free_memory(piece);
    }
    return result;
  }

  /// A text of any length.
  std::string text(const std::string& name) const {
    const hid_t set = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    const hid_t type = H5Dget_type(set);
    char* data = nullptr;
    BOOST_REQUIRE_GE(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &data), 0);
    const std::string result(data);
    H5free_memory(data);
    H5Tclose(type);
    H5Dclose(set);
    return result;
  }

  std::string attribute(const std::string& object, const std::string& name) const {
    const hid_t attribute =
        H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    BOOST_REQUIRE_MESSAGE(attribute >= 0, object + " has no " + name);
    const hid_t type = H5Aget_type(attribute);
    char* data = nullptr;
    BOOST_REQUIRE_GE(H5Aread(attribute, type, &data), 0);
    const std::string result(data);
    H5free_memory(data);
    H5Tclose(type);
    H5Aclose(attribute);
    return result;
  }

  int number(const std::string& object, const std::string& name) const {
    const hid_t attribute =
        H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    BOOST_REQUIRE_MESSAGE(attribute >= 0, object + " has no " + name);
    int value = 0;
    H5Aread(attribute, H5T_NATIVE_INT, &value);
    H5Aclose(attribute);
    return value;
  }

  /// The names of all datasets.
  Strings datasets() const {
    Strings names;
    const auto take = [](hid_t, const char* name, const H5O_info_t* info, void* target) -> herr_t {
      if (info->type == H5O_TYPE_DATASET)
        static_cast<Strings*>(target)->push_back("/" + std::string(name));
      return 0;
    };
    H5Ovisit2(file_, H5_INDEX_NAME, H5_ITER_NATIVE, take, &names, H5O_INFO_BASIC);
    return names;
  }

 private:
  hid_t file_;
};

/// Writes everything that `samara floquet` writes, of the small system above.
std::string write_floquet(const Folder& folder) {
  const std::string path = folder.file("x.h5");
  ResultFile file(path, baseline(), record);
  file.write_floquet(small_floquet());
  file.publish();
  return path;
}

/// The one line of the refusal, without the folder; empty where the path is accepted.
template <class Require>
std::string refusal(const Require& require, const std::string& path) {
  try {
    require(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void require_refused(const std::string& message, const std::string& words) {
  BOOST_TEST_CONTEXT(message) {
    BOOST_TEST(message.find(words) != std::string::npos);
    BOOST_TEST(message.find('\n') == std::string::npos);
  }
}

template <class Value>
void require_equal(const std::vector<Value>& found, const std::vector<Value>& expected) {
  BOOST_REQUIRE_EQUAL_COLLECTIONS(found.begin(), found.end(), expected.begin(), expected.end());
}

BOOST_AUTO_TEST_CASE(a_result_states_how_it_came_about) {
  const Folder folder;
  const Reader reader(write_floquet(folder));
  BOOST_TEST(reader.text("/case") == baseline().text);
  BOOST_TEST(reader.text("/case").starts_with("# --set gravity=9.81\n"));
  BOOST_TEST(reader.number("/", "samara_schema") == result_schema);
  BOOST_TEST(reader.attribute("/", "program").starts_with("samara "));
  BOOST_TEST(reader.attribute("/", "command_line") == record.command_line);
  BOOST_TEST(reader.attribute("/", "petsc_options") == record.petsc_options);
  BOOST_TEST(reader.attribute("/", "libraries") == record.libraries);
  BOOST_TEST(reader.number("/", "ranks") == record.ranks);
  const std::string time = reader.attribute("/", "time");
  BOOST_TEST(time.size() == std::string("2002-01-01T00:00:00Z").size());
  BOOST_TEST(time.back() == 'Z');
}

BOOST_AUTO_TEST_CASE(every_dataset_has_unit_frame_and_description) {
  const Folder folder;
  const std::string path = folder.file("x.h5");
  {
    const model::Turbine turbine = model::build_turbine(baseline().turbine);
    const turbine::TurbineSystem system(turbine, PETSC_COMM_SELF);
    ResultFile file(path, baseline(), record);
    file.write_model(system);
    file.write_floquet(small_floquet());
    file.write_modes(small_floquet().set);
    file.publish();
  }
  const Reader reader(path);
  BOOST_TEST(reader.datasets().size() > 30u);
  for (const std::string& name : reader.datasets()) {
    BOOST_TEST_CONTEXT(name) {
      reader.attribute(name, "unit");
      BOOST_TEST(!reader.attribute(name, "frame").empty());
      BOOST_TEST(!reader.attribute(name, "description").empty());
    }
  }
}

BOOST_AUTO_TEST_CASE(modes_are_rows_in_their_order) {
  const Folder folder;
  const Reader reader(write_floquet(folder));
  require_equal(reader.shape("/floquet/multipliers"), {2, 2});
  require_equal(reader.values("/floquet/multipliers"), {1.5, 0.0, 0.5, 0.25});
  require_equal(reader.values("/floquet/exponents"), {0.2, 0.0, -0.1, 3.0});
  require_equal(reader.values("/floquet/frequency_per_rev"), {0.0, 1.5});
  require_equal(reader.values("/floquet/frequency_hz"), {0.0, 1.5 / std::numbers::pi});
  require_equal(reader.values("/floquet/damping_ratio"), {-1.0, 1.0 / 30.0});
  require_equal(reader.values("/floquet/harmonic"), {0.0, 1.0});
  require_equal(reader.values("/floquet/residual"), {0.0, 1e-12});
  BOOST_TEST(reader.number("/floquet", "degrees_of_freedom") == 2);
  BOOST_TEST(reader.number("/floquet", "steps") == 8);
  BOOST_TEST(reader.number("/floquet", "sectors") == 2);
}

BOOST_AUTO_TEST_CASE(an_unresolved_mode_says_so) {
  const Folder folder;
  const Reader reader(write_floquet(folder));
  require_equal(reader.words("/floquet/label"), {"yaw (unresolved)", "1st blade flap"});
  require_equal(reader.values("/floquet/resolved"), {0.0, 1.0});
}

BOOST_AUTO_TEST_CASE(shares_of_parts_have_one_column_a_part) {
  const Folder folder;
  const Reader reader(write_floquet(folder));
  require_equal(reader.words("/floquet/part"), {"blade", "tower"});
  require_equal(reader.values("/floquet/part_share"), {0.25, 0.75, 0.9, 0.1});
}

BOOST_AUTO_TEST_CASE(participations_reach_as_far_as_there_are_any) {
  const Folder folder;
  const Reader reader(write_floquet(folder));
  require_equal(reader.shape("/floquet/participation"), {2, 3});
  require_equal(reader.values("/floquet/participation_harmonic"), {-1.0, 0.0, 1.0});
  require_equal(reader.values("/floquet/participation"), {0.0, 1.0, 0.0, 0.2, 0.0, 0.8});
}

BOOST_AUTO_TEST_CASE(shapes_run_over_mode_sample_unknown_and_part) {
  const Folder folder;
  const Reader reader(write_floquet(folder));
  require_equal(reader.shape("/floquet/modes"), {2, 2, 3, 2});
  const std::vector<double> found = reader.values("/floquet/modes");
  for (std::size_t i = 0; i < 12; ++i) {
    BOOST_TEST(std::isnan(found[i]));  // not resolved, no shape
    BOOST_TEST(found[12 + i] == static_cast<double>(i + 1), boost::test_tools::tolerance(exact));
  }
  require_equal(reader.values("/floquet/mode_times"), {0.0, 0.5});
}

BOOST_AUTO_TEST_CASE(constant_modes_have_nothing_of_a_period) {
  const Folder folder;
  const std::string path = folder.file("x.h5");
  {
    analysis::ModeSet set = small_floquet().set;
    set.rotor_speed = 0.0;
    set.participation.resize(0, 0);
    ResultFile file(path, baseline(), record);
    file.write_modes(set);
    file.publish();
  }
  const Reader reader(path);
  for (const char* name : {"exponents", "frequency_hz", "damping_ratio", "label", "modes"})
    BOOST_TEST(reader.has("/modes/" + std::string(name)));
  for (const char* name : {"multipliers", "harmonic", "participation", "frequency_per_rev"})
    BOOST_TEST(!reader.has("/modes/" + std::string(name)));
  BOOST_TEST(reader.number("/modes", "degrees_of_freedom") == 2);
}

BOOST_AUTO_TEST_CASE(unknowns_have_name_unit_and_role) {
  const Folder folder;
  const std::string path = folder.file("x.h5");
  const model::Turbine turbine = model::build_turbine(baseline().turbine);
  const turbine::TurbineSystem system(turbine, PETSC_COMM_SELF);
  {
    ResultFile file(path, baseline(), record);
    file.write_model(system);
    file.publish();
  }
  const Reader reader(path);
  const Strings names = reader.words("/model/unknowns/name");
  const Strings units = reader.words("/model/unknowns/unit");
  const Strings roles = reader.words("/model/unknowns/role");
  const auto yaw = static_cast<std::size_t>(system.layout().yaw());
  BOOST_TEST(names.size() == static_cast<std::size_t>(system.size()));
  BOOST_TEST(names.at(yaw) == "yaw angle");
  BOOST_TEST(units.at(yaw) == "rad");
  BOOST_TEST(roles.at(yaw) == "position");
  BOOST_TEST(roles.at(yaw + 1) == "velocity");
  BOOST_TEST(roles.at(static_cast<std::size_t>(system.layout().tower_root())) == "internal");
  BOOST_TEST(reader.values("/model/rotor_speed").at(0) == 6.02);
}

BOOST_AUTO_TEST_CASE(the_steady_state_has_a_column_a_coefficient) {
  const Folder folder;
  const std::string path = folder.file("x.h5");
  Eigen::MatrixXd coefficients(2, 3);
  coefficients << 1.0, 2.0, 3.0, 4.0, 5.0, 6.0;
  {
    ResultFile file(path, baseline(), record);
    file.write_trim(make_trim(coefficients));
    file.publish();
  }
  const Reader reader(path);
  require_equal(reader.shape("/trim/harmonics"), {2, 3});
  require_equal(reader.values("/trim/harmonics"), {1.0, 2.0, 3.0, 4.0, 5.0, 6.0});
  require_equal(reader.words("/trim/harmonic_name"), {"mean", "cos 1", "sin 1"});
  require_equal(reader.values("/trim/residual"), {1e-9, 1e-3});
  require_equal(reader.words("/trim/held_name"), {"yaw"});
  require_equal(reader.values("/trim/held_load"), {7.5});
}

BOOST_AUTO_TEST_CASE(a_file_that_is_not_published_leaves_nothing) {
  const Folder folder;
  {
    ResultFile file(folder.file("x.h5"), baseline(), record);
    file.write_floquet(small_floquet());
  }
  BOOST_TEST(count_files(folder) == 0u);
}

BOOST_AUTO_TEST_CASE(a_result_is_replaced_only_when_the_next_is_complete) {
  const Folder folder;
  const std::string path = write_floquet(folder);
  const std::string before = read_text(path);
  {
    ResultFile file(path, baseline(), record);
    file.write_modes(small_floquet().set);
    BOOST_TEST((read_text(path) == before));
  }
  BOOST_TEST((read_text(path) == before));
  {
    ResultFile file(path, baseline(), record);
    file.write_modes(small_floquet().set);
    file.publish();
  }
  BOOST_TEST((read_text(path) != before));
  BOOST_TEST(Reader(path).has("/modes/exponents"));
  BOOST_TEST(count_files(folder) == 1u);
}

BOOST_AUTO_TEST_CASE(a_folder_that_goes_away_is_an_error_of_the_environment) {
  const Folder folder;
  fs::create_directory(folder.file("gone"));
  ResultFile file(folder.file("gone/x.h5"), baseline(), record);
  fs::remove_all(folder.file("gone"));
  BOOST_CHECK_THROW(file.publish(), InternalError);
}

BOOST_AUTO_TEST_CASE(a_new_name_and_a_result_can_be_written) {
  const Folder folder;
  BOOST_TEST(refusal(require_result_path, folder.file("new.h5")) == "");
  const std::string path = write_floquet(folder);
  BOOST_TEST(refusal(require_result_path, path) == "");
  BOOST_TEST(is_result(path));
}

BOOST_AUTO_TEST_CASE(what_samara_did_not_write_is_never_overwritten) {
  const Folder folder;
  const std::string text = folder.file("notes.h5");
  write_text(text, "my notes\n");
  require_refused(refusal(require_result_path, text), "no result of samara");
  const std::string empty = folder.file("empty.h5");
  write_text(empty, "");
  require_refused(refusal(require_result_path, empty), "no result of samara");
  const std::string foreign = folder.file("foreign.h5");
  H5Fclose(H5Fcreate(foreign.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  require_refused(refusal(require_result_path, foreign), "of another program");
  const std::string damaged = folder.file("damaged.h5");
  write_text(damaged, read_text(write_floquet(folder)).substr(0, 100));
  require_refused(refusal(require_result_path, damaged), "cannot be opened");
  for (const std::string& path : {text, empty, foreign, damaged}) BOOST_TEST(!is_result(path));
  BOOST_TEST(!is_result(folder.file("not there")));
}

BOOST_AUTO_TEST_CASE(the_result_of_a_newer_program_is_not_overwritten) {
  const Folder folder;
  const std::string path = write_floquet(folder);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t attribute = H5Aopen(file, "samara_schema", H5P_DEFAULT);
  const int next = result_schema + 1;
  H5Awrite(attribute, H5T_NATIVE_INT, &next);
  H5Aclose(attribute);
  H5Fclose(file);
  require_refused(refusal(require_result_path, path), "newer samara");
}

BOOST_AUTO_TEST_CASE(places_where_no_file_can_be_are_refused) {
  const Folder folder;
  write_text(folder.file("file"), "");
  for (const auto& require : {require_result_path, require_table_path}) {
    require_refused(refusal(require, folder.file("missing/x.h5")), "there is no folder");
    require_refused(refusal(require, folder.file("file/x.h5")), "not a folder");
    require_refused(refusal(require, folder.path.string()), "a folder");
    require_refused(refusal(require, "/dev/null"), "not a plain file");
  }
}

BOOST_AUTO_TEST_CASE(a_table_of_modes_has_a_line_a_mode) {
  const Folder folder;
  const std::string path = folder.file("x.csv");
  write_mode_table(path, small_floquet().set);
  std::istringstream lines(read_text(path));
  Strings found;
  for (std::string line; std::getline(lines, line);) found.push_back(line);
  BOOST_REQUIRE(found.size() == 3u);
  BOOST_TEST(found[0] ==
             "number,label,frequency_per_rev,frequency_hz,damping_ratio,logarithmic_decrement,"
             "exponent_re,exponent_im,"
             "multiplier_re,multiplier_im,harmonic,resolved,residual,error,error_growth");
  BOOST_TEST(found[1] == "1,yaw,0,0,-1,nan,0.20000000000000001,0,1.5,0,0,0,0,0,0");
  BOOST_TEST(found[2].starts_with("2,1st blade flap,1.5,0.4774648292756"));
  BOOST_TEST(count_files(folder) == 1u);
}

BOOST_AUTO_TEST_CASE(a_table_of_the_steady_state_has_a_line_an_unknown) {
  const Folder folder;
  const std::string path = folder.file("x.csv");
  const model::Turbine turbine = model::build_turbine(baseline().turbine);
  const turbine::TurbineSystem system(turbine, PETSC_COMM_SELF);
  const Eigen::MatrixXd coefficients =
      Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(system.size()), 3, 0.5);
  write_trim_table(path, system, make_trim(coefficients));
  const std::string text = read_text(path);
  BOOST_TEST(text.starts_with("name,unit,mean,cos 1,sin 1\n"));
  BOOST_TEST(text.find("\nyaw angle,rad,0.5,0.5,0.5\n") != std::string::npos);
  BOOST_TEST(std::count(text.begin(), text.end(), '\n') == system.size() + 1);
}

BOOST_AUTO_TEST_CASE(only_tables_of_samara_are_overwritten) {
  const Folder folder;
  const std::string own = folder.file("own.csv");
  write_mode_table(own, small_floquet().set);
  BOOST_TEST(refusal(require_table_path, own) == "");
  BOOST_TEST(refusal(require_table_path, folder.file("new.csv")) == "");
  const std::string other = folder.file("other.csv");
  write_text(other, "a,b\n1,2\n");
  require_refused(refusal(require_table_path, other), "no table of samara");
}

}  // namespace
