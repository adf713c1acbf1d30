#include "picture/rest_forces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "palpate/interior/partition.h"
#include "palpate/render/haptic_renderer.h"
#include "picture/parallel_rows.h"

namespace palpate::tools {
namespace {

constexpr int kMostWays = 64;     // most steps out of one layer after another
constexpr double kBeyond = 1e-6;  // [m] the hand starts this far outside
constexpr double kStride = 2e-4;  // [m] per tick, on the way in
constexpr int kFewestStrides = 16;
constexpr int kMostStrides = 400;
constexpr int kMostRest = 200;     // [ticks] in which a hand must come to rest
constexpr double kStill = 1e-6;    // [N] largest change of the force per tick at rest
constexpr double kNoForce = 1e-6;  // [N]
// Number of steps along each direction, if the fields do not lead outside
constexpr int kLooks = 200;

struct Extent {
  double lo_u = kInfinity, hi_u = -kInfinity, lo_v = kInfinity, hi_v = -kInfinity;
};

/// The extent of the box, seen along the plane's normal.
Extent extentOf(const CutPlane& plane, const Box3& box) {
  Extent e;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 p = box.lo;
    for (int i = 0; i < 3; ++i) {
      if (((corner >> i) & 1) != 0) p[i] = box.hi[i];
    }
    e.lo_u = std::min(e.lo_u, plane.u(p));
    e.hi_u = std::max(e.hi_u, plane.u(p));
    e.lo_v = std::min(e.lo_v, plane.v(p));
    e.hi_v = std::max(e.hi_v, plane.v(p));
  }
  return e;
}

/// Finds the place outside where a hand begins.
class WayOut {
 public:
  WayOut(const Scene& scene, const Box3& box)
      : scene_(scene),
        longest_(glm::length(box.size())),
        signs_(scene.partition().leaves().size()) {}

  std::optional<Vec3> from(const Vec3& p) {
    if (isOutside(p)) return p;
    if (const auto along = byFields(p)) return along;
    return byLooking(p);
  }

 private:
  bool isOutside(const Vec3& p) {
    scene_.partition().signsAt(p, signs_);
    return scene_.partition().regionOf(signs_) == kOutside;
  }
  /// Moves out of the layer in which the point is deepest, and repeats.
  std::optional<Vec3> byFields(const Vec3& p) {
    Vec3 q = p;
    for (int i = 0; i < kMostWays; ++i) {
      double deepest = 0.0;
      Vec3 step(0.0);
      for (const Region& region : scene_.regions()) {
        if (!region.field || region.field->bounds().distanceTo(q) > 0.0) continue;
        const FieldSample sample = region.field->sample(q);
        const double slope = glm::length(sample.gradient);
        if (sample.value >= 0.0) continue;
        if (!(slope > 0.0)) return {};
        const double depth = -sample.value / slope;
        if (depth <= deepest) continue;
        deepest = depth;
        step = (depth + kBeyond) / slope * sample.gradient;
      }
      q += step;
      if (glm::length(q - p) > longest_ || !isFinite(q)) return {};
      if (isOutside(q)) return q;
    }
    return {};
  }
  /// The nearest exit along 26 directions.
  std::optional<Vec3> byLooking(const Vec3& p) {
    for (int look = 1; look <= kLooks; ++look) {
      const double way = longest_ * look / kLooks;
      for (int n = 0; n < 27; ++n) {
        const Vec3 to(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
        if (n == 13) continue;
        const Vec3 q = p + way * glm::normalize(to);
        if (isOutside(q)) return q;
      }
    }
    return {};
  }

  const Scene& scene_;
  double longest_;  ///< [m]
  Signs signs_;
};

Vec3 ledTo(HapticRenderer& renderer, const Vec3& from, const Vec3& to) {
  renderer.reset();
  HipState hip;
  const int strides =
      std::clamp(static_cast<int>(glm::length(to - from) / kStride), kFewestStrides, kMostStrides);
  for (int i = 0; i <= strides; ++i) {
    hip.position = from + (to - from) * (static_cast<double>(i) / strides);
    (void)renderer.update(hip);
  }
  TickResult last = renderer.update(hip);
  for (int i = 0; i < kMostRest; ++i) {
    const TickResult now = renderer.update(hip);
    const bool is_still = now.settled && glm::length(now.force - last.force) < kStill;
    last = now;
    if (is_still) break;
  }
  return last.force;
}

}  // namespace

double restSpacing(const CutPlane& plane, const Box3& box, int count) {
  const Extent e = extentOf(plane, box);
  return std::max(e.hi_u - e.lo_u, e.hi_v - e.lo_v) / count;
}

std::vector<RestForce> restForces(const Scene& scene, const CutPlane& plane, const Box3& box,
                                  int count, const Progress& progress) {
  const Extent e = extentOf(plane, box);
  const double spacing = restSpacing(plane, box, count);
  const auto squares = [&](double length) {
    return std::max(1, static_cast<int>(length / spacing + 1e-9));
  };
  const int columns = squares(e.hi_u - e.lo_u);
  const int rows = squares(e.hi_v - e.lo_v);
  const double left = 0.5 * (e.lo_u + e.hi_u - (columns - 1) * spacing);
  const double low = 0.5 * (e.lo_v + e.hi_v - (rows - 1) * spacing);

  struct Worker {
    std::unique_ptr<HapticRenderer> renderer;
    WayOut way;
  };
  // A pointer without ownership: the scene outlives the renderers, which end with this function.
  const ScenePtr borrowed(ScenePtr(), &scene);
  std::vector<Worker> workers;
  for (std::size_t i = 0; i < workerCount(); ++i) {
    workers.push_back({makeRenderer(borrowed), WayOut(scene, box)});
  }
  std::vector<std::vector<RestForce>> found(static_cast<std::size_t>(rows));
  parallelRows(rows, progress, "feeling the plane", [&](int row, std::size_t worker) {
    for (int column = 0; column < columns; ++column) {
      const Vec3 p = plane.at(left + column * spacing, low + row * spacing);
      const auto from = workers[worker].way.from(p);
      if (!from) continue;
      const Vec3 force = ledTo(*workers[worker].renderer, *from, p);
      if (glm::length(force) > kNoForce) found[static_cast<std::size_t>(row)].push_back({p, force});
    }
  });
  std::vector<RestForce> all;
  for (const auto& row : found) all.insert(all.end(), row.begin(), row.end());
  return all;
}

}  // namespace palpate::tools
