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

  /// Whether a ray from p leaves the mesh, which is closed and does not pass through itself.
  [[nodiscard]] bool isInside(const Vec3& p) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// Of the mesh's tetrahedra with the origin, each with its sign. [m^3]
[[nodiscard]] double cgalVolume(const Mesh& mesh);

}  // namespace palpate::vdb::test
