#pragma once
/// Talk and progress on stderr. Results never come here; they are the only thing on stdout.

#include <chrono>
#include <set>
#include <string>
#include <string_view>

#include "palpate/core/progress.h"

namespace palpate::tools {

class Console {
 public:
  explicit Console(bool quiet);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// Something assumed or worth knowing; the same note is printed once. Silent with --quiet.
  void note(const std::string& text);
  /// Something that the user cannot do without; told even with --quiet.
  void say(const std::string& text);
  /// Something that went wrong without stopping the work; told even with --quiet.
  void warn(const std::string& text);

  /// A bar on a terminal; elsewhere a line now and then once the work has lasted. Stops the work
  /// when a stop was asked for. Must not outlive the console.
  [[nodiscard]] Progress progress();

 private:
  bool onProgress(std::string_view what, double fraction);
  void clearBar();

  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool terminal_;
  bool bar_shown_ = false;
  Clock::time_point work_began_;
  Clock::time_point last_shown_ = {};
  std::set<std::string> told_;
};

/// Throws kCancelled if a stop was asked for.
void checkStop();

}  // namespace palpate::tools
