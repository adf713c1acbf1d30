#include <new>

#include "image/image_parts.h"
#include "image/nifti_header.h"
#include "image/nifti_labels.h"
#include "palpate/core/error.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {
namespace {

/// Limit well above any table of names; a longer gap before the voxels is skipped.
constexpr std::uint64_t kLongestExtensions = std::uint64_t{1} << 24U;

/// Some writers pad behind the voxels; more than this is not padding.
constexpr std::uint64_t kMostPadding = std::uint64_t{1} << 20U;

/// Reads label names stored between header and voxels; returns how many bytes were read.
std::uint64_t readLabels(ByteStream& stream, const NiftiHeader& header, const std::string& path,
                         LabelTable& labels) {
  if (header.extension_bytes > kLongestExtensions) return 0;
  std::vector<unsigned char> bytes(header.extension_bytes);
  const std::size_t got = stream.read(bytes);
  if (got < bytes.size()) stream.failShort(0, header.voxelCount());
  labels = niftiLabels(bytes, header.coding.swapped, path);
  return got;
}

}  // namespace

Image readNifti(const std::string& path, const ImageOptions& options) try {
  ByteStream stream(path, "nifti");
  const NiftiHeader header = readNiftiHeader(stream, path, options);
  Image image = emptyImage(path, header.size, header.place, header.notes);
  const std::uint64_t done = header.header_bytes + readLabels(stream, header, path, image.labels);
  skipBytes(stream, header.data_offset - done, header.voxelCount());
  Oddities odd;
  image.values = readVoxels(stream, header.voxelCount(), header.coding, odd);
  if (const std::uint64_t most = header.later_bytes + kMostPadding; stream.verifyEnd(most) > most) {
    throw inputError("nifti.size",
                     "the file holds far more than its header asks for: sizes or type may be wrong",
                     "write the file again", path);
  }
  odd.tell(image.notes);
  return image;
} catch (const std::bad_alloc&) {
  throw notEnoughMemory("nifti", path);
}

ImageInfo readNiftiInfo(const std::string& path, const ImageOptions& options) {
  ByteStream stream(path, "nifti");
  const NiftiHeader header = readNiftiHeader(stream, path, options);
  ImageInfo info = infoOf(header.size, header.place, header.notes);
  info.data_type = nameOf(header.coding.type);
  info.format = "NIfTI-" + std::to_string(header.version);
  info.length_unit = header.length_unit;
  readLabels(stream, header, path, info.labels);
  info.is_labels = header.is_labels || !info.labels.names.empty();
  return info;
}

}  // namespace palpate::vdb
