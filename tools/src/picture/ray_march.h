#pragma once
/// Casts rays through a scene, and finds the color of each.

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

/// The scene and the parts of it that are drawn.
struct SpaceScene {
  const Scene& scene;
  const Paint& paint;
  Box3 box;                            ///< [m] nothing beyond it is drawn
  std::optional<CutPlane> plane = {};  ///< the side that its normal points to is cut away
  /// 0 to 1, by region: opacity of the walls into it from outer regions, and of the walls out of
  /// it; empty: all 1. Cut faces are opaque.
  std::vector<double> opacity = {};
  /// Planes that are seen from both sides: they show the regions that they cut, and the scan's gray
  /// values around these.
  std::vector<CutPlane> slices = {};
  const DistanceLines* lines = nullptr;  ///< on the cut face and on slices; null: none
};

/// The first thing that a ray met. A dark edge separates neighboring pixels with different `part`,
/// and pixels of the cut face between which a sheet is cut.
struct Hit {
  Color color = rgb(0xFFFFFF);  ///< of everything that it met, up to the first opaque surface
  int part = -1;  ///< number from the region and whether it is the cut face; -1: nothing; below: a
                  ///< sheet or a slice
  SheetSides sides = {};  ///< only for the cut face
  double opacity = 1.0;   ///< of the first surface
  double through = 1.0;   ///< share of the light from behind that is still seen

  [[nodiscard]] bool isApartFrom(const Hit& other) const {
    return part != other.part || sides.crossedTo(other.sides) != 0;
  }
};

/// Brightness of cut faces and slices, whichever way they face.
inline constexpr double kFlatShade = 0.97;

/// Brightness of a surface under the light of `camera`: soft light from a broad lamp behind the
/// viewer's left shoulder, and from the sky.
[[nodiscard]] double shadeOf(const Vec3& normal, const Camera& camera);

/// Casts one ray after another; owns the scratch memory.
class RayMarch {
 public:
  RayMarch(const SpaceScene& space, const Camera& camera);
  RayMarch(const RayMarch&) = delete;
  RayMarch& operator=(const RayMarch&) = delete;

  /// [m] Distance from begin() within which the rays through all pixels within `radius` pixels of
  /// (x, y) meet nothing.
  [[nodiscard]] double freeWay(double x, double y, double radius);
  /// `free`: freeWay() of a round spot that contains (x, y), or 0.
  [[nodiscard]] Hit cast(double x, double y, double free = 0.0);
  /// 0 to 1: how much of the light from `p` [m] reaches the viewer; surfaces within `margin` [m] in
  /// front of it do not hide it.
  [[nodiscard]] double lightFrom(const Vec3& p, double margin);

 private:
  struct Surface {
    Color color;
    double opacity = 1.0;
    int part = -1;
  };

  /// The interval of a ray that is traced.
  struct Stretch {
    double begin = 0.0;       ///< [m] along the ray
    double end = kInfinity;   ///< [m]
    double cut = -kInfinity;  ///< [m] where it passes through the cut
  };
  /// The last look at a leaf along a ray.
  struct Look {
    double at = 0.0;      ///< [m] along the ray
    double safe = 0.0;    ///< [m] so far to both sides the leaf keeps its sign
    double likely = 0.0;  ///< [m] so far ahead the next look is likely to show that it kept it
    bool is_inside = false;
  };
  /// How far a ray can go on from a point, as said of Look.
  struct Reach {
    double safe = kInfinity;    ///< [m]
    double likely = kInfinity;  ///< [m]
    bool is_certain = true;     ///< looks show all signs between the last point and this one
  };
  /// The traced interval of a ray; nothing if the ray misses the scene.
  [[nodiscard]] std::optional<Stretch> stretchOf(const Vec3& origin) const;
  [[nodiscard]] Hit march(const Vec3& origin, Stretch way, double free);
  /// Stores the distances [m] at which the ray meets slices, with the slices' numbers, in slices_.
  void findSlices(const Vec3& origin, const Stretch& way);
  [[nodiscard]] std::optional<Surface> slice(std::size_t index, RegionId region,
                                             const Vec3& p) const;
  /// `color` with the lines of equal distance on a plane with the normal `normal`.
  [[nodiscard]] Color lined(const Color& color, const Vec3& p, const Vec3& normal) const;

  /// Computes the signs at `p`; returns a distance [m] within which no leaf changes its sign.
  double probe(const Vec3& p, Signs& out) const;
  /// Finds the interval of the ray in each leaf's box.
  void findSpans(const Vec3& origin);
  /// probe() at `t` [m] along that ray. Evaluates only the leaves whose signs the ray's earlier
  /// points leave open.
  Reach probeAlong(const Vec3& origin, double t, Signs& out);
  [[nodiscard]] double advance(double safe) const;
  /// The region changes between `before` and `after` on the ray; moves `after`, and the signs, to
  /// the first change.
  Surface surface(const Vec3& origin, double before, double& after);
  /// The first sheet in the list that lies between here_ and there_, which are in the same region.
  [[nodiscard]] std::optional<Surface> sheet(const Vec3& origin, double before, double after);
  [[nodiscard]] Vec3 sheetNormal(std::size_t index, const Vec3& p, const Vec3& fallback) const;
  [[nodiscard]] double opacityOf(RegionId region) const;

  const SpaceScene& space_;
  const Camera& camera_;
  Signs signs_[3];
  /// Signs at the last point, at the next, and between them. Pointers, because a scene's signs can
  /// take kilobytes to swap.
  Signs *here_ = &signs_[0], *there_ = &signs_[1], *middle_ = &signs_[2];
  Vec3 way_;
  std::vector<Box3> bounds_;
  std::vector<std::pair<double, double>>
      spans_;                ///< [m] for each leaf: interval of the ray in its box
  std::vector<Look> looks_;  ///< for each leaf, along the present ray
  std::vector<std::pair<double, std::size_t>>
      slices_;  ///< slices that the ray still has to meet, the last one first
  bool has_sheets_;
  /// [m] Along a ray from the camera's plane; the whole box is behind this distance
  double begin_ = 0.0;
};

}  // namespace palpate::tools
