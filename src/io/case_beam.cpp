#include "case_beam.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "samara/base/error.hpp"
#include "samara/model/beam_modes.hpp"

namespace samara::io {
namespace {

constexpr int max_elements = 100000;

/// `length` beside `reference_line` must agree to this, relative.
constexpr double length_tolerance = 1e-3;

bool is_word(const YamlNode& node, std::string_view word) {
  return node.kind == YamlNode::Kind::scalar && node.text == word;
}

bool is_rigid(const YamlNode& node) { return is_word(node, "rigid"); }

void read_stiffness_map(const YamlNode& node, const std::string& where,
                        model::SectionDefinition& section, ErrorList& errors) {
  constexpr std::array<const char*, 6> keys = {"EA", "GA2", "GA3", "GJ", "EI2", "EI3"};
  constexpr NumberRule rule{"a number > 0 or rigid", positive.low, positive.high, true};
  MapReader map(node, where, errors);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const YamlNode* entry = map.require(keys[i], "a number > 0 or rigid");
    if (entry == nullptr) continue;
    section.rigid[i] = is_rigid(*entry);
    const auto k = static_cast<Eigen::Index>(i);
    if (!section.rigid[i]) {
      read_number(*entry, map.where(keys[i]), rule, section.stiffness(k, k), errors);
    }
  }
  map.finish();
}

/// Reads 6 rows of 6; on the diagonal the word `rigid` is accepted where `rigid` is given.
void read_matrix(const YamlNode& node, const std::string& where, Matrix6& matrix,
                 std::array<bool, 6>* rigid, ErrorList& errors) {
  if (node.kind != YamlNode::Kind::list || node.children.size() != 6) {
    errors.add(node.place, where, "expected a list of 6 rows of 6 numbers, " + describe(node));
    return;
  }
  constexpr NumberRule number_or_rigid{"a finite number or rigid"};
  const std::size_t errors_before = errors.size();
  for (std::size_t i = 0; i < 6; ++i) {
    const YamlNode& row = node.children[i];
    const std::string row_where = join_path(where, i);
    if (row.kind != YamlNode::Kind::list || row.children.size() != 6) {
      errors.add(row.place, row_where, "expected a list of 6 numbers, " + describe(row));
      continue;
    }
    for (std::size_t j = 0; j < 6; ++j) {
      if (i == j && rigid != nullptr && is_rigid(row.children[j])) {
        (*rigid)[i] = true;
        continue;
      }
      const NumberRule& rule = i == j && rigid != nullptr ? number_or_rigid : any_number;
      read_number(row.children[j], join_path(row_where, j), rule,
                  matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)), errors);
    }
  }
  if (errors.size() > errors_before) matrix.setZero();
}

void read_stiffness(MapReader& map, model::SectionDefinition& section) {
  const YamlNode* entries = map.find("stiffness");
  const YamlNode* matrix = map.find("stiffness_matrix");
  if (entries != nullptr && matrix != nullptr) {
    map.refuse(*matrix, "stiffness_matrix", "given together with stiffness; leave one of them out");
  } else if (entries != nullptr) {
    read_stiffness_map(*entries, map.where("stiffness"), section, map.errors());
  } else if (matrix != nullptr) {
    read_matrix(*matrix, map.where("stiffness_matrix"), section.stiffness, &section.rigid,
                map.errors());
  } else {
    map.require("stiffness", "or \"stiffness_matrix\"");
  }
}

/// I6 of a section with its mass centre at c = (0, c2, c3) and its inertia about the reference
/// line: P = m (V + Omega x c), H = I Omega + m c x V, (3).
Matrix6 build_section_mass(double mass, const Vector3& inertia, double c2, double c3) {
  Matrix3 skew_c;
  skew_c << 0.0, -c3, c2, c3, 0.0, 0.0, -c2, 0.0, 0.0;
  Matrix6 matrix = Matrix6::Zero();
  matrix.topLeftCorner<3, 3>() = mass * Matrix3::Identity();
  matrix.topRightCorner<3, 3>() = -mass * skew_c;
  matrix.bottomLeftCorner<3, 3>() = mass * skew_c;
  matrix.bottomRightCorner<3, 3>() = inertia.asDiagonal();
  return matrix;
}

void read_mass(MapReader& map, model::SectionDefinition& section) {
  const YamlNode* matrix = map.find("mass_matrix");
  double mass = 0.0;
  Vector3 inertia = Vector3::Zero();
  std::array<double, 2> center = {0.0, 0.0};
  if (matrix == nullptr) {
    map.require("mass", "per length, or \"mass_matrix\"");
    map.require("inertia", "per length, or \"mass_matrix\"");
  }
  map.read("mass", mass, positive);
  read_vector(map, "inertia", inertia, non_negative);
  map.read("mass_center", std::span<double>(center), any_number);
  if (matrix == nullptr) {
    section.mass = build_section_mass(mass, inertia, center[0], center[1]);
    return;
  }
  for (const char* key : {"mass", "inertia", "mass_center"}) {
    if (const YamlNode* entry = map.node().find(key)) {
      map.refuse(*entry, key, "given together with mass_matrix; leave one of them out");
    }
  }
  read_matrix(*matrix, map.where("mass_matrix"), section.mass, nullptr, map.errors());
}

