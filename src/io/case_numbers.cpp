#include "samara/io/case_numbers.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/base/number.hpp"
#include "samara/base/words.hpp"
#include "samara/io/yaml_tree.hpp"

#include "yaml_reader.hpp"
#include "yaml_settings.hpp"

namespace samara::io {
namespace {

constexpr char every[] = "*";
constexpr char matrix_key[] = "stiffness_matrix";

std::string name_of(const YamlNode& parent, std::size_t child) {
  return parent.kind == YamlNode::Kind::list ? std::to_string(child) : parent.children[child].key;
}

/// Adds the numbers of a node and of all below it.
void add_numbers(const YamlNode& node, const std::string& key, std::vector<CaseNumber>& numbers) {
  if (node.kind == YamlNode::Kind::scalar && !node.quoted)
    if (const std::optional<double> value = parse_number(node.text))
      numbers.push_back({key, *value});
  for (std::size_t i = 0; i < node.children.size(); ++i)
    add_numbers(node.children[i], join_path(key, name_of(node, i)), numbers);
}

/// Keys below a node whose name begins with a word, in upper or lower case, each once: as they
/// follow the key of the node, with every item of a list as `*`. Below a key that is found, none.
void add_beginning(const YamlNode& node, const std::string& key, const std::string& word,
                   std::vector<std::string>& found) {
  for (const YamlNode& child : node.children) {
    const bool is_item = node.kind == YamlNode::Kind::list;
    const std::string path = join_path(key, is_item ? every : child.key);
    if (is_item || !to_lower(child.key).starts_with(word))
      add_beginning(child, path, word, found);
    else if (std::ranges::find(found, path) == found.end())
      found.push_back(path);
  }
}

/// The entries of a 6 x 6 matrix of stiffness that are known by names.
constexpr std::array<std::pair<std::string_view, int>, 6> entries_of_matrix{
    {{"ea", 0}, {"ga2", 1}, {"ga3", 2}, {"gj", 3}, {"ei2", 4}, {"ei3", 5}}};

/// `; did you mean "stiffness.EI2" or "stiffness.EI3"?`, or the most similar of the names.
std::string suggest_below(const YamlNode& node, const std::string& word,
                          const std::vector<std::string>& names) {
  constexpr std::size_t least_letters = 2;
  constexpr std::size_t most_keys = 4;
  std::vector<std::string> found;
  for (const std::string& name : names)
    if (to_lower(name).starts_with(to_lower(word))) found.push_back(name);
  if (word.size() >= least_letters && found.empty()) add_beginning(node, "", to_lower(word), found);
  if (word.size() >= least_letters && found.empty() && node.find(matrix_key) != nullptr)
    for (const auto& [name, row] : entries_of_matrix)
      if (name.starts_with(to_lower(word))) {
        const std::string number = std::to_string(row);
        found.push_back(join_path(matrix_key, join_path(number, number)));
      }
  if (found.empty() || word.size() < least_letters) return suggest(word, names);
  found.resize(std::min(found.size(), most_keys));
  std::string text;
  for (std::size_t i = 0; i < found.size(); ++i)
    text += (i == 0 ? "" : i + 1 < found.size() ? ", " : " or ") + ("\"" + found[i] + "\"");
  return "; did you mean " + text + "?";
}

class Search {
 public:
  Search(std::vector<std::string> words, std::vector<CaseNumber>& numbers)
      : words_(std::move(words)), numbers_(numbers) {}

  void visit(const YamlNode& node, const std::string& key, std::size_t depth) {
    if (depth == words_.size()) return add_numbers(node, key, numbers_);
    std::vector<std::string> names;
    bool is_found = false;
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      names.push_back(name_of(node, i));
      if (words_[depth] != every && words_[depth] != names.back()) continue;
      is_found = true;
      visit(node.children[i], join_path(key, names.back()), depth + 1);
    }
    if (is_found || (!hint_.empty() && depth <= deepest_)) return;
    deepest_ = depth;
    hint_ = names.empty() ? (key.empty() ? "the case" : key) + " has no keys"
                          : (key.empty() ? "" : key + ": ") + "no \"" + words_[depth] + "\"" +
                                suggest_below(node, words_[depth], names);
  }

  const std::string& hint() const { return hint_; }

 private:
  std::vector<std::string> words_;
  std::vector<CaseNumber>& numbers_;
  std::string hint_;  ///< where the search ended, first among the deepest places
  std::size_t deepest_ = 0;
};

}  // namespace

std::vector<CaseNumber> find_numbers(const Case& input, const std::string& pattern) {
  YamlNode root = parse_yaml(input.file_text());
  ErrorList errors(input.path, input.settings);
  apply_settings(input.settings, root, errors);
  std::vector<std::string> words;
  std::istringstream stream(pattern);
  for (std::string word; std::getline(stream, word, '.');) words.push_back(word);
  std::vector<CaseNumber> numbers;
  Search search(words, numbers);
  search.visit(root, "", 0);
  if (numbers.empty())
    throw InputError(pattern + ": " + (search.hint().empty() ? "no number there" : search.hint()) +
                     "; hint: a key that the case has, or --set gives it its default");
  return numbers;
}

}  // namespace samara::io
