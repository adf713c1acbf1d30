#pragma once
// Compares an image that was read with the same file as read by another library.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "palpate/vdb/image.h"
#include "vdb/python_oracle.h"

namespace palpate::vdb::test {

/// [mm] Numbers in files are decimal or single precision, and both sides compute in double: far
/// below this.
inline constexpr double kSamePlace = 1e-5;

inline std::map<double, std::size_t> histogramOf(const Image& image) {
  std::map<double, std::size_t> counts;
  for (const float value : image.values) ++counts[static_cast<double>(value)];
  return counts;
}

/// The largest distance [mm] of an image's corner from its place by the 3 x 4 numbers.
template <typename Twelve>
double farthestOff(const Image& image, const Twelve& affine) {
  double worst = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index(0.0);
    for (int a = 0; a < 3; ++a) {
      index[a] = (corner >> a & 1) * (image.size[static_cast<std::size_t>(a)] - 1);
    }
    const Vec3 ours = image.toWorld(index) * 1e3;
    for (std::size_t row = 0; row < 3; ++row) {
      const double theirs = affine[4 * row] * index.x + affine[4 * row + 1] * index.y +
                            affine[4 * row + 2] * index.z + affine[4 * row + 3];
      worst = std::max(worst, std::abs(ours[static_cast<int>(row)] - theirs));
    }
  }
  return worst;
}

/// Compares places and values of NIfTI files with nibabel's.
inline void expectAsNibabelHas(const std::vector<std::string>& files,
                               const ImageOptions& options = {}) {
  const auto affines = askPython("affine", files);
  const auto histograms = askPython("histogram", files);
  for (std::size_t n = 0; n < files.size(); ++n) {
    SCOPED_TRACE(files[n]);
    const Image image = readImage(files[n], options);
    EXPECT_LT(farthestOff(image, affines.at(n)), kSamePlace);
    std::map<double, std::size_t> expected;
    for (std::size_t i = 0; i + 1 < histograms.at(n).size(); i += 2) {
      expected[histograms[n][i]] = static_cast<std::size_t>(histograms[n][i + 1]);
    }
    EXPECT_EQ(histogramOf(image), expected);
  }
}

}  // namespace palpate::vdb::test
