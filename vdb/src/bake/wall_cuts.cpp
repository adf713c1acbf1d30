#include "bake/wall_cuts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bake/bake_plan.h"
#include "bake/edges.h"
#include "palpate/core/bounds_tree.h"

namespace palpate::vdb {
namespace {

/// [voxels] A point this near to a plane or line counts as lying in it. That is far above the
/// rounding of places (1e-12 at ten thousand voxels), and too near to a cut to show in distances.
constexpr double kInPlane = 1e-8;
/// [voxels] Shorter cuts are ignored.
constexpr double kShort = 1e-8;
/// If there are more cuts than this, they are first halved by place: cuts along a curve that bends
/// one way would each leave all others on one side.
constexpr std::size_t kMany = 32;

/// A triangle's plane, with its sides as lines in it.
struct Wall {
  Corners3 corners;
  Vec3 normal{0.0};           ///< zero: no area
  std::array<Vec3, 3> out{};  ///< in the plane, out of each side
};

Wall wallOf(const Solid& solid, std::uint32_t triangle) {
  const auto& [i, j, k] = solid.triangles[triangle];
  Wall wall{{solid.vertices[i], solid.vertices[j], solid.vertices[k]}};
  wall.normal = unitOr(
      glm::cross(wall.corners[1] - wall.corners[0], wall.corners[2] - wall.corners[0]), Vec3(0.0));
  for (std::size_t n = 0; n < 3; ++n) {
    const Vec3 side = wall.corners[(n + 1) % 3] - wall.corners[n];
    wall.out[n] = unitOr(glm::cross(side, wall.normal), Vec3(0.0));
  }
  return wall;
}

/// The part of a cut within the wall, borders included; nothing if it is only a point.
std::optional<WallCut> within(WallCut cut, const Wall& wall) {
  for (std::size_t n = 0; n < 3; ++n) {
    const double from = glm::dot(wall.out[n], cut.from - wall.corners[n]);
    const double to = glm::dot(wall.out[n], cut.to - wall.corners[n]);
    if (from > kInPlane && to > kInPlane) return {};
    const Vec3 at = cut.from + from / (from - to) * (cut.to - cut.from);
    if (from > kInPlane && from > to) cut.from = at;
    if (to > kInPlane && to > from) cut.to = at;
  }
  if (glm::distance(cut.from, cut.to) <= kShort) return {};
  return cut;
}

/// Whether some side of `wall` has all of another triangle in the same plane beyond it.
bool isBeside(const Wall& wall, const Corners3& other) {
  for (std::size_t n = 0; n < 3; ++n) {
    const auto is_out = [&](const Vec3& p) {
      return glm::dot(wall.out[n], p - wall.corners[n]) >= -kInPlane;
    };
    if (is_out(other[0]) && is_out(other[1]) && is_out(other[2])) return true;
  }
  return false;
}

/// Adds the cuts that `other` makes in `mine`.
void addCuts(const Solid& solid, std::uint32_t mine, std::uint32_t other, const Wall& wall,
             std::vector<WallCut>& cuts) {
  const Triangle& here = solid.triangles[mine];
  const Triangle& there = solid.triangles[other];
  Corners3 corners;
  std::array<double, 3> heights{};
  int shared = 0;
  for (std::size_t n = 0; n < 3; ++n) {
    corners[n] = solid.vertices[there[n]];
    const bool is_shared = std::find(here.begin(), here.end(), there[n]) != here.end();
    shared += is_shared ? 1 : 0;
    heights[n] = is_shared ? 0.0 : glm::dot(wall.normal, corners[n] - wall.corners[0]);
    if (std::abs(heights[n]) <= kInPlane) heights[n] = 0.0;
  }
  const auto add = [&](const Vec3& from, const Vec3& to) {
    if (const auto cut = within({from, to}, wall)) cuts.push_back(*cut);
  };
  if (heights[0] == 0.0 && heights[1] == 0.0 && heights[2] == 0.0) {
    if (shared == 3 || isBeside(wall, corners) || isBeside(wallOf(solid, other), wall.corners)) {
      return;
    }
    for (std::size_t n = 0; n < 3; ++n) add(corners[n], corners[(n + 1) % 3]);
    return;
  }
  if (shared >= 2) return;
  std::array<Vec3, 4> ends{};
  std::size_t count = 0;
  for (std::size_t n = 0; n < 3; ++n) {
    const double a = heights[n];
    const double b = heights[(n + 1) % 3];
    if (a == 0.0) ends[count++] = corners[n];
    if (a * b < 0.0) ends[count++] = corners[n] + a / (a - b) * (corners[(n + 1) % 3] - corners[n]);
  }
  if (count == 2) add(ends[0], ends[1]);
}

}  // namespace

WallCuts::WallCuts(const Solid& solid, const Progress& progress) {
  std::vector<Box3> boxes(solid.triangles.size());
  for (std::size_t n = 0; n < boxes.size(); ++n) {
    for (const std::uint32_t v : solid.triangles[n]) boxes[n].include(solid.vertices[v]);
    boxes[n] = boxes[n].grownBy(kInPlane);
  }
  const BoundsTree tree(boxes);
  constexpr std::size_t kBatch = 1024;
  struct Batch {
    std::vector<WallCut> cuts;
    std::vector<std::size_t> ends;
  };
  std::vector<Batch> batches((solid.triangles.size() + kBatch - 1) / kBatch);
  parallelWithProgress(batches.size(), progress, "bake mesh: finding where walls cross", 0.15, 0.15,
                       [&](std::size_t number) {
                         Batch& batch = batches[number];
                         const std::size_t end =
                             std::min(solid.triangles.size(), (number + 1) * kBatch);
                         for (std::size_t t = number * kBatch; t < end; ++t) {
                           const auto mine = static_cast<std::uint32_t>(t);
                           const Wall wall = wallOf(solid, mine);
                           if (wall.normal != Vec3(0.0)) {
                             std::vector<std::uint32_t> others;
                             tree.visitMeeting(boxes[mine], [&](std::uint32_t other) {
                               if (other != mine) others.push_back(other);
                             });
                             std::sort(others.begin(), others.end());
                             for (const std::uint32_t other : others) {
                               addCuts(solid, mine, other, wall, batch.cuts);
                             }
                           }
                           batch.ends.push_back(batch.cuts.size());
                         }
                       });
  first_.reserve(solid.triangles.size() + 1);
  first_.push_back(0);
  for (const Batch& batch : batches) {
    const std::size_t before = cuts_.size();
    for (const std::size_t end : batch.ends) first_.push_back(before + end);
    cuts_.insert(cuts_.end(), batch.cuts.begin(), batch.cuts.end());
  }
}

WallCutter::Halves WallCutter::halve(const Polygon& polygon, const std::vector<WallCut>& cuts,
                                     const Vec3& normal) {
  Vec3 place;
  Vec3 across;
  std::size_t chosen = cuts.size();
  const auto crosses = [&](const WallCut& cut) {
    const double a = glm::dot(across, cut.from - place);
    const double b = glm::dot(across, cut.to - place);
    return (a > kInPlane && b < -kInPlane) || (a < -kInPlane && b > kInPlane);
  };
  bool by_place = cuts.size() > kMany;
  if (by_place) {
    Box3 box;
    for (const WallCut& cut : cuts) {
      box.include(cut.from);
      box.include(cut.to);
    }
    const Vec3 size = box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    Vec3 along(0.0);
    along[axis] = 1.0;
    // The cuts spread most along an axis that is not the plane's normal, so that this is not zero.
    across = glm::normalize(along - glm::dot(along, normal) * normal);
    std::vector<double> places;
    for (const WallCut& cut : cuts) places.push_back(glm::dot(across, cut.from + cut.to));
    const auto middle = places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2);
    std::nth_element(places.begin(), middle, places.end());
    place = 0.5 * *middle * across;
    // Cuts that all cross each other would be halved again and again without end.
    const auto cut_by_it = std::count_if(cuts.begin(), cuts.end(), crosses);
    by_place = static_cast<std::size_t>(cut_by_it) < cuts.size() / 4;
  }
  if (!by_place) {
    chosen = 0;
    for (std::size_t n = 1; n < cuts.size(); ++n) {
      const auto length = [&](std::size_t i) { return glm::distance(cuts[i].from, cuts[i].to); };
      if (length(n) > length(chosen)) chosen = n;
    }
    place = cuts[chosen].from;
    across = glm::normalize(glm::cross(normal, cuts[chosen].to - cuts[chosen].from));
  }
  const auto heightOf = [&](const Vec3& p) { return glm::dot(across, p - place); };
  Halves halves;
  for (std::size_t n = 0; n < polygon.size(); ++n) {
    const Vec3& p = polygon[n];
    const Vec3& q = polygon[(n + 1) % polygon.size()];
    const double a = heightOf(p);
    const double b = heightOf(q);
    if (a >= 0.0) halves.left.push_back(p);
    if (a <= 0.0) halves.right.push_back(p);
    if ((a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0)) {
      const Vec3 at = p + a / (a - b) * (q - p);
      halves.left.push_back(at);
      halves.right.push_back(at);
    }
  }
  for (std::size_t n = 0; n < cuts.size(); ++n) {
    if (n == chosen) continue;
    const double a = heightOf(cuts[n].from);
    const double b = heightOf(cuts[n].to);
    const bool is_halved = crosses(cuts[n]);
    const Vec3 at =
        is_halved ? cuts[n].from + a / (a - b) * (cuts[n].to - cuts[n].from) : cuts[n].to;
    const auto add = [&](double side, const WallCut& cut) {
      if (std::abs(side) <= kInPlane || glm::distance(cut.from, cut.to) <= kShort) return;
      (side > 0.0 ? halves.left_cuts : halves.right_cuts).push_back(cut);
    };
    if (is_halved) {
      add(a, {cuts[n].from, at});
      add(b, {at, cuts[n].to});
    } else {
      add(std::abs(a) > std::abs(b) ? a : b, cuts[n]);
    }
  }
  return halves;
}

