#pragma once
// Distances to meshes and their volumes, computed by CGAL in double without any code of ours.

#include <memory>

#include "palpate/vdb/mesh.h"

namespace palpate::vdb::test {

/// Every query searches an AABB tree for the closest point of all triangles. One thread at a time.
class CgalDistance {
 public:
  explicit CgalDistance(const Mesh& mesh);
  ~CgalDistance();
  CgalDistance(const CgalDistance&) = delete;
  CgalDistance& operator=(const CgalDistance&) = delete;

  [[nodiscard]] double to(const Vec3& p) const;

  /// Whether p is inside a closed mesh: on a ray from p, the walls left minus the walls entered are
  /// not 0 (the winding number).
  [[nodiscard]] bool isInside(const Vec3& p) const;

  /// [m^3] Volume of the region whose winding number is not 0, by lines along z, `spacing` [m]
  /// apart.
  [[nodiscard]] double volume(double spacing) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace palpate::vdb::test
