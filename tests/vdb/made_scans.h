#pragma once
/// Synthetic scans of shapes with known dimensions, made voxel by voxel; and files of them by the
/// tests' own writers, so that readers are not tested with the library that they belong to.

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "palpate/vdb/image.h"
#include "support/temp_file.h"

namespace palpate::vdb::test {

/// A random direction, all equally likely.
[[nodiscard]] Vec3 direction(std::mt19937& random);

/// Voxels of `axes` [mm] around `center` [mm], as many as are needed for a cube of `side` [mm] in
/// any orientation; each has the value at its own center [mm].
[[nodiscard]] Image imageAround(const Vec3& center, const Mat3& axes, double side,
                                const std::function<double(const Vec3&)>& value);

/// Cubic, anisotropic or mirrored voxels [mm], rotated about an axis that is not an axis of the
/// image.
[[nodiscard]] Mat3 obliqueAxes(const Vec3& spacing, double angle = 0.6);

/// Three cylinders with flat ends: bone within muscle within fat. Their common axis is oblique to
/// every image. [mm]
struct Limb {
  static constexpr double kBone = 8.0;
  static constexpr double kMuscle = 16.0;
  static constexpr double kBody = 22.0;
  static constexpr double kHalf = 19.0;  ///< half of the length
  static constexpr double kBoneHu = 1000.0;
  static constexpr double kMuscleHu = 50.0;
  static constexpr double kFatHu = -100.0;
  static constexpr double kAirHu = -1000.0;

  Vec3 center{12.0, -7.0, 30.0};
  Vec3 axis = glm::normalize(Vec3(0.3, -0.4, 0.9));
  Vec3 across = glm::normalize(glm::cross(axis, Vec3(1, 0, 0)));

  /// A direction away from the axis, perpendicular to it.
  [[nodiscard]] Vec3 outwards(double angle) const;
  [[nodiscard]] double radius(const Vec3& mm) const;
  /// 1 bone, 2 muscle, 3 fat, 0 what is around.
  [[nodiscard]] double label(const Vec3& mm) const;
  /// Hounsfield units: at a wall half-way between the two materials, and the pure value from 1.5 mm
  /// on.
  [[nodiscard]] double ct(const Vec3& mm) const;

  [[nodiscard]] Image labels(const Mat3& axes) const;
  [[nodiscard]] Image scan(const Mat3& axes) const;
};

/// Writes labels or integers as NIfTI (sform, bytes or shorts); returns the path.
std::string writeNifti(const Image& image, const palpate::testing::TempFolder& folder,
                       const std::string& name);
/// The same as NRRD, LPS.
std::string writeNrrd(const Image& image, const palpate::testing::TempFolder& folder,
                      const std::string& name);
/// The same as a DICOM series of as many slices; returns the folder.
std::string writeDicom(const Image& image, const palpate::testing::TempFolder& folder,
                       const std::string& name);

/// A segment for a .seg.nrrd: all voxels whose value is not 0.
struct Segment {
  std::string name;
  Image voxels;
};
/// Writes segments that may overlap: each has its own layer, with the value 1.
std::string writeSegments(const std::vector<Segment>& segments,
                          const palpate::testing::TempFolder& folder, const std::string& name);

}  // namespace palpate::vdb::test
