#pragma once
/// Scans: voxel values with their place in space, and names of labels.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "palpate/core/math.h"

namespace palpate::vdb {

/// A 3-D image. Voxel (i, j, k) is values[i + nx (j + ny k)] and its centre lies at affine applied to
/// (i, j, k): RAS, [m]. Sheared, oblique and left-handed affines are kept as they are.
struct Image {
  std::string source;
  std::array<int, 3> size{};
  std::vector<float> values;   ///< after scl_slope and scl_inter
  Mat3 axes{1.0};              ///< [m per voxel] columns: step along i, j, k
  Vec3 origin{0.0, 0.0, 0.0};  ///< [m] centre of voxel (0, 0, 0)
  std::vector<std::string>
      notes;  ///< what was assumed ("unit code 0 taken as mm"), to be told once

  [[nodiscard]] float at(int i, int j, int k) const noexcept {
    return values[static_cast<std::size_t>(i) +
                  static_cast<std::size_t>(size[0]) *
                      (static_cast<std::size_t>(j) +
                       static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(k))];
  }
  [[nodiscard]] Vec3 toWorld(const Vec3& index) const noexcept { return axes * index + origin; }
  [[nodiscard]] Vec3 toIndex(const Vec3& world) const noexcept {
    return glm::inverse(axes) * (world - origin);
  }
  /// Trilinear between voxel centres (scipy map_coordinates, order 1); outside the centres' box: NaN.
  [[nodiscard]] double interpolate(const Vec3& world) const noexcept;
};

/// NIfTI-1 and -2, .nii and .nii.gz (libnifti). sform if its code > 0, else qform; neither is an error.
/// @throws Error (kInput): missing, not NIfTI, truncated, bad checksum, 4-D, singular affine, ...
[[nodiscard]] Image readNifti(const std::string& path);

/// Header only, for `info`: no voxel is read.
struct ImageInfo {
  std::array<int, 3> size{};
  Mat3 axes{1.0};              ///< [m per voxel]
  Vec3 origin{0.0, 0.0, 0.0};  ///< [m]
  std::string data_type;
  std::string orientation;  ///< axis codes, "RAS"
  std::vector<std::string> notes;
};
[[nodiscard]] ImageInfo readNiftiInfo(const std::string& path);

/// Label value -> name.
using NameTable = std::map<int, std::string>;

/// `index name [code]` separated by blanks, or CSV `value,name` with or without a header line; CRLF too.
/// @throws Error (kInput) naming file and line.
[[nodiscard]] NameTable readNameTable(const std::string& path);

}  // namespace palpate::vdb
