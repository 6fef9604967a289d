#include "htc_beam.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <Eigen/Geometry>

#include "samara/base/error.hpp"
#include "samara/math/rotation.hpp"
#include "samara/model/reference_line.hpp"

namespace samara::decks {
namespace {

/// A line that leaves its axis by less is straight [of the length].
constexpr double straight_tolerance = 1e-9;

/// Coordinates up to this size are round-off [of the length].
constexpr double no_distance = 1e-12;

/// Moduli from here on belong to bodies that are meant to be rigid [N/m^2].
constexpr double rigid_modulus = 1e14;

/// A table that ends earlier or later than the line is named [of the length].
constexpr double length_tolerance = 2e-3;

/// Products of inertia that are named [of the largest moment].
constexpr double product_tolerance = 1e-6;

/// Twists that differ by less are the same [rad].
constexpr double round_off_angle = 1e-12;

/// A mass nearer to the root of a beam moves here [of the length].
constexpr double least_place = 0.05;

/// Columns of a table of 19 columns.
constexpr std::size_t young_column = 8;
constexpr std::size_t shear_column = 9;

Matrix3 ground_matrix() { return Vector3(-1.0, 1.0, -1.0).asDiagonal(); }

/// Strains, in the order of a case, of a body whose moduli say that it is rigid.
std::array<bool, 6> find_rigid(const StTable& table) {
  if (table.full) return {};
  const auto all = [&](std::size_t column) {
    return std::ranges::all_of(table.rows,
                               [&](const auto& row) { return row[column] >= rigid_modulus; });
  };
  const bool bends = !all(young_column);
  const bool twists = !all(shear_column);
  return {!bends, !twists, !twists, !twists, !bends, !bends};
}

class BeamBuilder {
 public:
  BeamBuilder(HtcImport& import, const HtcBody& body, Matrix3 to_root, std::string key,
              model::BeamDefinition& beam)
      : import_(import),
        body_(body),
        key_(std::move(key)),
        beam_(beam),
        to_root_(std::move(to_root)) {}

  Curve build() {
    if (!set_line() || !find_twists()) return {{0.0, 1.0}, {0.0, 0.0}};
    add_sections();
    set_damping();
    add_masses();
    return twists_;
  }

 private:
  bool set_line() {
    std::vector<Vector3> line;
    for (const Vector3& point : body_.points)
      line.push_back(to_root_ * (point - body_.points.front()));
    const double size = body_.length();
    double across = 0.0;
    for (Vector3& point : line) {
      for (double& component : point)
        if (std::abs(component) <= no_distance * size) component = 0.0;
      across = std::max(across, std::hypot(point(1), point(2)));
    }
    if (across <= straight_tolerance * size) {
      beam_.length = line.back()(0);
      for (std::size_t i = 1; i < line.size(); ++i)
        if (!(line[i](0) > line[i - 1](0))) {
          import_.errors.add(body_.place, body_.label + ": the line turns back");
          return false;
        }
    } else {
      beam_.reference_line = line;
      beam_.length = model::compute_arc_length(line);
      if (!std::isfinite(beam_.length)) {
        import_.errors.add(body_.place, body_.label + ": the line has no length");
        return false;
      }
    }
    return true;
  }

  /// Places of the points and the twist of a case there.
  bool find_twists() {
    constexpr int most_steps = 60;
    constexpr double tolerance = 1e-13;
    try {
      const model::ReferenceLine line(key_, beam_);
      const std::vector<double> chords = body_.chords();
      for (std::size_t i = 0; i < body_.points.size(); ++i) {
        const Vector3 point = to_root_ * (body_.points[i] - body_.points.front());
        double at = chords[i] / chords.back();
        for (int step = 0; step < most_steps; ++step) {
          const model::ReferenceLine::Station there = line.at(at);
          const double along = there.C_ab.col(0).dot(Vector3(point - there.x)) / beam_.length;
          at = std::clamp(at + along, 0.0, 1.0);
          if (std::abs(along) <= tolerance) break;
        }
        if (i == 0) at = 0.0;
        if (i + 1 == body_.points.size()) at = 1.0;
        const model::ReferenceLine::Station there = line.at(at);
        const Vector3 tangent = to_root_.transpose() * there.C_ab.col(0);
        if (std::abs(tangent(2)) < 1e-3) {
          import_.errors.add(body_.place, body_.label + ": the line runs across z of the body, " +
                                              rounded(at * beam_.length) + " m along it");
          return false;
        }
        const Vector3 chord =
            there.C_ab.transpose() * to_root_ * section_axes(tangent, body_.twists[i]).col(1);
        double twist = std::atan2(-chord(2), chord(1));
        if (!twists_.values.empty())
          twist += 2.0 * std::numbers::pi *
                   std::round((twists_.values.back() - twist) / (2.0 * std::numbers::pi));
        twists_.grid.push_back(std::max(at, twists_.grid.empty() ? 0.0 : twists_.grid.back()));
        twists_.values.push_back(twist);
      }
    } catch (const InputError& error) {
      import_.errors.add(body_.place, body_.label + ": " + error.what());
      return false;
    }
    places_ = twists_.grid;
    // A tower runs against z of its body: its sections are turned by 180 degrees.
    half_turns_ = std::lround(twists_.values.front() / std::numbers::pi);
    for (double& twist : twists_.values) {
      twist -= std::numbers::pi * static_cast<double>(half_turns_);
      if (std::abs(twist) <= round_off_angle) twist = 0.0;
    }
    const auto [least, most] = std::ranges::minmax(twists_.values);
    if (most - least <= round_off_angle) twists_ = {{0.0, 1.0}, {least, least}};
    return true;
  }

