// Drives a harness where libFuzzer is not at hand: changes inputs at random, keeps those that reach
// new code (where it is built with -fsanitize-coverage=trace-pc), and runs them in a child, whose
// crash, hang or hunger for memory is a finding.
//
//     fuzz_case [-runs=N] [-max_total_time=S] [-seed=N] [-timeout=S] [-rss_limit_mb=N]
//               [-max_len=N] [-dict=FILE] [-artifact_prefix=PATH] [FOLDER or FILE ...]
//
// Options are libFuzzer's. The first folder gets what reaches new code. All files are run once
// before any change; -runs=0 ends after that. Exit code 1 where there was a finding.
#include <algorithm>
#include <cctype>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness.hpp"

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t map_size = 1 << 16;
constexpr std::size_t largest_input = 1 << 20;
constexpr std::size_t most_changed = 128;  // bytes, at a time
constexpr int most_findings = 20;

/// Memory that parent and child share.
struct Shared {
  volatile std::uint64_t executions;
  volatile std::uint64_t seeds_done;
  volatile std::uint64_t kept;
  volatile std::size_t size;
  std::uint8_t seen[map_size];  // 1: reached before
  std::uint8_t input[largest_input];
};

Shared* shared = nullptr;
std::uint8_t reached[map_size];

struct Options {
  std::map<std::string, std::string> values{
      {"runs", "-1"},           {"max_total_time", "0"}, {"seed", "0"}, {"timeout", "5"},
      {"rss_limit_mb", "4096"}, {"max_len", "0"},        {"dict", ""},  {"artifact_prefix", "./"}};
  std::vector<fs::path> places;

  double number(const std::string& name) const { return std::stod(values.at(name)); }
};

Options read_options(int count, char** words) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const std::size_t equals = word.find('=');
    if (word.empty() || word[0] != '-') {
      options.places.emplace_back(word);
    } else if (equals != std::string::npos && options.values.contains(word.substr(1, equals - 1))) {
      options.values[word.substr(1, equals - 1)] = word.substr(equals + 1);
    } else {
      std::cerr << "unknown option " << word << "\n";
      std::exit(2);
    }
  }
  return options;
}

std::string read_bytes(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  bytes.resize(std::min(bytes.size(), largest_input));
  return bytes;
}

void write_bytes(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::string name_of(const std::string& input) {
  std::ostringstream name;
  name << std::hex << std::hash<std::string>{}(input);
  return name.str();
}

std::vector<std::string> read_corpus(const std::vector<fs::path>& places) {
  std::vector<fs::path> files;
  for (const fs::path& place : places) {
    if (!fs::is_directory(place)) {
      files.push_back(place);
      continue;
    }
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(place))
      if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> corpus;
  for (const fs::path& file : files) corpus.push_back(read_bytes(file));
  return corpus;
}

/// Lines `"word"` with \xHH, \\ and \" in them.
std::vector<std::string> read_dictionary(const std::string& path) {
  std::vector<std::string> words;
  std::ifstream stream(path);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t first = line.find('"');
    const std::size_t last = line.rfind('"');
    if (line.starts_with('#') || first == std::string::npos || last <= first) continue;
    std::string word;
    for (std::size_t i = first + 1; i < last; ++i) {
      if (line[i] == '\\' && line[i + 1] == 'x' && i + 3 < last) {
        word += static_cast<char>(std::stoi(line.substr(i + 2, 2), nullptr, 16));
        i += 3;
      } else {
        if (line[i] == '\\') ++i;
        word += line[i];
      }
    }
    words.push_back(word);
  }
  return words;
}

/// Changes of inputs, of bytes and of words.
class Mutator {
 public:
  Mutator(unsigned long seed, std::vector<std::string> words)
      : random_(static_cast<std::mt19937_64::result_type>(seed)), words_(std::move(words)) {}

  std::size_t below(std::size_t end) {
    return std::uniform_int_distribution<std::size_t>(0, end - 1)(random_);
  }
  unsigned number() { return static_cast<unsigned>(random_()); }

  void change(std::string& input, std::size_t most) {
    for (std::size_t i = std::size_t{1} << below(5); i > 0; --i) change_once(input);
    if (input.size() > most) input.resize(most);
  }

  /// A part of another one, between or in place of its own.
  void cross(std::string& input, const std::string& other) {
    if (input.empty() || other.empty()) return;
    const std::size_t from = below(other.size());
    const std::size_t place = below(input.size() + 1);
    const std::size_t gone = below(2) == 0 ? 0 : below(input.size() - place + 1);
    input.replace(place, gone, other.substr(from, 1 + below(other.size() - from)));
  }

