#pragma once
/// A field's surface as triangles, for display.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "palpate/fields/field.h"

namespace palpate::tools {

struct SurfaceNet {
  std::vector<Vec3> points;                             ///< [m] on the surface, each once
  std::vector<Vec3> normals;                            ///< [-] of the field, outward
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counterclockwise as seen from outside
  double error =
      0.0;        ///< [m] largest distance of a triangle's middle from the surface, to first order
  int cells = 0;  ///< number along the longest side of the box
};

/// `p` moved onto the surface of `field` along its gradient, by at most `reach` [m].
[[nodiscard]] Vec3 onSurface(const Field& field, Vec3 p, double reach);

/// The part of the surface of `field` within the bounded `box`: one point in each lattice cell that
/// the surface passes through, moved onto the surface along the gradient. Where the surface leaves
/// the box, the mesh is open.
[[nodiscard]] SurfaceNet surfaceNet(const Field& field, const Box3& box, int cells);

/// The same on the coarsest of several lattices whose error is at most `tolerance` [m]; if there is
/// none, on the finest.
[[nodiscard]] SurfaceNet surfaceWithin(const Field& field, const Box3& box, double tolerance);

/// Little-endian: "PSRF", the numbers of points and triangles (uint32), the points and the normals
/// (float32, three each), the triangles (uint32, three each).
[[nodiscard]] std::string surfaceBytes(const SurfaceNet& net);

}  // namespace palpate::tools
