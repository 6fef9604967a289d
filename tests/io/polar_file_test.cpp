// Polars from airfoil files of AeroDyn and from plain columns.
#include "samara/io/polar_file.hpp"

#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include <boost/test/unit_test.hpp>
#include <sys/stat.h>

#include "samara/base/error.hpp"

#include "folder.hpp"

namespace samara::io {
namespace {

namespace fs = std::filesystem;
using test::Folder;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double round_off = 1e-15;

using Polars = std::vector<model::PolarDefinition>;

/// A table of an airfoil file; the values of unsteady aerodynamics could be taken for others.
std::string table(const std::string& reynolds, const std::string& rows, const std::string& count) {
  return "! data of a table\n" + reynolds + R"(   Re   ! Reynolds number in millions
0   UserProp
True   InclUAdata
!........
"Default"  T_p  ! 1.7
 6.2  C_nalpha
DEFAULT  UACutout  45 degrees
! Table of aerodynamics coefficients
)" + count +
         "   NumAlf  ! Number of data lines\n!  Alpha  Cl  Cd  Cm\n! (deg)\n" + rows;
}

std::string aerodyn(const std::string& tables, const std::string& count = "1") {
  return R"(! ------------ AirfoilInfo v1.01.x Input File ------------
! An airfoil, 30% thick
"DEFAULT"  InterpOrd  ! {1=linear; 3=cubic spline}
 1   NonDimArea
@"coordinates.txt"  NumCoords  ! not read
"unused"  BL_file
)" + count +
         "   NumTabs  ! Number of tables\n" + tables;
}

const std::string rows =
    "-180.00  0.1  0.02  0.0\n\n-1.0D+01\t-.5 .01 +0.1 0.9\n! between rows\n180,0.1,2.0e-2,0 ! "
    "end\n";

Polars read(const std::string& text) { return parse_polars("a.dat", text); }

void check_error(const std::string& text, const std::string& expected) {
  try {
    read(text);
    BOOST_ERROR("no error, expected: " + expected);
  } catch (const InputError& error) {
    BOOST_TEST(error.what() == expected);
  }
}

BOOST_AUTO_TEST_SUITE(polar_files)

BOOST_AUTO_TEST_CASE(a_file_of_aerodyn_has_a_table) {
  for (const std::string ends : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const char c : "\xef\xbb\xbf" + aerodyn(table("0.75", rows, "3")))
      text += c == '\n' ? ends : std::string(1, c);
    const Polars polars = read(text);
    BOOST_REQUIRE(polars.size() == 1u);
    BOOST_TEST(polars[0].reynolds == 0.75e6);
    BOOST_REQUIRE(polars[0].angles.size() == 3u);
    BOOST_TEST(polars[0].angles[1] == -10.0 * degree, boost::test_tools::tolerance(round_off));
    BOOST_TEST((polars[0].lift == std::vector<double>{0.1, -0.5, 0.1}));
    BOOST_TEST((polars[0].drag == std::vector<double>{0.02, 0.01, 0.02}));
    BOOST_TEST((polars[0].moment == std::vector<double>{0.0, 0.1, 0.0}));
  }
}

BOOST_AUTO_TEST_CASE(half_a_turn_is_pi) {
  const Polars polars = read("-180 0 0.1\n180 0 0.1\n");
  BOOST_TEST(polars[0].angles.front() == -std::numbers::pi);
  BOOST_TEST(polars[0].angles.back() == std::numbers::pi);
}

BOOST_AUTO_TEST_CASE(tables_come_by_rising_reynolds_number) {
  const Polars polars =
      read(aerodyn(table("6", "-180 1 1\n", "1") + table("0.5", "-180 2 2\n", "1"), "2"));
  BOOST_REQUIRE(polars.size() == 2u);
  BOOST_TEST(polars[0].reynolds == 0.5e6);
  BOOST_TEST(polars[0].lift[0] == 2.0);
  BOOST_TEST(polars[1].reynolds == 6e6);
}

BOOST_AUTO_TEST_CASE(tables_beyond_the_stated_number_are_not_read) {
  const Polars polars = read(aerodyn(table("6", rows, "3") + table("6", "-180 2 2\n", "1")));
  BOOST_REQUIRE(polars.size() == 1u);
  BOOST_TEST(polars[0].angles.size() == 3u);
}

BOOST_AUTO_TEST_CASE(a_reynolds_number_may_be_unknown) {
  BOOST_TEST(read(aerodyn(table("\"Default\"", rows, "3")))[0].reynolds == 0.0);
  BOOST_TEST(read(aerodyn(table("0", rows, "3")))[0].reynolds == 0.0);
}

BOOST_AUTO_TEST_CASE(coordinates_in_the_file_are_no_rows) {
  const std::string text =
      "1  NonDimArea\n3  NumCoords\n! x y\n0.25 0\n1 0\n0 0\n1 NumTabs\n" + table("1", rows, "3");
  BOOST_TEST(read(text)[0].angles.size() == 3u);
}

BOOST_AUTO_TEST_CASE(columns_have_a_moment_or_none) {
  const Polars with = read("# angle Cl Cd Cm\n% more\n-180 0 .1 .2\n\n! 0\n180, 0, .1, .2\n");
  BOOST_REQUIRE(with.size() == 1u);
  BOOST_TEST(with[0].reynolds == 0.0);
  BOOST_TEST((with[0].moment == std::vector<double>{0.2, 0.2}));
  BOOST_TEST((read("-180 0 .1\n180 0 .1")[0].moment == std::vector<double>{0.0, 0.0}));
}

