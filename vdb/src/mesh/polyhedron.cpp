#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <utility>

#include "bake/solid.h"
#include "mesh/flat_faces.h"
#include "palpate/core/error.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {
namespace {

/// Relative to the mesh's size: a point this near to a plane counts as lying in it. Coordinates in
/// floats are off by up to 1e-7.
constexpr double kFlat = 1e-6;
/// For pockets nested deeper than this, a grid is better than a tree of half-spaces.
constexpr int kDeepest = 8;

/// A tree of half-spaces with a known bounding box.
class Polyhedron final : public Field {
 public:
  Polyhedron(FieldPtr tree, const Box3& bounds, double feature)
      : tree_(std::move(tree)), bounds_(bounds), feature_(feature) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    return tree_->sample(p);
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override { return tree_->value(p); }
  void values(const PointBatch& points, ValueBatch& out) const noexcept override {
    tree_->values(points, out);
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override { return tree_->jet(p); }
  [[nodiscard]] Box3 bounds() const noexcept override { return bounds_; }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kBound; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] double featureSize() const noexcept override { return feature_; }
  [[nodiscard]] FieldStructure structure() const noexcept override { return tree_->structure(); }

 private:
  FieldPtr tree_;
  Box3 bounds_;
  double feature_;
};

/// Builds the tree from outside in. A solid is the intersection of the half-spaces of those faces
/// that lie on its convex hull, minus the pockets that the hull closes. A pocket is bounded by
/// connected faces that do not cross an edge of the hull. Its lids lie in planes of the hull, whose
/// half-spaces are in the intersection already. So the pocket is the solid of its own faces turned
/// inside out, and is built the same way.
class TreeBuilder {
 public:
  TreeBuilder(const std::vector<Vec3>& vertices, const FlatFaces& flat, double tolerance)
      : vertices_(vertices), flat_(flat), tolerance_(tolerance) {
    // Faces in one plane share one half-space.
    for (const FlatFace& face : flat.faces) {
      const auto same = std::find_if(planes_.begin(), planes_.end(), [&](const Plane& plane) {
        return glm::dot(plane.normal, face.normal) > 1.0 - 1e-12 &&
               std::abs(plane.offset - face.offset) <= tolerance;
      });
      if (same == planes_.end()) {
        planes_.push_back(
            {face.normal, face.offset, halfSpace(face.offset * face.normal, face.normal)});
        plane_of_.push_back(planes_.size() - 1);
      } else {
        plane_of_.push_back(static_cast<std::size_t>(same - planes_.begin()));
      }
    }
  }

  /// Null if there is no such tree.
  FieldPtr build() {
    std::vector<std::uint32_t> all(flat_.faces.size());
    std::iota(all.begin(), all.end(), 0U);
    return build(all, 0);
  }

 private:
  struct Plane {
    Vec3 normal;
    double offset;
    FieldPtr half_space;
  };

  /// Levels 0, 2, ... give a solid; the others give the outside of a pocket.
  FieldPtr build(const std::vector<std::uint32_t>& faces, int level) {
    if (level > kDeepest) return nullptr;
    std::vector<std::uint32_t> points;
    for (const std::uint32_t face : faces) {
      const auto& mine = flat_.faces[face].vertices;
      points.insert(points.end(), mine.begin(), mine.end());
    }
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());

    const double sign = level % 2 == 0 ? 1.0 : -1.0;
    std::vector<std::uint32_t> within;
    std::vector<std::size_t> used;
    for (const std::uint32_t face : faces) {
      const Plane& plane = planes_[plane_of_[face]];
      const bool is_on_hull = std::all_of(points.begin(), points.end(), [&](std::uint32_t v) {
        return sign * (glm::dot(plane.normal, vertices_[v]) - plane.offset) <= 2.0 * tolerance_;
      });
      if (is_on_hull) {
        used.push_back(plane_of_[face]);
      } else {
        within.push_back(face);
      }
    }
    if (used.empty()) return nullptr;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    std::vector<FieldPtr> operands;
    for (const std::size_t plane : used) operands.push_back(planes_[plane].half_space);
    for (const std::vector<std::uint32_t>& pocket : pocketsOf(within, points)) {
      FieldPtr beyond = build(pocket, level + 1);
      if (!beyond) return nullptr;
      operands.push_back(std::move(beyond));
    }
    if (operands.size() == 1) return operands.front();
    return level % 2 == 0 ? intersect(std::move(operands)) : unite(std::move(operands));
  }

