#pragma once
/// Where walls of a solid cross each other, and the pieces that the cuts leave of a triangle.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/solid.h"
#include "palpate/core/progress.h"

namespace palpate::vdb {

/// A line segment [voxels] in a triangle's plane where another triangle passes through it, or ends
/// at it.
struct WallCut {
  Vec3 from{0.0}, to{0.0};
};

/// The cuts of every triangle. Triangles are paired by a tree of their boxes, in time nearly linear
/// in their number and in the length of the lines along which they meet. The result does not depend
/// on the number of threads.
class WallCuts {
 public:
  /// @throws Error (kCancelled).
  WallCuts(const Solid& solid, const Progress& progress);

  [[nodiscard]] std::span<const WallCut> of(std::uint32_t triangle) const noexcept {
    return std::span(cuts_).subspan(first_[triangle], first_[triangle + 1] - first_[triangle]);
  }
  /// Whether another wall meets the triangle in more than a point; then its use cannot be taken
  /// from its neighbors.
  [[nodiscard]] bool isCut(std::uint32_t triangle) const noexcept {
    return first_[triangle] != first_[triangle + 1];
  }

 private:
  std::vector<WallCut> cuts_;       ///< triangle by triangle
  std::vector<std::size_t> first_;  ///< index of each triangle's first cut, and an end
};

/// The use of a piece of a wall.
enum class WallUse : std::uint8_t {
  kIdle,    ///< the solid is on both sides, or on neither
  kNeeded,  ///< part of the surface
  kMixed,   ///< partly kIdle, partly kNeeded
  kNothing  ///< too thin to be either
};

using Corners3 = std::array<Vec3, 3>;

/// Divides a triangle along its cuts and calls `use_at(point, normal)`, which returns kIdle or
/// kNeeded, once for each piece. Needed pieces are added to `pieces` as triangles, unless the whole
/// triangle has one use.
class WallCutter {
 public:
  using Polygon = std::vector<Vec3>;

  /// The corners must span an area. `use_at` must outlive the call.
  template <typename UseAt>
  static WallUse cut(const Corners3& t, std::span<const WallCut> cuts, UseAt& use_at,
                     std::vector<Corners3>& pieces) {
    const Vec3 normal = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
    const Polygon whole(t.begin(), t.end());
    return cutPolygon(whole, std::vector<WallCut>(cuts.begin(), cuts.end()), normal, use_at,
                      pieces);
  }

 private:
  /// The two parts on either side of a line.
  struct Halves {
    Polygon left, right;
    std::vector<WallCut> left_cuts, right_cuts;
  };

  /// Divides by one of the cuts, or, if there are many, by a line through their middle.
  static Halves halve(const Polygon& polygon, const std::vector<WallCut>& cuts, const Vec3& normal);
  static void add(const Polygon& polygon, std::vector<Corners3>& pieces);
  /// [voxels] Its least width, to a factor of two.
  static double widthOf(const Polygon& polygon);
  static Vec3 middleOf(const Polygon& polygon);

  template <typename UseAt>
  static WallUse cutPolygon(const Polygon& polygon, const std::vector<WallCut>& cuts,
                            const Vec3& normal, UseAt& use_at, std::vector<Corners3>& pieces) {
    if (polygon.size() < 3 || widthOf(polygon) < kThin) return WallUse::kNothing;
    const auto keep = [&](WallUse use) {
      if (use == WallUse::kNeeded) add(polygon, pieces);
      return use;
    };
    if (cuts.empty()) return keep(use_at(middleOf(polygon), normal));
    const std::size_t before = pieces.size();
    const Halves halves = halve(polygon, cuts, normal);
    const WallUse left = cutPolygon(halves.left, halves.left_cuts, normal, use_at, pieces);
    const WallUse right = cutPolygon(halves.right, halves.right_cuts, normal, use_at, pieces);
    if (left != right && left != WallUse::kNothing && right != WallUse::kNothing) {
      return WallUse::kMixed;
    }
    const WallUse use = left == WallUse::kNothing ? right : left;
    if (use == WallUse::kMixed || use == WallUse::kNothing) return use;
    pieces.resize(before);
    return keep(use);
  }

  /// [voxels] Thinner pieces are left out: a neighboring piece is as near.
  static constexpr double kThin = 1e-7;
};

}  // namespace palpate::vdb
