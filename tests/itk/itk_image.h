#pragma once
/// Reads scans with ITK.

#include <array>
#include <map>
#include <string>
#include <vector>

namespace palpate::vdb::test {

struct ItkImage {
  std::array<int, 3> size{};
  std::array<double, 12> affine{};  ///< 3 x 4, row by row, RAS, mm
  std::map<double, std::size_t> histogram;
};

/// Reads NIfTI, NRRD or MetaImage, by extension, with scalar voxels in three dimensions. @throws
/// std::runtime_error
[[nodiscard]] ItkImage readWithItk(const std::string& path);

/// Reads the only DICOM series in a folder, by ITK's own search for its files. @throws
/// std::runtime_error
[[nodiscard]] ItkImage readSeriesWithItk(const std::string& folder);

}  // namespace palpate::vdb::test
