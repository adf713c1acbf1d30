#pragma once
// Scans and meshes that are not part of the repository: in the folder that PALPATE_SCANS names, or
// in ../shared/data beside the repository.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "folders/folders.h"

namespace palpate::testing {

inline std::string scansFolder() {
  const char* const named = std::getenv("PALPATE_SCANS");
  return named != nullptr && *named != '\0' ? named : test::sourceFolder() + "/../shared/data";
}

inline std::string scanPath(const std::string& name) { return scansFolder() + "/" + name; }

/// The reason for skipping a test that needs `path`; tools/test.sh counts these by file.
inline std::string absentScan(const std::string& path) {
  const std::string folder = scansFolder();
  const std::string name = std::filesystem::path(path).lexically_relative(folder).generic_string();
  return "absent: " + (name == "." ? "all scans" : name) + " in " + folder +
         "; PALPATE_SCANS names another folder";
}

}  // namespace palpate::testing

/// Skips the test if a file or folder of the scans is missing, and says which one.
#define PALPATE_NEEDS_SCAN(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << ::palpate::testing::absentScan(path)
