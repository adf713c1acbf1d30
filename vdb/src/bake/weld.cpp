#include "bake/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace palpate::vdb {
namespace {

/// Relative to the mesh's size. Copies of a corner that are each off by up to 1e-5 along each axis
/// are up to 3.5e-5 apart.
constexpr std::array<double, 3> kReaches{1e-6, 1e-5, 4e-5};
/// [voxels] Joining vertices this near is not felt.
constexpr double kLargestReach = 0.1;
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
  std::vector<std::uint32_t> table(slots, kNone);  // of vertices, each the first at its place
  std::vector<std::uint32_t> name(mesh.vertices.size());
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3& place = mesh.vertices[v];
    if (!isFinite(place)) continue;  // no triangle uses it
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

namespace {

Box3 boundsOf(const Solid& solid) {
  Box3 bounds;
  for (const Triangle& t : solid.triangles) {
    for (const std::uint32_t v : t) bounds.include(solid.vertices[v]);
  }
  return bounds;
}

}  // namespace

std::vector<double> weldReaches(const Solid& solid) {
  const double size = glm::length(boundsOf(solid).size());
  std::vector<double> reaches;
  for (const double share : kReaches) {
    const double reach = std::min(share * size, kLargestReach);
    if (reaches.empty() || reach > reaches.back()) reaches.push_back(reach);
  }
  return reaches;
}

bool weldRims(Solid& solid, const std::vector<Side>& sides, double reach) {
  std::vector<bool> on_rim(solid.vertices.size(), false);
  bool any = false;
  forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin == 2) return;
    on_rim[sides[begin].low] = on_rim[sides[begin].high] = any = true;
  });
  if (!any || !(reach > 0.0)) return false;
  const Box3 bounds = boundsOf(solid);
  // Cells are much larger than the reach, so that few vertices are near a cell's border, where a
  // second cell has to be searched.
  const double size = 16.0 * reach;
  struct Cell {
    Vec3 place;
    std::size_t hash;
  };
  const auto cell_at = [&](const Vec3& place) { return Cell{place, hashOf(place)}; };
  std::size_t slots = 16;
  while (slots < 2 * solid.vertices.size()) slots *= 2;
  std::vector<std::uint32_t> table(slots, kNone);                 // first vertex of each cell
  std::vector<std::uint32_t> next(solid.vertices.size(), kNone);  // next vertex in the same cell
  std::vector<Vec3> cell_of(solid.vertices.size());
  /// The slot of a cell: the one that holds its first vertex, or an empty one.
  const auto slot_of = [&](const Cell& cell) {
    std::size_t slot = cell.hash & (slots - 1);
    while (table[slot] != kNone && cell_of[table[slot]] != cell.place)
      slot = (slot + 1) & (slots - 1);
    return slot;
  };
  std::vector<std::uint32_t> name(solid.vertices.size(), kNone);
  bool joined = false;
  for (std::uint32_t v = 0; v < solid.vertices.size(); ++v) {
    name[v] = v;
    if (!on_rim[v]) continue;
    const Vec3& place = solid.vertices[v];
    const Vec3 in_cells = (place - bounds.lo) / size;
    const Vec3 own = glm::floor(in_cells);
    const Vec3 lowest = glm::floor(in_cells - reach / size);
    const Vec3 highest = glm::floor(in_cells + reach / size);
    for (double x = lowest.x; x <= highest.x && name[v] == v; ++x) {
      for (double y = lowest.y; y <= highest.y && name[v] == v; ++y) {
        for (double z = lowest.z; z <= highest.z && name[v] == v; ++z) {
          const std::size_t slot = slot_of(cell_at(Vec3(x, y, z)));
          for (std::uint32_t other = table[slot]; other != kNone; other = next[other]) {
            if (glm::distance(solid.vertices[other], place) > reach) continue;
            name[v] = other;
            joined = true;
            break;
          }
        }
      }
    }
    if (name[v] != v) continue;
    cell_of[v] = own;
    const std::size_t slot = slot_of(cell_at(own));
    next[v] = table[slot];
    table[slot] = v;
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
