#include "htc_structure.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include "samara/base/words.hpp"
#include "samara/math/rotation.hpp"

#include "import_common.hpp"

namespace samara::decks {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr int most_nodes = 5000;

/// Acceleration that HAWC2 takes where a body states none.
constexpr double standard_gravity = 9.81;

/// Shortest distance of two points of a line [m].
constexpr double least_distance = 1e-6;

class StructureReader {
 public:
  explicit StructureReader(HtcImport& import) : import_(import) {}

  HtcStructure read() {
    const HtcBlock* block = import_.deck.root().find_block("new_htc_structure");
    if (block == nullptr) {
      import_.errors.add(import_.deck.path(),
                         "missing block \"begin new_htc_structure\": not a deck of HAWC2");
      return structure_;
    }
    block->used = true;
    structure_.gravity = standard_gravity;
    for (const HtcBlock& part : block->blocks)
      if (part.name == "main_body") read_name(part);
    for (const HtcBlock& part : block->blocks)
      if (part.name == "main_body") read_body(part);
    for (const HtcBlock& part : block->blocks) {
      if (part.name == "orientation") read_orientation(part);
      if (part.name == "constraint") read_constraints(part);
    }
    place_bodies();
    return structure_;
  }

 private:
  // ---- bodies

  void read_name(const HtcBlock& block) {
    block.used = true;
    const HtcCommand* name = import_.require(block, "name");
    if (name == nullptr) return;
    const std::string word = to_lower(import_.word(*name, 0, "the name"));
    if (word.empty()) return;
    if (!blocks_.try_emplace(word, &block).second)
      import_.errors.add(name->place, "name: there are two bodies \"" + word + "\"");
    import_.say(word, *name, Fate::derived, "the body");
  }

  void read_body(const HtcBlock& block) {
    const HtcCommand* name = block.find("name");
    if (name == nullptr || name->words.empty()) return;
    HtcBody body;
    body.label = name->words[0];
    body.name = to_lower(body.label);
    body.place = block.place;
    body.source = body.name;
    const HtcBlock* source = &block;
    if (const HtcCommand* copy = block.find("copy_main_body")) {
      const std::string other = to_lower(import_.word(*copy, 0, "the name of a body"));
      const auto known = blocks_.find(other);
      if (known == blocks_.end() || known->second->find("copy_main_body") != nullptr) {
        import_.errors.add(copy->place, "copy_main_body: there is no body \"" + other +
                                            "\" with commands of its own");
        return;
      }
      import_.say(body.name, *copy, Fate::derived, "the same as " + other);
      source = known->second;
      body.source = other;
    }
    const bool speaks = source == &block;
    read_type(*source, body, speaks);
    read_line(*source, body, speaks);
    read_nodes(*source, body, speaks);
    read_damping(*source, body, speaks);
    read_masses(*source, body, speaks);
    read_table(*source, body, speaks);
    read_gravity(*source, body, speaks);
    if (body.points.size() < 2 || body.table.rows.empty()) {
      is_complete_ = false;
      return;
    }
    structure_.bodies.push_back(std::move(body));
  }

  void read_type(const HtcBlock& block, const HtcBody& body, bool speaks) {
    if (const HtcCommand* type = import_.require(block, "type"); type != nullptr && speaks) {
      const std::string word = to_lower(import_.word(*type, 0, "the type"));
      if (!word.starts_with("timo") && !word.empty())
        import_.errors.add(type->place, "type: timoschenko can be read, got \"" + word + "\"");
      import_.say(body.name, *type, Fate::derived, "a beam");
    }
    if (const HtcCommand* count = block.find("nbodies"); count != nullptr && speaks)
      import_.say(body.name, *count, Fate::ignored,
                  "beams of a case are geometrically exact: one body has any deflection");
  }

