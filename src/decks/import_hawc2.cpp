#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <set>

#include <Eigen/Geometry>

#include "samara/base/error.hpp"
#include "samara/base/words.hpp"
#include "samara/fields/field.hpp"

#include "htc_air.hpp"
#include "htc_beam.hpp"
#include "htc_report.hpp"
#include "htc_structure.hpp"
#include "import_common.hpp"

namespace samara::decks {
namespace {

constexpr double degrees = 180.0 / std::numbers::pi;

/// Distances of parts that should meet [m].
constexpr double same_place = 1e-3;

/// Angles of blades that should be the same [rad].
constexpr double same_angle = 1e-4;

/// Distances up to this size are round-off [of the height].
constexpr double round_off = 1e-12;

/// Torsional stiffness of a shaft from which on it is rigid [N m/rad].
constexpr double rigid_torsion = 1e14;

/// Bodies that are rigid in the case may bend by this part of the tower.
constexpr double small_bending = 1e-3;

/// Products of inertia that are named [of the largest moment].
constexpr double product_tolerance = 1e-3;

/// Cosine between the line of a body and the axis of the rotor, above which it is a part of the
/// shaft.
constexpr double along_the_shaft = 0.999;

/// A number without the round-off of the turns that led to it: to nine decimals where it is that
/// near to them.
double clean(double value) {
  constexpr double decimals = 1e9;
  constexpr double near = 1e-3;
  const double scaled = value * decimals;
  const double whole = std::round(scaled);
  return std::abs(scaled - whole) <= near ? (whole == 0.0 ? 0.0 : whole / decimals) : value;
}

Vector3 clean(Vector3 vector) {
  for (double& component : vector) component = clean(component);
  return vector;
}

/// The same of an angle [rad], in degrees.
double clean_angle(double angle) { return fields::deg.to_si(clean(angle * degrees)); }

class Importer {
 public:
  Importer(const std::string& path, const ImportOptions& options) : import_(path, options) {}

  Import run() {
    if (import_.errors.empty() && import_.deck.root().find_block("new_htc_structure") == nullptr)
      throw InputError(
          import_.deck.path() +
          ": missing block \"begin new_htc_structure\": not a main file of HAWC2; hint: "
          "files in which it continues are no decks of their own");
    structure_ = read_htc_structure(import_);
    rotor_ = read_htc_rotor(import_);
    import_.errors.throw_if_any();
    sort_bodies();
    import_.errors.throw_if_any();
    read_axes();
    import_.errors.throw_if_any();
    read_tower();
    read_nacelle();
    read_rotor();
    read_blades();
    import_.errors.throw_if_any();
    read_air();
    import_.errors.throw_if_any();
    report_constraints();
    report_files(import_);
    report_rest(import_);
    return finish();
  }

 private:
  model::TurbineDefinition& turbine() { return import_.turbine; }

  const HtcBody& body(const std::string& name) const { return *structure_.find(name); }

  // ---- which body is which part

  enum class Part { support, tower, nacelle, rotor, blade, left_out };

  /// Bodies from the ground to one of them.
  std::vector<std::string> chain_to(const std::string& name) const {
    std::vector<std::string> chain;
    for (std::string next = name; !next.empty(); next = body(next).parent) chain.push_back(next);
    std::ranges::reverse(chain);
    return chain;
  }

  void sort_bodies() {
    for (const std::string& blade : rotor_.blades)
      if (structure_.find(blade) == nullptr)
        import_.errors.add(rotor_.block->place,
                           "begin aero: there is no body \"" + blade + "\" for a blade");
    if (structure_.find(rotor_.hub_body) == nullptr)
      import_.errors.add(rotor_.place, "hub_vec: there is no body \"" + rotor_.hub_body + "\"");
    if (!import_.errors.empty()) return;
    for (const std::string& blade : rotor_.blades) chains_.push_back(chain_to(blade));
    const std::vector<std::string>& chain = chains_.front();
    first_of_rotor_ = find_rotor_root(chain);
    if (first_of_rotor_.empty()) return;
    const auto root = std::ranges::find(chain, first_of_rotor_);
    if (root == chain.begin() || root + 1 == chain.end()) {
      import_.errors.add(rotor_.place, "the rotor needs a body below it and a hub below the blade");
      return;
    }
    tower_ = find_tower({chain.begin(), root});
    for (const std::vector<std::string>& other : chains_)
      if (std::ranges::find(other, first_of_rotor_) == other.end() ||
          std::ranges::find(other, tower_) == other.end()) {
        import_.errors.add(body(other.back()).place_of_orientation,
                           "the blade \"" + other.back() + "\" does not stand on the same shaft");
        return;
      }
    for (const HtcBody& one : structure_.bodies) parts_[one.name] = part_of(one.name);
    refuse_support(chain);
  }

