#include "scan/smooth_mask.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "huge_vector.h"
#include "scan/band_distances.h"
#include "scan/for_blocks.h"
#include "scan/gather.h"
#include "scan/relax.h"

namespace palpate::vdb {
namespace {

using Values = BandBlock::Values;

// More steps smooth more. After these numbers of steps a ball, a ring and a tilted plane all have
// normals within half a degree, while waves longer than a scan's voxels can cause are left alone.
constexpr int kFirstSteps = 80;
constexpr int kSecondSteps = 140;
constexpr double kMostStretch = 4.0;
/// The largest eigenvalue of the energy's matrix is 144/42 of its diagonal.
constexpr float kStep = 1.0F / 3.5F;
/// Steps of diffusion: the first ones, with stride 1, also mix odd and even voxels. Together they
/// amount to a Gaussian of 5.7 voxels.
constexpr int kDiffuseNear = 4;
constexpr int kDiffuseFar = 26;
constexpr double kDiffuseShare = 0.15;
/// A sharper bend than this is a crease, not a curvature: a ball of two voxels has 0.1.
constexpr float kLargestForce = 0.1F;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// Working data of a block.
struct Work {
  alignas(32) Values ahead;  ///< where the gradient is taken: the value plus its momentum
  alignas(32) Values next;
  alignas(32) Values step;   ///< how far a unit of force moves each voxel
  alignas(32) Values force;  ///< force to subtract
};

class Smoothing {
 public:
  Smoothing(Band& band, const Mask& mask, const Mat3& axes, const Progress& progress)
      : band_(band),
        mask_(mask),
        axes_(axes),
        spacing_(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])),
        progress_(progress) {
    for (int a = 0; a < 3; ++a) {
      const double u = spacing_[(a + 1) % 3];
      const double v = spacing_[(a + 2) % 3];
      weights_.axis[a] = static_cast<float>(1.0 / std::pow(spacing_[a], 4));
      weights_.plane[a] = static_cast<float>(2.0 / (u * u * v * v));  // two of the nine derivatives
    }
  }

  void run() {
    begin();
    // With thick slices, a surface makes steps that are many voxels long; smoothing must travel as
    // far, in as many iterations.
    const double longest = std::max({spacing_.x, spacing_.y, spacing_.z});
    const double more = std::min(longest, kMostStretch);
    relax(static_cast<int>(more * kFirstSteps), 0.0, 0.4, /*with_force=*/false);
    work_ = HugeVector<Work>();  // frees this memory: the distances need their own
    report(progress_, "smooth the labels", 0.4);
    makeDistances(band_, mask_, axes_);
    begin();
    takeOutForces();
    relax(static_cast<int>(more * kSecondSteps), 0.5, 1.0, /*with_force=*/true);
  }

 private:
  void begin() {
    work_.resize(band_.blocks.size());
    forBlocks(work_.size(), [&](std::size_t b) {
      work_[b].ahead = band_.blocks[b].value;
      work_[b].next = band_.blocks[b].value;
      findSteps(b);
    });
  }

  /// 1 / (3.5 x the diagonal): the diagonal counts the energy's squares that contain each voxel.
  void findSteps(std::size_t b) noexcept {
    Patch patch;
    gather(
        band_.blocks[b], [&](std::size_t n) -> const Values& { return band_.blocks[n].value; },
        patch);
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

  /// Whether all of the energy's squares around a voxel have their voxels.
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
  void relax(int steps, double from, double to, bool with_force) {
    alignas(32) static constexpr Values kNoForce{};
    double t = 1.0;
    for (int step = 0; step < steps; ++step) {
      if (step % 10 == 0) report(progress_, "smooth the labels", from + (to - from) * step / steps);
      const double t_next = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * t * t));
      const auto momentum = static_cast<float>((t - 1.0) / t_next);
      t = t_next;
      // The two arrays alternate.
      Values Work::*const from_here = step % 2 == 0 ? &Work::ahead : &Work::next;
      Values Work::*const to_there = step % 2 == 0 ? &Work::next : &Work::ahead;
      forBlocks(band_.blocks.size(), [&](std::size_t b) {
        BandBlock& block = band_.blocks[b];
        Patch patch;
        gather(
            block, [&](std::size_t n) -> const Values& { return work_[n].*from_here; }, patch);
        const BlockBounds& bounds = band_.bounds[b];
        Work& work = work_[b];
        kernels_.relax(patch, block.rows, weights_,
                       {with_force ? work.force.data() : kNoForce.data(), work.step.data(),
                        bounds.lower.data(), bounds.upper.data(), block.value.data(),
                        (work.*to_there).data(), momentum});
      });
    }
    forBlocks(band_.blocks.size(), [&](std::size_t b) { work_[b].ahead = band_.blocks[b].value; });
  }

  /// Computes the force on the present distances. At the band's edge it is used as it is; elsewhere
  /// it is first smoothed along the surface by diffusion.
  void takeOutForces() {
    forBlocks(band_.blocks.size(), [&](std::size_t b) {
      Patch patch;
      gather(
          band_.blocks[b], [&](std::size_t n) -> const Values& { return work_[n].ahead; }, patch);
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
    // `ahead` and `next` alternate.
    for (int step = 0; step < kDiffuseNear + kDiffuseFar; ++step) {
      const int stride = step < kDiffuseNear ? 1 : 2;
      forBlocks(band_.blocks.size(), [&](std::size_t b) {
        Patch patch;
        gather(
            band_.blocks[b],
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
  HugeVector<Work> work_;
};

}  // namespace

void smoothBand(Band& band, const Mask& mask, const Mat3& axes, const Progress& progress) {
  if (!band.blocks.empty()) Smoothing(band, mask, axes, progress).run();
}

}  // namespace palpate::vdb
