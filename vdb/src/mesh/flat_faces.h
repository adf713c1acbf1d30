#pragma once
/// Triangles that lie in one plane.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "palpate/core/math.h"

namespace palpate::vdb {

/// A plane of some triangles; lengths in units of the caller's.
struct FlatFace {
  Vec3 normal{0.0};  ///< out of the solid
  double offset = 0.0;
  std::vector<std::uint32_t> vertices;  ///< each once
};

/// An edge between two faces.
struct FlatEdge {
  std::uint32_t first, second;  ///< faces
  std::uint32_t from, to;       ///< vertices
};

struct FlatFaces {
  std::vector<FlatFace> faces;
  std::vector<FlatEdge> edges;
};

/// The faces of a closed mesh: the largest triangle first, and what hangs together with it within
/// `tolerance` of its plane; then the next. Nothing if there are more than `most`.
[[nodiscard]] std::optional<FlatFaces> findFlatFaces(
    const std::vector<Vec3>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles,
    double tolerance, std::size_t most);

}  // namespace palpate::vdb