 private:
  void change_once(std::string& input) {
    if (input.empty()) input.push_back(static_cast<char>(below(256)));
    const std::size_t place = below(input.size());
    const std::size_t length = 1 + below(std::min(input.size() - place, most_changed));
    switch (below(9)) {
      case 0:
        input[place] = static_cast<char>(input[place] ^ (1 << below(8)));
        break;
      case 1:
        input[place] = static_cast<char>(below(256));
        break;
      case 2:
        input.erase(place, length);
        break;
      case 3:
        input.insert(below(input.size() + 1), std::string(input, place, length));
        break;
      case 4: {  // a small or odd integer of 1, 2, 4 or 8 bytes
        const std::int64_t odd[] = {0,   1,     -1,    127,        128,        255,
                                    256, 32767, 65535, 2147483647, 4294967295, 1ll << 40};
        const std::int64_t value = odd[below(std::size(odd))];
        const std::size_t width = std::min(input.size() - place, std::size_t{1} << below(4));
        std::memcpy(input.data() + place, &value, width);
        break;
      }
      case 5:
        replace_word(input, place);
        break;
      case 6:
        replace_number(input, place);
        break;
      case 7:
        if (!words_.empty()) input.insert(place, words_[below(words_.size())]);
        break;
      default: {  // takes a line out, doubles or moves it
        const std::size_t first = line_start(input, place);
        const std::size_t end = std::min(input.find('\n', place), input.size() - 1) + 1;
        const std::string line = input.substr(first, end - first);
        if (below(2) == 0) input.erase(first, end - first);
        if (below(2) == 0) input.insert(line_start(input, below(input.size() + 1)), line);
        break;
      }
    }
  }

  static bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
  }

  struct Word {
    std::size_t first;
    std::size_t length;
  };

  /// The word around a place.
  static Word word_at(const std::string& input, std::size_t place) {
    std::size_t first = place;
    std::size_t last = place;
    while (first > 0 && is_word(input[first - 1])) --first;
    while (last < input.size() && is_word(input[last])) ++last;
    return {first, last - first};
  }

  void replace_word(std::string& input, std::size_t place) {
    const Word own = word_at(input, place);
    const Word other = word_at(input, below(input.size()));
    const std::string word = !words_.empty() && below(2) == 0
                                 ? words_[below(words_.size())]
                                 : input.substr(other.first, other.length);
    input.replace(own.first, own.length, word);
  }

  void replace_number(std::string& input, std::size_t place) {
    const char* odd[] = {"0",    "-1",      "1e308",      "-1e-308", "nan", ".inf", "1e-300", "0.5",
                         "1e18", "1000000", "2147483648", "99",      "3",   "~",    "true"};
    const std::size_t digit = input.find_first_of("0123456789", place);
    if (digit == std::string::npos) return;
    const Word own = word_at(input, digit);
    input.replace(own.first, own.length, odd[below(std::size(odd))]);
  }

  static std::size_t line_start(const std::string& input, std::size_t place) {
    while (place > 0 && input[place - 1] != '\n') --place;
    return place;
  }

  std::mt19937_64 random_;
  std::vector<std::string> words_;
};

Mutator* own_mutator = nullptr;

/// True where the last run reached what none had reached before.
bool note_reached() {
  bool is_new = false;
  for (std::size_t i = 0; i < map_size; ++i)
    if (reached[i] != 0 && shared->seen[i] == 0) {
      shared->seen[i] = 1;
      is_new = true;
    }
  return is_new;
}

bool run_once(const std::string& input) {
  std::memcpy(shared->input, input.data(), input.size());
  shared->size = input.size();
  std::memset(reached, 0, sizeof reached);
  LLVMFuzzerTestOneInput(shared->input, input.size());
  shared->executions = shared->executions + 1;
  return note_reached();
}

/// The child: all seeds that are left, then changes of them, until it is told to end.
[[noreturn]] void work(const Options& options, std::vector<std::string> corpus, unsigned long seed,
                       std::uint64_t runs) {
  Mutator mutator(seed, read_dictionary(options.values.at("dict")));
  own_mutator = &mutator;
  for (std::size_t i = shared->seeds_done; i < corpus.size(); ++i) {
    shared->seeds_done = i + 1;
    run_once(corpus[i]);
  }
  const auto limit = static_cast<std::size_t>(options.number("max_len"));
  std::size_t most = limit;
  if (limit == 0) {
    for (const std::string& one : corpus) most = std::max(most, 2 * one.size());
    most = std::clamp<std::size_t>(most, 4096, largest_input);
  }
  if (corpus.empty()) corpus.emplace_back();
  const std::uint64_t first = corpus.size();
  while (shared->executions < runs + first) {
    std::string input = corpus[mutator.below(corpus.size())];
    if (LLVMFuzzerCustomMutator != nullptr) {
      const std::size_t size = std::min(input.size(), most);
      input.resize(most);
      input.resize(LLVMFuzzerCustomMutator(reinterpret_cast<std::uint8_t*>(input.data()), size,
                                           most, mutator.number()));
    } else {
      if (mutator.below(4) == 0) mutator.cross(input, corpus[mutator.below(corpus.size())]);
      mutator.change(input, most);
    }
    if (!run_once(input)) continue;
    corpus.push_back(input);
    if (options.places.empty() || !fs::is_directory(options.places.front())) continue;
    write_bytes(options.places.front() / name_of(input), input);
    shared->kept = shared->kept + 1;
  }
  std::exit(0);
}

