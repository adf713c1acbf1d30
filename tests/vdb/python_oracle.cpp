#include "vdb/python_oracle.h"

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "folders/folders.h"

namespace palpate::vdb::test {

std::vector<std::vector<double>> askPython(const std::string& command,
                                           const std::vector<std::string>& arguments) {
  return askScript("vdb/nifti_oracle.py", command, arguments);
}

std::vector<std::vector<double>> askScript(const std::string& script, const std::string& command,
                                           const std::vector<std::string>& arguments) {
  std::string line =
      "/usr/bin/python3 '" + palpate::test::sourceFolder() + "/tests/" + script + "' " + command;
  for (const std::string& argument : arguments) line += " '" + argument + "'";
  FILE* pipe = popen(line.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start: " + line);
  std::string output;
  char chunk[65536];
  for (std::size_t got = 0; (got = fread(chunk, 1, sizeof chunk, pipe)) > 0;)
    output.append(chunk, got);
  if (pclose(pipe) != 0) throw std::runtime_error("failed: " + line);

  std::vector<std::vector<double>> rows;
  std::istringstream lines(output);
  for (std::string text; std::getline(lines, text);) {
    auto& row = rows.emplace_back();
    const char* at = text.c_str();
    for (char* end = nullptr;; at = end) {
      const double value = std::strtod(at, &end);  // parses "nan" and "inf" too
      if (end == at) break;
      row.push_back(value);
    }
  }
  return rows;
}

}  // namespace palpate::vdb::test
