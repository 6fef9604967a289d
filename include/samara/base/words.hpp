// Words and lines that users write.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace samara {

/// Lower case of an ASCII letter, whatever the locale.
inline char to_lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// The same of all letters of a word.
std::string to_lower(std::string_view word);

/// Lines end with LF, CR LF or CR.
std::vector<std::string_view> split_lines(std::string_view text);

/// Returns the word that `word` is probably meant to be, or an empty string.
std::string find_similar(std::string_view word, const std::vector<std::string>& candidates);

/// `; did you mean "..."?`, or `otherwise` where no word resembles the given one.
std::string suggest(std::string_view word, const std::vector<std::string>& candidates,
                    const std::string& otherwise = {});

/// `"a", "b" (did you mean "c"?)` of words that are not among the candidates, twenty of them at
/// most. `otherwise` follows where a shown word resembles no candidate.
std::string list_unknown(const std::vector<std::string>& words,
                         const std::vector<std::string>& candidates,
                         const std::string& otherwise = {});

}  // namespace samara
