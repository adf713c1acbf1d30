#pragma once
/// The machine and the build on which times were measured.

#include <string>

namespace palpate::tools {

struct Machine {
  std::string cpu;       ///< model name
  unsigned threads = 0;  ///< threads that the machine can run at once
  std::string system;    ///< kernel and architecture
  std::string compiler;
  std::string build_type;
  bool optimized = false;  ///< false: times mean nothing
  double clock_ns = 0.0;   ///< [ns] time to read the clock, which is part of a tick's time
};

[[nodiscard]] Machine thisMachine();

}  // namespace palpate::tools
