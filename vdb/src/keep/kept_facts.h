#pragma once
/// What goes along with a grid that is kept, so that the next run tells the same as the first.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

struct KeptFacts {
  /// What was said when it was made: about what, and the note.
  std::vector<std::pair<std::string, std::string>> notes;
  LevelSetInfo made;  ///< the grid as it was made, before its band was widened
};

/// `grid` with the facts in its metadata. Notes about `what` will be about whatever the grid is
/// called then, all others about its file.
[[nodiscard]] LevelSet withFacts(const LevelSet& grid, const KeptFacts& facts,
                                 const std::string& what);

/// The facts of a grid, called `what` now and made of `file`. The grid's own metadata stay in
/// `made`.
[[nodiscard]] KeptFacts factsOf(const LevelSet& grid, const std::string& what,
                                const std::string& file);

[[nodiscard]] std::string textOf(const Box3& box);
[[nodiscard]] std::optional<Box3> boxOf(const std::string& text);

}  // namespace palpate::vdb
