// RayMarch: identifies the surfaces that a ray meets.

#include <algorithm>
#include <bit>
#include <cmath>

#include "palpate/interior/port_machine.h"
#include "picture/palette.h"
#include "picture/ray_march.h"

namespace palpate::tools {
namespace {

constexpr int kHalvings = 12;
constexpr double kFine = 0.01;  // [pixels] error of the place of a surface, if kHalvings are enough
// Share of ink in the color of surfaces that belong to no region
constexpr double kSheetInk = 0.25;
constexpr int kFirstSheet =
    -2;  // `part` of a hit on the first sheet; further sheets count down from it
// Slices count down likewise
constexpr int kFirstSlice = kFirstSheet - static_cast<int>(kMostSheets);
constexpr int kMostRegions = 65536;

}  // namespace

std::optional<RayMarch::Surface> RayMarch::slice(std::size_t index, RegionId region,
                                                 const Vec3& p) const {
  if (region == kOutside && !space_.paint.isInImage(p)) return {};
  const Color color = lined(space_.paint.at(region, p), p, space_.slices[index].normal());
  return Surface{scaled(color, kFlatShade), 1.0,
                 kFirstSlice - static_cast<int>(index) * kMostRegions - region};
}

Color RayMarch::lined(const Color& color, const Vec3& p, const Vec3& normal) const {
  if (space_.lines == nullptr) return color;
  return mixed(color, kInk, space_.lines->inkAt(p, normal, camera_.step));
}

RayMarch::Surface RayMarch::surface(const Vec3& origin, double before, double& after) {
  const Partition& partition = space_.scene.partition();
  const RegionId from = partition.regionOf(*here_);
  double low = std::min(before, after);
  double high = after;
  for (int i = 0; i < kHalvings && high - low > kFine * camera_.step; ++i) {
    const double half = 0.5 * (low + high);
    probeAlong(origin, half, *middle_);
    if (*middle_ == *here_ || partition.regionOf(*middle_) == from) {
      low = half;
      std::swap(here_, middle_);
    } else {
      high = half;
      std::swap(there_, middle_);
    }
  }
  after = high;
  const RegionId inner = std::max(from, partition.regionOf(*there_));
  Surface met{{}, opacityOf(inner), 2 * inner + 1};
  if (met.opacity <= 0.0) return met;
  const Vec3 p = origin + high * way_;
  Vec3 normal = -way_;
  const auto leaves = partition.leaves();
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const auto leaf = static_cast<LeafId>(i);
    if (here_->inside(leaf) == there_->inside(leaf)) continue;
    normal = unitOr(leaves[i].field->sample(p).gradient, normal);
    break;
  }
  if (glm::dot(normal, way_) > 0.0) normal = -normal;  // two-sided
  met.color = space_.paint.of(inner);
  const Boundary crossed = classify(space_.scene, *here_, *there_);
  if (crossed.kind == Boundary::Kind::kPort) met.color = mixed(met.color, kPortInk, 0.35);
  if (crossed.kind == Boundary::Kind::kAbsent) met.color = mixed(met.color, kPaper, 0.4);
  met.color = scaled(met.color, shadeOf(normal, camera_));
  return met;
}

std::optional<RayMarch::Surface> RayMarch::sheet(const Vec3& origin, double before, double after) {
  const std::uint64_t inner = sheetSides(space_.scene, *here_).inner;
  std::uint64_t changed = inner ^ sheetSides(space_.scene, *there_).inner;
  for (; changed != 0; changed &= changed - 1) {
    const auto index = static_cast<std::size_t>(std::countr_zero(changed));
    const std::uint64_t bit = std::uint64_t{1} << index;
    double low = std::min(before, after);
    double high = after;
    SheetSides beyond = sheetSides(space_.scene, *there_);
    for (int i = 0; i < kHalvings && high - low > kFine * camera_.step; ++i) {
      const double half = 0.5 * (low + high);
      probeAlong(origin, half, *middle_);
      const SheetSides sides = sheetSides(space_.scene, *middle_);
      const bool is_before = ((sides.inner ^ inner) & bit) == 0;
      (is_before ? low : high) = half;
      if (!is_before) beyond = sides;
    }
    if ((beyond.extent & bit) == 0) continue;
    Vec3 normal = sheetNormal(index, origin + high * way_, -way_);
    if (glm::dot(normal, way_) > 0.0) normal = -normal;
    return Surface{scaled(mixed(kPaper, kWallInk, kSheetInk), shadeOf(normal, camera_)), 1.0,
                   kFirstSheet - static_cast<int>(index)};
  }
  return {};
}

/// Normal of the sheet at `p`: that of the leaf whose surface is nearest there.
Vec3 RayMarch::sheetNormal(std::size_t index, const Vec3& p, const Vec3& fallback) const {
  double nearest = kInfinity;
  Vec3 normal = fallback;
  for (const LeafId leaf : space_.scene.passages().sheets()[index].leaves) {
    const FieldSample sample = space_.scene.partition().leaves()[leaf].field->sample(p);
    if (std::abs(sample.value) >= nearest) continue;
    nearest = std::abs(sample.value);
    normal = unitOr(sample.gradient, fallback);
  }
  return normal;
}

}  // namespace palpate::tools
