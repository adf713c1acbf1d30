#pragma once
/// What bake() and bakeMesh() share: checked options, the empty grid, memory, parallel work with
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

/// BakeOptions, checked and put into numbers.
struct BakePlan {
  double voxel = 0.0;            ///< [m]
  double band = 0.0;             ///< [m] half width
  double metres_per_unit = 1.0;  ///< [m] of the grid's length unit
  float background = 0.0F;       ///< [units]
  std::uint64_t max_memory = 0;  ///< [bytes]
};

/// Bytes that one allocated leaf takes, with its share of a branch node.
inline constexpr double kLeafBytes = sizeof(openvdb::FloatTree::LeafNodeType) + 512 * 4 + 64;

/// @throws Error (kInput) naming the option, its value and what it may be.
[[nodiscard]] BakePlan checkOptions(const BakeOptions& options);

/// A grid without voxels; voxel (0, 0, 0) has its centre at the world's origin.
[[nodiscard]] openvdb::FloatGrid::Ptr emptyGrid(const BakePlan& plan, const BakeOptions& options);

/// Metadata, name and class. @throws Error (kInput) if no voxel is inside.
[[nodiscard]] LevelSet finishGrid(openvdb::FloatGrid::Ptr grid, const BakePlan& plan,
                                  const BakeOptions& options);

/// @throws Error (kOperation) naming voxel sizes if `bytes` is more than the plan allows; a band grid
/// grows as 1 / voxel^2.
void requireMemory(double bytes, const BakePlan& plan);

/// "0.25 mm"
[[nodiscard]] std::string inMillimetres(double metres);

/// Runs body(index) for every index below `count` in parallel, in pieces of some 50 ms between which
/// the calling thread reports progress, from share `from` to `to`.
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
