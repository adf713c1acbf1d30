#include "bake/mesh_solid.h"

#include <algorithm>
#include <cmath>

namespace palpate::vdb {

std::optional<double> wayTo(const Corners& t, const Vec3& from, const Vec3& along) noexcept {
  const Vec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  const double steep = glm::dot(normal, along);
  if (steep == 0.0) return {};
  const double way = glm::dot(normal, t[0] - from) / steep;
  const Vec3 at = from + way * along;
  for (std::size_t n = 0; n < 3; ++n) {
    const Vec3 side = t[(n + 1) % 3] - t[n];
    const double slack = 1e-9 * glm::dot(normal, normal);
    if (glm::dot(glm::cross(side, at - t[n]), normal) < -slack) return {};
  }
  return way;
}

double MeshSolid::wayOut(const Vec3& from, const Vec3& along) const {
  const openvdb::Coord at(static_cast<int>(std::lround(from.x)),
                          static_cast<int>(std::lround(from.y)),
                          static_cast<int>(std::lround(from.z)));
  const auto leaf = mesh_.bins.find(at);
  double least = kInfinity;
  if (!leaf) return least;
  for (const std::uint32_t triangle : mesh_.bins.triangles(*leaf)) {
    const auto way = wayTo(cornersOf(mesh_.walls, triangle), from, along);
    if (way && *way > 0.0) least = std::min(least, *way);
  }
  return least;
}

}  // namespace palpate::vdb
