#include "mesh/gltf_guard.h"

#include <cstdint>
#include <cstring>
#include <string_view>

#include "mesh/builder.h"
#include "palpate/core/error.h"
#include "palpate/core/stop.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

constexpr std::size_t kHead = 12;
constexpr std::size_t kChunkHead = 8;
constexpr std::uint32_t kJson = 0x4E4F534A;
constexpr int kDeepest = 128;  ///< real scenes nest arrays and objects about a dozen deep

/// glTF is little endian.
std::uint32_t wordAt(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;) {
    word = (word << 8U) | static_cast<unsigned char>(bytes[at + i]);
  }
  return word;
}

void checkDepth(std::string_view json, const std::string& path) {
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    if (i % (std::size_t{1} << 16U) == 0) pollStop();
    const char c = json[i];
    if (in_text) {
      if (c == '\\') ++i;
      in_text = c != '"';
    } else if (c == '"') {
      in_text = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kDeepest) {
        throw inputError("mesh.unreadable",
                         "its JSON goes deeper than " + std::to_string(kDeepest) +
                             " brackets at byte " + std::to_string(i),
                         "the file is damaged or was written wrongly; export the mesh again", path);
      }
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
}

}  // namespace

void checkGltf(const std::string& bytes, const std::string& extension, const std::string& path) {
  if (extension == ".gltf") return checkDepth(bytes, path);
  if (extension != ".glb") return;
  const auto fail = [&](const std::string& what) {
    return inputError("mesh.truncated", what,
                      "it was cut short or damaged; copy or export it again", path);
  };
  if (bytes.size() < kHead + kChunkHead || !bytes.starts_with("glTF")) {
    throw inputError("mesh.unreadable", "this is not a GLB file: it does not begin with 'glTF'", "",
                     path);
  }
  const std::size_t whole = wordAt(bytes, 8);
  if (whole > bytes.size()) {
    throw fail("the file has " + std::to_string(bytes.size()) + " bytes and promises " +
               std::to_string(whole));
  }
  if (whole < kHead + kChunkHead) {
    throw fail("the file claims a length of " + std::to_string(whole) +
               " bytes, less than its headers need");
  }
  // To find a second chunk, Assimp uses the file's real length, not the length in the header.
  for (std::size_t at = kHead; at + kChunkHead <= bytes.size();) {
    const std::size_t length = wordAt(bytes, at);
    if (length > bytes.size() - at - kChunkHead) {
      throw fail("a part of " + std::to_string(length) + " bytes at byte " + std::to_string(at) +
                 " reaches beyond the file");
    }
    if (wordAt(bytes, at + 4) == kJson) {
      checkDepth(std::string_view(bytes).substr(at + kChunkHead, length), path);
    }
    // The next chunk begins at a multiple of four bytes.
    at = (at + kChunkHead + length + 3) / 4 * 4;
  }
}

}  // namespace palpate::vdb
