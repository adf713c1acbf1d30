#include "bake/walls.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/bake_plan.h"
#include "bake/edges.h"
#include "bake/solid_inside.h"
#include "mesh/triangles_meet.h"

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

enum class Use : std::uint8_t { kIdle, kNeeded, kMixed };

class Sorter {
 public:
  explicit Sorter(const SolidInside& inside) : inside_(inside), count_(inside.counter()) {}

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
    return inside_.at(p + aside, count_) == inside_.at(p - aside, count_) ? Use::kIdle
                                                                          : Use::kNeeded;
  }

  const SolidInside& inside_;
  WallCount count_;
};

}  // namespace

void dropIdleWalls(Solid& solid, const Columns& columns, const Progress& progress) {
  using Pieces = std::vector<std::array<Vec3, 3>>;
  const SolidInside inside(solid, columns);
  constexpr std::size_t kBatch = 256;
  std::vector<Use> uses(solid.triangles.size(), Use::kNeeded);
  std::vector<Pieces> pieces(solid.triangles.size());
  const std::size_t batches = (uses.size() + kBatch - 1) / kBatch;
  parallelWithProgress(
      batches, progress, "bake mesh: removing inner walls", 0.15, 0.15, [&](std::size_t batch) {
        Sorter sorter(inside);
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
  for (std::size_t i = 0; i < near.size(); ++i) {
    const Triangle& mine = solid.triangles[near[i].triangle];
    for (std::size_t k = i + 1; k < near.size() && near[k].box.lo.x <= near[i].box.hi.x; ++k) {
      if (solid.part_of[near[i].triangle] != solid.part_of[near[k].triangle]) continue;
      if (near[i].box.intersectedWith(near[k].box).isEmpty()) continue;
      const Triangle& other = solid.triangles[near[k].triangle];
      const bool touches = std::any_of(mine.begin(), mine.end(), [&](std::uint32_t v) {
        return std::find(other.begin(), other.end(), v) != other.end();
      });
      if (touches) continue;
      if (const auto at = trianglesMeet(solid.vertices, mine, other)) return at;
    }
  }
  return {};
}

}  // namespace palpate::vdb