  /// Groups of faces connected across edges that are not edges of the hull of `points`.
  std::vector<std::vector<std::uint32_t>> pocketsOf(const std::vector<std::uint32_t>& faces,
                                                    const std::vector<std::uint32_t>& points) {
    std::map<std::uint32_t, std::uint32_t> parent;
    for (const std::uint32_t face : faces) parent[face] = face;
    const auto root = [&](std::uint32_t face) {
      while (parent[face] != face) face = parent[face] = parent[parent[face]];
      return face;
    };
    for (const FlatEdge& edge : flat_.edges) {
      if (!parent.contains(edge.first) || !parent.contains(edge.second)) continue;
      if (root(edge.first) == root(edge.second) || isOnHull(edge, points)) continue;
      parent[root(edge.first)] = root(edge.second);
    }
    std::map<std::uint32_t, std::vector<std::uint32_t>> pockets;
    for (const std::uint32_t face : faces) pockets[root(face)].push_back(face);
    std::vector<std::vector<std::uint32_t>> list;
    for (auto& [name, pocket] : pockets) list.push_back(std::move(pocket));
    return list;
  }

  /// Whether some plane through the edge has all points on one side: seen along the edge, the
  /// points leave half a turn free.
  [[nodiscard]] bool isOnHull(const FlatEdge& edge,
                              const std::vector<std::uint32_t>& points) const {
    const Vec3& base = vertices_[edge.from];
    const Vec3 along = unitOr(vertices_[edge.to] - base, Vec3(1.0, 0.0, 0.0));
    const Vec3 aside = std::abs(along.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    const Vec3 u = glm::normalize(glm::cross(along, aside));
    const Vec3 w = glm::cross(along, u);
    std::vector<double> angles;
    for (const std::uint32_t v : points) {
      const Vec3 d = vertices_[v] - base;
      const double x = glm::dot(u, d);
      const double y = glm::dot(w, d);
      if (std::hypot(x, y) > 4.0 * tolerance_) angles.push_back(std::atan2(y, x));
    }
    if (angles.empty()) return true;
    std::sort(angles.begin(), angles.end());
    double widest = angles.front() + 2.0 * std::numbers::pi - angles.back();
    for (std::size_t n = 1; n < angles.size(); ++n) {
      widest = std::max(widest, angles[n] - angles[n - 1]);
    }
    return widest > std::numbers::pi - 1e-5;
  }

  const std::vector<Vec3>& vertices_;
  const FlatFaces& flat_;
  double tolerance_;
  std::vector<Plane> planes_;
  std::vector<std::size_t> plane_of_;  ///< number of the half-space of each face
};

/// Whether a point is in a closed mesh: its winding number is not 0.
bool isInside(const std::vector<Vec3>& vertices,
              const std::vector<std::array<std::uint32_t, 3>>& triangles, const Vec3& p) {
  double turns = 0.0;
  for (const auto& [i, j, k] : triangles) {
    const Vec3 a = vertices[i] - p;
    const Vec3 b = vertices[j] - p;
    const Vec3 c = vertices[k] - p;
    const double la = glm::length(a);
    const double lb = glm::length(b);
    const double lc = glm::length(c);
    turns +=
        std::atan2(glm::dot(a, glm::cross(b, c)),
                   la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return std::abs(turns) > std::numbers::pi;
}

/// Whether a tree has the same inside as the mesh: beside the triangles, and anywhere in its box.
bool agrees(const Field& tree, const std::vector<Vec3>& vertices,
            const std::vector<std::array<std::uint32_t, 3>>& triangles, const Box3& box,
            double tolerance) {
  constexpr std::size_t kMostTriangles = 4000;
  const std::size_t step = 1 + triangles.size() / kMostTriangles;
  for (std::size_t t = 0; t < triangles.size(); t += step) {
    const Vec3& a = vertices[triangles[t][0]];
    const Vec3& b = vertices[triangles[t][1]];
    const Vec3& c = vertices[triangles[t][2]];
    const Vec3 normal = glm::cross(b - a, c - a);
    const Vec3 middle = (a + b + c) / 3.0;
    if (std::abs(tree.value(middle)) > 4.0 * tolerance) return false;
    const double longest =
        std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    if (glm::length(normal) < 100.0 * tolerance * longest) continue;
    const Vec3 aside = 8.0 * tolerance * glm::normalize(normal);
    if (!(tree.value(middle + aside) > 0.0) || !(tree.value(middle - aside) < 0.0)) return false;
  }
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-0.05, 1.05);
  const std::size_t points = std::min<std::size_t>(4000, 1 + 100'000'000 / triangles.size());
  for (std::size_t n = 0; n < points; ++n) {
    const Vec3 p = box.lo + Vec3(any(random), any(random), any(random)) * box.size();
    const double value = tree.value(p);
    if (std::abs(value) <= 4.0 * tolerance) continue;
    if ((value < 0.0) != isInside(vertices, triangles, p)) return false;
  }
  return true;
}

/// Whether a few triangles already show that there are too many faces, before the whole mesh is
/// examined.
bool hasManyFaces(const Mesh& mesh, std::size_t most_faces) {
  std::vector<Vec3> normals;
  const std::size_t step = 1 + mesh.triangles.size() / (8 * most_faces + 8);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += step) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (v >= mesh.vertices.size()) return false;  // makeSolid() reports it
    }
    const auto& [i, j, k] = mesh.triangles[t];
    const Vec3 normal =
        unitOr(glm::cross(mesh.vertices[j] - mesh.vertices[i], mesh.vertices[k] - mesh.vertices[i]),
               Vec3(0.0));
    const bool is_known = std::any_of(normals.begin(), normals.end(), [&](const Vec3& other) {
      return glm::distance(other, normal) < 1e-2;
    });
    if (!is_known) normals.push_back(normal);
    if (normals.size() > most_faces) return true;
  }
  return false;
}

}  // namespace

