#include "bake/weld.h"

#include <cmath>
#include <cstring>
#include <unordered_map>
#include <utility>

namespace palpate::vdb {
namespace {

/// Of the mesh's size: what rounding to floats, or to seven digits of a text, moves a vertex by.
constexpr double kRounding = 1e-6;
constexpr std::uint32_t kNone = 0xffffffffU;

std::size_t hashOf(const Vec3& p) noexcept {
  std::uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::uint64_t bits = 0;
    const double value = p[axis] + 0.0;  // -0 and 0 are one place
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15U;
    hash ^= hash >> 29;
  }
  return hash;
}

}  // namespace

void weld(const Mesh& mesh, double voxel, Solid& solid) {
  std::size_t slots = 16;
  while (slots < 2 * mesh.vertices.size()) slots *= 2;
  std::vector<std::uint32_t> table(slots, kNone);  // of vertices, each the first in its place
  std::vector<std::uint32_t> name(mesh.vertices.size());
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3& place = mesh.vertices[v];
    if (!isFinite(place)) continue;  // no triangle has it
    std::size_t slot = hashOf(place) & (slots - 1);
    while (table[slot] != kNone && mesh.vertices[table[slot]] != place)
      slot = (slot + 1) & (slots - 1);
    if (table[slot] == kNone) {
      table[slot] = v;
      name[v] = static_cast<std::uint32_t>(solid.vertices.size());
      solid.vertices.push_back(place / voxel);
    }
    name[v] = name[table[slot]];
  }
  solid.triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Triangle t{name[a], name[b], name[c]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) solid.triangles.push_back(t);
  }
}

bool weldRims(Solid& solid, const std::vector<Side>& sides) {
  std::vector<bool> on_rim(solid.vertices.size(), false);
  bool any = false;
  forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin == 2) return;
    on_rim[sides[begin].low] = on_rim[sides[begin].high] = any = true;
  });
  if (!any) return false;
  Box3 bounds;
  for (const Triangle& t : solid.triangles) {
    for (const std::uint32_t v : t) bounds.include(solid.vertices[v]);
  }
  const double reach = kRounding * glm::length(bounds.size());
  // Cells as large as the reach: what is near is in the same one or in one beside it.
  const auto cell_of = [&](const Vec3& p) { return glm::floor((p - bounds.lo) / reach); };
  std::unordered_map<std::size_t, std::vector<std::uint32_t>> cells;
  std::vector<std::uint32_t> name(solid.vertices.size(), kNone);
  bool joined = false;
  for (std::uint32_t v = 0; v < solid.vertices.size(); ++v) {
    name[v] = v;
    if (!on_rim[v]) continue;
    const Vec3& place = solid.vertices[v];
    const Vec3 cell = cell_of(place);
    for (int n = 0; n < 27 && name[v] == v; ++n) {
      const Vec3 beside = cell + Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      const auto there = cells.find(hashOf(beside));
      if (there == cells.end()) continue;
      for (const std::uint32_t other : there->second) {
        if (glm::distance(solid.vertices[other], place) > reach) continue;
        name[v] = other;
        joined = true;
        break;
      }
    }
    if (name[v] == v) cells[hashOf(cell)].push_back(v);
  }
  if (!joined) return false;
  std::size_t kept = 0;
  for (const auto& [a, b, c] : solid.triangles) {
    const Triangle t{name[a], name[b], name[c]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) solid.triangles[kept++] = t;
  }
  solid.triangles.resize(kept);
  return true;
}

}  // namespace palpate::vdb
