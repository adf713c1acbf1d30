#pragma once
/// DICOM slices of any kind, good and bad, for tests. Written by hand from the standard's layout.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "support/temp_file.h"

namespace palpate::vdb::test {

struct DicomFile {
  int rows = 4;
  int columns = 6;
  std::vector<int> pixels = {};  ///< empty: 0, 1, 2, ...
  int bits_stored = 16;
  bool is_signed = true;
  std::string position = "0\\0\\0";
  std::string orientation = "1\\0\\0\\0\\1\\0";
  std::string spacing = "2\\0.5";  ///< from row to row, from column to column
  std::string series = "1.2.3";
  std::string slope = "1";
  std::string intercept = "-1000";
  std::string tilt = {};
  std::string photometric = "MONOCHROME2";
  std::string frames = {};
  int pixel_bytes_off = 0;  ///< error added to the length of the pixel data
  std::string storage_class = "1.2.840.10008.5.1.4.1.1.2";  ///< CT
  bool with_pixels = true;
  bool is_implicit = false;
  bool with_sequence = false;  ///< a nested sequence before all relevant elements
};

[[nodiscard]] std::string bytesOf(const DicomFile& file);

/// Writes `count` slices, `step` apart (x\y\z), each modified by `change`, to a separate folder
/// below `folder`.
template <typename Change>
std::string writeSeries(const palpate::testing::TempFolder& folder, const std::string& name,
                        int count, const std::array<double, 3>& step, const Change& change) {
  std::filesystem::create_directory(folder.path(name));
  for (int k = 0; k < count; ++k) {
    DicomFile file;
    file.position.clear();
    for (const double s : step) {
      char number[32];
      std::snprintf(number, sizeof number, "%.10g", 10.0 + k * s);
      file.position += (file.position.empty() ? "" : "\\") + std::string(number);
    }
    change(file, k);
    // Names are in the opposite order to places.
    (void)folder.file(name + "/" + std::to_string(90 - k) + ".dcm", bytesOf(file));
  }
  return folder.path(name);
}

}  // namespace palpate::vdb::test
