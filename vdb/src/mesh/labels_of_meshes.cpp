#include <algorithm>
#include <cmath>
#include <set>

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

/// A triangle that a row of voxel centers passes through.
struct Crossing {
  std::uint64_t row = 0;
  double x = 0.0;  ///< [voxels]
  int turn = 0;    ///< 1 where the row goes in, -1 where it comes out
};

/// Rows of voxel centers along x, and the triangles that each passes. Whether it passes on this or
/// that side of an edge is computed from the edge alone, its ends in the order of their numbers, so
/// that the two triangles of an edge agree and a closed mesh is closed for every row.
class RowCrossings {
 public:
  RowCrossings(const Mesh& mesh, const Image& image) : image_(image) {
    for (const Vec3& v : mesh.vertices) at_.push_back(image.toIndex(v));
    for (const auto& triangle : mesh.triangles) add(triangle);
    std::sort(found_.begin(), found_.end(), [](const Crossing& a, const Crossing& b) {
      return a.row != b.row ? a.row < b.row : a.x < b.x;
    });
  }

  /// The voxels whose centers are inside.
  void fill(Structure& out) const {
    const auto nx = static_cast<std::uint64_t>(image_.size[0]);
    for (std::size_t n = 0; n < found_.size();) {
      const std::uint64_t row = found_[n].row;
      int winding = 0;
      for (; n < found_.size() && found_[n].row == row; ++n) {
        const bool is_entry = winding == 0;
        winding += found_[n].turn;
        if (is_entry) entry_ = found_[n].x;
        if (winding != 0 || is_entry) continue;
        const double first = std::max(0.0, std::ceil(entry_));
        const double end = std::min(static_cast<double>(nx), std::ceil(found_[n].x));
        if (first < end) {
          out.add(row * nx + static_cast<std::uint64_t>(first),
                  row * nx + static_cast<std::uint64_t>(end));
        }
      }
    }
  }

 private:
  /// Twice the area between an edge and a row, in y and z: above 0 on the one side.
  [[nodiscard]] double side(std::uint32_t a, std::uint32_t b, double y, double z) const {
    const bool is_turned = a > b;
    const Vec3& from = at_[is_turned ? b : a];
    const Vec3& to = at_[is_turned ? a : b];
    const double area = (to.y - from.y) * (z - from.z) - (to.z - from.z) * (y - from.y);
    const double sign = area > 0.0 ? 1.0 : -1.0;  // a row through an edge is on its right
    return is_turned ? -sign : sign;
  }

  void add(const std::array<std::uint32_t, 3>& triangle) {
    const auto& [a, b, c] = triangle;
    const Vec3 normal = glm::cross(at_[b] - at_[a], at_[c] - at_[a]);
    if (normal.x == 0.0) return;  // along the rows: its neighbors are passed
    const auto [y0, y1] = std::minmax({at_[a].y, at_[b].y, at_[c].y});
    const auto [z0, z1] = std::minmax({at_[a].z, at_[b].z, at_[c].z});
    const int last_y = std::min(image_.size[1] - 1, static_cast<int>(std::floor(y1)));
    const int last_z = std::min(image_.size[2] - 1, static_cast<int>(std::floor(z1)));
    for (int k = std::max(0, static_cast<int>(std::ceil(z0))); k <= last_z; ++k) {
      for (int j = std::max(0, static_cast<int>(std::ceil(y0))); j <= last_y; ++j) {
        const double first = side(a, b, j, k);
        if (side(b, c, j, k) != first || side(c, a, j, k) != first) continue;
        const double x =
            at_[a].x - ((j - at_[a].y) * normal.y + (k - at_[a].z) * normal.z) / normal.x;
        const auto row = static_cast<std::uint64_t>(j) +
                         static_cast<std::uint64_t>(image_.size[1]) * static_cast<std::uint64_t>(k);
        found_.push_back({row, x, normal.x < 0.0 ? 1 : -1});
      }
    }
  }

  const Image& image_;
  std::vector<Vec3> at_;  ///< [voxels]
  std::vector<Crossing> found_;
  mutable double entry_ = 0.0;
};

/// An image around all meshes, without voxels.
Image imageAround(const std::vector<NamedMesh>& meshes, double voxel) {
  Box3 box;
  for (const NamedMesh& each : meshes) {
    for (const Vec3& v : each.mesh.vertices) box.include(v);
  }
  Image image;
  image.source = meshes.front().mesh.source;
  image.axes = Mat3(voxel);
  double voxels = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double first = std::floor(box.lo[axis] / voxel) - kFree;
    const double last = std::ceil(box.hi[axis] / voxel) + kFree;
    image.origin[axis] = first * voxel;
    voxels *= last - first + 1.0;
    if (!(voxels <= kMostVoxels)) {
      throw inputError("models.size",
                       "at voxels of " + shortNumber(1e3 * voxel, 3) + " mm the models take more " +
                           "than 2^31 of them",
                       "give larger voxels");
    }
    image.size[static_cast<std::size_t>(axis)] = static_cast<int>(last - first) + 1;
  }
  return image;
}

void requireClosed(const Mesh& mesh) {
  const MeshReport report = checkMesh(mesh);
  if (report.isClosed()) return;
  const Vec3 at = 1e3 * report.first_boundary;
  throw inputError("models.open",
                   "the mesh is not closed: " + std::to_string(report.boundary_edges) +
                       " edges have one triangle, the first near (" + shortNumber(at.x, 4) + ", " +
                       shortNumber(at.y, 4) + ", " + shortNumber(at.z, 4) + ") mm",
                   "close it, for instance by `palpate convert` with --sign winding", mesh.source);
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
  Image image = imageAround(meshes, voxel);
  std::vector<Structure> structures;
  for (std::size_t n = 0; n < meshes.size(); ++n) {
    report(progress, "voxels of models",
           static_cast<double>(n) / static_cast<double>(meshes.size()));
    requireClosed(meshes[n].mesh);
    Structure structure;
    structure.name = meshes[n].name;
    structure.label = static_cast<int>(n) + 1;
    RowCrossings(meshes[n].mesh, image).fill(structure);
    image.labels.names[structure.label] = structure.name;
    structures.push_back(std::move(structure));
  }
  image.values = mergeStructures(structures, "models", priority, image);
  return image;
} catch (const std::bad_alloc&) {
  throw notEnoughMemory("models", meshes.front().mesh.source);
}

}  // namespace palpate::vdb
