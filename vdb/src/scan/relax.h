#pragma once
/// The inner loops of the smoothing of masks (smooth_mask.h), on one block of 8^3 voxels.

#include <cstddef>
#include <cstdint>

namespace palpate::vdb {

/// A block and two voxels around it, in OpenVDB's order (the last axis is the fastest). Voxels that
/// do not count are NaN. Voxels across a corner, or farther than (1, 1) off across an edge, are
/// never read.
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

/// Weights of the squares in the energy. Plain arrays: a file compiled for newer processors shares
/// no code with others, not even that of std::array.
struct RelaxWeights {
  float axis[3];   ///< for the second difference along each axis
  float plane[3];  ///< for the mixed difference in the plane across each axis
};

/// The data of one relaxation step. Each voxel moves against the force, is clamped to its bounds,
/// and gets its momentum added. 512 floats each, in OpenVDB's order.
struct RelaxStep {
  const float* bias;   ///< force that is subtracted
  const float* share;  ///< share of the force by which the voxel moves
  const float* lower;
  const float* upper;
  float* value;  ///< in: before; out: after
  float* ahead;  ///< out: the value plus its momentum
  float momentum;
};

/// The loops, for one kind of processor. The force is half the derivative of the weighted sum of
/// squares of all second differences whose voxels count. All loops process the rows (8 x + y) of
/// eight voxels whose bit in `rows` is set; voxels that do not count are NaN, in and out. All kinds
/// give the same bits.
struct RelaxKernels {
  void (*force)(const Patch& patch, std::uint64_t rows, const RelaxWeights& weights, float* out);
  void (*relax)(const Patch& patch, std::uint64_t rows, const RelaxWeights& weights,
                const RelaxStep& step);
  /// One step of diffusion between neighbors that are `stride` apart along each axis: voxels that
  /// do not count exchange nothing.
  void (*diffuse)(const Patch& patch, std::uint64_t rows, int stride, const float* share,
                  float* out);
};

/// The loops for the present processor.
[[nodiscard]] const RelaxKernels& relaxKernels() noexcept;

/// The loops for every processor, the fallback of relaxKernels().
extern const RelaxKernels kBaseRelaxKernels;
#if defined(__x86_64__)
extern const RelaxKernels kAvx2RelaxKernels;
#endif

}  // namespace palpate::vdb
