#pragma once
// Small sound files of every kind, made by the tests' own writers, and every damaged one that ever
// did harm.

#include <string>
#include <string_view>
#include <vector>

namespace palpate::fuzz {

/// Sound files for the reader of that name; at least one.
[[nodiscard]] std::vector<std::string> seedsOf(std::string_view reader);

/// A file that once crashed a reader, hung it or filled the memory.
struct Find {
  std::string name;
  std::string reader;
  std::string bytes;
};
[[nodiscard]] std::vector<Find> finds();

/// .vdb files with grids of many kinds, packed in every way.
[[nodiscard]] std::vector<std::string> vdbSeeds();

/// DICOM segmentations of every kind, and a structure set.
[[nodiscard]] std::vector<std::string> segmentSeeds();

}  // namespace palpate::fuzz