BOOST_AUTO_TEST_CASE(a_number_next_to_nothing_is_zero) {
  BOOST_TEST(read("-180 1e-31 .1\n180 -1e-200 .1")[0].lift[1] == 0.0);
}

BOOST_AUTO_TEST_CASE(faulty_columns_are_refused) {
  check_error("",
              "a.dat: has no polar; hint: lines of angle [deg], Cl, Cd and Cm, or an airfoil file "
              "of AeroDyn");
  check_error("alpha cl cd\n-180 0 0\n",
              "a.dat:1: expected numbers: angle [deg], Cl, Cd, Cm; got \"alpha\"; hint: comments "
              "start with #, ! or %");
  check_error("\n-180 0 nan\n",
              "a.dat:2: expected numbers: angle [deg], Cl, Cd, Cm; got \"nan\"; hint: comments "
              "start with #, ! or %");
  check_error("-180 0 1e999\n",
              "a.dat:1: expected numbers: angle [deg], Cl, Cd, Cm; got \"1e999\"; hint: comments "
              "start with #, ! or %");
  check_error("-180 0\n", "a.dat:1: expected 3 or 4 columns (angle [deg], Cl, Cd, Cm), got 2");
  check_error("1 2 3 4 5\n", "a.dat:1: expected 3 or 4 columns (angle [deg], Cl, Cd, Cm), got 5");
  check_error("-180 0 1 0\n\n180 0 1\n", "a.dat:3: has 3 columns, line 1 has 4");
  std::string many;
  for (int i = 0; i < 5001; ++i) many += std::to_string(i) + " 0 0\n";
  check_error(many, "a.dat:5001: more than 5000 rows");
}

BOOST_AUTO_TEST_CASE(faulty_files_of_aerodyn_are_refused) {
  check_error(aerodyn(table("1", rows, "4")),
              "a.dat:24: expected a row of the table: Alpha, Cl, Cd, Cm; hint: NumAlf in line 17 "
              "states 4 rows, there are 3");
  check_error(aerodyn(table("1", rows, "2")),
              "a.dat:24: one more row of the table; hint: NumAlf in line 17 states 2 rows");
  check_error(aerodyn(table("1", "-180 0 x\n", "1")),
              "a.dat:20: expected a row of the table: Alpha, Cl, Cd, Cm; hint: NumAlf in line 17 "
              "states 1 rows, there are 0");
  for (const std::string count : {"999999999999999999999", "5001", "0", "-1", "x", "1e3"})
    check_error(aerodyn(table("1", rows, count)),
                "a.dat:17: NumAlf: expected an integer from 1 to 5000, got \"" + count + "\"");
  check_error(aerodyn(table("-1", rows, "3")),
              "a.dat:9: Re: expected a number >= 0, in millions, got \"-1\"");
  check_error(aerodyn(table("1", rows, "3"), "2"), "a.dat:7: NumTabs is 2, the file has 1 table");
  check_error(aerodyn(table("1", rows, "3"), "1000000"),
              "a.dat:7: NumTabs: expected an integer from 1 to 100, got \"1000000\"");
  check_error(aerodyn(table("1", "-180 0 1\n", "1") + table("1", "-180 0 1\n", "1"), "2"),
              "a.dat:30: a second table for the Reynolds number of another one; hint: keep the "
              "table of one control setting");
}

BOOST_AUTO_TEST_CASE(bytes_that_are_no_text_are_refused) {
  check_error(std::string("-180 0 1\0", 9),
              "a.dat: not a plain text file; hint: UTF-16 must be saved as UTF-8");
  check_error(
      "\x1b\x01 0 0\n",
      "a.dat:1: expected numbers: angle [deg], Cl, Cd, Cm; got \"  \"; hint: comments start "
      "with #, ! or %");
  check_error(
      "\"",
      "a.dat:1: expected numbers: angle [deg], Cl, Cd, Cm; got \"\"\"; hint: comments start "
      "with #, ! or %");
  check_error(std::string(100000, '9'),
              "a.dat:1: expected numbers: angle [deg], Cl, Cd, Cm; got \"" + std::string(40, '9') +
                  "...\"; hint: comments start with #, ! or %");
}

BOOST_AUTO_TEST_CASE(only_plain_files_are_read) {
  const Folder folder;
  const std::string file = folder.file("a.dat");
  const auto error_of = [](const std::string& path) {
    try {
      read_polar_file(path);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  BOOST_TEST(error_of(file) == file + ": no such file");
  BOOST_TEST(error_of(folder.path) ==
             folder.path.string() + ": a directory, expected a polar file");
  BOOST_REQUIRE(::mkfifo(file.c_str(), 0600) == 0);
  BOOST_TEST(error_of(file) == file + ": not a plain file, expected a polar file");
  fs::remove(file);
  std::ofstream(file) << "-180 0 1\n180 0 1\n";
  BOOST_TEST(read_polar_file(file)[0].angles.size() == 2u);
  std::ofstream(file) << std::string(17 << 20, ' ');
  BOOST_TEST(error_of(file) == file + ": more than 16 MB, too large for a polar file");
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
}  // namespace samara::io
