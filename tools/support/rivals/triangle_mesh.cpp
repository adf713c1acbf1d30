#include "support/rivals/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace palpate::rivals {
namespace {

/// Corner n of a cube is at (n & 1, n >> 1 & 1, n >> 2 & 1). Six tetrahedra about the diagonal from
/// 0 to 7; neighboring cubes use the same diagonals on their common faces.
constexpr std::array<std::array<int, 4>, 6> kTetrahedra{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

class Mesher {
 public:
  Mesher(const Field& field, const Box3& box, double edge)
      : field_(field), lo_(box.lo), edge_(edge) {
    for (int axis = 0; axis < 3; ++axis) {
      count_[axis] = static_cast<int>(std::ceil(box.size()[axis] / edge)) + 1;
    }
  }

  TriangleMesh mesh() && {
    const auto number = [&](int axis) { return static_cast<std::size_t>(count_[axis]); };
    values_.resize(number(0) * number(1) * number(2));
    for (std::size_t n = 0; n < values_.size(); ++n) values_[n] = field_.value(pointOf(n));
    for (int z = 0; z + 1 < count_[2]; ++z) {
      for (int y = 0; y + 1 < count_[1]; ++y) {
        for (int x = 0; x + 1 < count_[0]; ++x) cube(x, y, z);
      }
    }
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] std::size_t indexOf(int x, int y, int z) const {
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    return (at(z) * at(count_[1]) + at(y)) * at(count_[0]) + at(x);
  }
  [[nodiscard]] Vec3 pointOf(std::size_t index) const {
    const auto nx = static_cast<std::size_t>(count_[0]);
    const auto ny = static_cast<std::size_t>(count_[1]);
    const std::size_t x = index % nx;
    const std::size_t y = index / nx % ny;
    const std::size_t z = index / nx / ny;
    return lo_ +
           edge_ * Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
  }

  void cube(int x, int y, int z) {
    std::array<std::size_t, 8> corner{};
    int inside = 0;
    for (int n = 0; n < 8; ++n) {
      corner[static_cast<std::size_t>(n)] =
          indexOf(x + (n & 1), y + (n >> 1 & 1), z + (n >> 2 & 1));
      if (values_[corner[static_cast<std::size_t>(n)]] < 0.0) ++inside;
    }
    if (inside == 0 || inside == 8) return;
    for (const auto& tetrahedron : kTetrahedra) {
      std::array<std::size_t, 4> c{};
      for (std::size_t n = 0; n < 4; ++n) {
        c[n] = corner[static_cast<std::size_t>(tetrahedron[n])];
      }
      cut(c);
    }
  }

  void cut(std::array<std::size_t, 4> c) {
    const auto is_inside = [&](std::size_t index) { return values_[index] < 0.0; };
    auto* const first_outside = std::partition(c.begin(), c.end(), is_inside);
    const auto inside = first_outside - c.begin();
    if (inside == 1) add(between(c[0], c[1]), between(c[0], c[2]), between(c[0], c[3]));
    if (inside == 3) add(between(c[3], c[0]), between(c[3], c[1]), between(c[3], c[2]));
    if (inside == 2) {
      const std::uint32_t a = between(c[0], c[2]);
      const std::uint32_t b = between(c[0], c[3]);
      const std::uint32_t d = between(c[1], c[2]);
      const std::uint32_t e = between(c[1], c[3]);
      add(a, b, d);
      add(b, e, d);
    }
  }

  /// The point of the surface on the edge from a point inside to one outside.
  std::uint32_t between(std::size_t a, std::size_t b) {
    const auto key = std::minmax(a, b);
    const auto [place, is_new] =
        points_.try_emplace(key, static_cast<std::uint32_t>(mesh_.points.size()));
    if (is_new) {
      Vec3 low = pointOf(key.first);
      Vec3 high = pointOf(key.second);
      const bool low_inside = values_[key.first] < 0.0;
      for (int i = 0; i < 50; ++i) {
        const Vec3 middle = 0.5 * (low + high);
        ((field_.value(middle) < 0.0) == low_inside ? low : high) = middle;
      }
      mesh_.points.push_back(low);
      mesh_.normals.push_back(unitOr(field_.sample(low).gradient, Vec3(0.0, 0.0, 1.0)));
    }
    return place->second;
  }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Vec3 across =
        glm::cross(mesh_.points[b] - mesh_.points[a], mesh_.points[c] - mesh_.points[a]);
    if (!(glm::length(across) > 1e-9 * edge_ * edge_)) return;
    const Vec3 out = mesh_.normals[a] + mesh_.normals[b] + mesh_.normals[c];
    if (glm::dot(across, out) < 0.0) std::swap(b, c);
    mesh_.triangles.push_back({a, b, c});
  }

  const Field& field_;
  Vec3 lo_;
  double edge_;
  std::array<int, 3> count_{};
  std::vector<double> values_;
  std::map<std::pair<std::size_t, std::size_t>, std::uint32_t> points_;
  TriangleMesh mesh_;
};

std::vector<Box3> boxesOf(const TriangleMesh& mesh) {
  std::vector<Box3> boxes;
  for (const auto& triangle : mesh.triangles) {
    Box3& box = boxes.emplace_back();
    for (const std::uint32_t point : triangle) box.include(mesh.points[point]);
  }
  return boxes;
}

}  // namespace

TriangleMesh meshOf(const Field& field, const Box3& box, double edge) {
  return Mesher(field, box, edge).mesh();
}

Facets::Facets(TriangleMesh mesh) : mesh_(std::move(mesh)), tree_(boxesOf(mesh_)) {
  for (const auto& t : mesh_.triangles) {
    const Vec3& a = mesh_.points[t[0]];
    planes_.push_back(
        unitOr(glm::cross(mesh_.points[t[1]] - a, mesh_.points[t[2]] - a), Vec3(0.0)));
  }
}

std::optional<Hit> Facets::firstHit(const Vec3& from, const Vec3& to) const noexcept {
  std::optional<Hit> best;
  const Vec3 way = to - from;
  tree_.visit(0.5 * (from + to), 0.5 * glm::length(way), [&](std::uint32_t item) {
    const Vec3& n = planes_[item];
    const double fall = -glm::dot(n, way);
    if (!(fall > 0.0)) return;
    const auto& t = mesh_.triangles[item];
    const Vec3& a = mesh_.points[t[0]];
    const double share = glm::dot(n, from - a) / fall;
    if (!(share >= 0.0 && share <= 1.0) || (best && best->share <= share)) return;
    const Vec3 at = from + share * way;
    for (int i = 0; i < 3; ++i) {
      const Vec3& p = mesh_.points[t[static_cast<std::size_t>(i)]];
      const Vec3& q = mesh_.points[t[static_cast<std::size_t>((i + 1) % 3)]];
      // A path that runs along an edge must hit at least one of the edge's facets.
      const double side = glm::dot(n, glm::cross(q - p, at - p));
      if (side < -1e-12 * glm::dot(q - p, q - p)) return;
    }
    best = Hit{item, share};
  });
  return best;
}

Vec3 Facets::shadedNormal(std::uint32_t triangle, const Vec3& p) const noexcept {
  const auto& t = mesh_.triangles[triangle];
  const Vec3& n = planes_[triangle];
  Vec3 sum(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& q = mesh_.points[t[(i + 1) % 3]];
    const Vec3& r = mesh_.points[t[(i + 2) % 3]];
    sum += glm::dot(n, glm::cross(q - p, r - p)) * mesh_.normals[t[i]];
  }
  return unitOr(sum, n);
}

}  // namespace palpate::rivals
