#pragma once
// Finds where a proxy comes to rest, starting where it was, from values of fields alone.

#include <optional>
#include <vector>

#include "support/plane_problem.h"
#include "support/region_tree.h"

namespace palpate::testing {

/// How far a point x is from being a local minimum of |x - P|.
struct RestCheck {
  /// [m] Distance from x to the nearest point of the linearized region, in the worst cell that
  /// contains x; walls nearer than 4 RegionTree::onSurface() count as touched.
  double residual = 0.0;
  double doubt = 0.0;  ///< [-] error bound of the normals that decided it
  bool is_judged =
      true;  ///< false: too many walls at once, or a kink that is neither convex nor concave
  int touching = 0;  ///< walls that hold it, in the worst cell
  /// One of them has no normal there: an apex, or a crease of a black-box field
  bool has_kink = false;
};

struct Rest {
  Vec3 point{0.0, 0.0, 0.0};
  bool has_settled = false;  ///< the flow reached a point that passes the check
  std::vector<Vec3> others =
      {};  ///< where the flow ends with steps of a tenth, or in the opposite direction off a saddle
  double blunt = 1.0;  ///< [-] least singular value of the normals that hold it: 1 for one wall,
                       ///< small in wedges
};

class RestOracle {
 public:
  explicit RestOracle(const RegionTree& tree) : tree_(tree) {}

  [[nodiscard]] RestCheck check(const Vec3& x, const Vec3& hip) const;

  /// The limit h -> 0 of x <- nearest allowed point to x + h (P - x) / |P - x|, to a second-order
  /// minimum.
  [[nodiscard]] Rest solve(const Vec3& previous, const Vec3& hip) const;
  /// A single run with the coarser step, which takes a tenth of the time.
  [[nodiscard]] Rest solveOnce(const Vec3& previous, const Vec3& hip) const;

  /// The point to which the flow goes from `x` with steps of 1e-6 of the depth, so that even the
  /// thinnest walls hold it.
  [[nodiscard]] Vec3 stay(const Vec3& x, const Vec3& hip) const;

  /// [-] Largest decrease of |x - P|, as a share of `radius`, towards an allowed point `radius`
  /// away, by the tree's value alone: directions are tried, then refined. 0 if no point is nearer.
  [[nodiscard]] double gainNear(const Vec3& x, const Vec3& hip, double radius) const;

  /// Least curvature of |x - P|^2 / 2 along the walls that hold x, in the worst cell; infinite at a
  /// corner.
  [[nodiscard]] double leastCurvature(const Vec3& x, const Vec3& hip) const;

 private:
  struct Cell {
    std::vector<int> literals;
    std::vector<HalfSpaceBound> planes;
    std::vector<int> owner;  ///< the literal of each plane
    bool holds = true;       ///< the cell contains x
    bool is_judged = true;
    double doubt = 0.0;
  };
  struct Newton {
    Vec3 step{0.0, 0.0, 0.0};
    double residual = 0.0;
    double least = kInfinity;  ///< curvature
    Vec3 least_way{0.0, 0.0, 0.0};
    double blunt = 1.0;
  };
  [[nodiscard]] Cell cellAt(const Vec3& x, const Nearby& nearby, std::uint32_t bits, double radius,
                            double granted, bool asks_creases) const;
  /// For a literal without a normal at `x`: the plane there that continues its surface at `x +
  /// out`.
  [[nodiscard]] std::optional<HalfSpaceBound> planeAtKink(const Literal& literal, const Vec3& x,
                                                          const Vec3& out) const;
  [[nodiscard]] bool addKink(Cell& cell, const Literal& literal, int index, const Vec3& x,
                             double radius) const;
  [[nodiscard]] std::optional<Vec3> project(const Vec3& goal, const Vec3& from, double h) const;
  [[nodiscard]] Newton newton(const Vec3& x, const Vec3& hip, double radius) const;
  [[nodiscard]] std::optional<Vec3> polish(const Vec3& x, const Vec3& hip, double h) const;
  struct Flow {
    Vec3 point;
    bool has_settled = false;
    bool was_kicked = false;
  };
  [[nodiscard]] double stepFor(const Vec3& previous, const Vec3& hip) const;
  void measureBluntness(Rest& rest, const Vec3& hip) const;
  [[nodiscard]] Flow flow(const Vec3& previous, const Vec3& hip, double h, double kick,
                          int steps = 40'000) const;

  const RegionTree& tree_;
  mutable Nearby nearby_;
};

}  // namespace palpate::testing
