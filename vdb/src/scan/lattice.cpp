#include "scan/lattice.h"

#include <algorithm>
#include <cmath>

namespace palpate::vdb {
namespace {

constexpr float kLargest = 1e30F;  // stands for infinite intensities; differences stay finite
constexpr float kSmallest = 1e-30F;

/// Copies the nearest box value into the frame, positive.
void mirrorIntoFrame(const Mask& mask, std::vector<float>& values) {
  const auto copy = [&](std::ptrdiff_t to, std::ptrdiff_t from) {
    values[static_cast<std::size_t>(to)] = std::abs(values[static_cast<std::size_t>(from)]);
  };
  const auto [nx, ny, nz] = mask.box;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      copy(mask.at(-1, j, k), mask.at(0, j, k));
      copy(mask.at(nx, j, k), mask.at(nx - 1, j, k));
    }
  }
  for (int k = 0; k < nz; ++k) {
    for (int i = -1; i <= nx; ++i) {
      copy(mask.at(i, -1, k), mask.at(i, 0, k));
      copy(mask.at(i, ny, k), mask.at(i, ny - 1, k));
    }
  }
  for (int j = -1; j <= ny; ++j) {
    for (int i = -1; i <= nx; ++i) {
      copy(mask.at(i, j, -1), mask.at(i, j, 0));
      copy(mask.at(i, j, nz), mask.at(i, j, nz - 1));
    }
  }
}

/// exp(-d^2 / (2 sigma^2)) for d = 0 .. 4, scaled to a sum of 1: beyond 3.2 sigma there is 0.1 %.
struct Kernel {
  std::array<float, 5> weight{};
  Kernel() {
    constexpr double kSigma = 1.25;  // [voxels]
    const auto bell = [](int d) { return std::exp(-0.5 * d * d / (kSigma * kSigma)); };
    double sum = bell(0);
    for (int d = 1; d < 5; ++d) sum += 2.0 * bell(d);
    for (int d = 0; d < 5; ++d)
      weight[static_cast<std::size_t>(d)] = static_cast<float>(bell(d) / sum);
  }
};

/// Blurs the rows of the box along one axis; beyond its ends the last value goes on.
void blurAlong(std::size_t axis, const Mask& mask, std::vector<float>& values) {
  static const Kernel kernel;
  const auto strides = mask.strides();
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  const int length = mask.box[axis];
  const std::ptrdiff_t step = strides[axis];
  std::vector<float> row(static_cast<std::size_t>(length) + 8);
  for (int b = 0; b < mask.box[v]; ++b) {
    for (int a = 0; a < mask.box[u]; ++a) {
      float* const line = values.data() + mask.at(0, 0, 0) + a * strides[u] + b * strides[v];
      bool constant = true;
      for (int i = 0; i < length; ++i) {
        row[static_cast<std::size_t>(i) + 4] = line[i * step];
        constant = constant && line[i * step] == line[0];
      }
      if (constant) continue;
      std::fill_n(row.begin(), 4, line[0]);
      std::fill_n(row.end() - 4, 4, line[(length - 1) * step]);
      for (int i = 0; i < length; ++i) {
        const float* const c = row.data() + i + 4;
        line[i * step] = kernel.weight[0] * c[0] + kernel.weight[1] * (c[-1] + c[1]) +
                         kernel.weight[2] * (c[-2] + c[2]) + kernel.weight[3] * (c[-3] + c[3]) +
                         kernel.weight[4] * (c[-4] + c[4]);
      }
    }
  }
}

}  // namespace

Lattice latticeOfThreshold(const Image& image, double above, const Mask& mask) {
  Lattice lattice{mask.first, mask.box, std::vector<float>(mask.inside.size())};
  for (int k = 0; k < mask.box[2]; ++k) {
    for (int j = 0; j < mask.box[1]; ++j) {
      for (int i = 0; i < mask.box[0]; ++i) {
        const auto n = static_cast<std::size_t>(mask.at(i, j, k));
        const float intensity = image.at(mask.first[0] + i, mask.first[1] + j, mask.first[2] + k);
        const auto apart = static_cast<float>(std::abs(above - static_cast<double>(intensity)));
        // NaN is background; what lies across from it then decides alone where the surface is.
        const float size = std::isnan(apart) ? kSmallest : std::clamp(apart, kSmallest, kLargest);
        lattice.values[n] = mask.inside[n] != 0 ? -size : size;
      }
    }
  }
  mirrorIntoFrame(mask, lattice.values);
  return lattice;
}

Lattice latticeOfLabels(const Mask& mask) {
  // A voxel centre that the blur puts on the wrong side goes as far to the right one, and so much
  // more: a sheet of one voxel keeps its thickness, and the steps of a voxelised slope are still
  // smoothed.
  constexpr float kHold = 0.02F;
  Lattice lattice{mask.first, mask.box, std::vector<float>(mask.inside.begin(), mask.inside.end())};
  std::vector<float>& blurred = lattice.values;
  for (std::size_t axis = 0; axis < 3; ++axis) blurAlong(axis, mask, blurred);
  std::vector<float> twice = blurred;
  for (std::size_t axis = 0; axis < 3; ++axis) blurAlong(axis, mask, twice);
  for (std::size_t n = 0; n < blurred.size(); ++n) {
    const float side = mask.inside[n] != 0 ? -1.0F : 1.0F;
    const float depth = side * (0.5F - (2.0F * blurred[n] - twice[n]));
    blurred[n] = side * (depth < kHold ? 2.0F * kHold - depth : depth);
  }
  mirrorIntoFrame(mask, lattice.values);
  return lattice;
}

}  // namespace palpate::vdb
