#pragma once
// Shared by several tests of the command.

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "folders/folders.h"
#include "support/run_command.h"
#include "support/temp_file.h"

namespace palpate::testing {

using Json = nlohmann::json;

/// A scene: a wall of 1000 N/m, 1 mm below the device's origin.
constexpr const char* kWallBelow =
    "palpate: 1\nlength: mm\nmaterials:\n  wall: {stiffness: 1000 N/m}\nlayers:\n"
    "  - {name: wall, wall: wall,\n     inside: {half_space: {point: [0, 0, -1], "
    "normal: [0, 0, 1]}}}\n";

/// The whole of stdout as one JSON object; anything else fails the test.
inline Json parseOnly(const CommandResult& result) {
  Json json = Json::parse(result.out, nullptr, false);
  EXPECT_TRUE(json.is_object()) << "stdout is not one JSON object:\n" << result.out << result.err;
  return json.is_object() ? json : Json::object();
}

/// The report of `palpate convert ARGUMENTS... --json`, which must succeed.
inline Json converted(const TempFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "convert");
  arguments.emplace_back("--json");
  const CommandResult result = runPalpate(arguments, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
  return parseOnly(result);
}

/// Runs `palpate ARGUMENTS...` in `folder` and sends it `signal` as soon as it prints to stderr; it
/// must end as interrupted.
inline CommandResult runInterrupted(const std::vector<std::string>& arguments,
                                    const std::string& folder, int signal = SIGTERM) {
  bool sent = false;
  CommandResult result = runPalpate(arguments, folder, [&](std::string_view, pid_t process) {
    if (!sent) kill(process, signal);
    sent = true;
  });
  EXPECT_TRUE(sent) << "it was over before it said anything";
  EXPECT_EQ(result.exit_code, 130) << result.err;
  return result;
}

inline std::string textOf(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

inline std::vector<std::string> filesIn(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

inline std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

inline std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

/// Whether the tags of an XML text are closed in the right order.
inline bool isWellFormed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1)) {
    const std::size_t end = xml.find('>', at);
    if (end == std::string::npos) return false;
    const std::string tag = xml.substr(at + 1, end - at - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" \n"));
    if (tag.starts_with('/')) {
      if (open.empty() || "/" + open.back() != tag) return false;
      open.pop_back();
    } else if (!tag.ends_with('/')) {
      open.push_back(name);
    }
  }
  return open.empty();
}

inline std::string scenePath(const std::string& name) {
  return test::sourceFolder() + "/data/scenes/" + name;
}

/// The paper's container, with all its numbers known.
inline constexpr const char* kContainer = R"(palpate: 1
length: mm
fields:
  bowl: {sphere: {center: [0, 0, 0], radius: 40}}
  brim: {half_space: {point: [0, 0, 15], normal: [0, 0, 1]}}
materials:
  glass: {stiffness: 1500 N/m}
  syrup: {viscosity: 4 N.s/m}
layers:
  - {name: liquid, inside: {intersection: [bowl, brim]}, content: syrup, wall: glass}
ports:
  - {name: mouth, between: [outside, liquid], on: brim}
)";

}  // namespace palpate::testing
