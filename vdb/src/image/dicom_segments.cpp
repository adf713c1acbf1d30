#include "image/dicom_segments.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>

#include "image/dicom_codes.h"
#include "image/dicom_pixels.h"
#include "image/image_parts.h"
#include "image/planes.h"
#include "image/structures.h"
#include "palpate/core/error.h"
#include "palpate/core/stop.h"
#include "palpate/core/text.h"

namespace palpate::vdb {
namespace {

using namespace dicom;

constexpr std::uint32_t kType = 0x00620001;
constexpr std::uint32_t kSegments = 0x00620002;
constexpr std::uint32_t kNumber = 0x00620004;
constexpr std::uint32_t kName = 0x00620005;
constexpr std::uint32_t kColor = 0x0062000D;
constexpr std::uint32_t kLargest = 0x0062000E;
constexpr std::uint32_t kSegmentOfFrame = 0x0062000A;
constexpr std::uint32_t kReferredNumber = 0x0062000B;
constexpr std::uint32_t kPropertyType = 0x0062000F;
constexpr std::uint32_t kShared = 0x52009229;
constexpr std::uint32_t kPerFrame = 0x52009230;
constexpr std::uint32_t kPlanePosition = 0x00209113;
constexpr std::uint32_t kPlaneOrientation = 0x00209116;
constexpr std::uint32_t kMeasures = 0x00289110;
constexpr std::uint32_t kThickness = 0x00180050;
constexpr std::uint32_t kBetweenSlices = 0x00180088;
constexpr int kMargin = 1;

enum class SegmentKind { kBinary, kFractional, kLabelMap };

Error fail(const DicomItem& of, const char* code, std::string message, std::string hint = {}) {
  return inputError(code, std::move(message), std::move(hint), of.path);
}

/// A file whose header is consistent.
struct SegmentFile {
  DicomElements elements;
  SegmentKind kind = SegmentKind::kBinary;
  LabelTable table;
  LabelCodes codes;
  int rows = 0;
  int columns = 0;
  PlaneSet planes;
  PlaneGrid grid;
  Place place;
  std::vector<int> segment_of;  ///< for each frame; empty in label maps
  std::vector<std::string> notes;

