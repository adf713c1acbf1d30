#pragma once
/// Which files of a folder make one volume, and where it lies.

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

/// The series of `path`: of a folder its only one, or the one with UID `wanted`; of a file that of
/// the file.
/// @throws Error (kInput, codes "dicom.*").
[[nodiscard]] DicomSeries findDicomSeries(const std::string& path, const std::string& wanted);

}  // namespace palpate::vdb
