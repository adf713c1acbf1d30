#pragma once
/// Finds thin parts that a grid has lost.

#include <cstdint>
#include <string>
#include <vector>

#include "bake/bake_plan.h"
#include "bake/columns.h"
#include "bake/solid.h"
#include "bake/triangle_bins.h"

namespace palpate::vdb {

/// [voxels] No point of the surface is farther than this from the nearest voxel center.
inline constexpr double kBySurface = 0.9;
/// [voxels] A grid holds plates of this thickness wherever they pass between voxels. The longest
/// way free of voxel centers is a cell's half diagonal and its mirror image, 1.73; trilinear values
/// close a plate already at less.
inline constexpr double kHeld = 1.75;
/// [voxels] How far the shape must go on to all sides to count as a plate.
inline constexpr double kGoesOn = 2.0;

enum class LostShape {
  kPlate,
  kWire,  ///< narrower than four voxels across, and goes on for two voxels at both ends
  kCrumb  ///< ends on all sides, and no place of it is in the grid
};

/// A place where something is lost.
struct LostPlace {
  Vec3 where;        ///< [m]
  double thickness;  ///< [m]
  LostShape shape;
};

/// The places found, and the messages about them.
class LostPlaces {
 public:
  [[nodiscard]] bool empty() const noexcept { return places_.empty(); }
  void add(const LostPlace& place) { places_.push_back(place); }
  void add(const LostPlaces& others);
  /// @throws Error (kInput) if there are plates, with the first of them and a voxel size that holds
  /// all.
  void refusePlates(const BakePlan& plan, const BakeOptions& options) const;
  /// "2 separate parts, the thickest 0.3 mm thin near (...)"; empty if there are none.
  [[nodiscard]] std::string wiresAndCrumbs(const BakePlan& plan) const;

 private:
  std::vector<LostPlace> places_;
};

/// A plate thinner than about a voxel has no voxel inside where it passes between them: it gets
/// holes through which a hand falls. A wire is broken there, and a crumb gone. Looks for such
/// places from every voxel beside the surface. A plate counts if it goes on for two voxels to all
/// sides, so that the last voxel of a sharp edge does not count; a wire, if it goes on at both ends
/// (lost_wires.h). Wires and crumbs alone are not refused: meshes of scans have some.
/// @throws Error (kInput) naming a plate, the thickness there and a voxel size that holds it.
/// @return LostPlaces::wiresAndCrumbs()
[[nodiscard]] std::string refuseLostPlates(const Field& field, const LevelSet& grid,
                                           const BakePlan& plan, const BakeOptions& options);

/// A mesh that became a grid.
struct BakedMesh {
  const Solid& walls;  ///< the walls that distances were measured to
  const TriangleBins& bins;
  const std::vector<std::uint8_t>&
      faces_itself;    ///< for each leaf: its walls include some turned a right angle apart
  const Solid& solid;  ///< the solid that `columns` belong to
  const Columns& columns;
};

/// The same for a mesh. Only leaves with walls that face away from each other are searched; the
/// others hold no plate.
[[nodiscard]] std::string refuseLostPlates(const BakedMesh& mesh, const LevelSet& grid,
                                           const BakePlan& plan, const BakeOptions& options);

}  // namespace palpate::vdb
