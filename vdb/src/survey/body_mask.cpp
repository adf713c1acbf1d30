#include <algorithm>
#include <cmath>
#include <limits>

#include "palpate/core/error.h"
#include "palpate/vdb/label_survey.h"
#include "survey/label_runs.h"

namespace palpate::vdb {
namespace {

/// [voxels] Tolerance within which two places count as the same.
constexpr double kSamePlace = 1e-3;

bool haveSameVoxels(const Image& a, const Image& b) {
  if (a.size != b.size) return false;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index;
    for (int axis = 0; axis < 3; ++axis) {
      index[axis] = ((corner >> axis) & 1) != 0 ? a.size[static_cast<std::size_t>(axis)] - 1 : 0.0;
    }
    if (glm::length(b.toIndex(a.toWorld(index)) - index) > kSamePlace) return false;
  }
  return true;
}

/// `mask`, which belongs to `from`, sampled at the voxels of `to`.
VoxelMask resampled(const VoxelMask& mask, const Image& from, const Image& to) {
  VoxelMask result(to.values.size(), 0);
  const Mat3 to_index = glm::inverse(from.axes) * to.axes;
  const Vec3 first = from.toIndex(to.origin);
  std::size_t n = 0;
  for (int k = 0; k < to.size[2]; ++k) {
    for (int j = 0; j < to.size[1]; ++j) {
      for (int i = 0; i < to.size[0]; ++i, ++n) {
        const Vec3 index = glm::round(first + to_index * Vec3(i, j, k));
        bool is_in = true;
        for (int axis = 0; axis < 3; ++axis) {
          is_in = is_in && index[axis] >= 0.0 &&
                  index[axis] < from.size[static_cast<std::size_t>(axis)];
        }
        if (!is_in) continue;
        const auto at =
            static_cast<std::size_t>(index.x) +
            static_cast<std::size_t>(from.size[0]) *
                (static_cast<std::size_t>(index.y) +
                 static_cast<std::size_t>(from.size[1]) * static_cast<std::size_t>(index.z));
        result[n] = mask[at];
      }
    }
  }
  return result;
}

}  // namespace

VoxelMask bodyMask(const Image& image, double above, const Image& grid, const Progress& progress) {
  report(progress, "body", 0.0);
  VoxelMask mask(image.values.size(), 0);
  const auto nx = static_cast<std::size_t>(image.size[0]);
  const auto row_at = [&](int j, int k) {
    return nx * (static_cast<std::size_t>(j) +
                 static_cast<std::size_t>(image.size[1]) * static_cast<std::size_t>(k));
  };
  const auto find_pieces = [&](auto&& is_in) {
    LabelRuns runs(image.size, [&](int j, int k, LabelRuns::Number* row) {
      const std::size_t at = row_at(j, k);
      for (std::size_t i = 0; i < nx; ++i) row[i] = is_in(at + i) ? 1 : 0;
    });
    runs.findPieces([](LabelRuns::Number number) { return number == 0; });
    return runs;
  };

  {
    const LabelRuns bright =
        find_pieces([&](std::size_t n) { return static_cast<double>(image.values[n]) > above; });
    const auto& pieces = bright.pieces();
    std::size_t largest = pieces.size();
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      if (pieces[p].number == 0) continue;
      if (largest == pieces.size() || pieces[p].voxels > pieces[largest].voxels) largest = p;
    }
    if (largest == pieces.size()) {
      float most = -std::numeric_limits<float>::infinity();
      for (const float value : image.values) most = std::fmax(most, value);
      throw inputError("scan.empty",
                       "nothing in the image is brighter than " + std::to_string(above) +
                           "; its largest value is " + std::to_string(most),
                       "choose a lower threshold", image.source);
    }
    bright.forEachRun([&](std::size_t piece, std::size_t first, std::size_t voxels) {
      if (piece == largest)
        std::fill_n(mask.begin() + static_cast<std::ptrdiff_t>(first), voxels, 1);
    });
  }
  report(progress, "body", 0.5);
  const LabelRuns kept = find_pieces([&](std::size_t n) { return mask[n] != 0; });
  kept.forEachRun([&](std::size_t piece, std::size_t first, std::size_t voxels) {
    const LabelRuns::Piece& of = kept.pieces()[piece];
    if (of.number == 0 && !of.at_border) {
      std::fill_n(mask.begin() + static_cast<std::ptrdiff_t>(first), voxels, 1);
    }
  });
  report(progress, "body", 1.0);
  return haveSameVoxels(image, grid) ? mask : resampled(mask, image, grid);
}

VoxelMask labelMask(const Image& image, const Image& grid) {
  VoxelMask mask(image.values.size());
  std::transform(image.values.begin(), image.values.end(), mask.begin(),
                 [](float value) { return value != 0.0F ? std::uint8_t{1} : std::uint8_t{0}; });
  return haveSameVoxels(image, grid) ? mask : resampled(mask, image, grid);
}

}  // namespace palpate::vdb
