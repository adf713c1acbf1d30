#include "bake/solid_inside.h"

#include <algorithm>
#include <cmath>

#include "bake/edges.h"
#include "bake/radix_sort.h"

namespace palpate::vdb {

SolidInside::SolidInside(const Solid& solid, const Columns& columns)
    : solid_(solid), columns_(columns) {
  for (const Vec3& v : solid.vertices) box_.include(v);
  double area = 0.0;
  for (const Triangle& t : solid.triangles) area += areaOf(solid.vertices, t);
  // Cells about as large as a triangle, but not so small that large triangles fill the memory.
  cell_ = std::max(1.0, std::sqrt(area / static_cast<double>(solid.triangles.size())));
  const double most = 4.0 * static_cast<double>(solid.triangles.size()) + 1e6;
  cell_ = std::max(cell_, std::sqrt(box_.size().x * box_.size().y / most));
  const auto cells = [&](double size) { return static_cast<std::uint64_t>(size / cell_) + 1; };
  nx_ = cells(box_.size().x);
  ny_ = cells(box_.size().y);
  struct Entry {
    std::uint64_t cell;
    std::uint32_t triangle;
  };
  std::vector<Entry> entries;
  for (std::uint32_t n = 0; n < solid.triangles.size(); ++n) {
    const auto& [i, j, k] = solid.triangles[n];
    const Vec3& a = solid.vertices[i];
    const Vec3& b = solid.vertices[j];
    const Vec3& c = solid.vertices[k];
    const Vec3 lo = glm::min(glm::min(a, b), c) - 1e-6;
    const Vec3 hi = glm::max(glm::max(a, b), c) + 1e-6;
    for (std::uint64_t x = cellAlong(lo.x, 0, nx_); x <= cellAlong(hi.x, 0, nx_); ++x) {
      for (std::uint64_t y = cellAlong(lo.y, 1, ny_); y <= cellAlong(hi.y, 1, ny_); ++y) {
        entries.push_back({x * ny_ + y, n});
      }
    }
  }
  radixSort(entries, bitsFor(nx_ * ny_), [](const Entry& e) { return e.cell; });
  first_.assign(nx_ * ny_ + 1, entries.size());
  for (std::size_t n = entries.size(); n-- > 0;) first_[entries[n].cell] = n;
  for (std::size_t n = first_.size() - 1; n-- > 0;) first_[n] = std::min(first_[n], first_[n + 1]);
  triangles_.reserve(entries.size());
  for (const Entry& entry : entries) triangles_.push_back(entry.triangle);
}

bool SolidInside::at(const Vec3& p, WallCount& count) const {
  if (isBetweenWalls(p, count)) return true;
  if (!columns_.isFilled()) return false;
  const Vec3 lo = glm::floor(p);
  const auto x = static_cast<int>(lo.x);
  const auto y = static_cast<int>(lo.y);
  const auto z = static_cast<int>(lo.z);
  for (int n = 0; n < 8; ++n) {
    if (!columns_.isInside(x + (n >> 2), y + ((n >> 1) & 1), z + (n & 1))) return false;
  }
  return true;
}

bool SolidInside::isBetweenWalls(const Vec3& p, WallCount& count) const {
  count.clear();
  if (p.x < box_.lo.x || p.y < box_.lo.y || p.x > box_.hi.x || p.y > box_.hi.y) return false;
  const std::uint64_t cell = cellAlong(p.x, 0, nx_) * ny_ + cellAlong(p.y, 1, ny_);
  for (std::size_t n = first_[cell]; n < first_[cell + 1]; ++n) {
    const std::uint32_t triangle = triangles_[n];
    const auto& [i, j, k] = solid_.triangles[triangle];
    const WallHit hit =
        hitWall(solid_.vertices[i], solid_.vertices[j], solid_.vertices[k], p.x, p.y);
    if (hit.entered != 0 && hit.z < p.z) count.add(solid_.part_of[triangle], hit.entered);
  }
  return count.isInside();
}

std::uint64_t SolidInside::cellAlong(double v, int axis, std::uint64_t count) const {
  const double place = std::max(0.0, (v - box_.lo[axis]) / cell_);
  return std::min(static_cast<std::uint64_t>(place), count - 1);
}

}  // namespace palpate::vdb