std::size_t resident_megabytes(pid_t child) {
  std::ifstream stream("/proc/" + std::to_string(child) + "/statm");
  std::size_t all = 0, resident = 0;
  stream >> all >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) >> 20;
}

/// Processor time of a child and of the processes that it has waited for [s].
double processor_seconds(pid_t child) {
  std::ifstream stream("/proc/" + std::to_string(child) + "/stat");
  std::string text;
  std::getline(stream, text);
  std::istringstream fields(text.substr(std::min(text.rfind(')'), text.size() - 1) + 1));
  std::string skipped;
  for (int i = 3; i < 14; ++i) fields >> skipped;
  double ticks = 0.0;
  double part = 0.0;
  for (int i = 14; i <= 17 && fields >> part; ++i) ticks += part;
  return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

/// How a child ended; empty: as it should. A hang is an input that takes more processor time than
/// `timeout`, or ten times as much by the clock: a busy machine must not make findings.
std::string watch(pid_t child, const Options& options, Clock::time_point end, bool has_end) {
  using std::chrono::duration;
  constexpr auto pause = std::chrono::milliseconds(20);
  std::uint64_t last = shared->executions;
  Clock::time_point since = Clock::now();
  double spent = processor_seconds(child);
  for (;;) {
    int status = 0;
    if (::waitpid(child, &status, WNOHANG) == child) {
      if (WIFSIGNALED(status)) return std::string("crash: ") + ::strsignal(WTERMSIG(status));
      return WEXITSTATUS(status) == 0 ? "" : "crash: exit " + std::to_string(WEXITSTATUS(status));
    }
    const Clock::time_point now = Clock::now();
    if (shared->executions != last) {
      last = shared->executions;
      since = now;
      spent = processor_seconds(child);
    }
    const double limit = options.number("timeout");
    const bool hangs = processor_seconds(child) - spent > limit ||
                       duration<double>(now - since).count() > 10.0 * limit;
    const bool is_hungry =
        static_cast<double>(resident_megabytes(child)) > options.number("rss_limit_mb");
    const bool is_over = has_end && now > end;
    if (hangs || is_hungry || is_over) {
      ::kill(child, SIGKILL);
      ::waitpid(child, &status, 0);
      return is_hungry ? "out of memory" : hangs ? "timeout" : "";
    }
    std::this_thread::sleep_for(pause);
  }
}

void keep_finding(const Options& options, const std::string& words) {
  std::string input(shared->size, '\0');
  std::memcpy(input.data(), shared->input, input.size());
  std::string path = options.values.at("artifact_prefix") + words.substr(0, words.find(':')) + "-" +
                     name_of(input);
  std::replace(path.begin(), path.end(), ' ', '-');
  write_bytes(path, input);
  std::cerr << words << ": " << path << "\n";
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most) {
  std::string input(size, '\0');
  std::memcpy(input.data(), data, size);
  own_mutator->change(input, most);
  std::memcpy(data, input.data(), input.size());
  return input.size();
}

/// Called by the compiler's code at every basic block of a build with coverage.
extern "C" __attribute__((no_sanitize_coverage)) void __sanitizer_cov_trace_pc() {
  const auto place = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
  reached[(place ^ (place >> 16)) % map_size] = 1;
}

int main(int count, char** words) {
  const Options options = read_options(count, words);
  shared = static_cast<Shared*>(
      ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  if (shared == MAP_FAILED) return 2;
  const bool has_end = options.number("max_total_time") > 0.0;
  const Clock::time_point start = Clock::now();
  const Clock::time_point end =
      start +
      std::chrono::milliseconds(static_cast<long>(1000.0 * options.number("max_total_time")));
  const double wanted = options.number("runs");
  const std::uint64_t runs =
      wanted < 0.0 ? ~std::uint64_t{0} >> 1 : static_cast<std::uint64_t>(wanted);
  auto seed = static_cast<unsigned long>(options.number("seed"));
  if (seed == 0) seed = std::random_device{}();
  std::cerr << "seed " << seed << "\n";
  int findings = 0;
  for (int i = 0;; ++i) {
    const std::vector<std::string> corpus = read_corpus(options.places);
    const pid_t child = ::fork();
    if (child < 0) return 2;
    if (child == 0) {
      try {
        work(options, corpus, seed + static_cast<unsigned long>(i), runs);
      } catch (const std::exception& error) {
        std::cerr << "uncaught: " << error.what() << "\n";
        std::abort();
      }
    }
    const std::string finding = watch(child, options, end, has_end);
    if (!finding.empty()) {
      keep_finding(options, finding);
      shared->executions = shared->executions + 1;
    }
    if (!finding.empty() && ++findings == most_findings) break;
    if (finding.empty()) break;
    if (has_end && Clock::now() > end) break;
  }
  std::cerr << "executions " << shared->executions << ", kept " << shared->kept << ", findings "
            << findings << ", seconds "
            << std::chrono::duration<double>(Clock::now() - start).count() << "\n";
  return findings == 0 ? 0 : 1;
}
