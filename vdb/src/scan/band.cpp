#include "scan/band.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "scan/cliff_faces.h"
#include "scan/for_blocks.h"
#include "scan/opposite.h"
#include "scan/slices.h"
#include "scan/thin_parts.h"

namespace palpate::vdb {
namespace {

/// A voxel center may lie on the surface, except in a part one voxel thin and beside it: there the
/// part would vanish or swell.
constexpr double kHold = 0.3;
constexpr double kBeside = 1.8;  ///< voxels that share a corner
/// By how many voxels the surface may be nearer than the nearest voxel of the other side: about one
/// for a smooth surface. A smaller value would bend curved surfaces. For voxels that are not cubes,
/// the unit is their diagonal.
constexpr double kSlack = 1.3;
/// At least this share of the longest edge: a surface along thick slices may pass close by one
/// slice's centers. A whole edge lets layers as thin as a slice lose centers in folds.
constexpr double kThickSlack = 0.82;
/// Share of the step between two voxels at which the surface is assumed at first.
constexpr double kHalf = 0.5;
/// [voxels] How far a flat face between cliffs may be from half-way.
constexpr double kLevel = 0.01;

class Finder {
 public:
  Finder(const Mask& mask, const Vec3& spacing, bool is_open)
      : mask_(mask),
        spacing_(spacing),
        slack_(std::max(kSlack * glm::length(spacing) / std::sqrt(3.0),
                        kThickSlack * std::max({spacing.x, spacing.y, spacing.z}))),
        longest_(std::max({spacing.x, spacing.y, spacing.z})),
        opposite_(spacing),
        slices_(SliceDistances::of(mask, spacing)) {
    band_.spacing = spacing;
    band_.is_open = is_open;
    band_.first = mask.first;
    band_.box = mask.box;
    for (std::size_t a = 0; a < 3; ++a) band_.table_size[a] = (mask.box[a] + 7) / 8;
  }

  Band run() {
    makeBlocks();
    forBlocks(band_.blocks.size(), [&](std::size_t b) { fill(band_.blocks[b], band_.bounds[b]); });
    dropEmpty();
    linkBlocks();
    return std::move(band_);
  }

 private:
  [[nodiscard]] bool inside(std::ptrdiff_t n) const noexcept {
    return mask_.inside[static_cast<std::size_t>(n)] != 0;
  }

  template <typename Visit>
  void forTable(const Visit& visit) const {
    const auto [nx, ny, nz] = band_.table_size;
    for (int z = 0; z < nz; ++z) {
      for (int y = 0; y < ny; ++y) {
        for (int x = 0; x < nx; ++x) visit(x, y, z);
      }
    }
  }
  [[nodiscard]] std::size_t tableAt(int x, int y, int z) const noexcept {
    const int place = x + band_.table_size[0] * (y + band_.table_size[1] * z);
    return static_cast<std::size_t>(place);
  }

  /// Makes the blocks with a voxel beside the surface, and those around them.
  void makeBlocks() {
    std::vector<std::uint8_t> near(tableAt(0, 0, band_.table_size[2]));
    const auto [sx, sy, sz] = mask_.strides();
    const auto [nx, ny, nz] = mask_.box;
    for (int k = 0; k < nz; ++k) {
      for (int j = 0; j < ny; ++j) {
        std::ptrdiff_t n = mask_.at(0, j, k);
        for (int i = 0; i < nx; ++i, ++n) {
          // It is enough to look at the inside voxel of each pair: the outside one is in the same
          // block or the next.
          if (!inside(n) || (inside(n - sx) && inside(n + sx) && inside(n - sy) && inside(n + sy) &&
                             inside(n - sz) && inside(n + sz))) {
            continue;
          }
          near[tableAt(i >> 3, j >> 3, k >> 3)] = 1;
        }
      }
    }
    // Not one structured binding, because clang 14 lambdas cannot capture it.
    const int tx = band_.table_size[0];
    const int ty = band_.table_size[1];
    const int tz = band_.table_size[2];
    band_.table.assign(near.size(), -1);
    std::vector<std::array<int, 3>> firsts;
    forTable([&](int x, int y, int z) {
      bool any = false;
      for (int n = 0; n < 27 && !any; ++n) {
        const int a = x + n / 9 - 1;
        const int b = y + n / 3 % 3 - 1;
        const int c = z + n % 3 - 1;
        any =
            a >= 0 && b >= 0 && c >= 0 && a < tx && b < ty && c < tz && near[tableAt(a, b, c)] != 0;
      }
      if (any) firsts.push_back({8 * x, 8 * y, 8 * z});
    });
    band_.blocks.resize(firsts.size());
    for (std::size_t b = 0; b < firsts.size(); ++b) band_.blocks[b].first = firsts[b];
    band_.bounds.resize(band_.blocks.size());
  }

