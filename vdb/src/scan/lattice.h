#pragma once
/// Smooth values on the voxel lattice of a mask, whose zero set is the surface that will be felt.

#include <array>
#include <vector>

#include "scan/band.h"

namespace palpate::vdb {

/// One value for each voxel of a mask, frame included: negative exactly at its inside voxels. The
/// frame mirrors its neighbour, so a shape that is cut by the image's border ends on the outer
/// faces of the border voxels, half a voxel beyond their centres.
struct Lattice {
  std::array<int, 3> first{};  ///< as in Mask
  std::array<int, 3> box{};    ///< as in Mask
  std::vector<float> values;   ///< [-] layout of Mask::inside; finite, never 0
};

/// Wherever `mask` is what the threshold alone would say, the image's own values put the surface
/// between two voxels; where it is not (a piece removed, a cavity filled) their sign is turned.
[[nodiscard]] Lattice latticeOfThreshold(const Image& image, double above, const Mask& mask);

/// The values of a band; further off only the sign counts.
[[nodiscard]] Lattice latticeOf(const Band& band, const Mask& mask);

/// The values of a lattice in the band of its mask, for the spline through them. Infinite ones become as
/// large as the largest that is not.
[[nodiscard]] Band bandOfLattice(const Lattice& lattice, const Mask& mask, const Vec3& spacing);

}  // namespace palpate::vdb
