#include "scan/smooth_mask.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include "scan/for_blocks.h"
#include "scan/lattice_spline.h"
#include "scan/relax.h"

namespace palpate::vdb {
namespace {

using Values = BandBlock::Values;

// More steps smooth more; after these a ball, a ring and a tilted plane all have normals within half a degree,
// and longer waves than a scan's voxels tell of are left alone.
constexpr int kFirstSteps = 80;
constexpr int kSecondSteps = 140;
constexpr double kMostStretch = 4.0;
/// The largest eigenvalue of the energy's matrix is 144/42 of its diagonal.
constexpr float kStep = 1.0F / 3.5F;
/// Steps of diffusion: the first ones also mix odd and even voxels. Together a Gaussian of 5.7 voxels.
constexpr int kDiffuseNear = 4;
constexpr int kDiffuseFar = 26;
constexpr double kDiffuseShare = 0.15;
/// A bend sharper than this is a crease, not a curvature: a ball of two voxels has 0.1.
constexpr float kLargestForce = 0.1F;
/// A distance that leads further away from what was is another place's.
constexpr double kSamePlace = 0.75;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

constexpr double kBySurface = 1.2;
constexpr std::uint8_t kUnknown = 255;

/// What a block has while it is worked on.
struct Work {
  alignas(32) Values ahead;  ///< where the gradient is taken: the value and its momentum
  alignas(32) Values next;
  alignas(32) Values step;     ///< by which the force moves each voxel
  alignas(32) Values force;    ///< that is taken out
  std::array<Values, 3> foot;  ///< from a voxel to its closest point of the surface
  std::array<std::uint8_t, BandBlock::kVoxels> round;  ///< in which that was found, or kUnknown
};

class Smoothing {
 public:
  Smoothing(Band& band, const Mask& mask, const Mat3& axes, const Progress& progress)
      : band_(band),
        mask_(mask),
        axes_(axes),
        spacing_(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])),
        progress_(progress),
        work_(band.blocks.size()) {
    for (int a = 0; a < 3; ++a) {
      const double u = spacing_[(a + 1) % 3];
      const double v = spacing_[(a + 2) % 3];
      weights_.axis[a] = static_cast<float>(1.0 / std::pow(spacing_[a], 4));
      weights_.plane[a] = static_cast<float>(2.0 / (u * u * v * v));  // two of the nine derivatives
    }
  }

  void run() {
    forBlocks(band_.blocks.size(), [&](std::size_t b) {
      work_[b].ahead = band_.blocks[b].value;
      work_[b].next = band_.blocks[b].value;
      work_[b].force.fill(0.0F);
      findSteps(b);
    });
    // Thick slices make long steps in voxels; what smooths them travels as far as the steps are many.
    const double longest = std::max({spacing_.x, spacing_.y, spacing_.z});
    const double more = std::min(longest, kMostStretch);
    relax(static_cast<int>(more * kFirstSteps), 0.0, 0.4);
    makeDistances();
    takeOutForces();
    relax(static_cast<int>(more * kSecondSteps), 0.5, 1.0);
  }

 private:
  /// Block b and what the stencils reach of its neighbors; `of` tells a block's values.
  template <typename Of>
  void gather(std::size_t b, const Of& of, Patch& patch) const noexcept {
    const auto& near = band_.blocks[b].near;
    const auto source = [&](int dx, int dy, int dz) -> const float* {
      const int place = 9 * dx + 3 * dy + dz + 13;
      const std::int32_t n = near[static_cast<std::size_t>(place)];
      return n < 0 ? nullptr : of(static_cast<std::size_t>(n)).data();
    };
    const auto side = [](int x) { return x < 0 ? -1 : x > 7 ? 1 : 0; };
    const auto copy = [&](const float* from, int x, int y, int z, int count) {
      float* const to = patch.values + Patch::at(x, y, z);
      if (from == nullptr) {
        std::fill_n(to, count, kNone);
      } else {
        std::memcpy(to, from + Band::placeOf(x, y, z),
                    static_cast<std::size_t>(count) * sizeof(float));
      }
    };
    for (int x = -Patch::kHalo; x < 8 + Patch::kHalo; ++x) {
      const int dx = side(x);
      const bool far_x = x < -1 || x > 8;
      for (int y = -Patch::kHalo; y < 8 + Patch::kHalo; ++y) {
        const int dy = side(y);
        const bool far = far_x || y < -1 || y > 8;
        if (far && dx != 0 && dy != 0) continue;
        copy(source(dx, dy, 0), x, y, 0, 8);
        if (dx != 0 && dy != 0) continue;
        if (far) continue;
        copy(source(dx, dy, -1), x, y, -2, 2);
        copy(source(dx, dy, 1), x, y, 8, 2);
      }
    }
  }

