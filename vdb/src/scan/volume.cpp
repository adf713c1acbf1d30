#include "scan/volume.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "scan/crossings.h"
#include "scan/for_blocks.h"
#include "scan/lattice_spline.h"

namespace palpate::vdb {
namespace {

constexpr int kRounds = 5;
constexpr float kMostShift = 0.3F;  ///< [steps] largest shift of all values
constexpr double kLeastRise =
    0.2;  ///< [steps] least difference between neighbors on two sides; grazing surfaces have less
constexpr double kLeastValue = 1e-6;  ///< [steps]

/// How much more volume the surface encloses than the voxels have, and how much that grows if the
/// surface moves by a step; in voxels.
struct Excess {
  double volume = 0.0;
  double slope = 0.0;
};

Excess sumOf(const std::vector<Excess>& parts) {
  return std::accumulate(parts.begin(), parts.end(), Excess{}, [](Excess a, const Excess& b) {
    return Excess{a.volume + b.volume, a.slope + b.slope};
  });
}

/// The line from an inside voxel to its outside neighbor. A shift of all values leaves it
/// unchanged.
struct Line {
  /// [steps] The difference between the spline and the straight line, where that passes zero.
  float bend = 0.0F;
  /// The square of the cosine between it and the surface's normal. The lines along the three axes
  /// through one place have 1 together. Lines that graze a flat cap may miss it, and count little.
  float weight = 0.0F;
};

class Volume {
 public:
  Volume(Band& band, const Mask& mask)
      : band_(band), mask_(mask), sums_(band.blocks.size()), lines_(band.blocks.size()) {}

  double run() {
    std::vector<BandBlock::Values> first;
    first.reserve(band_.blocks.size());
    for (const BandBlock& block : band_.blocks) first.push_back(block.value);
    findLines();
    float shift = 0.0F;
    for (int round = 0; round < kRounds; ++round) {
      const Excess excess = find();
      if (!(excess.slope > 0.0)) return 0.0;
      shift = std::clamp(shift - static_cast<float>(excess.volume / excess.slope), -kMostShift,
                         kMostShift);
      forBlocks(band_.blocks.size(), [&](std::size_t b) {
        BandBlock& block = band_.blocks[b];
        const BlockBounds& bounds = band_.bounds[b];
        for (std::size_t n = 0; n < BandBlock::kVoxels; ++n) {
          if (std::isnan(block.value[n])) continue;
          block.value[n] = std::clamp(first[b][n] - shift, bounds.lower[n], bounds.upper[n]);
        }
      });
    }
    return find().volume;
  }

 private:
  /// Sums each block first, so that the order of additions does not depend on threads.
  Excess find() {
    forBlocks(band_.blocks.size(), [&](std::size_t b) {
      Excess& sum = sums_[b];
      sum = {};
      std::size_t crossing = 0;
      forPairs(band_.blocks[b], [&](const Vec3&, const Vec3&, double inside, double outside) {
        const double rise = outside - inside;
        const Line& line = lines_[b][crossing++];
        const double share = (-inside - static_cast<double>(line.bend)) / rise;
        const auto weight = static_cast<double>(line.weight);
        sum.volume += (std::clamp(share, 0.0, 1.0) - 0.5) * weight;
        sum.slope += weight / std::max(rise, kLeastRise);
      });
    });
    return sumOf(sums_);
  }

  void findLines() {
    const LatticeSpline spline(band_, mask_, Mat3(1.0), Vec3(0.0));
    forBlocks(band_.blocks.size(), [&](std::size_t b) {
      forPairs(band_.blocks[b],
               [&](const Vec3& at, const Vec3& step, double inside, double outside) {
                 const Vec3 zero = at + step * (inside / (inside - outside));
                 const Vec3 slope = spline.slopeAt(zero);
                 const double square = glm::dot(slope, slope);
                 const double along = glm::dot(slope, step);
                 lines_[b].push_back(
                     {static_cast<float>(spline.valueAt(zero).value_or(0.0)),
                      static_cast<float>(square > 0.0 ? along * along / square : 1.0 / 3.0)});
               });
    });
  }

  /// Calls visit(voxel, step to its neighbor outside, both values) for each inside voxel of a block
  /// with an outside neighbor; not beyond the image's border.
  template <typename Visit>
  void forPairs(const BandBlock& block, const Visit& visit) const {
    forCrossings(
        band_, mask_, block,
        [&](const std::array<int, 3>& at, int axis, int side, float inside, float outside) {
          if (std::isnan(outside)) return;
          Vec3 step(0.0);
          step[axis] = side;
          visit(Vec3(at[0], at[1], at[2]), step,
                std::min(static_cast<double>(band_.closed(inside, at)), -kLeastValue),
                std::max(static_cast<double>(outside), kLeastValue));
        });
  }

  Band& band_;
  const Mask& mask_;
  std::vector<Excess> sums_;
  std::vector<std::vector<Line>> lines_;  ///< for each block, in the order of forPairs()
};

}  // namespace

float shiftToVolumeOf(const Band& band, const Mask& mask, double excess,
                      const std::function<float(float, int, int, int)>& other) {
  std::vector<Excess> sums(band.blocks.size());
  forBlocks(band.blocks.size(), [&](std::size_t b) {
    const auto share = [](double inside, double outside) {
      return std::clamp(inside / (inside - outside), 0.0, 1.0);
    };
    forCrossings(
        band, mask, band.blocks[b],
        [&](const std::array<int, 3>& at, int axis, int side, float inside, float outside) {
          if (std::isnan(outside)) return;
          std::array<int, 3> p = {band.first[0] + at[0], band.first[1] + at[1],
                                  band.first[2] + at[2]};
          const double in = other(inside, p[0], p[1], p[2]);
          p[static_cast<std::size_t>(axis)] += side;
          const double out = other(outside, p[0], p[1], p[2]);
          sums[b].volume += (share(in, out) - share(inside, outside)) / 3.0;
          sums[b].slope += 1.0 / (3.0 * std::max(out - in, kLeastRise));
        });
  });
  const Excess all = sumOf(sums);
  if (!(all.slope > 0.0)) return 0.0F;
  return std::clamp(-static_cast<float>((all.volume + excess) / all.slope), -kMostShift,
                    kMostShift);
}

double keepVolume(Band& band, const Mask& mask) { return Volume(band, mask).run(); }

}  // namespace palpate::vdb