  void add_sections() {
    const double length = beam_.length;
    std::vector<double> grid;
    for (const auto& row : body_.table.rows)
      if (row[0] <= length * (1.0 + straight_tolerance))
        grid.push_back(std::min(row[0] / length, 1.0));
    const double last = body_.table.rows.back()[0];
    if (std::abs(last - length) > length_tolerance * length)
      import_.warn(body_.table.place(body_.table.rows.size() - 1),
                   "note: the table of " + body_.label + " ends at " + rounded(last) +
                       " m, its line at " + rounded(length) + " m" +
                       (last < length ? ": the last row holds to the end" : ""));
    const std::array<bool, 6> rigid = find_rigid(body_.table);
    for (const Station& station : merge_grids({&grid, &twists_.grid})) {
      model::SectionDefinition section;
      section.at = std::min(place_of(station), 1.0);
      const StSection own =
          interpolate_st(body_.table, table_place(station.place * length), station.behind);
      section.stiffness = own.stiffness;
      section.mass = own.mass;
      if (half_turns_ % 2 != 0) {
        turn_half(section.stiffness);
        turn_half(section.mass);
      }
      section.rigid = rigid;
      for (Eigen::Index i = 0; i < 6; ++i)
        if (rigid[static_cast<std::size_t>(i)]) {
          section.stiffness.row(i).setZero();
          section.stiffness.col(i).setZero();
        }
      for (Matrix6* matrix : {&section.stiffness, &section.mass}) {
        symmetrize(*matrix);
        drop_round_off(*matrix);
      }
      section.twist = interpolate(twists_, station);
      beam_.sections.push_back(section);
    }
    check_sections(beam_, key_, {body_.table.place(0)}, import_.errors);
    if (std::ranges::find(rigid, true) != rigid.end())
      import_.warn(body_.table.place(0), "note: " + body_.label + ": moduli of " +
                                             rounded(rigid_modulus) + " N/m^2 and more: " +
                                             (rigid[0] && rigid[3] ? "all strains are"
                                              : rigid[0]           ? "extension and bending are"
                                                                   : "shear and torsion are") +
                                             " rigid");
  }

  /// The place of a row that is the same but for round-off.
  double table_place(double r) const {
    for (const auto& row : body_.table.rows)
      if (std::abs(row[0] - r) <= straight_tolerance * beam_.length) return row[0];
    return r;
  }

  void set_damping() {
    const std::string key = key_ + ".damping";
    if (body_.damping_place.empty()) {
      import_.warn(body_.place, "note: " + body_.label + " has no damping");
      import_.note(key, "not in the deck");
      return;
    }
    const auto& k = body_.damping;
    // Strains that offsets of the centres couple have about the same mu: extension that of bending,
    // shear that of torsion. Otherwise stiffness times mu would feed energy to fast modes, which
    // HAWC2's damping, a sum of positive parts, does not.
    beam_.damping << 0.5 * (k[3] + k[4]), k[5], k[5], k[5], k[3], k[4];
    import_.note(key, "extension: mean of bending; shear: Kz; torsion: Kz; bending: Kx and Ky");
    if (k[0] != 0.0 || k[1] != 0.0 || k[2] != 0.0)
      import_.warn(
          body_.damping_place,
          "note: " + body_.label + ": the factors of the mass (the first three) are left out");
  }

