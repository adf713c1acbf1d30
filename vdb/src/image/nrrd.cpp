#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <new>

#include "image/header_text.h"
#include "image/image_parts.h"
#include "image/nrrd_header.h"
#include "image/nrrd_segments.h"
#include "image/readers.h"
#include "palpate/core/error.h"
#include "palpate/core/stop.h"

namespace palpate::vdb {
namespace {

int entriesOf(const NrrdHeader& header) {
  return header.other ? static_cast<int>(header.sizes[*header.other]) : 1;
}

/// Reads numbers written as text.
std::vector<float> readText(const NrrdHeader& header, Oddities& odd) {
  std::ifstream file(header.data_path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(header.data_begin) +
             static_cast<std::streamoff>(header.byte_skip));
  std::vector<float> values;
  for (std::string word; values.size() < header.count() && file >> word;) {
    if (values.size() % 1024 == 0) pollStop();
    if (word.ends_with(',')) word.pop_back();
    const std::string lower = lowerCase(word);
    const auto value =
        lower == "nan" ? std::numeric_limits<double>::quiet_NaN() : numberIn<double>(word);
    if (!value) {
      throw inputError("nrrd.damaged",
                       "`" + word.substr(0, 40) + "` among the voxels is not a number",
                       "fetch or write the file again", header.data_path);
    }
    values.push_back(static_cast<float>(*value));
    odd.not_finite += std::isfinite(*value) ? 0U : 1U;
  }
  if (values.size() < header.count()) {
    throw inputError("nrrd.truncated",
                     "the file is cut short: it holds " + std::to_string(values.size()) + " of " +
                         std::to_string(header.count()) + " voxels",
                     "fetch or write the file again", header.data_path);
  }
  return values;
}

/// The voxels as a stream of unpacked bytes. @throws Error if they cannot all be there.
std::unique_ptr<ByteStream> openData(const NrrdHeader& header, const std::string& path) try {
  const double bytes =
      static_cast<double>(header.count()) * static_cast<double>(bytesOf(header.coding.type));
  const bool gzip = header.encoding == NrrdEncoding::kGzip;
  std::uint64_t begin = header.data_begin;
  if (header.byte_skip < 0) {
    const ByteStream whole(header.data_path, "nrrd", 0, Packing::kNone);
    begin = static_cast<double>(whole.fileSize()) > bytes
                ? whole.fileSize() - static_cast<std::uint64_t>(bytes)
                : 0;
  }
  auto stream = std::make_unique<ByteStream>(header.data_path, "nrrd", begin,
                                             gzip ? Packing::kGzip : Packing::kNone);
  stream->requireContent(bytes + static_cast<double>(std::max<std::int64_t>(header.byte_skip, 0)));
  return stream;
} catch (const Error& error) {
  if (header.data_path == path || error.problem().code != "nrrd.missing") throw;
  throw inputError("nrrd.missing", "its data file " + header.data_path + " is not there",
                   "keep the two files together", path);
}

std::vector<float> readAll(const NrrdHeader& header, const std::string& path, Oddities& odd) {
  if (header.encoding == NrrdEncoding::kText) return readText(header, odd);
  const auto stream = openData(header, path);
  skipBytes(*stream, static_cast<std::uint64_t>(std::max<std::int64_t>(header.byte_skip, 0)),
            header.count());
  std::vector<float> values = readVoxels(*stream, header.count(), header.coding, odd);
  if (stream->verifyEnd(0) > 0) {
    throw inputError(
        "nrrd.size",
        "the file holds more bytes than its header asks for: sizes or type may be wrong",
        "write the file again", path);
  }
  return values;
}

/// The volume number `entry` along the axis that is not spatial.
std::vector<float> volume(const std::vector<float>& all, const NrrdHeader& header, int entry) {
  std::size_t inner = 1;  // values that belong to one entry and follow each other
  for (std::size_t axis = 0; axis < *header.other; ++axis) {
    inner *= static_cast<std::size_t>(header.sizes[axis]);
  }
  const auto entries = static_cast<std::size_t>(entriesOf(header));
  std::vector<float> out;
  out.reserve(all.size() / entries);
  for (std::size_t at = static_cast<std::size_t>(entry) * inner; at < all.size();
       at += inner * entries) {
    out.insert(out.end(), all.begin() + static_cast<std::ptrdiff_t>(at),
               all.begin() + static_cast<std::ptrdiff_t>(at + inner));
  }
  return out;
}

/// The chosen frame. @throws Error if there are several and none was chosen, or if the chosen one
/// does not exist.
int chosenFrame(const NrrdHeader& header, const std::string& path, const ImageOptions& options) {
  const int entries = entriesOf(header);
  const int frame = options.frame.value_or(0);
  if (frame < 0 || frame >= entries) {
    throw inputError(
        "nrrd.frame",
        "there is no frame " + std::to_string(frame) + " in an image of " + shapeText(header.sizes),
        "frames are counted from 0", path);
  }
  if (entries > 1 && !options.frame) {
    throw inputError("nrrd.dimensions",
                     "the image has 4 dimensions (" + shapeText(header.sizes) +
                         "); one 3-D volume of single values is needed",
                     "frame chooses one of the " + std::to_string(entries) +
                         " volumes, from 0 (on the command line --frame 0)",
                     path);
  }
  return frame;
}

/// The file's segments, if it has some and no single frame was chosen.
Segments segmentsOf(const NrrdHeader& header, const std::string& path,
                    const ImageOptions& options) {
  if (options.frame) return Segments({}, 1, path);
  return {header.pairs, entriesOf(header), path};
}

}  // namespace

Image readNrrd(const std::string& path, const ImageOptions& options) try {
  const NrrdHeader header = readNrrdHeader(path, options);
  const Segments segments = segmentsOf(header, path, options);
  const int frame = segments.empty() ? chosenFrame(header, path, options) : 0;
  Image image = emptyImage(path, header.size(), header.place, header.notes);
  Oddities odd;
  image.values = readAll(header, path, odd);
  if (!segments.empty()) {
    std::vector<std::vector<float>> layers;
    for (int n = 0; header.other && n < entriesOf(header); ++n) {
      layers.push_back(volume(image.values, header, n));
    }
    if (!header.other) layers.push_back(std::move(image.values));
    image.notes.insert(image.notes.end(), segments.notes().begin(), segments.notes().end());
    image.values =
        segments.merged(layers, image.size, std::abs(glm::determinant(image.axes)), image.notes);
    image.labels = segments.table();
  } else if (header.other) {
    image.values = volume(image.values, header, frame);
  }
  odd.tell(image.notes);
  return image;
} catch (const std::bad_alloc&) {
  throw notEnoughMemory("nrrd", path);
}

ImageInfo readNrrdInfo(const std::string& path, const ImageOptions& options) {
  const NrrdHeader header = readNrrdHeader(path, options);
  const Segments segments = segmentsOf(header, path, options);
  if (segments.empty()) (void)chosenFrame(header, path, options);
  if (header.encoding != NrrdEncoding::kText) (void)openData(header, path);
  ImageInfo info = infoOf(header.size(), header.place, header.notes);
  info.data_type = nameOf(header.coding.type);
  info.notes.insert(info.notes.end(), segments.notes().begin(), segments.notes().end());
  info.format = segments.empty() ? "NRRD" : "NRRD segmentation";
  info.length_unit = header.length_unit;
  info.labels = segments.table();
  info.is_labels = !segments.empty();
  return info;
}

LabelCodes readNrrdCodes(const std::string& path, const ImageOptions& options) {
  return segmentsOf(readNrrdHeader(path, options), path, options).codes();
}

}  // namespace palpate::vdb