  void read_line(const HtcBlock& block, HtcBody& body, bool speaks) {
    const HtcBlock* line = block.find_block("c2_def");
    if (line == nullptr) {
      import_.errors.add(block.place, body.label + ": missing block \"begin c2_def\"");
      return;
    }
    const HtcCommand* count = import_.require(*line, "nsec");
    const auto stated =
        count == nullptr ? std::optional<int>() : import_.integer(*count, 0, 2, most_nodes);
    if (!stated) return;
    for (const HtcCommand& command : line->commands) {
      if (command.name != "sec") continue;
      const auto number = import_.integer(command, 0, 1, most_nodes);
      const auto values = import_.numbers(command, 1, 4);
      if (!number || !values) return;
      if (*number != static_cast<int>(body.points.size()) + 1) {
        import_.errors.add(command.place, "sec: expected section " +
                                              std::to_string(body.points.size() + 1) + ", got " +
                                              std::to_string(*number));
        return;
      }
      const Vector3 point((*values)[0], (*values)[1], (*values)[2]);
      if (!body.points.empty() && !((point - body.points.back()).norm() > least_distance)) {
        import_.errors.add(command.place, "sec: the same point as the one before");
        return;
      }
      body.points.push_back(point);
      body.twists.push_back((*values)[3] * degree);
      command.used = true;
    }
    if (*stated != static_cast<int>(body.points.size())) {
      import_.errors.add(count->place, "nsec: " + std::to_string(*stated) + ", there are " +
                                           std::to_string(body.points.size()) + " sections");
      body.points.clear();
      return;
    }
    count->used = true;
    if (speaks)
      import_.say(*line, body.name + ".c2_def", Fate::derived,
                  "the line and the twist of the body");
  }

  void read_nodes(const HtcBlock& block, HtcBody& body, bool speaks) {
    const HtcCommand* command = block.find("node_distribution");
    if (command == nullptr) return;
    const std::string kind = to_lower(import_.word(*command, 0, "a distribution"));
    if (kind == "uniform") {
      const auto count = import_.integer(*command, 1, 2, most_nodes);
      if (count) body.uniform_nodes = *count;
    } else if (kind != "c2_def" && !kind.empty()) {
      import_.errors.add(command->place,
                         "node_distribution: c2_def and uniform can be read, got \"" + kind + "\"");
    }
    if (speaks)
      import_.say(body.name, *command, Fate::ignored,
                  "a case has a mesh of its own; masses are at the places of their nodes");
  }

  void read_damping(const HtcBlock& block, HtcBody& body, bool speaks) {
    for (const char* name : {"damping_posdef", "damping_aniso", "damping"}) {
      const HtcCommand* command = block.find(name);
      if (command == nullptr) continue;
      const auto values = import_.numbers(*command, 0, 6);
      if (!values) return;
      if (*std::ranges::min_element(*values) < 0.0) {
        import_.errors.add(command->place, command->name + ": expected numbers >= 0");
        return;
      }
      std::ranges::copy(*values, body.damping.begin());
      const bool is_about_axes = command->name == "damping_aniso";
      if (!is_about_axes) std::swap(body.damping[3], body.damping[4]);
      body.damping_place = command->place;
      if (speaks)
        import_.say(body.name, *command, Fate::derived,
                    is_about_axes
                        ? "Kx, Ky, Kz: the mu of bending about x, about y and of torsion"
                        : "Kx, Ky, Kz: the mu of bending along x, along y and of torsion");
      return;
    }
  }

  void read_masses(const HtcBlock& block, HtcBody& body, bool speaks) {
    for (const HtcCommand& command : block.commands) {
      if (command.name != "concentrated_mass") continue;
      const auto node = import_.integer(command, 0, 1, most_nodes);
      const bool has_products = command.words.size() >= 11;
      const auto values = import_.numbers(command, 1, has_products ? 10 : 7);
      if (!node || !values) continue;
      if (body.points.size() >= 2 && *node > body.nodes()) {
        import_.errors.add(command.place, "concentrated_mass: node " + std::to_string(*node) +
                                              " of " + std::to_string(body.nodes()));
        continue;
      }
      HtcMass mass;
      mass.place = command.place;
      mass.node = *node;
      mass.offset = {(*values)[0], (*values)[1], (*values)[2]};
      mass.mass = (*values)[3];
      mass.inertia.diagonal() << (*values)[4], (*values)[5], (*values)[6];
      if (has_products) {
        mass.inertia(0, 1) = mass.inertia(1, 0) = (*values)[7];
        mass.inertia(0, 2) = mass.inertia(2, 0) = (*values)[8];
        mass.inertia(1, 2) = mass.inertia(2, 1) = (*values)[9];
      }
      if (mass.mass < 0.0 || mass.inertia.diagonal().minCoeff() < 0.0) {
        import_.errors.add(command.place,
                           "concentrated_mass: expected a mass and moments of inertia >= 0");
        continue;
      }
      body.masses.push_back(mass);
      command.used = true;
      if (speaks)
        import_.say(body.name, command, Fate::derived,
                    "node " + std::to_string(*node) + ", " + rounded(mass.mass) + " kg");
    }
  }

