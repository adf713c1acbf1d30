#include "bake/agreement.h"

#include <optional>
#include <string>

#include "bake/walls.h"
#include "palpate/core/error.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {

void requireAgreement(const Mesh& mesh, const Solid& solid, const Columns& columns, double voxel) {
  const std::string hint =
      "repair it in a mesh editor; or choose what decides: --sign winding or --sign flood";
  if (columns.doubt()) {
    throw inputError("mesh.ambiguous",
                     "it is not clear where the mesh is solid: at " +
                         eachInMillimeters(columns.doubt()->place * voxel) + " " +
                         columns.doubt()->why,
                     hint, mesh.source);
  }
  CrossingSearch crossings(solid);
  for (const Columns::Pocket& pocket : columns.pockets()) {
    // A space whose way out is narrower than a voxel is enclosed as well; it is outside, as it
    // should be.
    const std::optional<Vec3> crossing = crossings.in(pocket.box.grownBy(1.5));
    if (!crossing) continue;
    throw inputError(
        "mesh.ambiguous",
        "the mesh passes through itself at " + eachInMillimeters(*crossing * voxel) +
            " and encloses a space of " + std::to_string(pocket.voxels) +
            " voxels there: inside by the flood from outside, outside by the winding number",
        hint, mesh.source);
  }
}

}  // namespace palpate::vdb
