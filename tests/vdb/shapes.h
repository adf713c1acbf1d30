#pragma once
// Shapes with distances in closed form, and meshes of them.

#include <functional>
#include <string>
#include <utility>

#include "palpate/fields/field.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb::test {

/// A field made from a function, with the properties that it claims.
class FunctionField final : public Field {
 public:
  struct Claims {
    Box3 bounds;
    Metric metric = Metric::kExact;
    double lipschitz = 1.0;
    double feature_size = 1e-3;
    Box3 lipschitz_domain = Box3::everything();
  };
  FunctionField(std::function<FieldSample(const Vec3&)> function, Claims claims)
      : function_(std::move(function)), claims_(claims) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override { return function_(p); }
  [[nodiscard]] Box3 bounds() const noexcept override { return claims_.bounds; }
  [[nodiscard]] Metric metric() const noexcept override { return claims_.metric; }
  [[nodiscard]] double lipschitz() const noexcept override { return claims_.lipschitz; }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override { return claims_.lipschitz_domain; }
  [[nodiscard]] double featureSize() const noexcept override { return claims_.feature_size; }

 private:
  std::function<FieldSample(const Vec3&)> function_;
  Claims claims_;
};

/// Torus about z: radii `big` of the ring, `small` of the tube. Exact distance.
[[nodiscard]] FieldPtr torus(double big, double small);

/// |p|^2 / radius - radius: zero on the sphere, but not a distance. L = 2 in the ball of that
/// radius.
[[nodiscard]] FieldPtr implicitBall(double radius);

[[nodiscard]] BakeOptions voxels(double size, double half_width = 6.0);

/// Box of twelve triangles, wound outwards.
[[nodiscard]] Mesh boxMesh(const Vec3& center, const Vec3& size);

/// Sphere about `center` of 20 * 4^levels triangles, wound outwards.
[[nodiscard]] Mesh ballMesh(const Vec3& center, double radius, int levels);

/// Both meshes in one; `inside_out` reverses the second.
[[nodiscard]] Mesh together(const Mesh& a, const Mesh& b, bool inside_out = false);

}  // namespace palpate::vdb::test
