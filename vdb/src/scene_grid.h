#pragma once
/// What all that becomes a grid shares in a scene: its keys, and where its errors are placed.

#include "palpate/scene/scene_file.h"
#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// How a grid is read.
[[nodiscard]] Sampler readSampler(const MapReader& reader);

/// Path of the file at `key`, which must be there; nothing of it is read.
[[nodiscard]] std::string readExistingFile(const MapReader& reader, std::string_view key);

/// `error` as one of the scene's, at `place`: errors of input that are not told there already.
/// Others are thrown as they are.
[[noreturn]] void throwAt(const SourcePlace& place, const Error& error);

}  // namespace palpate::vdb
