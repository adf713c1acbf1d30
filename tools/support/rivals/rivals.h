#pragma once
/// Published renderers behind our interface, for comparison. Each implements the idea of its source
/// and nothing else: no ports, no contents, no friction. They feel the layers of a scene whose
/// walls are not absent, each layer as a solid from outside, with the stiffness and damping of its
/// wall at that place.

#include <memory>

#include "palpate/render/haptic_renderer.h"
#include "support/rivals/triangle_mesh.h"

namespace palpate::rivals {

// All of them keep their memory outside RendererState: they can be reset, but not resumed from a
// saved state. All throw Error (kInput, rivals.no_solid) for a scene without a solid.

/// The nearest surface point in each tick, without history.
[[nodiscard]] std::unique_ptr<HapticRenderer> closestPoint(ScenePtr scene);

/// The sum over all solids of stiffness times depth, along each solid's gradient.
[[nodiscard]] std::unique_ptr<HapticRenderer> potentialField(ScenePtr scene);

/// Salisbury and Tarr (Proceedings of the ASME Dynamic Systems and Control Division 61, 1997): the
/// probe is projected onto the plane at the last contact point, and that point is brought back to
/// the surface by one Newton step per tick.
[[nodiscard]] std::unique_ptr<HapticRenderer> tangentTracking(ScenePtr scene);

struct SlowPlane {
  double period = 0.01;   ///< [s] from plane to plane
  double recovery = 0.0;  ///< [s] in which a new plane moves to its place; 0: at once
};
/// Adachi, Kumano and Ogino (VRAIS 1995): a plane through the nearest point, renewed slowly. With
/// `recovery`, as by Mark, Randolph, Finch, Van Verth and Taylor (SIGGRAPH 1996), the new plane
/// moves to its place gradually.
[[nodiscard]] std::unique_ptr<HapticRenderer> slowPlane(ScenePtr scene, const SlowPlane& settings);

/// Zilles and Salisbury (IROS 1995): a point that up to three facets hold back, as near to the
/// probe as they allow.
[[nodiscard]] std::unique_ptr<HapticRenderer> godObject(ScenePtr scene, TriangleMesh mesh);

/// Ruspini, Kolarov and Khatib (SIGGRAPH 1997): the god-object, drawn not to the probe but to the
/// point where a plane with the interpolated normal would hold it.
[[nodiscard]] std::unique_ptr<HapticRenderer> forceShading(ScenePtr scene, TriangleMesh mesh);

struct Voxels {
  enum class Gradient { kCentral, kInterpolated, kSobel };
  double size = 1e-3;  ///< [m] of a voxel
  double ramp = 0.0;   ///< [voxels] over which the occupancy rises; 0: it is 0 or 1
  Gradient gradient = Gradient::kInterpolated;
};
/// Avila and Sobierajski (Visualization 1996): voxels that are occupied or not; the interpolated
/// value gives the size of the force, and the gradient of the voxels its direction.
[[nodiscard]] std::unique_ptr<HapticRenderer> voxelOccupancy(ScenePtr scene, const Voxels& voxels);

}  // namespace palpate::rivals
