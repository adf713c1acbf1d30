#pragma once
/// Checks of a glTF file before Assimp reads it.

#include <string>
#include <string_view>
#include <vector>

namespace palpate::vdb {

/// Assimp parses nested brackets recursively, and trusts every length. These checks cover the
/// header and the chunks of a GLB file, and the nesting depth of the JSON text. Files that are
/// neither pass.
/// @throws Error (kInput): mesh.truncated, mesh.unreadable.
void checkGltf(const std::string& bytes, const std::string& extension, const std::string& path);

/// The files that the buffers of a glTF or GLB file lie in, as it names them. Other names, of
/// textures, and buffers within the file itself do not count.
[[nodiscard]] std::vector<std::string> gltfBuffers(std::string_view bytes);

}  // namespace palpate::vdb
