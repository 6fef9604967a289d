// Fields are declared once, in functions declare(Visitor&, definition): whoever reads a case,
// checks ranges, writes a case or describes its keys is a visitor of them.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "samara/fields/field.hpp"
#include "samara/math/types.hpp"

namespace samara::fields {

/// A word that may stand in place of a number, and whether it does.
struct Word {
  const char* text;
  bool* is_given;
};

/// A column of a table of numbers.
struct Column {
  const char* name;  ///< as messages call it
  Unit unit;
  std::vector<double>* values;
};

/// "a number > 0", "a number > 0 or rigid", "a number > 0, rigid or free".
inline std::string join_words(std::string expected, const std::vector<std::string>& others) {
  for (std::size_t i = 0; i < others.size(); ++i)
    expected += (i + 1 == others.size() ? " or " : ", ") + others[i];
  return expected;
}
inline std::string join_words(std::string expected, std::span<const Word> words) {
  std::vector<std::string> others;
  for (const Word& word : words) others.emplace_back(word.text);
  return join_words(std::move(expected), others);
}

/// A mapping that may be left out.
struct Presence {
  std::function<bool()> is_there;
  std::function<void()> make;
  bool may_be_absent = true;  ///< false: leaving it out is the same as none of its keys
};

/// A list of mappings.
struct Items {
  const char* words;  ///< "sections": a list of ...
  std::size_t least;  ///< entries that it must have
  std::function<std::size_t()> size;
  std::function<void(std::size_t)> resize;
  std::function<void(std::size_t)> declare;  ///< the fields of an entry
};

/// Mappings by a number from 1.
struct Numbered {
  const char* words;  ///< "blade number"
  int count;
  std::function<bool(int)> is_there;
  std::function<void(int)> declare;  ///< the fields of one; makes it where it is not there
};

/// Mappings by names that the user chooses.
struct Named {
  const char* words;  ///< "channels, e.g. ..."
  std::function<std::vector<std::string>()> names;
  std::function<void(const std::string&)> declare;  ///< the fields of one; makes it
};

/// Numbers are passed in SI and radians; a visitor converts by the unit of the field.
class Visitor {
 public:
  virtual ~Visitor() = default;

  // ---- what a visitor is -----------------------------------------------------------------------

  /// It gives the values.
  virtual bool reads() const { return false; }
  /// It wants all fields that could be, whatever the values.
  virtual bool describes() const { return false; }
  /// All ways to state a thing, not the one that suits its value.
  bool wants_all() const { return reads() || describes(); }
  /// Which of two spellings states a number.
  virtual const Field& spelling(const Field& field, const Field&, double) { return field; }
  /// The mapping that is read has this key.
  virtual bool given(std::string_view) const { return false; }

  // ---- values ----------------------------------------------------------------------------------

  /// A number, or one of the words. The flags of words are set, too.
  virtual void number(const Field& field, double& value, std::span<const Word> words) = 0;
  virtual void integer(const Field& field, int& value, std::span<const Word> words) = 0;
  /// As many integers as there are values, or one that holds for all.
  virtual void integers(const Field& field, std::span<int> values) = 0;
  /// As many numbers as there are values; with `spread` also one that holds for all, or one of the
  /// words.
  virtual void numbers(const Field& field, std::span<double> values, bool spread,
                       std::span<const Word> words) = 0;
  /// One number or more; `items` says of what.
  virtual void number_list(const Field& field, const char* items, std::vector<double>& values) = 0;
  virtual void name_list(const Field& field, std::vector<std::string>& names) = 0;
  /// [[x, y], ...] with rising x; `names` are the words for x and y.
  virtual void pairs(const Field& field, const std::array<const char*, 2>& names,
                     std::vector<std::pair<double, double>>& pairs) = 0;
  /// Rows of numbers, one for each column.
  virtual void table(const Field& field, std::span<const Column> columns) = 0;
  /// Any text; `expected` says which.
  /// False: it is left out, or no text.
  virtual bool text(const Field& field, const char* expected, std::string& value) = 0;
  /// One of the words, by its place among them. False: the place is not known.
  virtual bool choice(const Field& field, std::span<const char* const> words,
                      std::size_t& place) = 0;
  /// 6 rows of 6; where `rigid` is given that word may stand on the diagonal.
  virtual void matrix(const Field& field, Matrix6& matrix, std::array<bool, 6>* rigid) = 0;
  /// Two points or more; memory has `to_a` times the components of the file.
  virtual void points(const Field& field, const Matrix3& to_a, std::vector<Vector3>& points) = 0;

  // ---- structure -------------------------------------------------------------------------------

  virtual void block(const Field& field, const Presence& presence,
                     const std::function<void()>& inside) = 0;
  virtual void list(const Field& field, const Items& items) = 0;
  virtual void numbered(const Field& field, const Numbered& entries) = 0;
  virtual void named(const Field& field, const Named& entries) = 0;
  /// A key that is a mapping, called `words`, or something else. Both ways name it once more.
  virtual void two_ways(const Field& field, const char* words, const std::function<void()>& plain,
                        const std::function<void()>& mapping) = 0;

