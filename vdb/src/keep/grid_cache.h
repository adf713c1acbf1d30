#pragma once
/// Grids that took long to make, kept by what they were made of.

#include <cstdint>
#include <optional>
#include <string>

#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// Files in a folder of the user's own, each named after what it was made of (`key`), and sealed:
/// its end says whose key it has and the hash of all before. A file is written beside its place and
/// renamed, and taken only if its seal and, of a grid, its certificate hold; one that is damaged is
/// made again. When all together are larger than the bound, those that were used the longest time
/// ago go. Failing to keep something is not an error.
class GridCache {
 public:
  static constexpr std::uint64_t kMostBytes = 4'000'000'000;

  enum class Owner {
    kUser,   ///< a folder that is not the user's own alone is not used
    kAnyone  ///< what a user names as an input may be anybody's
  };

  /// An empty `folder` keeps nothing. `most` [bytes] of all files.
  explicit GridCache(std::string folder, std::uint64_t most = kMostBytes,
                     Owner owner = Owner::kUser)
      : folder_(std::move(folder)), most_(most), owner_(owner) {}

  /// `key`: hexadecimal digits, and what of a '-'. `max_memory` as of readVdb().
  [[nodiscard]] std::optional<LevelSet> find(const std::string& key, Sampler sampler,
                                             std::uint64_t max_memory = 0) const;
  /// `grid` has its certificate. One larger than a quarter of the bound is not kept. Whether it
  /// was.
  bool keep(const std::string& key, const LevelSet& grid) const;

  /// A few words about something that takes long to read.
  [[nodiscard]] std::optional<std::string> findText(const std::string& key) const;
  bool keepText(const std::string& key, const std::string& text) const;

  [[nodiscard]] const std::string& folder() const noexcept { return folder_; }
  /// Makes the folder if it is missing. False if there is none, or it is not the user's own alone.
  [[nodiscard]] bool isUsable() const;

 private:
  [[nodiscard]] std::string pathOf(const std::string& key, const char* extension) const;
  void makeRoom() const;

  std::string folder_;
  std::uint64_t most_;
  Owner owner_;
};

}  // namespace palpate::vdb
