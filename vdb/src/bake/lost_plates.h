#pragma once
// Thin parts that a grid of them has lost.

#include <cstdint>
#include <string>
#include <vector>

#include "bake/bake_plan.h"
#include "bake/columns.h"
#include "bake/solid.h"
#include "bake/triangle_bins.h"

namespace palpate::vdb {

/// [voxels] No point of the surface is further than that from the centre of some voxel.
inline constexpr double kBySurface = 0.9;
/// [voxels] Plates from here on are held wherever they pass between voxels: a cell's half diagonal
/// and its mirror image, 1.73, are the longest way that can be free of centres; trilinear values close it at less.
inline constexpr double kHeld = 1.75;
/// [voxels] How far the shape must go on to all sides.
inline constexpr double kGoesOn = 2.0;

/// A plate thinner than about a voxel has no voxel inside where it passes between them: holes, which a hand
/// falls through. Looks for such places from every voxel by the surface; a place counts where the
/// shape goes on for two voxels to all sides, so that the last voxel of a sharp edge or a tip does not.
/// @throws Error (kInput) naming one, the thickness there and a voxel size that holds it.
void refuseLostPlates(const Field& field, const LevelSet& grid, const BakePlan& plan,
                      const BakeOptions& options);

/// A mesh that became a grid.
struct BakedMesh {
  const Solid& walls;  ///< that the distances are of
  const TriangleBins& bins;
  const std::vector<std::uint8_t>&
      faces_itself;    ///< leaf by leaf: walls turned a right angle apart
  const Solid& solid;  ///< that `columns` are of
  const Columns& columns;
};

/// The same of a mesh, in leaves with walls that face away from each other; the others hold no plate.
void refuseLostPlates(const BakedMesh& mesh, const LevelSet& grid, const BakePlan& plan,
                      const BakeOptions& options);

/// Places found, and what is said about them.
struct LostPlates {
  std::size_t places = 0;
  Vec3 where{0.0};        ///< [m] the first
  double thinnest = 0.0;  ///< [m]

  void add(const Vec3& place, double thickness);
  void add(const LostPlates& others);
  /// @throws Error (kInput) if there are any.
  void refuse(const BakePlan& plan, const BakeOptions& options) const;
};

}  // namespace palpate::vdb
