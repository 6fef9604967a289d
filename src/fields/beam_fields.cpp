#include "beam_fields.hpp"

namespace samara::fields {
namespace {

constexpr std::array<const char*, 6> directions{"u1", "u2", "u3", "theta1", "theta2", "theta3"};

constexpr int most_elements = 100000;
constexpr int most_order = 6;  ///< Gauss points an element

/// Values of a diagonal section mass.
struct SectionMass {
  double mass = 0.0;
  Vector3 inertia = Vector3::Zero();
  std::array<double, 2> center{};
};

/// I6 of a section with its mass centre at c = (0, c2, c3) and its inertia about the reference
/// line: P = m (V + Omega x c), H = I Omega + m c x V, (3).
Matrix6 build_section_mass(const SectionMass& parts) {
  const double c2 = parts.center[0];
  const double c3 = parts.center[1];
  Matrix3 skew_c;
  skew_c << 0.0, -c3, c2, c3, 0.0, 0.0, -c2, 0.0, 0.0;
  Matrix6 matrix = Matrix6::Zero();
  matrix.topLeftCorner<3, 3>() = parts.mass * Matrix3::Identity();
  matrix.topRightCorner<3, 3>() = -parts.mass * skew_c;
  matrix.bottomLeftCorner<3, 3>() = parts.mass * skew_c;
  matrix.bottomRightCorner<3, 3>() = parts.inertia.asDiagonal();
  return matrix;
}

SectionMass split_section_mass(const Matrix6& matrix) {
  SectionMass parts;
  parts.mass = matrix(0, 0);
  parts.inertia = matrix.diagonal().tail<3>();
  if (parts.mass != 0.0) parts.center = {matrix(5, 0) / -parts.mass, matrix(3, 1) / -parts.mass};
  return parts;
}

void declare_section_mass(Visitor& fields, model::SectionDefinition& section) {
  SectionMass parts = split_section_mass(section.mass);
  const bool is_compulsory = !fields.given("mass_matrix");
  const bool has_parts = build_section_mass(parts) == section.mass;
  constexpr const char* hint = "per length, or \"mass_matrix\"";
  fields.exclusive({{"mass_matrix"}, {"mass", "inertia", "mass_center"}});
  if (has_parts || fields.wants_all()) {
    fields.number(Field("mass", "kg/m", positive, "required without `mass_matrix`")
                      .required(hint, is_compulsory),
                  parts.mass);
    fields.numbers(Field("inertia", "kg m", non_negative,
                         "`[I1, I2, I3]` per unit length about b1, b2, b3 **through the reference "
                         "line**; required without `mass_matrix`. For a thin section I1 = I2 + I3")
                       .required(hint, is_compulsory),
                   std::span<double>(parts.inertia.data(), 3), false);
    fields.numbers({"mass_center", "m",
                    "`[b2, b3]`, offset of the mass centre. The product of inertia about b2 and b3 "
                    "is taken as 0: where it is not, use `mass_matrix`"},
                   parts.center, false);
  }
  if (fields.reads()) section.mass = build_section_mass(parts);
  if (has_parts && !fields.wants_all()) return;
  fields.matrix(
      {"mass_matrix", "kg/m, kg, kg m",
       "instead of `mass`, `inertia`, `mass_center`: momenta from velocities, order V1 V2 "
       "V3 Omega1 Omega2 Omega3"},
      section.mass, nullptr);
}

void declare_section(Visitor& fields, bool is_single, model::SectionDefinition& section) {
  constexpr std::array<const char*, 6> names{"EA", "GA2", "GA3", "GJ", "EI2", "EI3"};
  constexpr std::array<const char*, 6> units{"N", "N", "N", "N m^2", "N m^2", "N m^2"};
  fields.number(Field("at", "", fraction_of_one,
                      "place as a fraction of the length, rising from section to section; required "
                      "where there are several")
                    .required("the fraction of the length, from 0 to 1", !is_single),
                section.at);
  declare_section_mass(fields, section);
  fields.exclusive({{"stiffness"}, {"stiffness_matrix"}});
  const Matrix6 uncoupled = section.stiffness.diagonal().asDiagonal();
  const Presence one_by_one{[&] { return section.stiffness == uncoupled; }, [] {}};
  fields.block({"stiffness", "N, N m^2", "of the strains, one by one"}, one_by_one, [&] {
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      fields.number(Field(names[i], units[i], positive, "").required("a number > 0 or rigid"),
                    section.stiffness(k, k), {{"rigid", &section.rigid[i]}});
    }
  });
  if (fields.wants_all() || !one_by_one.is_there())
    fields.matrix({"stiffness_matrix", "N, N m, N m^2",
                   "instead of `stiffness`: order axial, shear 2, shear 3, torsion, bending 2, "
                   "bending 3. Symmetric and positive definite; `rigid` may stand on the diagonal, "
                   "the rest of that row and column is then 0"},
                  section.stiffness, &section.rigid);
  fields.at_least_one({"stiffness", "stiffness_matrix"}, "or \"stiffness_matrix\"");
  fields.number({"twist_deg", deg, "turns the axes b2, b3 of the section, > 0 toward feather"},
                section.twist);
}

void declare_springs(Visitor& fields, bool at_root, model::SupportDefinition& support) {
  fields.exclusive({{"stiffness"}, {"stiffness_matrix"}});
  if (fields.given("stiffness_matrix")) support.rigid = support.free = {};
  const Matrix6 uncoupled = support.stiffness.diagonal().asDiagonal();
  const Presence one_by_one{[&] { return support.stiffness == uncoupled; }, [] {}};
  fields.block({"stiffness", "N/m, N m/rad",
                at_root ? "along and about b1 b2 b3 of the root (of a tower up, side-side, "
                          "downwind); a direction that is left out is rigid. Rotations are "
                          "Rodrigues parameters"
                        : "along and about b1 b2 b3 of the root; a direction that is left out is "
                          "free. Rotations are Rodrigues parameters"},
               one_by_one, [&] {
                 for (std::size_t i = 0; i < directions.size(); ++i) {
                   const auto k = static_cast<Eigen::Index>(i);
                   fields.number(Field(directions[i], i < 3 ? "N/m" : "N m/rad", positive, "")
                                     .or_else(at_root ? "`rigid`" : "`free`"),
                                 support.stiffness(k, k),
                                 {{"rigid", &support.rigid[i]}, {"free", &support.free[i]}});
                 }
               });
  if (fields.wants_all() || !one_by_one.is_there())
    fields.matrix(
        {"stiffness_matrix", "N/m, N, N m",
         "in this order, instead of `stiffness`. Symmetric and positive definite; `rigid` "
         "may stand on the diagonal, the rest of that row and column is then 0"},
        support.stiffness, &support.rigid);
  fields.at_least_one({"stiffness", "stiffness_matrix"}, "or \"stiffness_matrix\"");
  if (!at_root) return;
  fields.number({"mass", "kg", non_negative,
                 "of a rigid body between springs and beam. `modes`, `trim` and `floquet` need one "
                 "where the root may move: a direction without inertia has no motion of its own"},
                support.mass);
  fields.vector({"center", "m", "of that mass, from the root, in root axes"}, support.center);
  fields.vector({"inertia", "kg m^2", non_negative,
                 "about its own centre, root axes; > 0 where the root may turn"},
                support.inertia);
  fields.block(Field("added_mass", "kg, kg m^2",
                     "inertia without weight along and about the axes of that body, of the water "
                     "around a foundation")
                   .or_else("none"),
               [&] {
                 for (std::size_t i = 0; i < directions.size(); ++i)
                   fields.number({directions[i], i < 3 ? "kg" : "kg m^2", non_negative, ""},
                                 support.added_mass(static_cast<Eigen::Index>(i)));
               });
  fields.numbers({"damping", "s", non_negative,
                  "one value or six (of u1 to theta3): load of the springs = stiffness x (motion + "
                  "damping x rate)"},
                 std::span<double>(support.damping.data(), 6), true);
}

void declare_support(Visitor& fields, bool at_root, model::SupportDefinition& support) {
  enum class Holding { clamped, pinned, free, springs };
  model::SupportDefinition pin;
  for (std::size_t i = 3; i < 6; ++i) {
    pin.rigid[i] = false;
    pin.free[i] = true;
  }
  Holding holding = support == model::SupportDefinition() ? Holding::clamped
                    : support == pin                      ? Holding::pinned
                    : support == model::free_end()        ? Holding::free
                                                          : Holding::springs;
  const Field field =
      at_root
          ? Field("support", "",
                  "holds the root: the word `clamped`, the word `pinned` (turns freely, does "
                  "not move), or [keys](#supports). The root of a tower stands on the ground, "
                  "that of a blade on the hub")
                .or_else("`clamped`")
          : Field("end_support", "", "holds the end, in the axes of the root").or_else("`free`");
  fields.two_ways(
      field, "springs",
      [&] {
        const bool known =
            at_root ? fields.choice(field, holding,
                                    {{"clamped", Holding::clamped}, {"pinned", Holding::pinned}})
                    : fields.choice(field, holding,
                                    {{"free", Holding::free},
                                     {"clamped", Holding::clamped},
                                     {"pinned", Holding::pinned}});
        if (!fields.reads() || !known) return;
        support = holding == Holding::clamped  ? model::SupportDefinition()
                  : holding == Holding::pinned ? pin
                                               : model::free_end();
      },
      [&] {
        fields.block(field, Presence{[&] { return holding == Holding::springs; }, [] {}},
                     [&] { declare_springs(fields, at_root, support); });
      });
}

void declare_damping(Visitor& fields, BeamPlace place, model::BeamDefinition& beam) {
  using Ratios = std::array<const char*, 3>;
  constexpr Ratios of_blade{"flap", "lead_lag", "torsion"};
  constexpr Ratios of_tower{"fore_aft", "side_side", "torsion"};
  constexpr Ratios texts{"damping ratio of the first mode that bends about b2",
                         "of the first mode that bends about b3", "of the first mode that twists"};
  const Ratios& words = place == BeamPlace::blade ? of_blade : of_tower;
  const Field field("damping", "s", non_negative,
                    "one value or six (axial, shear 2, shear 3, torsion, bending 2, bending 3): "
                    "section force = stiffness x (strain + mu x strain rate). With one value a "
                    "mode of frequency omega gets the damping ratio mu omega/2. It acts on elastic "
                    "strains only. Or a mapping of [damping ratios](#damping-ratios)");
  const auto has_ratios = [&beam] {
    for (const std::optional<double>& ratio : beam.modal_damping)
      if (ratio) return true;
    return false;
  };
  fields.two_ways(
      field, "damping ratios",
      [&] {
        if (fields.wants_all() || !has_ratios())
          fields.numbers(field, std::span<double>(beam.damping.data(), 6), true);
      },
      [&] {
        fields.block(field, Presence{has_ratios, [] {}}, [&] {
          for (std::size_t i = 0; i < words.size(); ++i)
            fields.number(Field(words[i], "", fraction_of_one, texts[i]).or_else("0"),
                          beam.modal_damping[i]);
          if (place == BeamPlace::tower)
            fields.retired("lateral", "is named side_side; hint: side_side, with the same number");
        });
      });
  fields.numbers({"mass_damping", "1/s", non_negative,
                  "one value alpha or three (along b1, b2, b3 of the sections): the force -alpha x "
                  "mass x velocity of a section against the rigid frame of the beam's own root, "
                  "which has the reaction. A mode of frequency omega gets the damping ratio "
                  "alpha/(2 omega) beside that of `damping`, so the two together meet the ratios "
                  "of two modes. Not beside damping ratios"},
                 std::span<double>(beam.mass_damping.data(), 3), true);
}

}  // namespace