  void read_table(const HtcBlock& block, HtcBody& body, bool speaks) {
    const HtcBlock* input = block.find_block("timoschenko_input");
    if (input == nullptr) {
      import_.errors.add(block.place, body.label + ": missing block \"begin timoschenko_input\"");
      return;
    }
    const HtcCommand* name = import_.require(*input, "filename");
    const HtcCommand* choice = import_.require(*input, "set");
    bool full = false;
    if (const HtcCommand* flag = input->find("fpm")) {
      const auto value = import_.integer(*flag, 0, 0, 1);
      full = value && *value == 1;
      if (speaks)
        import_.say(body.name, *flag, Fate::derived,
                    full ? "full matrices: 30 columns" : "19 columns");
    }
    if (name == nullptr || choice == nullptr) return;
    const auto set = import_.integer(*choice, 0, 1, most_nodes);
    const auto subset = import_.integer(*choice, 1, 1, most_nodes);
    const std::string word = import_.word(*name, 0, "the name of a file");
    if (!set || !subset || word.empty()) return;
    const std::string path = import_.deck.find_file(word, name->place);
    if (path.empty()) return;
    const auto key = std::make_pair(path, std::array<int, 3>{*set, *subset, full ? 1 : 0});
    auto known = tables_.find(key);
    if (known == tables_.end())
      known = tables_.emplace(key, read_st(path, *set, *subset, full, import_.errors)).first;
    body.table = known->second;
    if (!speaks) return;
    import_.say(body.name, *name, Fate::derived, "sections of the body");
    import_.say(body.name, *choice, Fate::derived,
                "set " + std::to_string(*set) + ", subset " + std::to_string(*subset) + ", " +
                    std::to_string(body.table.rows.size()) + " rows");
    input->used = true;
    if (body.table.is_open && open_tables_.insert(path).second)
      import_.warn(body.table.place(body.table.lines.size() - 1),
                   "note: the file ends inside this line; its last number may be cut off");
  }

  void read_gravity(const HtcBlock& block, const HtcBody& body, bool speaks) {
    const HtcCommand* command = block.find("gravity");
    if (command == nullptr) return;
    const auto value = import_.number(*command, 0);
    if (!value) return;
    if (*value < 0.0) import_.errors.add(command->place, "gravity: expected a number >= 0");
    if (has_gravity_ && *value != structure_.gravity)
      import_.errors.add(command->place, "gravity: bodies of different gravity cannot be imported");
    has_gravity_ = true;
    structure_.gravity = *value;
    if (speaks) import_.say(body.name, *command, Fate::taken, "gravity");
  }

  // ---- orientation

  HtcBody* body_of(const HtcCommand& command) {
    const std::string name = to_lower(import_.word(command, 0, "the name of a body"));
    if (name.empty()) return nullptr;
    const auto found = std::ranges::find(structure_.bodies, name, &HtcBody::name);
    HtcBody* body = found == structure_.bodies.end() ? nullptr : &*found;
    // A body with faults of its own has been reported.
    if (body == nullptr && !blocks_.contains(name))
      import_.errors.add(command.place, command.name + ": there is no body \"" + name + "\"");
    return body;
  }

  /// The turn of a block, from the axes of the first body to those of the second: commands that end
  /// in eulerang, eulerpar or axisangle, one after the other in turned axes.
  Matrix3 turn_of(const HtcBlock& block) {
    Matrix3 turn = Matrix3::Identity();
    for (const HtcCommand& command : block.commands) {
      if (command.name.ends_with("eulerang")) {
        if (const auto angles = import_.numbers(command, 0, 3))
          for (int axis = 0; axis < 3; ++axis)
            turn =
                turn * math::turn_about<double>(Vector3::Unit(axis),
                                                (*angles)[static_cast<std::size_t>(axis)] * degree);
      } else if (command.name.ends_with("axisangle")) {
        if (const auto values = import_.numbers(command, 0, 4)) {
          const Vector3 axis((*values)[0], (*values)[1], (*values)[2]);
          if (!(axis.norm() > 0.0) && (*values)[3] != 0.0)
            import_.errors.add(command.place, command.name + ": the axis has no length");
          else if ((*values)[3] != 0.0)
            turn = turn * math::turn_about<double>(axis.normalized(), (*values)[3] * degree);
        }
      } else if (command.name.ends_with("eulerpar")) {
        if (const auto values = import_.numbers(command, 0, 4)) {
          Eigen::Quaterniond parameters((*values)[0], (*values)[1], (*values)[2], (*values)[3]);
          if (std::abs(parameters.norm() - 1.0) > 1e-3) {
            import_.errors.add(command.place, command.name + ": the squares must sum up to 1");
          } else {
            parameters.normalize();
            turn = turn * parameters.toRotationMatrix();
          }
        }
      } else {
        continue;
      }
      command.used = true;
    }
    return turn;
  }

