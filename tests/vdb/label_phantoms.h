#pragma once
/// Label images of shapes whose surfaces are known, and of what is thin, folded or random; and how
/// far surfaces made of them are off.

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "palpate/scene/scene.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/label_centers.h"

namespace palpate::vdb::test {

/// Voxels of `spacing` [mm] over a box around the origin that reaches `half` [mm] to all sides;
/// each has the label of its center [mm]. Voxel centers lie at `shift` voxels from the origin's.
[[nodiscard]] Image labelImage(const Vec3& spacing, const Vec3& half,
                               const std::function<int(const Vec3&)>& label_at,
                               const Vec3& shift = Vec3(0.0));

/// Every label of an image but 0 as a layer of a scene, as scene files have them.
class LabelScene {
 public:
  explicit LabelScene(const Image& image);

  /// The label at a point [mm]; 0: none.
  [[nodiscard]] int labelAt(const Vec3& mm) const;
  [[nodiscard]] LabelCenters centers() const;
  [[nodiscard]] const FieldPtr& field(int label) const { return fields_.at(label); }
  /// [s] of the processor that the grids took.
  [[nodiscard]] double seconds() const noexcept { return seconds_; }

 private:
  const Image& image_;
  std::vector<int> labels_;  ///< by layer
  std::map<int, FieldPtr> fields_;
  ScenePtr scene_;
  double seconds_ = 0.0;
};

/// How far a surface is off at points of the true one.
struct SurfaceError {
  double bias = 0.0;    ///< [mm] mean value there; positive: ours is inside
  double most = 0.0;    ///< [mm] largest distance
  double normal = 0.0;  ///< [degree] RMS
  double worst = 0.0;   ///< [degree]
};

struct SurfacePoint {
  Vec3 at;      ///< [mm]
  Vec3 normal;  ///< outward
};
/// Of the wall to `other`, if there is one: where both fields are equal.
[[nodiscard]] SurfaceError surfaceError(const Field& field, const std::vector<SurfacePoint>& points,
                                        const Field* other = nullptr);

/// A ball of label 1.
struct BallPhantom {
  Vec3 center;    ///< [mm]
  double radius;  ///< [mm]
  [[nodiscard]] Image image(const Vec3& spacing) const;
  [[nodiscard]] std::vector<SurfacePoint> points() const;
};

/// Label 1 below a tilted plane through `center`, label 2 above; both end with the image.
struct PlanePhantom {
  Vec3 center;
  Vec3 normal;
  /// [mm] How far the image reaches to all sides.
  [[nodiscard]] static Vec3 half(const Vec3& spacing);
  [[nodiscard]] Image image(const Vec3& spacing) const;
  /// Three voxels and more from the image's border.
  [[nodiscard]] std::vector<SurfacePoint> points(const Vec3& spacing) const;
};

/// A box of label 1, whose faces lie half-way between voxel centers.
struct SlabPhantom {
  std::array<int, 3> voxels{};  ///< along each axis
  [[nodiscard]] Image image(const Vec3& spacing) const;
  /// Points of its faces from `nearest` to `farthest` voxels from all edges: [voxels along the
  /// face's normal] the largest distance of the surface from them.
  [[nodiscard]] double error(const Field& field, const Vec3& spacing, double nearest,
                             double farthest) const;
  /// [voxels] The largest part of an edge's line that is cut off, measured along the bisector of
  /// its faces; away from corners.
  [[nodiscard]] double cutOff(const Field& field, const Vec3& spacing) const;
};

/// A head of folded layers [mm]: white matter 1 within a gray ribbon 2, whose folds touch or leave
/// fluid 3 between them; around it a shell of bone 5 with dura 4, a voxel thin, on its inside and
/// skin 6, a voxel thin, outside.
struct FoldedHead {
  double radius = 20.0;  ///< of the fluid's outside
  double ribbon = 1.2;   ///< [mm] thickness of the gray matter
  double period = 9.0;   ///< [mm] of the folds
  std::uint32_t seed = 1;
  [[nodiscard]] Image image(const Vec3& spacing) const;
};

/// How many of `rays` from the origin out meet no point of a label, in steps of a twentieth of the
/// smallest spacing.
[[nodiscard]] int openRays(const LabelScene& scene, int label, double radius, double step,
                           int rays);

/// Labels 0 to `labels` - 1 at random: blobs of some `size` voxels, thin sheets between some of
/// them, and specks.
[[nodiscard]] Image randomLabels(std::uint32_t seed, const std::array<int, 3>& size,
                                 const Vec3& spacing, int labels, double blob);

}  // namespace palpate::vdb::test