void declare_beam(Visitor& fields, BeamPlace place, model::BeamDefinition& beam) {
  // A tower is stated in n1 n2 n3, the beam's axes are a = (n3, n1, n2).
  Matrix3 to_a = Matrix3::Identity();
  if (place == BeamPlace::tower) to_a << 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
  const Field length =
      Field("length", "m", positive,
            "along the beam. Required without `reference_line`, and not needed beside it")
          .or_else("");
  if (fields.wants_all() || beam.reference_line.empty()) fields.number(length, beam.length);
  fields.points(Field("reference_line", "m",
                      "at least two points `[x, y, z]`, the first `[0, 0, 0]`. The beam follows "
                      "the natural cubic spline through them, its parameter the chord length, and "
                      "its length is that of the spline (a `length` given too must agree to 0.1 "
                      "%). See [curved beams](#curved-beams)")
                    .or_else("straight along b1"),
                to_a, beam.reference_line);
  fields.at_least_one({"length", "reference_line"}, "or \"reference_line\"");
  fields.integer({"elements", "", integers(1, most_elements), "number of elements"}, beam.elements);
  fields.number_list(
      Field("element_lengths", "", positive,
            "`[1, 1, 0.5]`, lengths of the elements by each other from the root on. With another "
            "number of `elements` the ends divide them in the same way: twice as many halve each")
          .or_else("equal"),
      "lengths", beam.element_lengths);
  fields.integer({"order", "", integers(1, most_order),
                  "Gauss points an element. Frequencies converge as (element length)^(2 order)"},
                 beam.order);
  fields.list(Field("sections", "list of [sections](#sections); one entry is a uniform beam")
                  .required("a list; one entry is a uniform beam"),
              "sections", 1, beam.sections, [&](model::SectionDefinition& section) {
                declare_section(fields, beam.sections.size() < 2, section);
              });
  declare_damping(fields, place, beam);
  fields.number({"tip_mass", "kg", non_negative, "a point mass at the end"}, beam.tip_mass);
  fields.list(Field("point_masses", "list of [point masses](#point-masses) anywhere on the beam"),
              "point masses", 0, beam.point_masses, [&](model::PointMassDefinition& lump) {
                fields.number(Field("at", "", beyond_the_root,
                                    "place as a fraction of the length. The end of an element is "
                                    "moved there, so that it is met exactly; two masses must be at "
                                    "least a quarter of an element apart")
                                  .required(),
                              lump.at);
                declare_lump(fields, lump, "of the mass, from the line, in the section's b1 b2 b3",
                             "about its own centre, section axes");
              });
  declare_support(fields, true, beam.support);
  if (place == BeamPlace::blade) declare_support(fields, false, beam.end_support);
}

}  // namespace samara::fields
