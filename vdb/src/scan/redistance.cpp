#include "scan/redistance.h"

#include <openvdb/tools/SignedFloodFill.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "bake/bake_plan.h"
#include "brick/brick_field.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using Leaf = openvdb::FloatTree::LeafNodeType;
using Bits = std::array<std::uint64_t, 8>;  ///< a word for each x, bit 8 y + z

constexpr std::size_t kVoxels = Leaf::SIZE;
/// Voxels beyond the band that still tell their neighbors: the nearest way round a hollow leads past them.
constexpr double kBeyond = 1.0;
/// [voxels] A neighbor's point that is nearer by less is the same one.
constexpr double kNearer = 1e-3;
constexpr int kLooks = 2;
/// [lattice diagonals] By how much a closest point may be further off than where its search began, a
/// crossing by linear interpolation; more is another place's.
constexpr double kSamePlace = 0.3;
/// [lattice diagonals] From there on the nearest lattice point is on a voxel's own side.
constexpr double kClear = 0.5;
constexpr int kFits = 2;
constexpr double kFitWidth =
    4.2;  ///< [voxels] of a band that a cubic spline can read at the surface
constexpr double kFitReach = 1.5;   ///< [voxels] from the surface
constexpr double kMostFit = 0.3;    ///< [voxels] more is a part that the voxels do not hold
constexpr double kLeastFit = 2e-3;  ///< [voxels] less is not felt
constexpr float kNowhere = std::numeric_limits<float>::max();

/// Voxels of a leaf while their distances are found.
struct Work {
  Coord origin;
  std::array<std::int32_t, 27> near{};  ///< leaves around it, 9 dx + 3 dy + dz from -1 on; -1: none
  Bits known{};                         ///< voxels whose neighbors may start from their point
  Bits fresh{};                         ///< those found in this round
  Bits inside{};
  std::array<std::array<float, 3>, kVoxels>
      foot;                             ///< [voxels] from each voxel to its closest point
  std::array<float, kVoxels> distance;  ///< [voxels] kNowhere: not found
};

class Redistance {
 public:
  Redistance(const LatticeSpline& spline, const Band& band, const Mask& mask, const Image& image,
             const BakeOptions& options, const Progress& progress)
      : spline_(spline),
        band_(band),
        mask_(mask),
        image_(image),
        options_(options),
        progress_(progress),
        plan_(checkOptions(options)),
        to_index_(glm::inverse(image.axes)),
        diagonal_(glm::length(glm::abs(image.axes[0]) + glm::abs(image.axes[1]) +
                              glm::abs(image.axes[2]))) {}

  LevelSet run() {
    report(progress_, "distances", 0.0);
    findCrossings();
    makeLeaves();
    seed();
    const int rounds = static_cast<int>(std::ceil(options_.half_width + kBeyond)) + 2;
    for (int round = 0; round < rounds; ++round) {
      report(progress_, "distances", 0.1 + 0.7 * round / rounds);
      if (!spread()) break;
    }
    for (int look = 0; look < kLooks; ++look) {
      report(progress_, "distances", 0.8 + 0.1 * look);
      lookAround();
    }
    return finish();
  }

