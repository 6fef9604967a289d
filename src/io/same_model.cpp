#include "samara/io/same_model.hpp"

#include <algorithm>
#include <sstream>

#include "samara/base/error.hpp"

namespace samara::io {
namespace {

/// Whether a key begins with `start`, up to the end of a name.
bool is_below(std::string_view key, std::string_view start) {
  constexpr std::string_view ends = "._[";
  return key.starts_with(start) &&
         (key.size() == start.size() || ends.find(key[start.size()]) != std::string_view::npos);
}

bool is_free(std::string_view key, std::string_view free) {
  const std::size_t star = free.find('*');
  if (star == std::string_view::npos) return is_below(key, free);
  if (!key.starts_with(free.substr(0, star))) return false;
  const std::size_t end = key.find('.', star);
  return end != std::string_view::npos && is_below(key.substr(end), free.substr(star + 1));
}

}  // namespace

ModelKeys model_keys(const std::string& text) {
  ModelKeys keys;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t end = line.find(": ");
    keys[line.substr(0, end)] = end == std::string::npos ? "" : line.substr(end + 2);
  }
  return keys;
}

void require_same_model(const std::string& path, const std::string& there, const std::string& here,
                        std::span<const std::string_view> free) {
  const ModelKeys a = model_keys(there);
  const ModelKeys b = model_keys(here);
  const auto value_of = [](const ModelKeys& keys, const std::string& key) {
    const auto found = keys.find(key);
    return found == keys.end() ? std::string("absent") : found->second;
  };
  ModelKeys all = a;
  all.insert(b.begin(), b.end());
  for (const auto& entry : all) {
    const std::string& key = entry.first;
    const auto frees = [&key](std::string_view one) { return is_free(key, one); };
    if (value_of(a, key) == value_of(b, key) || std::ranges::any_of(free, frees)) continue;
    throw InputError(path + ": is of another model (" + key + ": " + value_of(a, key) + " there, " +
                     value_of(b, key) + " here)");
  }
}

bool states_alike(const std::string& there, const std::string& here, std::string_view start) {
  const auto select = [start](const std::string& text) {
    ModelKeys keys = model_keys(text);
    std::erase_if(keys, [start](const auto& entry) { return !is_below(entry.first, start); });
    return keys;
  };
  return select(there) == select(here);
}

}  // namespace samara::io
