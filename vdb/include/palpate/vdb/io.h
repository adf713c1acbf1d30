#pragma once
/// .vdb files in and out, with the metadata that vdb/README.md lists.

#include <span>
#include <string>
#include <vector>

#include "palpate/export.h"
#include "palpate/vdb/level_set.h"
#include "palpate/vdb/material_grid.h"

namespace palpate::vdb {

/// Writes a temporary file beside `path` and renames it; nothing is left behind on failure.
/// Replaces an existing file only if `overwrite`. The grids of materials follow the others, with
/// the voxels as their maps store them.
/// @throws Error (kOperation).
PALPATE_EXPORT void writeVdb(const std::string& path, std::span<const LevelSet> grids,
                             bool overwrite, std::span<const NamedMaterialGrid> materials = {});

/// One grid of a file as the verb `info` reports it; level sets and others alike.
struct VdbGridSummary {
  std::string name;        ///< may be empty, or occur more than once in a file
  std::string type;        ///< "FloatGrid", ...
  std::string grid_class;  ///< "level set", "fog volume", "unknown"
  LevelSetInfo info;       ///< as far as it applies
};
/// All grids of a file, in its order; no voxel values are read. @throws Error (kInput, vdb.*) if
/// the file cannot be read.
[[nodiscard]] PALPATE_EXPORT std::vector<VdbGridSummary> listVdb(const std::string& path);

/// How to read a grid without a class (OpenVDB's "unknown").
enum class UnknownClass {
  kRefuse,   ///< not read: readVdb() throws
  kLevelSet  ///< signed distances, negative inside: for callers who know that they are
};

/// Reads a float level set; `name` may be empty if the file holds exactly one. A file without a
/// length unit in its metadata needs `unit_if_missing`. @throws Error (kInput) with the reason and
/// remedy.
[[nodiscard]] PALPATE_EXPORT LevelSet readVdb(const std::string& path, const std::string& name,
                                              const std::string& unit_if_missing,
                                              UnknownClass unknown_class = UnknownClass::kRefuse);

}  // namespace palpate::vdb
