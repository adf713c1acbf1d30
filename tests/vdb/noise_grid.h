#pragma once
// Grids of noise: a voxel that is taken from a wrong place shows at once.

#include <vector>

#include "brick/instruction_set.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb::test {

constexpr double kNoiseVoxel = 0.5e-3;  // [m]

/// [voxels] A fixed number for each voxel, from -3 to 3.
[[nodiscard]] double noise(int x, int y, int z);

/// Noise in cubes of 2 * `half` voxels about `centers`; nothing elsewhere.
[[nodiscard]] LevelSet noiseGrid(const std::vector<openvdb::Coord>& centers, int half);

/// The instruction sets that this processor has.
[[nodiscard]] std::vector<InstructionSet> instructionSets();

}  // namespace palpate::vdb::test
