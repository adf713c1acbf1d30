#include "image/nifti_header.h"

#include <nifti2_io.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>

#include "palpate/core/error.h"
#include "palpate/core/text.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

struct FreeNifti {
  void operator()(nifti_image* image) const noexcept { nifti_image_free(image); }
};
using NiftiPtr = std::unique_ptr<nifti_image, FreeNifti>;

constexpr std::size_t kNifti1Size = sizeof(nifti_1_header);
constexpr std::size_t kNifti2Size = sizeof(nifti_2_header);
static_assert(kNifti1Size == 348 && kNifti2Size == 540);

Error fail(const std::string& path, const char* code, std::string message, std::string hint = {}) {
  return inputError(code, std::move(message), std::move(hint), path);
}

Error notNifti(const std::string& path) {
  return fail(path, "nifti.format", "this is not a NIfTI file",
              "such files end in .nii or .nii.gz (NIfTI-1 or NIfTI-2)");
}

void checkMagic(const char* magic, char version, const std::string& path) {
  if (magic[0] == 'n' && magic[2] == version && magic[3] == '\0') {
    if (magic[1] == '+') return;
    if (magic[1] == 'i') {
      throw fail(path, "nifti.pair", "this is the header of a detached .hdr / .img pair",
                 "convert the pair to a single .nii or .nii.gz file");
    }
  }
  if (version == '1') {
    throw fail(path, "nifti.analyze",
               "this looks like an Analyze 7.5 header, which says nothing "
               "about orientation",
               "convert the image to NIfTI with the orientation you know of");
  }
  throw notNifti(path);
}

/// Checks dim[] before libnifti sees it: libnifti prints its complaints to stderr, whatever its
/// debug level.
template <typename Header>
void checkDimensions(const Header& header, const std::string& path, std::optional<int> frame) {
  if (header.dim[0] < 1 || header.dim[0] > 7) {
    throw fail(
        path, "nifti.dimensions",
        "the header gives " + std::to_string(header.dim[0]) + " dimensions; NIfTI has 1 to 7");
  }
  std::string shape;
  bool more_than_3d = false;
  bool more_than_4d = false;
  for (int i = 1; i <= header.dim[0]; ++i) {
    shape += (i > 1 ? " x " : "") + std::to_string(header.dim[i]);
    more_than_3d = more_than_3d || (i > 3 && header.dim[i] > 1);
    more_than_4d = more_than_4d || (i > 4 && header.dim[i] > 1);
  }
  for (int i = 1; i <= header.dim[0]; ++i) {
    if (header.dim[i] < 1 || header.dim[i] > std::numeric_limits<int>::max()) {
      throw fail(path, "nifti.dimensions", "the image is " + shape + " voxels, which cannot be");
    }
  }
  if (more_than_4d || (more_than_3d && !frame)) {
    throw fail(path, "nifti.dimensions",
               "the image has " + std::to_string(header.dim[0]) + " dimensions (" + shape +
                   "); one 3-D volume of single values is needed",
               more_than_4d ? "save the volume that you mean to a file of its own"
                            : "frame chooses one of the " + std::to_string(header.dim[4]) +
                                  " volumes, from 0 (on the command line --frame 0)");
  }
  const auto frames = header.dim[0] >= 4 ? static_cast<std::int64_t>(header.dim[4]) : 1;
  if (frame && (*frame < 0 || *frame >= frames)) {
    throw fail(path, "nifti.frame",
               "there is no frame " + std::to_string(*frame) + " in an image of " + shape,
               "frames are counted from 0");
  }
  if (header.dim[0] < 3 || header.dim[1] < 2 || header.dim[2] < 2 || header.dim[3] < 2) {
    throw fail(path, "nifti.dimensions",
               "the image is " + shape +
                   "; a 3-D image with at least two voxels along each axis "
                   "is needed");
  }
}

Scalar voxelType(int datatype, const std::string& path) {
  switch (datatype) {
    case NIFTI_TYPE_UINT8:
      return Scalar::kUint8;
    case NIFTI_TYPE_INT8:
      return Scalar::kInt8;
    case NIFTI_TYPE_UINT16:
      return Scalar::kUint16;
    case NIFTI_TYPE_INT16:
      return Scalar::kInt16;
    case NIFTI_TYPE_UINT32:
      return Scalar::kUint32;
    case NIFTI_TYPE_INT32:
      return Scalar::kInt32;
    case NIFTI_TYPE_UINT64:
      return Scalar::kUint64;
    case NIFTI_TYPE_INT64:
      return Scalar::kInt64;
    case NIFTI_TYPE_FLOAT32:
      return Scalar::kFloat32;
    case NIFTI_TYPE_FLOAT64:
      return Scalar::kFloat64;
    default:
      break;
  }
  std::string name = "code " + std::to_string(datatype);
  if (nifti_is_valid_datatype(datatype) != 0) {
    name = std::string(nifti_datatype_to_string(datatype)) + ", " + name;
  }
  throw fail(path, "nifti.data_type",
             "voxels of this data type (" + name +
                 ") are not single numbers "
                 "that can be read",
             "save the image with an integer or float type of 8 to 64 bits");
}

