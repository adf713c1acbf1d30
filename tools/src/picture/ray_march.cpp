#include "picture/ray_march.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "palpate/interior/port_machine.h"
#include "picture/palette.h"

namespace palpate::tools {
namespace {

constexpr double kAmbient = 0.42;
constexpr double kFaceShade = 0.97;
constexpr int kMostSteps = 4000;
constexpr int kHalvings = 12;
constexpr double kFlat = 1e-9;      // a ray that runs along the cut
constexpr double kGone = 0.01;      // share of light behind which nothing is seen
constexpr double kSheetInk = 0.25;  // share of ink in what belongs to no region
constexpr int kFirstSheet =
    -2;  // part of a hit on the first sheet; those of the others go down from it

/// The part of a ray within a box, as distances along it.
std::optional<std::pair<double, double>> within(const Box3& box, const Vec3& origin,
                                                const Vec3& way) {
  double enter = -kInfinity;
  double leave = kInfinity;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(way[i]) < 1e-12) {
      if (origin[i] < box.lo[i] || origin[i] > box.hi[i]) return {};
      continue;
    }
    const double a = (box.lo[i] - origin[i]) / way[i];
    const double b = (box.hi[i] - origin[i]) / way[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (!(enter < leave)) return {};
  return std::pair{enter, leave};
}

/// Colors over one another, from the front to the back.
struct Layers {
  Color sum{0.0, 0.0, 0.0, 1.0};
  double through = 1.0;

  void add(const Color& color, double opacity) {
    const double share = through * opacity;
    sum.r += share * color.r;
    sum.g += share * color.g;
    sum.b += share * color.b;
    through *= 1.0 - opacity;
  }
};

}  // namespace

double shadeOf(const Vec3& normal, const Camera& camera) {
  const Vec3 light = glm::normalize(camera.toward + 0.6 * camera.up - 0.5 * camera.right);
  return kAmbient + (1.0 - kAmbient) * std::clamp(glm::dot(normal, light), 0.0, 1.0);
}

RayMarch::RayMarch(const SpaceScene& space, const Camera& camera)
    : space_(space),
      camera_(camera),
      here_(space.scene.partition().leaves().size()),
      there_(here_),
      middle_(here_),
      way_(-camera.toward),
      has_sheets_(!space.scene.passages().sheets().empty()) {
  for (const Leaf& leaf : space.scene.partition().leaves()) bounds_.push_back(leaf.field->bounds());
  begin_ = glm::dot(space.box.center() - camera.center, way_) - 0.5 * glm::length(space.box.size());
}

double RayMarch::probe(const Vec3& p, Signs& out) const {
  double safe = kInfinity;
  const auto leaves = space_.scene.partition().leaves();
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const double away = bounds_[i].distanceTo(p);
    if (away > 0.0) {  // outside a leaf's box it is not worth a look
      out.set(static_cast<LeafId>(i), false);
      safe = std::min(safe, away);
      continue;
    }
    const double value = leaves[i].field->value(p);
    out.set(static_cast<LeafId>(i), value < 0.0);
    safe = std::min(safe, std::abs(value) / leaves[i].lipschitz);
  }
  return safe;
}

double RayMarch::advance(double safe) const {
  return std::max(std::isfinite(safe) ? safe : 0.0, 0.5 * camera_.step);
}

double RayMarch::opacityOf(RegionId region) const {
  return region < space_.opacity.size() ? space_.opacity[region] : 1.0;
}

double RayMarch::freeWay(double x, double y, double radius) {
  const Vec3 origin = camera_.world(x, y) + begin_ * way_;
  const double around = radius * camera_.step;
  const double most = glm::length(space_.box.size());
  double way = 0.0;
  while (way < most) {
    const double safe = probe(origin + way * way_, here_);
    if (space_.scene.partition().regionOf(here_) != kOutside) return 0.0;
    // The ball of `safe` around the point holds the rays' next stretch.
    if (!(safe > 1.5 * around)) break;
    way += std::isfinite(safe) ? safe - around : most;
  }
  return std::min(way, most);
}

