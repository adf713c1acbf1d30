#pragma once
/// What figures of time were measured on and with.

#include <string>

namespace palpate::tools {

struct Machine {
  std::string cpu;       ///< model name
  unsigned threads = 0;  ///< that the machine can run at once
  std::string system;    ///< kernel and architecture
  std::string compiler;
  std::string build_type;
  bool optimized = false;  ///< false: times say nothing
  double clock_ns = 0.0;   ///< [ns] that reading the clock adds to a tick's time
};

[[nodiscard]] Machine thisMachine();

}  // namespace palpate::tools
