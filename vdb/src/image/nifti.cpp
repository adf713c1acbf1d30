#include <nifti2_io.h>

#include <cmath>
#include <cstring>
#include <new>

#include "image/byte_stream.h"
#include "image/nifti_header.h"
#include "palpate/core/error.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {
namespace {

/// What the conversion to float met on its way.
struct Oddities {
  std::uint64_t not_finite = 0;
  std::uint64_t rounded = 0;  ///< integers beyond 2^24, which float cannot hold
};

template <typename T>
void convertAs(std::span<const unsigned char> raw, const NiftiHeader& header, float* out,
               Oddities& odd) {
  const std::size_t count = raw.size() / sizeof(T);
  for (std::size_t i = 0; i < count; ++i) {
    T stored;
    std::memcpy(&stored, raw.data() + i * sizeof(T), sizeof(T));
    auto value = static_cast<double>(stored);
    if (header.scaled) value = value * header.slope + header.intercept;
    out[i] = static_cast<float>(value);
    if constexpr (std::is_floating_point_v<T>) {
      odd.not_finite += std::isfinite(out[i]) ? 0U : 1U;
    } else if constexpr (sizeof(T) >= 4) {
      odd.rounded += !header.scaled && std::abs(value) > 16777216.0 ? 1U : 0U;
    }
  }
}

void convert(std::span<unsigned char> raw, const NiftiHeader& header, float* out, Oddities& odd) {
  const int bytes = header.bytes_per_voxel;
  if (header.swapped && bytes > 1) {
    nifti_swap_Nbytes(static_cast<std::int64_t>(raw.size()) / bytes, bytes, raw.data());
  }
  switch (header.type) {
    case VoxelType::kUint8:
      return convertAs<std::uint8_t>(raw, header, out, odd);
    case VoxelType::kInt8:
      return convertAs<std::int8_t>(raw, header, out, odd);
    case VoxelType::kUint16:
      return convertAs<std::uint16_t>(raw, header, out, odd);
    case VoxelType::kInt16:
      return convertAs<std::int16_t>(raw, header, out, odd);
    case VoxelType::kUint32:
      return convertAs<std::uint32_t>(raw, header, out, odd);
    case VoxelType::kInt32:
      return convertAs<std::int32_t>(raw, header, out, odd);
    case VoxelType::kUint64:
      return convertAs<std::uint64_t>(raw, header, out, odd);
    case VoxelType::kInt64:
      return convertAs<std::int64_t>(raw, header, out, odd);
    case VoxelType::kFloat32:
      return convertAs<float>(raw, header, out, odd);
    case VoxelType::kFloat64:
      return convertAs<double>(raw, header, out, odd);
  }
}

[[noreturn]] void failShort(const std::string& path, std::uint64_t voxels, std::uint64_t wanted) {
  throw inputError("nifti.truncated",
                   "the file is cut short: it holds " + std::to_string(voxels) + " of " +
                       std::to_string(wanted) + " voxels",
                   "fetch or write the file again", path);
}

void skip(ByteStream& stream, std::uint64_t bytes, const NiftiHeader& header,
          const std::string& path) {
  std::vector<unsigned char> scratch(4096);
  while (bytes > 0) {
    const auto step = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, scratch.size()));
    const std::size_t got = stream.read(std::span(scratch).first(step));
    if (got == 0) failShort(path, 0, header.voxelCount());
    bytes -= got;
  }
}

}  // namespace

Image readNifti(const std::string& path) try {
  ByteStream stream(path);
  std::uint64_t consumed = 0;
  const NiftiHeader header = readNiftiHeader(stream, path, consumed);
  skip(stream, header.data_offset - consumed, header, path);

  Image image;
  image.source = path;
  image.size = header.size;
  image.axes = header.axes;
  image.origin = header.origin;
  image.notes = header.notes;
  image.values.resize(header.voxelCount());

  Oddities odd;
  const auto bytes = static_cast<std::size_t>(header.bytes_per_voxel);
  std::vector<unsigned char> raw(std::size_t{1} << 20U);  // a multiple of every voxel size
  for (std::uint64_t done = 0; done < image.values.size();) {
    const auto count = static_cast<std::size_t>(
        std::min<std::uint64_t>(raw.size() / bytes, image.values.size() - done));
    const std::size_t got = stream.read(std::span(raw).first(count * bytes));
    if (got < count * bytes) failShort(path, done + got / bytes, header.voxelCount());
    convert(std::span(raw).first(got), header, image.values.data() + done, odd);
    done += count;
  }
  stream.verifyEnd();

  if (odd.not_finite > 0) {
    image.notes.push_back(std::to_string(odd.not_finite) +
                          " voxels are NaN or infinite: NaN is taken as background");
  }
  if (odd.rounded > 0) {
    image.notes.push_back(std::to_string(odd.rounded) +
                          " voxels are integers beyond 16777216 and were rounded");
  }
  return image;
} catch (const std::bad_alloc&) {
  throw Error(ErrorKind::kOperation,
              {"nifti.memory", "there is not enough memory for the image", "crop the image", path});
}

ImageInfo readNiftiInfo(const std::string& path) {
  ByteStream stream(path);
  std::uint64_t consumed = 0;
  const NiftiHeader header = readNiftiHeader(stream, path, consumed);
  return {header.size,         header.axes,        header.origin,
          nameOf(header.type), header.orientation, header.notes};
}

}  // namespace palpate::vdb
