#pragma once
/// Facets as pieces of the smooth surface that they were taken from.

#include <cstdint>

#include "bake/solid.h"

namespace palpate::vdb {

/// Puts a cubic patch in the place of each facet, and cuts it into triangles with sides of less
/// than `side` voxels; flat ones stay as they are. Patches go through the vertices with normals
/// weighted as Max (1999) does, which makes them exact on a sphere; they are those of Vlachos et
/// al. (2001), with sides that are arcs to the sixth order, but for creases: at edges where facets
/// meet at `crease` [rad] or more, the boundary follows the line in which the tangent planes of
/// both sides meet, so that a cylinder's rim is round and a cube stays a cube. Neighbors share all
/// points, so that what was closed is. Triangles must be turned alike.
/// @throws Error (kOperation) where that needs more than `max_memory` bytes.
void makeCurved(Solid& solid, double crease, double side, std::uint64_t max_memory);

}  // namespace palpate::vdb
