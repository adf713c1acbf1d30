#pragma once
// The surface of a union of convex solids, by brute force: every triangle less every other solid.

#include <vector>

#include "palpate/vdb/mesh.h"

namespace palpate::vdb::test {

/// Knows nothing of the ways that bakeMesh() goes: a solid is the planes of its triangles, and what
/// of a triangle is in another solid is cut away, one plane after the other.
class UnionOracle {
 public:
  /// Convex solids, wound outwards. Faces of two that look the same way in one plane must not
  /// overlap: each would be taken off the other.
  explicit UnionOracle(const std::vector<Mesh>& parts);

  /// The signed distance at `p`, if it is less than `reach`; else `reach` or its opposite.
  [[nodiscard]] double at(const Vec3& p, double reach) const;

 private:
  struct Convex {
    Box3 box;
    std::vector<Vec3> normals, places;
    std::vector<std::array<Vec3, 3>> triangles;
    [[nodiscard]] bool holds(const Vec3& p) const;
  };
  std::vector<Convex> solids_;
};

}  // namespace palpate::vdb::test
