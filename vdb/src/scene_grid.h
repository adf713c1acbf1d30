#pragma once
/// What all that becomes a grid shares in a scene: its keys, and where its errors are told.

#include "palpate/scene/scene_file.h"
#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// The word at `sampler`; cubic if it is not there.
[[nodiscard]] Sampler readSampler(MapReader& reader);

/// [m] The length at `key`, such as `voxel`, which must be more than 0 if it is given; 0 if it is not.
[[nodiscard]] double readPositiveOrNone(MapReader& reader, const char* key);

/// [voxels] The number at `half_width`; `fallback` if it is not there.
[[nodiscard]] double readHalfWidth(MapReader& reader, double fallback);

/// Path of the file at `key`, which must be there; nothing of it is read.
[[nodiscard]] std::string readExistingFile(MapReader& reader, std::string_view key);

/// `error` as one of the scene's, at `place`: errors of input that are not told there already. Others
/// are thrown as they are.
[[noreturn]] void throwAt(const SourcePlace& place, const Error& error);

}  // namespace palpate::vdb
