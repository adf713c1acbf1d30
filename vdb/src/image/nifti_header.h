#pragma once
/// What of a NIfTI header matters here, checked.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "image/byte_stream.h"
#include "palpate/core/math.h"

namespace palpate::vdb {

enum class VoxelType {
  kUint8,
  kInt8,
  kUint16,
  kInt16,
  kUint32,
  kInt32,
  kUint64,
  kInt64,
  kFloat32,
  kFloat64
};

[[nodiscard]] const char* nameOf(VoxelType type) noexcept;

struct NiftiHeader {
  std::array<int, 3> size{};
  VoxelType type = VoxelType::kUint8;
  int bytes_per_voxel = 1;
  bool swapped = false;           ///< the file's byte order is not this machine's
  std::uint64_t data_offset = 0;  ///< [bytes] of the first voxel
  bool scaled = false;            ///< slope and intercept are to be applied
  double slope = 1.0;
  double intercept = 0.0;
  Mat3 axes{1.0};              ///< [m per voxel]
  Vec3 origin{0.0, 0.0, 0.0};  ///< [m]
  std::string orientation;     ///< "RAS"
  std::vector<std::string> notes;

  [[nodiscard]] std::uint64_t voxelCount() const noexcept {
    return static_cast<std::uint64_t>(size[0]) * static_cast<std::uint64_t>(size[1]) *
           static_cast<std::uint64_t>(size[2]);
  }
  [[nodiscard]] std::uint64_t dataBytes() const noexcept {
    return voxelCount() * static_cast<std::uint64_t>(bytes_per_voxel);
  }
};

/// Reads the header at the front of `stream`; `consumed` becomes the number of bytes taken from it.
/// @throws Error (kInput) for whatever cannot be placed in space or read as scalars; also if the
/// file is certainly too short for its voxels.
[[nodiscard]] NiftiHeader readNiftiHeader(ByteStream& stream, const std::string& path,
                                          std::uint64_t& consumed);

}  // namespace palpate::vdb
