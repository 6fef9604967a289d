#include "samara/io/case_numbers.hpp"

#include <sstream>

#include "samara/base/error.hpp"
#include "samara/base/number.hpp"
#include "samara/base/words.hpp"
#include "samara/io/yaml_tree.hpp"

#include "yaml_reader.hpp"
#include "yaml_settings.hpp"

namespace samara::io {
namespace {

constexpr char every[] = "*";

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
    if (is_found || !hint_.empty()) return;
    hint_ = names.empty() ? (key.empty() ? "the case" : key) + " has no keys"
                          : (key.empty() ? "" : key + ": ") + "no \"" + words_[depth] + "\"" +
                                suggest(words_[depth], names);
  }

  const std::string& hint() const { return hint_; }

 private:
  std::vector<std::string> words_;
  std::vector<CaseNumber>& numbers_;
  std::string hint_;  ///< where the search ended first
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
