#include "accuracy/points.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

namespace palpate::tools {
namespace {

constexpr std::uint64_t kSeed = 20260101;
constexpr double kFinestCells = 256.0;  ///< along the longest side
constexpr std::size_t kReportEvery = 4096;

/// Gives the same numbers everywhere, which std's distributions do not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  [[nodiscard]] double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
  [[nodiscard]] Vec3 inCube() {
    const double x = unit();
    const double y = unit();
    return {x, y, unit()};
  }
  [[nodiscard]] std::size_t below(std::size_t count) {
    return std::min(static_cast<std::size_t>(unit() * static_cast<double>(count)), count - 1);
  }

 private:
  std::mt19937_64 engine_;
};

/// Equal cubes that together contain all points within `band` of the surface.
struct Cells {
  std::vector<Vec3> lower;  ///< [m] corners
  double side = 0.0;        ///< [m]
};

Cells cellsNear(const Field& field, double band, const Progress& progress) {
  const Box3 box = field.bounds().grownBy(band);
  const Vec3 size = box.size();
  Cells cells;
  cells.side = std::max({size.x, size.y, size.z});
  const double finest = std::max(2.0 * band, cells.side / kFinestCells);
  cells.lower = {box.lo};
  const Box3 domain = field.lipschitzDomain();
  while (cells.side > finest) {
    report(progress, "finding the surface", 0.0);
    cells.side *= 0.5;
    const double reach = 0.5 * std::sqrt(3.0) * cells.side + band;
    std::vector<Vec3> kept;
    for (const Vec3& corner : cells.lower) {
      for (int n = 0; n < 8; ++n) {
        const Vec3 lower = corner + cells.side * Vec3(n >> 2, (n >> 1) & 1, n & 1);
        const Vec3 center = lower + Vec3(0.5 * cells.side);
        const bool known =
            domain.contains(center - Vec3(reach)) && domain.contains(center + Vec3(reach));
        // |S| is at most L times the distance to the surface.
        if (!known || std::fabs(field.value(center)) <= field.lipschitz() * reach) {
          kept.push_back(lower);
        }
      }
    }
    cells.lower = std::move(kept);
  }
  return cells;
}

Error noSurface() {
  return inputError("accuracy.no_surface", "no point near the surface was found",
                    "is the shape empty, or smaller than the voxels?");
}

/// A unit vector perpendicular to `normal`, turned by `angle` about it.
Vec3 tangentAt(const Vec3& normal, double angle) {
  const Vec3 least = std::fabs(normal.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
  const Vec3 first = glm::normalize(glm::cross(normal, least));
  return std::cos(angle) * first + std::sin(angle) * glm::cross(normal, first);
}

}  // namespace

PointSet pointsNear(const Truth& truth, double band, std::size_t count, double voxel,
                    const Progress& progress) {
  const Field& field = truth.field();
  const Cells cells = cellsNear(field, band, progress);
  if (cells.lower.empty()) throw noSurface();
  Random random(kSeed);
  PointSet out;
  out.points.reserve(count);
  const std::size_t most_tries = 1000 * count + 100000;
  for (std::size_t tries = 0; out.points.size() < count; ++tries) {
    if (tries % kReportEvery == 0) {
      report(progress, "choosing points",
             static_cast<double>(out.points.size()) / static_cast<double>(count));
    }
    if (tries == most_tries) break;
    const Vec3& corner = cells.lower[random.below(cells.lower.size())];
    const Vec3 p = corner + cells.side * random.inCube();
    if (std::fabs(field.value(p)) > field.lipschitz() * band) continue;
    const std::optional<TruePoint> found = truth.at(p);
    if (!found) {
      ++out.without_truth;
      continue;
    }
    if (std::fabs(found->value) > band) continue;
    out.points.push_back({p, *found, isSmoothAround(field, p, voxel)});
  }
  if (out.points.empty()) throw noSurface();
  return out;
}

std::vector<Stroke> strokesAlong(const Truth& truth, const PointSet& from, std::size_t strokes,
                                 std::size_t length, double step, double voxel,
                                 const Progress& progress) {
  const Field& field = truth.field();
  Random random(kSeed + 1);
  std::vector<Stroke> out;
  for (std::size_t i = 0; i < std::min(strokes, from.points.size()); ++i) {
    report(progress, "stroking", static_cast<double>(i) / static_cast<double>(strokes));
    Stroke stroke;
    Vec3 heading(0.0);
    std::optional<Vec3> at = truth.onSurface(from.points[i].at);
    while (at && stroke.points.size() < length) {
      const auto found = truth.at(*at);
      if (!found) break;
      stroke.points.push_back({*at, *found, isSmoothAround(field, *at, voxel)});
      const Vec3 normal = found->normal;
      if (stroke.points.size() == 1) {
        heading = tangentAt(normal, 2.0 * 3.14159265358979324 * random.unit());
      }
      heading = unitOr(heading - glm::dot(heading, normal) * normal, tangentAt(normal, 0.0));
      at = truth.onSurface(*at + step * heading);
    }
    if (stroke.points.size() >= 3) out.push_back(std::move(stroke));
  }
  return out;
}

}  // namespace palpate::tools
