#pragma once
/// Where in space some voxels of an image are.

#include <algorithm>

#include "palpate/vdb/image.h"

namespace palpate::vdb {

/// [m] The box around the voxels of an image that hold(value), half a voxel and one more to each side of their
/// centres.
template <typename F>
Box3 boxWhere(const Image& image, const F& holds) {
  Box3 box;
  double step = 0.0;
  for (int axis = 0; axis < 3; ++axis) step = std::max(step, glm::length(image.axes[axis]));
  for (int k = 0; k < image.size[2]; ++k) {
    for (int j = 0; j < image.size[1]; ++j) {
      for (int i = 0; i < image.size[0]; ++i) {
        if (holds(image.at(i, j, k))) box.include(image.toWorld(Vec3(i, j, k)));
      }
    }
  }
  return box.grownBy(1.5 * step);
}

}  // namespace palpate::vdb
