#include "vdb/noise_grid.h"

#include <cstdint>

namespace palpate::vdb::test {

using openvdb::Coord;

double noise(int x, int y, int z) {
  std::uint64_t bits = 0x9E3779B97F4A7C15ULL;
  for (const int i : {x, y, z}) {
    bits = (bits ^ static_cast<std::uint32_t>(i)) * 0xBF58476D1CE4E5B9ULL;
    bits ^= bits >> 29;
  }
  const double share = static_cast<double>(bits >> 40) / static_cast<double>(1 << 24);
  return static_cast<float>((6.0 * share - 3.0) * kNoiseVoxel * 1e3) / (kNoiseVoxel * 1e3);
}

LevelSet noiseGrid(const std::vector<Coord>& centers, int half) {
  initializeOpenVdb();
  auto grid = openvdb::FloatGrid::create(static_cast<float>(6.0 * kNoiseVoxel * 1e3));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(kNoiseVoxel * 1e3));
  auto accessor = grid->getAccessor();
  for (const Coord& center : centers) {
    for (int x = -half; x < half; ++x) {
      for (int y = -half; y < half; ++y) {
        for (int z = -half; z < half; ++z) {
          const Coord at = center.offsetBy(x, y, z);
          accessor.setValue(at,
                            static_cast<float>(noise(at.x(), at.y(), at.z()) * kNoiseVoxel * 1e3));
        }
      }
    }
  }
  return makeLevelSet(grid, "mm");
}

std::vector<InstructionSet> instructionSets() {
  std::vector<InstructionSet> sets{InstructionSet::kBase};
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (isSupported(set)) sets.push_back(set);
  }
  return sets;
}

}  // namespace palpate::vdb::test
