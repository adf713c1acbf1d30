#pragma once
/// What this machine and this user allow a real-time loop.

#include <string>
#include <vector>

namespace palpate::tools {

/// One thing that was looked at.
struct Finding {
  std::string what;   ///< "real-time priority"
  std::string found;  ///< "refused: limit 0"
  bool is_good = true;
  std::string remedy;  ///< what to do if it is not good; one line
};

[[nodiscard]] std::vector<Finding> realtimeFindings();

}  // namespace palpate::tools
