#include "samara/base/words.hpp"

#include <algorithm>
#include <cstddef>

namespace samara {
namespace {

/// Edits (insert, remove, replace, swap neighbours; case does not count) from one word to another.
std::size_t compute_edit_distance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<std::size_t> table((a.size() + 1) * width);
  const auto at = [&](std::size_t i, std::size_t j) -> std::size_t& {
    return table[i * width + j];
  };
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        at(i, j) = i + j;
        continue;
      }
      const auto same = [&](std::size_t p, std::size_t q) {
        return to_lower(a[p - 1]) == to_lower(b[q - 1]);
      };
      at(i, j) =
          std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, at(i - 1, j - 1) + (same(i, j) ? 0u : 1u)});
      if (i > 1 && j > 1 && same(i, j - 1) && same(i - 1, j)) {
        at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
      }
    }
  }
  return at(a.size(), b.size());
}

}  // namespace

std::string to_lower(std::string_view word) {
  std::string lower(word);
  for (char& c : lower) c = to_lower(c);
  return lower;
}

std::vector<std::string_view> split_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end);
    text.remove_prefix(text.starts_with("\r\n") ? 2 : text.empty() ? 0 : 1);
  }
  return lines;
}

std::string find_similar(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr std::size_t longest_word = 100;
  if (word.size() > longest_word) return {};
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = compute_edit_distance(word, candidate);
    if (distance < best_distance && distance < candidate.size()) {
      best = candidate;
      best_distance = distance;
    }
  }
  if (!best.empty()) return best;
  for (const std::string& candidate : candidates) {
    if (!word.empty() && candidate.starts_with(std::string(word) + "_")) return candidate;
  }
  return {};
}

std::string suggest(std::string_view word, const std::vector<std::string>& candidates,
                    const std::string& otherwise) {
  const std::string similar = find_similar(word, candidates);
  return similar.empty() ? otherwise : "; did you mean \"" + similar + "\"?";
}

std::string list_unknown(const std::vector<std::string>& words,
                         const std::vector<std::string>& candidates, const std::string& otherwise) {
  constexpr std::size_t most_shown = 20;
  const std::size_t shown = std::min(words.size(), most_shown);
  std::string text;
  bool has_stranger = false;
  for (std::size_t i = 0; i < shown; ++i) {
    const std::string similar = find_similar(words[i], candidates);
    text += (i == 0 ? "\"" : ", \"") + words[i] + "\"";
    if (similar.empty())
      has_stranger = true;
    else
      text += " (did you mean \"" + similar + "\"?)";
  }
  if (words.size() > shown) text += " and " + std::to_string(words.size() - shown) + " more";
  return text + (has_stranger ? otherwise : "");
}

}  // namespace samara