/// [m] Size of one unit of the header's spatial coordinates.
double metersPerSpaceUnit(int code, const std::string& path, std::vector<std::string>& notes) {
  switch (code) {
    case NIFTI_UNITS_METER:
      return 1.0;
    case NIFTI_UNITS_MM:
      return 1e-3;
    case NIFTI_UNITS_MICRON:
      return 1e-6;
    case NIFTI_UNITS_UNKNOWN:
      notes.emplace_back("the header names no length unit (unit code 0): taken as mm");
      return 1e-3;
    default:
      break;
  }
  throw fail(path, "nifti.unit",
             "the header's length unit has code " + std::to_string(code) +
                 "; 1 (m), 2 (mm) and 3 (um) are known",
             "set xyzt_units to 2 if the image is in mm");
}

Place placeOf(const nifti_dmat44& m) {
  Place a;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) a.axes[column][row] = m.m[row][column];
    a.origin[row] = m.m[row][3];
  }
  return a;
}

void checkPlace(const Place& place, const char* name, const std::string& path) {
  if (!isUsable(place)) {
    throw fail(path, "nifti.singular",
               std::string("the ") + name + " is singular: it gives the voxels no volume in space",
               std::string("set a valid sform") +
                   (name[0] == 's' ? ", or set sform_code to 0 to use the qform" : ""));
  }
}

void checkSpacings(const nifti_image& nim, const char* user, const std::string& path) {
  for (int i = 1; i <= 3; ++i) {
    // libnifti replaces such spacings by 1.
    if (!(nim.pixdim[i] > 0.0) || !std::isfinite(nim.pixdim[i])) {
      throw fail(path, "nifti.spacing",
                 "the voxel spacing pixdim[" + std::to_string(i) + "] is " +
                     shortNumber(nim.pixdim[i], 3) + ", which " + user + " needs to be positive",
                 "set the sform and set qform_code to 0");
    }
  }
}

/// [units of the file] The qform as a place.
std::optional<Place> qform(const nifti_image& nim, const std::string& path) {
  if (nim.qform_code <= 0) return std::nullopt;
  checkSpacings(nim, "the qform", path);
  const Place place = placeOf(nim.qto_xyz);
  checkPlace(place, "qform", path);
  return place;
}

std::optional<Place> sform(const nifti_image& nim, const std::string& path) {
  if (nim.sform_code <= 0) return std::nullopt;
  const Place place = placeOf(nim.sto_xyz);
  checkPlace(place, "sform", path);
  return place;
}

Place chosen(const std::optional<Place>& form, const char* name, const std::string& path) {
  if (form) return *form;
  throw fail(
      path, "nifti.no_affine",
      std::string("the ") + name + " was asked for, but the file does not set it (its code is 0)",
      "leave the choice out, or choose another: sform, qform, spacing");
}

Place placeInSpace(const nifti_image& nim, const std::array<int, 3>& size, const std::string& path,
                   AffineChoice choice) {
  if (choice == AffineChoice::kSform) return chosen(sform(nim, path), "sform", path);
  if (choice == AffineChoice::kQform) return chosen(qform(nim, path), "qform", path);
  if (choice == AffineChoice::kSpacing) {
    checkSpacings(nim, "affine: spacing", path);
    Place place;
    for (int i = 0; i < 3; ++i) place.axes[i][i] = nim.pixdim[i + 1];
    return place;
  }
  const std::optional<Place> from_q = qform(nim, path);
  const std::optional<Place> from_s = sform(nim, path);
  if (!from_s) {
    if (from_q) return *from_q;
    throw fail(
        path, "nifti.no_affine",
        "neither the sform nor the qform is set, so the place and orientation of the image "
        "are not known",
        "set the sform, for example in Python with nibabel: image.set_sform(affine, code=1); or, "
        "if axes "
        "along R, A, S from 0 will do: affine: spacing (on the command line --affine spacing)");
  }
  if (from_q) {
    const double apart = disagreement(*from_s, *from_q, size);
    if (apart > 0.1) {
      throw fail(
          path, "nifti.affine_conflict",
          "sform (code " + std::to_string(nim.sform_code) + ") and qform (code " +
              std::to_string(nim.qform_code) + ") place the image differently: by " +
              shortNumber(apart, 3) + " voxels at a corner, 0.1 at most is taken as agreement",
          "set the code of the wrong one to 0, or say which counts: affine: sform or affine: qform "
          "(on the command line --affine sform)");
    }
  }
  return *from_s;
}

void applyScaling(NiftiHeader& out, const nifti_image& nim) {
  if (!std::isfinite(nim.scl_slope) || nim.scl_slope == 0.0) return;  // "none", says the standard
  VoxelCoding& coding = out.coding;
  coding.slope = nim.scl_slope;
  coding.intercept = std::isfinite(nim.scl_inter) ? nim.scl_inter : 0.0;
  coding.scaled = coding.slope != 1.0 || coding.intercept != 0.0;
}

