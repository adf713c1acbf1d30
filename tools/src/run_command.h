#pragma once
/// The whole command except main().

#include <string>
#include <vector>

namespace palpate::tools {

/// Parses `arguments` (without the program's name), runs one verb, prints its report once, and
/// returns the exit code. To be called once in a process: it takes over the signals that stop the
/// run.
[[nodiscard]] int runCommand(const std::vector<std::string>& arguments);

}  // namespace palpate::tools
