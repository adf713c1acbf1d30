#pragma once
/// A mesh that became a grid, as the search for lost wires asks for it.

#include "bake/grid_values.h"
#include "bake/lost_plates.h"
#include "bake/solid_inside.h"

namespace palpate::vdb {

using Corners = std::array<Vec3, 3>;

[[nodiscard]] inline Corners cornersOf(const Solid& solid, std::uint32_t triangle) {
  const auto& [a, b, c] = solid.triangles[triangle];
  return {solid.vertices[a], solid.vertices[b], solid.vertices[c]};
}

/// How far along a ray a triangle is met, from either side; sides belong to it.
[[nodiscard]] std::optional<double> wayTo(const Corners& triangle, const Vec3& from,
                                          const Vec3& along) noexcept;

/// For one thread. Lengths and places in voxels.
class MeshSolid {
 public:
  MeshSolid(const BakedMesh& mesh, const SolidInside& inside, const GridValues& values)
      : mesh_(mesh), inside_(inside), count_(inside.counter()), values_(values) {}

  /// Walls out of reach of the band are not known, and taken as far.
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
