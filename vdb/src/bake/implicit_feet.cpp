#include "bake/implicit_feet.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "bake/band_source.h"
#include "bake/closest_point.h"
#include "bake/cube_search.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;

/// [voxels] The side is looked up for all voxels that may be this near to the surface. They include
/// each voxel that has a neighbor, diagonal ones too, on the other side.
constexpr double kSided = 1.75;
/// [voxels] Up to this distance a voxel searches for its closest point by itself. Each point of the
/// surface has a voxel within 0.87.
constexpr double kSeeded = 1.2;
/// A leaf's slope bound is at most this many times the steepest slope between its points two voxels
/// apart. A bound for all of space is often far too large: that of a quadratic form, say, is many
/// times its slope near its surface.
constexpr double kSteeper = 1.7;

constexpr std::size_t kVoxels = DistanceLeaf::kVoxels;
constexpr std::size_t kBatch = PointBatch::kCount;

Coord offsetOf(std::size_t place) noexcept {
  const auto n = static_cast<int>(place);
  return {n >> 6, n >> 3 & 7, n & 7};
}

/// The largest slope [value per step] among 4^3 values, by differences to the neighbors along the
/// axes.
double steepestOf(const ValueBatch& values) noexcept {
  double most = 0.0;
  for (std::size_t n = 0; n < kBatch; ++n) {
    double square = 0.0;
    for (const std::size_t step : {std::size_t{1}, std::size_t{4}, std::size_t{16}}) {
      const bool is_last = (n / step & 3U) == 3;
      const double by = is_last ? values[n] - values[n - step] : values[n + step] - values[n];
      square += by * by;
    }
    most = std::max(most, square);
  }
  return std::sqrt(most);
}

/// [m] Lower bound of the distance to the surface, if the field curves at most twice as much as it
/// does here: the t for which |S| = |grad S| t + |H| t^2.
double leastDistance(const FieldJet& jet) noexcept {
  double square = 0.0;
  for (int column = 0; column < 3; ++column) {
    square += glm::dot(jet.hessian[column], jet.hessian[column]);
  }
  const double slope = glm::length(jet.gradient);
  // The root, written so that it also holds without curvature.
  const double value = std::fabs(jet.value);
  return 2.0 * value / (slope + std::sqrt(slope * slope + 4.0 * std::sqrt(square) * value));
}

/// The results of one leaf.
struct Found {
  KnownSides sides;
  std::vector<SurfaceFoot> feet;
};

class SurfaceFinder {
 public:
  SurfaceFinder(const Field& field, const BandSource& source, const Box3& domain,
                const BakePlan& plan)
      : field_(field),
        source_(source),
        closest_(field, plan.voxel),
        voxel_(plan.voxel),
        asked_(domain.grownBy(kSided * plan.voxel)),
        lipschitz_(field.lipschitz()),
        domain_(field.lipschitzDomain()) {}

  /// `broken`: set where a value is not a number.
  void in(const CubeSearch::Cube& cube, const FieldPart& part, Found& found,
          std::atomic<bool>& broken) const {
    found.sides.origin = cube.origin;
    const Vec3 first = at(cube.origin);
    const bool is_bounded = domain_.contains(first - Vec3(2.0 * voxel_)) &&
                            domain_.contains(first + Vec3(9.0 * voxel_));
    // First blocks of 2^3 voxels, by their middles.
    PointBatch points;
    ValueBatch values;
    for (std::size_t n = 0; n < kBatch; ++n) {
      const auto [x, y, z] = std::array{n >> 4, n >> 2 & 3, n & 3};
      put(points, n, first + voxel_ * (Vec3(x, y, z) * 2.0 + Vec3(0.5)));
    }
    const double reach = (0.5 * std::sqrt(3.0) + kSided) * voxel_ * (1.0 + 1e-9);
    source_.parts().values(part, points, values);
    const double steepest = std::min(is_bounded ? lipschitz_ : kInfinity,
                                     kSteeper * steepestOf(values) / (2.0 * voxel_));
    std::array<std::uint16_t, kVoxels> places;
    std::size_t count = 0;
    for (std::size_t n = 0; n < kBatch; ++n) {
      if (std::fabs(values[n]) > steepest * reach) continue;
      const std::size_t low = (n >> 4 << 7) + ((n >> 2 & 3U) << 4) + ((n & 3U) << 1);
      for (const std::size_t step : {0U, 1U, 8U, 9U, 64U, 65U, 72U, 73U}) {
        // The leaf may reach beyond the voxels asked for.
        if (!asked_.contains(first + voxel_ * vec(offsetOf(low + step)))) continue;
        places[count++] = static_cast<std::uint16_t>(low + step);
      }
    }
    for (std::size_t begin = 0; begin < count; begin += kBatch) {
      const std::size_t end = std::min(begin + kBatch, count);
      if (end - begin < kBatch / 4) {
        for (std::size_t n = begin; n < end; ++n) {
          const Vec3 p = first + voxel_ * vec(offsetOf(places[n]));
          values[n - begin] = source_.parts().value(part, p);
        }
      } else {
        for (std::size_t n = 0; n < kBatch; ++n) {
          const std::size_t place = places[std::min(begin + n, end - 1)];
          put(points, n, first + voxel_ * vec(offsetOf(place)));
        }
        source_.parts().values(part, points, values);
      }
      for (std::size_t n = begin; n < end; ++n) {
        if (std::isnan(values[n - begin])) broken.store(true, std::memory_order_relaxed);
        look(places[n], values[n - begin], steepest, found);
      }
    }
  }

