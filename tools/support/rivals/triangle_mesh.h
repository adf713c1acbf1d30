#pragma once
/// A surface made of triangles, for the rivals that need one.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "palpate/core/bounds_tree.h"
#include "palpate/fields/field.h"

namespace palpate::rivals {

/// Corners are counterclockwise as seen from outside.
struct TriangleMesh {
  std::vector<Vec3> points;   ///< [m]
  std::vector<Vec3> normals;  ///< [-] unit, outward, at the points
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The surface of `field` within `box` [m], from cubes of `edge` [m] that are each cut into six
/// tetrahedra. Normals are the field's.
[[nodiscard]] TriangleMesh meshOf(const Field& field, const Box3& box, double edge);

/// The first facet on a straight path.
struct Hit {
  std::uint32_t triangle = 0;
  double share = 0.0;  ///< [-] of the path's length
};

/// A mesh with a search structure for its triangles. Real-time safe except for the constructor.
class Facets {
 public:
  explicit Facets(TriangleMesh mesh);

  /// The first facet that the path from `from` to `to` [m] crosses from outside.
  [[nodiscard]] std::optional<Hit> firstHit(const Vec3& from, const Vec3& to) const noexcept;
  [[nodiscard]] const Vec3& normalOf(std::uint32_t triangle) const noexcept {
    return planes_[triangle];
  }
  [[nodiscard]] const Vec3& cornerOf(std::uint32_t triangle) const noexcept {
    return mesh_.points[mesh_.triangles[triangle][0]];
  }
  /// [-] The unit normal interpolated from the corners by the barycentric coordinates of `p` [m], a
  /// point in the plane of `triangle`.
  [[nodiscard]] Vec3 shadedNormal(std::uint32_t triangle, const Vec3& p) const noexcept;

 private:
  TriangleMesh mesh_;
  std::vector<Vec3> planes_;  ///< [-] unit normals
  BoundsTree tree_;
};

}  // namespace palpate::rivals
