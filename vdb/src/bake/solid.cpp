#include "bake/solid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "bake/bake_plan.h"
#include "bake/edges.h"
#include "bake/weld.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

/// The largest share of the closed part's area that a lid may have: beyond it, the shape does not
/// tell where the missing wall was.
constexpr double kMostLid = 0.125;
/// [voxels] An open part no larger than this, or no wider than a quarter of a voxel on the mean, is
/// a speck: whatever lid closed it, a grid would hardly show it.
constexpr double kSpeck = 4.0;
constexpr double kSliver = 0.25;
/// A vertex farther out than this many times the extent of all others is taken for a mistake.
constexpr double kFar = 1000.0;

void requireUsable(const Mesh& mesh) {
  if (mesh.triangles.empty()) {
    throw inputError("mesh.no_faces", "the mesh has no faces", "", mesh.source);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t vertex : mesh.triangles[i]) {
      if (vertex >= mesh.vertices.size()) {
        throw inputError("mesh.index",
                         "face " + std::to_string(i) + " (from 0) names vertex " +
                             std::to_string(vertex) + " of " + std::to_string(mesh.vertices.size()),
                         "", mesh.source);
      }
      if (!isFinite(mesh.vertices[vertex])) {
        throw inputError("mesh.not_finite",
                         "vertex " + std::to_string(vertex) + " (from 0) is not a finite point", "",
                         mesh.source);
      }
    }
  }
}

void refuseOutliers(const Mesh& mesh) {
  std::vector<double> values;
  values.reserve(mesh.vertices.size());
  Vec3 middle(0.0);
  Vec3 spread(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (const Vec3& p : mesh.vertices) {
      if (isFinite(p)) values.push_back(p[axis]);  // a vertex that no face uses need not be finite
    }
    // Leaves out a fiftieth on each side; more if there are few vertices.
    const auto fringe = static_cast<std::ptrdiff_t>(
        std::max<std::size_t>(values.size() / 50, std::min<std::size_t>(values.size() / 3, 6)));
    const auto lo = values.begin() + fringe;
    const auto hi = values.end() - 1 - fringe;
    std::nth_element(values.begin(), lo, values.end());
    const double low = *lo;
    std::nth_element(values.begin(), hi, values.end());
    middle[axis] = 0.5 * (low + *hi);
    spread[axis] = *hi - low;
  }
  const double size = glm::length(spread);
  if (!(size > 0.0)) return;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      const Vec3& p = mesh.vertices[vertex];
      if (glm::distance(p, middle) <= kFar * size) continue;
      throw inputError("mesh.outlier",
                       "vertex " + std::to_string(vertex) + " (from 0) lies at " +
                           eachInMillimeters(p) +
                           ", more than a thousand times the size of the rest away",
                       "remove it, or put it where it belongs", mesh.source);
    }
  }
}

/// Of triangles with the same corners only the first is kept, whichever way they are turned.
void dropDoubles(std::vector<Triangle>& triangles, const std::vector<Side>& sides) {
  std::vector<bool> doubled(triangles.size(), false);
  const auto third = [&](const Side& side) {
    const Triangle& t = triangles[side.triangle];
    return t[0] + t[1] + t[2] - side.low - side.high;
  };
  bool any = false;
  forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
    // Sides of an edge come in the order of their triangles.
    for (std::size_t n = begin + 1; n < end; ++n) {
      for (std::size_t m = begin; m < n; ++m) {
        if (third(sides[m]) == third(sides[n])) doubled[sides[n].triangle] = any = true;
      }
    }
  });
  if (!any) return;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!doubled[t]) triangles[kept++] = triangles[t];
  }
  triangles.resize(kept);
}

