#include "bake/walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "bake/bake_plan.h"
#include "bake/edges.h"
#include "bake/solid_inside.h"
#include "bake/wall_cuts.h"
#include "mesh/triangles_meet.h"

namespace palpate::vdb {
namespace {

/// [voxels] The two sides of a wall are probed this far from it: where another wall is nearer than
/// this the side may come out wrong, and distances are off by no more than this.
constexpr double kBeside = 1e-5;

constexpr std::size_t kBatch = 256;

/// The uses of a solid's triangles, and the pieces of those that are mixed.
struct Sorted {
  explicit Sorted(std::size_t count) : uses(count, WallUse::kNeeded), pieces(count) {}
  std::vector<WallUse> uses;
  std::vector<std::vector<Corners3>> pieces;
};

/// Probes both sides of a wall; one object for each thread.
class Looker {
 public:
  explicit Looker(const SolidInside& inside) : inside_(inside), count_(inside.counter()) {}

  /// `normal`: of length 1.
  WallUse operator()(const Vec3& p, const Vec3& normal) {
    const Vec3 aside = kBeside * normal;
    return inside_.at(p + aside, count_) == inside_.at(p - aside, count_) ? WallUse::kIdle
                                                                          : WallUse::kNeeded;
  }
  /// Probes at the middle of a triangle.
  WallUse operator()(const Corners3& t) {
    return (*this)((t[0] + t[1] + t[2]) / 3.0,
                   unitOr(glm::cross(t[1] - t[0], t[2] - t[0]), Vec3(0.36, 0.48, 0.8)));
  }

 private:
  const SolidInside& inside_;
  WallCount count_;
};

Corners3 cornersOfWall(const Solid& solid, std::size_t triangle) {
  const auto& [a, b, c] = solid.triangles[triangle];
  return {solid.vertices[a], solid.vertices[b], solid.vertices[c]};
}

/// Calls sort(number, looker) for every number below `count`, in parallel.
template <typename Sort>
void inBatches(std::size_t count, const SolidInside& inside, const Progress& progress,
               const Sort& sort) {
  parallelWithProgress((count + kBatch - 1) / kBatch, progress, "bake mesh: removing inner walls",
                       0.15, 0.15, [&](std::size_t batch) {
                         Looker look(inside);
                         const std::size_t end = std::min(count, (batch + 1) * kBatch);
                         for (std::size_t n = batch * kBatch; n < end; ++n) sort(n, look);
                       });
}

/// Groups triangles without cuts that are connected across edges with two triangles: all triangles
/// of such a patch have the same use.
class Patches {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffU;
  /// The largest triangles of a patch. Three, because one of them may lie so near to another wall
  /// that probing its sides tells nothing.
  using Witnesses = std::array<std::uint32_t, 3>;

  Patches(const Solid& solid, const WallCuts& cuts) : parent_(solid.triangles.size()) {
    std::iota(parent_.begin(), parent_.end(), 0U);
    const std::vector<Side> sides = sortedSides(solid.triangles);
    forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
      if (end - begin != 2) return;
      const std::uint32_t a = sides[begin].triangle;
      const std::uint32_t b = sides[begin + 1].triangle;
      if (!cuts.isCut(a) && !cuts.isCut(b)) parent_[root(a)] = root(b);
    });
    std::vector<double> areas(parent_.size(), 0.0);
    for (std::uint32_t t = 0; t < parent_.size(); ++t) {
      if (cuts.isCut(t)) continue;
      areas[t] = areaOf(solid.vertices, solid.triangles[t]);
      const auto [at, is_new] = number_.try_emplace(root(t), witnesses_.size());
      if (is_new) witnesses_.push_back({kNone, kNone, kNone});
      std::uint32_t here = t;
      for (std::uint32_t& witness : witnesses_[at->second]) {
        if (witness == kNone || areas[here] > areas[witness]) std::swap(here, witness);
        if (here == kNone) break;
      }
    }
  }

  [[nodiscard]] std::size_t size() const noexcept { return witnesses_.size(); }
  [[nodiscard]] const Witnesses& witnesses(std::size_t patch) const { return witnesses_[patch]; }
  [[nodiscard]] std::size_t of(std::uint32_t triangle) { return number_.at(root(triangle)); }

 private:
  std::uint32_t root(std::uint32_t t) {
    while (parent_[t] != t) t = parent_[t] = parent_[parent_[t]];
    return t;
  }

  std::vector<std::uint32_t> parent_;
  std::unordered_map<std::uint32_t, std::size_t> number_;  ///< of a patch, by its root
  std::vector<Witnesses> witnesses_;
};

/// Walls are cut where they cross each other, so that each piece has one use.
Sorted sortByCuts(const Solid& solid, const SolidInside& inside, const Progress& progress) {
  const WallCuts cuts(solid, progress);
  Patches patches(solid, cuts);
  std::vector<WallUse> uses(patches.size(), WallUse::kNeeded);
  inBatches(patches.size(), inside, progress, [&](std::size_t patch, Looker& look) {
    int idle = 0;
    int asked = 0;
    for (const std::uint32_t witness : patches.witnesses(patch)) {
      if (witness == Patches::kNone) continue;
      ++asked;
      if (look(cornersOfWall(solid, witness)) == WallUse::kIdle) ++idle;
    }
    if (2 * idle > asked) uses[patch] = WallUse::kIdle;
  });
  Sorted sorted(solid.triangles.size());
  for (std::uint32_t t = 0; t < sorted.uses.size(); ++t) {
    if (!cuts.isCut(t)) sorted.uses[t] = uses[patches.of(t)];
  }
  inBatches(solid.triangles.size(), inside, progress, [&](std::size_t t, Looker& look) {
    const auto triangle = static_cast<std::uint32_t>(t);
    if (!cuts.isCut(triangle)) return;
    sorted.uses[t] =
        WallCutter::cut(cornersOfWall(solid, t), cuts.of(triangle), look, sorted.pieces[t]);
  });
  return sorted;
}

