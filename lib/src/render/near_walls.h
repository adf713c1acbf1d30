#pragma once
/// NearWalls: the leaves near the proxy, their shape there, and the cells that make up the proxy's
/// region around it. Scratch: computed anew for each place.

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "cell_walker.h"
#include "palpate/interior/near_cells.h"
#include "palpate/interior/port_machine.h"
#include "solver_limits.h"

namespace palpate {

/// A leaf at one place, as a distance: S over the length of its gradient.
struct WallThere {
  LeafId leaf = 0;
  double distance = 0.0;       ///< [m] S / |grad S|, negative inside
  double tolerance = 0.0;      ///< [m] within this distance the point is on the surface
  double slope = 0.0;          ///< [-] |grad S|; 0: the leaf has no normal here
  Vec3 normal{0.0, 0.0, 0.0};  ///< [-] outward

  /// [m] distance to the surface on the side that is asked for; negative beyond it
  [[nodiscard]] double gap(bool inside) const noexcept { return inside ? -distance : distance; }
};

/// The same, with the curvature of the leaf there.
struct NearWall : WallThere {
  Mat3 bend{0.0};          ///< [1/m] Hessian of S over the slope
  double bend_size = 0.0;  ///< [1/m] its norm
};

class NearWalls {
 public:
  static constexpr std::size_t kMax = NearCells::kMaxNear;

  NearWalls(const Scene& scene, CellWalker& walker)
      : walker_(walker), cells_(scene.partition(), scene.passages()) {}

  /// Looks for leaves whose surface may come within `radius` [m] of the walker's point; false if
  /// there are more than kMax (then nothing is known). With `trust_sides`, the walker's side counts
  /// even for a leaf that the point is slightly beyond, so that the point finds its way back.
  [[nodiscard]] bool look(double radius, bool trust_sides) noexcept;

  [[nodiscard]] std::span<const NearWall> walls() const noexcept { return {wall_.data(), count_}; }
  [[nodiscard]] std::span<const NearCell> cells() const noexcept {
    return {cell_.data(), cell_count_};
  }

 private:
  /// True if the cell's walls at the point leave no room between them: faces of neighbors that
  /// touch, or the line where the walls between three labels meet.
  [[nodiscard]] bool isSliver(const NearCell& cell) const noexcept;

  CellWalker& walker_;
  NearCells cells_;
  std::array<NearWall, kMax> wall_{};
  std::size_t count_ = 0;
  std::array<NearCell, NearCells::kMaxCells> cell_{};
  std::size_t cell_count_ = 0;
};

/// Where `leaf`'s curvature is larger than its feature size permits, its finite differences
/// straddle a fold. Then `bend` is taken a little further beyond the surface, seen from `side`,
/// where only the wall with `normal` (outward) contributes; a cone near its tip, which really is
/// curved like that, keeps `bend`.
void unfoldBend(const Leaf& leaf, double side, const Vec3& p, const Vec3& normal,
                Mat3& bend) noexcept;

/// [1/m^2] The square of the norm of a bend.
[[nodiscard]] inline double squareOf(const Mat3& m) noexcept {
  return glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]);
}

/// [1/m] The norm of a bend.
[[nodiscard]] inline double sizeOf(const Mat3& m) noexcept { return std::sqrt(squareOf(m)); }

/// The leaf `id` at a place where its field's sample is `s`.
[[nodiscard]] inline WallThere wallOf(LeafId id, const Leaf& leaf, const FieldSample& s) noexcept {
  WallThere out;
  out.leaf = id;
  out.slope = s.in_band ? glm::length(s.gradient) : 0.0;
  // A slope beyond the Lipschitz bound, which then is false, would make the tolerance longer than
  // intended.
  const double least = limits::kFlattest * leaf.lipschitz;
  const double length = 1.0 / std::max(out.slope, least);
  out.tolerance = limits::kOnSurface * leaf.feature;
  if (out.slope > leaf.lipschitz) out.tolerance *= leaf.lipschitz * length;
  out.distance = s.value * length;
  if (out.slope > 0.0) out.normal = s.gradient * (out.slope > least ? length : 1.0 / out.slope);
  return out;
}

}  // namespace palpate
