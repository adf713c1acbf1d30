#pragma once
/// Shared by bake() and bakeMesh(): checked options, the empty grid, memory, parallel work with
/// progress.

#include <openvdb/openvdb.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "palpate/vdb/bake.h"

namespace palpate::vdb {

/// BakeOptions, checked and converted to the units of the bake.
struct BakePlan {
  double voxel = 0.0;            ///< [m]
  double half_width = 0.0;       ///< [voxels] of the band, each side
  double band = 0.0;             ///< [m] the same
  double meters_per_unit = 1.0;  ///< [m] of the grid's length unit
  float background = 0.0F;       ///< [units]
  std::uint64_t max_memory = 0;  ///< [bytes]
};

/// @throws Error (kInput) naming the option, its value and the values it may have.
[[nodiscard]] BakePlan checkOptions(const BakeOptions& options);

/// The voxels that a band around a surface within `bounds` [m] can touch.
/// @throws Error (kOperation) if they cannot be counted in 32 bits.
[[nodiscard]] openvdb::CoordBBox voxelRange(const Box3& bounds, const BakePlan& plan,
                                            const std::string& name);

/// A grid without voxels; voxel (0, 0, 0) has its center at the world's origin.
[[nodiscard]] openvdb::FloatGrid::Ptr emptyGrid(const BakePlan& plan, const BakeOptions& options);

/// Metadata, name and class. @throws Error (kInput) if no voxel is inside.
[[nodiscard]] LevelSet finishGrid(openvdb::FloatGrid::Ptr grid, const BakePlan& plan,
                                  const BakeOptions& options);

/// The same grid, with `lost` in its metadata if it has lost something.
[[nodiscard]] LevelSet withLostParts(const LevelSet& grid, const std::string& lost);

/// Checks the memory of a band around a surface of `area` [voxels^2].
/// @throws Error (kOperation), naming a voxel size that fits, if it is more than `margin` times the
/// plan's limit.
void requireMemory(double area, double margin, const BakePlan& plan);

/// [bytes] The limit that a `max_memory` stands for: 0 means 80 % of the machine's.
[[nodiscard]] std::uint64_t memoryLimit(std::uint64_t max_memory);

/// Runs body(index) for every index below `count` in parallel, in pieces of some 50 ms between
/// which the calling thread reports progress, from share `from` to `to`.
template <typename Body>
void parallelWithProgress(std::size_t count, const Progress& progress, std::string_view what,
                          double from, double to, const Body& body) {
  std::size_t piece = progress ? 64 : count;
  for (std::size_t done = 0; done < count;) {
    report(progress, what,
           from + (to - from) * static_cast<double>(done) / static_cast<double>(count));
    const std::size_t end = std::min(count, done + piece);
    const auto start = std::chrono::steady_clock::now();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(done, end),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
                      });
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    if (took.count() < 0.025) piece *= 2;
    if (took.count() > 0.1 && piece > 1) piece /= 2;
    done = end;
  }
}

}  // namespace palpate::vdb