void WallCutter::add(const Polygon& polygon, std::vector<Corners3>& pieces) {
  // Corners are removed alternately from both ends, so that a round piece does not become a fan of
  // needles.
  std::size_t low = 0;
  std::size_t high = polygon.size() - 1;
  for (bool from_low = true; high - low > 1; from_low = !from_low) {
    const std::size_t third = from_low ? low + 1 : high - 1;
    pieces.push_back({polygon[low], polygon[third], polygon[high]});
    (from_low ? low : high) = third;
  }
}

double WallCutter::widthOf(const Polygon& polygon) {
  double longest = 0.0;
  std::size_t first = 0;
  for (std::size_t n = 0; n < polygon.size(); ++n) {
    const double side = glm::distance(polygon[n], polygon[(n + 1) % polygon.size()]);
    if (side > longest) {
      longest = side;
      first = n;
    }
  }
  if (!(longest > 0.0)) return 0.0;
  const Vec3 along = (polygon[(first + 1) % polygon.size()] - polygon[first]) / longest;
  double height = 0.0;
  for (const Vec3& p : polygon) {
    height = std::max(height, glm::length(glm::cross(along, p - polygon[first])));
  }
  return height;
}

Vec3 WallCutter::middleOf(const Polygon& polygon) {
  Vec3 sum(0.0);
  double area = 0.0;
  for (std::size_t n = 1; n + 1 < polygon.size(); ++n) {
    const double part =
        glm::length(glm::cross(polygon[n] - polygon[0], polygon[n + 1] - polygon[0]));
    sum += part / 3.0 * (polygon[0] + polygon[n] + polygon[n + 1]);
    area += part;
  }
  return area > 0.0 ? sum / area : polygon[0];
}

}  // namespace palpate::vdb
