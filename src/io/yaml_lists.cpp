#include "yaml_lists.hpp"

namespace samara::io {

void read_words(MapReader& map, std::string_view key, std::vector<std::string>& words) {
  const YamlNode* list = map.find(key);
  if (list == nullptr) return;
  if (list->kind != YamlNode::Kind::list || list->children.empty()) {
    map.refuse(*list, key, "expected a list of names, " + describe(*list));
    return;
  }
  for (const YamlNode& entry : list->children) {
    if (entry.kind != YamlNode::Kind::scalar)
      map.refuse(entry, key, "expected a name, " + describe(entry));
    words.push_back(entry.text);
  }
}

void read_stations(MapReader& map, std::string_view key, std::vector<double>& places) {
  const YamlNode* list = map.find(key);
  if (list == nullptr) return;
  if (list->kind != YamlNode::Kind::list || list->children.empty()) {
    map.refuse(*list, key, "expected a list of fractions of the length, " + describe(*list));
    return;
  }
  places.resize(list->children.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    read_number(list->children[i], join_path(map.where(key), i), fraction_of_one, places[i],
                map.errors());
}

}  // namespace samara::io
