#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

#include "bake/bake_plan.h"
#include "bake/edges.h"
#include "bake/wall_count.h"
#include "mesh/exact_side.h"
#include "mesh/triangles_meet.h"
#include "palpate/core/bounds_tree.h"
#include "palpate/vdb/mesh_defects.h"

namespace palpate::vdb {
namespace {

/// Connected sets of vertices.
class Sets {
 public:
  explicit Sets(std::size_t vertices) : parent_(vertices) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }
  std::uint32_t root(std::uint32_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

std::vector<Triangle> withoutDoubles(const Mesh& mesh, MeshDefects& defects) {
  struct Named {
    Triangle corners;  ///< sorted
    std::uint32_t triangle;
  };
  std::vector<Named> all(mesh.triangles.size());
  for (std::uint32_t t = 0; t < all.size(); ++t) {
    all[t] = {mesh.triangles[t], t};
    std::sort(all[t].corners.begin(), all[t].corners.end());
  }
  std::sort(all.begin(), all.end(), [](const Named& a, const Named& b) {
    return a.corners != b.corners ? a.corners < b.corners : a.triangle < b.triangle;
  });
  std::vector<bool> doubled(all.size(), false);
  for (std::size_t n = 1; n < all.size(); ++n) {
    if (all[n].corners == all[n - 1].corners) doubled[all[n].triangle] = true;
  }
  std::vector<Triangle> triangles;
  triangles.reserve(all.size());
  for (std::size_t t = 0; t < all.size(); ++t) {
    if (!doubled[t]) triangles.push_back(mesh.triangles[t]);
  }
  defects.doubled_triangles = mesh.triangles.size() - triangles.size();
  return triangles;
}

void findHoles(const std::vector<Vec3>& vertices, const std::vector<Side>& sides,
               MeshDefects& defects) {
  Sets sets(vertices.size());
  std::vector<Side> borders;
  forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin > 2) ++defects.non_manifold_edges;
    if (end - begin != 1) return;
    borders.push_back(sides[begin]);
    sets.join(sides[begin].low, sides[begin].high);
  });
  defects.boundary_edges = borders.size();
  // Sort edges so that those of one hole are adjacent, and holes are in the order of their
  // vertices.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> by_hole;
  for (std::uint32_t n = 0; n < borders.size(); ++n)
    by_hole.emplace_back(sets.root(borders[n].low), n);
  std::sort(by_hole.begin(), by_hole.end());
  for (std::size_t n = 0; n < by_hole.size(); ++n) {
    if (n == 0 || by_hole[n].first != by_hole[n - 1].first) defects.holes.emplace_back();
    MeshHole& hole = defects.holes.back();
    const Side& edge = borders[by_hole[n].second];
    const double length = glm::distance(vertices[edge.low], vertices[edge.high]);
    ++hole.edges;
    hole.length += length;
    hole.middle += 0.5 * length * (vertices[edge.low] + vertices[edge.high]);
  }
  for (MeshHole& hole : defects.holes) hole.middle /= std::max(hole.length, 1e-300);
  std::stable_sort(defects.holes.begin(), defects.holes.end(),
                   [](const MeshHole& a, const MeshHole& b) { return a.length > b.length; });
}

bool isDegenerate(const std::vector<Vec3>& vertices, const Triangle& t) {
  for (int axis = 0; axis < 3; ++axis) {
    if (sideOfLine(vertices[t[0]], vertices[t[1]], vertices[t[2]], axis) != 0) return false;
  }
  return true;
}

Box3 boxOf(const std::vector<Vec3>& vertices, const Triangle& triangle) {
  Box3 box;
  for (const std::uint32_t vertex : triangle) box.include(vertices[vertex]);
  return box;
}

BoundsTree treeOf(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  std::vector<Box3> boxes;
  boxes.reserve(triangles.size());
  for (const Triangle& triangle : triangles) boxes.push_back(boxOf(vertices, triangle));
  return BoundsTree(boxes);
}

void findCrossings(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                   const BoundsTree& tree, const Progress& progress, MeshDefects& defects) {
  struct Found {
    std::size_t count = 0;
    std::optional<Vec3> first;
  };
  constexpr std::size_t kBatch = 256;
  std::vector<Found> found((triangles.size() + kBatch - 1) / kBatch);
  parallelWithProgress(
      found.size(), progress, "check mesh: self-intersections", 0.3, 1.0, [&](std::size_t batch) {
        const std::size_t end = std::min(triangles.size(), (batch + 1) * kBatch);
        for (std::size_t t = batch * kBatch; t < end; ++t) {
          const auto mine = static_cast<std::uint32_t>(t);
          tree.visitMeeting(boxOf(vertices, triangles[mine]), [&](std::uint32_t other) {
            if (other <= mine) return;
            const auto at = trianglesMeet(vertices, triangles[mine], triangles[other]);
            if (!at) return;
            ++found[batch].count;
            if (!found[batch].first) found[batch].first = at;
          });
        }
      });
  for (const Found& batch : found) {
    if (defects.crossings == 0 && batch.first) defects.first_crossing = *batch.first;
    defects.crossings += batch.count;
  }
}

/// Triangles connected by corners.
struct Part {
  /// The corners farthest out along each axis, in both directions.
  std::array<std::uint32_t, 6> extremes{};
  double volume = 0.0;  ///< [m^3] signed
};

