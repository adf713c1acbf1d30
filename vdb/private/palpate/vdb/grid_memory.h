#pragma once
/// Reading a grid, and making a field of it, within a limit of memory.

#include <cstdint>
#include <string>

#include "palpate/vdb/io.h"
#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// gridField(), with a limit. @throws Error (kOperation, bricks.memory) if grid and bricks together
/// would take more than `max_memory` [bytes]; 0: 80 % of the machine's.
[[nodiscard]] FieldPtr gridField(const LevelSet& grid, Sampler sampler, const Box3& within,
                                 std::uint64_t max_memory);

/// readVdb(), with a limit: the size is known before any voxel is read. @throws Error (kOperation,
/// vdb.memory) if the grid would take more than `max_memory` [bytes]; 0: 80 % of the machine's.
[[nodiscard]] LevelSet readVdb(const std::string& path, const std::string& name,
                               const std::string& unit_if_missing, UnknownClass unknown_class,
                               std::uint64_t max_memory);

}  // namespace palpate::vdb
