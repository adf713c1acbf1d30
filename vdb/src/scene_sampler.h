#pragma once
/// `sampler` in a scene: how a field or layer reads its grid.

#include "palpate/scene/scene_file.h"
#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// The word at `sampler`; cubic if it is not there.
[[nodiscard]] inline Sampler readSampler(MapReader& reader) {
  const std::string name = reader.textOr("sampler", "cubic");
  if (name == "cubic") return Sampler::kCubic;
  if (name == "trilinear") return Sampler::kTrilinear;
  if (name == "accessor") return Sampler::kAccessor;
  throw reader.errorAt("sampler", "scene.kind", "'sampler' is `" + name + "`",
                       "write sampler: cubic, sampler: trilinear or sampler: accessor");
}

}  // namespace palpate::vdb