  // ---- rules of a mapping ----------------------------------------------------------------------

  using Keys = std::initializer_list<const char*>;
  /// Keys of one group only; declared before the fields.
  virtual void exclusive(std::initializer_list<Keys>) {}
  /// The first key is compulsory where there is none of the others.
  virtual void at_least_one(Keys, const char* hint [[maybe_unused]]) {}
  /// A key of older files, and where it went.
  virtual void retired(std::string_view, const char* where_it_went [[maybe_unused]]) {}
  /// Keys that are known, and of no use here.
  virtual void accept(Keys) {}
  /// A key is compulsory after all; says so of whoever reads.
  virtual void require(std::string_view, const char* hint [[maybe_unused]]) {}
  /// The value of a key that was given is wrong; an empty key is the mapping itself.
  virtual void refuse(std::string_view, const std::string& text [[maybe_unused]]) {}
  /// The same of a value that should be something else.
  virtual void expected(std::string_view, const std::string& words [[maybe_unused]]) {}

  // ---- the same in other types -----------------------------------------------------------------

  void number(const Field& field, double& value, std::initializer_list<Word> words = {}) {
    number(field, value, std::span<const Word>(words.begin(), words.size()));
  }
  void number(const Field& field, std::optional<double>& value);
  void integer(const Field& field, int& value, std::initializer_list<Word> words = {}) {
    integer(field, value, std::span<const Word>(words.begin(), words.size()));
  }
  void numbers(const Field& field, std::span<double> values, bool spread,
               std::initializer_list<Word> words = {}) {
    numbers(field, values, spread, std::span<const Word>(words.begin(), words.size()));
  }
  void table(const Field& field, std::initializer_list<Column> columns) {
    table(field, std::span<const Column>(columns.begin(), columns.size()));
  }
  void vector(const Field& field, Vector3& value) {
    numbers(field, std::span<double>(value.data(), 3), false);
  }
  /// A number that has two spellings, each in its own unit.
  template <class Number>
  void number(const Field& field, const Field& other, Number& value) {
    exclusive({{field.key.data()}, {other.key.data()}});
    if (wants_all()) {
      number(field, value);
      number(other, value);
    } else if (const std::optional<double> shown = value) {
      number(spelling(field, other, *shown), value);
    }
  }

  template <class Choice>
  bool choice(const Field& field, Choice& value,
              std::initializer_list<std::pair<const char*, Choice>> choices) {
    std::vector<const char*> words;
    std::size_t place = choices.size();
    for (const auto& [word, one] : choices) {
      if (one == value) place = words.size();
      words.push_back(word);
    }
    if (!choice(field, std::span<const char* const>(words), place) || place >= choices.size())
      return false;
    value = choices.begin()[place].second;
    return true;
  }
  bool flag(const Field& field, bool& value) {
    return choice(field, value, {{"true", true}, {"false", false}});
  }

  /// A mapping that is always there.
  void block(const Field& field, const std::function<void()>& inside) {
    block(field, Presence{[] { return true; }, [] {}, false}, inside);
  }
  void block(const Field& field, bool& is_there, const std::function<void()>& inside) {
    block(field, Presence{[&is_there] { return is_there; }, [&is_there] { is_there = true; }},
          inside);
  }
  template <class Definition, class Inside>
  void block(const Field& field, std::optional<Definition>& definition, const Inside& inside) {
    std::optional<Definition> shown;  // of a description
    block(field,
          Presence{[&definition] { return definition.has_value(); },
                   [&definition] { definition.emplace(); }},
          [&] { inside(definition ? *definition : shown.emplace()); });
  }

  template <class Definition, class Declare>
  void list(const Field& field, const char* words, std::size_t least,
            std::vector<Definition>& entries, const Declare& declare) {
    Definition shown{};  // of a description
    list(field, Items{words, least, [&entries] { return entries.size(); },
                      [&entries](std::size_t size) { entries.resize(size); },
                      [&](std::size_t i) { declare(i < entries.size() ? entries[i] : shown); }});
  }
  template <class Definition, class Declare>
  void numbered(const Field& field, const char* words, int count,
                std::map<int, Definition>& entries, const Declare& declare) {
    numbered(field, Numbered{words, count, [&entries](int k) { return entries.count(k) > 0; },
                             [&](int k) { declare(entries[k]); }});
  }
  template <class Definition, class Declare>
  void named(const Field& field, const char* words, std::map<std::string, Definition>& entries,
             const Declare& declare) {
    Definition shown{};  // of a description
    named(field,
          Named{words,
                [&entries] {
                  std::vector<std::string> names;
                  for (const auto& [name, entry] : entries) names.push_back(name);
                  return names;
                },
                [&](const std::string& name) { declare(name.empty() ? shown : entries[name]); }});
  }
};

inline void Visitor::number(const Field& field, std::optional<double>& value) {
  constexpr double none = std::numeric_limits<double>::infinity();
  double number_or_none = value.value_or(none);
  number(field.none_at_infinity(field.fallback), number_or_none);
  if (number_or_none != none) value = number_or_none;
}

}  // namespace samara::fields