  void read_orientation(const HtcBlock& block) {
    block.used = true;
    for (const HtcBlock& part : block.blocks) {
      if (part.name == "base") read_base(part);
      if (part.name == "relative") read_relative(part);
    }
  }

  void read_base(const HtcBlock& block) {
    const HtcCommand* name = block.find("body", "mbdy");
    if (name == nullptr) {
      import_.errors.add(block.place, "begin base: missing command \"mbdy\"");
      return;
    }
    const HtcCommand* start = import_.require(block, "inipos");
    const auto values =
        start == nullptr ? std::optional<std::vector<double>>() : import_.numbers(*start, 0, 3);
    const Matrix3 turn = turn_of(block);
    HtcBody* body = body_of(*name);
    if (body == nullptr || !values) return;
    if (!take_place(*body, block)) return;
    body->axes = turn;
    body->origin = {(*values)[0], (*values)[1], (*values)[2]};
    body->is_placed = true;
    name->used = start->used = true;
    import_.say(block, "base " + body->label, Fate::derived, "place of the body on the ground");
    read_rotation(block, *body);
  }

  bool take_place(HtcBody& body, const HtcBlock& block) {
    if (body.place_of_orientation.empty()) {
      body.place_of_orientation = block.place;
      return true;
    }
    import_.errors.add(block.place, "the body \"" + body.label + "\" has its place already, from " +
                                        body.place_of_orientation);
    return false;
  }

  struct Relative {
    std::size_t body = 0;
    std::string parent;
    int parent_node = 0;  ///< 0: the origin; -1: the last
    int own_node = 1;
    Matrix3 turn = Matrix3::Identity();
    std::string place;
  };

  /// A node of a body: a number, 0 for its origin, or `last`, -1.
  std::optional<int> node_of(const HtcCommand& command) {
    if (command.words.size() > 1 && to_lower(command.words[1]) == "last") return -1;
    return import_.integer(command, 1, -1, most_nodes);
  }

  void read_relative(const HtcBlock& block) {
    const HtcCommand* first = block.find("body1", "mbdy1");
    const HtcCommand* second = block.find("body2", "mbdy2");
    if (first == nullptr || second == nullptr) {
      import_.errors.add(block.place, std::string("begin relative: missing command \"") +
                                          (first == nullptr ? "mbdy1" : "mbdy2") + "\"");
      return;
    }
    const HtcBody* parent = body_of(*first);
    HtcBody* body = body_of(*second);
    const auto parent_node = node_of(*first);
    const auto own_node = node_of(*second);
    const Matrix3 turn = turn_of(block);
    if (parent == nullptr || body == nullptr || !parent_node || !own_node) return;
    if (*parent_node > parent->nodes() || *own_node > body->nodes()) {
      import_.errors.add(block.place, "begin relative: a body has fewer nodes than stated");
      return;
    }
    if (*own_node != 0 && *own_node != 1) {
      import_.errors.add(second->place, second->name +
                                            ": a body starts at its node 1 (or its origin, 0), "
                                            "other nodes cannot be read");
      return;
    }
    if (parent == body) {
      import_.errors.add(block.place, "begin relative: a body cannot stand on itself");
      return;
    }
    if (!take_place(*body, block)) return;
    first->used = second->used = true;
    Relative relative;
    relative.body = static_cast<std::size_t>(body - structure_.bodies.data());
    relative.parent = parent->name;
    relative.parent_node = *parent_node;
    relative.own_node = *own_node;
    relative.turn = turn;
    relative.place = block.place;
    body->parent = parent->name;
    body->starts_at_origin = *own_node == 0;
    relatives_.push_back(relative);
    import_.say(block, "relative " + body->label, Fate::derived,
                "place of the body on " + parent->label);
    read_rotation(block, *body);
  }

  void read_rotation(const HtcBlock& block, const HtcBody& body) {
    for (const HtcCommand& command : block.commands) {
      if (!command.name.ends_with("ini_rotvec_d1")) continue;
      const auto values = import_.numbers(command, 0, 4);
      command.used = true;
      if (!values) continue;
      const Vector3 axis((*values)[0], (*values)[1], (*values)[2]);
      if (!(axis.norm() > 0.0)) {
        if ((*values)[3] != 0.0)
          import_.errors.add(command.place, command.name + ": the axis has no length");
        continue;
      }
      structure_.rotations.push_back({body.name, command.place, axis.normalized(), (*values)[3]});
    }
  }

