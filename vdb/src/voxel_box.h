#pragma once
/// Finds the region of space that some voxels of an image occupy.

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "palpate/core/stop.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {

/// [m] The longest step from a voxel to the next along an axis.
[[nodiscard]] inline double longestStep(const Image& image) {
  double step = 0.0;
  for (int axis = 0; axis < 3; ++axis) step = std::max(step, glm::length(image.axes[axis]));
  return step;
}

/// [m] The box around the voxels of an image for which hold(value) is true, extended by a voxel and
/// a half on each side of their centers.
template <typename F>
Box3 boxWhere(const Image& image, const F& holds) {
  Box3 box;
  for (int k = 0; k < image.size[2]; ++k) {
    pollStop();
    for (int j = 0; j < image.size[1]; ++j) {
      for (int i = 0; i < image.size[0]; ++i) {
        if (holds(image.at(i, j, k))) box.include(image.toWorld(Vec3(i, j, k)));
      }
    }
  }
  return box.grownBy(1.5 * longestStep(image));
}

/// [m] For each value in an image, the box of its voxels' centers, found in one pass however many
/// labels there are.
[[nodiscard]] inline std::map<float, Box3> boxesOfValues(const Image& image) {
  std::map<float, Box3> boxes;
  float last = std::numeric_limits<float>::quiet_NaN();
  Box3* box = nullptr;  // the box of `last`
  for (int k = 0; k < image.size[2]; ++k) {
    pollStop();
    for (int j = 0; j < image.size[1]; ++j) {
      int i = 0;
      while (i < image.size[0]) {
        const float value = image.at(i, j, k);
        const int first = i;
        do ++i;
        while (i < image.size[0] && image.at(i, j, k) == value);
        if (std::isnan(value)) continue;
        if (value != last) box = &boxes[value];
        last = value;
        box->include(image.toWorld(Vec3(first, j, k)));
        box->include(image.toWorld(Vec3(i - 1, j, k)));
      }
    }
  }
  return boxes;
}

}  // namespace palpate::vdb
