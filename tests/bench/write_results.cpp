#include "write_results.h"

#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "palpate/core/error.h"
#include "palpate/version.h"

namespace palpate::bench {

std::string fileNameOf(const std::string& cpu) {
  std::string name;
  for (const char c : cpu) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0) {
      name += static_cast<char>(std::tolower(byte));
    } else if (!name.empty() && name.back() != '-') {
      name += '-';
    }
  }
  while (!name.empty() && name.back() == '-') name.pop_back();
  return name.empty() ? "unknown" : name;
}

nlohmann::ordered_json machineJson(const tools::Machine& machine) {
  return {{"cpu", machine.cpu},          {"threads", machine.threads},
          {"system", machine.system},    {"compiler", machine.compiler},
          {"build", machine.build_type}, {"palpate", PALPATE_VERSION_STRING}};
}

std::string takeOption(const std::string& name, int& count, char** arguments) {
  const std::string start = "--" + name + "=";
  std::string value;
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    const std::string argument = arguments[i];
    if (argument.starts_with(start)) {
      value = argument.substr(start.size());
    } else {
      arguments[kept++] = arguments[i];
    }
  }
  count = kept;
  return value;
}

void write(const nlohmann::ordered_json& results, const tools::Machine& machine,
           const std::string& folder, const std::string& suffix) {
  const std::filesystem::path path =
      std::filesystem::path(folder) / (fileNameOf(machine.cpu) + suffix + ".json");
  std::filesystem::path beside = path;
  beside += ".tmp";
  std::ofstream out(beside);
  out << results.dump(2) << "\n";
  out.close();
  if (!out) {
    throw Error(ErrorKind::kOperation, {"bench.write", "cannot write", {}, beside.string()});
  }
  std::filesystem::rename(beside, path);
  std::printf("\nWritten  %s\n", path.string().c_str());
}

}  // namespace palpate::bench
