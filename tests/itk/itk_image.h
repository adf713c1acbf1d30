#pragma once
/// What ITK makes of a scan.

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

/// NIfTI, NRRD or MetaImage by its extension, of single numbers in three dimensions. @throws
/// std::runtime_error
[[nodiscard]] ItkImage readWithItk(const std::string& path);

/// The one DICOM series in a folder, by ITK's own search for its files. @throws std::runtime_error
[[nodiscard]] ItkImage readSeriesWithItk(const std::string& folder);

}  // namespace palpate::vdb::test