  /// The first body that turns: behind a free or driven bearing, else the one of hub_vec.
  std::string find_rotor_root(const std::vector<std::string>& chain) {
    for (const HtcConstraint& constraint : structure_.constraints) {
      const bool is_bearing = constraint.kind == "bearing1" || constraint.kind == "bearing3";
      const auto found = std::ranges::find(chain, constraint.second);
      if (!is_bearing || found == chain.end() || found + 1 == chain.end()) continue;
      if (std::ranges::find(found, chain.end(), rotor_.hub_body) == chain.end() &&
          constraint.second != rotor_.hub_body)
        continue;
      // The axis of a yaw bearing is upright.
      const Vector3 axis = bearing_axis(constraint);
      if (std::abs(axis(2)) > 0.9) continue;
      return constraint.second;
    }
    if (std::ranges::find(chain, rotor_.hub_body) != chain.end()) {
      import_.warn(rotor_.place, "note: no free bearing on the shaft: the rotor turns with " +
                                     rotor_.hub_body + ", the body of hub_vec");
      return rotor_.hub_body;
    }
    import_.errors.add(rotor_.place, "hub_vec: the body \"" + rotor_.hub_body +
                                         "\" is not between the ground and the blades");
    return {};
  }

  /// In n1 n2 n3; zero where it is not stated.
  Vector3 bearing_axis(const HtcConstraint& constraint) {
    const HtcCommand* command = constraint.block->find("bearing_vector");
    if (command == nullptr) return Vector3::Zero();
    const auto frame = import_.integer(*command, 0, 0, 2);
    const auto values = import_.numbers(*command, 1, 3);
    if (!frame || !values) return Vector3::Zero();
    Vector3 axis((*values)[0], (*values)[1], (*values)[2]);
    const std::string& name = *frame == 1 ? constraint.first : constraint.second;
    const HtcBody* owner = structure_.find(name);
    if (*frame != 0 && owner != nullptr) axis = owner->axes * axis;
    if (!(axis.norm() > 0.0)) return Vector3::Zero();
    return to_ground_axes(Vector3(axis.normalized()));
  }

  /// The body named tower, that of the tower shadow, or the longest.
  std::string find_tower(const std::vector<std::string>& chain) const {
    if (std::ranges::find(chain, "tower") != chain.end()) return "tower";
    if (const HtcBlock* wind = import_.deck.root().find_block("wind"))
      for (const HtcBlock& block : wind->blocks)
        if (const HtcCommand* link = block.find("tower_mbdy_link");
            link != nullptr && !link->words.empty() &&
            std::ranges::find(chain, to_lower(link->words[0])) != chain.end())
          return to_lower(link->words[0]);
    return *std::ranges::max_element(chain, {},
                                     [&](const std::string& name) { return body(name).length(); });
  }

  Part part_of(const std::string& name) const {
    const std::vector<std::string> chain = chain_to(name);
    for (const std::string& blade : rotor_.blades) {
      if (name == blade) return Part::blade;
      if (std::ranges::find(chain, blade) != chain.end()) return Part::left_out;
    }
    if (std::ranges::find(chain, first_of_rotor_) != chain.end()) return Part::rotor;
    if (name == tower_) return Part::tower;
    const auto tower = std::ranges::find(chain, tower_);
    if (tower == chain.end()) {
      const std::vector<std::string>& main = chains_.front();
      return std::ranges::find(main, name) != main.end() ? Part::support : Part::left_out;
    }
    // On the top of the tower, or elsewhere on it.
    const HtcBody& top = body(tower_);
    const HtcBody& next = body(*(tower + 1));
    const Vector3 foot =
        next.global(next.starts_at_origin ? Vector3::Zero().eval() : next.points.front());
    return (foot - top.global(top.points.back())).norm() <= same_place ? Part::nacelle
                                                                       : Part::left_out;
  }

  void refuse_support(const std::vector<std::string>& chain) {
    std::string below;
    for (const std::string& name : chain)
      if (parts_[name] == Part::support) below += (below.empty() ? "" : ", ") + name;
    if (!below.empty()) {
      const std::string place = body(chain.front()).place;
      if (import_.options.tower_only)
        import_.warn(place, "note: " + below + ": left out, the tower is clamped at its foot; " +
                                "tower.support of the case can state a foundation");
      else
        import_.errors.add(place, below +
                                      ": bodies below the tower cannot be imported; hint: "
                                      "--tower-only leaves them out and clamps the tower at its "
                                      "foot");
    }
    for (const auto& [name, part] : parts_)
      if (part == Part::left_out)
        import_.warn(body(name).place, "note: the body " + name +
                                           " is left out: it is no part of tower, nacelle, hub or "
                                           "blade");
    const bool is_clamped = std::ranges::any_of(structure_.constraints, [&](const auto& one) {
      return one.kind == "fix0" && one.second == chain.front();
    });
    if (!is_clamped && below.empty())
      import_.warn(body(tower_).place,
                   "note: no fix0 holds " + body(tower_).label + ": the case clamps its foot");
  }

