#include "palpate/vdb/grid_error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

/// [voxels] A surface point farther than this from the voxel where the search began belongs to
/// another voxel.
constexpr double kFarthest = 2.0;

GridError worse(const GridError& a, const GridError& b) {
  GridError out = a.turn >= b.turn ? a : b;
  out.off = std::max(a.off, b.off);
  return out;
}

/// A place in the voxel at `at`, each of whose coordinates is -0.5 to 0.5 voxels from the center,
/// always the same one. A regular lattice would not do: interpolation errors could vanish at all
/// its points.
Vec3 scattered(const openvdb::Coord& at) noexcept {
  Vec3 out(0.0);
  std::uint64_t state = 0x9E3779B97F4A7C15U;
  for (int axis = 0; axis < 3; ++axis) {
    state = (state ^ static_cast<std::uint32_t>(at[axis])) * 0xBF58476D1CE4E5B9U;
    state ^= state >> 31U;
  }
  for (int axis = 0; axis < 3; ++axis) {
    out[axis] =
        static_cast<double>(state >> (21U * static_cast<unsigned>(axis)) & 0xFFFFU) / 65535.0 - 0.5;
  }
  return out;
}

class Comparison {
 public:
  Comparison(const Field& field, const LevelSet& grid, const Field& made, const Box3& box)
      : field_(field), grid_(grid), made_(made), box_(box) {}

  [[nodiscard]] GridError in(const Leaf& leaf) const noexcept {
    const double voxel = grid_.info().voxel_size;
    const auto near = static_cast<float>(voxel / grid_.info().meters_per_unit);
    GridError worst;
    for (auto value = leaf.cbeginValueOn(); value; ++value) {
      if (std::fabs(*value) >= near) continue;
      const openvdb::Coord at = value.getCoord();
      const Vec3 center = grid_.impl().origin + voxel * Vec3(at.x(), at.y(), at.z());
      Vec3 p = center + voxel * scattered(at);
      if (!ontoSurface(p) || !box_.contains(p)) continue;
      if (glm::length(p - center) > kFarthest * voxel) continue;
      worst = worse(worst, errorAt(p));
    }
    return worst;
  }

 private:
  /// Newton's method along the gradient. False if it does not reach the surface.
  [[nodiscard]] bool ontoSurface(Vec3& p) const noexcept {
    const double voxel = grid_.info().voxel_size;
    for (int i = 0; i < 8; ++i) {
      const FieldSample s = field_.sample(p);
      const double square = glm::dot(s.gradient, s.gradient);
      if (!s.in_band || !(square > 0.0)) return false;
      const Vec3 by = s.value / square * s.gradient;
      p -= by;
      if (glm::dot(by, by) < 1e-18 * voxel * voxel) return true;
    }
    return false;
  }

  [[nodiscard]] GridError errorAt(const Vec3& p) const noexcept {
    const FieldSample s = made_.sample(p);
    const double slope = glm::length(s.gradient);
    const Vec3 normal = unitOr(field_.sample(p).gradient, Vec3(0.0));
    if (!s.in_band || !(slope > 0.0)) return {std::fabs(s.value), 3.14159, p};
    const Vec3 made_normal = s.gradient / slope;
    return {std::fabs(s.value) / slope,
            std::atan2(glm::length(glm::cross(normal, made_normal)), glm::dot(normal, made_normal)),
            p};
  }

  const Field& field_;
  const LevelSet& grid_;
  const Field& made_;
  const Box3& box_;
};

}  // namespace

GridError gridError(const Field& field, const LevelSet& grid, const Field& made, const Box3& box,
                    std::size_t most_blocks) {
  std::vector<const Leaf*> leaves;
  grid.impl().grid->tree().getNodes(leaves);
  if (leaves.size() > most_blocks) {
    for (std::size_t i = 0; i < most_blocks; ++i)
      leaves[i] = leaves[i * leaves.size() / most_blocks];
    leaves.resize(most_blocks);
  }
  const Comparison comparison(field, grid, made, box);
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, leaves.size()), GridError{},
      [&](const tbb::blocked_range<std::size_t>& range, GridError worst) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          worst = worse(worst, comparison.in(*leaves[i]));
        }
        return worst;
      },
      worse);
}

GridError smoothGridError(Sampler sampler, double voxel_size) noexcept {
  constexpr double kDegree = std::numbers::pi / 180.0;
  return sampler == Sampler::kCubic ? GridError{0.02 * voxel_size, 1.0 * kDegree}
                                    : GridError{0.1 * voxel_size, 10.0 * kDegree};
}

}  // namespace palpate::vdb
