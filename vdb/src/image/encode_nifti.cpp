#include <nifti1.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "palpate/core/error.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {
namespace {

static_assert(std::endian::native == std::endian::little, "the header is written as it stands");

constexpr double kMillimeters = 1e3;
constexpr std::size_t kVoxelsAt = 352;  ///< after the header, and four bytes that say: no extension

std::string gzipped(const std::string& bytes) {
  z_stream stream{};
  constexpr int kGzip = 16;  // zlib: added to the window size, it selects the gzip format
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, MAX_WBITS + kGzip, 8,
                   Z_DEFAULT_STRATEGY) != Z_OK) {
    throw Error(ErrorKind::kOperation, {"nifti.gzip", "zlib has no memory"});
  }
  std::string out;
  char room[1 << 16];
  std::size_t taken = 0;
  int status = Z_OK;
  while (status == Z_OK) {
    if (stream.avail_in == 0) {
      // zlib counts in 32 bits.
      const std::size_t piece = std::min<std::size_t>(bytes.size() - taken, 1U << 30U);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + taken));
      stream.avail_in = static_cast<uInt>(piece);
      taken += piece;
    }
    stream.next_out = reinterpret_cast<Bytef*>(room);
    stream.avail_out = sizeof room;
    status = deflate(&stream, taken == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
    out.append(room, sizeof room - stream.avail_out);
  }
  deflateEnd(&stream);
  return out;
}

/// The whole header except the data type and its size.
nifti_1_header headerOf(const Image& image) {
  nifti_1_header header{};
  header.sizeof_hdr = sizeof header;
  header.regular = 'r';
  header.dim[0] = 3;
  std::size_t count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int size = image.size[axis];
    if (size < 1 || size > 32767) {
      throw inputError(
          "nifti.size",
          "an image of " + std::to_string(size) + " voxels along axis " + std::to_string(axis + 1),
          "NIfTI-1 holds from 1 to 32767 along each axis", image.source);
    }
    header.dim[axis + 1] = static_cast<short>(size);
    header.pixdim[axis + 1] =
        static_cast<float>(glm::length(image.axes[static_cast<int>(axis)]) * kMillimeters);
    count *= static_cast<std::size_t>(size);
  }
  for (int axis = 4; axis < 8; ++axis) header.dim[axis] = 1;
  if (image.values.size() != count) {
    throw inputError("nifti.size",
                     "the image has " + std::to_string(image.values.size()) + " values for " +
                         std::to_string(count) + " voxels",
                     "", image.source);
  }
  header.vox_offset = kVoxelsAt;
  header.scl_slope = 1.0F;
  header.xyzt_units = NIFTI_UNITS_MM;
  header.sform_code = NIFTI_XFORM_ALIGNED_ANAT;
  float* const rows[3] = {header.srow_x, header.srow_y, header.srow_z};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      rows[row][column] = static_cast<float>(image.axes[column][row] * kMillimeters);
    }
    rows[row][3] = static_cast<float>(image.origin[row] * kMillimeters);
  }
  std::memcpy(header.magic, "n+1", 4);
  std::memcpy(header.descrip, "palpate", 7);
  return header;
}

template <class Number>
std::string bytesOf(const Image& image, nifti_1_header header, short datatype, bool gzip) {
  header.datatype = datatype;
  header.bitpix = 8 * sizeof(Number);
  std::string bytes(kVoxelsAt + image.values.size() * sizeof(Number), '\0');
  std::memcpy(bytes.data(), &header, sizeof header);
  if constexpr (std::is_same_v<Number, float>) {
    std::memcpy(bytes.data() + kVoxelsAt, image.values.data(), bytes.size() - kVoxelsAt);
  } else {
    char* at = bytes.data() + kVoxelsAt;
    for (const float value : image.values) {
      const auto number = static_cast<Number>(value);
      std::memcpy(at, &number, sizeof number);
      at += sizeof number;
    }
  }
  return gzip ? gzipped(bytes) : bytes;
}

}  // namespace

std::string encodeNifti(const Image& image, bool gzip) {
  return bytesOf<float>(image, headerOf(image), DT_FLOAT32, gzip);
}

std::string encodeLabels(const Image& image, bool gzip) {
  nifti_1_header header = headerOf(image);
  header.intent_code = NIFTI_INTENT_LABEL;
  float most = 0.0F;
  for (const float value : image.values) {
    // Written so that NaN fails too.
    if (!(value >= 0.0F && value <= 65535.0F && std::floor(value) == value)) {
      throw inputError("nifti.label", "a voxel is " + std::to_string(value),
                       "labels are whole numbers from 0 to 65535", image.source);
    }
    most = std::max(most, value);
  }
  return most > 255.0F ? bytesOf<std::uint16_t>(image, header, DT_UINT16, gzip)
                       : bytesOf<std::uint8_t>(image, header, DT_UINT8, gzip);
}

}  // namespace palpate::vdb
