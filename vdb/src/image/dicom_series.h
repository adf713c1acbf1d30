#pragma once
/// Finds the files of a folder that make one volume, and the volume's place.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "image/dicom_elements.h"
#include "image/even_slices.h"
#include "image/place.h"

namespace palpate::vdb {

struct DicomSeries {
  std::vector<DicomElements> slices;  ///< along the normal
  std::array<int, 3> size{};          ///< of the image, resampled or not
  Place place;                        ///< [m], RAS, of the image
  std::vector<std::string> notes;
  /// Has a value if the image is resampled from the slices: its voxels. `places` then says where
  /// each slice lies.
  std::optional<EvenSlices> even = {};
  std::vector<SlicePlace> places = {};
};

/// The series of `path`: for a folder its only series, or the one with UID `wanted`; for a file the
/// series that it belongs to. Slices that are uneven, off one line or sheared are resampled if
/// `resample` says so; the first two are refused otherwise.
/// @throws Error (kInput, codes "dicom.*").
[[nodiscard]] DicomSeries findDicomSeries(const std::string& path, const std::string& wanted,
                                          bool resample);

}  // namespace palpate::vdb
