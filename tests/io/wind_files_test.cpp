// io/wind_files.hpp: files that are written here, and faults of them.
#include "samara/io/wind_files.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"

#include "folder.hpp"

namespace {

using namespace samara;
using test::Folder;

template <class Number>
void add(std::string& bytes, Number value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// 3 instants of 2 rows and 3 columns, 0.5 s and 10 x 20 m apart; two points at the tower. Stored
/// numbers n mean (n - 100)/50.
std::string turbsim_bytes(std::int16_t id = 7) {
  std::string bytes;
  add(bytes, id);
  for (const std::int32_t n : {2, 3, 2, 3}) add(bytes, n);  // rows, columns, tower, instants
  for (const float x : {20.0F, 10.0F, 0.5F, 8.0F, 90.0F, 80.0F}) add(bytes, x);
  for (int c = 0; c < 3; ++c) {
    add(bytes, 50.0F);
    add(bytes, 100.0F);
  }
  const std::string text = "made for a test";
  add(bytes, static_cast<std::int32_t>(text.size()));
  bytes += text;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 3; ++c)
          add(bytes, static_cast<std::int16_t>(1000 * i + 100 * j + 10 * k + c));
    for (int n = 0; n < 6; ++n) add(bytes, std::int16_t{-7});
  }
  return bytes;
}