  [[nodiscard]] std::size_t frames() const { return planes.positions.size(); }
  [[nodiscard]] std::size_t pixelsOfFrame() const {
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  }
  [[nodiscard]] std::array<int, 3> size() const { return {columns, rows, grid.count}; }
};

int requireShort(const DicomItem& of, std::uint32_t tag, const char* name, int least) {
  const int value = of.shortAt(tag).value_or(0);
  if (value < least) {
    throw fail(of, "dicom.segments",
               std::string(name) + " is missing, or " + std::to_string(value));
  }
  return value;
}

void readKind(SegmentFile& out) {
  const std::string type = out.elements.text(kType);
  if (type == "BINARY") {
    out.kind = SegmentKind::kBinary;
  } else if (type == "FRACTIONAL") {
    out.kind = SegmentKind::kFractional;
  } else if (type == "LABELMAP") {
    out.kind = SegmentKind::kLabelMap;
  } else {
    throw fail(out.elements, "dicom.segments", "segments of the type '" + type + "' cannot be read",
               "BINARY, FRACTIONAL and LABELMAP can");
  }
  const int allocated = out.elements.shortAt(kBitsAllocated).value_or(0);
  const bool fits = out.kind == SegmentKind::kBinary       ? allocated == 1
                    : out.kind == SegmentKind::kFractional ? allocated == 8
                                                           : allocated == 8 || allocated == 16;
  if (!fits || out.elements.shortAt(kSamplesPerPixel).value_or(1) != 1) {
    throw fail(out.elements, "dicom.data_type",
               "a segmentation of the type " + type + " with " + std::to_string(allocated) +
                   " bits a pixel cannot be read");
  }
  if (out.kind == SegmentKind::kBinary && out.elements.packed) {
    throw fail(out.elements, "dicom.pixels", "binary segments are packed as images are",
               "save it uncompressed (gdcmconv --raw)");
  }
}

void readTable(SegmentFile& out) {
  for (const DicomItem& segment : out.elements.items(kSegments)) {
    const auto number = segment.shortAt(kNumber);
    if (!number) throw fail(segment, "dicom.segments", "a segment has no number");
    // Label maps may describe their background, which is not a segment.
    if (*number == 0) continue;
    const auto code = codeIn(segment, kPropertyType);
    std::string name = segment.text(kName);
    if (name.empty() && code) name = code->meaning;
    if (name.empty()) name = "segment " + std::to_string(*number);
    if (!out.table.names.emplace(*number, name).second) {
      throw fail(segment, "dicom.segments",
                 "segment '" + name + "' has number " + std::to_string(*number) +
                     ", as another segment has",
                 "save the segmentation again");
    }
    if (code) out.codes[*number] = *code;
    const std::vector<int> lab = segment.shorts(kColor, 3);
    if (!lab.empty()) out.table.colors[*number] = colorOfLab(lab);
  }
  if (out.table.names.empty()) {
    throw fail(out.elements, "dicom.segments", "the file describes no segment", {});
  }
}

/// The functional group of frame `n` itself, or else the shared one of all frames; null if neither
/// has one.
const DicomItem* groupOf(const SegmentFile& file, std::size_t n, std::uint32_t tag) {
  const std::vector<DicomItem>& frames = file.elements.items(kPerFrame);
  if (n < frames.size()) {
    if (const DicomItem* own = frames[n].first(tag)) return own;
  }
  const DicomItem* const shared = file.elements.first(kShared);
  return shared == nullptr ? nullptr : shared->first(tag);
}

const DicomItem& requireGroup(const SegmentFile& file, std::size_t n, std::uint32_t tag,
                              std::uint32_t value, const char* name) {
  const DicomItem* const group = groupOf(file, n, tag);
  if (group == nullptr || !group->has(value)) {
    throw fail(
        file.elements, "dicom.no_affine",
        "frame " + std::to_string(n + 1) + " has no " + name + ", so its place is not known");
  }
  return *group;
}

void readPlanes(SegmentFile& out) {
  const double count = out.elements.numbers(kFrames, 1).front();
  const std::size_t frames = out.elements.items(kPerFrame).size();
  if (count < 1.0 || static_cast<double>(frames) != count) {
    throw fail(out.elements, "dicom.segments",
               "the file has " + out.elements.text(kFrames) + " frames and describes " +
                   std::to_string(frames),
               "fetch or write the file again");
  }
  for (std::size_t n = 0; n < frames; ++n) {
    if (n % 64 == 0) pollStop();
    const auto position = requireGroup(out, n, kPlanePosition, kPosition, "ImagePositionPatient")
                              .numbers(kPosition, 3);
    const auto directions =
        requireGroup(out, n, kPlaneOrientation, kOrientation, "ImageOrientationPatient")
            .numbers(kOrientation, 6);
    const DicomItem& measures = requireGroup(out, n, kMeasures, kPixelSpacing, "PixelSpacing");
    const auto spacing = measures.numbers(kPixelSpacing, 2);
    const Vec3 row(directions[0], directions[1], directions[2]);
    const Vec3 column(directions[3], directions[4], directions[5]);
    out.planes.positions.emplace_back(position[0], position[1], position[2]);
    if (n == 0) {
      out.planes.along_row = row;
      out.planes.along_column = column;
      out.planes.row_spacing = spacing[0];
      out.planes.column_spacing = spacing[1];
      const std::uint32_t step = measures.has(kBetweenSlices) ? kBetweenSlices : kThickness;
      if (measures.has(step)) out.planes.stated_step = measures.numbers(step, 1).front();
    }
    constexpr double kSame = 1e-4;
    if (glm::length(row - out.planes.along_row) > kSame ||
        glm::length(column - out.planes.along_column) > kSame ||
        std::abs(spacing[0] - out.planes.row_spacing) > kSame * spacing[0] ||
        std::abs(spacing[1] - out.planes.column_spacing) > kSame * spacing[1]) {
      throw fail(
          out.elements, "dicom.mixed",
          "frame " + std::to_string(n + 1) + " is oriented or spaced differently from frame 1",
          "save the segmentation on one grid");
    }
  }
  const bool unit = std::abs(glm::length(out.planes.along_row) - 1.0) < 1e-3 &&
                    std::abs(glm::length(out.planes.along_column) - 1.0) < 1e-3 &&
                    std::abs(glm::dot(out.planes.along_row, out.planes.along_column)) < 1e-3;
  if (!unit || !(out.planes.row_spacing > 0.0) || !(out.planes.column_spacing > 0.0)) {
    throw fail(out.elements, "dicom.orientation",
               "its directions are not two unit vectors at right angles, or its pixel spacing is "
               "not greater than 0");
  }
}

/// Finds the segment of each frame; the same segment twice at one place is an error.
void readSegmentsOfFrames(SegmentFile& out) {
  std::map<std::pair<int, int>, std::size_t> known;
  for (std::size_t n = 0; n < out.frames(); ++n) {
    int number = 0;
    if (out.kind != SegmentKind::kLabelMap) {
      const DicomItem* const group = groupOf(out, n, kSegmentOfFrame);
      number = group == nullptr ? 0 : group->shortAt(kReferredNumber).value_or(0);
      if (!out.table.names.contains(number)) {
        throw fail(out.elements, "dicom.segments",
                   "frame " + std::to_string(n + 1) + " belongs to segment " +
                       std::to_string(number) + ", which the file does not describe",
                   "save the segmentation again");
      }
      out.segment_of.push_back(number);
    }
    const auto [at, is_new] = known.emplace(std::pair(number, out.grid.index[n]), n);
    if (is_new) continue;
    throw fail(out.elements, "dicom.duplicate",
               "frames " + std::to_string(at->second + 1) + " and " + std::to_string(n + 1) +
                   " show the same segment at the same place",
               "save the segmentation again");
  }
}

SegmentFile readHeader(const std::string& path) {
  SegmentFile out;
  out.elements = readDicomElements(path, DicomDepth::kSequencesToo);
  readKind(out);
  readTable(out);
  out.rows = requireShort(out.elements, kRows, "the number of rows", 2);
  out.columns = requireShort(out.elements, kColumns, "the number of columns", 2);
  if (!out.elements.has_pixels) {
    throw fail(out.elements, "dicom.truncated", "the file has no pixel data",
               "fetch or write the file again");
  }
  readPlanes(out);
  out.grid = planeGrid(out.planes, kMargin, path, out.notes);
  out.place = placeOf(out.planes, out.grid, path);
  readSegmentsOfFrames(out);
  const int allocated = out.elements.shortAt(kBitsAllocated).value_or(0);
  const auto bits = static_cast<std::uint64_t>(out.pixelsOfFrame()) * out.frames() *
                    static_cast<std::uint64_t>(allocated);
  const std::uint64_t wanted = (bits + 7) / 8;
  // One byte of padding may fill up to an even length.
  const bool fits = out.elements.packed ||
                    (out.elements.pixel_bytes >= wanted && out.elements.pixel_bytes <= wanted + 1);
  if (!fits) {
    throw fail(out.elements, out.elements.pixel_bytes < wanted ? "dicom.truncated" : "dicom.pixels",
               "the file holds " + std::to_string(out.elements.pixel_bytes) +
                   " bytes of pixels, and its header asks for " + std::to_string(wanted),
               "fetch or write the file again");
  }
  return out;
}

/// Reads the values of frames, one frame after another.
class FrameReader {
 public:
  explicit FrameReader(const SegmentFile& file) : file_(file) {
    if (!file.elements.packed) {
      stream_.open(file.elements.path, std::ios::binary);
      return;
    }
    // The table of offsets, then one fragment for each frame.
    if (file.elements.pixels.size() != file.frames() + 1) {
      throw fail(file.elements, "dicom.pixels",
                 std::to_string(file.frames()) + " frames lie in " +
                     std::to_string(file.elements.pixels.size()) + " fragments",
                 "save it uncompressed (gdcmconv --raw)");
    }
    std::vector<DicomElements> frames;
    for (std::size_t n = 0; n < file.frames(); ++n) {
      DicomElements one;
      static_cast<DicomItem&>(one).path = file.elements.path;
      one.big_endian = file.elements.big_endian;
      one.transfer_syntax = file.elements.transfer_syntax;
      one.packed = true;
      for (const std::uint32_t tag :
           {kRows, kColumns, kBitsAllocated, kBitsStored, kPixelRepresentation}) {
        const auto at = file.elements.texts.find(tag);
        if (at != file.elements.texts.end()) one.texts.insert(*at);
      }
      one.pixels = {{}, file.elements.pixels[n + 1]};
      frames.push_back(std::move(one));
    }
    unpacked_ = readDicomPixels(frames);
  }

