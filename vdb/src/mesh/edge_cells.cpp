#include "mesh/edge_cells.h"

#include <algorithm>
#include <cmath>

#include "palpate/core/bounds_tree.h"

namespace palpate::vdb {
namespace {

std::uint64_t scrambled(std::uint64_t key) noexcept {
  key *= 0x9E3779B97F4A7C15U;
  return key ^ (key >> 29);
}

}  // namespace

Vec3 nearestOf(const Vec3& a, const Vec3& b, const Vec3& p) noexcept {
  const Vec3 side = b - a;
  const double square = glm::dot(side, side);
  if (!(square > 0.0)) return a;
  return a + std::clamp(glm::dot(side, p - a) / square, 0.0, 1.0) * side;
}

NearestPoint nearestOf(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) noexcept {
  const Vec3 normal = glm::cross(b - a, c - a);
  const double area = glm::dot(normal, normal);
  const auto is_left = [&](const Vec3& from, const Vec3& to) {
    return glm::dot(glm::cross(to - from, p - from), normal) >= 0.0;
  };
  if (area > 0.0 && is_left(a, b) && is_left(b, c) && is_left(c, a)) {
    const double height = glm::dot(normal, p - a);
    return {p - height / area * normal, height * height / area, 0};
  }
  const std::array<Vec3, 3> corners{a, b, c};
  NearestPoint best;
  for (std::size_t n = 0; n < 3; ++n) {
    const std::size_t next = (n + 1) % 3;
    const Vec3 side = corners[next] - corners[n];
    const double length = glm::dot(side, side);
    const double along = length > 0.0 ? glm::dot(side, p - corners[n]) / length : 0.0;
    const Vec3 point = corners[n] + std::clamp(along, 0.0, 1.0) * side;
    const double square = glm::dot(p - point, p - point);
    if (square >= best.square) continue;
    const std::size_t feature = along <= 0.0 ? 4 + n : along >= 1.0 ? 4 + next : 1 + n;
    best = {point, square, static_cast<int>(feature)};
  }
  return best;
}

EdgeCells::EdgeCells(const std::vector<Vec3>& vertices, const std::vector<MeshTriangle>& triangles,
                     const std::vector<std::array<std::uint32_t, 2>>& edges, double reach,
                     double size)
    : size_(size) {
  std::vector<Box3> edge_boxes;
  for (const auto& [a, b] : edges) {
    Box3 box;
    box.include(vertices[a]);
    box.include(vertices[b]);
    edge_boxes.push_back(box);
    box_ = box_.unitedWith(box.grownBy(reach));
  }
  lo_ = box_.lo;
  std::vector<Box3> boxes;
  for (const auto& t : triangles) {
    Box3 box;
    for (const std::uint32_t v : t) box.include(vertices[v]);
    boxes.push_back(box);
  }
  const double half = 0.5 * size;
  const double radius = std::sqrt(3.0) * half;
  // The cells along all edges, without duplicates.
  std::vector<std::array<std::int64_t, 3>> cells;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const Vec3 lo = glm::floor((edge_boxes[e].lo - reach - lo_) / size);
    const Vec3 hi = glm::floor((edge_boxes[e].hi + reach - lo_) / size);
    for (auto x = static_cast<std::int64_t>(lo.x); x <= static_cast<std::int64_t>(hi.x); ++x) {
      for (auto y = static_cast<std::int64_t>(lo.y); y <= static_cast<std::int64_t>(hi.y); ++y) {
        for (auto z = static_cast<std::int64_t>(lo.z); z <= static_cast<std::int64_t>(hi.z); ++z) {
          const Vec3 center = lo_ + size * (Vec3(x, y, z) + 0.5);
          const Vec3 near = nearestOf(vertices[edges[e][0]], vertices[edges[e][1]], center);
          if (glm::distance(center, near) <= reach + radius) cells.push_back({x, y, z});
        }
      }
    }
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  std::size_t slots = 16;
  while (slots < 2 * cells.size()) slots *= 2;
  table_.resize(slots);
  const BoundsTree triangle_tree(boxes);
  const BoundsTree edge_tree(edge_boxes);
  std::vector<std::pair<double, std::uint32_t>> near;
  for (const auto& [x, y, z] : cells) {
    const Vec3 center = lo_ + size * (Vec3(x, y, z) + 0.5);
    // A triangle can be nearest to a point of the cell only if it is no farther from the middle
    // than the nearest triangle plus the cell's diameter. The nearest one is at most as far as the
    // edge in this cell.
    near.clear();
    double least = reach + radius;
    triangle_tree.visitMeeting(
        Box3{center, center}.grownBy(reach + 3.0 * radius), [&](std::uint32_t t) {
          const auto& [a, b, c] = triangles[t];
          const double distance =
              std::sqrt(nearestOf(vertices[a], vertices[b], vertices[c], center).square);
          least = std::min(least, distance);
          near.emplace_back(distance, t);
        });
    Cell cell{keyOf(x, y, z), static_cast<std::uint32_t>(lists_.size()), 0, 0};
    std::sort(near.begin(), near.end());
    for (const auto& [distance, t] : near) {
      if (distance <= least + 2.0 * radius) lists_.push_back(t);
    }
    cell.edges = static_cast<std::uint32_t>(lists_.size());
    edge_tree.visitMeeting(Box3{center, center}.grownBy(reach + half), [&](std::uint32_t e) {
      const Vec3 at = nearestOf(vertices[edges[e][0]], vertices[edges[e][1]], center);
      if (glm::distance(at, center) <= reach + radius) lists_.push_back(e);
    });
    cell.end = static_cast<std::uint32_t>(lists_.size());
    std::size_t slot = scrambled(cell.key) & (slots - 1);
    while (table_[slot].key != ~std::uint64_t{0}) slot = (slot + 1) & (slots - 1);
    table_[slot] = cell;
  }
}

EdgeCells::Lists EdgeCells::at(const Vec3& p) const noexcept {
  if (!box_.contains(p)) return {};
  const Vec3 place = glm::floor((p - lo_) / size_);
  const std::uint64_t key =
      keyOf(static_cast<std::int64_t>(place.x), static_cast<std::int64_t>(place.y),
            static_cast<std::int64_t>(place.z));
  for (std::size_t slot = scrambled(key) & (table_.size() - 1);
       table_[slot].key != ~std::uint64_t{0}; slot = (slot + 1) & (table_.size() - 1)) {
    const Cell& cell = table_[slot];
    if (cell.key != key) continue;
    const std::span<const std::uint32_t> all(lists_);
    return {all.subspan(cell.triangles, cell.edges - cell.triangles),
            all.subspan(cell.edges, cell.end - cell.edges)};
  }
  return {};
}

}  // namespace palpate::vdb
