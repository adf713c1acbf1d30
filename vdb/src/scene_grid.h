#pragma once
/// Shared by all kinds of a scene that become grids: their keys, and the place of their errors.

#include "palpate/scene/scene_file.h"
#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// Reads which sampler a grid uses.
[[nodiscard]] Sampler readSampler(const MapReader& reader);

/// Path of the file at `key`, which must exist; the file is not read.
[[nodiscard]] std::string readExistingFile(const MapReader& reader, std::string_view key);

/// Throws `error` with the place in the scene, if it is an error of input without such a place.
/// Other errors are thrown as they are.
[[noreturn]] void throwAt(const SourcePlace& place, const Error& error);

}  // namespace palpate::vdb
