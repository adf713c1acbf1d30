#pragma once
/// Groups triangles that lie in one plane.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "palpate/core/math.h"

namespace palpate::vdb {

/// The plane of some triangles; lengths in the caller's unit.
struct FlatFace {
  Vec3 normal{0.0};  ///< pointing out of the solid
  double offset = 0.0;
  std::vector<std::uint32_t> vertices;  ///< each once
};

/// An edge between two faces.
struct FlatEdge {
  std::uint32_t first, second;  ///< numbers of faces
  std::uint32_t from, to;       ///< numbers of vertices
};

struct FlatFaces {
  std::vector<FlatFace> faces;
  std::vector<FlatEdge> edges;
};

/// The flat faces of a closed mesh. Each starts from the largest triangle that is left, and takes
/// the connected triangles within `tolerance` of its plane. Nothing if there are more than `most`
/// faces.
[[nodiscard]] std::optional<FlatFaces> findFlatFaces(
    const std::vector<Vec3>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles,
    double tolerance, std::size_t most);

}  // namespace palpate::vdb
