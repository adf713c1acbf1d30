#pragma once
/// A mesh that became a grid, in the form in which the search for lost wires asks for it.

#include "bake/grid_values.h"
#include "bake/lost_plates.h"
#include "bake/solid_inside.h"

namespace palpate::vdb {

using Corners = std::array<Vec3, 3>;

[[nodiscard]] inline Corners cornersOf(const Solid& solid, std::uint32_t triangle) {
  const auto& [a, b, c] = solid.triangles[triangle];
  return {solid.vertices[a], solid.vertices[b], solid.vertices[c]};
}

/// Distance along a ray to a triangle, hit from either side; the sides belong to it.
[[nodiscard]] std::optional<double> wayTo(const Corners& triangle, const Vec3& from,
                                          const Vec3& along) noexcept;

/// For one thread. Lengths and places in voxels.
class MeshSolid {
 public:
  MeshSolid(const BakedMesh& mesh, const SolidInside& inside, const GridValues& values)
      : mesh_(mesh), inside_(inside), count_(inside.counter()), values_(values) {}

  /// Walls beyond the reach of the band are not known, and count as far away.
  [[nodiscard]] double wayOut(const Vec3& from, const Vec3& along) const;
  [[nodiscard]] bool isInside(const Vec3& p) const { return inside_.at(p, count_); }
  [[nodiscard]] bool isHeld(const Vec3& p) const { return values_.at(p) < 0.0; }

 private:
  const BakedMesh& mesh_;
  const SolidInside& inside_;
  mutable WallCount count_;  // scratch
  const GridValues& values_;
};

}  // namespace palpate::vdb
