#include <algorithm>

#include "image/dicom_pixels.h"
#include "image/dicom_series.h"
#include "image/image_parts.h"
#include "image/readers.h"
#include "palpate/core/error.h"

namespace palpate::vdb {

Image readDicom(const std::string& path, const ImageOptions& options) try {
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

}  // namespace palpate::vdb
