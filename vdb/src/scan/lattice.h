#pragma once
/// Smooth values on the voxel lattice of a mask, whose zero set is the surface that will be felt.

#include <array>
#include <vector>

#include "scan/mask.h"

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

/// The mask blurred by 2 G - G G, G a Gaussian of 1.25 voxels, at level 1/2, held to the mask's
/// side at each voxel centre so that nothing thin is lost. G alone shrinks a ball of radius R by
/// sigma^2 / R; the second term takes that back to first order. Needs kLabelMargin voxels around
/// the inside.
[[nodiscard]] Lattice latticeOfLabels(const Mask& mask);

inline constexpr int kLabelMargin = 5;  ///< [voxels] reach of the truncated Gaussian, and one more

}  // namespace palpate::vdb
