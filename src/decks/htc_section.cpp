#include "htc_section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "samara/math/rotation.hpp"

namespace samara::decks {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// Columns that both kinds of tables have.
constexpr std::size_t r_column = 0;
constexpr std::size_t mass_column = 1;
constexpr std::size_t x_cg = 2;
constexpr std::size_t y_cg = 3;
constexpr std::size_t ri_x = 4;
constexpr std::size_t ri_y = 5;
/// Of a table of 19 columns.
constexpr std::size_t x_sh = 6;
constexpr std::size_t y_sh = 7;
constexpr std::size_t young = 8;
constexpr std::size_t shear = 9;
constexpr std::size_t area_x = 10;
constexpr std::size_t area_y = 11;
constexpr std::size_t torsion = 12;
constexpr std::size_t factor_x = 13;
constexpr std::size_t factor_y = 14;
constexpr std::size_t area = 15;
/// Of one of 30 columns: the 21 entries of the stiffness matrix, by rows.
constexpr std::size_t first_entry = 9;
/// Of both, behind the columns of their own or before them: pitch, x_e, y_e.
constexpr std::size_t classic_pitch = 16;
constexpr std::size_t full_pitch = 6;

/// HAWC2's component of each of b1 b2 b3.
constexpr std::array<Eigen::Index, 3> source{2, 0, 1};

/// Strains of HAWC2 (shear x, shear y, axial, bending x, bending y, torsion) at the point x, y in
/// axes turned by `pitch` about z, from those at the origin.
Matrix6 strains_at(double x, double y, double pitch) {
  Matrix6 shifted = Matrix6::Identity();  // gamma + kappa x r
  shifted(0, 5) = -y;
  shifted(1, 5) = x;
  shifted(2, 3) = y;
  shifted(2, 4) = -x;
  Matrix6 turned = Matrix6::Zero();
  turned.topLeftCorner<3, 3>() = math::turn_about<double>(Vector3::UnitZ(), -pitch);
  turned.bottomRightCorner<3, 3>() = turned.topLeftCorner<3, 3>();
  return turned * shifted;
}

Matrix6 stiffness_of(const std::vector<double>& row, bool full) {
  if (full) {
    Matrix6 elastic;
    std::size_t entry = first_entry;
    for (Eigen::Index i = 0; i < 6; ++i)
      for (Eigen::Index j = i; j < 6; ++j) elastic(i, j) = elastic(j, i) = row[entry++];
    const Matrix6 at =
        strains_at(row[full_pitch + 1], row[full_pitch + 2], row[full_pitch] * degree);
    return at.transpose() * elastic * at;
  }
  const double pitch = row[classic_pitch] * degree;
  Matrix6 elastic = Matrix6::Zero();
  elastic(2, 2) = row[young] * row[area];
  elastic(3, 3) = row[young] * row[area_x];
  elastic(4, 4) = row[young] * row[area_y];
  Matrix6 about_shear = Matrix6::Zero();
  about_shear(0, 0) = row[factor_x] * row[shear] * row[area];
  about_shear(1, 1) = row[factor_y] * row[shear] * row[area];
  about_shear(5, 5) = row[shear] * row[torsion];
  const Matrix6 at_elastic = strains_at(row[classic_pitch + 1], row[classic_pitch + 2], pitch);
  const Matrix6 at_shear = strains_at(row[x_sh], row[y_sh], pitch);
  return at_elastic.transpose() * elastic * at_elastic +
         at_shear.transpose() * about_shear * at_shear;
}

/// The radii of gyration count from the elastic centre, about the principal axes of bending.
Matrix6 mass_of(const std::vector<double>& row, bool full) {
  const double m = row[mass_column];
  const std::size_t column = full ? full_pitch : classic_pitch;
  const double pitch = row[column] * degree;
  const double x_e = row[column + 1];
  const double y_e = row[column + 2];
  const double c = std::cos(pitch);
  const double s = std::sin(pitch);
  const double about_x = m * row[ri_x] * row[ri_x];  // integral of eta^2
  const double about_y = m * row[ri_y] * row[ri_y];  // of xi^2
  const double mx = m * row[x_cg];
  const double my = m * row[y_cg];
  // Integrals of x^2, y^2 and x y about the origin: xi = c dx + s dy, eta = -s dx + c dy.
  const double xx = c * c * about_y + s * s * about_x + x_e * (2.0 * mx - m * x_e);
  const double yy = s * s * about_y + c * c * about_x + y_e * (2.0 * my - m * y_e);
  const double xy = c * s * (about_y - about_x) + x_e * my + y_e * mx - m * x_e * y_e;
  Matrix6 matrix = Matrix6::Zero();
  matrix.topLeftCorner<3, 3>().diagonal().setConstant(m);
  const Matrix3 first = math::skew<double>(Vector3(mx, my, 0.0));
  matrix.topRightCorner<3, 3>() = -first;
  matrix.bottomLeftCorner<3, 3>() = first;
  matrix.bottomRightCorner<3, 3>() << yy, -xy, 0.0, -xy, xx, 0.0, 0.0, 0.0, xx + yy;
  return matrix;
}

Matrix6 to_case(const Matrix6& matrix) {
  Matrix6 turned;
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = 0; j < 6; ++j)
      turned(i, j) = matrix(3 * (i / 3) + source[static_cast<std::size_t>(i % 3)],
                            3 * (j / 3) + source[static_cast<std::size_t>(j % 3)]);
  return turned;
}

