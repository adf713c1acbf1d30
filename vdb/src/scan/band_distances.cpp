#include "scan/band_distances.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "huge_vector.h"
#include "scan/for_blocks.h"
#include "scan/gather.h"
#include "scan/lattice_spline.h"
#include "scan/nearest_feet.h"

namespace palpate::vdb {
namespace {

/// [steps] A distance that differs more than this from the old value belongs to another place of
/// the surface.
constexpr double kSamePlace = 0.75;
constexpr double kBySurface = 1.2;  ///< [steps] voxels with a smaller |value| begin the search

/// The result of one voxel's search.
struct Taken {
  std::size_t place = 0;
  Vec3 foot{0.0, 0.0, 0.0};
  float value = 0.0F;
};

class Distances {
 public:
  Distances(Band& band, const Mask& mask, const Mat3& axes)
      : band_(band),
        axes_(axes),
        to_index_(glm::inverse(axes)),
        spline_(band, mask, axes, Vec3(0.0)),
        feet_(band.blocks.size()),
        taken_(band.blocks.size()) {}

  void run() {
    forBlocks(feet_.size(), [&](std::size_t b) { feet_[b].clear(); });
    forBlocks(feet_.size(), [&](std::size_t b) { fromValues(b); });
    takeAll();
    for (int round = 0; round <= Band::kReach; ++round) {
      forBlocks(feet_.size(), [&](std::size_t b) { fromNeighbors(b); });
      takeAll();
    }
  }

 private:
  void fromValues(std::size_t b) {
    const BandBlock& block = band_.blocks[b];
    Patch patch;
    gather(
        block, [&](std::size_t n) -> const BandBlock::Values& { return band_.blocks[n].value; },
        patch);
    const Mat3 back = glm::transpose(glm::inverse(axes_));
    for (std::size_t place = 0; place < BandBlock::kVoxels; ++place) {
      const auto value = static_cast<double>(block.value[place]);
      if (!(std::abs(value) < kBySurface)) continue;
      const auto n = static_cast<int>(place);
      const Vec3 slope = back * slopeAt(patch.values + Patch::at(n >> 6, n >> 3 & 7, n & 7));
      const double square = glm::dot(slope, slope);
      if (square > 0.0) look(b, place, -slope * (value / square));
    }
  }

  void fromNeighbors(std::size_t b) {
    const BandBlock& block = band_.blocks[b];
    std::uint64_t rows = 0;
    for (std::size_t place = 0; place < BandBlock::kVoxels; ++place) {
      if (isOpen(b, place)) rows |= std::uint64_t{1} << (place >> 3);
    }
    if (rows == 0) return;
    std::array<const Feet*, 27> around{};
    for (std::size_t n = 0; n < 27; ++n) {
      if (block.near[n] >= 0) around[n] = &feet_[static_cast<std::size_t>(block.near[n])];
    }
    NearestFeet nearest(axes_);
    nearest.find(around, rows);
    for (std::size_t place = 0; place < BandBlock::kVoxels; ++place) {
      if (isOpen(b, place) && nearest.square(place) < Feet::kNone) {
        look(b, place, nearest.foot(place));
      }
    }
  }

  [[nodiscard]] bool isOpen(std::size_t b, std::size_t place) const noexcept {
    return !std::isnan(band_.blocks[b].value[place]) && !feet_[b].has(place);
  }

  /// Searches the closest point, starting from `start` [steps from the voxel].
  void look(std::size_t b, std::size_t place, const Vec3& start) {
    const BandBlock& block = band_.blocks[b];
    const auto n = static_cast<int>(place);
    const Vec3 p = axes_ * Vec3(block.first[0] + (n >> 6), block.first[1] + (n >> 3 & 7),
                                block.first[2] + (n & 7));
    const std::optional<LatticeSpline::Foot> foot = spline_.foot(p, p + start);
    if (!foot || isAtBorder(foot->point)) return;
    const float value = block.value[place];
    const double distance = std::abs(foot->distance);
    if (std::abs(distance - static_cast<double>(std::fabs(value))) >
        kSamePlace * std::max(1.0, 0.5 * distance)) {
      return;
    }
    const BlockBounds& bounds = band_.bounds[b];
    taken_[b].push_back({place, foot->point - p,
                         std::clamp(std::copysign(static_cast<float>(distance), value),
                                    bounds.lower[place], bounds.upper[place])});
  }

  /// Whether a place is on the image's border, where shapes end but open bands do not.
  [[nodiscard]] bool isAtBorder(const Vec3& p) const noexcept {
    constexpr double kMost = 0.25;  // [voxels] beyond the last voxel's center
    if (!band_.is_open) return false;
    const Vec3 index = to_index_ * p;
    for (int a = 0; a < 3; ++a) {
      const double last = band_.box[static_cast<std::size_t>(a)] - 1;
      if (index[a] < -kMost || index[a] > last + kMost) return true;
    }
    return false;
  }

  /// Applied when all voxels have searched, so that none uses results of the same round.
  void takeAll() {
    forBlocks(feet_.size(), [&](std::size_t b) {
      for (const Taken& taken : taken_[b]) {
        feet_[b].set(taken.place, taken.foot);
        band_.blocks[b].value[taken.place] = taken.value;
      }
      taken_[b].clear();
    });
  }

  /// Gradient from the neighboring voxels, one-sided at the band's edge.
  [[nodiscard]] static Vec3 slopeAt(const float* c) noexcept {
    Vec3 slope(0.0);
    for (int a = 0; a < 3; ++a) {
      const std::ptrdiff_t stride = a == 0 ? Patch::kSide * Patch::kRow : a == 1 ? Patch::kRow : 1;
      const float before = c[-stride];
      const float after = c[stride];
      const float ahead = std::isnan(after) ? 0.0F : after - c[0];
      const float behind = std::isnan(before) ? 0.0F : c[0] - before;
      const bool both = !std::isnan(after) && !std::isnan(before);
      slope[a] = static_cast<double>(ahead + behind) * (both ? 0.5 : 1.0);
    }
    return slope;
  }

  Band& band_;
  Mat3 axes_;
  Mat3 to_index_;
  LatticeSpline spline_;  ///< through the old values
  HugeVector<Feet> feet_;
  std::vector<std::vector<Taken>> taken_;  ///< results of this round, for each block
};

}  // namespace

void makeDistances(Band& band, const Mask& mask, const Mat3& axes) {
  Distances(band, mask, axes).run();
}

}  // namespace palpate::vdb