Hit RayMarch::cast(double x, double y, double free) {
  const Vec3 origin = camera_.world(x, y);
  const auto part = within(space_.box, origin, way_);
  if (!part) return {};
  double t = part->first;
  double end = part->second;
  double cut = -kInfinity;
  if (space_.plane) {
    const double facing = glm::dot(way_, space_.plane->normal());
    const double height = glm::dot(origin - space_.plane->point, space_.plane->normal());
    if (facing < -kFlat) {  // into what is kept
      cut = -height / facing;
      t = std::max(t, cut);
    } else if (facing > kFlat) {
      end = std::min(end, -height / facing);
    } else if (height > 0.0) {
      return {};
    }
  }
  t = std::max(t, begin_ + free);
  if (t >= end) return {};

  Layers layers;
  Hit hit;
  const auto meet = [&](const Surface& met) {
    if (hit.part == -1) {
      hit.part = met.part;
      hit.opacity = met.opacity;
    }
    layers.add(met.color, met.opacity);
  };
  double step = probe(origin + t * way_, here_);
  RegionId region = space_.scene.partition().regionOf(here_);
  if (region != kOutside) {
    const Vec3 p = origin + t * way_;
    const bool is_face = t == cut;
    const Color color = space_.paint.at(region, p);
    if (is_face) {
      hit.color = scaled(color, kFaceShade);
      hit.part = 2 * region;
      hit.sides = sheetSides(space_.scene, here_);
      return hit;
    }
    // The box cuts an endless layer.
    meet({scaled(color, shadeOf(-way_, camera_)), opacityOf(region), 2 * region + 1});
  }
  double before = t;
  t += advance(step);
  for (int i = 0; i < kMostSteps && t < end && layers.through > kGone; ++i) {
    step = probe(origin + t * way_, there_);
    const RegionId next = space_.scene.partition().regionOf(there_);
    if (next != region) {
      meet(surface(origin, before, t));
      region = space_.scene.partition().regionOf(there_);
      step = 0.0;
    } else if (has_sheets_ && here_ != there_) {
      if (const auto met = sheet(origin, before, t)) meet(*met);
    }
    std::swap(here_, there_);
    before = t;
    t += advance(step);
  }
  layers.add(rgb(0xFFFFFF), 1.0);
  hit.color = layers.sum;
  return hit;
}

RayMarch::Surface RayMarch::surface(const Vec3& origin, double before, double& after) {
  const Partition& partition = space_.scene.partition();
  const RegionId from = partition.regionOf(here_);
  double low = std::min(before, after);
  double high = after;
  for (int i = 0; i < kHalvings; ++i) {
    const double half = 0.5 * (low + high);
    probe(origin + half * way_, middle_);
    if (partition.regionOf(middle_) == from) {
      low = half;
      std::swap(here_, middle_);
    } else {
      high = half;
      std::swap(there_, middle_);
    }
  }
  after = high;
  const RegionId inner = std::max(from, partition.regionOf(there_));
  Surface met{{}, opacityOf(inner), 2 * inner + 1};
  if (met.opacity <= 0.0) return met;
  const Vec3 p = origin + high * way_;
  Vec3 normal = -way_;
  const auto leaves = partition.leaves();
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const auto leaf = static_cast<LeafId>(i);
    if (here_.inside(leaf) == there_.inside(leaf)) continue;
    normal = unitOr(leaves[i].field->sample(p).gradient, normal);
    break;
  }
  if (glm::dot(normal, way_) > 0.0) normal = -normal;  // two-sided
  met.color = space_.paint.of(inner);
  const Boundary crossed = classify(space_.scene, here_, there_);
  if (crossed.kind == Boundary::Kind::kPort) met.color = mixed(met.color, kPortInk, 0.35);
  if (crossed.kind == Boundary::Kind::kAbsent) met.color = mixed(met.color, kPaper, 0.4);
  met.color = scaled(met.color, shadeOf(normal, camera_));
  return met;
}

std::optional<RayMarch::Surface> RayMarch::sheet(const Vec3& origin, double before, double after) {
  const std::uint64_t inner = sheetSides(space_.scene, here_).inner;
  std::uint64_t changed = inner ^ sheetSides(space_.scene, there_).inner;
  for (; changed != 0; changed &= changed - 1) {
    const auto index = static_cast<std::size_t>(std::countr_zero(changed));
    const std::uint64_t bit = std::uint64_t{1} << index;
    double low = std::min(before, after);
    double high = after;
    SheetSides beyond = sheetSides(space_.scene, there_);
    for (int i = 0; i < kHalvings; ++i) {
      const double half = 0.5 * (low + high);
      probe(origin + half * way_, middle_);
      const SheetSides sides = sheetSides(space_.scene, middle_);
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

/// Of the sheet at `p`: of the leaf whose surface is nearest there.
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