  void place_bodies() {
    bool has_changed = true;
    while (has_changed) {
      has_changed = false;
      for (const Relative& relative : relatives_) {
        HtcBody& body = structure_.bodies[relative.body];
        const HtcBody* parent = structure_.find(relative.parent);
        if (body.is_placed || !parent->is_placed) continue;
        const Vector3 node = relative.parent_node == 0  ? Vector3::Zero().eval()
                             : relative.parent_node < 0 ? parent->node(parent->nodes())
                                                        : parent->node(relative.parent_node);
        body.axes = parent->axes * relative.turn;
        body.origin = parent->global(node);
        if (relative.own_node == 1) body.origin -= body.axes * body.points.front();
        body.is_placed = true;
        has_changed = true;
      }
    }
    if (!is_complete_) return;
    for (const HtcBody& body : structure_.bodies)
      if (!body.is_placed)
        import_.errors.add(body.place, "the body \"" + body.label +
                                           "\" has no place: no begin base or relative leads from "
                                           "the ground to it");
  }

  // ---- constraints

  void read_constraints(const HtcBlock& block) {
    block.used = true;
    for (const HtcBlock& part : block.blocks) {
      HtcConstraint constraint;
      constraint.kind = part.name;
      constraint.place = part.place;
      constraint.block = &part;
      const HtcCommand* first = part.find("body1", "mbdy1");
      const HtcCommand* second = part.find("body2", "mbdy2");
      const HtcCommand* single = part.find("body", "mbdy");
      if (const HtcCommand* name = part.find("name"); name != nullptr && !name->words.empty())
        constraint.name = name->words[0];
      if (single != nullptr && second == nullptr) {
        if (!single->words.empty()) constraint.second = to_lower(single->words[0]);
      } else if (first != nullptr && second != nullptr && !first->words.empty() &&
                 !second->words.empty()) {
        constraint.first = to_lower(first->words[0]);
        constraint.second = to_lower(second->words[0]);
      }
      for (const std::string& name : {constraint.first, constraint.second})
        if (!name.empty() && !blocks_.contains(name))
          import_.errors.add(part.place,
                             "begin " + part.name + ": there is no body \"" + name + "\"");
      for (const HtcCommand& command : part.commands) command.used = true;
      part.used = true;
      structure_.constraints.push_back(constraint);
    }
  }

  HtcImport& import_;
  HtcStructure structure_;
  std::map<std::string, const HtcBlock*> blocks_;  ///< of bodies, by their names
  std::map<std::pair<std::string, std::array<int, 3>>, StTable> tables_;
  std::set<std::string> open_tables_;  ///< files that end inside their last row
  std::vector<Relative> relatives_;
  bool is_complete_ = true;  ///< every body has been read
  bool has_gravity_ = false;
};

}  // namespace

std::vector<double> HtcBody::chords() const {
  std::vector<double> lengths{0.0};
  for (std::size_t i = 1; i < points.size(); ++i)
    lengths.push_back(lengths.back() + (points[i] - points[i - 1]).norm());
  return lengths;
}

int HtcBody::nodes() const {
  return uniform_nodes > 0 ? uniform_nodes : static_cast<int>(points.size());
}

double HtcBody::share(int number) const {
  if (uniform_nodes > 0) return (number - 1.0) / (uniform_nodes - 1.0);
  const std::vector<double> lengths = chords();
  return lengths[static_cast<std::size_t>(number) - 1] / lengths.back();
}

Vector3 HtcBody::node(int number) const {
  if (uniform_nodes == 0) return points[static_cast<std::size_t>(number) - 1];
  const std::vector<double> lengths = chords();
  const double at = share(number) * lengths.back();
  std::size_t next = 1;
  while (next + 1 < lengths.size() && lengths[next] < at) ++next;
  const double part = (at - lengths[next - 1]) / (lengths[next] - lengths[next - 1]);
  return points[next - 1] + part * (points[next] - points[next - 1]);
}

const HtcBody* HtcStructure::find(const std::string& name) const {
  const auto found = std::ranges::find(bodies, name, &HtcBody::name);
  return found == bodies.end() ? nullptr : &*found;
}

HtcStructure read_htc_structure(HtcImport& import) { return StructureReader(import).read(); }

}  // namespace samara::decks
