#pragma once
/// Everything that is wrong with a mesh, for people who have to mend it. bakeMesh() does not need
/// it.

#include <cstddef>
#include <vector>

#include "palpate/core/progress.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {

/// A hole: connected edges with one triangle each.
struct MeshHole {
  std::size_t edges = 0;
  double length = 0.0;         ///< [m] of the edges
  Vec3 middle{0.0, 0.0, 0.0};  ///< [m] of the edges
};

/// Counts are for the mesh without doubled triangles.
struct MeshDefects {
  std::size_t doubled_triangles = 0;     ///< with the corners of an earlier one, however turned
  std::size_t degenerate_triangles = 0;  ///< all corners in one line
  std::size_t boundary_edges = 0;        ///< with one triangle
  std::vector<MeshHole> holes;           ///< the longest first
  std::size_t non_manifold_edges = 0;    ///< with three triangles or more
  std::size_t turned_triangles = 0;  ///< turned against most of the area that is connected to them
  /// Pairs of triangles that have points in common beyond the corners and sides they share: exact
  /// for the coordinates as they are, so that touching counts. Degenerate triangles are left out.
  std::size_t crossings = 0;
  Vec3 first_crossing{0.0, 0.0, 0.0};  ///< [m] a place of one of them
  std::size_t parts = 0;               ///< connected components of triangles, joined by corners
  std::size_t inside_out_parts = 0;    ///< parts that wind inwards and lie in no other part
  std::size_t hollow_parts = 0;        ///< parts within another and turned against it
  double area = 0.0;                   ///< [m^2]
  /// [m^3] of the parts: those in no other part count in full, hollows are subtracted, parts within
  /// a solid add nothing. Parts that overlap count twice; meaningless if there are boundary edges.
  double volume = 0.0;
  Box3 bounds;  ///< [m] of the triangles
};

/// Every index must be in range and every vertex finite, as readMesh() guarantees. Needs some 200
/// bytes for each triangle; in parallel (TBB), with the same result for any number of threads.
/// @throws Error (kCancelled).
[[nodiscard]] MeshDefects findDefects(const Mesh& mesh, const Progress& progress = {});

}  // namespace palpate::vdb
