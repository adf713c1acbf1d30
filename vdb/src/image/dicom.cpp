#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "image/dicom_contours.h"
#include "image/dicom_pixels.h"
#include "image/dicom_segments.h"
#include "image/dicom_series.h"
#include "image/image_parts.h"
#include "image/readers.h"
#include "palpate/core/error.h"
#include "palpate/core/text.h"
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
  if (kind != DicomKind::kSlices && options.resample) {
    throw inputError("image.option", "resampling applies to DICOM series", "leave it out", path);
  }
  if (kind != DicomKind::kSlices || options.priority.empty()) return;
  throw inputError("image.option",
                   "a priority applies to structures that were segmented one by one",
                   "leave it out", path);
}

/// Puts the values of `series`, which are those of its slices, on the voxels that `image` has.
void resample(const DicomSeries& series, Image& image) {
  const DicomElements& first = series.slices.front();
  const int columns = first.shortAt(dicom::kColumns).value_or(0);
  const int rows = first.shortAt(dicom::kRows).value_or(0);
  const bool is_straight =
      std::all_of(series.places.begin(), series.places.end(), [](const SlicePlace& each) {
        return std::fabs(each.column) < 0.01 && std::fabs(each.row) < 0.01;
      });
  if (is_straight && series.places.size() > 2) {
    const auto slice_size = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    if (const auto off = linearError(series.places, slice_size, image.values)) {
      image.notes.push_back(
          "between the slices farthest apart they are off by about " + shortNumber(*off, 3) +
          " (RMS): so much the slices between others as far apart are off linear values");
    }
  }
  image.values = resampled(*series.even, series.places, columns, rows, image.values);
  if (!is_straight) {
    const auto unknown = std::count_if(image.values.begin(), image.values.end(),
                                       [](float value) { return std::isnan(value); });
    if (unknown > 0) {
      image.notes.push_back(std::to_string(unknown) +
                            " voxels beside the slices have no value (NaN): surfaces take them "
                            "as outside");
    }
  }
}

}  // namespace

Image readDicom(const std::string& path, const ImageOptions& options) try {
  const auto [kind, file] = chosenFile(path, options);
  checkKind(kind, options, path);
  if (kind == DicomKind::kSegmentation) return readDicomSegmentation(file, options);
  if (kind == DicomKind::kStructureSet) return readDicomStructureSet(file, options);
  const DicomSeries series = findDicomSeries(path, options.series, options.resample);
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
  if (series.even) resample(series, image);
  return image;
} catch (const std::bad_alloc&) {
  throw notEnoughMemory("dicom", path);
}

ImageInfo readDicomInfo(const std::string& path, const ImageOptions& options) {
  const auto [kind, file] = chosenFile(path, options);
  checkKind(kind, options, path);
  if (kind == DicomKind::kSegmentation) return readDicomSegmentationInfo(file);
  if (kind == DicomKind::kStructureSet) return readDicomStructureSetInfo(file);
  const DicomSeries series = findDicomSeries(path, options.series, options.resample);
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
