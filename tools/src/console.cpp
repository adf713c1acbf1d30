#include "console.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "stop_signal.h"

namespace palpate::tools {
namespace {

constexpr auto kQuietStart = std::chrono::seconds(2);    // shorter work gets no line
constexpr auto kLineInterval = std::chrono::seconds(4);  // between two lines in a log
constexpr auto kBarInterval = std::chrono::milliseconds(80);
constexpr int kBarWidth = 28;

void print(const std::string& text) { std::fputs(text.c_str(), stderr); }

int percent(double fraction) {
  return static_cast<int>(std::floor(100.0 * std::clamp(fraction, 0.0, 1.0)));
}

}  // namespace

Console::Console(bool quiet)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1), work_began_(Clock::now()) {}

Console::~Console() { clearBar(); }

void Console::note(const std::string& text) {
  if (quiet_ || !told_.insert(text).second) return;
  clearBar();
  print("note: " + text + "\n");
}

void Console::say(const std::string& text) {
  clearBar();
  print(text + "\n");
}

void Console::warn(const std::string& text) {
  clearBar();
  print("warning: " + text + "\n");
}

Progress Console::progress() {
  return [this](std::string_view what, double fraction) { return onProgress(what, fraction); };
}

bool Console::onProgress(std::string_view what, double fraction) {
  if (stopRequested().load()) {
    clearBar();
    return false;
  }
  if (quiet_) return true;
  const auto now = Clock::now();
  if (terminal_) {
    if (now - work_began_ < kBarInterval || now - last_shown_ < kBarInterval) return true;
    std::string bar(kBarWidth, ' ');
    if (fraction >= 0.0) {
      const int filled = static_cast<int>(std::lround(kBarWidth * std::clamp(fraction, 0.0, 1.0)));
      std::fill_n(bar.begin(), filled, '#');
    }
    print("\r\033[K[" + bar + "] " +
          (fraction >= 0.0 ? std::to_string(percent(fraction)) + " % " : "") +
          std::string(what.substr(0, 60)));
    std::fflush(stderr);
    bar_shown_ = true;
    last_shown_ = now;
    return true;
  }
  if (now - work_began_ < kQuietStart || now - last_shown_ < kLineInterval) return true;
  print(std::string(what) +
        (fraction >= 0.0 ? ": " + std::to_string(percent(fraction)) + " %" : "") + "\n");
  last_shown_ = now;
  return true;
}

void Console::clearBar() {
  if (!bar_shown_) return;
  print("\r\033[K");
  bar_shown_ = false;
}

void checkStop() {
  if (stopRequested().load()) {
    throw Error(ErrorKind::kCancelled, {"cancelled", "stopped at your request"});
  }
}

}  // namespace palpate::tools