  /// Masses of all nodes but the first, which stands on the root.
  void add_masses() {
    std::map<int, RigidBody> nodes;
    for (const HtcMass& mass : body_.masses) {
      if (mass.node == 1 && body_.share(1) == 0.0) continue;
      nodes[mass.node].add(mass.mass, mass.offset, mass.inertia);
    }
    const model::ReferenceLine line(key_, beam_);
    for (const auto& [node, sum] : nodes) {
      const double at =
          body_.uniform_nodes > 0 ? body_.share(node) : places_[static_cast<std::size_t>(node) - 1];
      if (sum.mass() == 0.0) {
        import_.warn(body_.place, "note: " + body_.label + ": inertia without mass at node " +
                                      std::to_string(node) + " is left out");
        continue;
      }
      const Matrix3 turn =
          line.at(at, interpolate(twists_, {at, false})).C_ab.transpose() * to_root_;
      model::PointMassDefinition point;
      point.at = at;
      point.mass = sum.mass();
      point.center = turn * sum.center();
      const Matrix3 inertia = turn * sum.inertia() * turn.transpose();
      point.inertia = inertia.diagonal();
      for (double& component : point.center)
        if (std::abs(component) <= no_distance * beam_.length) component = 0.0;
      if (largest_product(inertia) > product_tolerance * inertia.diagonal().maxCoeff())
        import_.warn(body_.place, "note: " + body_.label + ": products of inertia at node " +
                                      std::to_string(node) + ", up to " +
                                      rounded(largest_product(inertia)) +
                                      " kg m^2, are left out: a case has none");
      if (at == 1.0 && point.center.isZero(0.0) && point.inertia.isZero(0.0))
        beam_.tip_mass += point.mass;
      else
        beam_.point_masses.push_back(point);
    }
    if (beam_.tip_mass > 0.0)
      import_.note(key_ + ".tip_mass", "concentrated_mass at the last node");
    if (!beam_.point_masses.empty()) import_.note(key_ + ".point_masses", "concentrated_mass");
  }