std::string fault_of(const auto& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(wind_files)

BOOST_AUTO_TEST_CASE(a_file_of_turbsim_is_read) {
  const Folder folder;
  const model::WindBox box = io::read_turbsim_box(folder.write("a.bts", turbsim_bytes()));
  BOOST_TEST(box.times == 3);
  BOOST_TEST(box.rows == 2);
  BOOST_TEST(box.columns == 3);
  BOOST_TEST(box.step == 0.5);
  BOOST_TEST(box.width == 10.0);
  BOOST_TEST(box.height == 20.0);
  BOOST_TEST(box.bottom == 80.0);
  BOOST_TEST(box.speed == 8.0);
  BOOST_TEST(box.front == 10.0);  // half of the width
  BOOST_TEST(!box.is_periodic);
  BOOST_TEST(!box.is_fluctuation);
  BOOST_REQUIRE(box.values.size() == 54u);
  // Instant 2, row 1, column 2 (the left one), v: 2121.
  BOOST_TEST(std::abs(box.values[((2 * 2 + 1) * 3 + 2) * 3 + 1] - (2121.0 - 100.0) / 50.0) < 1e-5);
  // The left column is at y = +10 m; the first instant is 10 m downwind of the tower.
  BOOST_TEST(std::abs(box.at({10.0, 10.0, 80.0}, 0.0).velocity(0) - (20.0 - 100.0) / 50.0) < 1e-5);
  const model::WindBox periodic = io::read_turbsim_box(folder.write("b.bts", turbsim_bytes(8)));
  BOOST_TEST(periodic.is_periodic);
  BOOST_TEST(periodic.front == 0.0);
}

BOOST_AUTO_TEST_CASE(faults_of_a_file_of_turbsim_are_said) {
  const Folder folder;
  const auto fault = [&](const std::string& bytes) {
    return fault_of([&] { io::read_turbsim_box(folder.write("a.bts", bytes)); });
  };
  const std::string whole = turbsim_bytes();
  BOOST_TEST(has(fault(turbsim_bytes(5)), "is no file of TurbSim"));
  for (std::size_t length = 0; length < whole.size(); ++length)
    BOOST_TEST(!fault(whole.substr(0, length)).empty());
  BOOST_TEST(has(fault(whole + "x"), "bytes of velocities"));
  std::string huge = whole;
  for (std::size_t i = 2; i < 18; ++i) huge[i] = '\x7f';
  BOOST_TEST(has(fault(huge), "columns"));
  BOOST_TEST(has(fault_of([&] { io::read_turbsim_box(folder.file("none")); }), "none"));
  // Any byte may be wrong.
  for (std::size_t i = 0; i < 70; ++i)
    for (const char c : {'\x00', '\x7f', '\xff'}) {
      std::string broken = whole;
      broken[i] = c;
      fault(broken);
    }
}

BOOST_AUTO_TEST_CASE(a_box_of_hawc2_is_read) {
  const Folder folder;
  std::array<std::string, 3> paths;
  for (int c = 0; c < 3; ++c) {
    std::string bytes;
    for (int i = 0; i < 4; ++i)      // along the wind
      for (int k = 0; k < 3; ++k)    // from left to right
        for (int j = 0; j < 2; ++j)  // up
          add(bytes, static_cast<float>(100 * i + 10 * k + j + 1000 * c));
    paths[static_cast<std::size_t>(c)] = folder.write("uvw"[c] + std::string(".bin"), bytes);
  }
  model::WindBox shape;
  shape.times = 4;
  shape.columns = 3;
  shape.rows = 2;
  shape.step = 0.5;
  shape.width = 10.0;
  shape.height = 20.0;
  shape.bottom = 80.0;
  shape.speed = 8.0;
  const model::WindBox box = io::read_hawc_box(paths, shape, {1.0, 2.0, 0.5});
  BOOST_TEST(box.is_periodic);
  BOOST_TEST(box.is_fluctuation);
  // Instant 2, upper row, left column: 201, twice 1201, half of 2201.
  const Vector3 there = box.at({0.0, 10.0, 100.0}, 1.0).velocity;
  BOOST_TEST((there - Vector3(201.0, 2402.0, 1100.5)).norm() < 1e-3);
  BOOST_TEST(std::abs(box.at({0.0, -10.0, 80.0}, 1.0).velocity(0) - 220.0) < 1e-3);
  shape.rows = 3;
  BOOST_TEST(has(fault_of([&] {
                   io::read_hawc_box(paths, shape, {1.0, 1.0, 1.0});
                 }),
                 "has 96 bytes, a box of 4 x 3 x 3 points has 144"));
}

BOOST_AUTO_TEST_CASE(a_table_sets_the_curves_that_are_not_given) {
  constexpr double degree = std::numbers::pi / 180.0;
  const Folder folder;
  folder.write("a.wnd",
               "! t V dir Vz hshr vshr vlin gust upflow\n"
               "0 8 0 0 0 0.1 0 0 0\n10, 12, 10, 0, 0.2, 0.3, -0.1, 1, 5 remark\n");
  model::WindChange change;
  change.table_path = "a.wnd";
  model::WindDefinition mean;
  mean.speed = 8.0;
  change.exponent = math::TimeCurve::along({{0.0, 0.7}, {1.0, 0.7}});
  io::read_wind_files(change, folder.path, mean);
  BOOST_TEST(change.speed->at(5.0).value == 10.0);
  BOOST_TEST(std::abs(change.direction->at(10.0).value + 10.0 * degree) < 1e-12);
  BOOST_TEST(std::abs(change.upflow->at(10.0).value - 5.0 * degree) < 1e-12);
  BOOST_TEST(change.exponent->at(5.0).value == 0.7);
  BOOST_TEST(std::abs(change.shear_left->at(5.0).value - 0.1) < 1e-12);
  BOOST_TEST(std::abs(change.shear_up->at(5.0).value + 0.05) < 1e-12);
  BOOST_TEST(change.gust->at(20.0).value == 1.0);
  folder.write("a.wnd", "0 8 0 0 0 0.1 0 0\n0 9 0 0 0 0.1 0 0\n");
  BOOST_TEST(has(fault_of([&] { io::read_wind_files(change, folder.path, mean); }),
                 "a.wnd:2: the times do not rise"));
}

BOOST_AUTO_TEST_CASE(lines_of_a_table_end_with_lf_cr_lf_or_cr) {
  const Folder folder;
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const std::string text = "! t V dir Vz hshr vshr vlin gust" + end + "0 8 0 0 0 0 0 0" + end +
                             "9\t7 0 0 0 0 0 0" + end;
    const auto rows = io::read_uniform_wind(folder.write("a.wnd", text));
    BOOST_REQUIRE(rows.size() == 2u);
    BOOST_TEST(rows[1].time == 9.0);
    BOOST_TEST(rows[1].speed == 7.0);
  }
}

BOOST_AUTO_TEST_SUITE_END()
