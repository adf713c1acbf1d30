#pragma once
/// Messages and progress on stderr. Results never go here; stdout carries nothing but them.

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

  /// An assumption, or something worth knowing; the same note is printed only once. Silent with
  /// --quiet.
  void note(const std::string& text);
  /// Something that the user needs to know; printed even with --quiet.
  void say(const std::string& text);
  /// Something that went wrong without stopping the work; printed even with --quiet.
  void warn(const std::string& text);

  /// A bar on a terminal; elsewhere a line from time to time once the work takes longer. Ends the
  /// work when the user asked to stop. Must not outlive the console.
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

/// Throws kCancelled if the user asked to stop.
void checkStop();

}  // namespace palpate::tools
