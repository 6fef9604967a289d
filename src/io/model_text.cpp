#include "model_text.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

#include "yaml_reader.hpp"

namespace samara::io {
namespace {

/// Keys of a case that do not change the model.
constexpr std::array<const char*, 7> other_keys{"samara", "title",     "trim",     "floquet",
                                                "static", "transient", "linearize"};

/// The text of a value; equal numbers get the same text.
std::string canonical(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::scalar || node.quoted) return node.text;
  std::istringstream stream(node.text);
  double value = 0.0;
  if (!(stream >> value) || !stream.eof()) return node.text;
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

bool is_polar_table(const std::string& where) {
  return where.starts_with("blades.airfoils.") && where.ends_with(".table");
}

/// A row of a table, "-180, 0, 0.5, 0".
std::string row_text(const YamlNode& row) {
  std::string text;
  for (const YamlNode& child : row.children) text += (text.empty() ? "" : ", ") + canonical(child);
  return text;
}

void add_lines(const YamlNode& node, const std::string& where,
               std::map<std::string, std::string>& lines) {
  if (node.kind == YamlNode::Kind::list && is_polar_table(where)) {
    for (std::size_t i = 0; i < node.children.size(); ++i)
      lines[join_path(where, i)] = row_text(node.children[i]);
    return;
  }
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    const YamlNode& child = node.children[i];
    const std::string place =
        node.kind == YamlNode::Kind::list ? join_path(where, i) : join_path(where, child.key);
    add_lines(child, place, lines);
  }
  if (node.children.empty()) lines[where] = canonical(node);
}

}  // namespace

std::string model_text_of(const YamlNode& root) {
  std::map<std::string, std::string> lines;
  for (const YamlNode& child : root.children) {
    const bool is_other = std::any_of(other_keys.begin(), other_keys.end(),
                                      [&child](const char* key) { return child.key == key; });
    if (!is_other) add_lines(child, child.key, lines);
  }
  std::string text;
  for (const auto& [key, value] : lines) text.append(key).append(": ").append(value).append("\n");
  return text;
}

}  // namespace samara::io
