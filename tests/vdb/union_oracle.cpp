#include "vdb/union_oracle.h"

#include <algorithm>
#include <cmath>

namespace palpate::vdb::test {
namespace {

using Polygon = std::vector<Vec3>;

/// Appends to `outside` the pieces of a polygon that are in front of some plane.
void subtract(Polygon polygon, const std::vector<Vec3>& normals, const std::vector<Vec3>& places,
              std::vector<Polygon>& outside) {
  for (std::size_t n = 0; n < normals.size() && polygon.size() > 2; ++n) {
    Polygon front;
    Polygon behind;
    for (std::size_t v = 0; v < polygon.size(); ++v) {
      const Vec3& p = polygon[v];
      const Vec3& q = polygon[(v + 1) % polygon.size()];
      const double a = glm::dot(normals[n], p - places[n]);
      const double b = glm::dot(normals[n], q - places[n]);
      (a > 0.0 ? front : behind).push_back(p);
      if ((a > 0.0) == (b > 0.0)) continue;
      front.push_back(p + a / (a - b) * (q - p));
      behind.push_back(front.back());
    }
    if (front.size() > 2) outside.push_back(front);
    polygon = behind;
  }
}

double distanceTo(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 normal = glm::cross(b - a, c - a);
  double least = kInfinity;
  bool over = glm::dot(normal, normal) > 0.0;
  const Vec3* const corners[] = {&a, &b, &c, &a};
  for (int n = 0; n < 3; ++n) {
    const Vec3 side = *corners[n + 1] - *corners[n];
    const Vec3 from = p - *corners[n];
    over = over && glm::dot(glm::cross(side, from), normal) >= 0.0;
    const double square = glm::dot(side, side);
    const double along = square > 0.0 ? std::clamp(glm::dot(side, from) / square, 0.0, 1.0) : 0.0;
    least = std::min(least, glm::length(from - along * side));
  }
  return over ? std::abs(glm::dot(glm::normalize(normal), p - a)) : least;
}

double distanceTo(const Polygon& polygon, const Vec3& p) {
  double least = kInfinity;
  for (std::size_t n = 1; n + 1 < polygon.size(); ++n) {
    least = std::min(least, distanceTo(polygon[0], polygon[n], polygon[n + 1], p));
  }
  return least;
}

}  // namespace

UnionOracle::UnionOracle(const std::vector<Mesh>& parts) {
  for (const Mesh& mesh : parts) {
    Convex solid;
    for (const auto& [i, j, k] : mesh.triangles) {
      const Vec3& a = mesh.vertices[i];
      const Vec3& b = mesh.vertices[j];
      const Vec3& c = mesh.vertices[k];
      solid.normals.push_back(glm::normalize(glm::cross(b - a, c - a)));
      solid.places.push_back(a);
      solid.triangles.push_back({a, b, c});
      for (const Vec3& v : {a, b, c}) solid.box.include(v);
    }
    solids_.push_back(std::move(solid));
  }
}

bool UnionOracle::Convex::holds(const Vec3& p) const {
  if (!box.contains(p)) return false;
  for (std::size_t n = 0; n < normals.size(); ++n) {
    if (glm::dot(normals[n], p - places[n]) > 0.0) return false;
  }
  return true;
}

double UnionOracle::at(const Vec3& p, double reach) const {
  double least = reach;
  for (const Convex& solid : solids_) {
    if (solid.box.distanceTo(p) > least) continue;
    for (const auto& [a, b, c] : solid.triangles) {
      if (distanceTo(a, b, c, p) >= least) continue;
      Box3 box;
      for (const Vec3& v : {a, b, c}) box.include(v);
      std::vector<Polygon> pieces{{a, b, c}};
      for (const Convex& other : solids_) {
        if (&other == &solid || other.box.intersectedWith(box).isEmpty()) continue;
        std::vector<Polygon> left;
        for (const Polygon& piece : pieces) subtract(piece, other.normals, other.places, left);
        pieces = left;
      }
      for (const Polygon& piece : pieces) least = std::min(least, distanceTo(piece, p));
    }
  }
  const bool inside = std::any_of(solids_.begin(), solids_.end(),
                                  [&](const Convex& solid) { return solid.holds(p); });
  return inside ? -least : least;
}

}  // namespace palpate::vdb::test
