#pragma once
/// Writes the results of a benchmark to a file that is named after the machine.

#include <nlohmann/json.hpp>
#include <string>

#include "bench/machine.h"

namespace palpate::bench {

/// "amd-epyc-7763" for "AMD EPYC 7763": lower case, with dashes in place of anything but letters
/// and digits.
[[nodiscard]] std::string fileNameOf(const std::string& cpu);

[[nodiscard]] nlohmann::ordered_json machineJson(const tools::Machine& machine);

/// Removes `--NAME=VALUE` from the arguments, the rest of which are for Google Benchmark; empty if
/// it is not there.
[[nodiscard]] std::string takeOption(const std::string& name, int& count, char** arguments);

/// Writes `results` to FOLDER/CPU`suffix`.json (a temporary file that is then renamed), and prints
/// a note.
void write(const nlohmann::ordered_json& results, const tools::Machine& machine,
           const std::string& folder, const std::string& suffix = {});

}  // namespace palpate::bench
