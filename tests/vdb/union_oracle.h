#pragma once
// The surface of a union of convex solids, by brute force: every triangle minus all other solids.

#include <vector>

#include "palpate/vdb/mesh.h"

namespace palpate::vdb::test {

/// Independent of the method of bakeMesh(): a solid is the set of planes of its triangles, and the
/// parts of a triangle inside another solid are cut away, one plane after another.
class UnionOracle {
 public:
  /// Convex solids, oriented outwards. Faces of two solids with the same normal in one plane must
  /// not overlap: each would be removed because of the other.
  explicit UnionOracle(const std::vector<Mesh>& parts);

  /// The signed distance at `p`, if its size is less than `reach`; else `reach` with that sign.
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
