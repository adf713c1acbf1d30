#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <new>

#include "image/header_text.h"
#include "image/image_parts.h"
#include "image/meta_image_header.h"
#include "image/readers.h"
#include "palpate/core/error.h"
#include "palpate/core/stop.h"

namespace palpate::vdb {
namespace {

Error fail(const std::string& path, const char* code, std::string message) {
  return inputError(code, std::move(message), "fetch or write the file again", path);
}

double bytesOfAll(const MetaImageHeader& header) {
  return static_cast<double>(header.voxelCount()) * header.frames *
         static_cast<double>(bytesOf(header.coding.type));
}

/// The voxels as a stream of unpacked bytes. @throws Error if they cannot all be there.
std::unique_ptr<ByteStream> openData(const MetaImageHeader& header, const std::string& path) try {
  std::uint64_t begin = header.data_begin;
  const std::uint64_t size =
      ByteStream(header.data_path, "metaimage", 0, Packing::kNone).fileSize();
  const bool packed = header.packing != Packing::kNone;
  if (header.at_end) {
    const double bytes = packed ? static_cast<double>(header.compressed_bytes) : bytesOfAll(header);
    begin = static_cast<double>(size) > bytes ? size - static_cast<std::uint64_t>(bytes) : 0;
  }
  // MetaIO trusts the size, and reads missing voxels as zeros.
  const std::uint64_t there = size - std::min(begin, size);
  if (packed && header.compressed_bytes > there) {
    throw fail(path, "metaimage.truncated",
               "the file is cut short: its header promises " +
                   std::to_string(header.compressed_bytes) + " bytes of zlib data, and " +
                   std::to_string(there) + " are there");
  }
  auto stream = std::make_unique<ByteStream>(header.data_path, "metaimage", begin, header.packing);
  if (!header.text) stream->requireContent(bytesOfAll(header));
  return stream;
} catch (const Error& error) {
  if (header.data_path == path || error.problem().code != "metaimage.missing") throw;
  throw inputError("metaimage.missing", "its data file " + header.data_path + " is not there",
                   "keep the two files together", path);
}

std::vector<float> readText(const MetaImageHeader& header, const std::string& path,
                            std::uint64_t passed) {
  std::ifstream file(header.data_path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(header.data_begin));
  std::vector<float> values;
  std::uint64_t met = 0;
  for (std::string word; values.size() < header.voxelCount() && file >> word; ++met) {
    if (met % 1024 == 0) pollStop();
    const auto value = numberIn<double>(word);
    if (!value) {
      throw fail(path, "metaimage.damaged",
                 "`" + word.substr(0, 40) + "` among the voxels is not a number");
    }
    if (met < passed) continue;
    values.push_back(static_cast<float>(*value * header.coding.slope + header.coding.intercept));
  }
  if (values.size() < header.voxelCount()) {
    throw fail(path, "metaimage.truncated",
               "the file is cut short: it holds " + std::to_string(values.size()) + " of " +
                   std::to_string(header.voxelCount()) + " voxels");
  }
  return values;
}

}  // namespace

Image readMetaImage(const std::string& path, const ImageOptions& options) try {
  const MetaImageHeader header = readMetaImageHeader(path, options);
  Image image = emptyImage(path, header.size, header.place, header.notes);
  const std::uint64_t passed =
      static_cast<std::uint64_t>(options.frame.value_or(0)) * header.voxelCount();
  const auto stream = openData(header, path);
  if (header.text) {
    image.values = readText(header, path, passed);
    return image;
  }
  skipBytes(*stream, passed * bytesOf(header.coding.type), header.voxelCount());
  Oddities odd;
  image.values = readVoxels(*stream, header.voxelCount(), header.coding, odd);
  const auto later_frames =
      static_cast<std::uint64_t>(header.frames - 1 - options.frame.value_or(0));
  const std::uint64_t most = later_frames * header.voxelCount() * bytesOf(header.coding.type);
  if (stream->verifyEnd(most) > most) {
    throw fail(path, "metaimage.size",
               "the file holds more voxels than its header asks for: sizes or type may be wrong");
  }
  if (header.compressed_bytes > 0 && stream->isPacked() &&
      stream->packedBytes() != header.compressed_bytes) {
    throw fail(path, "metaimage.compressed_size",
               "its header promises " + std::to_string(header.compressed_bytes) +
                   " bytes of zlib data, and they end after " +
                   std::to_string(stream->packedBytes()));
  }
  odd.tell(image.notes);
  return image;
} catch (const std::bad_alloc&) {
  throw notEnoughMemory("metaimage", path);
}

ImageInfo readMetaImageInfo(const std::string& path, const ImageOptions& options) {
  const MetaImageHeader header = readMetaImageHeader(path, options);
  (void)openData(header, path);
  ImageInfo info = infoOf(header.size, header.place, header.notes);
  info.data_type = nameOf(header.coding.type);
  info.format = "MetaImage";
  return info;
}

}  // namespace palpate::vdb