FieldPtr polyhedronField(const Mesh& mesh, std::size_t most_faces) {
  if (most_faces == 0 || hasManyFaces(mesh, most_faces)) return nullptr;
  Solid solid;
  try {
    solid = makeSolid(mesh, 1.0, MeshSign::kVote);
  } catch (const Error& error) {
    if (error.problem().code == "mesh.open") return nullptr;
    throw;
  }
  if (!solid.was_closed) return nullptr;
  const bool inside_out = solid.parts.front().volume < 0.0;
  std::vector<FieldPtr> parts;
  Box3 box;
  for (const SolidPart& part : solid.parts) box = box.unitedWith(part.box);
  const Vec3 lengths = box.size();
  // The feature size: the voxel size that a grid of it would typically have, as a measure for
  // baking.
  const double feature = std::max({lengths.x, lengths.y, lengths.z}) / 128.0;
  std::size_t left = most_faces;
  for (std::uint32_t part = 0; part < solid.parts.size(); ++part) {
    const SolidPart& here = solid.parts[part];
    if ((here.volume < 0.0) != inside_out || here.volume == 0.0) return nullptr;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t t = 0; t < solid.triangles.size(); ++t) {
      if (solid.part_of[t] != part) continue;
      auto triangle = solid.triangles[t];
      if (inside_out) std::swap(triangle[1], triangle[2]);
      triangles.push_back(triangle);
    }
    const double size = glm::length(here.box.size());
    const double tolerance = kFlat * size;
    const auto flat = findFlatFaces(solid.vertices, triangles, tolerance, left);
    if (!flat) return nullptr;
    left -= flat->faces.size();
    FieldPtr tree = TreeBuilder(solid.vertices, *flat, tolerance).build();
    if (!tree || !agrees(*tree, solid.vertices, triangles, here.box, tolerance)) return nullptr;
    parts.push_back(
        std::make_shared<Polyhedron>(std::move(tree), here.box.grownBy(4.0 * tolerance), feature));
  }
  if (parts.size() == 1) return parts.front();
  return unite(std::move(parts));
}

}  // namespace palpate::vdb
