#pragma once
/// What is wrong with a mesh, in full: for people who have to mend it. bakeMesh() does without.

#include <cstddef>
#include <vector>

#include "palpate/core/progress.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {

/// Edges with one triangle that hang together.
struct MeshHole {
  std::size_t edges = 0;
  double length = 0.0;         ///< [m] of the edges
  Vec3 middle{0.0, 0.0, 0.0};  ///< [m] of the edges
};

/// Counts are of the mesh without doubled triangles.
struct MeshDefects {
  std::size_t doubled_triangles = 0;     ///< with the corners of one before, however turned
  std::size_t degenerate_triangles = 0;  ///< all corners in one line
  std::size_t boundary_edges = 0;        ///< with one triangle
  std::vector<MeshHole> holes;           ///< the longest first
  std::size_t non_manifold_edges = 0;    ///< with three triangles or more
  std::size_t turned_triangles = 0;      ///< against most of the area that hangs together with them
  /// Pairs of triangles that have points in common beyond the corners and the side they share:
  /// exact for the coordinates as they are, so that touching counts. Degenerate triangles are left
  /// out.
  std::size_t crossings = 0;
  Vec3 first_crossing{0.0, 0.0, 0.0};  ///< [m] a place of one of them
  std::size_t parts = 0;               ///< of triangles that hang together by corners
  std::size_t inside_out_parts = 0;    ///< that wind inwards and lie in no other
  std::size_t hollow_parts = 0;        ///< within another and turned against it
  double area = 0.0;                   ///< [m^2]
  /// [m^3] of the parts: those in no other count in full, hollows are taken off, what lies in a
  /// solid adds nothing. Parts that overlap count twice; no meaning if there are boundary edges.
  double volume = 0.0;
  Box3 bounds;  ///< [m] of the triangles
};

/// Every index must be in range and every vertex finite, as readMesh() has it. Needs some 200 bytes
/// for each triangle; in parallel (TBB), with the same result for any number of threads.
/// @throws Error (kCancelled).
[[nodiscard]] MeshDefects findDefects(const Mesh& mesh, const Progress& progress = {});

}  // namespace palpate::vdb
