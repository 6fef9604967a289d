#include "samara/model/beam.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "samara/base/error.hpp"
#include "samara/math/quadrature.hpp"
#include "samara/math/rotation.hpp"
#include "samara/model/reference_line.hpp"

namespace samara::model {
namespace {

/// Shortest element next to a point mass, relative to the even length.
constexpr double least_element = 0.25;

/// Gauss points between two stations. Sections are linear there, their compliance is not.
constexpr int fine_points = 6;

/// Relative to the largest pivot of a semi-definite matrix. A smaller pivot is round-off.
constexpr double semi_definite = 1e-12;

TestFunctions test_functions(const math::QuadratureRule& rule) {
  const int order = static_cast<int>(rule.points.size());
  const std::vector<double> nodes = math::lobatto_nodes(order);
  TestFunctions functions;
  functions.weights = rule.weights;
  for (int a = 0; a <= order; ++a) {
    std::vector<double> value;
    std::vector<double> slope;
    for (const double xi : rule.points) {
      value.push_back(math::lagrange(nodes, a, xi));
      slope.push_back(math::lagrange_derivative(nodes, a, xi));
    }
    functions.value.push_back(value);
    functions.slope.push_back(slope);
  }
  return functions;
}

/// Ends of elements by the stated lengths, as fractions of the length of the beam.
std::vector<double> regular_ends(const BeamDefinition& definition) {
  const int n = definition.elements;
  std::vector<double> ends;
  if (definition.element_lengths.empty()) {
    for (int e = 0; e <= n; ++e) ends.push_back(static_cast<double>(e) / n);
    return ends;
  }
  std::vector<double> stated{0.0};
  for (const double length : definition.element_lengths) stated.push_back(stated.back() + length);
  const auto intervals = static_cast<double>(definition.element_lengths.size());
  for (int e = 0; e <= n; ++e) {
    const double place = intervals * e / n;
    const auto i = std::min(static_cast<std::size_t>(place), stated.size() - 2);
    const double part = place - static_cast<double>(i);
    ends.push_back((stated[i] + part * (stated[i + 1] - stated[i])) / stated.back());
  }
  ends.back() = 1.0;
  return ends;
}

/// The regular ends, except that each point mass moves the nearest end to its place.
std::vector<double> element_ends(const std::string& name, const BeamDefinition& definition) {
  const int n = definition.elements;
  const std::vector<double> regular = regular_ends(definition);
  std::vector<double> ends = regular;
  int last = 0;
  for (const PointMassDefinition& lump : definition.point_masses) {
    if (lump.at == 1.0 || lump.at == ends[static_cast<std::size_t>(last)]) continue;
    // The later one of two ends at the same distance.
    const auto next = std::lower_bound(regular.begin() + 1, regular.end(), lump.at);
    const bool is_next = *next - lump.at <= lump.at - *(next - 1);
    const auto found = static_cast<int>(next - regular.begin()) - (is_next ? 0 : 1);
    last = std::max(std::min(found, n - 1), last + 1);
    if (last >= n) break;
    ends[static_cast<std::size_t>(last)] = lump.at;
  }
  const auto is_short = [&](std::size_t e) {
    const double before = e > 1 ? regular[e - 1] - regular[e - 2] : regular[e] - regular[e - 1];
    const double behind = e < ends.size() - 1 ? regular[e + 1] - regular[e] : before;
    const double least = std::min({before, regular[e] - regular[e - 1], behind});
    return !(ends[e] - ends[e - 1] >= least_element * least);
  };
  for (std::size_t e = 1; e < ends.size(); ++e)
    if (last >= n || is_short(e))
      throw InputError(name + ": the mesh of " + std::to_string(n) +
                       (n == 1 ? " element" : " elements") +
                       " is too coarse for the places of its point masses and mass dampers; hint: "
                       "increase elements");
  return ends;
}

/// The inverse on the elastic directions, zero elsewhere.
Matrix6 inverse_of(const Matrix6& stiffness, const std::vector<int>& elastic) {
  const auto n = static_cast<Eigen::Index>(elastic.size());
  Eigen::MatrixXd S(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      S(i, j) =
          stiffness(elastic[static_cast<std::size_t>(i)], elastic[static_cast<std::size_t>(j)]);
  const Eigen::MatrixXd inverse = S.llt().solve(Eigen::MatrixXd::Identity(n, n));
  Matrix6 compliance = Matrix6::Zero();
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      compliance(elastic[static_cast<std::size_t>(i)], elastic[static_cast<std::size_t>(j)]) =
          0.5 * (inverse(i, j) + inverse(j, i));
  return compliance;
}

/// Mass and compliance of a Gauss point.
struct MeanSection {
  Matrix6 mass = Matrix6::Zero();
  Matrix6 compliance = Matrix6::Zero();
};

bool is_semi_definite(const Matrix6& matrix) {
  const Eigen::LDLT<Matrix6> factors(matrix);
  const Vector6 pivots = factors.vectorD();
  return pivots.minCoeff() >= -semi_definite * pivots.cwiseAbs().maxCoeff();
}

/// The ends of an element and the stations between them.
std::vector<double> cuts_of(const BeamDefinition& definition, double start, double span) {
  std::vector<double> cuts{start};
  for (const SectionDefinition& section : definition.sections)
    if (section.at > start && section.at < start + span) cuts.push_back(section.at);
  cuts.push_back(start + span);
  return cuts;
}

/// Mean sections of an element with stations inside it. The values at the points would omit
/// sections between the points. The integrals (1 / w_j) int l_j(xi) m(xi) dxi, with the polynomials
/// l_j through the points, keep the moments of the section data. Without stations inside, the
/// integrals equal the values at the points: nothing is returned, and those are used. They are also
/// used if an integral is not a possible section.
std::vector<MeanSection> mean_sections(const BeamDefinition& definition,
                                       const math::QuadratureRule& rule, const ReferenceLine& line,
                                       double start, double span) {
  const std::vector<double> cuts = cuts_of(definition, start, span);
  if (cuts.size() == 2) return {};
  const math::QuadratureRule fine = math::gauss_rule(fine_points);
  std::vector<MeanSection> means(rule.points.size());
  const auto axes_at = [&](double at) {
    return line.at(at, interpolate_section(definition, at).twist).C_ab;
  };
  for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
    for (std::size_t q = 0; q < fine.points.size(); ++q) {
      const double at = cuts[c] + (cuts[c + 1] - cuts[c]) * fine.points[q];
      const double length = (cuts[c + 1] - cuts[c]) / span * fine.weights[q];
      const SectionDefinition section = interpolate_section(definition, at);
      const Matrix6 compliance = compliance_of(section);
      const Matrix3 axes = axes_at(at);
      for (std::size_t j = 0; j < means.size(); ++j) {
        const double share = math::lagrange(rule.points, static_cast<int>(j), (at - start) / span) *
                             length / rule.weights[j];
        Matrix6 turn = Matrix6::Zero();  // into the axes of the point
        turn.topLeftCorner<3, 3>() = axes_at(start + span * rule.points[j]).transpose() * axes;
        turn.bottomRightCorner<3, 3>() = turn.topLeftCorner<3, 3>();
        means[j].mass += share * turn * section.mass * turn.transpose();
        means[j].compliance += share * turn * compliance * turn.transpose();
      }
    }
  }
  const auto all = [&means](Matrix6 MeanSection::*part) {
    return std::all_of(means.begin(), means.end(),
                       [part](const MeanSection& mean) { return is_semi_definite(mean.*part); });
  };
  const bool masses = all(&MeanSection::mass);
  const bool compliances = all(&MeanSection::compliance);
  for (std::size_t j = 0; j < means.size(); ++j) {
    const SectionDefinition section =
        interpolate_section(definition, start + span * rule.points[j]);
    if (!masses) means[j].mass = section.mass;
    if (!compliances) means[j].compliance = compliance_of(section);
  }
  return means;
}

/// Remainder of the element that ends with the last points of `beam`.
SectionRemainder section_remainder(const BeamDefinition& definition, const ReferenceLine& line,
                                   const math::QuadratureRule& rule, const Beam& beam, double start,
                                   double span, double mass_factor, double stiffness_factor) {
  const auto s = static_cast<Eigen::Index>(rule.points.size());
  const std::size_t first = beam.points.size() - rule.points.size();
  const double length = span * definition.length;
  SectionRemainder remainder{Eigen::MatrixXd::Zero(6 * s, 6 * s),
                             Eigen::MatrixXd::Zero(6 * s, 6 * s)};
  const std::vector<double> cuts = cuts_of(definition, start, span);
  const math::QuadratureRule fine = math::gauss_rule(fine_points + static_cast<int>(s));
  std::vector<Matrix6> turns(rule.points.size(), Matrix6::Zero());  // from the axes of a place
  std::vector<double> values(rule.points.size());
  for (std::size_t c = 0; c + 1 < cuts.size(); ++c)
    for (std::size_t q = 0; q < fine.points.size(); ++q) {
      const double at = cuts[c] + (cuts[c + 1] - cuts[c]) * fine.points[q];
      const double share = (cuts[c + 1] - cuts[c]) * definition.length * fine.weights[q];
      const SectionDefinition section = interpolate_section(definition, at);
      const Matrix3 axes = line.at(at, section.twist).C_ab;
      const Matrix6 compliance = share / stiffness_factor * compliance_of(section);
      const Matrix6 mass = share * mass_factor * section.mass;
      for (std::size_t j = 0; j < turns.size(); ++j) {
        values[j] = math::lagrange(rule.points, static_cast<int>(j), (at - start) / span);
        const Matrix3 turn = beam.points[first + j].C_ab.transpose() * axes;
        turns[j].topLeftCorner<3, 3>() = turn;
        turns[j].bottomRightCorner<3, 3>() = turn;
      }
      for (Eigen::Index j = 0; j < s; ++j)
        for (Eigen::Index k = 0; k < s; ++k) {
          const auto a = static_cast<std::size_t>(j);
          const auto b = static_cast<std::size_t>(k);
          const double weight = values[a] * values[b];
          remainder.compliance.block<6, 6>(6 * j, 6 * k) +=
              weight * turns[a] * compliance * turns[b].transpose();
          remainder.mass.block<6, 6>(6 * j, 6 * k) +=
              weight * turns[a] * mass * turns[b].transpose();
        }
    }
  for (Eigen::Index j = 0; j < s; ++j) {
    const auto at = static_cast<std::size_t>(j);
    const double weight = rule.weights[at] * length;
    remainder.compliance.block<6, 6>(6 * j, 6 * j) -= weight * beam.points[first + at].compliance;
    remainder.mass.block<6, 6>(6 * j, 6 * j) -= weight * beam.points[first + at].mass;
  }
  return remainder;
}

void add_supports(const BeamDefinition& definition, Beam& beam) {
  const SupportDefinition& support = definition.support;
  if (!support.is_clamp()) {
    std::vector<int> elastic;
    for (int i = 0; i < 6; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (!support.rigid[at] && !support.free[at]) elastic.push_back(i);
    }
    beam.has_support = true;
    beam.support.compliance = inverse_of(support.stiffness, elastic);
    beam.support.free = support.free;
    beam.support.damping = support.damping;
    beam.support.added_mass = support.added_mass.asDiagonal();
    beam.mass_nodes.push_back(
        {0, Vector3::Zero(),
         rigid_mass(support.mass, support.center, support.inertia.asDiagonal())});
  }
  beam.end_support.stiffness = definition.end_support.stiffness;
  beam.end_support.rigid = definition.end_support.rigid;
}

}  // namespace

Matrix6 compliance_of(const SectionDefinition& section) {
  std::vector<int> elastic;
  for (int i = 0; i < 6; ++i)
    if (!section.rigid[static_cast<std::size_t>(i)]) elastic.push_back(i);
  return inverse_of(section.stiffness, elastic);
}

Matrix6 rigid_mass(double mass, const Vector3& center, const Matrix3& inertia_about_center) {
  const Matrix3 across = mass * math::skew<double>(center);
  Matrix6 matrix;
  matrix << mass * Matrix3::Identity(), -across, across,
      inertia_about_center - across * math::skew<double>(center);
  return matrix;
}

Beam build_beam(const std::string& name, const BeamDefinition& definition, double mass_factor,
                double stiffness_factor) {
  const math::QuadratureRule rule = math::gauss_rule(definition.order);
  const ReferenceLine line(name, definition);
  Beam beam;
  beam.name = name;
  beam.elements = definition.elements;
  beam.order = definition.order;
  beam.length = definition.length;
  beam.ends = element_ends(name, definition);
  beam.functions = test_functions(rule);
  beam.tip = line.at(1.0).x;
  beam.tip_mass = rigid_mass(definition.tip_mass, Vector3::Zero(), Matrix3::Zero());
  for (int e = 0; e < definition.elements; ++e) {
    const double start = beam.ends[static_cast<std::size_t>(e)];
    const double span = beam.ends[static_cast<std::size_t>(e) + 1] - start;
    const std::vector<MeanSection> means = mean_sections(definition, rule, line, start, span);
    for (const double& xi : rule.points) {
      const double fraction = start + span * xi;
      const SectionDefinition section = interpolate_section(definition, fraction);
      const ReferenceLine::Station station = line.at(fraction, section.twist);
      elements::BeamPoint point;
      point.x = station.x;
      point.C_ab = station.C_ab;
      const auto j = static_cast<std::size_t>(&xi - rule.points.data());
      point.compliance = means.empty() ? compliance_of(section) : means[j].compliance;
      point.compliance /= stiffness_factor;
      point.mass = (means.empty() ? section.mass : means[j].mass) * mass_factor;
      for (int i = 0; i < 6; ++i)
        point.damping(i) = section.rigid[static_cast<std::size_t>(i)] ? 0.0 : definition.damping(i);
      point.drag = point.mass(0, 0) * point.C_ab * definition.mass_damping.asDiagonal() *
                   point.C_ab.transpose();
      if (!point.drag.isZero(0.0)) beam.has_drag = true;
      beam.points.push_back(point);
      beam.fractions.push_back(fraction);
    }
    beam.remainders.push_back(section_remainder(definition, line, rule, beam, start, span,
                                                mass_factor, stiffness_factor));
  }
  add_supports(definition, beam);
  for (const PointMassDefinition& lump : definition.point_masses) {
    const ReferenceLine::Station station =
        line.at(lump.at, interpolate_section(definition, lump.at).twist);
    const Matrix3 C = station.C_ab;
    const Matrix3 inertia = C * lump.inertia.asDiagonal() * C.transpose();
    const Matrix6 mass = rigid_mass(lump.mass, C * lump.center, inertia);
    if (lump.at == 1.0) {
      beam.tip_mass += mass;
      continue;
    }
    const auto end = std::find(beam.ends.begin(), beam.ends.end(), lump.at) - beam.ends.begin();
    if (!beam.mass_nodes.empty() && beam.mass_nodes.back().end == end)
      beam.mass_nodes.back().mass += mass;
    else
      beam.mass_nodes.push_back({static_cast<int>(end), station.x, mass});
  }
  return beam;
}

}  // namespace samara::model