  // ---- axes of nacelle, shaft and blades

  struct Blade {
    Vector3 root = Vector3::Zero();  ///< in n1 n2 n3 from the tower top
    Vector3 along = Vector3::Zero();
    double precone = 0.0;
    double azimuth = 0.0;
    double pitch = 0.0;
    double radius = 0.0;
    double apex = 0.0;  ///< along the shaft from the yaw axis
  };

  void read_axes() {
    const HtcBody& tower = body(tower_);
    top_ = to_ground_axes(tower.global(tower.points.back()));
    foot_ = to_ground_axes(tower.global(tower.points.front()));
    const HtcBody& hub = body(rotor_.hub_body);
    const double sign = rotor_.hub_axis < 0 ? -1.0 : 1.0;
    const Vector3 turning =
        to_ground_axes(Vector3(sign * hub.axes.col(std::abs(rotor_.hub_axis) - 1)));
    if (turning(1) <= 0.0) {
      import_.errors.add(rotor_.place,
                         "hub_vec: the rotor turns counter-clockwise as seen by one who looks "
                         "downwind; a case turns clockwise");
      return;
    }
    shaft_axis_ = turning;
    yaw_ = clean_angle(std::atan2(-turning(0), turning(1)));
    turbine().shaft.tilt = clean_angle(std::asin(std::clamp(turning(2), -1.0, 1.0)));
    // The nacelle, turned by the yaw.
    const double c = std::cos(yaw_);
    const double s = std::sin(yaw_);
    nacelle_axes_ << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
    find_shaft_line(hub);
    find_blades();
  }

  /// Where the shaft passes the yaw axis.
  void find_shaft_line(const HtcBody& hub) {
    const Vector3 point = to_ground_axes(Vector3(hub.global(hub.points.front()))) - top_;
    const Vector3 level(shaft_axis_(0), shaft_axis_(1), 0.0);
    const double along = -point.dot(level) / level.squaredNorm();
    crossing_ = point + along * shaft_axis_;
    turbine().shaft.height = clean(crossing_(2));
    const double aside = std::hypot(crossing_(0), crossing_(1));
    if (aside > same_place)
      import_.warn(hub.place, "note: the shaft passes the yaw axis " + rounded(aside) +
                                  " m aside, which is left out");
    crossing_(0) = crossing_(1) = 0.0;
    shaft_aside_ = point + along * shaft_axis_ - crossing_;
    import_.note("shaft.tilt_deg", "axis of hub_vec");
    import_.note("shaft.height", "where the axis of the rotor passes the yaw axis");
    import_.note("shaft.overhang", "along the axis to the point where the blade axes meet it");
  }

  void find_blades() {
    const Vector3 up = (Vector3::UnitZ() - shaft_axis_(2) * shaft_axis_).normalized();
    const Vector3 right = shaft_axis_.cross(up);
    for (const std::string& name : rotor_.blades) {
      const HtcBody& one = body(name);
      Blade blade;
      blade.root = to_ground_axes(Vector3(one.global(one.points.front()))) - top_ - shaft_aside_;
      blade.along = to_ground_axes(Vector3(one.axes.col(2)));
      const double axial = blade.along.dot(shaft_axis_);
      if (std::abs(axial) > 0.99) {
        import_.errors.add(one.place_of_orientation, name + ": the blade points along the shaft");
        return;
      }
      blade.precone = clean_angle(std::asin(axial));
      blade.azimuth = std::atan2(blade.along.dot(right), blade.along.dot(up));
      // The apex: the point of the axis next to the line of the blade.
      const Vector3 from = blade.root - crossing_;
      const double b = shaft_axis_.dot(blade.along);
      const double d = shaft_axis_.dot(from);
      const double e = blade.along.dot(from);
      blade.apex = (d - b * e) / (1.0 - b * b);
      const Vector3 apex = crossing_ + blade.apex * shaft_axis_;
      blade.radius = blade.along.dot(Vector3(blade.root - apex));
      const double miss = (blade.root - apex - blade.radius * blade.along).norm();
      const double allowed = same_place + 1e-3 * one.length();
      if (miss > allowed)
        import_.errors.add(one.place_of_orientation,
                           name + ": the axis of the blade misses that of the shaft by " +
                               rounded(miss) + " m, which a case cannot state");
      else if (miss > same_place)
        import_.warn(one.place_of_orientation, "note: " + name +
                                                   ": the axis of the blade misses that of the "
                                                   "shaft by " +
                                                   rounded(miss) + " m, which is left out");
      if (blade.radius < -same_place)
        import_.errors.add(one.place_of_orientation, name + ": the blade points to the shaft");
      blade.radius = std::max(blade.radius, 0.0);
      const Vector3 b3 = (shaft_axis_ - axial * blade.along).normalized();
      const Vector3 b2 = b3.cross(blade.along);
      const Vector3 chord = to_ground_axes(Vector3(one.axes.col(0)));
      blade.pitch = clean_angle(std::atan2(-chord.dot(b3), chord.dot(b2)));
      blades_.push_back(blade);
    }
    compare_blades();
  }

