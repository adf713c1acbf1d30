#include "bench/machine.h"

#include <sys/utsname.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <thread>

namespace palpate::tools {
namespace {

std::string cpuModel() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const auto colon = line.find(": ");
    if (colon != std::string::npos && line.starts_with("model name")) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string systemName() {
  utsname name{};
  if (uname(&name) != 0) return "unknown";
  return std::string(name.sysname) + " " + name.release + " " + name.machine;
}

double clockCost() {
  using Clock = std::chrono::steady_clock;
  double least = 1e9;
  for (int i = 0; i < 10000; ++i) {
    const auto before = Clock::now();
    const auto after = Clock::now();
    least = std::min(least, std::chrono::duration<double, std::nano>(after - before).count());
  }
  return least;
}

bool isOptimized() {
#if defined(__OPTIMIZE__) && defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
  return true;
#else
  return false;
#endif
}

}  // namespace

Machine thisMachine() {
  Machine machine;
  machine.cpu = cpuModel();
  machine.threads = std::thread::hardware_concurrency();
  machine.system = systemName();
#ifdef __clang__
  machine.compiler = "Clang " __clang_version__;
#else
  machine.compiler = "GCC " __VERSION__;
#endif
  machine.build_type = PALPATE_BUILD_TYPE;
  machine.optimized = isOptimized();
  machine.clock_ns = clockCost();
  return machine;
}

}  // namespace palpate::tools