 private:
  [[nodiscard]] static Vec3 vec(const Coord& c) noexcept { return {c.x(), c.y(), c.z()}; }
  [[nodiscard]] Vec3 at(const Coord& voxel) const noexcept { return vec(voxel) * voxel_; }
  static void put(PointBatch& points, std::size_t n, const Vec3& p) noexcept {
    points.x[n] = p.x;
    points.y[n] = p.y;
    points.z[n] = p.z;
  }

  void look(std::size_t place, double value, double steepest, Found& found) const {
    setBit(found.sides.known, place);
    if (value < 0.0) setBit(found.sides.inside, place);
    if (std::fabs(value) > steepest * kSeeded * voxel_) return;
    const Coord voxel = found.sides.origin + offsetOf(place);
    const Vec3 p = at(voxel);
    const FieldJet jet = field_.jet(p);
    const double slope = glm::length(jet.gradient);
    if (!jet.in_band || leastDistance(jet) > kSeeded * voxel_) return;
    // Where the gradient vanishes, S / |grad S| does not tell how far away the surface is.
    const bool is_far = !(std::fabs(jet.value) <= kSeeded * voxel_ * slope);
    if (is_far && !hasCrossing(p, value)) return;
    if (const std::optional<Vec3> foot = footOf(p, jet, slope)) {
      const Vec3 way = (*foot - p) / voxel_;
      if (glm::length(way) <= kSided) found.feet.push_back({voxel, way});
    }
  }

  /// Whether the field changes its sign towards a neighbor.
  [[nodiscard]] bool hasCrossing(const Vec3& p, double value) const noexcept {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        Vec3 q = p;
        q[axis] += side * voxel_;
        if ((field_.value(q) < 0.0) != (value < 0.0)) return true;
      }
    }
    return false;
  }

  [[nodiscard]] std::optional<Vec3> footOf(const Vec3& p, const FieldJet& jet,
                                           double slope) const noexcept {
    if (slope > 0.0) {
      const Vec3 start = p - (jet.value / (slope * slope)) * jet.gradient;
      const Vec3 way = start - p;
      if (glm::dot(way, way) < 4.0 * voxel_ * voxel_) {
        if (const auto foot = closest_.from(p, p, jet)) return foot;
        if (const auto on = closest_.onto(start)) return closest_.creptTo(p, *on);
      }
    }
    return byBisection(p, jet.value);
  }

  /// A surface point between this voxel and a neighbor on the other side.
  [[nodiscard]] std::optional<Vec3> byBisection(const Vec3& p, double value) const noexcept {
    std::optional<Vec3> best;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        Vec3 q = p;
        q[axis] += side * voxel_;
        if ((field_.value(q) < 0.0) == (value < 0.0)) continue;
        Vec3 near = p;
        for (int i = 0; i < 30; ++i) {
          const Vec3 middle = 0.5 * (near + q);
          ((field_.value(middle) < 0.0) == (value < 0.0) ? near : q) = middle;
        }
        if (!best || glm::length(q - p) < glm::length(*best - p)) best = q;
      }
    }
    if (best) best = closest_.creptTo(p, *best);
    return best;
  }

  const Field& field_;
  const BandSource& source_;
  ClosestPoint closest_;
  double voxel_;
  Box3 asked_;  ///< [m] box of the voxels asked for
  double lipschitz_;
  Box3 domain_;
};

}  // namespace

ImplicitSurface findSurface(const Field& field, const Box3& domain, const BakePlan& plan,
                            const BakeOptions& options, const Progress& progress) {
  const BandSource source(field, domain, false, kSided * plan.voxel);
  // For a field that is much flatter than its Lipschitz bound, more cubes are kept than its surface
  // needs.
  constexpr double kMargin = 4.0;
  CubeSearch search(source, plan, 2.0 * kSided, kMargin);
  search.run(voxelRange(domain, plan, options.name), progress);
  const std::vector<CubeSearch::Cube>& cubes = search.cubes();
  const SurfaceFinder finder(field, source, domain, plan);
  std::vector<Found> found(cubes.size());
  std::atomic<bool> broken = false;
  parallelWithProgress(cubes.size(), progress, "bake: the surface", 0.0, 0.3, [&](std::size_t i) {
    finder.in(cubes[i], search.partOf(cubes[i]), found[i], broken);
  });
  if (broken) {
    throw inputError("bake.not_finite",
                     "the field of '" + options.name + "' is not a number somewhere in its bounds");
  }
  ImplicitSurface surface;
  for (Found& one : found) {
    if (std::any_of(one.sides.known.begin(), one.sides.known.end(),
                    [](std::uint64_t word) { return word != 0; })) {
      surface.leaves.push_back(one.sides);
    }
    surface.feet.insert(surface.feet.end(), one.feet.begin(), one.feet.end());
  }
  return surface;
}

}  // namespace palpate::vdb
