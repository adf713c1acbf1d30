#pragma once
/// Makes a scene from a mesh, a scan or a grid, so that it can be touched directly.

#include <string>

#include "options.h"
#include "palpate/scene/scene.h"
#include "text.h"

namespace palpate::tools {

/// True unless `path` is already a scene. @throws Error as inputKind() does.
[[nodiscard]] bool isShape(const std::string& path);

/// The scene's text, with absolute paths: one layer for the mesh, for the threshold --above, for
/// each of --labels, or for each surface of a .vdb.
/// @throws Error: kUsage for options that are missing or do not apply to this kind of file; kInput
/// for a .vdb without a surface.
[[nodiscard]] std::string shapeSceneText(const TouchOptions& options);

/// For a scene: checks that no option was given that applies to shapes only. @throws Error
/// (kUsage).
void refuseShapeOptions(const TouchOptions& options);

/// A place on the outermost surface, found from above, and the surface's normal there.
struct SurfacePoint {
  Vec3 place{0.0};   ///< [m]
  Vec3 normal{0.0};  ///< [-] outward, of length 1
};

/// The highest place of the scene's layers on the vertical line through their middle; if that line
/// meets none, on the nearest line that does and whose normal there points upwards.
/// @throws Error (kOperation) if no line meets a surface.
[[nodiscard]] SurfacePoint findSurfacePoint(const Scene& scene);

}  // namespace palpate::tools
