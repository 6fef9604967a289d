#include "yaml_settings.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <string_view>
#include <system_error>

#include "exclusive_keys.hpp"

namespace samara::io {
namespace {

constexpr std::size_t max_path_length = 16;

/// Splits `blades.sections.0.mass`; no keys where a part of the path is empty.
std::vector<std::string> split_path(std::string_view path) {
  std::vector<std::string> keys;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    if (end == begin) return {};
    keys.emplace_back(path.substr(begin, end - begin));
    if (end == path.size()) return keys;
    begin = end + 1;
  }
}

void remove_other_spellings(YamlNode& map, std::string_view key) {
  static const ExclusiveKeys others = find_exclusive_keys();
  std::erase_if(map.children, [&](const YamlNode& child) {
    return others.contains({std::string(key), child.key});
  });
}

/// Returns the child `key`, and creates it if it is missing; null after an error.
YamlNode* enter(YamlNode& node, const std::string& key, const std::string& where,
                const Place& place, ErrorList& errors) {
  if (node.kind == YamlNode::Kind::list) {
    std::size_t index = 0;
    const char* end = key.data() + key.size();
    const auto [stop, error] = std::from_chars(key.data(), end, index);
    if (stop != end || error != std::errc() || index >= node.children.size()) {
      const std::size_t count = node.children.size();
      errors.add(
          place, "",
          where + " is a list" +
              (count == 0 ? " without items" : " with items 0 to " + std::to_string(count - 1)) +
              ", it has no item \"" + key + "\"");
      return nullptr;
    }
    return &node.children[index];
  }
  if (node.kind == YamlNode::Kind::scalar) {
    errors.add(place, "", where + " is a value, it has no key \"" + key + "\"");
    return nullptr;
  }
  if (node.kind == YamlNode::Kind::empty) node.kind = YamlNode::Kind::map;
  if (YamlNode* child = node.find(key)) return child;
  YamlNode child;
  child.key = key;
  child.place = place;
  node.children.push_back(child);
  return &node.children.back();
}

void apply_setting(const std::string& setting, const Place& place, YamlNode& root,
                   ErrorList& errors) {
  const std::size_t equals = setting.find('=');
  const std::vector<std::string> keys = split_path(setting.substr(0, equals));
  const bool has_control_character = std::any_of(
      setting.begin(), setting.end(), [](char c) { return c >= 0 && (c < ' ' || c == '\x7f'); });
  if (equals == std::string::npos || keys.empty() || keys.size() > max_path_length ||
      has_control_character) {
    errors.add(place, "", "expected key=value in one line, e.g. blades.elements=8");
    return;
  }
  YamlNode value;
  try {
    value = parse_yaml(setting.substr(equals + 1));
  } catch (const YamlError& error) {
    errors.add(place, "", error.what());
    return;
  }
  YamlNode* node = &root;
  std::string where;
  for (const std::string& key : keys) {
    if (&key == &keys.back() && node->kind == YamlNode::Kind::map)
      remove_other_spellings(*node, key);
    node = enter(*node, key, where, place, errors);
    if (node == nullptr) return;
    where = join_path(where, key);
  }
  const std::string key = node->key;
  *node = value;
  node->key = key;
  mark_as_setting(*node, place.setting);
}

}  // namespace

void apply_settings(const std::vector<std::string>& settings, YamlNode& root, ErrorList& errors) {
  for (std::size_t i = 0; i < settings.size(); ++i) {
    apply_setting(settings[i], {0, 0, static_cast<int>(i)}, root, errors);
  }
}

}  // namespace samara::io
