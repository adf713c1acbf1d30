#pragma once
// Distances to meshes and their volumes, by CGAL in double: nothing of ours is in them.

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

  /// Whether the walls on a ray from p, those left less those entered, are any: its winding number,
  /// of a closed mesh.
  [[nodiscard]] bool isInside(const Vec3& p) const;

  /// [m^3] of all that the winding number is not 0 of: by lines along z, `spacing` [m] apart.
  [[nodiscard]] double volume(double spacing) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace palpate::vdb::test
