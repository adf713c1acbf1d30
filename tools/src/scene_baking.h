#pragma once
/// Functions for baking a scene as a whole and in parts.

#include <string>

#include "loaded_scene.h"
#include "options.h"
#include "palpate/vdb/bake.h"

namespace palpate::tools {

[[nodiscard]] Error bakeUsageError(std::string message, std::string hint = {});

/// Refuses options that make no sense for a scene, and layers that it does not have.
void checkSceneOptions(const BakeOptions& options, const SceneDescription& description);

/// Whether --layer asks for `layer`.
[[nodiscard]] bool isAskedFor(const BakeOptions& options, const std::string& layer);

/// --voxel [m], or 0 if it was not given. @throws Error (kUsage).
[[nodiscard]] double askedVoxel(const BakeOptions& options, const LengthUnit& unit);

/// [m] A share of the longest side; a note reports it.
[[nodiscard]] double defaultVoxel(const LengthUnit& unit, const Box3& bounds,
                                  const std::string& what, Console& console);

/// [bytes] What remains of --max-memory after `taken`; 0 if the option was not given. @throws Error
/// (kUsage).
[[nodiscard]] std::uint64_t memoryLeft(const BakeOptions& options, std::uint64_t taken = 0);

/// The same error. If too little memory was allowed, it gets a hint to the option that allows more.
[[nodiscard]] Error withMemoryHint(const Error& error);

/// `taken` [bytes]: memory of the grids made before.
[[nodiscard]] vdb::BakeOptions gridOptions(const BakeOptions& options, const std::string& layer,
                                           double voxel, const std::string& unit,
                                           const std::string& source, std::uint64_t taken = 0);

/// @throws Error (kInput) if the layer's field is unbounded.
void requireBounds(const Field& field, const std::string& layer, const std::string& file);

}  // namespace palpate::tools
