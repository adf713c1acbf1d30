#pragma once
/// Scans: voxel values with their place in space, and names of labels.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "palpate/core/math.h"

namespace palpate::vdb {

/// A 3-D image. Voxel (i, j, k) is values[i + nx (j + ny k)] and its centre lies at affine applied
/// to (i, j, k): RAS, [m]. Sheared, oblique and left-handed affines are kept as they are.
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
  /// Trilinear between voxel centres (scipy map_coordinates, order 1); outside the centres' box:
  /// NaN.
  [[nodiscard]] double interpolate(const Vec3& world) const noexcept;
};

/// NIfTI-1 and -2, .nii and .nii.gz, either byte order, every integer and float type of 8 to 64
/// bits, scaled by scl_slope and scl_inter (libnifti reads the header). The place is the sform if
/// its code is above 0, else the qform; if both are set they must agree within 0.1 voxel at the
/// image's corners. Units scale spacing and origin; without a unit (code 0) mm is taken, with a
/// note. NaN voxels stay NaN, with a note; surfaces take them as outside. Dimensions beyond the
/// third must be 1.
/// @throws Error (kInput, codes "nifti.*"): missing, empty, not NIfTI, cut short, wrong gzip
/// checksum, 4-D or 2-D, colour or complex voxels, neither form set or both in conflict, singular
/// affine, a detached .hdr / .img pair, ...
[[nodiscard]] Image readNifti(const std::string& path);

/// The bytes of a NIfTI-1 file: float voxels, the place as sform (code 2, aligned), mm; compressed
/// with gzip if asked. readNifti() gives the same values back, the place to a float's rounding.
/// @throws Error (kInput) for an empty image or one longer than 32767 voxels (the format's limit).
[[nodiscard]] std::string encodeNifti(const Image& image, bool gzip);

/// Header only, for `info`: no voxel is read, so that only what the header and the file's size tell
/// is checked. Throws as readNifti() does.
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

/// `index name [code]` separated by blanks (or tabs, if names hold blanks), or CSV `value,name`
/// with or without a header line. LF or CR LF; a byte order mark, blank lines and lines from # on
/// are skipped; further numeric columns (colours) are ignored.
/// @throws Error (kInput, codes "labels.*") naming file and line: a value that is no integer or has
/// two names, a missing name, a column that does not belong.
[[nodiscard]] NameTable readNameTable(const std::string& path);

}  // namespace palpate::vdb
