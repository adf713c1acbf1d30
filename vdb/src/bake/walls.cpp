#include "bake/walls.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/bake_plan.h"
#include "bake/edges.h"
#include "bake/radix_sort.h"
#include "bake/wall_count.h"

namespace palpate::vdb {
namespace {

/// [voxels] On a wall's sides, its neighborhood is looked at from so far.
constexpr double kBeside = 1e-4;
/// [voxels] Pieces larger than that are looked at in parts, lest something passes between.
constexpr double kCoarse = 4.0;
constexpr double kFine = 0.1;

double longestSide(const std::array<Vec3, 3>& t) {
  return std::max(
      {glm::distance(t[0], t[1]), glm::distance(t[1], t[2]), glm::distance(t[2], t[0])});
}

/// Triangles over the cells of a grid in the plane z = 0.
class Floor {
 public:
  explicit Floor(const Solid& solid) : solid_(solid) {
    for (const Vec3& v : solid.vertices) box_.include(v);
    double area = 0.0;
    for (const Triangle& t : solid.triangles) area += areaOf(solid.vertices, t);
    // As large as a triangle, but not so small that large triangles fill the memory.
    cell_ = std::max(1.0, std::sqrt(area / static_cast<double>(solid.triangles.size())));
    const double most = 4.0 * static_cast<double>(solid.triangles.size()) + 1e6;
    cell_ = std::max(cell_, std::sqrt(box_.size().x * box_.size().y / most));
    const auto cells = [&](double size) { return static_cast<std::uint64_t>(size / cell_) + 1; };
    nx_ = cells(box_.size().x);
    ny_ = cells(box_.size().y);
    struct Entry {
      std::uint64_t cell;
      std::uint32_t triangle;
    };
    std::vector<Entry> entries;
    for (std::uint32_t n = 0; n < solid.triangles.size(); ++n) {
      const auto& [i, j, k] = solid.triangles[n];
      const Vec3& a = solid.vertices[i];
      const Vec3& b = solid.vertices[j];
      const Vec3& c = solid.vertices[k];
      const Vec3 lo = glm::min(glm::min(a, b), c) - 1e-6;
      const Vec3 hi = glm::max(glm::max(a, b), c) + 1e-6;
      for (std::uint64_t x = column(lo.x, 0, nx_); x <= column(hi.x, 0, nx_); ++x) {
        for (std::uint64_t y = column(lo.y, 1, ny_); y <= column(hi.y, 1, ny_); ++y) {
          entries.push_back({x * ny_ + y, n});
        }
      }
    }
    radixSort(entries, bitsFor(nx_ * ny_), [](const Entry& e) { return e.cell; });
    first_.assign(nx_ * ny_ + 1, entries.size());
    for (std::size_t n = entries.size(); n-- > 0;) first_[entries[n].cell] = n;
    for (std::size_t n = first_.size() - 1; n-- > 0;)
      first_[n] = std::min(first_[n], first_[n + 1]);
    triangles_.reserve(entries.size());
    for (const Entry& entry : entries) triangles_.push_back(entry.triangle);
  }

  /// Whether p is in the solid, by the walls below it.
  [[nodiscard]] bool isInside(const Vec3& p, WallCount& count) const {
    count.clear();
    if (p.x < box_.lo.x || p.y < box_.lo.y || p.x > box_.hi.x || p.y > box_.hi.y) return false;
    const std::uint64_t cell = column(p.x, 0, nx_) * ny_ + column(p.y, 1, ny_);
    for (std::size_t n = first_[cell]; n < first_[cell + 1]; ++n) {
      const std::uint32_t triangle = triangles_[n];
      const auto& [i, j, k] = solid_.triangles[triangle];
      const WallHit hit =
          hitWall(solid_.vertices[i], solid_.vertices[j], solid_.vertices[k], p.x, p.y);
      if (hit.entered != 0 && hit.z < p.z) count.add(solid_.part_of[triangle], hit.entered);
    }
    return count.isInside();
  }

