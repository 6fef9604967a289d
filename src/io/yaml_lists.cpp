#include "yaml_lists.hpp"

#include <algorithm>

namespace samara::io {

const YamlNode* find_list(MapReader& map, std::string_view key, const std::string& items) {
  const YamlNode* list = map.find(key);
  if (list == nullptr) return nullptr;
  if (list->kind == YamlNode::Kind::list && !list->children.empty()) return list;
  const bool is_empty = list->kind == YamlNode::Kind::list;
  map.refuse(
      *list, key,
      "expected a list of " + items + ", " + (is_empty ? "got an empty one" : describe(*list)));
  return nullptr;
}

void read_words(MapReader& map, std::string_view key, std::vector<std::string>& words) {
  const YamlNode* list = find_list(map, key, "names");
  if (list == nullptr) return;
  for (const YamlNode& entry : list->children) {
    if (entry.kind != YamlNode::Kind::scalar)
      map.refuse(entry, key, "expected a name, " + describe(entry));
    else if (std::ranges::find(words, entry.text) != words.end())
      map.refuse(entry, key, "\"" + entry.text + "\" is given twice");
    words.push_back(entry.text);
  }
}

void read_numbers(MapReader& map, std::string_view key, const Range& range,
                  std::vector<double>& values, const std::string& items) {
  const YamlNode* list = find_list(map, key, items);
  if (list == nullptr) return;
  values.resize(list->children.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    read_number(list->children[i], join_path(map.where(key), i), range, values[i], map.errors());
}

}  // namespace samara::io
