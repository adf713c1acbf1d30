#pragma once
/// Where walls of a solid cross each other, and the pieces that they cut a triangle into.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/solid.h"
#include "palpate/core/progress.h"

namespace palpate::vdb {

/// A stretch [voxels] of a triangle's plane that another triangle passes through, or ends at.
struct WallCut {
  Vec3 from{0.0}, to{0.0};
};

/// The cuts of every triangle. Triangles are paired by a tree of their boxes: near-linear in their
/// number and in the length of the lines that they meet along. The result does not depend on the
/// number of threads.
class WallCuts {
 public:
  /// @throws Error (kCancelled).
  WallCuts(const Solid& solid, const Progress& progress);

  [[nodiscard]] std::span<const WallCut> of(std::uint32_t triangle) const noexcept {
    return std::span(cuts_).subspan(first_[triangle], first_[triangle + 1] - first_[triangle]);
  }
  /// Whether another wall meets it in more than a point; then its neighbors tell nothing of it.
  [[nodiscard]] bool isCut(std::uint32_t triangle) const noexcept {
    return first_[triangle] != first_[triangle + 1];
  }

 private:
  std::vector<WallCut> cuts_;       ///< triangle by triangle
  std::vector<std::size_t> first_;  ///< of each triangle's cuts, and one more
};

/// What a piece of a wall is for.
enum class WallUse : std::uint8_t {
  kIdle,    ///< the solid, or nothing, is on both sides
  kNeeded,  ///< the surface
  kMixed,   ///< partly this, partly that
  kNothing  ///< too thin to be either
};

using Corners3 = std::array<Vec3, 3>;

/// Cuts a triangle along its cuts and asks `use_at(point, normal)`, kIdle or kNeeded, once for each
/// piece. Pieces that are needed are added to `pieces` as triangles, unless all of it is one use.
class WallCutter {
 public:
  using Polygon = std::vector<Vec3>;

  /// Of corners that span an area. `use_at` must outlive the call.
  template <typename UseAt>
  static WallUse cut(const Corners3& t, std::span<const WallCut> cuts, UseAt& use_at,
                     std::vector<Corners3>& pieces) {
    const Vec3 normal = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
    const Polygon whole(t.begin(), t.end());
    return cutPolygon(whole, std::vector<WallCut>(cuts.begin(), cuts.end()), normal, use_at,
                      pieces);
  }

 private:
  /// What is on either side of a line.
  struct Halves {
    Polygon left, right;
    std::vector<WallCut> left_cuts, right_cuts;
  };

  /// By one of the cuts, or, where there are many, by a line through their middle.
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

  /// [voxels] Thinner pieces are left out: what is beside them is as near.
  static constexpr double kThin = 1e-7;
};

}  // namespace palpate::vdb