  /// The values of frame `n`: 0 or 1 for binary segments, otherwise the stored values.
  const std::vector<std::int32_t>& frame(std::size_t n) {
    if (file_.elements.packed) return unpacked_[n];
    const auto bits =
        static_cast<std::uint64_t>(file_.elements.shortAt(kBitsAllocated).value_or(1));
    const std::uint64_t count = file_.pixelsOfFrame();
    // Frames of binary segments are packed bit by bit, and need not begin at a byte.
    const std::uint64_t first_bit = count * n * bits;
    const std::uint64_t first = first_bit / 8;
    const std::uint64_t end = (first_bit + count * bits + 7) / 8;
    std::string raw(end - first, '\0');
    stream_.seekg(static_cast<std::streamoff>(file_.elements.pixels.front().begin + first));
    stream_.read(raw.data(), static_cast<std::streamsize>(raw.size()));
    if (!stream_) {
      throw fail(file_.elements, "dicom.truncated", "the file became shorter while it was read",
                 "fetch or write the file again");
    }
    values_.resize(count);
    const auto byte = [&](std::uint64_t at) {
      return static_cast<std::uint32_t>(static_cast<unsigned char>(raw[at]));
    };
    for (std::uint64_t i = 0; i < count; ++i) {
      std::uint32_t value = 0;
      if (bits == 1) {
        const std::uint64_t bit = first_bit % 8 + i;
        value = (byte(bit / 8) >> (bit % 8)) & 1U;
      } else if (bits == 8) {
        value = byte(i);
      } else {
        value = file_.elements.big_endian ? (byte(2 * i) << 8U) | byte(2 * i + 1)
                                          : byte(2 * i) | (byte(2 * i + 1) << 8U);
      }
      values_[i] = static_cast<std::int32_t>(value);
    }
    return values_;
  }

