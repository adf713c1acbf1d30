#pragma once
/// Scans: voxel values with their place in space, and names of labels.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/export.h"

namespace palpate::vdb {

/// Directions of a file's axes. The library itself uses RAS: to the right, the front, up.
enum class Space {
  kStated,  ///< as the file says; if it says nothing, its format's convention
  kRas,
  kLps,  ///< to the left, the back, up: x and y negated
};

/// Label value -> name.
using NameTable = std::map<int, std::string>;

/// Red, green, blue, each from 0 to 1.
using LabelColor = std::array<float, 3>;

/// Names and colors of label values; not every value with a name needs a color.
struct LabelTable {
  NameTable names;                   ///< by label value
  std::map<int, LabelColor> colors;  ///< by label value
};

/// A 3-D image. Voxel (i, j, k) is values[i + nx (j + ny k)] and its center lies at affine applied
/// to (i, j, k): RAS, [m]. Sheared, oblique and left-handed affines are kept as they are.
struct PALPATE_EXPORT Image {
  std::string source;          ///< name of the file or folder, for messages
  std::array<int, 3> size{};   ///< voxels along i, j, k
  std::vector<float> values;   ///< after the file's own slope and intercept
  Mat3 axes{1.0};              ///< [m per voxel] columns: step along i, j, k
  Vec3 origin{0.0, 0.0, 0.0};  ///< [m] center of voxel (0, 0, 0)
  std::vector<std::string>
      notes;               ///< what was assumed ("unit code 0 taken as mm"), to be reported once
  LabelTable labels = {};  ///< read from the file itself

