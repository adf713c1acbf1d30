#pragma once
/// Voxels as they stand in files, and as floats.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "image/byte_stream.h"
#include "scalar.h"

namespace palpate::vdb {

/// How the bytes of a file become values.
struct VoxelCoding {
  Scalar type = Scalar::kUint8;
  bool swapped = false;  ///< the file's byte order is not this machine's
  bool scaled = false;   ///< slope and intercept are to be applied
  double slope = 1.0;
  double intercept = 0.0;
};

/// What the conversion to float met on its way.
struct Oddities {
  std::uint64_t not_finite = 0;
  std::uint64_t rounded = 0;  ///< integers beyond 2^24, which float cannot hold

  void tell(std::vector<std::string>& notes) const;
};

/// `raw` holds whole voxels, and is swapped in place if need be; `out` has room for them.
void convertVoxels(std::span<unsigned char> raw, const VoxelCoding& coding, float* out,
                   Oddities& odd);

/// `count` voxels from where `stream` is. @throws Error (kInput, "<format>.truncated") if it holds
/// less.
[[nodiscard]] std::vector<float> readVoxels(ByteStream& stream, std::uint64_t count,
                                            const VoxelCoding& coding, Oddities& odd);

/// Passes over `bytes`, which come before `count` voxels.
void skipBytes(ByteStream& stream, std::uint64_t bytes, std::uint64_t count);

}  // namespace palpate::vdb
