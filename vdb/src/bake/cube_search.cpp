#include "bake/cube_search.h"

#include <cmath>

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using Cube = CubeSearch::Cube;

int alignedDown(int value, int size) { return value & ~(size - 1); }

/// Cubes at the top of the hierarchy: few, so that the first level costs nothing.
std::pair<std::vector<Cube>, int> topCubes(const CoordBBox& range) {
  int size = 8;
  while (size < (1 << 30) && range.dim()[range.maxExtent()] / size >= 4) size *= 2;
  std::vector<Cube> cubes;
  const Coord lo(alignedDown(range.min().x(), size), alignedDown(range.min().y(), size),
                 alignedDown(range.min().z(), size));
  for (int x = lo.x(); x <= range.max().x(); x += size) {
    for (int y = lo.y(); y <= range.max().y(); y += size) {
      for (int z = lo.z(); z <= range.max().z(); z += size) cubes.push_back({{x, y, z}, 0});
    }
  }
  return {std::move(cubes), size};
}

std::vector<Cube> split(const std::vector<Cube>& cubes, int size, const CoordBBox& range) {
  std::vector<Cube> parts;
  parts.reserve(8 * cubes.size());
  for (const Cube& cube : cubes) {
    for (int n = 0; n < 8; ++n) {
      const Coord origin =
          cube.origin.offsetBy((n >> 2) * size, ((n >> 1) & 1) * size, (n & 1) * size);
      if (range.hasOverlap(CoordBBox::createCube(origin, size))) {
        parts.push_back({origin, cube.part});
      }
    }
  }
  return parts;
}

}  // namespace

CubeSearch::CubeSearch(const BandSource& source, const BakePlan& plan, double width, double margin)
    : source_(source), plan_(plan), width_(width), margin_(margin) {}

Vec3 CubeSearch::centerOf(const Coord& origin, int size) const noexcept {
  const double half = 0.5 * (size - 1);
  return Vec3(origin.x() + half, origin.y() + half, origin.z() + half) * plan_.voxel;
}

double CubeSearch::radiusOf(int size) const noexcept {
  return std::sqrt(3.0) * 0.5 * (size - 1) * plan_.voxel;
}

void CubeSearch::run(const CoordBBox& range, const Progress& progress) {
  std::pair<std::vector<Cube>, int> top = topCubes(range);
  std::vector<Cube>& cubes = top.first;
  int& size = top.second;
  parts_.assign(1, source_.whole());
  std::vector<Verdict> verdicts;
  std::vector<FieldPart> left;  // empty where it equals that of the parent cube
  for (;; size /= 2) {
    verdicts.assign(cubes.size(), Verdict::kKeep);
    // Leaves are judged once more when they are filled, so that their reduced fields are not
    // stored.
    const bool is_narrowed = size > 8 && source_.whole().nodes.size() > 1;
    left.assign(is_narrowed ? cubes.size() : 0, {});
    parallelWithProgress(cubes.size(), progress, "bake: finding the surface", 0.0, 0.0,
                         [&](std::size_t i) {
                           verdicts[i] = judge(cubes[i], size, is_narrowed ? &left[i] : nullptr);
                         });
    std::vector<Cube> kept;
    for (std::size_t i = 0; i < cubes.size(); ++i) {
      if (verdicts[i] == Verdict::kInside) inside_.push_back({cubes[i].origin, size});
      if (verdicts[i] != Verdict::kKeep) continue;
      kept.push_back(cubes[i]);
      if (!is_narrowed || left[i].nodes.empty()) continue;
      kept.back().part = static_cast<std::uint32_t>(parts_.size());
      parts_.push_back(std::move(left[i]));
    }
    refuseIfTooLarge(kept.size(), size);
    if (size == 8) {
      cubes_ = std::move(kept);
      return;
    }
    cubes = split(kept, size / 2, range);
  }
}

/// Sets `left`, unless it is null, to the operands that matter in the cube, if these are fewer than
/// in the parent cube.
Verdict CubeSearch::judge(const Cube& cube, int size, FieldPart* left) const {
  thread_local FieldPart here;
  const FieldPart& before = parts_[cube.part];
  const Verdict verdict =
      source_.judge(before, centerOf(cube.origin, size), radiusOf(size), false, here);
  if (left != nullptr && verdict == Verdict::kKeep && here.nodes.size() < before.nodes.size()) {
    *left = here;
  }
  return verdict;
}

/// Blocks are kept in a shell whose half width is their half diagonal plus the band, so that at any
/// size the number of blocks yields the surface's area, and the area the number of leaves. Early
/// levels are coarse, and judged with a wide margin.
void CubeSearch::refuseIfTooLarge(std::size_t blocks, int size) const {
  const double shell = std::sqrt(3.0) * (size - 1.0) + width_;
  const double area = static_cast<double>(blocks) * std::pow(size, 3) / shell;
  constexpr std::size_t kEnoughToCount = 20000;
  const double margin = margin_ * (size == 8 ? 1.0 : 8.0);
  if (size == 8 || blocks > kEnoughToCount) requireMemory(area, margin, plan_);
}

}  // namespace palpate::vdb
