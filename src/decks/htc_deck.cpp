#include "htc_deck.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/base/words.hpp"
#include "samara/io/whole_file.hpp"

namespace samara::decks {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_files = 16;       ///< one inside the other
constexpr std::size_t most_blocks = 64;      ///< one inside the other
constexpr std::size_t most_lines = 2000000;  ///< of all files

}  // namespace

std::vector<std::string> split_htc_words(std::string_view line) {
  std::vector<std::string> words;
  std::size_t i = 0;
  while (i < line.size()) {
    const char c = line[i];
    if (std::isspace(static_cast<unsigned char>(c)) != 0 || c == ',') {
      ++i;
    } else if (c == '"' || c == '\'') {
      const std::size_t stop = std::min(line.find(c, i + 1), line.size());
      words.emplace_back(line.substr(i + 1, stop - i - 1));
      i = stop + 1;
    } else {
      const std::size_t stop = std::min(line.find_first_of(" \t\f\v,\"'", i), line.size());
      words.emplace_back(line.substr(i, stop - i));
      i = stop;
    }
  }
  return words;
}

const HtcCommand* HtcBlock::find(const std::string& wanted, const std::string& other) const {
  const auto found = std::find_if(commands.rbegin(), commands.rend(), [&](const auto& command) {
    return command.name == wanted || (!other.empty() && command.name == other);
  });
  return found == commands.rend() ? nullptr : &*found;
}

const HtcBlock* HtcBlock::find_block(const std::string& wanted) const {
  const auto found = std::ranges::find(blocks, wanted, &HtcBlock::name);
  return found == blocks.end() ? nullptr : &*found;
}

HtcDeck::HtcDeck(std::string path, DeckErrors& errors) : path_(std::move(path)), errors_(errors) {
  root_.place = path_;
  // Pointers to open blocks stay valid: only the innermost open block gets new members.
  std::vector<HtcBlock*> open{&root_};
  read(path_, open);
}

void HtcDeck::read(const std::string& path, std::vector<HtcBlock*>& open) {
  const std::string text = read_deck_text(path);
  const std::vector<std::string_view> lines = split_lines(text);
  const std::size_t outer = open.size();
  reading_.push_back(path);
  bool has_exit = false;
  for (std::size_t i = 0; i < lines.size() && !has_exit; ++i) {
    if (++lines_ > most_lines) {
      errors_.add(path, "the deck has more than " + std::to_string(most_lines) + " lines");
      break;
    }
    const std::string place = path + ":" + std::to_string(i + 1);
    const std::size_t comment = lines[i].find(';');
    const std::vector<std::string> words = split_htc_words(lines[i].substr(0, comment));
    if (words.empty()) continue;
    has_exit = to_lower(words[0]) == "exit";
    const bool is_cut = comment == std::string_view::npos && i + 1 == lines.size() &&
                        !decks::ends_with_line(text) && !has_exit;
    if (is_cut)
      errors_.add(place, "the file ends inside this line; hint: a command ends with \";\"");
    else if (!has_exit)
      take_line(place, words, open, outer);
  }
  while (open.size() > outer) {
    errors_.add(open.back()->place, "begin " + open.back()->name +
                                        ": its end is missing; hint: the file may be cut off");
    open.pop_back();
  }
  if (!has_exit) without_exit_.push_back(path);
  reading_.pop_back();
}

void HtcDeck::take_line(const std::string& place, const std::vector<std::string>& words,
                        std::vector<HtcBlock*>& open, std::size_t outer) {
  const std::string first = to_lower(words[0]);
  if (first == "begin") {
    if (words.size() < 2) {
      errors_.add(place, "begin: the name of the block is missing");
      return;
    }
    if (open.size() > most_blocks)
      throw InputError(place + ": more than " + std::to_string(most_blocks) +
                       " blocks one inside the other");
    HtcBlock block;
    block.name = to_lower(words[1]);
    block.place = place;
    open.back()->blocks.push_back(std::move(block));
    open.push_back(&open.back()->blocks.back());
    return;
  }
  if (first == "end") {
    end_block(place, words, open, outer);
    return;
  }
  if (first == "continue_in_file") {
    if (words.size() < 2) {
      errors_.add(place, "continue_in_file: the name of the file is missing");
      return;
    }
    const std::string next = find_file(words[1], place);
    if (next.empty()) return;
    const bool is_open = std::ranges::any_of(
        reading_, [&](const std::string& other) { return io::is_same_file(other, next); });
    if (is_open || reading_.size() >= most_files) {
      errors_.add(place, "continue_in_file: " + words[1] +
                             (is_open ? ": the file continues in itself"
                                      : ": more than " + std::to_string(most_files) +
                                            " files one inside the other"));
      return;
    }
    try {
      read(next, open);
    } catch (const InputError& error) {
      errors_.add_message(error.what());
    }
    return;
  }
  HtcCommand command;
  command.name = first;
  command.words.assign(words.begin() + 1, words.end());
  command.place = place;
  open.back()->commands.push_back(std::move(command));
}

void HtcDeck::end_block(const std::string& place, const std::vector<std::string>& words,
                        std::vector<HtcBlock*>& open, std::size_t outer) {
  const std::string name = words.size() < 2 ? std::string() : to_lower(words[1]);
  if (open.size() <= outer) {
    errors_.add(place, "end " + name + ": no block has begun in this file");
    return;
  }
  if (name.empty() || open.back()->name == name) {
    open.pop_back();
    return;
  }
  errors_.add(place, "end " + name + ": the open block is " + open.back()->name + ", begun at " +
                         open.back()->place);
  const auto known = std::find_if(open.rbegin(), open.rend() - static_cast<std::ptrdiff_t>(outer),
                                  [&](const HtcBlock* block) { return block->name == name; });
  if (known != open.rend() - static_cast<std::ptrdiff_t>(outer))
    open.resize(open.size() - static_cast<std::size_t>(known - open.rbegin()) - 1);
}

std::string HtcDeck::find_file(const std::string& name, const std::string& place) {
  std::string plain = name;
  std::ranges::replace(plain, '\\', '/');
  const auto known = std::ranges::find_if(
      found_, [&](const FoundFile& file) { return file.name == name && file.place == place; });
  if (known != found_.end()) return known->path;
  const fs::path folder = io::folder_of(path_);
  std::error_code ignored;
  const std::array<fs::path, 2> bases{folder, folder / ".."};
  for (const bool any_case : {false, true})
    for (std::size_t i = 0; i < bases.size(); ++i) {
      fs::path full = fs::path(plain).is_absolute() ? fs::path(plain) : bases[i] / plain;
      std::string path = full.lexically_normal().string();
      if (any_case) path = find_in_other_case(path);
      if (path.empty() || !fs::is_regular_file(path, ignored)) continue;
      found_.push_back({place, name, path, i == 1 && !fs::path(plain).is_absolute(), any_case});
      return path;
    }
  errors_.add(place, name + ": there is no such file, neither from the folder of " +
                         fs::path(path_).filename().string() + " nor from the one above");
  return "";
}

}  // namespace samara::decks
