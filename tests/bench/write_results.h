#pragma once
/// Results of a benchmark as a file that is named after the machine.

#include <nlohmann/json.hpp>
#include <string>

#include "bench/machine.h"

namespace palpate::bench {

/// "amd-epyc-7763" for "AMD EPYC 7763": lower case, what is neither letter nor digit a dash.
[[nodiscard]] std::string fileNameOf(const std::string& cpu);

[[nodiscard]] nlohmann::ordered_json machineJson(const tools::Machine& machine);

/// Takes `--NAME=VALUE` out of the arguments, which are Google Benchmark's otherwise; empty if it
/// is not there.
[[nodiscard]] std::string takeOption(const std::string& name, int& count, char** arguments);

/// Writes `results` into FOLDER/CPU`suffix`.json, beside its place and renamed, and says so.
void write(const nlohmann::ordered_json& results, const tools::Machine& machine,
           const std::string& folder, const std::string& suffix = {});

}  // namespace palpate::bench