  void compare_blades() {
    const Blade& first = blades_.front();
    const auto count = static_cast<double>(blades_.size());
    std::set<int> sectors;
    for (std::size_t i = 0; i < blades_.size(); ++i) {
      const Blade& blade = blades_[i];
      const std::string& place = body(rotor_.blades[i]).place_of_orientation;
      if (std::abs(blade.precone - first.precone) > same_angle ||
          std::abs(blade.radius - first.radius) > same_place ||
          std::abs(blade.apex - first.apex) > same_place)
        import_.errors.add(place, rotor_.blades[i] +
                                      ": cone angle, root and hub must be those of the first "
                                      "blade");
      const double turns = (blade.azimuth - first.azimuth) / (2.0 * std::numbers::pi) * count;
      const double sector = std::round(turns);
      if (std::abs(turns - sector) > same_angle * count)
        import_.errors.add(place, rotor_.blades[i] +
                                      ": blades must be evenly spread, this one is " +
                                      rounded(degrees * (blade.azimuth - first.azimuth)) +
                                      " degrees from the first");
      const auto whole = static_cast<int>(sector);
      const int total = static_cast<int>(blades_.size());
      numbers_.push_back((whole % total + total) % total + 1);
      sectors.insert(numbers_.back());
    }
    if (sectors.size() != blades_.size() && import_.errors.empty())
      import_.errors.add(rotor_.block->place, "two blades have the same azimuth");
    turbine().shaft.overhang = clean(first.apex);
    turbine().hub.radius = clean(first.radius);
    turbine().blades.precone = first.precone;
    turbine().shaft.azimuth = clean_angle(first.azimuth);
    turbine().blades.count = static_cast<int>(blades_.size());
    import_.note("hub.radius", "from the axis to the root of the blade");
    import_.note("blades.precone_deg", "from the orientation of the blade");
    import_.note("shaft.azimuth_deg", "from the orientation of the first blade");
    import_.report.push_back({rotor_.block->place, "link", Fate::derived, numbering()});
  }

  std::string numbering() const {
    std::string words = "blades of the case:";
    for (std::size_t i = 0; i < numbers_.size(); ++i)
      words += " " + rotor_.blades[i] + " is blade " + std::to_string(numbers_[i]) +
               (i + 1 < numbers_.size() ? "," : "");
    return words;
  }

  // ---- tower and nacelle

  void read_tower() {
    turbine().has_tower = true;
    turbine().gravity = structure_.gravity;
    import_.note("gravity", "standard of HAWC2, or of the bodies");
    // b1 b2 b3 = n3 n1 n2.
    Matrix3 root;
    root << Vector3::UnitZ(), Vector3::UnitX(), Vector3::UnitY();
    Matrix3 to_root = root.transpose() * to_ground_axes(body(tower_).axes);
    for (double& component : to_root.reshaped()) component = clean(component);
    build_beam(import_, body(tower_), to_root, "tower", turbine().tower);
    set_htc_mesh(import_, turbine().tower, tower_mesh);
    import_.note("tower.length", "c2_def");
    import_.note("tower.reference_line", "c2_def");
    import_.note("tower.elements", "chosen by the importer");
    import_.note("tower.sections", "table of timoschenko_input");
    tower_bending_ = integrate_body(body(tower_)).bending;
    for (const HtcMass& mass : body(tower_).masses)
      if (mass.node == 1)
        import_.warn(mass.place,
                     "note: the mass at the foot of the tower, which is clamped, is "
                     "left out");
  }

