#pragma once
/// Finds the blocks of 8^3 voxels that a band around a field's surface can touch.

#include <openvdb/openvdb.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "bake/bake_plan.h"
#include "bake/band_source.h"
#include "bake/band_tree.h"

namespace palpate::vdb {

/// Halves cubes of voxels, from the whole range down to 8^3, and drops those that the band does not
/// reach.
class CubeSearch {
 public:
  /// A cube that the band can touch, and the operands of the field that matter there.
  struct Cube {
    openvdb::Coord origin;
    std::uint32_t part = 0;
  };

  /// `width` [voxels] is that of the whole band, both sides together, by which `source` judges. It
  /// serves the estimate of memory, which may be off by `margin`.
  CubeSearch(const BandSource& source, const BakePlan& plan, double width, double margin = 1.0);

  /// Searches the voxels of `range`. @throws Error (kOperation) if the grid would be too large,
  /// kCancelled.
  void run(const openvdb::CoordBBox& range, const Progress& progress);

  [[nodiscard]] const std::vector<Cube>& cubes() const noexcept { return cubes_; }
  [[nodiscard]] const FieldPart& partOf(const Cube& cube) const noexcept {
    return parts_[cube.part];
  }
  /// Blocks that lie inside the surface and outside the band.
  [[nodiscard]] std::vector<BandBlock>& inside() noexcept { return inside_; }

  /// [m] center of the cube of `size`^3 voxels that begins at `origin`.
  [[nodiscard]] Vec3 centerOf(const openvdb::Coord& origin, int size) const noexcept;
  /// [m] from a cube's center to the voxels at its corners.
  [[nodiscard]] double radiusOf(int size) const noexcept;

 private:
  [[nodiscard]] Verdict judge(const Cube& cube, int size, FieldPart* left) const;
  void refuseIfTooLarge(std::size_t blocks, int size) const;

  const BandSource& source_;
  const BakePlan& plan_;
  double width_;
  double margin_;
  std::vector<FieldPart> parts_;  ///< operands that matter in the cubes, of all levels
  std::vector<Cube> cubes_;       ///< of 8^3 voxels
  std::vector<BandBlock> inside_;
};

}  // namespace palpate::vdb
