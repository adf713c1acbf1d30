#include "scan/band.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

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
/// Share of the step between two voxels at which the surface is assumed at first.
constexpr double kHalf = 0.5;

struct Offset {
  std::array<int, 3> step{};
  double steps = 0.0;     ///< its length in voxels
  double distance = 0.0;  ///< in steps of the smallest spacing
};

class Finder {
 public:
  Finder(const Mask& mask, const Vec3& spacing)
      : mask_(mask),
        spacing_(spacing),
        slack_(kSlack * glm::length(spacing) / std::sqrt(3.0)),
        opposite_(spacing),
        slices_(SliceDistances::of(mask, spacing)),
        is_cubic_(glm::length(spacing - Vec3(1.0)) < 1e-5) {
    band_.first = mask.first;
    band_.box = mask.box;
    for (std::size_t a = 0; a < 3; ++a) band_.table_size[a] = (mask.box[a] + 7) / 8;
    makeOffsets();
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

  void makeOffsets() {
    constexpr int kR = Band::kReach;
    for (int i = -kR; i <= kR; ++i) {
      for (int j = -kR; j <= kR; ++j) {
        for (int k = -kR; k <= kR; ++k) {
          const int square = i * i + j * j + k * k;
          if (square == 0 || square > kR * kR) continue;
          offsets_.push_back({{i, j, k}, std::sqrt(square), glm::length(Vec3(i, j, k) * spacing_)});
        }
      }
    }
    // Ties are broken by the length in voxels, so that an offset and its opposite, as seen from the
    // other side, sort alike.
    std::stable_sort(offsets_.begin(), offsets_.end(), [](const Offset& a, const Offset& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.steps < b.steps;
    });
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
    if (found.square[place] >= Opposite::kNone) return {};
    const auto voxels = static_cast<double>(found.voxels[place]);
    if (voxels <= Band::kReach * Band::kReach) {
      return {std::sqrt(voxels), std::sqrt(static_cast<double>(found.square[place]))};
    }
    // With unequal spacings, a voxel that is farther away may be fewer voxels away.
    return is_cubic_ ? Other{} : otherWithinReach(at);
  }

  [[nodiscard]] bool isByBorder(const std::array<int, 3>& first) const noexcept {
    bool by = false;
    for (std::size_t a = 0; a < 3; ++a) {
      by = by || first[a] < Band::kReach ||
           first[a] + BandBlock::kSide + Band::kReach > mask_.box[a];
    }
    return by;
  }

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
      lower = std::max(0.0, other.distance - slack_);
      upper = other.distance;
    }
    if (is_inside) size = std::min(size, borderDistance(at));
    if (!(size < kInfinity)) return false;
    if (other.steps < kBeside && isAtThinPart(mask_, at)) lower = std::max(lower, kHold);
    size = std::clamp(size, lower, upper);
    const std::size_t place = Band::placeOf(at[0], at[1], at[2]);
    block.value[place] = static_cast<float>(is_inside ? -size : size);
    bounds.lower[place] = static_cast<float>(is_inside ? -upper : lower);
    bounds.upper[place] = static_cast<float>(is_inside ? -lower : upper);
    return true;
  }

  [[nodiscard]] Other otherWithinReach(const std::array<int, 3>& at) const noexcept {
    const bool side = inside(mask_.at(at[0], at[1], at[2]));
    for (const Offset& offset : offsets_) {
      const std::array<int, 3> there = {at[0] + offset.step[0], at[1] + offset.step[1],
                                        at[2] + offset.step[2]};
      // Beyond the image nothing is known; it does not count as outside.
      if (isIn(mask_, there) && inside(mask_.at(there[0], there[1], there[2])) != side) {
        return {offset.steps, offset.distance};
      }
    }
    return {};
  }

  /// Distance to the image's border, if that is within reach. An inside voxel near the box's border
  /// is near the image's border: masks have a margin elsewhere.
  [[nodiscard]] double borderDistance(const std::array<int, 3>& at) const noexcept {
    double nearest = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const int steps = std::min(at[a], mask_.box[a] - 1 - at[a]);
      if (steps < Band::kReach) nearest = std::min(nearest, (steps + kHalf) * spacing_[axis]);
    }
    return nearest;
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
  Opposite opposite_;
  std::optional<SliceDistances> slices_;
  bool is_cubic_;
  std::vector<Offset> offsets_;
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

Band bandOf(const Mask& mask, const Vec3& spacing) { return Finder(mask, spacing).run(); }

}  // namespace palpate::vdb