  /// Adds the beam of a body, and warns where it bends.
  RigidBeam add_body(const std::string& name, RigidBody& sum) {
    RigidBeam rigid = integrate_body(body(name));
    sum.add(rigid.body);
    if (rigid.bending > small_bending * tower_bending_)
      import_.warn(body(name).place, "note: the body " + name +
                                         " is rigid in the case; in the deck it bends, by up to " +
                                         rounded(rigid.bending / tower_bending_, 2) +
                                         " of the tower under an equal moment");
    import_.report.push_back(
        {body(name).place, "main_body " + name, Fate::derived, "a rigid part of the case"});
    return rigid;
  }

  void read_nacelle() {
    turbine().has_nacelle = true;
    RigidBody sum;
    for (const auto& [name, part] : parts_) {
      if (part != Part::nacelle) continue;
      add_body(name, sum);
      for (const HtcMass& mass : body(name).masses) {
        const Vector3 place =
            to_ground_axes(Vector3(body(name).global(body(name).node(mass.node) + mass.offset)));
        if (mass.inertia.isZero(0.0) && (place - top_).norm() <= round_off * top_.norm())
          turbine().tower.tip_mass += mass.mass;
        else
          add_mass(body(name), mass, sum);
      }
    }
    // From the tower top, in axes of the nacelle.
    RigidBody own;
    if (!sum.is_empty())
      own.add(sum.mass(), nacelle_axes_.transpose() * (sum.center() - top_),
              nacelle_axes_.transpose() * sum.inertia() * nacelle_axes_);
    turbine().nacelle.mass = own.mass();
    turbine().nacelle.center_of_mass = clean(own.center());
    turbine().nacelle.inertia = principal(own.inertia(), "nacelle");
    import_.note("nacelle.mass", "bodies between tower and shaft, and their concentrated masses");
    import_.note("nacelle.center_of_mass", "from the tower top");
    import_.note("nacelle.inertia", "about its own centre");
    if (turbine().tower.tip_mass > 0.0)
      import_.note("tower.tip_mass", "concentrated masses without inertia at the tower top");
    read_yaw();
  }

  void read_yaw() {
    import_.note("nacelle.yaw", "locked: no free bearing below the nacelle");
    for (const HtcConstraint& constraint : structure_.constraints) {
      const auto part = parts_.find(constraint.second);
      if (part == parts_.end() || part->second != Part::nacelle) continue;
      if (!constraint.kind.starts_with("bearing")) continue;
      const bool is_upright = std::abs(bearing_axis(constraint)(2)) > 0.99;
      if (constraint.kind == "bearing1" && is_upright) {
        turbine().nacelle.yaw.kind = model::JointKind::free;
        import_.note("nacelle.yaw", "free bearing " + constraint.name);
      } else {
        import_.warn(constraint.place, "begin " + constraint.kind +
                                           ": note: the bearing between tower and nacelle is "
                                           "locked in the case");
      }
    }
  }

  /// Moments of inertia; products are left out.
  Vector3 principal(const Matrix3& inertia, const std::string& what) {
    const double product = largest_product(inertia);
    if (product > product_tolerance * inertia.diagonal().cwiseAbs().maxCoeff())
      import_.warn(import_.deck.path(), "note: " + what + ": products of inertia, up to " +
                                            rounded(product) +
                                            " kg m^2, are left out: a case has none");
    Vector3 diagonal = inertia.diagonal();
    const double scale = diagonal.cwiseAbs().maxCoeff();
    for (double& moment : diagonal)
      if (moment < 0.0 && moment > -1e-9 * scale) moment = 0.0;
    if (diagonal.minCoeff() < 0.0)
      import_.errors.add(import_.deck.path(), what + ": a moment of inertia is negative");
    return diagonal;
  }

  // ---- rotor

  void read_rotor() {
    const std::vector<std::string> shaft = shaft_bodies();
    RigidBody on_shaft;
    RigidBody on_hub;
    double twisting = 0.0;
    double damping = 0.0;
    for (const auto& [name, part] : parts_) {
      if (part != Part::rotor) continue;
      const bool is_shaft = std::ranges::find(shaft, name) != shaft.end();
      const RigidBeam beam = add_body(name, is_shaft ? on_shaft : on_hub);
      if (is_shaft && beam.twisting > 0.0) {
        twisting += beam.twisting;
        damping += body(name).damping[5] * beam.twisting;
      }
      for (const HtcMass& mass : body(name).masses)
        if (name == first_of_rotor_ && mass.node == 1)
          add_generator(body(name), mass, on_shaft);
        else
          add_mass(body(name), mass, on_hub);
    }
    for (const std::string& name : rotor_.blades)
      for (const HtcMass& mass : body(name).masses)
        if (mass.node == 1) {
          add_mass(body(name), mass, on_hub);
          import_.report.push_back({mass.place, "concentrated_mass", Fate::derived,
                                    "a part of the hub: it is at the root of the blade"});
        }
    set_torsion(twisting, damping, shaft);
    set_shaft(on_shaft);
    set_hub(on_hub);
    read_speed();
  }

