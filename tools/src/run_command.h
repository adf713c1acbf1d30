#pragma once
/// The command, all but the process that it is.

#include <string>
#include <vector>

namespace palpate::tools {

/// Parses `arguments` (without the program's name), runs one verb, prints once, and returns the
/// exit code that what went wrong has. Once in a process: it takes over the signals that stop it.
[[nodiscard]] int runCommand(const std::vector<std::string>& arguments);

}  // namespace palpate::tools
