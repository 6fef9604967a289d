#include "samara/model/definition.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

#include <Eigen/Eigenvalues>

#include "samara/base/error.hpp"
#include "samara/math/spline.hpp"

namespace samara::model {
namespace {

/// Two entries of a printed symmetric matrix may differ by this much, relative to the larger.
constexpr double symmetry_tolerance = 1e-6;

/// Eigenvalues of a matrix scaled to a unit diagonal count as zero below this.
constexpr double mass_null_tolerance = 1e-10;
constexpr double stiffness_null_tolerance = 1e-12;

/// A unit null vector moves a component if its share in that component is above this.
constexpr double component_tolerance = 1e-6;

/// The place of an entry in words; indices count from 1, as in the case file.
std::string describe_entry(int row, int column) {
  return "(" + std::to_string(row + 1) + ", " + std::to_string(column + 1) + ")";
}

/// Returns the reason why a matrix is not finite or not symmetric, or an empty string.
std::string find_symmetry_fault(const Matrix6& matrix, const std::string& name) {
  if (!matrix.allFinite()) return "the " + name + " matrix has an entry that is not finite";
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < i; ++j) {
      const double larger = std::max(std::abs(matrix(i, j)), std::abs(matrix(j, i)));
      if (std::abs(matrix(i, j) - matrix(j, i)) > symmetry_tolerance * larger) {
        return "the " + name + " matrix is not symmetric: entries " + describe_entry(i, j) +
               " and " + describe_entry(j, i) + " differ";
      }
    }
  }
  return {};
}

/// Scales a symmetric matrix to a unit diagonal. Units and magnitudes then have no influence on the
/// definiteness test. Rows with a zero diagonal do not change.
Matrix6 scale_to_unit_diagonal(const Matrix6& matrix) {
  Vector6 scale = Vector6::Ones();
  for (int i = 0; i < 6; ++i) {
    if (matrix(i, i) > 0.0) scale(i) = 1.0 / std::sqrt(matrix(i, i));
  }
  const Matrix6 symmetric = 0.5 * (matrix + matrix.transpose());
  return scale.asDiagonal() * symmetric * scale.asDiagonal();
}