/// Rows on both sides of a place, and the share of the second.
struct Between {
  std::size_t a = 0;
  std::size_t b = 0;
  double share = 0.0;
};

Between find_rows(const StTable& table, double r, bool behind) {
  const auto& rows = table.rows;
  std::size_t b = 0;
  while (b < rows.size() && (behind ? rows[b][r_column] <= r : rows[b][r_column] < r)) ++b;
  if (b == rows.size()) return {b - 1, b - 1, 0.0};
  if (b == 0 || rows[b][r_column] == r) return {b, b, 0.0};
  const double below = rows[b - 1][r_column];
  return {b - 1, b, (r - below) / (rows[b][r_column] - below)};
}

}  // namespace

StSection interpolate_st(const StTable& table, double r, bool behind) {
  // Matrices of the rows are linear in between: those of mass keep all moments of the deck where
  // its columns are linear but for the products of small differences.
  const Between between = find_rows(table, r, behind);
  StSection section{to_case(stiffness_of(table.rows[between.a], table.full)),
                    to_case(mass_of(table.rows[between.a], table.full))};
  if (between.share == 0.0) return section;
  section.stiffness += between.share * (to_case(stiffness_of(table.rows[between.b], table.full)) -
                                        section.stiffness);
  section.mass +=
      between.share * (to_case(mass_of(table.rows[between.b], table.full)) - section.mass);
  return section;
}

double interpolate_column(const StTable& table, std::size_t column, double r, bool behind) {
  const Between between = find_rows(table, r, behind);
  const double a = table.rows[between.a][column];
  return a + between.share * (table.rows[between.b][column] - a);
}

void turn_half(Matrix6& matrix) {
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = 0; j < 6; ++j)
      if ((i % 3 == 0) != (j % 3 == 0)) matrix(i, j) = -matrix(i, j);
}

void RigidBody::add(double mass, const Vector3& center, const Matrix3& inertia) {
  const Matrix3 arm = math::skew<double>(center);
  mass_ += mass;
  first_ += mass * center;
  moments_ += inertia - mass * arm * arm;
}

void RigidBody::add(const RigidBody& other) {
  mass_ += other.mass_;
  first_ += other.first_;
  moments_ += other.moments_;
}

Vector3 RigidBody::center() const {
  if (mass_ == 0.0) return Vector3::Zero();
  return first_ / mass_;
}

Matrix3 RigidBody::inertia() const {
  const Matrix3 arm = math::skew<double>(center());
  return moments_ + mass_ * arm * arm;
}

double largest_product(const Matrix3& inertia) {
  return std::max({std::abs(inertia(0, 1)), std::abs(inertia(0, 2)), std::abs(inertia(1, 2))});
}

}  // namespace samara::decks
