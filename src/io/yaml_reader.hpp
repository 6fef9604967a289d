// Reads checked values from a YAML tree and collects all its errors.
#pragma once

#include <array>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "samara/base/fault.hpp"
#include "samara/fields/ranges.hpp"
#include "samara/io/yaml_tree.hpp"
#include "samara/math/types.hpp"

namespace samara::io {

/// All errors of a case, in the order of the file.
class ErrorList {
 public:
  ErrorList(std::string path, std::vector<std::string> settings)
      : path_(std::move(path)), settings_(std::move(settings)) {}

  /// `where` is the path of the key (`shaft.speed`); empty if `what` is complete.
  void add(const Place& place, const std::string& where, const std::string& what) {
    add(place, where, what, where);
  }
  /// `mapping`: path of the key or mapping that was read with this error.
  void add(const Place& place, const std::string& where, const std::string& what,
           const std::string& mapping);
  /// Adds faults of fields, at their places in `root`; fields that were read with errors get none.
  void add(const std::vector<Fault>& faults, const YamlNode& root);
  /// Adds notes on fields that are no errors, but lack their apparent effect.
  void note(const std::vector<Fault>& notes, const YamlNode& root);
  const std::vector<std::string>& notes() const { return notes_; }
  std::size_t size() const { return errors_.size(); }

  /// @throws InputError with one error per line, if there are any.
  void throw_if_any() const;

 private:
  struct Error {
    Place place;
    std::string where;
    std::string message;
  };
  bool has_error_at(const std::string& field) const;
  std::string compose(const Place& place, const std::string& where, const std::string& what) const;

  std::string path_;
  std::vector<std::string> settings_;
  std::vector<Error> errors_;
  std::vector<std::string> notes_;
};

using fields::join_path;
using fields::Range;

/// Describes the given value, for the end of a message: `got "fast"`.
std::string describe(const YamlNode& node);

/// Place of an error in a value made of several: the last --set argument in it, else its own place.
Place find_blame(const YamlNode& node);

/// These leave `value` unchanged and add an error if the node does not follow the rule.
bool read_number(const YamlNode& node, const std::string& where, const Range& range, double& value,
                 ErrorList& errors);
/// `others`: other accepted words, in the form of the message: " or auto".
bool read_integer(const YamlNode& node, const std::string& where, int low, int high,
                  const std::string& others, int& value, ErrorList& errors);
bool read_numbers(const YamlNode& node, const std::string& where, const Range& range,
                  std::span<double> values, ErrorList& errors);

/// Reads the entries of one mapping. The requested keys are the known keys, so every key must be
/// requested, whatever the values of the others; finish() then reports the unknown keys.
class MapReader {
 public:
  MapReader(const YamlNode& node, std::string where, ErrorList& errors);

  const YamlNode& node() const { return node_; }
  const std::string& where() const { return where_; }
  std::string where(std::string_view key) const { return join_path(where_, key); }
  ErrorList& errors() const { return errors_; }

  /// The entry, or null if it is left out.
  const YamlNode* find(std::string_view key);
  /// The same for a compulsory key; `hint` is added to the message if it is missing.
  const YamlNode* require(std::string_view key, std::string_view hint = {});

  /// True if no compulsory key was missing so far; finish() reports missing keys.
  bool is_complete() const { return missing_.empty(); }

  /// Adds an error about the value of an entry.
  void refuse(const YamlNode& entry, std::string_view key, const std::string& what) const;
  /// The same for a value that is not one of the words.
  void refuse_word(const YamlNode& entry, std::string_view key,
                   const std::vector<std::string>& words) const;

  /// Reports unknown and missing keys. Call it last.
  void finish();

 private:
  /// Reports an unknown key; returns the known one it resembles.
  std::string report_unknown(const YamlNode& entry) const;

  struct Missing {
    std::string key;
    std::string hint;
  };
  const YamlNode& node_;
  std::string where_;
  ErrorList& errors_;
  std::vector<std::string> known_;
  std::vector<Missing> missing_;
};

/// Reads [[x, y], ...] with rising x; `names` are the names of x and y in messages.
void read_pairs(MapReader& map, std::string_view key, const YamlNode& node,
                const std::array<const char*, 2>& names,
                std::vector<std::pair<double, double>>& pairs);

}  // namespace samara::io
