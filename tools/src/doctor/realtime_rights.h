#pragma once
/// Checks what this machine and this user's rights allow a real-time loop.

#include <string>
#include <vector>

namespace palpate::tools {

/// The result of one check.
struct Finding {
  std::string what;   ///< "real-time priority"
  std::string found;  ///< "refused: limit 0"
  bool is_good = true;
  std::string remedy;  ///< what to do if the result is not good; one line
};

[[nodiscard]] std::vector<Finding> realtimeFindings();

}  // namespace palpate::tools
