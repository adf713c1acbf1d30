#include "bake/empty_solid.h"

#include <algorithm>
#include <cmath>

#include "bake/lost_plates.h"
#include "palpate/core/text.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

std::string inVoxels(double length) { return shortNumber(length, 2) + " voxels"; }

}  // namespace

Error emptySolidError(const Mesh& mesh, const Solid& solid, const BakePlan& plan) {
  Box3 box;
  double volume = 0.0;
  double area = 0.0;
  for (const SolidPart& part : solid.parts) {
    box.include(part.box.lo);
    box.include(part.box.hi);
    volume += std::abs(part.volume);
    area += part.area;
  }
  const Vec3 size = box.size();
  const double longest = std::max({size.x, size.y, size.z});
  // Thickness of a plate: the area is that of its two faces.
  const double thickness = area > 0.0 ? 2.0 * volume / area : 0.0;
  const std::string none = "no voxel lies inside: ";
  const auto lengthText = [&](double voxels) {
    return inMillimeters(voxels * plan.voxel) + " (" + inVoxels(voxels) + ")";
  };
  if (longest < 2.0) {
    return inputError("bake.empty",
                      none + "the whole mesh is only " + lengthText(longest) + " long",
                      "it may have been read in the wrong length unit; else use voxels of " +
                          inMillimeters(longest * plan.voxel / 64.0),
                      mesh.source);
  }
  if (thickness < 1e-6 * longest) {
    return inputError("bake.empty", none + "the mesh encloses no volume: its sides coincide",
                      "make it a shell of some thickness (--shell 2mm, in a scene shell: 2 mm)",
                      mesh.source);
  }
  return inputError(
      "bake.empty",
      none + "the mesh is about " + lengthText(thickness) + " thick, and passes between the voxels",
      "use voxels of " + inMillimeters(thickness * plan.voxel / kHeld) +
          ", or make it a shell of some thickness",
      mesh.source);
}

}  // namespace palpate::vdb
