#include "case_polars.hpp"

#include <filesystem>
#include <map>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/fields/field.hpp"
#include "samara/io/case_text.hpp"
#include "samara/io/polar_file.hpp"
#include "samara/io/whole_file.hpp"

namespace samara::io {
namespace {

using model::PolarDefinition;

/// Rows of all polars of a case: each is kept as text, too.
constexpr std::size_t most_rows = 200000;

YamlNode make_node(YamlNode::Kind kind, const Place& place, std::string key = {}) {
  YamlNode node;
  node.kind = kind;
  node.place = place;
  node.key = std::move(key);
  return node;
}

YamlNode make_number(std::string text, const Place& place, std::string key = {}) {
  YamlNode node = make_node(YamlNode::Kind::scalar, place, std::move(key));
  node.text = std::move(text);
  return node;
}

YamlNode make_polar(const PolarDefinition& polar, const Place& place) {
  YamlNode node = make_node(YamlNode::Kind::map, place);
  if (polar.reynolds != 0.0)
    node.children.push_back(make_number(exact(polar.reynolds), place, "reynolds"));
  YamlNode& table = node.children.emplace_back(make_node(YamlNode::Kind::list, place, "table"));
  for (std::size_t i = 0; i < polar.angles.size(); ++i) {
    YamlNode& row = table.children.emplace_back(make_node(YamlNode::Kind::list, place));
    row.children.push_back(make_number(exact_in(fields::deg, polar.angles[i]), place));
    for (const std::vector<double>* values : {&polar.lift, &polar.drag, &polar.moment})
      row.children.push_back(make_number(exact((*values)[i]), place));
  }
  return node;
}

/// The node as YAML in one line.
std::string flow_text(const YamlNode& node) {
  if (node.kind == YamlNode::Kind::scalar) return node.text;
  const bool is_map = node.kind == YamlNode::Kind::map;
  std::string text(1, is_map ? '{' : '[');
  for (const YamlNode& child : node.children) {
    if (text.size() > 1) text += ", ";
    if (is_map) text += child.key + ": ";
    text += flow_text(child);
  }
  return text + (is_map ? '}' : ']');
}

class PolarEmbedding {
 public:
  PolarEmbedding(const std::string& case_path, ErrorList& errors)
      : folder_(folder_of(case_path)), errors_(errors) {}

  void embed(YamlNode& airfoil) {
    YamlNode* file = airfoil.find("file");
    if (file == nullptr || file->kind != YamlNode::Kind::scalar ||
        airfoil.find("polars") != nullptr)
      return;
    const std::string where = "blades.airfoils." + airfoil.key;
    try {
      const std::vector<PolarDefinition>& polars = read((folder_ / file->text).string());
      for (const PolarDefinition& polar : polars) rows_ += polar.angles.size();
      if (rows_ > most_rows)
        throw InputError("the polars of the case have more than " + std::to_string(most_rows) +
                         " rows");
      YamlNode list = make_node(YamlNode::Kind::list, file->place, "polars");
      for (const PolarDefinition& polar : polars)
        list.children.push_back(make_polar(polar, file->place));
      *file = std::move(list);
      settings_.push_back(where + ".polars=" + flow_text(*file));
    } catch (const InputError& error) {
      errors_.add(file->place, where + ".file", error.what(), where);
    }
  }

  std::vector<std::string> take_settings() { return std::move(settings_); }

 private:
  const std::vector<PolarDefinition>& read(const std::string& path) {
    const auto known = known_.find(path);
    return known != known_.end() ? known->second : known_[path] = read_polar_file(path);
  }

  std::filesystem::path folder_;
  ErrorList& errors_;
  std::map<std::string, std::vector<PolarDefinition>> known_;
  std::size_t rows_ = 0;
  std::vector<std::string> settings_;
};

}  // namespace

std::vector<std::string> embed_polars(const std::string& case_path, YamlNode& root,
                                      ErrorList& errors) {
  PolarEmbedding embedding(case_path, errors);
  YamlNode* blades = root.find("blades");
  YamlNode* airfoils = blades == nullptr ? nullptr : blades->find("airfoils");
  if (airfoils == nullptr || airfoils->kind != YamlNode::Kind::map) return {};
  for (YamlNode& airfoil : airfoils->children)
    if (airfoil.kind == YamlNode::Kind::map) embedding.embed(airfoil);
  return embedding.take_settings();
}

}  // namespace samara::io