 private:
  [[nodiscard]] std::uint64_t column(double v, int axis, std::uint64_t count) const {
    const double place = std::max(0.0, (v - box_.lo[axis]) / cell_);
    return std::min(static_cast<std::uint64_t>(place), count - 1);
  }

  const Solid& solid_;
  Box3 box_;
  double cell_ = 1.0;
  std::uint64_t nx_ = 1;
  std::uint64_t ny_ = 1;
  std::vector<std::size_t> first_;        ///< of each cell's triangles, and one more
  std::vector<std::uint32_t> triangles_;  ///< cell by cell
};

enum class Use : std::uint8_t { kIdle, kNeeded, kMixed };

class Sorter {
 public:
  Sorter(const Floor& floor, const Columns& columns, bool filled)
      : floor_(floor), columns_(columns), count_(columns.roles()), filled_(filled) {}

  /// Of a triangle; the pieces that are needed go to `pieces`.
  Use sort(const std::array<Vec3, 3>& t, std::vector<std::array<Vec3, 3>>& pieces) {
    const Vec3 middle = (t[0] + t[1] + t[2]) / 3.0;
    const Vec3 aside =
        kBeside * unitOr(glm::cross(t[1] - t[0], t[2] - t[0]), Vec3(0.36, 0.48, 0.8));
    const double longest = longestSide(t);
    const Use use = useAt(middle, aside);
    if (longest < kFine) return keep(use, t, pieces);
    bool same = longest <= kCoarse;
    for (std::size_t n = 0; n < 3 && same; ++n)
      same = useAt(0.95 * t[n] + 0.05 * middle, aside) == use;
    if (same) return keep(use, t, pieces);
    const Vec3 ab = 0.5 * (t[0] + t[1]);
    const Vec3 bc = 0.5 * (t[1] + t[2]);
    const Vec3 ca = 0.5 * (t[2] + t[0]);
    const std::size_t before = pieces.size();
    const std::array<Use, 4> uses{sort({t[0], ab, ca}, pieces), sort({ab, t[1], bc}, pieces),
                                  sort({ca, bc, t[2]}, pieces), sort({ab, bc, ca}, pieces)};
    for (const Use part : uses) {
      if (part != uses[0] || part == Use::kMixed) return Use::kMixed;
    }
    pieces.resize(before);
    return keep(uses[0], t, pieces);
  }

 private:
  static Use keep(Use use, const std::array<Vec3, 3>& t, std::vector<std::array<Vec3, 3>>& pieces) {
    if (use == Use::kNeeded) pieces.push_back(t);
    return use;
  }

  Use useAt(const Vec3& p, const Vec3& aside) {
    return isInside(p + aside) == isInside(p - aside) ? Use::kIdle : Use::kNeeded;
  }

  bool isInside(const Vec3& p) {
    if (floor_.isInside(p, count_)) return true;
    if (!filled_) return false;
    // What the flood filled is known at voxels only; a point between eight of them is as they are.
    const Vec3 lo = glm::floor(p);
    const auto x = static_cast<int>(lo.x);
    const auto y = static_cast<int>(lo.y);
    const auto z = static_cast<int>(lo.z);
    for (int n = 0; n < 8; ++n) {
      if (!columns_.isInside(x + (n >> 2), y + ((n >> 1) & 1), z + (n & 1))) return false;
    }
    return true;
  }