 private:
  template <typename Body>
  void forLeaves(const Body& body) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, work_.size()),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t n = range.begin(); n != range.end(); ++n) body(work_[n]);
                      });
  }

  /// Between all neighbors on two sides of the mask, by linear interpolation; half-way to what lies beyond the
  /// image's border.
  void findCrossings() {
    const auto strides = mask_.strides();
    for (const BandBlock& block : band_.blocks) {
      for (std::size_t n = 0; n < BandBlock::kVoxels; ++n) {
        const float value = block.value[n];
        if (!(value < 0.0F)) continue;
        const auto place = static_cast<int>(n);
        const std::array<int, 3> at = {block.first[0] + (place >> 6),
                                       block.first[1] + (place >> 3 & 7),
                                       block.first[2] + (place & 7)};
        const std::ptrdiff_t here = mask_.at(at[0], at[1], at[2]);
        for (std::size_t a = 0; a < 3; ++a) {
          for (const int step : {-1, 1}) {
            const std::ptrdiff_t there = here + step * strides[a];
            if (mask_.inside[static_cast<std::size_t>(there)] != 0) continue;
            Vec3 index(mask_.first[0] + at[0], mask_.first[1] + at[1], mask_.first[2] + at[2]);
            std::array<int, 3> next = at;
            next[a] += step;
            const float other = band_.valueAt(mask_.first[0] + next[0], mask_.first[1] + next[1],
                                              mask_.first[2] + next[2]);
            const double share =
                std::isnan(other) ? 0.5 : static_cast<double>(value / (value - other));
            index[static_cast<int>(a)] += step * share;
            crossings_.push_back(image_.toWorld(index) / plan_.voxel);
            bounds_.include(crossings_.back() * plan_.voxel);
          }
        }
      }
    }
  }

  static std::uint64_t keyOf(const Coord& origin) noexcept {
    const auto part = [](int x) {
      const int leaf = (x >> 3) + (1 << 20);
      return static_cast<std::uint64_t>(leaf);
    };
    return part(origin.x()) << 42 | part(origin.y()) << 21 | part(origin.z());
  }

  /// The leaves that the band around a crossing can touch.
  void makeLeaves() {
    (void)voxelRange(bounds_, plan_, options_.name);
    // Each lattice edge crosses some two thirds of a voxel's face of the surface.
    const double face = std::pow(std::abs(glm::determinant(image_.axes)), 2.0 / 3.0);
    const double area =
        static_cast<double>(crossings_.size()) * face / (1.5 * plan_.voxel * plan_.voxel);
    constexpr double kRough = 4.0;
    requireMemory(area, kRough, plan_);
    // A crossing's part of the surface reaches up to a lattice step from it.
    const double reach = options_.half_width + kBeyond + diagonal_ / plan_.voxel;
    std::vector<std::uint64_t> keys;
    std::vector<Coord> origins;
    std::uint64_t last = 0;
    // Crossings of one lattice voxel after another: most ask for the leaves that the one before did.
    for (const Vec3& p : crossings_) {
      const Coord lo(down(p.x - reach), down(p.y - reach), down(p.z - reach));
      const Coord hi(down(p.x + reach), down(p.y + reach), down(p.z + reach));
      const std::uint64_t same = keyOf(lo) ^ (keyOf(hi) * 0x9E3779B97F4A7C15U);
      if (same == last) continue;
      last = same;
      for (int x = lo.x(); x <= hi.x(); x += 8) {
        for (int y = lo.y(); y <= hi.y(); y += 8) {
          for (int z = lo.z(); z <= hi.z(); z += 8) keys.push_back(keyOf({x, y, z}));
        }
      }
      if (keys.size() > 4'000'000) unite(keys);
    }
    unite(keys);
    keys_ = std::move(keys);
    work_.resize(keys_.size());
    forLeaves([&](Work& work) {
      const std::uint64_t key = keys_[static_cast<std::size_t>(&work - work_.data())];
      const auto part = [&](int shift) {
        return (static_cast<int>(key >> shift & 0x1FFFFFU) - (1 << 20)) * 8;
      };
      work.origin = Coord(part(42), part(21), part(0));
      work.distance.fill(kNowhere);
      for (int n = 0; n < 27; ++n) {
        work.near[static_cast<std::size_t>(n)] =
            leafAt(work.origin.offsetBy(8 * (n / 9 - 1), 8 * (n / 3 % 3 - 1), 8 * (n % 3 - 1)));
      }
    });
  }

  static void unite(std::vector<std::uint64_t>& keys) {
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  }
  static int down(double x) noexcept { return static_cast<int>(std::floor(x)) & ~7; }

  [[nodiscard]] std::int32_t leafAt(const Coord& origin) const noexcept {
    const auto at = std::lower_bound(keys_.begin(), keys_.end(), keyOf(origin));
    if (at == keys_.end() || *at != keyOf(origin)) return -1;
    return static_cast<std::int32_t>(at - keys_.begin());
  }

  /// Each voxel around a crossing starts from the nearest one.
  void seed() {
    for (const Vec3& p : crossings_) {
      const Vec3 low = glm::floor(p);
      for (int n = 0; n < 8; ++n) {
        const Vec3 corner = low + Vec3(n >> 2, n >> 1 & 1, n & 1);
        const Coord at(static_cast<int>(corner.x), static_cast<int>(corner.y),
                       static_cast<int>(corner.z));
        Work& work = work_[static_cast<std::size_t>(leafAt(at & ~7))];
        const Vec3 foot = p - corner;
        const std::size_t place = Leaf::coordToOffset(at);
        const auto distance = static_cast<float>(glm::length(foot));
        if (distance >= work.distance[place]) continue;
        work.distance[place] = distance;
        work.foot[place] = {static_cast<float>(foot.x), static_cast<float>(foot.y),
                            static_cast<float>(foot.z)};
      }
    }
    forLeaves([&](Work& work) {
      for (std::size_t n = 0; n < kVoxels; ++n) {
        if (work.distance[n] == kNowhere) continue;
        const auto& [x, y, z] = work.foot[n];
        take(work, n, Vec3(x, y, z), work.known);
      }
    });
  }

  static void set(Bits& bits, std::size_t place) noexcept {
    bits[place >> 6] |= std::uint64_t{1} << (place & 63U);
  }
  [[nodiscard]] static bool test(const Bits& bits, std::size_t place) noexcept {
    return (bits[place >> 6] >> (place & 63U) & 1U) != 0;
  }

  /// [voxels]
  [[nodiscard]] static Vec3 positionOf(const Work& work, std::size_t place) noexcept {
    const Coord at = work.origin + Leaf::offsetToLocalCoord(static_cast<openvdb::Index>(place));
    return {at.x(), at.y(), at.z()};
  }

  /// Finds the closest point of a voxel from `start` [voxels from it] on. The bit is set where its neighbors may
  /// go on from there.
  void take(Work& work, std::size_t place, const Vec3& start, Bits& bits) const noexcept {
    const Vec3 at = positionOf(work, place);
    const Vec3 p = at * plan_.voxel;
    Vec3 foot = start;
    double distance = glm::length(start);
    const auto found = spline_.foot(p, p + start * plan_.voxel);
    const bool holds =
        found && std::abs(found->distance) < distance * plan_.voxel + kSamePlace * diagonal_;
    if (holds) {
      foot = (found->point - p) / plan_.voxel;
      distance = std::abs(found->distance) / plan_.voxel;
    }
    const bool by_side = holds && distance * plan_.voxel < kClear * diagonal_;
    const bool inside = by_side ? found->distance < 0.0 : latticeInside(p);
    work.distance[place] = static_cast<float>(distance);
    work.foot[place] = {static_cast<float>(foot.x), static_cast<float>(foot.y),
                        static_cast<float>(foot.z)};
    if (inside) {
      set(work.inside, place);
    } else {
      work.inside[place >> 6] &= ~(std::uint64_t{1} << (place & 63U));
    }
    if (distance < options_.half_width + kBeyond) set(bits, place);
  }

  [[nodiscard]] bool latticeInside(const Vec3& p) const noexcept {
    const Vec3 index = glm::round(to_index_ * (p - image_.origin));
    std::array<int, 3> at{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double place = index[axis] - mask_.first[a];
      if (!(place >= 0.0 && place < mask_.box[a])) return false;
      at[a] = static_cast<int>(place);
    }
    return mask_.inside[static_cast<std::size_t>(mask_.at(at[0], at[1], at[2]))] != 0;
  }

  /// Voxels of a leaf next to known ones, by faces, edges or corners.
  [[nodiscard]] Bits beside(const Work& work) const noexcept {
    // Rows of ten bits (z from -1 to 8), in slabs of ten rows.
    std::array<std::array<std::uint32_t, 10>, 10> rows{};
    // The first row and slab are the last of the leaf before.
    const auto side = [](std::size_t n) -> std::size_t { return n == 0 ? 0 : n == 9 ? 2 : 1; };
    for (std::size_t x = 0; x < 10; ++x) {
      for (std::size_t y = 0; y < 10; ++y) {
        std::uint32_t row = 0;
        for (std::size_t z = 0; z < 3; ++z) {
          const std::int32_t n = work.near[9 * side(x) + 3 * side(y) + z];
          if (n < 0) continue;
          const Bits& known = work_[static_cast<std::size_t>(n)].known;
          const auto eight =
              static_cast<std::uint32_t>(known[(x + 7) & 7U] >> (8 * ((y + 7) & 7U)) & 0xFFU);
          row |= z == 0 ? eight >> 7 : z == 1 ? eight << 1 : (eight & 1U) << 9;
        }
        row |= row << 1 | row >> 1;
        rows[x][y] = row;
      }
    }
    Bits result{};
    for (std::size_t x = 0; x < 8; ++x) {
      for (std::size_t y = 0; y < 8; ++y) {
        std::uint32_t row = 0;
        for (std::size_t n = 0; n < 9; ++n) row |= rows[x + n / 3][y + n % 3];
        result[x] |= std::uint64_t{row >> 1 & 0xFFU} << (8 * y);
      }
    }
    return result;
  }
  [[nodiscard]] static std::size_t sideOf(int x) noexcept { return x < 0 ? 0 : x > 7 ? 2 : 1; }

  /// The nearest of the closest points that the voxels around a voxel know [voxels from it].
  [[nodiscard]] double nearestAround(const Work& work, std::size_t place,
                                     Vec3& nearest) const noexcept {
    const Coord local = Leaf::offsetToLocalCoord(static_cast<openvdb::Index>(place));
    double best = kInfinity;
    for (int n = 0; n < 27; ++n) {
      const Coord step(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
      const Coord at = local + step;
      const std::int32_t leaf = work.near[9 * sideOf(at.x()) + 3 * sideOf(at.y()) + sideOf(at.z())];
      if (leaf < 0) continue;
      const Work& other = work_[static_cast<std::size_t>(leaf)];
      const std::size_t there = Leaf::coordToOffset(at);
      if (!test(other.known, there)) continue;
      const auto& [x, y, z] = other.foot[there];
      const Vec3 foot =
          Vec3(step.x(), step.y(), step.z()) +
          Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
      const double square = glm::dot(foot, foot);
      if (square < best) {
        best = square;
        nearest = foot;
      }
    }
    return best;
  }

  /// One layer of voxels more. False: there is none.
  bool spread() {
    forLeaves([&](Work& work) {
      const Bits around = beside(work);
      work.fresh = {};
      for (std::size_t x = 0; x < 8; ++x) {
        for (std::uint64_t rest = around[x] & ~work.known[x]; rest != 0; rest &= rest - 1) {
          const std::size_t place = 64 * x + static_cast<std::size_t>(std::countr_zero(rest));
          if (work.distance[place] != kNowhere) continue;  // found, and beyond the band
          Vec3 start(0.0);
          if (nearestAround(work, place, start) < kInfinity) {
            take(work, place, start, work.fresh);
          }
        }
      }
    });
    bool any = false;
    for (Work& work : work_) {
      for (std::size_t x = 0; x < 8; ++x) {
        any = any || work.fresh[x] != 0;
        work.known[x] |= work.fresh[x];
      }
    }
    return any;
  }

  /// Takes what a neighbor knows better.
  void lookAround() {
    std::vector<std::vector<std::pair<std::size_t, Vec3>>> better(work_.size());
    forLeaves([&](Work& work) {
      auto& mine = better[static_cast<std::size_t>(&work - work_.data())];
      for (std::size_t place = 0; place < kVoxels; ++place) {
        if (work.distance[place] == kNowhere) continue;
        Vec3 start(0.0);
        const double square = nearestAround(work, place, start);
        const double enough = static_cast<double>(work.distance[place]) - kNearer;
        if (enough > 0.0 && square < enough * enough) mine.emplace_back(place, start);
      }
    });
    forLeaves([&](Work& work) {
      for (const auto& [place, start] : better[static_cast<std::size_t>(&work - work_.data())]) {
        take(work, place, start, work.known);
      }
    });
  }

  LevelSet finish() {
    const openvdb::FloatGrid::Ptr grid = emptyGrid(plan_, options_);
    const double units = plan_.voxel / plan_.metres_per_unit;
    std::vector<std::unique_ptr<Leaf>> leaves(work_.size());
    forLeaves([&](const Work& work) {
      auto leaf = std::make_unique<Leaf>(work.origin, plan_.background, false);
      for (std::size_t n = 0; n < kVoxels; ++n) {
        if (work.distance[n] == kNowhere) continue;
        const auto size = static_cast<float>(static_cast<double>(work.distance[n]) * units);
        const float sign = test(work.inside, n) ? -1.0F : 1.0F;
        if (size < plan_.background) {
          leaf->setValueOn(static_cast<openvdb::Index>(n), sign * size);
        } else {
          leaf->setValueOff(static_cast<openvdb::Index>(n), sign * plan_.background);
        }
      }
      if (!leaf->isEmpty())
        leaves[static_cast<std::size_t>(&work - work_.data())] = std::move(leaf);
    });
    for (auto& leaf : leaves) {
      if (leaf) grid->tree().addLeaf(leaf.release());
    }
    openvdb::tools::signedFloodFill(grid->tree());
    for (int round = 0; round < kFits && options_.half_width > kFitWidth; ++round) fit(grid);
    report(progress_, "distances", 1.0);
    return finishGrid(grid, plan_, options_);
  }

  /// Beside creases, distances bend more than a spline through them can follow. Voxels by the surface move by what
  /// that is off where their closest points are, so that it passes through the surface there too.
  void fit(const openvdb::FloatGrid::Ptr& grid) {
    const BrickField read(makeLevelSet(grid, options_.length_unit), Sampler::kCubic);
    const double units = plan_.voxel / plan_.metres_per_unit;
    forLeaves([&](const Work& work) {
      Leaf* const leaf = grid->tree().probeLeaf(work.origin);
      if (leaf == nullptr) return;
      for (std::size_t n = 0; n < kVoxels; ++n) {
        if (!(static_cast<double>(work.distance[n]) < kFitReach)) continue;
        const auto& [x, y, z] = work.foot[n];
        const Vec3 foot = positionOf(work, n) + Vec3(static_cast<double>(x), static_cast<double>(y),
                                                     static_cast<double>(z));
        const FieldSample there = read.sample(foot * plan_.voxel);
        if (!there.in_band) continue;
        const double off = there.value / plan_.voxel;
        if (!(std::abs(off) > kLeastFit && std::abs(off) < kMostFit)) continue;
        const auto place = static_cast<openvdb::Index>(n);
        const float value = leaf->getValue(place) - static_cast<float>(off * units);
        if ((value < 0.0F) == test(work.inside, n)) leaf->setValueOnly(place, value);
      }
    });
  }

  const LatticeSpline& spline_;
  const Band& band_;
  const Mask& mask_;
  const Image& image_;
  const BakeOptions& options_;
  const Progress& progress_;
  BakePlan plan_;
  Mat3 to_index_;
  double diagonal_;                  ///< [m] of a lattice cell
  std::vector<Vec3> crossings_;      ///< [voxels]
  Box3 bounds_;                      ///< [m] of the crossings
  std::vector<std::uint64_t> keys_;  ///< of the leaves' origins, ascending
  std::vector<Work> work_;           ///< in the keys' order
};

}  // namespace

LevelSet bakeSpline(const LatticeSpline& spline, const Band& band, const Mask& mask,
                    const Image& image, const BakeOptions& options, const Progress& progress) {
  return Redistance(spline, band, mask, image, options, progress).run();
}

}  // namespace palpate::vdb
