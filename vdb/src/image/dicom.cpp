#include <algorithm>
#include <filesystem>
#include <utility>

#include "image/dicom_contours.h"
#include "image/dicom_pixels.h"
#include "image/dicom_segments.h"
#include "image/dicom_series.h"
#include "image/image_parts.h"
#include "image/readers.h"
#include "palpate/core/error.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

enum class DicomKind { kSlices, kSegmentation, kStructureSet };

DicomKind kindOf(const DicomElements& file) {
  if (isDicomSegmentation(file)) return DicomKind::kSegmentation;
  return isDicomStructureSet(file) ? DicomKind::kStructureSet : DicomKind::kSlices;
}

/// The kind of `path`, and the file to read: `path` itself, or the only file of a folder without
/// slices.
std::pair<DicomKind, std::string> chosenFile(const std::string& path, const ImageOptions& options) {
  std::error_code failure;
  if (std::filesystem::is_regular_file(path, failure)) {
    return {kindOf(readDicomElements(path)), path};
  }
  if (!options.series.empty()) return {DicomKind::kSlices, path};
  std::vector<std::pair<DicomKind, std::string>> found;
  for (const auto& entry : std::filesystem::directory_iterator(path, failure)) {
    const std::string file = entry.path().string();
    if (!entry.is_regular_file(failure) || !isDicomFile(file)) continue;
    const DicomElements elements = readDicomElements(file);
    const DicomKind kind = kindOf(elements);
    if (kind != DicomKind::kSlices) {
      found.emplace_back(kind, file);
    } else if (elements.has_pixels) {
      return {DicomKind::kSlices, path};
    }
  }
  if (found.empty()) return {DicomKind::kSlices, path};
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.second < b.second; });
  if (found.size() > 1) {
    throw inputError(
        "dicom.several",
        "the folder holds several segmentations or structure sets: " + fileName(found[0].second) +
            ", " + fileName(found[1].second) + (found.size() > 2 ? ", ..." : ""),
        "name one of them", path);
  }
  return found.front();
}

void checkKind(DicomKind kind, const ImageOptions& options, const std::string& path) {
  if (kind != DicomKind::kSlices || options.priority.empty()) return;
  throw inputError("image.option",
                   "a priority applies to structures that were segmented one by one",
                   "leave it out", path);
}

}  // namespace

Image readDicom(const std::string& path, const ImageOptions& options) try {
  const auto [kind, file] = chosenFile(path, options);
  checkKind(kind, options, path);
  if (kind == DicomKind::kSegmentation) return readDicomSegmentation(file, options);
  if (kind == DicomKind::kStructureSet) return readDicomStructureSet(file, options);
  const DicomSeries series = findDicomSeries(path, options.series);
  Image image = emptyImage(path, series.size, series.place, series.notes);
  const std::vector<std::vector<std::int32_t>> pixels = readDicomPixels(series.slices);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const DicomElements& slice = series.slices[i];
    const auto number = [&](std::uint32_t tag, double otherwise) {
      return slice.text(tag).empty() ? otherwise : slice.numbers(tag, 1).front();
    };
    const double slope = number(dicom::kSlope, 1.0);
    const double intercept = number(dicom::kIntercept, 0.0);
    if (slope == 0.0) {
      throw inputError("dicom.value", "RescaleSlope is 0, which would make all voxels the same", {},
                       slice.path);
    }
    for (const std::int32_t stored : pixels[i]) {
      image.values.push_back(static_cast<float>(stored * slope + intercept));
    }
  }
  return image;
} catch (const std::bad_alloc&) {
  throw notEnoughMemory("dicom", path);
}

ImageInfo readDicomInfo(const std::string& path, const ImageOptions& options) {
  const auto [kind, file] = chosenFile(path, options);
  checkKind(kind, options, path);
  if (kind == DicomKind::kSegmentation) return readDicomSegmentationInfo(file);
  if (kind == DicomKind::kStructureSet) return readDicomStructureSetInfo(file);
  const DicomSeries series = findDicomSeries(path, options.series);
  const DicomElements& first = series.slices.front();
  ImageInfo info = infoOf(series.size, series.place, series.notes);
  info.data_type = (first.shortAt(dicom::kPixelRepresentation).value_or(0) == 1 ? "int" : "uint") +
                   std::to_string(first.shortAt(dicom::kBitsAllocated).value_or(16));
  info.format = "DICOM series";
  if (const std::string modality = first.text(dicom::kModality); !modality.empty()) {
    info.format += ", " + modality;
  }
  return info;
}

LabelCodes readDicomCodes(const std::string& path, const ImageOptions& options) {
  const auto [kind, file] = chosenFile(path, options);
  if (kind == DicomKind::kSegmentation) return readDicomSegmentationCodes(file);
  if (kind == DicomKind::kStructureSet) return readDicomStructureSetCodes(file);
  return {};
}

}  // namespace palpate::vdb