/// Reads one section. `at` is compulsory where there are several.
model::SectionDefinition read_section(const YamlNode& node, const std::string& where,
                                      bool is_single, ErrorList& errors) {
  model::SectionDefinition section;
  MapReader map(node, where, errors);
  if (!is_single) map.require("at", "the fraction of the length, from 0 to 1");
  map.read("at", section.at, fraction_of_one);
  read_mass(map, section);
  read_stiffness(map, section);
  read_angle(map, "twist_deg", section.twist, any_number);
  map.finish();
  return section;
}

void read_sections(MapReader& map, std::vector<model::SectionDefinition>& sections) {
  ErrorList& errors = map.errors();
  const YamlNode* list = map.require("sections", "a list; one entry is a uniform beam");
  if (list == nullptr) return;
  if (list->kind != YamlNode::Kind::list || list->children.empty()) {
    map.refuse(*list, "sections",
               "expected a list of sections (each starts with \"- \"), " + describe(*list));
    return;
  }
  for (std::size_t i = 0; i < list->children.size(); ++i) {
    const YamlNode& node = list->children[i];
    const std::string where = join_path(map.where("sections"), i);
    sections.push_back(read_section(node, where, list->children.size() == 1, errors));
  }
}

/// Reads `damping`: one mu for all directions, or six.
void read_one_or_six(MapReader& map, const YamlNode& entry, const char* expected,
                     Vector6& damping) {
  const std::string where = map.where("damping");
  if (entry.kind == YamlNode::Kind::list) {
    read_numbers(entry, where, non_negative, std::span<double>(damping.data(), 6), map.errors());
    return;
  }
  const NumberRule rule{expected, non_negative.low};
  double mu = 0.0;
  if (read_number(entry, where, rule, mu, map.errors())) damping.setConstant(mu);
}

void read_damping(MapReader& map, const RatioKeys& ratios, model::BeamDefinition& beam) {
  const YamlNode* entry = map.find("damping");
  if (entry == nullptr) return;
  if (entry->kind == YamlNode::Kind::map) {
    MapReader modes(*entry, map.where("damping"), map.errors());
    for (std::size_t d = 0; d < ratios.size(); ++d) {
      double ratio = 0.0;
      if (modes.read(ratios[d], ratio, fraction_of_one)) beam.modal_damping[d] = ratio;
    }
    modes.finish();
    return;
  }
  read_one_or_six(map, *entry, "a number >= 0, a list of 6 or damping ratios", beam.damping);
}

void read_mass_damping(MapReader& map, model::BeamDefinition& beam) {
  const YamlNode* entry = map.find("mass_damping");
  if (entry == nullptr) return;
  const std::string where = map.where("mass_damping");
  if (entry->kind == YamlNode::Kind::list) {
    read_numbers(*entry, where, non_negative, std::span<double>(beam.mass_damping.data(), 3),
                 map.errors());
    return;
  }
  constexpr NumberRule rule{"a number >= 0 or a list of 3", non_negative.low};
  double alpha = 0.0;
  if (read_number(*entry, where, rule, alpha, map.errors())) beam.mass_damping.setConstant(alpha);
}

/// Reads the points of a reference line as the file states them. False: there is none to use.
bool read_points(MapReader& map, const YamlNode& node, std::vector<Vector3>& points) {
  const std::string where = map.where("reference_line");
  const std::size_t errors_before = map.errors().size();
  if (node.kind != YamlNode::Kind::list || node.children.size() < 2) {
    map.refuse(node, "reference_line",
               "expected a list of at least 2 points of 3 numbers, " + describe(node));
    return false;
  }
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    Vector3 point = Vector3::Zero();
    const std::string point_where = join_path(where, i);
    if (read_numbers(node.children[i], point_where, any_number, std::span<double>(point.data(), 3),
                     map.errors())) {
      if (i == 0 && !point.isZero(0.0)) {
        map.errors().add(find_blame(node.children[i]), point_where,
                         "the first point must be [0, 0, 0], the root of the beam");
      }
      if (!points.empty() && point == points.back()) {
        map.errors().add(find_blame(node.children[i]), point_where,
                         "the same point as the one before");
      }
    }
    points.push_back(point);
  }
  return map.errors().size() == errors_before;
}