  const Floor& floor_;
  const Columns& columns_;
  WallCount count_;
  bool filled_;
};

/// Where the segment from p to q passes through a triangle.
std::optional<Vec3> passes(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t) {
  const Vec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  const double before = glm::dot(normal, p - t[0]);
  const double after = glm::dot(normal, q - t[0]);
  if (!(before * after < 0.0)) return {};
  const Vec3 at = p + before / (before - after) * (q - p);
  for (std::size_t n = 0; n < 3; ++n) {
    const Vec3& from = t[n];
    if (!(glm::dot(glm::cross(t[(n + 1) % 3] - from, at - from), normal) > 0.0)) return {};
  }
  return at;
}

}  // namespace

void dropIdleWalls(Solid& solid, const Columns& columns, const Progress& progress) {
  using Pieces = std::vector<std::array<Vec3, 3>>;
  const Floor floor(solid);
  constexpr std::size_t kBatch = 256;
  std::vector<Use> uses(solid.triangles.size(), Use::kNeeded);
  std::vector<Pieces> pieces(solid.triangles.size());
  const std::size_t batches = (uses.size() + kBatch - 1) / kBatch;
  parallelWithProgress(
      batches, progress, "bake mesh: removing inner walls", 0.15, 0.15, [&](std::size_t batch) {
        Sorter sorter(floor, columns, columns.isFilled());
        const std::size_t end = std::min(uses.size(), (batch + 1) * kBatch);
        for (std::size_t t = batch * kBatch; t < end; ++t) {
          const auto& [a, b, c] = solid.triangles[t];
          uses[t] =
              sorter.sort({solid.vertices[a], solid.vertices[b], solid.vertices[c]}, pieces[t]);
        }
      });
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> part_of;
  for (std::size_t t = 0; t < uses.size(); ++t) {
    if (uses[t] == Use::kNeeded) {
      triangles.push_back(solid.triangles[t]);
      part_of.push_back(solid.part_of[t]);
    }
    if (uses[t] != Use::kMixed) continue;
    for (const std::array<Vec3, 3>& piece : pieces[t]) {
      const auto first = static_cast<std::uint32_t>(solid.vertices.size());
      solid.vertices.insert(solid.vertices.end(), piece.begin(), piece.end());
      triangles.push_back({first, first + 1, first + 2});
      part_of.push_back(solid.part_of[t]);
    }
  }
  solid.triangles = std::move(triangles);
  solid.part_of = std::move(part_of);
}

std::optional<Vec3> findCrossing(const Solid& solid, const Box3& box) {
  struct Near {
    std::uint32_t triangle;
    Box3 box;
  };
  std::vector<Near> near;
  for (std::uint32_t n = 0; n < solid.triangles.size(); ++n) {
    Box3 around;
    for (const std::uint32_t v : solid.triangles[n]) around.include(solid.vertices[v]);
    if (!around.intersectedWith(box).isEmpty()) near.push_back({n, around});
  }
  std::sort(near.begin(), near.end(),
            [](const Near& a, const Near& b) { return a.box.lo.x < b.box.lo.x; });
  const auto corners_of = [&](const Near& n) {
    const auto& [a, b, c] = solid.triangles[n.triangle];
    return std::array<Vec3, 3>{solid.vertices[a], solid.vertices[b], solid.vertices[c]};
  };
  for (std::size_t i = 0; i < near.size(); ++i) {
    const Triangle& mine = solid.triangles[near[i].triangle];
    const std::array<Vec3, 3> here = corners_of(near[i]);
    for (std::size_t k = i + 1; k < near.size() && near[k].box.lo.x <= near[i].box.hi.x; ++k) {
      if (solid.part_of[near[i].triangle] != solid.part_of[near[k].triangle]) continue;
      if (near[i].box.intersectedWith(near[k].box).isEmpty()) continue;
      const Triangle& other = solid.triangles[near[k].triangle];
      const bool touches = std::any_of(mine.begin(), mine.end(), [&](std::uint32_t v) {
        return std::find(other.begin(), other.end(), v) != other.end();
      });
      if (touches) continue;
      const std::array<Vec3, 3> there = corners_of(near[k]);
      for (std::size_t n = 0; n < 3; ++n) {
        if (const auto at = passes(here[n], here[(n + 1) % 3], there)) return at;
        if (const auto at = passes(there[n], there[(n + 1) % 3], here)) return at;
      }
    }
  }
  return {};
}

}  // namespace palpate::vdb
