#pragma once
/// The least distance of each voxel of a leaf to a list of triangles: the inner loop of the mesh
/// bake.

#include <cstdint>
#include <vector>

#include "bake/facet.h"

namespace palpate::vdb {

/// Scratch memory of the search, kept from leaf to leaf. Sized by makeQuery().
struct LeafScratch {
  std::vector<float> distances;       ///< squared distances of eight cubes for each facet
  std::vector<std::uint32_t> nearby;  ///< facets that matter to each cube of 4^3 voxels
  std::vector<std::uint32_t> close;   ///< facets that matter to each cube of 2^3 in one of them
};

/// The same as plain pointers: files compiled for newer processors share no inline code with
/// others.
struct LeafQuery {
  const Facet* facets;  ///< about the leaf's middle
  std::uint32_t count;
  float half_width;  ///< [voxels]
  float* distances;
  std::uint32_t* nearby;
  std::uint32_t* close;
  float* squares;  ///< [voxels^2] out, in OpenVDB's order; kFarSquare where surely not in the band
};

inline constexpr float kFarSquare = 3.0e38F;

/// Cubes of 4^3 and then 2^3 voxels drop the triangles that are nearest to none of their voxels;
/// eight voxels are computed at a time. The error of a square is some 1e-6 voxel times the
/// distance.
void findSquares(const LeafQuery& query) noexcept;

/// The variant for every processor, one of those that findSquares() chooses from.
void findSquaresBase(const LeafQuery& query) noexcept;
#if defined(__x86_64__)
void findSquaresAvx2(const LeafQuery& query) noexcept;
#endif

[[nodiscard]] LeafQuery makeQuery(const std::vector<Facet>& facets, float half_width,
                                  LeafScratch& scratch, float* squares);

}  // namespace palpate::vdb
