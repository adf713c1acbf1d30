#pragma once
/// Finds the files of a folder that make one volume, and the volume's place.

#include <array>
#include <string>
#include <vector>

#include "image/dicom_elements.h"
#include "image/place.h"

namespace palpate::vdb {

struct DicomSeries {
  std::vector<DicomElements> slices;  ///< along k
  std::array<int, 3> size{};
  Place place;  ///< [m], RAS
  std::vector<std::string> notes;
};

/// The series of `path`: for a folder its only series, or the one with UID `wanted`; for a file the
/// series that it belongs to.
/// @throws Error (kInput, codes "dicom.*").
[[nodiscard]] DicomSeries findDicomSeries(const std::string& path, const std::string& wanted);

}  // namespace palpate::vdb