std::vector<Part> findParts(const std::vector<Vec3>& vertices,
                            const std::vector<Triangle>& triangles,
                            std::vector<std::uint32_t>& part_of) {
  Sets sets(vertices.size());
  for (const auto& [a, b, c] : triangles) {
    sets.join(a, b);
    sets.join(b, c);
  }
  constexpr std::uint32_t kNone = 0xffffffffU;
  std::vector<std::uint32_t> name(vertices.size(), kNone);
  std::vector<Vec3> base;  // for each part
  std::vector<Part> parts;
  for (const auto& t : triangles) {
    std::uint32_t& part = name[sets.root(t[0])];
    if (part == kNone) {
      part = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back().extremes.fill(t[0]);
      base.push_back(vertices[t[0]]);
    }
    part_of.push_back(part);
    Part& here = parts[part];
    const Vec3 u = vertices[t[0]] - base[part];
    here.volume +=
        glm::dot(u, glm::cross(vertices[t[1]] - base[part], vertices[t[2]] - base[part])) / 6.0;
    for (const std::uint32_t vertex : t) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto n = static_cast<std::size_t>(axis);
        const double at = vertices[vertex][axis];
        if (at < vertices[here.extremes[n]][axis]) here.extremes[n] = vertex;
        if (at > vertices[here.extremes[n + 3]][axis]) here.extremes[n + 3] = vertex;
      }
    }
  }
  return parts;
}

/// Finds the parts that lie around others, by counting the walls below a point.
class Surroundings {
 public:
  Surroundings(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
               const BoundsTree& tree)
      : vertices_(vertices),
        triangles_(triangles),
        tree_(tree),
        parts_(findParts(vertices, triangles, part_of_)) {}

  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }

  /// Numbers of the parts that contain all extreme corners of part `n`, sorted.
  [[nodiscard]] std::vector<std::uint32_t> around(std::uint32_t n) const {
    std::vector<std::uint32_t> all;
    for (std::size_t i = 0; i < parts_[n].extremes.size(); ++i) {
      const std::vector<std::uint32_t> here = aroundPlace(vertices_[parts_[n].extremes[i]], n);
      if (i == 0) all = here;
      std::vector<std::uint32_t> both;
      std::set_intersection(all.begin(), all.end(), here.begin(), here.end(),
                            std::back_inserter(both));
      all = std::move(both);
      if (all.empty()) break;
    }
    return all;
  }

 private:
  [[nodiscard]] std::vector<std::uint32_t> aroundPlace(const Vec3& place, std::uint32_t own) const {
    std::vector<std::pair<std::uint32_t, int>> below;  // walls entered, by part
    tree_.visitMeeting({Vec3(place.x, place.y, -kInfinity), place}, [&](std::uint32_t t) {
      const auto& [a, b, c] = triangles_[t];
      if (part_of_[t] == own) return;
      const WallHit hit = hitWall(vertices_[a], vertices_[b], vertices_[c], place.x, place.y);
      if (hit.entered != 0 && hit.z < place.z) below.emplace_back(part_of_[t], hit.entered);
    });
    std::sort(below.begin(), below.end());
    std::vector<std::uint32_t> parts;
    for (std::size_t i = 0; i < below.size();) {
      const std::uint32_t part = below[i].first;
      int entered = 0;
      for (; i < below.size() && below[i].first == part; ++i) entered += below[i].second;
      if (entered != 0) parts.push_back(part);
    }
    return parts;
  }

  const std::vector<Vec3>& vertices_;
  const std::vector<Triangle>& triangles_;
  const BoundsTree& tree_;
  std::vector<std::uint32_t> part_of_;  ///< of each triangle; filled while parts_ is made
  std::vector<Part> parts_;
};

/// Tells hollows from parts that are inside out, by the parts around each.
void sortParts(const Surroundings& surroundings, MeshDefects& defects) {
  const std::vector<Part>& parts = surroundings.parts();
  defects.parts = parts.size();
  for (std::uint32_t n = 0; n < parts.size(); ++n) {
    const Part& part = parts[n];
    const Part* next = nullptr;  // the smallest part around it
    for (const std::uint32_t other : surroundings.around(n)) {
      if (next == nullptr || std::abs(parts[other].volume) < std::abs(next->volume)) {
        next = &parts[other];
      }
    }
    if (next == nullptr) {
      defects.inside_out_parts += part.volume < 0.0 ? 1 : 0;
      defects.volume += std::abs(part.volume);
    } else if ((part.volume < 0.0) != (next->volume < 0.0)) {
      ++defects.hollow_parts;
      defects.volume -= std::abs(part.volume);
    }
  }
}

}  // namespace

MeshDefects findDefects(const Mesh& mesh, const Progress& progress) {
  report(progress, "check mesh: edges", 0.0);
  MeshDefects defects;
  std::vector<Triangle> triangles = withoutDoubles(mesh, defects);
  const std::vector<Side> sides = sortedSides(triangles);
  findHoles(mesh.vertices, sides, defects);
  for (const Triangle& t : triangles) {
    defects.area += areaOf(mesh.vertices, t);
    defects.degenerate_triangles += isDegenerate(mesh.vertices, t) ? 1 : 0;
    for (const std::uint32_t vertex : t) defects.bounds.include(mesh.vertices[vertex]);
  }
  report(progress, "check mesh: orientation", 0.1);
  const std::vector<bool> turned = turnAlike(mesh.vertices, sides, triangles);
  defects.turned_triangles =
      static_cast<std::size_t>(std::count(turned.begin(), turned.end(), true));
  const BoundsTree tree = treeOf(mesh.vertices, triangles);
  report(progress, "check mesh: parts", 0.25);
  sortParts(Surroundings(mesh.vertices, triangles, tree), defects);
  findCrossings(mesh.vertices, triangles, tree, progress, defects);
  report(progress, "check mesh", 1.0);
  return defects;
}

}  // namespace palpate::vdb