  /// Bodies that all blades have in common and that lie along the axis.
  std::vector<std::string> shaft_bodies() const {
    std::vector<std::string> bodies;
    const std::vector<std::string>& chain = chains_.front();
    for (auto next = std::ranges::find(chain, first_of_rotor_); next + 1 != chain.end(); ++next) {
      const bool is_common = std::ranges::all_of(chains_, [&](const auto& other) {
        return std::ranges::find(other, *next) != other.end();
      });
      const HtcBody& one = body(*next);
      const Vector3 line =
          to_ground_axes(Vector3(one.axes * (one.points.back() - one.points.front()))).normalized();
      if (!is_common || std::abs(line.dot(shaft_axis_)) < along_the_shaft) break;
      bodies.push_back(*next);
    }
    return bodies;
  }

  /// A mass at the end of the shaft behind its torsion: its inertia is that of the generator.
  void add_generator(const HtcBody& one, const HtcMass& mass, RigidBody& on_shaft) {
    HtcMass rest = mass;
    const Vector3 axis = one.axes.transpose() * ground(shaft_axis_);
    const double axial = axis.dot(Vector3(mass.inertia * axis));
    turbine().shaft.generator.inertia = clean(turbine().shaft.generator.inertia + axial);
    rest.inertia -= axial * axis * axis.transpose();
    add_mass(one, rest, on_shaft);
    import_.note("shaft.generator", "inertia at the first node of " + one.label +
                                        ", about the shaft; its drive is not read");
  }

  /// From n1 n2 n3 to global axes of HAWC2.
  static Vector3 ground(const Vector3& v) { return to_ground_axes(v); }

  void set_torsion(double twisting, double damping, const std::vector<std::string>& shaft) {
    model::JointDefinition& torsion = turbine().shaft.torsion;
    if (!(twisting > 1.0 / rigid_torsion)) {
      import_.note("shaft.torsion", "the shaft is rigid");
      return;
    }
    torsion.kind = model::JointKind::free;
    torsion.stiffness = 1.0 / twisting;
    torsion.damping = damping / twisting * torsion.stiffness;
    std::string names;
    for (const std::string& name : shaft) names += (names.empty() ? "" : ", ") + name;
    import_.note("shaft.torsion", "GJ/length and Kz of " + names);
    import_.report.push_back({body(shaft.front()).place, "main_body " + shaft.front(),
                              Fate::derived,
                              "shaft.torsion: stiffness " + rounded(torsion.stiffness) +
                                  " N m/rad, damping Kz times it"});
  }

  void set_shaft(const RigidBody& sum) {
    if (sum.is_empty()) return;
    model::ShaftDefinition& shaft = turbine().shaft;
    const Vector3 center = sum.mass() > 0.0
                               ? Vector3(sum.center() - top_ - shaft_aside_ - crossing_)
                               : Vector3::Zero().eval();
    shaft.mass = sum.mass();
    shaft.center_of_mass = clean(center.dot(shaft_axis_));
    const double aside = (center - center.dot(shaft_axis_) * shaft_axis_).norm();
    if (aside > same_place)
      import_.warn(body(first_of_rotor_).place, "note: the mass of the shaft is " + rounded(aside) +
                                                    " m off its axis, which is left out");
    const Matrix3 inertia = sum.inertia();
    shaft.inertia_axial = std::max(shaft_axis_.dot(Vector3(inertia * shaft_axis_)), 0.0);
    shaft.inertia_transverse = std::max(0.5 * (inertia.trace() - shaft.inertia_axial), 0.0);
    import_.note("shaft.mass", "bodies of the shaft");
  }

  void set_hub(const RigidBody& sum) {
    model::HubDefinition& hub = turbine().hub;
    import_.note("hub.mass", "bodies between shaft and blades, and masses at the end of the shaft");
    if (sum.is_empty()) return;
    // h2 along the shaft, h3 along blade 1 without its cone.
    const Vector3 along = blades_.front().along;
    Matrix3 axes;
    axes.col(1) = shaft_axis_;
    axes.col(2) = (along - along.dot(shaft_axis_) * shaft_axis_).normalized();
    axes.col(0) = axes.col(1).cross(axes.col(2));
    const Vector3 apex = top_ + shaft_aside_ + crossing_ + blades_.front().apex * shaft_axis_;
    const Vector3 center = sum.mass() > 0.0 ? Vector3(axes.transpose() * (sum.center() - apex))
                                            : Vector3::Zero().eval();
    const Vector3 inertia = principal(axes.transpose() * sum.inertia() * axes, "hub");
    const double aside = std::hypot(center(0), center(2));
    if (aside > 1e-6) {
      hub.point_masses.push_back({sum.mass(), center, inertia});
      import_.note("hub.point_masses", "its centre of mass is off the shaft");
      return;
    }
    hub.mass = sum.mass();
    hub.center_of_mass = clean(center(1));
    hub.inertia = inertia;
    import_.note("hub.center_of_mass", "from the point where the blade axes meet");
    import_.note("hub.inertia", "about its own centre");
  }