/// For solids that a flood filled: their inside is known at voxels only, so that borders are found
/// by bisection.
class Halver {
 public:
  explicit Halver(Looker& look) : look_(look) {}

  /// Sorts a triangle; the pieces that are needed go to `pieces`.
  WallUse sort(const Corners3& t, std::vector<Corners3>& pieces) {
    const Vec3 middle = (t[0] + t[1] + t[2]) / 3.0;
    const Vec3 normal = unitOr(glm::cross(t[1] - t[0], t[2] - t[0]), Vec3(0.36, 0.48, 0.8));
    const double longest =
        std::max({glm::distance(t[0], t[1]), glm::distance(t[1], t[2]), glm::distance(t[2], t[0])});
    const WallUse use = look_(middle, normal);
    bool same = longest <= kCoarse;
    for (std::size_t n = 0; n < 3 && same && longest >= kFine; ++n) {
      same = look_(0.95 * t[n] + 0.05 * middle, normal) == use;
    }
    if (same) {
      if (use == WallUse::kNeeded) pieces.push_back(t);
      return use;
    }
    const Vec3 ab = 0.5 * (t[0] + t[1]);
    const Vec3 bc = 0.5 * (t[1] + t[2]);
    const Vec3 ca = 0.5 * (t[2] + t[0]);
    const std::size_t before = pieces.size();
    const std::array<WallUse, 4> uses{sort({t[0], ab, ca}, pieces), sort({ab, t[1], bc}, pieces),
                                      sort({ca, bc, t[2]}, pieces), sort({ab, bc, ca}, pieces)};
    for (const WallUse part : uses) {
      if (part != uses[0] || part == WallUse::kMixed) return WallUse::kMixed;
    }
    pieces.resize(before);
    if (uses[0] == WallUse::kNeeded) pieces.push_back(t);
    return uses[0];
  }

 private:
  /// [voxels] Larger pieces are probed in parts, so that no wall between the probes is missed.
  static constexpr double kCoarse = 4.0;
  static constexpr double kFine = 0.1;

  Looker& look_;
};

Sorted sortByHalving(const Solid& solid, const SolidInside& inside, const Progress& progress) {
  Sorted sorted(solid.triangles.size());
  inBatches(solid.triangles.size(), inside, progress, [&](std::size_t t, Looker& look) {
    sorted.uses[t] = Halver(look).sort(cornersOfWall(solid, t), sorted.pieces[t]);
  });
  return sorted;
}

}  // namespace

void dropIdleWalls(Solid& solid, const Columns& columns, const Progress& progress) {
  const SolidInside inside(solid, columns);
  const Sorted sorted = columns.isFilled() ? sortByHalving(solid, inside, progress)
                                           : sortByCuts(solid, inside, progress);
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> part_of;
  for (std::size_t t = 0; t < sorted.uses.size(); ++t) {
    if (sorted.uses[t] == WallUse::kNeeded) {
      triangles.push_back(solid.triangles[t]);
      part_of.push_back(solid.part_of[t]);
    }
    if (sorted.uses[t] != WallUse::kMixed) continue;
    for (const Corners3& piece : sorted.pieces[t]) {
      const auto first = static_cast<std::uint32_t>(solid.vertices.size());
      solid.vertices.insert(solid.vertices.end(), piece.begin(), piece.end());
      triangles.push_back({first, first + 1, first + 2});
      part_of.push_back(solid.part_of[t]);
    }
  }
  solid.triangles = std::move(triangles);
  solid.part_of = std::move(part_of);
}

CrossingSearch::CrossingSearch(const Solid& solid) : solid_(solid) {}

std::optional<Vec3> CrossingSearch::in(const Box3& box) {
  if (!tree_) {
    boxes_.resize(solid_.triangles.size());
    for (std::size_t n = 0; n < boxes_.size(); ++n) {
      for (const std::uint32_t v : solid_.triangles[n]) boxes_[n].include(solid_.vertices[v]);
    }
    tree_.emplace(boxes_);
  }
  std::vector<std::uint32_t> near;
  tree_->visitMeeting(box, [&](std::uint32_t n) { near.push_back(n); });
  std::sort(near.begin(), near.end());
  for (const std::uint32_t here : near) {
    const Triangle& mine = solid_.triangles[here];
    std::optional<Vec3> found;
    std::uint32_t with = 0;
    tree_->visitMeeting(boxes_[here], [&](std::uint32_t n) {
      if (n <= here || (found && n > with)) return;
      if (solid_.part_of[here] != solid_.part_of[n]) return;
      const Triangle& other = solid_.triangles[n];
      const bool touches = std::any_of(mine.begin(), mine.end(), [&](std::uint32_t v) {
        return std::find(other.begin(), other.end(), v) != other.end();
      });
      if (touches || !BoundsTree::meet(boxes_[n], box)) return;
      if (const auto at = trianglesMeet(solid_.vertices, mine, other)) {
        found = at;
        with = n;
      }
    });
    if (found) return found;
  }
  return {};
}

}  // namespace palpate::vdb
