#pragma once
/// Keeps grids that took long to make, under keys made from their sources.

#include <cstdint>
#include <optional>
#include <string>

#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// Files in a folder of the user's own. Each is named after its `key`, and sealed: its end holds
/// the key and the hash of everything before. A file is written beside its place and then renamed.
/// It is used only if its seal and, for a grid, its certificate are valid; a damaged one is made
/// again. If all files together exceed the limit, those that have not been used for the longest
/// time are removed. Failing to keep something is not an error.
class GridCache {
 public:
  static constexpr std::uint64_t kMostBytes = 4'000'000'000;

  enum class Owner {
    kUser,   ///< the folder must belong to the user alone
    kAnyone  ///< a folder that the user names as an input may belong to anybody
  };

  /// An empty `folder` keeps nothing. `most` [bytes]: limit for all files together.
  explicit GridCache(std::string folder, std::uint64_t most = kMostBytes,
                     Owner owner = Owner::kUser)
      : folder_(std::move(folder)), most_(most), owner_(owner) {}

  /// `key`: hexadecimal digits, and a part separated by '-'. `max_memory` as in readVdb().
  [[nodiscard]] std::optional<LevelSet> find(const std::string& key, Sampler sampler,
                                             std::uint64_t max_memory = 0) const;
  /// `grid` must have its certificate. A grid larger than a quarter of the limit is not kept.
  /// Returns whether it was kept.
  bool keep(const std::string& key, const LevelSet& grid) const;

  /// Whether a grid is there that find() may take: its seal and certificate are not looked at.
  [[nodiscard]] bool mayHave(const std::string& key) const;

  /// A short text about a file that takes long to read.
  [[nodiscard]] std::optional<std::string> findText(const std::string& key) const;
  bool keepText(const std::string& key, const std::string& text) const;

  [[nodiscard]] const std::string& folder() const noexcept { return folder_; }
  /// Makes the folder if it is missing. False if that fails, or if the folder does not belong to
  /// the user alone.
  [[nodiscard]] bool isUsable() const;

 private:
  [[nodiscard]] std::string pathOf(const std::string& key, const char* extension) const;
  void makeRoom() const;

  std::string folder_;
  std::uint64_t most_;
  Owner owner_;
};

}  // namespace palpate::vdb
