#include "picture/ray_march.h"

#include <algorithm>
#include <cmath>

#include "palpate/interior/port_machine.h"
#include "picture/palette.h"

namespace palpate::tools {
namespace {

constexpr double kAmbient = 0.44;
constexpr double kSky = 0.12;   // share of the light: from all of the upper side
constexpr double kWrap = 0.25;  // share of the lamp's light that gets around the edge of a shade,
                                // because the lamp is not a point
constexpr int kMostSteps = 4000;
// Most steps of rays together; rays that creep along a surface gain little from more
constexpr int kMostFree = 500;
constexpr double kFlat = 1e-9;  // below this a ray runs along the cut
constexpr double kGone = 0.01;  // share of light below which nothing behind is seen

/// The part of a ray within a box, as two distances along it.
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

/// Blends colors over one another, from front to back.
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
  const Vec3 lamp = glm::normalize(camera.toward + 0.6 * camera.up - 0.5 * camera.right);
  const double direct = std::clamp((glm::dot(normal, lamp) + kWrap) / (1.0 + kWrap), 0.0, 1.0);
  const double sky = 0.5 + 0.5 * glm::dot(normal, camera.up);
  return kAmbient + (1.0 - kAmbient - kSky) * direct + kSky * sky;
}

RayMarch::RayMarch(const SpaceScene& space, const Camera& camera)
    : space_(space),
      camera_(camera),
      way_(-camera.toward),
      has_sheets_(!space.scene.passages().sheets().empty()) {
  for (Signs& signs : signs_) signs = Signs(space.scene.partition().leaves().size());
  for (const Leaf& leaf : space.scene.partition().leaves()) bounds_.push_back(leaf.field->bounds());
  spans_.resize(bounds_.size());
  begin_ = glm::dot(space.box.center() - camera.center, way_) - 0.5 * glm::length(space.box.size());
}

double RayMarch::probe(const Vec3& p, Signs& out) const {
  double safe = kInfinity;
  const auto leaves = space_.scene.partition().leaves();
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const double away = bounds_[i].distanceTo(p);
    if (away > 0.0) {  // no need to evaluate a leaf outside its box
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

void RayMarch::findSpans(const Vec3& origin) {
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    const auto span = within(bounds_[i], origin, way_);
    spans_[i] = span.value_or(std::pair{kInfinity, -kInfinity});
  }
  looks_.assign(bounds_.size(), {});
}

RayMarch::Reach RayMarch::probeAlong(const Vec3& origin, double t, Signs& out) {
  const Vec3 p = origin + t * way_;
  Reach reach;
  const auto leaves = space_.scene.partition().leaves();
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const auto leaf = static_cast<LeafId>(i);
    const auto [enter, leave] = spans_[i];
    Look& look = looks_[i];
    if (t < enter || t > leave) {
      out.set(leaf, false);
      if (t < enter) {
        look = {enter, 0.0, 0.0, false};
        reach.safe = std::min(reach.safe, enter - t);
        reach.likely = std::min(reach.likely, enter - t);
      }
      continue;
    }
    if (!(std::abs(t - look.at) < look.safe)) {
      const double value = leaves[i].field->value(p);
      const double size = std::abs(value);
      const double lipschitz = leaves[i].lipschitz;
      const double known = look.at + look.safe;
      // A slope of about 1 leaves enough behind for the two looks to meet.
      look = {t, size / lipschitz, 2.0 * size / (lipschitz + 1.0), value < 0.0};
      if (t - look.safe > known) reach.is_certain = false;
    }
    out.set(leaf, look.is_inside);
    reach.safe = std::min(reach.safe, look.at + look.safe - t);
    reach.likely = std::min(reach.likely, look.at + look.likely - t);
  }
  return reach;
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
  here_->clear();
  for (int i = 0; i < kMostFree && way < most; ++i) {
    const double safe = probe(origin + way * way_, *there_);
    const bool is_known = way > 0.0 && *here_ == *there_;
    if (!is_known && space_.scene.partition().regionOf(*there_) != kOutside) return 0.0;
    std::swap(here_, there_);
    // The rays' next step must lie within the ball of radius `safe` around the point.
    if (!(safe > 1.5 * around)) break;
    way += std::isfinite(safe) ? safe - around : most;
  }
  return std::min(way, most);
}

std::optional<RayMarch::Stretch> RayMarch::stretchOf(const Vec3& origin) const {
  const auto part = within(space_.box, origin, way_);
  if (!part) return {};
  Stretch out{part->first, part->second};
  if (space_.plane) {
    const double facing = glm::dot(way_, space_.plane->normal());
    const double height = glm::dot(origin - space_.plane->point, space_.plane->normal());
    if (facing < -kFlat) {  // towards the side that is kept
      out.cut = -height / facing;
      out.begin = std::max(out.begin, out.cut);
    } else if (facing > kFlat) {
      out.end = std::min(out.end, -height / facing);
    } else if (height > 0.0) {
      return {};
    }
  }
  if (out.begin >= out.end) return {};
  return out;
}

void RayMarch::findSlices(const Vec3& origin, const Stretch& way) {
  slices_.clear();
  for (std::size_t i = 0; i < space_.slices.size(); ++i) {
    const CutPlane& plane = space_.slices[i];
    const double facing = glm::dot(way_, plane.normal());
    if (std::abs(facing) < kFlat) continue;
    const double at = glm::dot(plane.point - origin, plane.normal()) / facing;
    if (at > way.begin && at < way.end) slices_.emplace_back(at, i);
  }
  std::sort(slices_.rbegin(), slices_.rend());
}

Hit RayMarch::cast(double x, double y, double free) {
  const Vec3 origin = camera_.world(x, y);
  const auto way = stretchOf(origin);
  return way ? march(origin, *way, free) : Hit{};
}

double RayMarch::lightFrom(const Vec3& p, double margin) {
  const double depth = glm::dot(p - camera_.center, way_);
  const Vec3 origin = p - depth * way_;
  auto way = stretchOf(origin);
  if (!way) return 1.0;
  way->end = std::min(way->end, depth - margin);
  return way->begin < way->end ? march(origin, *way, 0.0).through : 1.0;
}

Hit RayMarch::march(const Vec3& origin, Stretch way, double free) {
  findSlices(origin, way);
  findSpans(origin);
  double t = std::max(way.begin, begin_ + free);
  if (!slices_.empty()) t = std::max(way.begin, std::min(t, slices_.back().first));
  if (t >= way.end) return {};

  Layers layers;
  Hit hit;
  const auto meet = [&](const Surface& met) {
    if (hit.part == -1) {
      hit.part = met.part;
      hit.opacity = met.opacity;
    }
    layers.add(met.color, met.opacity);
  };
  Reach reach = probeAlong(origin, t, *here_);
  RegionId region = space_.scene.partition().regionOf(*here_);
  if (region != kOutside) {
    const Vec3 p = origin + t * way_;
    const bool is_face = t == way.cut;
    const Color color = space_.paint.at(region, p);
    if (is_face) {
      hit.color = scaled(lined(color, p, space_.plane->normal()), kFlatShade);
      hit.part = 2 * region;
      hit.sides = sheetSides(space_.scene, *here_);
      hit.through = 0.0;
      return hit;
    }
    // The box cuts an unbounded layer.
    meet({scaled(color, shadeOf(-way_, camera_)), opacityOf(region), 2 * region + 1});
  }
  double before = t;
  t += advance(reach.likely);
  for (int i = 0; i < kMostSteps && before < way.end && layers.through > kGone; ++i) {
    bool is_slice = !slices_.empty() && slices_.back().first <= t;
    if (is_slice) t = slices_.back().first;
    if (t >= way.end) break;
    const double certain = before + advance(reach.safe);
    reach = probeAlong(origin, t, *there_);
    if (!reach.is_certain && t > certain) {
      t = certain;
      is_slice = false;
      reach = probeAlong(origin, t, *there_);
    }
    const bool is_same = *here_ == *there_;
    if (!is_same && space_.scene.partition().regionOf(*there_) != region) {
      meet(surface(origin, before, t));
      region = space_.scene.partition().regionOf(*there_);
      reach = {0.0, 0.0};
    } else {
      if (has_sheets_ && !is_same) {
        if (const auto met = sheet(origin, before, t)) meet(*met);
      }
      if (is_slice) {
        if (const auto met = slice(slices_.back().second, region, origin + t * way_)) meet(*met);
        slices_.pop_back();
      }
    }
    std::swap(here_, there_);
    before = t;
    t += advance(reach.likely);
  }
  hit.through = layers.through;
  layers.add(rgb(0xFFFFFF), 1.0);
  hit.color = layers.sum;
  return hit;
}

}  // namespace palpate::tools
