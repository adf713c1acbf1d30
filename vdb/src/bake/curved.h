#pragma once
/// Turns facets back into pieces of the smooth surface that they approximate.

#include <cstdint>

#include "bake/solid.h"

namespace palpate::vdb {

/// Replaces each facet by a cubic patch, and cuts the patch into triangles with sides of less than
/// `side` voxels; flat ones stay as they are. Patches go through the vertices with normals weighted
/// as by Max (1999), which are exact on a sphere. Away from creases the patches are those of
/// Vlachos et al. (2001), with sides that match circular arcs up to sixth order. At edges where
/// facets meet at `crease` [rad] or more, the boundary follows the line in which the tangent planes
/// of both sides meet, so that a cylinder's rim is round and a cube stays a cube. Neighbors share
/// all points, so that a closed mesh stays closed. Triangles must be turned alike.
/// @throws Error (kOperation) where that needs more than `max_memory` bytes.
void makeCurved(Solid& solid, double crease, double side, std::uint64_t max_memory);

}  // namespace palpate::vdb