std::string find_stiffness_fault(const SectionDefinition& section) {
  std::string fault = find_symmetry_fault(section.stiffness, "stiffness");
  if (!fault.empty()) return fault;

  Matrix6 elastic = section.stiffness;
  for (int i = 0; i < 6; ++i) {
    const bool rigid = section.rigid[static_cast<std::size_t>(i)];
    if (rigid) {
      if (!section.stiffness.row(i).isZero(0.0) || !section.stiffness.col(i).isZero(0.0)) {
        return "the row and column of a rigid strain must be 0 in the stiffness matrix (row " +
               std::to_string(i + 1) + ")";
      }
      elastic(i, i) = 1.0;
    } else if (!(section.stiffness(i, i) > 0.0)) {
      return "the stiffness matrix is not positive definite: entry " + describe_entry(i, i) +
             " must be > 0 (or rigid)";
    }
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(scale_to_unit_diagonal(elastic),
                                                      Eigen::EigenvaluesOnly);
  if (!(solver.eigenvalues()(0) > stiffness_null_tolerance)) {
    return "the stiffness matrix is not positive definite: its coupling terms are too large for "
           "its diagonal";
  }
  return {};
}

/// Returns a fault if an elastic strain moves a rotation without inertia, or an empty string. V and
/// Omega of a section follow from u and theta. Torsion rotates a section about b1 independently; a
/// rotation about b2 or b3 is the slope of the reference line, unless shear makes it independent.
std::string find_massless_fault(const SectionDefinition& section, const Vector6& null_share) {
  if (null_share.head<3>().maxCoeff() > component_tolerance) {
    return "the mass matrix is singular for a motion with translation: a point mass beside the "
           "reference line needs an inertia about its own centre";
  }
  struct Tie {
    int rotation;
    std::size_t strain;
    const char* axis;
    const char* stiffness;
  };
  constexpr Tie ties[] = {{3, 3, "b1", "GJ"}, {4, 2, "b2", "GA3"}, {5, 1, "b3", "GA2"}};
  for (const Tie& tie : ties) {
    if (null_share(tie.rotation) > component_tolerance && !section.rigid[tie.strain]) {
      return std::string("the section has no inertia about ") + tie.axis +
             ": give it one, or make " + tie.stiffness + " rigid";
    }
  }
  return {};
}

std::string find_mass_fault(const SectionDefinition& section) {
  std::string fault = find_symmetry_fault(section.mass, "mass");
  if (!fault.empty()) return fault;

  for (int i = 0; i < 6; ++i) {
    if (i < 3 && !(section.mass(i, i) > 0.0)) {
      return "the section has no mass per length: entry " + describe_entry(i, i) +
             " of the mass matrix must be > 0";
    }
    if (section.mass(i, i) < 0.0) {
      return "the mass matrix is not positive semi-definite: entry " + describe_entry(i, i) +
             " is negative";
    }
    if (section.mass(i, i) == 0.0 && !section.mass.row(i).isZero(0.0)) {
      return "the mass matrix is not positive semi-definite: entry " + describe_entry(i, i) +
             " is 0 but its row is not";
    }
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(scale_to_unit_diagonal(section.mass));
  if (solver.eigenvalues()(0) < -mass_null_tolerance) {
    return "the mass matrix is not positive semi-definite: the inertia about the reference line is "
           "too small for the offset of the mass centre";
  }
  Vector6 null_share = Vector6::Zero();
  for (int k = 0; k < 6 && solver.eigenvalues()(k) <= mass_null_tolerance; ++k) {
    null_share += solver.eigenvectors().col(k).cwiseAbs2();
  }
  return find_massless_fault(section, null_share.cwiseSqrt());
}

}  // namespace

elements::TorqueLine TorqueLaw::at(double speed) const {
  if (table.empty()) return {torque, slope, speed, {}};
  if (!covers(speed)) {
    if (speed == 0.0) return {};
    throw InternalError("a torque table does not cover the speed");
  }
  const auto slope_before = [this](std::size_t i) {
    return (table[i].second - table[i - 1].second) / (table[i].first - table[i - 1].first);
  };
  std::size_t i = 1;
  while (i + 1 < table.size() && table[i].first < speed) ++i;
  elements::TorqueLine line{0.0, slope_before(i), speed, {}};
  line.torque = table[i].second + line.slope * (speed - table[i].first);
  if (i + 1 < table.size() && table[i].first == speed)
    line.slope = 0.5 * (slope_before(i) + slope_before(i + 1));
  return line;
}

elements::JointMotion PrescribedMotion::at(double t, double rotor_speed) const {
  const double rate = per_rev > 0 ? per_rev * rotor_speed : frequency;
  const double turned = rate * t + phase;
  return {angle + amplitude * std::cos(turned), -amplitude * rate * std::sin(turned),
          -amplitude * rate * rate * std::cos(turned)};
}

SectionDefinition interpolate_section(const BeamDefinition& beam, double fraction) {
  const std::vector<SectionDefinition>& sections = beam.sections;
  if (sections.empty()) throw InternalError("interpolate_section: the beam has no section");

  const auto next =
      std::lower_bound(sections.begin(), sections.end(), fraction,
                       [](const SectionDefinition& section, double at) { return section.at < at; });
  SectionDefinition result;
  if (next == sections.begin()) {
    result = sections.front();
  } else if (next == sections.end()) {
    result = sections.back();
  } else if (next->at == fraction) {
    result = *next;
  } else {
    const SectionDefinition& left = *std::prev(next);
    const SectionDefinition& right = *next;
    const double weight = (fraction - left.at) / (right.at - left.at);
    result.stiffness = (1.0 - weight) * left.stiffness + weight * right.stiffness;
    result.mass = (1.0 - weight) * left.mass + weight * right.mass;
    result.twist = (1.0 - weight) * left.twist + weight * right.twist;
    for (int i = 0; i < 6; ++i) {
      const std::size_t k = static_cast<std::size_t>(i);
      result.rigid[k] = left.rigid[k] || right.rigid[k];
      if (result.rigid[k]) {
        result.stiffness.row(i).setZero();
        result.stiffness.col(i).setZero();
      }
    }
  }
  result.at = fraction;
  return result;
}

std::string find_section_fault(const SectionDefinition& section) {
  if (!std::isfinite(section.twist)) return "the twist is not finite";
  std::string fault = find_stiffness_fault(section);
  if (fault.empty()) fault = find_mass_fault(section);
  return fault;
}

SupportDefinition free_end() {
  SupportDefinition end;
  end.rigid = {};
  end.free.fill(true);
  return end;
}

std::string find_support_fault(const SupportDefinition& support) {
  SectionDefinition springs;  // checked in the form of a section
  springs.stiffness = support.stiffness;
  for (std::size_t i = 0; i < 6; ++i) {
    springs.rigid[i] = support.rigid[i] || support.free[i];
    const auto k = static_cast<Eigen::Index>(i);
    if (springs.rigid[i] && !support.stiffness.row(k).isZero(0.0))
      return "a direction that is rigid or free cannot have springs as well";
  }
  return find_stiffness_fault(springs);
}

double compute_arc_length(const std::vector<Vector3>& reference_line) {
  if (reference_line.size() < 2) return 0.0;
  for (std::size_t i = 1; i < reference_line.size(); ++i)
    if (!((reference_line[i] - reference_line[i - 1]).norm() > 0.0))
      return std::numeric_limits<double>::quiet_NaN();
  return math::NaturalSpline(reference_line).length();
}

}  // namespace samara::model
