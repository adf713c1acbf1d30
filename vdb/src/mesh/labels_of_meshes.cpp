#include <algorithm>
#include <cmath>
#include <set>

#include "bake/agreement.h"
#include "bake/columns.h"
#include "bake/solid.h"
#include "image/image_parts.h"
#include "image/structures.h"
#include "palpate/core/error.h"
#include "palpate/core/text.h"
#include "palpate/vdb/mesh.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

constexpr double kMostVoxels = 2147483648.0;
constexpr int kFree = 2;  // voxels around the meshes
constexpr const char* kStep = "voxels of models";

/// [voxels] The voxel with the index (0, 0, 0): voxel centers lie at whole numbers of voxels.
using First = std::array<int, 3>;

/// An image around all meshes, without voxels.
Image imageAround(const std::vector<NamedMesh>& meshes, double voxel, First& first) {
  Box3 box;
  for (const NamedMesh& each : meshes) {
    for (const Vec3& v : each.mesh.vertices) box.include(v);
  }
  Image image;
  image.source = meshes.front().mesh.source;
  image.axes = Mat3(voxel);
  double voxels = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    const double begin = std::floor(box.lo[axis] / voxel) - kFree;
    const double last = std::ceil(box.hi[axis] / voxel) + kFree;
    voxels *= last - begin + 1.0;
    if (!(voxels <= kMostVoxels) || !(std::fabs(begin) < kMostVoxels)) {
      throw inputError("models.size",
                       "at voxels of " + shortNumber(1e3 * voxel, 3) +
                           " mm the models take more than 2^31 of them",
                       "give larger voxels");
    }
    first[at] = static_cast<int>(begin);
    image.origin[axis] = begin * voxel;
    image.size[at] = static_cast<int>(last - begin) + 1;
  }
  return image;
}

/// The voxels of `image` inside `mesh`, as bakeMesh() tells inside from outside. Returns whether
/// the mesh was closed.
bool fill(const Mesh& mesh, const Image& image, const First& first, const Progress& progress,
          Structure& out) {
  const double voxel = image.axes[0][0];
  const Solid solid = makeSolid(mesh, voxel, MeshSign::kVote);
  const Columns columns(solid, MeshSign::kVote, {});
  requireAgreement(mesh, solid, columns, voxel);
  std::array<int, 3> begin{};
  std::array<int, 3> end{};
  Box3 box;
  for (const SolidPart& part : solid.parts) box = box.unitedWith(part.box);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    begin[axis] = std::max(0, static_cast<int>(std::floor(box.lo[a])) - first[axis]);
    end[axis] =
        std::min(image.size[axis], static_cast<int>(std::ceil(box.hi[a])) - first[axis] + 1);
  }
  for (int k = begin[2]; k < end[2]; ++k) {
    report(progress, kStep, -1.0);
    for (int j = begin[1]; j < end[1]; ++j) {
      const auto row = static_cast<std::uint64_t>(image.size[0]) *
                       (static_cast<std::uint64_t>(j) +
                        static_cast<std::uint64_t>(image.size[1]) * static_cast<std::uint64_t>(k));
      for (int i = begin[0]; i < end[0]; ++i) {
        if (!columns.isInside(i + first[0], j + first[1], k + first[2])) continue;
        const std::uint64_t at = row + static_cast<std::uint64_t>(i);
        out.add(at, at + 1);
      }
    }
  }
  return solid.was_closed;
}

/// Runs `work`; an error about the mesh's inside gets a hint with a remedy that also works for an
/// import.
template <typename Work>
void withRemedy(double voxel, const Work& work) try {
  work();
} catch (const Error& error) {
  if (error.problem().code != "mesh.open" && error.problem().code != "mesh.ambiguous") throw;
  Problem problem = error.problem();
  problem.hint = "repair it in a mesh editor; or make a closed mesh of it: palpate convert " +
                 fileName(problem.file) + " -o CLOSED.stl --voxel " + shortNumber(1e3 * voxel, 3) +
                 "mm --sign winding";
  throw Error(error.kind(), problem);
}

}  // namespace

Image labelsOfMeshes(const std::vector<NamedMesh>& meshes, double voxel,
                     const std::vector<std::string>& priority, const Progress& progress) try {
  std::set<std::string> names;
  for (const NamedMesh& each : meshes) {
    if (names.insert(each.name).second) continue;
    throw inputError("models.name", "two models are called '" + each.name + "'",
                     "give each file a name of its own", each.mesh.source);
  }
  First first{};
  Image image = imageAround(meshes, voxel, first);
  std::vector<Structure> structures;
  for (std::size_t n = 0; n < meshes.size(); ++n) {
    report(progress, kStep, static_cast<double>(n) / static_cast<double>(meshes.size()));
    Structure structure;
    structure.name = meshes[n].name;
    structure.label = static_cast<int>(n) + 1;
    withRemedy(voxel, [&] {
      if (fill(meshes[n].mesh, image, first, progress, structure)) return;
      image.notes.push_back("the mesh of '" + meshes[n].name +
                            "' was not closed; flat lids close its holes");
    });
    image.labels.names[structure.label] = structure.name;
    structures.push_back(std::move(structure));
  }
  image.values = mergeStructures(structures, "models", priority, image);
  return image;
} catch (const std::bad_alloc&) {
  throw notEnoughMemory("models", meshes.front().mesh.source);
}

}  // namespace palpate::vdb
