#pragma once
// Runs the built command as a user would, and catches all that it says.

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

/// Told all that stderr has brought so far, whenever something came, and the process it is from.
using OnTalk = std::function<void(std::string_view err, pid_t process)>;

/// Runs `palpate ARGUMENTS...` in `folder` (empty: where the test runs) without a terminal.
[[nodiscard]] CommandResult runPalpate(const std::vector<std::string>& arguments,
                                       const std::string& folder = {}, const OnTalk& on_talk = {});

}  // namespace palpate::testing
