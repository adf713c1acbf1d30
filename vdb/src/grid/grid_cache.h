#pragma once
/// Grids that took long to make out of others, kept by what they were made of.

#include <cstdint>
#include <optional>
#include <string>

#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// Files in a folder of the user's own, each named after the content of the grid that it was made from. A file is written beside its
/// place and renamed, and taken only if its certificate is of its content; one that is damaged is made again. When all
/// together are larger than kMostBytes, those that were used the longest time ago go. Failing to keep a grid is not an error.
class GridCache {
 public:
  static constexpr std::uint64_t kMostBytes = 4'000'000'000;
  /// Fewer active voxels are made again faster than they are worth keeping.
  static constexpr std::uint64_t kLeastVoxels = 100'000;

  /// An empty `folder` keeps nothing.
  explicit GridCache(std::string folder) : folder_(std::move(folder)) {}

  /// `key`: contentHash() of the grid it was made of, and what was made of it.
  [[nodiscard]] std::optional<LevelSet> find(const std::string& key) const;
  /// `grid` has its certificate.
  void keep(const std::string& key, const LevelSet& grid) const;

 private:
  [[nodiscard]] std::string pathOf(const std::string& key) const;
  void makeRoom() const;

  std::string folder_;
};

}  // namespace palpate::vdb
