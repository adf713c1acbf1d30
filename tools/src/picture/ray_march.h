#pragma once
/// Rays through a scene: what they meet, and what color that gives.

#include <optional>
#include <vector>

#include "palpate/interior/partition.h"
#include "palpate/scene/scene.h"
#include "picture/camera.h"
#include "picture/cut_plane.h"
#include "picture/paint.h"
#include "picture/section.h"

namespace palpate::tools {

/// What of a scene is looked at.
struct SpaceScene {
  const Scene& scene;
  const Paint& paint;
  Box3 box;                            ///< [m] nothing beyond it is seen
  std::optional<CutPlane> plane = {};  ///< what lies on the side of its normal is cut away
  /// 0 to 1, by region: of the walls into it from outer ones, and of those out of it; empty: all 1. Cut faces are opaque.
  std::vector<double> opacity = {};
};

/// What a ray met first. Neighbors with different `part` are set apart by a dark edge, and so are those of the cut face
/// between which it cuts a sheet.
struct Hit {
  Color color = rgb(0xFFFFFF);  ///< of all that it met, down to what is opaque
  int part = -1;          ///< region and whether it is the cut face; -1: nothing; below: a sheet
  SheetSides sides = {};  ///< of the cut face
  double opacity = 1.0;   ///< of what it met first

  [[nodiscard]] bool isApartFrom(const Hit& other) const {
    return part != other.part || sides.crossedTo(other.sides) != 0;
  }
};

/// The share of its color that a surface keeps under the light of `camera`: 1 where it faces the light.
[[nodiscard]] double shadeOf(const Vec3& normal, const Camera& camera);

/// One ray after the other; owns the scratch.
class RayMarch {
 public:
  RayMarch(const SpaceScene& space, const Camera& camera);

  /// [m] from begin() along the rays through all pixels within `radius` pixels of (x, y): up to there they meet nothing.
  [[nodiscard]] double freeWay(double x, double y, double radius);
  /// `free`: freeWay() of a round spot that holds (x, y), or 0.
  [[nodiscard]] Hit cast(double x, double y, double free = 0.0);

 private:
  struct Surface {
    Color color;
    double opacity = 1.0;
    int part = -1;
  };

  /// Signs at `p` and a distance [m] within which no leaf changes its sign.
  double probe(const Vec3& p, Signs& out) const;
  [[nodiscard]] double advance(double safe) const;
  /// Between `before` and `after` on the ray the region changes; moves `after` and the signs onto the first change.
  Surface surface(const Vec3& origin, double before, double& after);
  /// The first sheet in the list that lies between here_ and there_, both in the same region.
  [[nodiscard]] std::optional<Surface> sheet(const Vec3& origin, double before, double after);
  [[nodiscard]] Vec3 sheetNormal(std::size_t index, const Vec3& p, const Vec3& fallback) const;
  [[nodiscard]] double opacityOf(RegionId region) const;

  const SpaceScene& space_;
  const Camera& camera_;
  Signs here_, there_, middle_;
  Vec3 way_;
  std::vector<Box3> bounds_;
  bool has_sheets_;
  double begin_ = 0.0;  ///< [m] along a ray from the camera's plane: all of the box lies behind it
};

}  // namespace palpate::tools
