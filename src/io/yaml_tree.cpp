#include "samara/io/yaml_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

namespace samara::io {
namespace {

constexpr std::size_t max_depth = 64;
/// Most values that aliases add, that anchors keep for them, and of a whole file: 16 MB of text can
/// expand to gigabytes.
constexpr std::size_t max_alias_nodes = 200000;
constexpr std::size_t max_anchor_nodes = 1000000;
constexpr std::size_t max_nodes = 4000000;

Place to_place(const YAML::Mark& mark) {
  if (mark.is_null()) return {};
  return {mark.line + 1, mark.column + 1, -1};
}

std::size_t count_nodes(const YamlNode& node) {
  std::size_t count = 1;
  for (const YamlNode& child : node.children) count += count_nodes(child);
  return count;
}

/// Adds the entries of the merge key `<<` to the map, except those that the map itself has.
void resolve_merge_key(YamlNode& map) {
  const auto merge = std::find_if(map.children.begin(), map.children.end(),
                                  [](const YamlNode& child) { return child.key == "<<"; });
  if (merge == map.children.end()) return;
  const YamlNode source = *merge;
  map.children.erase(merge);
  const bool is_list = source.kind == YamlNode::Kind::list;
  const std::vector<YamlNode> maps = is_list ? source.children : std::vector<YamlNode>{source};
  std::set<std::string, std::less<>> own;
  for (const YamlNode& child : map.children) own.insert(child.key);
  for (const YamlNode& other : maps) {
    if (other.kind != YamlNode::Kind::map) {
      throw YamlError(source.place, "the merge key << needs a mapping, or a list of mappings");
    }
    for (const YamlNode& child : other.children) {
      if (own.insert(child.key).second) map.children.push_back(child);
    }
  }
}

/// Refuses bytes that the YAML parser would misread silently: it takes 0x04 for the end of the
/// file.
void require_utf8_text(const std::string& text) {
  Place place{1, 1, -1};
  std::size_t i = 0;
  const auto byte_at = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  while (i < text.size()) {
    const unsigned char byte = byte_at(i);
    if ((byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') || byte == 0x7f) {
      throw YamlError(place, "a control character: this is not a text file");
    }
    const std::size_t length = byte < 0x80                    ? 1
                               : byte >= 0xc2 && byte <= 0xdf ? 2
                               : byte >= 0xe0 && byte <= 0xef ? 3
                               : byte >= 0xf0 && byte <= 0xf4 ? 4
                                                              : 0;
    bool valid = length > 0 && i + length <= text.size();
    for (std::size_t k = 1; valid && k < length; ++k) valid = (byte_at(i + k) & 0xc0) == 0x80;
    if (!valid) throw YamlError(place, "a byte that is not UTF-8: this is not a text file");
    i += length;
    ++place.column;
    if (byte == '\n') place = {place.line + 1, 1, -1};
  }
}

class TreeBuilder final : public YAML::EventHandler {
 public:
  YamlNode take_root() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    finish(start(YamlNode::Kind::empty, mark), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto original = anchors_.find(anchor);
    if (original == anchors_.end()) {
      throw YamlError(to_place(mark), "an alias that refers to itself");
    }
    alias_nodes_ += count_nodes(original->second);
    if (alias_nodes_ > max_alias_nodes) {
      throw YamlError(to_place(mark), "the aliases expand to too many values");
    }
    YamlNode copy = original->second;
    copy.place = to_place(mark);
    copy.key.clear();
    finish(std::move(copy), YAML::NullAnchor);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    YamlNode node = start(YamlNode::Kind::scalar, mark);
    node.text = value;
    node.quoted = tag == "!" || tag == "tag:yaml.org,2002:str";
    finish(std::move(node), anchor);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(start(YamlNode::Kind::list, mark), anchor);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(start(YamlNode::Kind::map, mark), anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Frame {
    YamlNode node;
    YAML::anchor_t anchor = YAML::NullAnchor;
    bool has_key = false;
    YamlNode key;
  };

  static YamlNode start(YamlNode::Kind kind, const YAML::Mark& mark) {
    YamlNode node;
    node.kind = kind;
    node.place = to_place(mark);
    return node;
  }

  void open(YamlNode node, YAML::anchor_t anchor) {
    if (open_.size() >= max_depth) throw YamlError(node.place, "nested too deeply");
    open_.push_back({std::move(node), anchor, false, {}});
  }

  void close() {
    Frame frame = std::move(open_.back());
    open_.pop_back();
    if (frame.node.kind == YamlNode::Kind::map) resolve_merge_key(frame.node);
    finish(std::move(frame.node), frame.anchor);
  }

  /// Passes a complete node to the enclosing node.
  void finish(YamlNode node, YAML::anchor_t anchor) {
    if (++nodes_ > max_nodes) throw YamlError(node.place, "more than 4 million values");
    if (anchor != YAML::NullAnchor) {
      anchor_nodes_ += count_nodes(node);
      if (anchor_nodes_ > max_anchor_nodes)
        throw YamlError(node.place, "the anchors hold too many values");
      anchors_[anchor] = node;
    }
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    Frame& frame = open_.back();
    if (frame.node.kind == YamlNode::Kind::map && !frame.has_key) {
      if (node.kind != YamlNode::Kind::scalar) {
        throw YamlError(node.place, "a key must be a plain word");
      }
      frame.key = std::move(node);
      frame.has_key = true;
      return;
    }
    if (frame.has_key) {
      node.key = frame.key.text;
      node.place = frame.key.place;
      frame.has_key = false;
    }
    frame.node.children.push_back(std::move(node));
  }

  YamlNode root_;
  std::vector<Frame> open_;
  std::map<YAML::anchor_t, YamlNode> anchors_;
  std::size_t alias_nodes_ = 0;
  std::size_t anchor_nodes_ = 0;
  std::size_t nodes_ = 0;
};

/// Adds a hint to a message of the parser.
std::string explain(const std::string& message) {
  const std::pair<const char*, const char*> hints[] = {
      {YAML::ErrorMsg::MAP_VALUE,
       "check the indentation; a text that holds \": \" needs quotes; tabs cannot indent"},
      {YAML::ErrorMsg::END_OF_MAP, "check the indentation of this line and the ones before"},
      {YAML::ErrorMsg::END_OF_SEQ, "check the indentation of this line and the ones before"},
      {YAML::ErrorMsg::END_OF_MAP_FLOW, "a \"{\" is not closed, or a comma is missing"},
      {YAML::ErrorMsg::END_OF_SEQ_FLOW, "a \"[\" is not closed, or a comma is missing"},
      {YAML::ErrorMsg::FLOW_END, "a closing bracket without its opening one"},
      {YAML::ErrorMsg::UNKNOWN_TOKEN,
       "a character that YAML reserves, or a tab: put texts in quotes"},
  };
  for (const auto& [known, hint] : hints) {
    if (message == known) return "not valid YAML: " + message + " (" + hint + ")";
  }
  return "not valid YAML: " + message;
}

}  // namespace

const YamlNode* YamlNode::find(std::string_view wanted) const {
  if (kind != Kind::map) return nullptr;
  const auto child = std::find_if(children.begin(), children.end(),
                                  [&](const YamlNode& entry) { return entry.key == wanted; });
  return child == children.end() ? nullptr : &*child;
}

YamlNode* YamlNode::find(std::string_view wanted) {
  return const_cast<YamlNode*>(std::as_const(*this).find(wanted));
}

YamlNode parse_yaml(const std::string& text) {
  require_utf8_text(text);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    TreeBuilder builder;
    if (!parser.HandleNextDocument(builder)) return {};
    TreeBuilder rest;
    if (parser.HandleNextDocument(rest)) {
      throw YamlError({}, "more than one YAML document (\"---\") in the file");
    }
    return builder.take_root();
  } catch (const YAML::DeepRecursion&) {
    throw YamlError({}, "not valid YAML: nested too deeply");
  } catch (const YAML::Exception& error) {
    throw YamlError(to_place(error.mark), explain(error.msg));
  }
}

void mark_as_setting(YamlNode& node, int setting) {
  node.place = {0, 0, setting};
  for (YamlNode& child : node.children) mark_as_setting(child, setting);
}

}  // namespace samara::io
