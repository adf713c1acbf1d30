#pragma once
/// Facts that are kept with a grid, so that the next run reports the same as the first.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

struct KeptFacts {
  /// The notes from when it was made: the subject of each, and the note.
  std::vector<std::pair<std::string, std::string>> notes;
  LevelSetInfo made;  ///< the grid as it was made, before its band was widened
};

/// `grid` with the facts in its metadata. When they are read back, notes about `what` refer to the
/// grid's name at that time, all others to its file.
[[nodiscard]] LevelSet withFacts(const LevelSet& grid, const KeptFacts& facts,
                                 const std::string& what);

/// The facts of a grid that is called `what` now and was made from `file`. The grid's own metadata
/// stay in `made`.
[[nodiscard]] KeptFacts factsOf(const LevelSet& grid, const std::string& what,
                                const std::string& file);

[[nodiscard]] std::string textOf(const Box3& box);
[[nodiscard]] std::optional<Box3> boxOf(const std::string& text);

}  // namespace palpate::vdb
