#pragma once
/// The machine in the form that reports use.

#include "bench/machine.h"
#include "palpate/version.h"
#include "report.h"

namespace palpate::tools {

[[nodiscard]] inline Json machineJson(const Machine& machine) {
  return {{"cpu", machine.cpu},           {"threads", machine.threads},
          {"system", machine.system},     {"compiler", machine.compiler},
          {"build", machine.build_type},  {"optimized", machine.optimized},
          {"clock_ns", machine.clock_ns}, {"palpate", PALPATE_VERSION_STRING}};
}

[[nodiscard]] inline std::string machineText(const Machine& machine) {
  return machine.cpu + " (" + std::to_string(machine.threads) + " threads), " + machine.system +
         ", " + machine.compiler + ", " + machine.build_type + " build";
}

}  // namespace palpate::tools