  HtcImport& import_;
  const HtcBody& body_;
  std::string key_;
  model::BeamDefinition& beam_;
  Matrix3 to_root_;             ///< components in axes of the body to those in b1 b2 b3 of the root
  Curve twists_;                ///< over the share of the length [rad]
  std::vector<double> places_;  ///< of the points, as shares of the length
  long half_turns_ = 0;
};

/// Whether each mass has an end of an element, with a quarter of an element between two ends.
bool has_room(const std::vector<model::PointMassDefinition>& masses, int elements) {
  constexpr double least = 0.26;
  std::vector<double> ends;
  for (int e = 0; e <= elements; ++e) ends.push_back(static_cast<double>(e) / elements);
  int last = 0;
  for (const model::PointMassDefinition& mass : masses) {
    if (mass.at == 1.0) continue;
    const int nearest = std::min(static_cast<int>(std::lround(mass.at * elements)), elements - 1);
    last = std::max(nearest, last + 1);
    if (last >= elements) return false;
    ends[static_cast<std::size_t>(last)] = mass.at;
  }
  return std::ranges::adjacent_find(
             ends, [&](double a, double b) { return b - a < least / elements; }) == ends.end();
}

/// Puts the two masses that are nearest to each other at the place of the first of them, or at
/// the end of the beam. A single mass moves away from the root.
void merge_nearest(HtcImport& import, std::vector<model::PointMassDefinition>& masses) {
  std::size_t nearest = 0;
  for (std::size_t i = 0; i + 1 < masses.size(); ++i)
    if (masses[i + 1].at - masses[i].at < masses[nearest + 1].at - masses[nearest].at) nearest = i;
  if (masses.size() < 2) {
    import.warn(import.deck.path(), "note: a mass at " + rounded(masses[0].at) +
                                        " of the length of a beam is at " + rounded(least_place) +
                                        " in the case");
    masses[0].at = least_place;
    return;
  }
  model::PointMassDefinition& first = masses[nearest];
  const model::PointMassDefinition second = masses[nearest + 1];
  RigidBody sum;
  sum.add(first.mass, first.center, first.inertia.asDiagonal());
  sum.add(second.mass, second.center, second.inertia.asDiagonal());
  import.warn(import.deck.path(), "note: two masses on a beam, at " + rounded(first.at) + " and " +
                                      rounded(second.at) +
                                      " of its length, are one in the case, at the " +
                                      (second.at == 1.0 ? "second" : "first"));
  if (second.at == 1.0) first.at = 1.0;
  first.mass = sum.mass();
  first.center = sum.center();
  first.inertia = sum.inertia().diagonal();
  masses.erase(masses.begin() + static_cast<std::ptrdiff_t>(nearest) + 1);
}

}  // namespace

Matrix3 to_ground_axes(const Matrix3& columns) { return ground_matrix() * columns; }

Matrix3 section_axes(const Vector3& tangent, double twist) {
  const double c = std::cos(twist);
  const double s = std::sin(twist);
  const Vector3 chord = Vector3(c, s, -(tangent(0) * c + tangent(1) * s) / tangent(2)).normalized();
  Matrix3 axes;
  axes << tangent, chord, tangent.cross(chord);
  return axes;
}

Curve build_beam(HtcImport& import, const HtcBody& body, const Matrix3& to_root,
                 const std::string& key, model::BeamDefinition& beam) {
  return BeamBuilder(import, body, to_root, key, beam).build();
}

void set_htc_mesh(HtcImport& import, model::BeamDefinition& beam, const Mesh& mesh) {
  constexpr int most_elements = 40;
  set_mesh(beam, mesh);
  std::ranges::sort(beam.point_masses, {}, &model::PointMassDefinition::at);
  for (;;) {
    for (beam.elements = mesh.elements; beam.elements <= most_elements; ++beam.elements)
      if (has_room(beam.point_masses, beam.elements)) return;
    merge_nearest(import, beam.point_masses);
  }
}

RigidBeam integrate_body(const HtcBody& body) {
  // Gauss points of three: exact for mass linear and places quadratic in between.
  const double g = std::sqrt(0.6);
  const std::array<std::pair<double, double>, 3> rule{
      {{-g, 5.0 / 9.0}, {0.0, 8.0 / 9.0}, {g, 5.0 / 9.0}}};
  RigidBeam sum;
  const std::vector<double> chords = body.chords();
  double about_b2 = 0.0;
  double about_b3 = 0.0;
  for (std::size_t i = 1; i < body.points.size(); ++i) {
    const double span = chords[i] - chords[i - 1];
    const Vector3 tangent = (body.points[i] - body.points[i - 1]) / span;
    std::vector<double> ends{chords[i - 1]};
    for (const auto& row : body.table.rows)
      if (row[0] > ends.back() && row[0] < chords[i]) ends.push_back(row[0]);
    ends.push_back(chords[i]);
    for (std::size_t k = 1; k < ends.size(); ++k)
      for (const auto& [place, weight] : rule) {
        const double r = 0.5 * (ends[k - 1] + ends[k]) + 0.5 * place * (ends[k] - ends[k - 1]);
        const double w = 0.5 * weight * (ends[k] - ends[k - 1]);
        const double part = (r - chords[i - 1]) / span;
        const StSection section = interpolate_st(body.table, r);
        const double twist = body.twists[i - 1] + part * (body.twists[i] - body.twists[i - 1]);
        Matrix3 axes = Matrix3::Identity();
        if (std::abs(tangent(2)) > 1e-3) axes = section_axes(tangent, twist);
        const Matrix3 turn = to_ground_axes(Matrix3(body.axes * axes));
        const double m = section.mass(0, 0);
        const Vector3 center = m > 0.0
                                   ? Vector3(0.0, -section.mass(5, 0) / m, section.mass(4, 0) / m)
                                   : Vector3::Zero().eval();
        const Vector3 point = body.points[i - 1] + part * (body.points[i] - body.points[i - 1]);
        const Matrix3 arm = math::skew<double>(center);
        const Matrix3 inertia = section.mass.bottomRightCorner<3, 3>() + m * arm * arm;
        sum.body.add(w * m, to_ground_axes(body.global(point)) + turn * center,
                     w * turn * inertia * turn.transpose());
        if (section.stiffness(3, 3) > 0.0) sum.twisting += w / section.stiffness(3, 3);
        if (section.stiffness(4, 4) > 0.0) about_b2 += w / section.stiffness(4, 4);
        if (section.stiffness(5, 5) > 0.0) about_b3 += w / section.stiffness(5, 5);
      }
  }
  sum.bending = std::max(about_b2, about_b3);
  return sum;
}

void add_mass(const HtcBody& body, const HtcMass& mass, RigidBody& sum) {
  const Matrix3 turn = to_ground_axes(body.axes);
  sum.add(mass.mass, to_ground_axes(Vector3(body.global(body.node(mass.node) + mass.offset))),
          turn * mass.inertia * turn.transpose());
}

}  // namespace samara::decks