  void fill(BandBlock& block, BlockBounds& bounds) const noexcept {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    block.value.fill(kNone);
    bounds.lower.fill(kNone);
    bounds.upper.fill(kNone);
    Opposite::Found found;
    const bool has_surface = opposite_.find(mask_, block.first, found);
    if (!has_surface && !isByBorder(block.first)) return;
    const auto [nx, ny, nz] = mask_.box;
    const auto [x, y, z] = block.first;
    for (int i = x; i < std::min(x + 8, nx); ++i) {
      for (int j = y; j < std::min(y + 8, ny); ++j) {
        for (int k = z; k < std::min(z + 8, nz); ++k) {
          Other other;
          if (has_surface) other = otherOf(found, {i, j, k});
          if (fillVoxel(block, bounds, {i, j, k}, other))
            block.rows |= std::uint64_t{1} << (8 * (i & 7) + (j & 7));
        }
      }
    }
  }

  /// The nearest voxel on the other side, if it is within reach.
  struct Other {
    double steps = kInfinity;     ///< [voxels] length of the step to it
    double distance = kInfinity;  ///< [steps of the smallest spacing] distance to it
  };

  [[nodiscard]] Other otherOf(const Opposite::Found& found,
                              const std::array<int, 3>& at) const noexcept {
    const int n = ((at[2] & 7) * 8 + (at[1] & 7)) * 8 + (at[0] & 7);
    const auto place = static_cast<std::size_t>(n);
    // With unequal spacings, a voxel that is farther away may be fewer voxels away.
    if (found.fewest[place] > Band::kReach * Band::kReach) return {};
    return {std::sqrt(static_cast<double>(found.voxels[place])),
            std::sqrt(static_cast<double>(found.square[place]))};
  }

  [[nodiscard]] bool isByBorder(const std::array<int, 3>& first) const noexcept {
    bool by = false;
    for (std::size_t a = 0; a < 3; ++a) {
      by = by || first[a] < Band::kReach ||
           first[a] + BandBlock::kSide + Band::kReach > mask_.box[a];
    }
    return by;
  }

  /// Returns whether the voxel is in the band.
  bool fillVoxel(BandBlock& block, BlockBounds& bounds, const std::array<int, 3>& at,
                 const Other& other) const noexcept {
    const std::ptrdiff_t n = mask_.at(at[0], at[1], at[2]);
    const bool is_inside = inside(n);
    double size = kInfinity;
    double lower = 0.0;
    double upper = kInfinity;
    if (other.steps < kInfinity) {
      size = other.distance * (1.0 - kHalf / other.steps);
      if (slices_) size = slices_->distanceAt(at).value_or(size);
      lower = std::max(0.0, std::min(other.distance, opposite_.seen()) - slack_);
      upper = other.distance;
    }
    const double border = is_inside ? band_.borderDistance(at) : kInfinity;
    if (!band_.is_open) size = std::min(size, border);
    if (!(size < kInfinity)) return border < kInfinity;
    if (other.steps < kBeside && isAtThinPart(mask_, at)) lower = std::max(lower, kHold);
    if (other.distance <= longest_) {
      if (const std::optional<int> axis = cliffFaceAxis(mask_, at)) {
        lower = std::max(lower, (kHalf - kLevel) * spacing_[*axis]);
        upper = std::min(upper, (kHalf + kLevel) * spacing_[*axis]);
      }
    }
    size = std::clamp(size, lower, upper);
    const std::size_t place = Band::placeOf(at[0], at[1], at[2]);
    block.value[place] = static_cast<float>(is_inside ? -size : size);
    bounds.lower[place] = static_cast<float>(is_inside ? -upper : lower);
    bounds.upper[place] = static_cast<float>(is_inside ? -lower : upper);
    return true;
  }

