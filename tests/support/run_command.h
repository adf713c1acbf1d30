#pragma once
// Runs the built command as a user would, and captures its output.

#include <sys/types.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::testing {

struct CommandResult {
  int exit_code = -1;  ///< 128 + signal if it was killed
  std::string out;
  std::string err;
};

/// Called with all of stderr so far whenever more arrives, and with the process that wrote it.
using OnTalk = std::function<void(std::string_view err, pid_t process)>;

/// Runs `palpate ARGUMENTS...` in `folder` (empty: where the test runs) without a terminal.
[[nodiscard]] CommandResult runPalpate(const std::vector<std::string>& arguments,
                                       const std::string& folder = {}, const OnTalk& on_talk = {});

}  // namespace palpate::testing
