#include "progress.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <unistd.h>

namespace samara::drivers {
namespace {

constexpr std::chrono::milliseconds between_bars(100);
constexpr std::chrono::seconds between_lines(10);
constexpr int bar_width = 40;
/// Work on which an estimate of the rest stands [s], and the longest rest that is printed.
constexpr double least_elapsed = 2.0;
constexpr double most_seconds = 360000.0;

bool is_terminal() {
  const char* name = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) != 0 && name != nullptr && std::string_view(name) != "dumb";
}

/// "40 %, 2 min 10 s left"; without the time where it is not known.
std::string words_of(double part, double left) {
  std::string text = std::to_string(static_cast<int>(100.0 * part)) + " %";
  if (!(left >= 1.0) || left > most_seconds) return text;
  constexpr int minute = 60;
  const long seconds = std::lround(left);
  text += ", ";
  if (seconds >= minute) text += std::to_string(seconds / minute) + " min ";
  return text + std::to_string(seconds % minute) + " s left";
}

}  // namespace

Progress::Progress(bool speaks)
    : speaks_(speaks),
      on_terminal_(speaks && is_terminal()),
      interval_(on_terminal_ ? Clock::duration(between_bars) : Clock::duration(between_lines)),
      next_(Clock::now() + interval_) {}

Progress::~Progress() { clear_bar(); }

void Progress::note(const std::string& text) {
  if (!speaks_) return;
  clear_bar();
  std::fprintf(stderr, "samara: %s\n", text.c_str());
}

void Progress::progress(const std::string& stage, long done, long all) {
  if (!speaks_) return;
  const Clock::time_point now = Clock::now();
  if (all <= 0) return;
  const double part = static_cast<double>(done) / static_cast<double>(all);
  if (stage != stage_ || part < begun_part_) {
    stage_ = stage;
    begun_ = now;
    begun_part_ = part;
  }
  if (now < next_) return;
  next_ = now + interval_;
  const double elapsed = std::chrono::duration<double>(now - begun_).count();
  const double rate = (part - begun_part_) / elapsed;
  const std::string words =
      words_of(part, elapsed > least_elapsed && rate > 0.0 ? (1.0 - part) / rate : 0.0);
  if (on_terminal_)
    draw_bar(stage, part, words);
  else
    std::fprintf(stderr, "samara: %s: %s\n", stage.c_str(), words.c_str());
}

void Progress::draw_bar(const std::string& stage, double part, const std::string& words) {
  const auto filled = static_cast<std::size_t>(part * bar_width);
  const std::string bar = std::string(filled, '#') + std::string(bar_width - filled, '.');
  std::fprintf(stderr, "\r\033[K%s  %s  %s", stage.c_str(), bar.c_str(), words.c_str());
  std::fflush(stderr);
  has_bar_ = true;
}

void Progress::clear_bar() {
  if (!has_bar_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  has_bar_ = false;
}

}  // namespace samara::drivers