  void read_speed() {
    double speed = 0.0;
    std::string place;
    for (const HtcStructure::Rotation& rotation : structure_.rotations) {
      const auto part = parts_.find(rotation.body);
      if (part == parts_.end() || part->second != Part::rotor) {
        if (rotation.speed != 0.0)
          import_.warn(rotation.place, "note: the initial rotation of " + rotation.body +
                                           " is left out: it is no part of the hub");
        continue;
      }
      const Vector3 axis =
          to_ground_axes(Vector3(body(rotation.body).axes * rotation.axis)) * rotation.speed;
      speed = axis.dot(shaft_axis_);
      place = rotation.place;
      import_.report.push_back(
          {place, "ini_rotvec_d1", Fate::derived, "shaft.speed_rpm, at the beginning"});
    }
    for (const HtcConstraint& constraint : structure_.constraints)
      if (constraint.kind == "bearing3" && constraint.second == first_of_rotor_)
        if (const HtcCommand* omega = constraint.block->find("omegas")) {
          if (const auto value = import_.number(*omega, 0)) {
            const Vector3 axis = bearing_axis(constraint) * *value;
            speed = axis.isZero(0.0) ? *value : axis.dot(shaft_axis_);
          }
          place = omega->place;
          import_.report.push_back({place, "omegas", Fate::derived, "shaft.speed_rpm"});
        }
    const auto stated = import_.options.stated.find("shaft.speed_rpm");
    if (stated != import_.options.stated.end()) {
      turbine().shaft.speed = fields::rpm.to_si(stated->second[0]);
      import_.note("shaft.speed_rpm", "from the command line");
      return;
    }
    if (speed < 0.0) {
      import_.errors.add(place,
                         "the rotor turns against hub_vec: counter-clockwise as seen by one who "
                         "looks downwind; a case turns clockwise");
      return;
    }
    turbine().shaft.speed = speed;
    import_.note("shaft.speed_rpm", place.empty() ? "not in the deck" : "at the beginning");
    import_.warn(
        place.empty() ? import_.deck.path() : place,
        "note: shaft.speed_rpm is " + rounded(fields::rpm.from_si(speed)) +
            (place.empty() ? ": the deck has no initial speed" : ", the speed at the beginning") +
            "; hint: --rotor-speed-rpm states another one");
  }

  // ---- blades

  void read_blades() {
    const HtcBody& first = body(rotor_.blades.front());
    for (std::size_t i = 1; i < rotor_.blades.size(); ++i) {
      const HtcBody& other = body(rotor_.blades[i]);
      const bool is_same =
          other.source == first.source ||
          (other.points == first.points && other.twists == first.twists &&
           other.table.rows == first.table.rows && other.table.full == first.table.full &&
           other.damping == first.damping && other.masses.size() == first.masses.size() &&
           std::equal(other.masses.begin(), other.masses.end(), first.masses.begin(),
                      [](const HtcMass& a, const HtcMass& b) {
                        return a.node == b.node && a.mass == b.mass && a.offset == b.offset &&
                               a.inertia == b.inertia;
                      }));
      if (!is_same)
        import_.errors.add(other.place, "blades that differ cannot be imported: " + other.label +
                                            " and " + first.label);
    }
    // b1 b2 b3 = z x y.
    Matrix3 to_root;
    to_root << Vector3::UnitY(), Vector3::UnitZ(), Vector3::UnitX();
    twist_ = build_beam(import_, first, to_root, "blades", turbine().blades.beam);
    set_htc_mesh(import_, turbine().blades.beam, blade_mesh);
    const double pitch = blades_.front().pitch;
    turbine().blades.pitch = pitch;
    for (std::size_t i = 1; i < blades_.size(); ++i)
      if (std::abs(blades_[i].pitch - pitch) > 1e-9)
        turbine().blades.each[numbers_[i]].pitch = blades_[i].pitch - pitch;
    import_.note("blades.pitch_deg", "from the orientation of the blade");
    import_.note("blades.length", "c2_def");
    import_.note("blades.reference_line", "c2_def, [z, x, y], from its first point");
    import_.note("blades.elements", "chosen by the importer");
    import_.note("blades.sections", "table of timoschenko_input; twist of c2_def, > 0 to feather");
    const Vector3& start = first.points.front();
    if (first.starts_at_origin && std::hypot(start(0), start(1)) > same_place)
      import_.warn(first.place, "note: the line of " + first.label + " begins " +
                                    rounded(std::hypot(start(0), start(1))) +
                                    " m beside the pitch axis, where the case has its root");
  }

