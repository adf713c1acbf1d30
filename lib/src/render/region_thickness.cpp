#include "region_thickness.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr int kMostMoves = 300;
/// A climb ends where its steps get shorter than this share of the first one.
constexpr double kShortest = 1e-6;
/// In units of the depth where the climb began: a region deeper than this counts as endless.
constexpr double kEndless = 1e6;

/// [m] Depth of `p` inside the field; infinite where the field does not know it.
double depthIn(const Field& field, const Vec3& p) {
  const FieldSample s = field.sample(p);
  if (!s.in_band) return s.value < 0.0 ? kInfinity : -kInfinity;
  const double slope = glm::length(s.gradient);
  return field.metric() == Metric::kImplicit && slope > 0.0 ? -s.value / slope : -s.value;
}

/// [m] The same in a region, which does not include what later layers take from it. At most
/// `enough` where it is that or less: of hundreds of layers most need no look then.
double depthIn(std::span<const Region> regions, std::size_t region, const Vec3& p, double enough) {
  double depth = depthIn(*regions[region].field, p);
  for (std::size_t later = region + 1; later < regions.size() && depth > enough; ++later) {
    if (regions[later].field) depth = std::min(depth, -depthIn(*regions[later].field, p));
  }
  return depth;
}

}  // namespace

double thicknessOf(std::span<const Region> regions, std::size_t region) {
  Vec3 p = regions[region].seed;
  double depth = depthIn(regions, region, p, 0.0);
  if (!(depth > 0.0)) return kInfinity;
  const double first = depth;
  double step = first;
  for (int i = 0; i < kMostMoves && step > kShortest * first && depth < kEndless * first; ++i) {
    bool is_deeper = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {1.0, -1.0}) {
        Vec3 next = p;
        next[axis] += side * step;
        const double there = depthIn(regions, region, next, depth);
        if (!(there > depth)) continue;
        is_deeper = true;
        depth = there;
        p = next;
      }
    }
    step *= is_deeper ? 2.0 : 0.5;
  }
  if (depth < kEndless * first) return 2.0 * depth;
  // Deeper than a grid's band: use the smallest side of the grid's box.
  const Box3 box = regions[region].field->bounds();
  const Vec3 size = box.size();
  return box.isBounded() ? std::min({size.x, size.y, size.z}) : kInfinity;
}

}  // namespace palpate
