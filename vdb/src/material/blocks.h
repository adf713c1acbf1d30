#pragma once
/// The voxels of a material grid, laid out for reading: blocks of 8^3 with a border of one voxel,
/// so that the 27 voxels of a sample lie in one block.

#include <array>
#include <cstdint>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/vdb/material_grid.h"

namespace palpate::vdb {

struct MaterialGrid::Blocks {
  static constexpr int kSide = 8;               // voxels of the block itself
  static constexpr int kRow = kSide + 2;        // with its border
  static constexpr std::size_t kVolume = 1000;  // kRow^3
  static constexpr std::uint32_t kUniform = ~std::uint32_t{0};

  struct Block {
    // Number among the stored blocks; or kUniform: all voxels are alike
    std::uint32_t first = kUniform;
    float uniform = 0.0F;  // their count (or value) if all are alike
  };

  std::array<int, 3> size{};   // voxels
  std::array<int, 3> count{};  // blocks
  std::vector<Block> table;
  // Only one of the three is used, depending on the bits.
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint16_t> words;
  std::vector<float> floats;

  [[nodiscard]] const Block& blockOf(int i, int j, int k) const noexcept {
    const int number = i / kSide + count[0] * (j / kSide + count[1] * (k / kSide));
    return table[static_cast<std::size_t>(number)];
  }
  /// Index of the first of the 3^3 voxels around one, in its block: the border puts it one voxel
  /// before that voxel.
  [[nodiscard]] static std::size_t cornerOf(int i, int j, int k) noexcept {
    const int corner = ((k % kSide) * kRow + j % kSide) * kRow + i % kSide;
    return static_cast<std::size_t>(corner);
  }
  /// The stored count (or value) of one voxel.
  [[nodiscard]] double at(int i, int j, int k, int bits) const noexcept;
  [[nodiscard]] std::uint64_t memory() const noexcept {
    return table.size() * sizeof(Block) + bytes.size() + 2 * words.size() + 4 * floats.size();
  }
};

}  // namespace palpate::vdb
