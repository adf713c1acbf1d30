#pragma once
/// The checked parts of a NIfTI header that matter here.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "image/byte_stream.h"
#include "image/place.h"
#include "image/voxels.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {

struct NiftiHeader {
  int version = 1;
  std::array<int, 3> size{};
  VoxelCoding coding;
  std::uint64_t data_offset = 0;  ///< [bytes] of the first voxel of the chosen frame
  std::uint64_t header_bytes = 0;
  std::uint64_t extension_bytes = 0;  ///< between the header and the first voxel of the file
  std::uint64_t later_bytes = 0;      ///< [bytes] of the frames behind the chosen one
  Place place;                        ///< [m], RAS
  std::string length_unit;
  bool is_labels = false;  ///< intent code 1002
  std::vector<std::string> notes;

  [[nodiscard]] std::uint64_t voxelCount() const noexcept {
    return static_cast<std::uint64_t>(size[0]) * static_cast<std::uint64_t>(size[1]) *
           static_cast<std::uint64_t>(size[2]);
  }
};

/// Reads the header at the front of `stream`, and nothing behind it.
/// @throws Error (kInput) if the image cannot be placed in space or read as scalars; also if the
/// file is certainly too short for its voxels.
[[nodiscard]] NiftiHeader readNiftiHeader(ByteStream& stream, const std::string& path,
                                          const ImageOptions& options);

}  // namespace palpate::vdb