  /// The value of voxel (i, j, k). The indices are not checked.
  [[nodiscard]] float at(int i, int j, int k) const noexcept {
    return values[static_cast<std::size_t>(i) +
                  static_cast<std::size_t>(size[0]) *
                      (static_cast<std::size_t>(j) +
                       static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(k))];
  }
  /// [m, RAS] The place of an index, which may lie between voxels or outside of the image.
  [[nodiscard]] Vec3 toWorld(const Vec3& index) const noexcept { return axes * index + origin; }
  /// The inverse of toWorld(); needs axes that are not singular.
  [[nodiscard]] Vec3 toIndex(const Vec3& world) const noexcept {
    return glm::inverse(axes) * (world - origin);
  }
  /// Trilinear between voxel centers (scipy map_coordinates, order 1); outside the centers' box:
  /// NaN.
  [[nodiscard]] double interpolate(const Vec3& world) const noexcept;
};

/// Which of a file's statements about its place in space counts.
enum class AffineChoice {
  kAuto,     ///< NIfTI: sform, else qform, and both must agree; other formats: what the file says
  kSform,    ///< NIfTI
  kQform,    ///< NIfTI
  kSpacing,  ///< NIfTI, NRRD: spacings only; axes along R, A, S, the first voxel's center at the
             ///< origin
};

/// A caller's choices where files leave something open.
struct ImageOptions {
  AffineChoice affine = AffineChoice::kAuto;  ///< which of the file's transforms places the voxels
  Space space = Space::kStated;  ///< of an NRRD file whose space is not an anatomical one
  std::optional<int> frame;      ///< of a 4-D file, from 0; not given: 4-D is refused
  std::string series;            ///< DICOM: UID of the series, if a folder holds several
  /// DICOM series: slices that are unevenly spaced, off one line or sheared become voxels with
  /// right angles; values between slices are linear. Without it the first two are refused.
  bool resample = false;
  /// Further files: the first file and these are masks, one structure each.
  std::vector<std::string> with = {};
  /// Names of structures that were segmented one by one. Where some of them overlap, the one listed
  /// first gets the voxel; where none is listed, the one with fewer voxels.
  std::vector<std::string> priority = {};
};

/// Everything about an image except its voxels.
struct ImageInfo {
  std::array<int, 3> size{};   ///< voxels along i, j, k
  Mat3 axes{1.0};              ///< [m per voxel]
  Vec3 origin{0.0, 0.0, 0.0};  ///< [m]
  std::string data_type;       ///< of the values in the file: "bit", "contours", a type of numbers
  std::string orientation;     ///< axis codes, "RAS"
  std::vector<std::string> notes;  ///< as Image::notes
  std::string format = {};         ///< "NIfTI-1", "NRRD", "MetaImage", "DICOM series"
  std::string length_unit = {};    ///< of the file: "mm"
  LabelTable labels = {};          ///< read from the file itself
  bool is_labels = false;          ///< the file says so, or has a table of names
};

/// Reads NIfTI (.nii, .nii.gz), NRRD (.nrrd, .nhdr, .seg.nrrd), MetaImage (.mha, .mhd), DICOM
/// series (a folder, or any file of it), DICOM segmentations and structure sets, and masks that
/// together are a label image (a folder of the first three). Where a file leaves something open, an
/// error names the option that decides it, or `notes` tells what was assumed; a file that
/// contradicts itself, is cut short or is damaged is refused. Each format's rules are in
/// vdb/README.md.
/// @throws Error (kInput, codes "nifti.*", "nrrd.*", "metaimage.*", "dicom.*", "masks.*",
/// "image.*").
[[nodiscard]] PALPATE_EXPORT Image readImage(const std::string& path,
                                             const ImageOptions& options = {});

/// Header only: reads no voxel, so that it checks only what the header and the file's size show.
/// Throws as readImage() does.
[[nodiscard]] PALPATE_EXPORT ImageInfo readImageInfo(const std::string& path,
                                                     const ImageOptions& options = {});

/// True if readImage() takes `path` for an image: by its extension, in upper or lower case; a
/// folder or a file without extension if it holds DICOM.
[[nodiscard]] PALPATE_EXPORT bool isImageFile(const std::string& path);

/// NIfTI-1 and -2, .nii and .nii.gz, either byte order, every integer and float type of 8 to 64
/// bits, scaled by scl_slope and scl_inter (libnifti reads the header). The place is the sform if
/// its code is above 0, else the qform; if both are set they must agree within 0.1 voxel at the
/// image's corners, unless `affine` chooses. Units scale spacing and origin; without a unit (code
/// 0) mm is taken, with a note. NaN voxels stay NaN, with a note; surfaces take them as outside.
/// Names come from an extension with a LabelTable (Caret, TotalSegmentator).
/// @throws Error (kInput, codes "nifti.*"): missing, empty, not NIfTI, cut short, wrong gzip
/// checksum, 4-D or 2-D, color or complex voxels, neither form set or both in conflict, singular
/// affine, a detached .hdr / .img pair, ...
[[nodiscard]] PALPATE_EXPORT Image readNifti(const std::string& path,
                                             const ImageOptions& options = {});
/// Reads the header alone. @throws Error (kInput) as readNifti(), for all that the header shows.
[[nodiscard]] PALPATE_EXPORT ImageInfo readNiftiInfo(const std::string& path,
                                                     const ImageOptions& options = {});

/// The bytes of a NIfTI-1 file: float voxels, the place as sform (code 2, aligned), mm; compressed
/// with gzip if asked. readNifti() gives the same values back, the place to a float's rounding.
/// @throws Error (kInput) for an empty image or one longer than 32767 voxels (the format's limit).
[[nodiscard]] PALPATE_EXPORT std::string encodeNifti(const Image& image, bool gzip);

/// The same for labels: voxels of 8 bits without sign, or of 16 where labels go beyond 255.
/// @throws Error (kInput, "nifti.label") for a value that is not a whole number from 0 to 65535.
[[nodiscard]] PALPATE_EXPORT std::string encodeLabels(const Image& image, bool gzip);

/// A table of label names, and colors if it has some:
/// - `index name [code]`, `index name R G B [A]` (Slicer .ctbl and .txt, FreeSurfer LUT; 0 to 255),
///   separated by blanks, or by tabs if names hold blanks
/// - `index R G B A visible mesh "name"` (ITK-SNAP)
/// - CSV `value,name` with or without a header line, with Color_R, Color_G, Color_B (Slicer .csv)
/// - an image with a table of its own (.seg.nrrd, .nii.gz)
///
/// LF or CR LF; a byte order mark, blank lines and lines from # on are skipped. Lines that are not
/// UTF-8 are taken for Latin-1.
/// @throws Error (kInput, codes "labels.*") naming file and line: a value that is not an integer or
/// has two names, a missing name, a column that does not belong, a color out of range.
[[nodiscard]] PALPATE_EXPORT LabelTable readLabelTable(const std::string& path);

/// Assimp (glTF, GLB and the other formats it reads) and GDCM's unpackers (compressed DICOM pixels)
/// trust statements in a file that cannot all be checked beforehand, and answer some damage with a
/// crash or an endless loop. In a child process only the child ends: readMesh() and readImage()
/// then throw Error (kInput, mesh.unreadable or dicom.pixels). Everything else is read by code that
/// checks each length itself.
struct LibraryLimits {
  bool in_child = false;  ///< the command sets it; a fork() takes some milliseconds
  /// [bytes] Memory that a child may take beyond that of this process; 0: 512 MB and 32 times the
  /// file. Not enforced in builds with the address sanitizer, which reserves terabytes.
  std::uint64_t memory = 0;
  /// [s] of processor time of a child; 0: 15 s and one more for each MB of the file.
  double seconds = 0.0;
};

/// Applies to all reading from now on, by any thread. Do not call it while files are being read. A
/// child is made by fork(): locks that other threads hold stay locked in it, so read while no other
/// thread uses these two libraries.
PALPATE_EXPORT void setLibraryLimits(const LibraryLimits& limits) noexcept;
/// The limits that hold now.
[[nodiscard]] PALPATE_EXPORT LibraryLimits libraryLimits() noexcept;

}  // namespace palpate::vdb
