#pragma once
/// What of a glTF file is checked before Assimp sees it.

#include <string>

namespace palpate::vdb {

/// Assimp follows brackets by calling itself, and believes every length. Checked here: the head and
/// the chunks of a GLB file, and how deep the JSON text goes. Files that are neither pass.
/// @throws Error (kInput): mesh.truncated, mesh.unreadable.
void checkGltf(const std::string& bytes, const std::string& extension, const std::string& path);

/// Whether the file at `path` is glTF whose buffers lie in files of their own.
[[nodiscard]] bool namesOtherFiles(const std::string& path);

}  // namespace palpate::vdb
