// A YAML document as a tree that remembers where everything stands. Built from the parser's events,
// since the node tree of yaml-cpp drops duplicate keys and the places of keys.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace samara::io {

/// Where something was given: in the file, or by the --set argument of that number.
struct Place {
  int line = 0;      ///< from 1; 0 = no line
  int column = 0;    ///< from 1
  int setting = -1;  ///< index of the --set argument, -1 = the file
};

struct YamlNode {
  enum class Kind { empty, scalar, list, map };

  Kind kind = Kind::empty;
  Place place;          ///< of the key where the node is the value of one, else of the node
  std::string key;      ///< empty for the items of a list
  std::string text;     ///< of a scalar
  bool quoted = false;  ///< a scalar in quotes is a text, whatever it looks like
  std::vector<YamlNode> children;  ///< items or entries, duplicate keys included

  /// First entry with this key, or null.
  const YamlNode* find(std::string_view wanted) const;
  YamlNode* find(std::string_view wanted);
};

/// The text is not one YAML document that a case file can be.
class YamlError : public std::runtime_error {
 public:
  YamlError(const Place& error_place, const std::string& what)
      : std::runtime_error(what), place(error_place) {}
  Place place;
};

/// Parses one document; aliases and merge keys (`<<`) are resolved. An empty document gives an
/// empty node. @throws YamlError
YamlNode parse_yaml(const std::string& text);

/// States in all nodes that they came from the --set argument `setting`.
void mark_as_setting(YamlNode& node, int setting);

}  // namespace samara::io
