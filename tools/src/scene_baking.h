#pragma once
/// What baking a scene whole and in parts share.

#include <string>

#include "loaded_scene.h"
#include "options.h"
#include "palpate/vdb/bake.h"

namespace palpate::tools {

[[nodiscard]] Error bakeUsageError(std::string message, std::string hint = {});

/// Options that make no sense for a scene are refused, not ignored, and so are layers that it
/// lacks.
void checkSceneOptions(const BakeOptions& options, const SceneDescription& description);

/// Whether --layer asks for this one.
[[nodiscard]] bool isAskedFor(const BakeOptions& options, const std::string& layer);

/// --voxel [m], or 0 if it was not given. @throws Error (kUsage).
[[nodiscard]] double askedVoxel(const BakeOptions& options, const LengthUnit& unit);

/// [m] A share of the longest side, and a note that tells so.
[[nodiscard]] double defaultVoxel(const LengthUnit& unit, const Box3& bounds,
                                  const std::string& what, Console& console);

/// [bytes] What --max-memory leaves beside `taken`; 0 if it was not given. @throws Error (kUsage).
[[nodiscard]] std::uint64_t memoryLeft(const BakeOptions& options, std::uint64_t taken = 0);

/// The same error; where too little memory was allowed, with the option that allows more.
[[nodiscard]] Error withMemoryHint(const Error& error);

/// `taken` [bytes]: what grids before it take.
[[nodiscard]] vdb::BakeOptions gridOptions(const BakeOptions& options, const std::string& layer,
                                           double voxel, const std::string& unit,
                                           const std::string& source, std::uint64_t taken = 0);

/// @throws Error (kInput) if the layer's field reaches to infinity.
void requireBounds(const Field& field, const std::string& layer, const std::string& file);

}  // namespace palpate::tools
