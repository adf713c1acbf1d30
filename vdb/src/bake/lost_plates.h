#pragma once
/// Thin parts that a grid of them has lost.

#include <cstdint>
#include <string>
#include <vector>

#include "bake/bake_plan.h"
#include "bake/columns.h"
#include "bake/solid.h"
#include "bake/triangle_bins.h"

namespace palpate::vdb {

/// [voxels] No point of the surface is further than that from the center of some voxel.
inline constexpr double kBySurface = 0.9;
/// [voxels] Plates from here on are held wherever they pass between voxels: a cell's half diagonal
/// and its mirror image, 1.73, are the longest way that can be free of centers; trilinear values
/// close it at less.
inline constexpr double kHeld = 1.75;
/// [voxels] How far the shape must go on to all sides.
inline constexpr double kGoesOn = 2.0;

enum class LostShape {
  kPlate,
  kWire,  ///< narrower than four voxels across, and goes on for two to both sides
  kCrumb  ///< ends on all sides, and no place of it is in the grid
};

/// A place where something is lost.
struct LostPlace {
  Vec3 where;        ///< [m]
  double thickness;  ///< [m]
  LostShape shape;
};

/// Places found, and what is said about them.
class LostPlaces {
 public:
  [[nodiscard]] bool empty() const noexcept { return places_.empty(); }
  void add(const LostPlace& place) { places_.push_back(place); }
  void add(const LostPlaces& others);
  /// @throws Error (kInput) if there are plates: the first of them, and a voxel that holds all.
  void refusePlates(const BakePlan& plan, const BakeOptions& options) const;
  /// "2 separate parts, the thickest 0.3 mm thin near (...)"; empty if there are none.
  [[nodiscard]] std::string wiresAndCrumbs(const BakePlan& plan) const;

 private:
  std::vector<LostPlace> places_;
};

/// A plate thinner than about a voxel has no voxel inside where it passes between them: holes,
/// which a hand falls through; a wire is broken there, and a crumb gone. Looks for such places from
/// every voxel by the surface; a plate counts where it goes on for two voxels to all sides, so that
/// the last voxel of a sharp edge does not, a wire where it does so to both (lost_wires.h). Wires
/// and crumbs alone are not refused: meshes of scans have some.
/// @throws Error (kInput) naming a plate, the thickness there and a voxel size that holds it.
/// @return LostPlaces::wiresAndCrumbs()
[[nodiscard]] std::string refuseLostPlates(const Field& field, const LevelSet& grid,
                                           const BakePlan& plan, const BakeOptions& options);

/// A mesh that became a grid.
struct BakedMesh {
  const Solid& walls;  ///< that the distances are of
  const TriangleBins& bins;
  const std::vector<std::uint8_t>&
      faces_itself;    ///< leaf by leaf: walls turned a right angle apart
  const Solid& solid;  ///< that `columns` are of
  const Columns& columns;
};

/// The same of a mesh, in leaves with walls that face away from each other; the others hold no
/// plate.
[[nodiscard]] std::string refuseLostPlates(const BakedMesh& mesh, const LevelSet& grid,
                                           const BakePlan& plan, const BakeOptions& options);

}  // namespace palpate::vdb