  /// 1 / (3.5 x the diagonal): how many of the energy's squares hold each voxel.
  void findSteps(std::size_t b) noexcept {
    Patch patch;
    gather(
        b, [&](std::size_t n) -> const Values& { return band_.blocks[n].value; }, patch);
    Values& step = work_[b].step;
    step.fill(0.0F);
    for (int n = 0; n < 512; ++n) {
      const int at = Patch::at(n >> 6, n >> 3 & 7, n & 7);
      if (std::isnan(patch.values[at])) continue;
      const float diagonal = diagonalAt(patch.values + at);
      step[static_cast<std::size_t>(n)] = diagonal > 0.0F ? kStep / diagonal : 0.0F;
    }
  }

  static constexpr std::ptrdiff_t kStride[3] = {std::ptrdiff_t{Patch::kSide} * Patch::kRow,
                                                Patch::kRow, 1};

  [[nodiscard]] float diagonalAt(const float* c) const noexcept {
    const auto in = [&](std::ptrdiff_t s) { return !std::isnan(c[s]); };
    float sum = 0.0F;
    for (int a = 0; a < 3; ++a) {
      const std::ptrdiff_t s = kStride[a];
      const std::ptrdiff_t u = kStride[(a + 1) % 3];
      const std::ptrdiff_t v = kStride[(a + 2) % 3];
      float squares = 0.0F;
      if (in(-s) && in(s)) squares += 4.0F;
      if (in(s) && in(2 * s)) squares += 1.0F;
      if (in(-s) && in(-2 * s)) squares += 1.0F;
      sum += weights_.axis[a] * squares;
      float corners = 0.0F;
      for (const std::ptrdiff_t du : {-u, u}) {
        for (const std::ptrdiff_t dv : {-v, v}) {
          if (in(du) && in(dv) && in(du + dv)) corners += 1.0F;
        }
      }
      sum += weights_.plane[a] * corners;
    }
    return sum;
  }

  /// Whether all of the energy's squares around a voxel are there.
  [[nodiscard]] static bool isWhole(const float* c) noexcept {
    bool whole = true;
    for (int a = 0; a < 3; ++a) {
      const std::ptrdiff_t s = kStride[a];
      const std::ptrdiff_t u = kStride[(a + 1) % 3];
      for (const std::ptrdiff_t d : {-2 * s, -s, s, 2 * s, -s - u, -s + u, s - u, s + u}) {
        whole = whole && !std::isnan(c[d]);
      }
    }
    return whole;
  }