  void read_air() {
    HtcAirSource source;
    source.foot = foot_(2);
    source.yaw = yaw_;
    source.tower = tower_;
    source.twist = twist_;
    source.aero = rotor_.block;
    read_htc_air(import_, source);
    for (const char* name : {"aerosections", "aero_distribution"})
      if (const HtcCommand* command = rotor_.block->find(name))
        import_.say("aero", *command, Fate::ignored,
                    "the air acts at the Gauss points of the elements");
  }

  // ---- the report

  void report_constraints() {
    for (const HtcConstraint& constraint : structure_.constraints) {
      const auto part = parts_.find(constraint.second);
      const Part where = part == parts_.end() ? Part::left_out : part->second;
      std::string words = constraint.kind + (constraint.name.empty() ? "" : " " + constraint.name);
      std::string meaning = "the parts are connected";
      Fate fate = Fate::derived;
      const bool is_bearing = constraint.kind.starts_with("bearing");
      if (is_bearing && constraint.second == first_of_rotor_) {
        meaning = "the shaft turns; the generator is locked to its speed";
      } else if (is_bearing && where == Part::blade) {
        meaning = "blades.pitch_deg, constant";
      } else if (is_bearing && where == Part::nacelle) {
        meaning = "nacelle.yaw";
      } else if (is_bearing) {
        meaning = "locked";
        import_.warn(constraint.place, "note: the bearing " + words + " on " + constraint.second +
                                           " is locked in the case");
      } else if (!constraint.kind.starts_with("fix")) {
        meaning = "left out";
        fate = Fate::ignored;
        import_.warn(constraint.place, "begin " + constraint.kind + ": note: left out");
      }
      import_.report.push_back({constraint.place, words, fate, constraint.second + ": " + meaning});
    }
  }

  Import finish() {
    turbine().title = clean_text(std::filesystem::path(import_.deck.path()).stem().string());
    std::vector<std::string> head{
        "Imported by samara from HAWC2, " +
            clean_text(std::filesystem::path(import_.deck.path()).filename().string()) + ".",
        "Every key is explained in docs/case_file.md, the import in docs/import.md. SI units."};
    const BeamMass tower = integrate_mass(turbine().tower, turbine().tower.length);
    const BeamMass blade = integrate_mass(turbine().blades.beam, turbine().blades.beam.length);
    head.push_back("Masses [kg]: tower " + rounded(tower.mass) + ", each blade " +
                   rounded(blade.mass) + ", hub " + rounded(turbine().hub.mass) + ", nacelle " +
                   rounded(turbine().nacelle.mass) + ".");
    import_.comments.head.insert(import_.comments.head.begin(), head.begin(), head.end());
    Import result;
    result.text = io::write_case_text(turbine(), import_.comments);
    result.report = std::move(import_.report);
    result.warnings = std::move(import_.warnings);
    for (ImportLine& line : result.report) {
      line.key = clean_text(line.key);
      line.words = clean_text(line.words);
    }
    check_import(result);
    return result;
  }

  HtcImport import_;
  HtcStructure structure_;
  HtcRotor rotor_;
  std::vector<std::vector<std::string>> chains_;  ///< from the ground to each blade
  std::string first_of_rotor_;                    ///< the first body that turns
  std::string tower_;
  std::map<std::string, Part> parts_;
  Vector3 foot_ = Vector3::Zero();  ///< of the tower, in n1 n2 n3 from the origin of HAWC2 [m]
  Vector3 top_ = Vector3::Zero();   ///< of the tower
  Vector3 shaft_axis_ = Vector3::UnitY();       ///< downwind
  Vector3 crossing_ = Vector3::Zero();          ///< of shaft and yaw axis, from the tower top
  Vector3 shaft_aside_ = Vector3::Zero();       ///< of the shaft from that point
  double yaw_ = 0.0;                            ///< counter-clockwise from above [rad]
  Matrix3 nacelle_axes_ = Matrix3::Identity();  ///< y1 y2 y3 as columns
  std::vector<Blade> blades_;
  std::vector<int> numbers_;  ///< of the blades in the case
  double tower_bending_ = 0.0;
  Curve twist_;  ///< of the blades
};

}  // namespace

Import import_hawc2(const std::string& path, const ImportOptions& options) {
  return Importer(path, options).run();
}

}  // namespace samara::decks
