#pragma once
/// A MetaImage header, checked.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "image/place.h"
#include "image/voxels.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {

struct MetaImageHeader {
  std::array<int, 3> size{};
  int frames = 1;
  VoxelCoding coding;
  bool text = false;  ///< numbers are written as text
  Packing packing = Packing::kNone;
  std::uint64_t compressed_bytes = 0;  ///< as the header says; 0: not stated
  std::string data_path;               ///< the header's own file, or the one that it names
  std::uint64_t data_begin = 0;        ///< [bytes] in that file
  bool at_end = false;                 ///< the voxels are the last bytes of the file
  Place place;                         ///< [m], RAS
  std::vector<std::string> notes;

  [[nodiscard]] std::uint64_t voxelCount() const noexcept {
    return static_cast<std::uint64_t>(size[0]) * static_cast<std::uint64_t>(size[1]) *
           static_cast<std::uint64_t>(size[2]);
  }
};

/// @throws Error (kInput, codes "metaimage.*") if the file cannot be read or placed in space.
[[nodiscard]] MetaImageHeader readMetaImageHeader(const std::string& path,
                                                  const ImageOptions& options);

}  // namespace palpate::vdb