/// Reads `length` or `reference_line`; `to_a` maps the file's components to the beam's axes a.
void read_length(MapReader& map, const Matrix3& to_a, model::BeamDefinition& beam) {
  const YamlNode* line = map.find("reference_line");
  if (line == nullptr) map.require("length", "or \"reference_line\"");
  const bool has_length = map.read("length", beam.length, positive);
  std::vector<Vector3> points;
  if (line == nullptr || !read_points(map, *line, points)) return;

  for (const Vector3& point : points) beam.reference_line.emplace_back(to_a * point);
  const double stated = beam.length;
  beam.length = model::compute_arc_length(beam.reference_line);
  if (!std::isfinite(beam.length)) {
    map.refuse(*line, "reference_line", "the points are too far apart");
  } else if (has_length && std::abs(stated - beam.length) > length_tolerance * beam.length) {
    const YamlNode& entry = *map.node().find("length");
    map.refuse(entry, "length",
               "the arc length of reference_line is " + std::to_string(beam.length) + ", " +
                   describe(entry) + "; leave length out");
  }
}

void read_point_masses(MapReader& map, std::vector<model::PointMassDefinition>& masses) {
  read_mass_list(map, masses, [](MapReader& entry, model::PointMassDefinition& lump) {
    entry.require("at");
    entry.read("at", lump.at, beyond_the_root);
  });
}

constexpr std::array<const char*, 6> directions{"u1", "u2", "u3", "theta1", "theta2", "theta3"};

/// Reads springs by direction; what is not given stays as it is.
void read_springs(const YamlNode& node, const std::string& where, model::SupportDefinition& support,
                  ErrorList& errors) {
  constexpr NumberRule rule{"a number > 0, rigid or free", positive.low, positive.high, true};
  MapReader map(node, where, errors);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const YamlNode* entry = map.find(directions[i]);
    if (entry == nullptr) continue;
    support.rigid[i] = is_rigid(*entry);
    support.free[i] = is_word(*entry, "free");
    const auto k = static_cast<Eigen::Index>(i);
    if (!support.rigid[i] && !support.free[i])
      read_number(*entry, map.where(directions[i]), rule, support.stiffness(k, k), errors);
  }
  map.finish();
}

void read_added_mass(MapReader& map, Vector6& mass) {
  const YamlNode* entry = map.find("added_mass");
  if (entry == nullptr) return;
  MapReader added(*entry, map.where("added_mass"), map.errors());
  for (std::size_t i = 0; i < directions.size(); ++i)
    added.read(directions[i], mass(static_cast<Eigen::Index>(i)), non_negative);
  added.finish();
}

}  // namespace

void read_support(MapReader& beam, std::string_view key, bool at_root,
                  model::SupportDefinition& support) {
  const YamlNode* node = beam.find(key);
  if (node == nullptr) return;
  ErrorList& errors = beam.errors();
  model::SupportDefinition hinge;
  for (std::size_t i = 3; i < 6; ++i) {
    hinge.rigid[i] = false;
    hinge.free[i] = true;
  }
  if (node->kind == YamlNode::Kind::scalar) {
    enum class Word { clamped, pinned, free };
    Word word = Word::clamped;
    const bool known =
        at_root ? beam.read(key, word, {{"clamped", Word::clamped}, {"pinned", Word::pinned}})
                : beam.read(
                      key, word,
                      {{"free", Word::free}, {"clamped", Word::clamped}, {"pinned", Word::pinned}});
    if (!known) return;
    support = word == Word::clamped  ? model::SupportDefinition()
              : word == Word::pinned ? hinge
                                     : model::free_end();
    return;
  }
  MapReader map(*node, beam.where(key), errors);
  const YamlNode* springs = map.find("stiffness");
  const YamlNode* matrix = map.find("stiffness_matrix");
  if (springs != nullptr && matrix != nullptr) {
    map.refuse(*matrix, "stiffness_matrix", "given together with stiffness; leave one of them out");
  } else if (springs != nullptr) {
    read_springs(*springs, map.where("stiffness"), support, errors);
  } else if (matrix != nullptr) {
    support.rigid = {};
    support.free = {};
    read_matrix(*matrix, map.where("stiffness_matrix"), support.stiffness, &support.rigid, errors);
  } else {
    map.require("stiffness", "or \"stiffness_matrix\"");
  }
  if (at_root) {
    map.read("mass", support.mass, non_negative);
    read_vector(map, "center", support.center, any_number);
    read_vector(map, "inertia", support.inertia, non_negative);
    read_added_mass(map, support.added_mass);
    if (const YamlNode* entry = map.find("damping"))
      read_one_or_six(map, *entry, "a number >= 0 or a list of 6", support.damping);
  }
  map.finish();
}

void read_beam(MapReader& map, const Matrix3& to_a, const RatioKeys& ratios,
               model::BeamDefinition& beam) {
  read_length(map, to_a, beam);
  map.read("elements", beam.elements, 1, max_elements);
  map.read("order", beam.order, 1, max_order);
  read_sections(map, beam.sections);
  read_damping(map, ratios, beam);
  read_mass_damping(map, beam);
  map.read("tip_mass", beam.tip_mass, non_negative);
  read_point_masses(map, beam.point_masses);
  read_support(map, "support", true, beam.support);
}

}  // namespace samara::io
