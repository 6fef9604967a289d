// Reads checked values out of a YAML tree and gathers everything that is wrong with it.
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
#include "samara/io/yaml_tree.hpp"
#include "samara/math/types.hpp"

namespace samara::io {

/// All errors of a case, in the order of the file.
class ErrorList {
 public:
  ErrorList(std::string path, std::vector<std::string> settings)
      : path_(std::move(path)), settings_(std::move(settings)) {}

  /// `where` is the path of the key (`shaft.speed`); empty where `what` says it all.
  void add(const Place& place, const std::string& where, const std::string& what);
  /// Faults of fields, at their places in `root`; what was read with errors has enough of them.
  void add(const std::vector<Fault>& faults, const YamlNode& root);
  /// What is no error, but has not the effect that it seems to have.
  void note(const Place& place, const std::string& where, const std::string& what);
  const std::vector<std::string>& notes() const { return notes_; }
  std::size_t size() const { return errors_.size(); }

  /// @throws InputError with one error a line, if there are any.
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

/// Which numbers are accepted, and how to say so.
struct NumberRule {
  const char* words;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool open = false;  ///< the limits themselves are refused
};

inline constexpr NumberRule any_number{"a finite number"};
inline constexpr NumberRule positive{"a number > 0", 0.0, std::numeric_limits<double>::infinity(),
                                     true};
inline constexpr NumberRule non_negative{"a number >= 0", 0.0};
/// Beyond it nothing converges; below it rounding decides.
inline constexpr NumberRule tolerance{"a number from 1e-14 to 1e-3", 1e-14, 1e-3};
inline constexpr NumberRule fraction_of_one{"a number from 0 to 1", 0.0, 1.0};
inline constexpr NumberRule quarter_turn{"an angle between -90 and 90 degrees", -90.0, 90.0, true};
inline constexpr NumberRule half_turn{"an angle from -180 to 180 degrees", -180.0, 180.0};

std::string join_path(const std::string& where, std::string_view key);
std::string join_path(const std::string& where, std::size_t index);

/// Says what was given, for the end of a message: `got "fast"`.
std::string describe(const YamlNode& node);

/// The place to blame for a value made of several: the last --set argument in it, else its own.
Place find_blame(const YamlNode& node);

/// These leave `value` alone and add an error where the node is not what the rule asks for.
bool read_number(const YamlNode& node, const std::string& where, const NumberRule& rule,
                 double& value, ErrorList& errors);
bool read_numbers(const YamlNode& node, const std::string& where, const NumberRule& rule,
                  std::span<double> values, ErrorList& errors);

/// Reads the entries of one mapping. The keys that are asked for are the keys that are known, so
/// every key must be asked for whatever the others say; finish() then reports the rest.
class MapReader {
 public:
  MapReader(const YamlNode& node, std::string where, ErrorList& errors);

  const YamlNode& node() const { return node_; }
  const std::string& where() const { return where_; }
  std::string where(std::string_view key) const { return join_path(where_, key); }
  ErrorList& errors() const { return errors_; }

  /// The entry, or null where it is left out.
  const YamlNode* find(std::string_view key);
  /// The same for a compulsory key; `hint` is added to the message where it is missing.
  const YamlNode* require(std::string_view key, std::string_view hint = {});

  /// Whether no compulsory key was missing so far; finish() reports those that are.
  bool is_complete() const { return missing_.empty(); }

  /// Optional values: false, and `value` untouched, where the key is left out or wrong.
  bool read(std::string_view key, double& value, const NumberRule& rule);
  bool read(std::string_view key, int& value, int low, int high);
  bool read(std::string_view key, std::span<double> values, const NumberRule& rule);

  template <class Choice>
  bool read(std::string_view key, Choice& value,
            std::initializer_list<std::pair<const char*, Choice>> choices) {
    const YamlNode* entry = find(key);
    if (entry == nullptr) return false;
    std::vector<std::string> words;
    for (const auto& [word, choice] : choices) {
      if (entry->kind == YamlNode::Kind::scalar && entry->text == word) {
        value = choice;
        return true;
      }
      words.emplace_back(word);
    }
    refuse_word(*entry, key, words);
    return false;
  }

  /// Adds an error about the value of an entry.
  void refuse(const YamlNode& entry, std::string_view key, const std::string& what) const;
  /// Adds a note about it.
  void note(const YamlNode& entry, std::string_view key, const std::string& what) const;

  /// Reports unknown and missing keys. Call it last.
  void finish();

 private:
  void refuse_word(const YamlNode& entry, std::string_view key,
                   const std::vector<std::string>& words) const;
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

/// Reads an angle key in degrees into radians.
void read_angle(MapReader& map, std::string_view key, double& angle, const NumberRule& rule);

/// Reads [[x, y], ...] with rising x, of which `names` are the words.
void read_pairs(MapReader& map, std::string_view key, const YamlNode& node,
                const std::array<const char*, 2>& names,
                std::vector<std::pair<double, double>>& pairs);

void read_vector(MapReader& map, std::string_view key, Vector3& vector, const NumberRule& rule);

}  // namespace samara::io
