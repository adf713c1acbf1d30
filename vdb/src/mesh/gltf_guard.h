#pragma once
/// Checks of a glTF file before Assimp reads it.

#include <string>

namespace palpate::vdb {

/// Assimp parses nested brackets recursively, and trusts every length. These checks cover the
/// header and the chunks of a GLB file, and the nesting depth of the JSON text. Files that are
/// neither pass.
/// @throws Error (kInput): mesh.truncated, mesh.unreadable.
void checkGltf(const std::string& bytes, const std::string& extension, const std::string& path);

/// Whether the file at `path` is glTF with buffers in other files.
[[nodiscard]] bool namesOtherFiles(const std::string& path);

}  // namespace palpate::vdb
