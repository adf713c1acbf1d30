#pragma once
/// The inner loops of the smoothing of masks (smooth_mask.h), on one block of 8^3 voxels.

#include <cstddef>
#include <cstdint>

namespace palpate::vdb {

/// A block and two voxels around it, in OpenVDB's order (the last axis is the fastest). Voxels that do not
/// count are NaN. What lies across a corner or off an edge by more than (1, 1) is never read.
struct Patch {
  static constexpr int kHalo = 2;
  static constexpr int kSide = 8 + 2 * kHalo;
  static constexpr int kRow = 16;   ///< floats of a row, of which kSide count
  static constexpr int kFirst = 4;  ///< place of voxel 0 in its row
  static constexpr int kSize = kSide * kSide * kRow;

  alignas(32) float values[kSize];

  [[nodiscard]] static constexpr int at(int x, int y, int z) noexcept {
    return ((x + kHalo) * kSide + y + kHalo) * kRow + z + kFirst;
  }
};

/// Of the squares in the energy. Plain arrays: a file compiled for newer processors shares no code with
/// others, not even that of std::array.
struct RelaxWeights {
  float axis[3];   ///< of the second difference along each axis
  float plane[3];  ///< of the mixed one across each axis
};

/// Half the derivative of the sum of weighted squares of all second differences whose voxels count; for the
/// rows (8 x + y) of eight voxels that `rows` has a bit for. NaN in, NaN out or not: not to be used.
void hessianForce(const Patch& patch, std::uint64_t rows, const RelaxWeights& weights,
                  float* out) noexcept;

/// One step of diffusion to the neighbors `stride` away along each axis: voxels that do not count take
/// nothing.
void diffuse(const Patch& patch, std::uint64_t rows, int stride, const float* share,
             float* out) noexcept;

/// The forms of both; the first two take the one that the processor has. All give the same bits.
void hessianForcePlain(const Patch& patch, std::uint64_t rows, const RelaxWeights& weights,
                       float* out) noexcept;
void hessianForceAvx2(const Patch& patch, std::uint64_t rows, const RelaxWeights& weights,
                      float* out) noexcept;
void diffusePlain(const Patch& patch, std::uint64_t rows, int stride, const float* share,
                  float* out) noexcept;
void diffuseAvx2(const Patch& patch, std::uint64_t rows, int stride, const float* share,
                 float* out) noexcept;

}  // namespace palpate::vdb