Solid cleaned(const Mesh& mesh, double voxel, std::vector<Side>& sides) {
  requireUsable(mesh);
  refuseOutliers(mesh);
  Solid solid;
  weld(mesh, voxel, solid);
  const auto require_some = [&] {
    if (!solid.triangles.empty()) return;
    throw inputError("mesh.no_faces", "all faces of the mesh have two corners in one point", "",
                     mesh.source);
  };
  require_some();
  sides = sortedSides(solid.triangles);
  for (const double reach : weldReaches(solid)) {
    if (!weldRims(solid, sides, reach)) continue;
    require_some();
    sides = sortedSides(solid.triangles);
  }
  const std::size_t before = solid.triangles.size();
  dropDoubles(solid.triangles, sides);
  if (solid.triangles.size() != before) sides = sortedSides(solid.triangles);
  return solid;
}

bool isConsistent(const std::vector<Side>& sides) {
  bool consistent = true;
  forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
    consistent = consistent && end - begin == 2 && sides[begin].upwards != sides[begin + 1].upwards;
  });
  return consistent;
}

/// Gives each triangle the number of its part; parts are connected by vertices.
void findParts(Solid& solid) {
  std::vector<std::uint32_t> parent(solid.vertices.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& [a, b, c] : solid.triangles) {
    parent[root(a)] = root(b);
    parent[root(b)] = root(c);
  }
  constexpr std::uint32_t kNone = 0xffffffffU;
  std::vector<std::uint32_t> name(solid.vertices.size(), kNone);
  solid.part_of.clear();
  for (const Triangle& t : solid.triangles) {
    std::uint32_t& part = name[root(t[0])];
    if (part == kNone) {
      part = static_cast<std::uint32_t>(solid.parts.size());
      solid.parts.push_back({0.0, 0.0, 0.0, solid.vertices[t[0]], {}});
    }
    solid.part_of.push_back(part);
    SolidPart& here = solid.parts[part];
    const Vec3 u = solid.vertices[t[0]] - here.place;
    const Vec3 v = solid.vertices[t[1]] - here.place;
    const Vec3 w = solid.vertices[t[2]] - here.place;
    here.volume += glm::dot(u, glm::cross(v, w)) / 6.0;
    here.area += areaOf(solid.vertices, t);
    for (const std::uint32_t vertex : t) here.box.include(solid.vertices[vertex]);
  }
}

/// [voxels^2] For each part the area of its lids: the triangles from `first_lid` on.
std::vector<double> lidsOf(const Solid& solid, std::size_t first_lid) {
  std::vector<double> lids(solid.parts.size(), 0.0);
  for (std::size_t t = first_lid; t < solid.triangles.size(); ++t) {
    lids[solid.part_of[t]] += areaOf(solid.vertices, solid.triangles[t]);
  }
  return lids;
}

/// Whether an open part is too small for a grid to show.
bool isSpeck(const SolidPart& part, double lid) {
  if (lid <= kMostLid * part.area) return false;
  const double length = glm::length(part.box.size());
  return length <= kSpeck || part.area - lid <= kSliver * length;
}

/// Removes the triangles of open specks, with their lids, unless nothing else is there. Adjusts
/// `first_lid` and `holes` to the triangles that are left.
void dropSpecks(Solid& solid, std::vector<Hole>& holes, std::size_t& first_lid,
                std::vector<bool>& turned, double voxel) {
  const std::vector<double> lids = lidsOf(solid, first_lid);
  std::vector<bool> is_speck(solid.parts.size());
  std::size_t count = 0;
  const SolidPart* largest = nullptr;
  const auto size = [](const SolidPart& part) { return glm::length(part.box.size()); };
  for (std::size_t part = 0; part < lids.size(); ++part) {
    is_speck[part] = isSpeck(solid.parts[part], lids[part]);
    if (!is_speck[part]) continue;
    ++count;
    if (largest == nullptr || size(solid.parts[part]) > size(*largest)) {
      largest = &solid.parts[part];
    }
  }
  if (count == 0 || count == solid.parts.size()) return;
  solid.dropped = std::to_string(count) + (count == 1 ? " open fragment, " : " open fragments, ") +
                  (count == 1 ? "" : "the largest ") + inMillimeters(size(*largest) * voxel) +
                  " across near " + eachInMillimeters(largest->box.center() * voxel);
  std::size_t lid = first_lid;
  std::erase_if(holes, [&](const Hole& hole) {
    const bool is_gone = is_speck[solid.part_of[lid]];
    lid += hole.lid.size();
    return is_gone;
  });
  std::size_t kept = 0;
  std::size_t kept_first_lid = 0;
  for (std::size_t t = 0; t < solid.triangles.size(); ++t) {
    if (is_speck[solid.part_of[t]]) continue;
    if (t < first_lid) {
      turned[kept] = turned[t];
      ++kept_first_lid;
    }
    solid.triangles[kept++] = solid.triangles[t];
  }
  solid.triangles.resize(kept);
  first_lid = kept_first_lid;
  solid.parts.clear();
  findParts(solid);
}

