#include "progress.hpp"

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <unistd.h>

namespace samara::drivers {
namespace {

constexpr std::chrono::milliseconds between_bars(100);
constexpr std::chrono::seconds between_lines(10);
constexpr int bar_width = 40;

bool is_terminal() {
  const char* name = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) != 0 && name != nullptr && std::string_view(name) != "dumb";
}

std::string percent(double part) { return std::to_string(static_cast<int>(100.0 * part)) + " %"; }

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
  if (now < next_ || all <= 0) return;
  next_ = now + interval_;
  const double part = static_cast<double>(done) / static_cast<double>(all);
  if (on_terminal_)
    draw_bar(stage, part);
  else
    std::fprintf(stderr, "samara: %s: %s\n", stage.c_str(), percent(part).c_str());
}

void Progress::draw_bar(const std::string& stage, double part) {
  const auto filled = static_cast<std::size_t>(part * bar_width);
  const std::string bar = std::string(filled, '#') + std::string(bar_width - filled, '.');
  std::fprintf(stderr, "\r\033[K%s  %s  %s", stage.c_str(), bar.c_str(), percent(part).c_str());
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