template <typename Header>
NiftiHeader interpret(Header raw, int version, bool swapped, const std::string& path,
                      const ImageOptions& options) {
  if (swapped) swap_nifti_header(&raw, version);
  checkMagic(raw.magic, version == 1 ? '1' : '2', path);
  checkDimensions(raw, path, options.frame);

  NiftiHeader out;
  out.version = version;
  out.coding.type = voxelType(raw.datatype, path);
  out.coding.swapped = swapped;
  out.is_labels = raw.intent_code == NIFTI_INTENT_LABEL;
  // The file's own spacings, before libnifti changes them.
  const double pixdim[4] = {0.0, static_cast<double>(raw.pixdim[1]),
                            static_cast<double>(raw.pixdim[2]), static_cast<double>(raw.pixdim[3])};
  NiftiPtr nim;
  if constexpr (sizeof(Header) == kNifti1Size) {
    nim.reset(nifti_convert_n1hdr2nim(raw, nullptr));
  } else {
    nim.reset(nifti_convert_n2hdr2nim(raw, nullptr));
  }
  if (!nim) throw fail(path, "nifti.format", "libnifti cannot make sense of the header");
  std::copy(pixdim + 1, pixdim + 4, nim->pixdim + 1);

  out.size = {static_cast<int>(nim->nx), static_cast<int>(nim->ny), static_cast<int>(nim->nz)};
  const auto offset = static_cast<double>(raw.vox_offset);
  out.header_bytes = sizeof(Header);
  const std::size_t header_size = sizeof(Header) + 4;  // four bytes announce the extensions
  if (!(offset >= 0.0) || offset > 1e15) {
    throw fail(path, "nifti.offset",
               "the voxels are said to begin at byte " + shortNumber(offset, 3));
  }
  out.data_offset = std::max<std::uint64_t>(static_cast<std::uint64_t>(offset), header_size);
  out.extension_bytes = out.data_offset - sizeof(Header);
  out.data_offset += static_cast<std::uint64_t>(options.frame.value_or(0)) * out.voxelCount() *
                     bytesOf(out.coding.type);
  const auto frames = raw.dim[0] >= 4 ? static_cast<std::int64_t>(raw.dim[4]) : 1;
  const double later = static_cast<double>(frames - 1 - options.frame.value_or(0)) *
                       static_cast<double>(out.size[0]) * static_cast<double>(out.size[1]) *
                       static_cast<double>(out.size[2]) *
                       static_cast<double>(bytesOf(out.coding.type));
  out.later_bytes = static_cast<std::uint64_t>(std::clamp(later, 0.0, 1e18));
  applyScaling(out, *nim);

  const double scale = metersPerSpaceUnit(nim->xyz_units, path, out.notes);
  out.length_unit = nim->xyz_units == NIFTI_UNITS_METER    ? "m"
                    : nim->xyz_units == NIFTI_UNITS_MICRON ? "um"
                                                           : "mm";
  out.place = scaled(placeInSpace(*nim, out.size, path, options.affine), scale);
  return out;
}

}  // namespace

NiftiHeader readNiftiHeader(ByteStream& stream, const std::string& path,
                            const ImageOptions& options) {
  nifti_set_debug_level(0);  // otherwise libnifti prints to stderr
  std::array<unsigned char, kNifti2Size> bytes{};
  std::size_t consumed = stream.read(std::span(bytes).first(kNifti1Size));
  std::int32_t header_size = 0;
  std::memcpy(&header_size, bytes.data(), sizeof header_size);
  std::int32_t other_order = header_size;
  nifti_swap_4bytes(1, &other_order);
  const auto is = [&](std::size_t size) {
    return header_size == static_cast<std::int32_t>(size) ||
           other_order == static_cast<std::int32_t>(size);
  };
  if (!is(kNifti1Size) && !is(kNifti2Size)) {
    if (consumed < sizeof header_size && stream.brokeOff()) stream.verifyEnd(0);
    throw notNifti(path);
  }
  const std::size_t wanted = is(kNifti1Size) ? kNifti1Size : kNifti2Size;
  if (consumed == kNifti1Size && wanted > consumed) {
    consumed += stream.read(std::span(bytes).subspan(kNifti1Size));
  }
  if (consumed < wanted) {
    throw fail(path, "nifti.truncated",
               "the file ends within its header (" + std::to_string(consumed) + " of " +
                   std::to_string(wanted) + " bytes)",
               "fetch or write the file again");
  }
  const bool swapped = header_size != static_cast<std::int32_t>(wanted);
  NiftiHeader header;
  if (wanted == kNifti1Size) {
    nifti_1_header raw;
    std::memcpy(&raw, bytes.data(), sizeof raw);
    header = interpret(raw, 1, swapped, path, options);
  } else {
    nifti_2_header raw;
    std::memcpy(&raw, bytes.data(), sizeof raw);
    header = interpret(raw, 2, swapped, path, options);
  }
  // In doubles: the product of three ints and eight bytes may overflow integers here.
  stream.requireContent(static_cast<double>(header.data_offset) +
                        static_cast<double>(header.size[0]) * static_cast<double>(header.size[1]) *
                            static_cast<double>(header.size[2]) *
                            static_cast<double>(bytesOf(header.coding.type)));
  return header;
}

}  // namespace palpate::vdb
