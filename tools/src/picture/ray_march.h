#pragma once
/// Rays through a scene: what they meet, and what color that gives.

#include <optional>
#include <vector>

#include "palpate/interior/partition.h"
#include "palpate/scene/scene.h"
#include "picture/camera.h"
#include "picture/cut_plane.h"
#include "picture/distance_lines.h"
#include "picture/paint.h"
#include "picture/section.h"

namespace palpate::tools {

/// What of a scene is looked at.
struct SpaceScene {
  const Scene& scene;
  const Paint& paint;
  Box3 box;                            ///< [m] nothing beyond it is seen
  std::optional<CutPlane> plane = {};  ///< what lies on the side of its normal is cut away
  /// 0 to 1, by region: of the walls into it from outer ones, and of those out of it; empty: all 1.
  /// Cut faces are opaque.
  std::vector<double> opacity = {};
  /// Seen from both sides: the regions that they cut, and the scan's gray values around them.
  std::vector<CutPlane> slices = {};
  const DistanceLines* lines = nullptr;  ///< on the cut face and on slices; null: none
};

/// What a ray met first. Neighbors with different `part` are set apart by a dark edge, and so are
/// those of the cut face between which it cuts a sheet.
struct Hit {
  Color color = rgb(0xFFFFFF);  ///< of all that it met, down to what is opaque
  int part = -1;  ///< region and whether it is the cut face; -1: nothing; below: a sheet or a slice
  SheetSides sides = {};  ///< of the cut face
  double opacity = 1.0;   ///< of what it met first
  double through = 1.0;   ///< share of the light behind all of it that is still seen

  [[nodiscard]] bool isApartFrom(const Hit& other) const {
    return part != other.part || sides.crossedTo(other.sides) != 0;
  }
};

/// The share of their color that cut faces and slices keep, whichever way they face.
inline constexpr double kFlatShade = 0.97;

/// The share of its color that a surface keeps under the light of `camera`: soft, from a broad lamp
/// behind the viewer's left shoulder and from the sky.
[[nodiscard]] double shadeOf(const Vec3& normal, const Camera& camera);

/// One ray after the other; owns the scratch.
class RayMarch {
 public:
  RayMarch(const SpaceScene& space, const Camera& camera);
  RayMarch(const RayMarch&) = delete;
  RayMarch& operator=(const RayMarch&) = delete;

  /// [m] from begin() along the rays through all pixels within `radius` pixels of (x, y): up to
  /// there they meet nothing.
  [[nodiscard]] double freeWay(double x, double y, double radius);
  /// `free`: freeWay() of a round spot that holds (x, y), or 0.
  [[nodiscard]] Hit cast(double x, double y, double free = 0.0);
  /// 0 to 1: how much of the light of `p` [m] gets to the viewer; what is within `margin` [m]
  /// before it hides nothing.
  [[nodiscard]] double lightFrom(const Vec3& p, double margin);

 private:
  struct Surface {
    Color color;
    double opacity = 1.0;
    int part = -1;
  };

  /// Where a ray is cut short.
  struct Stretch {
    double begin = 0.0;       ///< [m] along it
    double end = kInfinity;   ///< [m]
    double cut = -kInfinity;  ///< [m] where it comes through the cut
  };
  /// What of the ray is looked at; none if there is nothing.
  [[nodiscard]] std::optional<Stretch> stretchOf(const Vec3& origin) const;
  [[nodiscard]] Hit march(const Vec3& origin, Stretch way, double free);
  /// The distances [m] at which the ray meets slices, with their numbers, into slices_.
  void findSlices(const Vec3& origin, const Stretch& way);
  [[nodiscard]] std::optional<Surface> slice(std::size_t index, RegionId region,
                                             const Vec3& p) const;
  /// `color` with the lines of distance on a plane across `normal`.
  [[nodiscard]] Color lined(const Color& color, const Vec3& p, const Vec3& normal) const;

  /// Signs at `p` and a distance [m] within which no leaf changes its sign.
  double probe(const Vec3& p, Signs& out) const;
  /// Where along the ray each leaf's box lies.
  void findSpans(const Vec3& origin);
  /// probe() at `t` [m] along that ray; the distance holds along it only.
  double probeAlong(const Vec3& origin, double t, Signs& out) const;
  [[nodiscard]] double advance(double safe) const;
  /// Between `before` and `after` on the ray the region changes; moves `after` and the signs onto
  /// the first change.
  Surface surface(const Vec3& origin, double before, double& after);
  /// The first sheet in the list that lies between here_ and there_, both in the same region.
  [[nodiscard]] std::optional<Surface> sheet(const Vec3& origin, double before, double after);
  [[nodiscard]] Vec3 sheetNormal(std::size_t index, const Vec3& p, const Vec3& fallback) const;
  [[nodiscard]] double opacityOf(RegionId region) const;

  const SpaceScene& space_;
  const Camera& camera_;
  Signs signs_[3];
  /// Of the last point, of the next, and between them: pointers, as a scene's signs have kilobytes
  /// to swap.
  Signs *here_ = &signs_[0], *there_ = &signs_[1], *middle_ = &signs_[2];
  Vec3 way_;
  std::vector<Box3> bounds_;
  std::vector<std::pair<double, double>>
      spans_;  ///< [m] by leaf: from where to where the ray is in its box
  std::vector<std::pair<double, std::size_t>>
      slices_;  ///< that the ray has yet to meet, the last one first
  bool has_sheets_;
  double begin_ = 0.0;  ///< [m] along a ray from the camera's plane: all of the box lies behind it
};

}  // namespace palpate::tools