/// Lids must be small compared with the part that they close. @throws Error naming the largest
/// hole.
void requireSmallLids(const Mesh& mesh, const Solid& solid, const std::vector<Hole>& holes,
                      std::size_t first_lid, double voxel) {
  const std::vector<double> lids = lidsOf(solid, first_lid);
  for (std::size_t part = 0; part < lids.size(); ++part) {
    if (lids[part] <= kMostLid * solid.parts[part].area) continue;
    const Hole* worst = nullptr;
    std::size_t count = 0;
    std::size_t t = first_lid;
    for (const Hole& hole : holes) {
      if (solid.part_of[t] == part) {
        ++count;
        if (worst == nullptr || hole.area > worst->area) worst = &hole;
      }
      t += hole.lid.size();
    }
    if (worst == nullptr) continue;
    Vec3 middle(0.0);
    Box3 box;
    for (const std::uint32_t v : worst->loop) {
      middle += solid.vertices[v] / static_cast<double>(worst->loop.size());
      box.include(solid.vertices[v]);
    }
    throw inputError(
        "mesh.open",
        "the mesh is open: " + std::to_string(count) + (count == 1 ? " hole" : " holes") +
            ", the largest " + inMillimeters(glm::length(box.size()) * voxel) + " across at " +
            eachInMillimeters(middle * voxel) +
            ", too large a share of the surface to be closed by a guess",
        "close it in a mesh editor; or let the winding number decide (--sign winding), which puts "
        "flat lids on all holes; or ask for a shell of some thickness (--shell 2mm)",
        mesh.source);
  }
}

}  // namespace

Solid makeSurface(const Mesh& mesh, double voxel) {
  std::vector<Side> sides;
  return cleaned(mesh, voxel, sides);
}

Solid makeSolid(const Mesh& mesh, double voxel, MeshSign sign) {
  std::vector<Side> sides;
  Solid solid = cleaned(mesh, voxel, sides);
  if (isConsistent(sides)) {
    findParts(solid);
    return solid;
  }
  solid.was_closed = false;
  std::vector<bool> turned = turnAlike(solid.vertices, sides, solid.triangles);
  sides = sortedSides(solid.triangles);
  std::vector<Hole> holes = closeHoles(solid.vertices, sides);
  std::size_t first_lid = solid.triangles.size();
  for (const Hole& hole : holes) {
    solid.triangles.insert(solid.triangles.end(), hole.lid.begin(), hole.lid.end());
  }
  findParts(solid);
  if (sign == MeshSign::kVote) dropSpecks(solid, holes, first_lid, turned, voxel);
  for (std::size_t t = 0; t < first_lid; ++t) {
    SolidPart& part = solid.parts[solid.part_of[t]];
    if (turned[t]) part.minority += areaOf(solid.vertices, solid.triangles[t]) / part.area;
  }
  if (sign == MeshSign::kVote) requireSmallLids(mesh, solid, holes, first_lid, voxel);
  return solid;
}

}  // namespace palpate::vdb
