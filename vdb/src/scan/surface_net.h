#pragma once
/// Closed triangle surface of a lattice's zero set (dual marching cubes).
///
/// One vertex for each sheet of the surface in a cell of eight lattice points, in the middle of
/// where the sheet crosses the cell's edges (linear interpolation); one quadrilateral for each
/// crossed lattice edge. Where a face of a cell is ambiguous, inside points are kept apart and
/// outside points joined. The surface is always closed and without degenerate triangles; only where
/// two sheets share a face of two cells has an edge four triangles instead of two. After P.
/// Gibson's surface nets (1998), with the several vertices a cell of G. M. Nielson's dual marching
/// cubes (2004).

#include "palpate/vdb/mesh.h"
#include "scan/lattice.h"

namespace palpate::vdb {

/// Vertices in [m]: `image`'s affine applied to the lattice's indices, whatever its shear or
/// handedness; triangles wind outwards.
[[nodiscard]] Mesh surfaceNet(const Lattice& lattice, const Image& image);

}  // namespace palpate::vdb