  void dropEmpty() {
    std::size_t kept = 0;
    for (std::size_t b = 0; b < band_.blocks.size(); ++b) {
      if (band_.blocks[b].rows == 0) continue;
      if (kept != b) {
        band_.blocks[kept] = band_.blocks[b];
        band_.bounds[kept] = band_.bounds[b];
      }
      ++kept;
    }
    band_.blocks.resize(kept);
    band_.bounds.resize(kept);
    band_.blocks.shrink_to_fit();
    band_.bounds.shrink_to_fit();
    for (std::size_t b = 0; b < band_.blocks.size(); ++b) {
      const auto [x, y, z] = band_.blocks[b].first;
      band_.table[tableAt(x >> 3, y >> 3, z >> 3)] = static_cast<std::int32_t>(b);
    }
  }

  void linkBlocks() {
    for (BandBlock& block : band_.blocks) {
      for (int n = 0; n < 27; ++n) {
        const std::array<int, 3> step = {n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
        std::array<int, 3> at{};
        bool in = true;
        for (std::size_t a = 0; a < 3; ++a) {
          at[a] = block.first[a] / 8 + step[a];
          in = in && at[a] >= 0 && at[a] < band_.table_size[a];
        }
        block.near[static_cast<std::size_t>(n)] =
            in ? band_.table[tableAt(at[0], at[1], at[2])] : -1;
      }
    }
  }

  const Mask& mask_;
  Vec3 spacing_;
  double slack_;  ///< in steps of the smallest spacing
  double longest_;
  Opposite opposite_;
  std::optional<SliceDistances> slices_;
  Band band_;
};

}  // namespace

float Band::valueAt(int i, int j, int k) const noexcept {
  const std::array<int, 3> at = {i - first[0], j - first[1], k - first[2]};
  for (std::size_t a = 0; a < 3; ++a) {
    if (at[a] < 0 || at[a] >= box[a]) return std::numeric_limits<float>::quiet_NaN();
  }
  const std::int32_t block = blockAt(at[0], at[1], at[2]);
  if (block < 0) return std::numeric_limits<float>::quiet_NaN();
  return blocks[static_cast<std::size_t>(block)].value[placeOf(at[0], at[1], at[2])];
}

/// An inside voxel near the box's border is near the image's border: masks have a margin elsewhere.
double Band::borderDistance(const std::array<int, 3>& at) const noexcept {
  double nearest = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const int steps = std::min(at[a], box[a] - 1 - at[a]);
    if (steps < kReach) nearest = std::min(nearest, (steps + kHalf) * spacing[axis]);
  }
  return nearest;
}

Band bandOf(const Mask& mask, const Vec3& spacing, bool is_open) {
  return Finder(mask, spacing, is_open).run();
}

void closeBand(Band& band, const Mask& mask) {
  forBlocks(band.blocks.size(), [&](std::size_t b) {
    BandBlock& block = band.blocks[b];
    for (std::size_t n = 0; n < BandBlock::kVoxels; ++n) {
      const auto place = static_cast<int>(n);
      const std::array<int, 3> at = {block.first[0] + (place >> 6),
                                     block.first[1] + (place >> 3 & 7),
                                     block.first[2] + (place & 7)};
      if (!isIn(mask, at)) continue;
      if (mask.inside[static_cast<std::size_t>(mask.at(at[0], at[1], at[2]))] == 0) continue;
      block.value[n] = band.closed(block.value[n], at);
    }
  });
  band.is_open = false;
}

}  // namespace palpate::vdb