 private:
  const SegmentFile& file_;
  std::ifstream stream_;
  std::vector<std::int32_t> values_;
  std::vector<std::vector<std::int32_t>> unpacked_;
};

/// The voxels of each segment, sorted by place.
std::vector<Structure> readStructures(const SegmentFile& file) {
  std::map<int, Structure> by_number;
  for (const auto& [number, name] : file.table.names) by_number[number] = {name, number, {}, 0};
  std::vector<std::size_t> order(file.frames());
  for (std::size_t n = 0; n < order.size(); ++n) order[n] = n;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return file.grid.index[a] < file.grid.index[b];
  });
  const int half =
      file.kind == SegmentKind::kFractional ? file.elements.shortAt(kLargest).value_or(255) : 0;
  FrameReader frames(file);
  for (const std::size_t n : order) {
    pollStop();
    const std::vector<std::int32_t>& values = frames.frame(n);
    const std::uint64_t begin =
        static_cast<std::uint64_t>(file.grid.index[n]) * file.pixelsOfFrame();
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] == 0 || 2 * values[i] < half) continue;
      int number = values[i];
      if (file.kind != SegmentKind::kLabelMap) number = file.segment_of[n];
      const auto of = by_number.find(number);
      if (of == by_number.end()) {
        const auto columns = static_cast<std::size_t>(file.columns);
        throw fail(file.elements, "dicom.segments",
                   "the pixel in row " + std::to_string(i / columns) + ", column " +
                       std::to_string(i % columns) + " of frame " + std::to_string(n + 1) +
                       " belongs to segment " + std::to_string(number) +
                       ", which the file does not describe",
                   "save the segmentation again");
      }
      of->second.add(begin + i, begin + i + 1);
    }
  }
  std::vector<Structure> out;
  for (auto& [number, structure] : by_number) out.push_back(std::move(structure));
  return out;
}

}  // namespace

bool isDicomSegmentation(const DicomElements& file) {
  const std::string kind =
      file.has(kStorageClass) ? file.text(kStorageClass) : file.text(kSopClass);
  return kind == "1.2.840.10008.5.1.4.1.1.66.4" || kind == "1.2.840.10008.5.1.4.1.1.66.7";
}

Image readDicomSegmentation(const std::string& path, const ImageOptions& options) {
  const SegmentFile file = readHeader(path);
  Image image = emptyImage(path, file.size(), file.place, file.notes);
  image.labels = file.table;
  image.values = mergeStructures(readStructures(file), "segments", options.priority, image);
  return image;
}

ImageInfo readDicomSegmentationInfo(const std::string& path) {
  const SegmentFile file = readHeader(path);
  ImageInfo info = infoOf(file.size(), file.place, file.notes);
  info.data_type = file.kind == SegmentKind::kBinary                        ? "bit"
                   : file.elements.shortAt(kBitsAllocated).value_or(8) == 8 ? "uint8"
                                                                            : "uint16";
  info.format = "DICOM segmentation";
  info.labels = file.table;
  info.is_labels = true;
  return info;
}

LabelCodes readDicomSegmentationCodes(const std::string& path) { return readHeader(path).codes; }

}  // namespace palpate::vdb
