#pragma once
/// Reads voxels in the types that files use, and converts them to floats.

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
  bool scaled = false;   ///< apply slope and intercept
  double slope = 1.0;
  double intercept = 0.0;
};

/// Unusual values that the conversion to float met.
struct Oddities {
  std::uint64_t not_finite = 0;
  std::uint64_t rounded = 0;  ///< integers beyond 2^24, which float cannot hold

  void tell(std::vector<std::string>& notes) const;
};

/// `raw` holds whole voxels, and is byte-swapped in place if needed; `out` has room for them.
void convertVoxels(std::span<unsigned char> raw, const VoxelCoding& coding, float* out,
                   Oddities& odd);

/// Reads `count` voxels from the present position of `stream`. @throws Error (kInput,
/// "<format>.truncated") if it holds fewer.
[[nodiscard]] std::vector<float> readVoxels(ByteStream& stream, std::uint64_t count,
                                            const VoxelCoding& coding, Oddities& odd);

/// Skips `bytes`, which come before `count` voxels.
void skipBytes(ByteStream& stream, std::uint64_t bytes, std::uint64_t count);

}  // namespace palpate::vdb
