// A YAML document as a tree with the places of all nodes. It is built from the parser's events,
// because the node tree of yaml-cpp drops duplicate keys and the places of keys.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace samara::io {

/// Place of a value: in the file, or in a --set argument.
struct Place {
  int line = 0;      ///< from 1; 0 = no line
  int column = 0;    ///< from 1
  int setting = -1;  ///< index of the --set argument, -1 = the file
};

struct YamlNode {
  enum class Kind { empty, scalar, list, map };

  Kind kind = Kind::empty;
  Place place;          ///< place of the key if the node is the value of one, else of the node
  std::string key;      ///< empty for the items of a list
  std::string text;     ///< text of a scalar
  bool quoted = false;  ///< a scalar in quotes is a text, even if it looks like a number
  std::vector<YamlNode> children;  ///< items or entries, duplicate keys included

  /// First entry with this key, or null.
  const YamlNode* find(std::string_view wanted) const;
  YamlNode* find(std::string_view wanted);
};

/// The text is not a single YAML document that is valid for a case file.
class YamlError : public std::runtime_error {
 public:
  YamlError(const Place& error_place, const std::string& what)
      : std::runtime_error(what), place(error_place) {}
  Place place;
};

/// Parses one document; aliases and merge keys (`<<`) are resolved. An empty document gives an
/// empty node. @throws YamlError
YamlNode parse_yaml(const std::string& text);

/// Sets the place of all nodes to the --set argument `setting`.
void mark_as_setting(YamlNode& node, int setting);

}  // namespace samara::io
