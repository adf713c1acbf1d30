#pragma once
/// Compares labels at places that another reader of the same files gives.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "palpate/vdb/image.h"
#include "vdb/python_oracle.h"

namespace palpate::vdb::test {

inline constexpr const char* kStructuresOracle = "vdb/structures_oracle.py";

/// Each row of `points` is `x y z label` [mm], RAS, for a voxel's center: `image` must have a voxel
/// there, to a hundredth of its size, with this label. At least a quarter of the points must be in
/// a structure, so that an empty image does not pass.
inline void expectLabelsAt(const Image& image, const std::vector<std::vector<double>>& points,
                           std::size_t count) {
  ASSERT_EQ(points.size(), count);
  std::size_t labelled = 0;
  for (const std::vector<double>& p : points) {
    ASSERT_EQ(p.size(), 4U);
    const Vec3 index = image.toIndex(Vec3(p[0], p[1], p[2]) * 1e-3);
    int at[3];
    for (int axis = 0; axis < 3; ++axis) {
      at[axis] = static_cast<int>(std::lround(index[axis]));
      ASSERT_NEAR(index[axis], at[axis], 0.01) << p[0] << " " << p[1] << " " << p[2];
      ASSERT_GE(at[axis], 0);
      ASSERT_LT(at[axis], image.size[static_cast<std::size_t>(axis)]);
    }
    ASSERT_EQ(image.at(at[0], at[1], at[2]), p[3]) << at[0] << " " << at[1] << " " << at[2];
    labelled += p[3] > 0.0 ? 1 : 0;
  }
  EXPECT_GE(4 * labelled, count);
}

}  // namespace palpate::vdb::test