  /// Projected gradient steps with momentum (A. Beck and M. Teboulle, 2009).
  void relax(int steps, double from, double to) {
    double t = 1.0;
    for (int step = 0; step < steps; ++step) {
      if (step % 10 == 0) report(progress_, "smooth the labels", from + (to - from) * step / steps);
      const double t_next = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * t * t));
      const auto momentum = static_cast<float>((t - 1.0) / t_next);
      t = t_next;
      // The two take turns.
      Values Work::*const from_here = step % 2 == 0 ? &Work::ahead : &Work::next;
      Values Work::*const to_there = step % 2 == 0 ? &Work::next : &Work::ahead;
      forBlocks(band_.blocks.size(), [&](std::size_t b) {
        Patch patch;
        gather(
            b, [&](std::size_t n) -> const Values& { return work_[n].*from_here; }, patch);
        BandBlock& block = band_.blocks[b];
        const BandBounds& bounds = band_.bounds[b];
        Work& work = work_[b];
        kernels_.relax(
            patch, block.rows, weights_,
            {work.force.data(), work.step.data(), bounds.lower.data(), bounds.upper.data(),
             block.value.data(), (work.*to_there).data(), momentum});
      });
    }
    forBlocks(band_.blocks.size(), [&](std::size_t b) { work_[b].ahead = band_.blocks[b].value; });
  }

  /// Each voxel its distance to the surface that the values have now, within its bounds. Those by the surface
  /// find its closest point along their slope, the others from those of their neighbors, layer by layer.
  void makeDistances() {
    report(progress_, "smooth the labels", 0.4);
    const LatticeSpline spline(band_, mask_, axes_, Vec3(0.0));
    const Mat3 back = glm::transpose(glm::inverse(axes_));
    forBlocks(band_.blocks.size(), [&](std::size_t b) {
      work_[b].round.fill(kUnknown);
      work_[b].next = band_.blocks[b].value;
    });
    for (int round = 0; round <= Band::kReach + 1; ++round) {
      forBlocks(band_.blocks.size(), [&](std::size_t b) {
        Patch patch;
        if (round == 0) {
          gather(
              b, [&](std::size_t n) -> const Values& { return band_.blocks[n].value; }, patch);
        }
        const BandBlock& block = band_.blocks[b];
        for (int n = 0; n < 512; ++n) {
          const auto place = static_cast<std::size_t>(n);
          const auto value = static_cast<double>(block.value[place]);
          if (std::isnan(value) || work_[b].round[place] != kUnknown) continue;
          const Vec3 p = positionOf(block, n);
          Vec3 start(0.0);
          if (round == 0) {
            if (!(std::abs(value) < kBySurface)) continue;
            const Vec3 slope = back * slopeAt(patch.values + Patch::at(n >> 6, n >> 3 & 7, n & 7));
            const double square = glm::dot(slope, slope);
            if (!(square > 0.0)) continue;
            start = p - slope * (value / square);
          } else if (!nearestFoot(block, n, round, p, start)) {
            continue;
          }
          takeFoot(b, place, round, spline.foot(p, start), p);
        }
      });
    }
    forBlocks(band_.blocks.size(), [&](std::size_t b) {
      band_.blocks[b].value = work_[b].next;
      work_[b].ahead = work_[b].next;
    });
  }

  [[nodiscard]] Vec3 positionOf(const BandBlock& block, int n) const noexcept {
    return axes_ *
           Vec3(block.first[0] + (n >> 6), block.first[1] + (n >> 3 & 7), block.first[2] + (n & 7));
  }

  void takeFoot(std::size_t b, std::size_t place, int round,
                const std::optional<LatticeSpline::Foot>& foot, const Vec3& p) noexcept {
    if (!foot) return;
    Work& work = work_[b];
    const float value = band_.blocks[b].value[place];
    if (std::abs(std::abs(foot->distance) - static_cast<double>(std::fabs(value))) >
        kSamePlace * std::max(1.0, 0.5 * std::abs(foot->distance))) {
      return;
    }
    const Vec3 offset = foot->point - p;
    for (int a = 0; a < 3; ++a) {
      work.foot[static_cast<std::size_t>(a)][place] = static_cast<float>(offset[a]);
    }
    std::atomic_ref<std::uint8_t>(work.round[place])
        .store(static_cast<std::uint8_t>(round), std::memory_order_relaxed);
    const BandBounds& bounds = band_.bounds[b];
    work.next[place] = std::clamp(std::copysign(static_cast<float>(foot->distance), value),
                                  bounds.lower[place], bounds.upper[place]);
  }

  /// The nearest of the closest points that neighbors found in rounds before.
  [[nodiscard]] bool nearestFoot(const BandBlock& block, int n, int round, const Vec3& p,
                                 Vec3& nearest) noexcept {
    double best = kInfinity;
    for (int step = 0; step < 27; ++step) {
      const int i = (n >> 6) + step / 9 - 1;
      const int j = (n >> 3 & 7) + step / 3 % 3 - 1;
      const int k = (n & 7) + step % 3 - 1;
      const auto side = [](int x) -> std::size_t { return x < 0 ? 0 : x > 7 ? 2 : 1; };
      const std::int32_t b = block.near[9 * side(i) + 3 * side(j) + side(k)];
      if (b < 0) continue;
      Work& work = work_[static_cast<std::size_t>(b)];
      const std::size_t place = Band::placeOf(i, j, k);
      // Others may be writing this round's number there; kUnknown is the largest.
      const std::atomic_ref<std::uint8_t> found(work.round[place]);
      if (found.load(std::memory_order_relaxed) >= round) continue;
      const Vec3 offset(work.foot[0][place], work.foot[1][place], work.foot[2][place]);
      const Vec3 foot =
          positionOf(band_.blocks[static_cast<std::size_t>(b)], static_cast<int>(place)) + offset;
      const Vec3 apart = foot - p;
      const double square = glm::dot(apart, apart);
      if (square < best) {
        best = square;
        nearest = foot;
      }
    }
    return best < kInfinity;
  }

  /// By the voxels around, one-sided at the band's edge.
  [[nodiscard]] static Vec3 slopeAt(const float* c) noexcept {
    Vec3 slope(0.0);
    for (int a = 0; a < 3; ++a) {
      const float before = c[-kStride[a]];
      const float after = c[kStride[a]];
      const float ahead = std::isnan(after) ? 0.0F : after - c[0];
      const float behind = std::isnan(before) ? 0.0F : c[0] - before;
      const bool both = !std::isnan(after) && !std::isnan(before);
      slope[a] = static_cast<double>(ahead + behind) * (both ? 0.5 : 1.0);
    }
    return slope;
  }

  /// The force on the distances as they are: at the band's edge whole, elsewhere what is left of it when it
  /// has spread along the surface.
  void takeOutForces() {
    forBlocks(band_.blocks.size(), [&](std::size_t b) {
      Patch patch;
      gather(
          b, [&](std::size_t n) -> const Values& { return work_[n].ahead; }, patch);
      BandBlock& block = band_.blocks[b];
      Work& work = work_[b];
      work.force.fill(0.0F);
      work.next.fill(kNone);
      kernels_.force(patch, block.rows, weights_, work.force.data());
      for (int n = 0; n < 512; ++n) {
        const auto place = static_cast<std::size_t>(n);
        const float* const c = patch.values + Patch::at(n >> 6, n >> 3 & 7, n & 7);
        if (std::isnan(*c)) {
          work.force[place] = 0.0F;
        } else if (isWhole(c)) {
          work.next[place] = std::clamp(work.force[place], -kLargestForce, kLargestForce);
        }
      }
    });
    float share[3];
    for (int a = 0; a < 3; ++a) {
      share[a] = static_cast<float>(kDiffuseShare / (spacing_[a] * spacing_[a]));
    }
    // `ahead` and `next` take turns.
    for (int step = 0; step < kDiffuseNear + kDiffuseFar; ++step) {
      const int stride = step < kDiffuseNear ? 1 : 2;
      forBlocks(band_.blocks.size(), [&](std::size_t b) {
        Patch patch;
        gather(
            b,
            [&](std::size_t n) -> const Values& {
              return step % 2 == 0 ? work_[n].next : work_[n].ahead;
            },
            patch);
        Values& to = step % 2 == 0 ? work_[b].ahead : work_[b].next;
        to.fill(kNone);
        kernels_.diffuse(patch, band_.blocks[b].rows, stride, share, to.data());
      });
    }
    static_assert((kDiffuseNear + kDiffuseFar) % 2 == 0);
    forBlocks(band_.blocks.size(), [&](std::size_t b) {
      for (std::size_t n = 0; n < BandBlock::kVoxels; ++n) {
        if (!std::isnan(work_[b].next[n])) work_[b].force[n] = work_[b].next[n];
      }
      work_[b].ahead = band_.blocks[b].value;
    });
  }

  Band& band_;
  const Mask& mask_;
  Mat3 axes_;
  Vec3 spacing_;
  const Progress& progress_;
  RelaxWeights weights_{};
  const RelaxKernels& kernels_ = relaxKernels();
  std::vector<Work> work_;
};

}  // namespace

void smoothBand(Band& band, const Mask& mask, const Mat3& axes, const Progress& progress) {
  if (!band.blocks.empty()) Smoothing(band, mask, axes, progress).run();
}

}  // namespace palpate::vdb
