#include "constraint_renderer.h"

#include <algorithm>
#include <cmath>

#include "palpate/contact/surface_effects.h"
#include "start_point.h"

namespace palpate {
namespace {

constexpr int kMaxIterations = 24;
/// Walls within this many tolerances of the proxy take part in the local problem.
constexpr double kNear = 100.0;
/// The proxy has arrived when what is left to slide is this share of the depth: 6e-8 degree of the
/// force's direction.
constexpr double kSettled = 1e-9;
/// A slide ends within this share of where the kinetic cone holds it.
constexpr double kSticksWithin = 1e-6;
/// A slide that another sheet of the same wall stops within this share of the feature size got nowhere.
constexpr double kStuck = 1e-6;
/// Content is felt in full this far behind the facet it was entered through [m], so that hovering in a
/// mouth does not chatter.
constexpr double kFadeLength = 0.25e-3;

}  // namespace

double ConstraintRenderer::Contact::load() const noexcept {
  Vec3 sum(0.0);
  for (const HeldWall& wall : walls()) sum += wall.multiplier * wall.normal;
  return glm::length(sum);
}

ConstraintRenderer::ConstraintRenderer(ScenePtr scene, const RendererSettings& settings)
    : HapticRenderer(settings.limits, scene->startRegion()),
      scene_(std::move(scene)),
      walker_(*scene_) {}

void ConstraintRenderer::forget() noexcept {
  started_ = false;
  sticking_ = false;
  walker_.forget();
  contact_ = {};
}

TickResult ConstraintRenderer::step(const HipState& hip) noexcept {
  TickResult out;
  if (!started_) start(hip.position);
  walker_.beginTick();
  track(hip.position);

  out.proxy = walker_.position();
  out.region = walker_.region();
  out.contact = contact_.count > 0;
  out.event_count = walker_.eventCount();
  out.events = walker_.events();
  out.force = force(hip);
  return out;
}

void ConstraintRenderer::start(const Vec3& hip) noexcept {
  walker_.place(startPoint(*scene_, walker_, hip));
  started_ = true;
}

/// Brings the proxy to where |x - P| is smallest in its region, as far as one tick's budget goes.
void ConstraintRenderer::track(const Vec3& hip) noexcept {
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    tick_begins_ = iteration == 0;
    findContact(hip);
    if (contact_.count == 0) {
      sticking_ = false;
      const CellWalker::Stop stop = walker_.move(hip, {}, false);
      if (stop == CellWalker::Stop::kArrived) return;
      if (stop == CellWalker::Stop::kSpent) break;
      continue;
    }
    if (isSettled(hip)) {
      // Only at rest does the spring of the wall have the length that is felt: a tangent plane that one
      // tick's motion left behind may be pressed harder, and must not open what was never pressed so.
      if (puncture()) continue;
      // At rest by the first order; by the second it may still be able to come closer.
      if (sticking_ || !mayBeSaddle(contact_.walls())) return;
      const SlideStep rest = slideStep(contact_.pull, contact_.walls());
      const double length = 1e-3 * walker_.leaf(contact_.leaf[contact_.index[0]]).feature;
      if (!rest.is_saddle || !slideBy(hip, length * rest.downhill, true)) return;
      continue;
    }
    if (!slide(hip)) {
      if (puncture()) continue;
      break;
    }
  }
  findContact(hip);
}

void ConstraintRenderer::findContact(const Vec3& hip) noexcept {
  Contact& c = contact_;
  c.planes = 0;
  c.count = 0;
  c.sliding_count = 0;
  walker_.forNear(kNear, [&](LeafId leaf, double value, const Facet& facet) {
    if (!facet.isClosed() || c.planes == kMaxPlanes) return;
    const FieldJet& jet = walker_.jetHere(leaf);
    const double slope = glm::length(jet.gradient);
    if (!(slope > 0.0)) return;
    c.leaf[c.planes] = leaf;
    c.facet[c.planes] = facet;
    c.jet[c.planes] = jet;
    c.plane[c.planes] = {walker_.side(leaf) / slope * jet.gradient, value / slope};
    ++c.planes;
  });
  const Vec3 wish = hip - walker_.position();
  const PlaneSolution solution = closestStep(wish, std::span(c.plane.data(), c.planes));
  c.step = solution.step;
  for (int i = 0; i < solution.count; ++i) {
    const auto k = static_cast<std::size_t>(solution.plane[static_cast<std::size_t>(i)]);
    const double multiplier = solution.multiplier[static_cast<std::size_t>(i)];
    if (!(multiplier > 0.0)) continue;
    HeldWall& wall = c.held[c.count];
    wall.field = walker_.leaf(c.leaf[k]).field.get();
    wall.side = walker_.side(c.leaf[k]);
    wall.tolerance = walker_.tolerance(c.leaf[k]);
    wall.jet = c.jet[k];
    wall.normal = c.plane[k].normal;
    wall.multiplier = multiplier;
    c.index[c.count] = k;
    ++c.count;
  }
  // Walls parallel to a held one are the same wall twice.
  for (std::size_t k = 0; k < c.planes; ++k) {
    for (const HeldWall& wall : c.walls()) {
      if (glm::dot(wall.normal, c.plane[k].normal) > 1.0 - 1e-6) {
        c.sliding[c.sliding_count++] = c.leaf[k];
        break;
      }
    }
  }
  c.pull = tangentialPart(wish, c.walls());
  c.lag = Vec3(0.0);
  if (c.count > 0) holdByFriction();
}

/// The cone: while it sticks the proxy may lag by static_ratio of the load, else it slides until it lags
/// by kinetic_ratio of it.
void ConstraintRenderer::holdByFriction() noexcept {
  Contact& c = contact_;
  Friction friction;
  for (std::size_t i = 0; i < c.count; ++i) {
    const Friction& own = wallMaterial(c.facet[c.index[i]]).friction;
    friction.static_ratio = std::max(friction.static_ratio, own.static_ratio);
    friction.kinetic_ratio = std::max(friction.kinetic_ratio, own.kinetic_ratio);
  }
  if (friction.static_ratio <= 0.0) return;
  const double pull = glm::length(c.pull);
  const double load = c.load();
  const double kinetic = friction.kinetic_ratio * load;
  if (sticking_ && pull > friction.static_ratio * load) sticking_ = false;
  // What slides sticks again when the hand no longer pulls it on, which shows when a tick begins: at the
  // end of its own slide it is always where the cone just holds it, and a hand that moves on would
  // feel a saw.
  if (!sticking_ && tick_begins_ && pull <= kinetic * (1.0 + kSticksWithin)) sticking_ = true;
  c.lag = sticking_ || pull <= kinetic ? c.pull : c.pull * (kinetic / pull);
  c.pull -= c.lag;
}

bool ConstraintRenderer::puncture() noexcept {
  const Contact& c = contact_;
  for (std::size_t i = 0; i < c.count; ++i) {
    const Facet& facet = c.facet[c.index[i]];
    if (facet.opens_at <= 0.0) continue;
    const double elastic = wallMaterial(facet).stiffness * c.held[i].multiplier;
    if (elastic >= facet.opens_at) {
      walker_.cross(c.leaf[c.index[i]], facet);
      return true;
    }
  }
  return false;
}

bool ConstraintRenderer::isSettled(const Vec3& hip) const noexcept {
  const double depth = glm::length(hip - walker_.position());
  return glm::length(contact_.pull) <= kSettled * depth && isOnWalls();
}

bool ConstraintRenderer::isOnWalls() const noexcept {
  for (std::size_t i = 0; i < contact_.count; ++i) {
    const std::size_t k = contact_.index[i];
    const double slack =
        walker_.tolerance(contact_.leaf[k]) / walker_.leaf(contact_.leaf[k]).lipschitz;
    if (std::fabs(contact_.plane[k].gap) > 2.0 * slack) return false;
  }
  return true;
}

bool ConstraintRenderer::slide(const Vec3& hip) noexcept {
  const SlideStep newton = slideStep(contact_.pull, contact_.walls());
  Vec3 by = newton.step;
  // Newton looks at the held walls only; where another wall is at hand, the first-order step respects it.
  for (std::size_t k = 0; k < contact_.planes; ++k) {
    const Plane& plane = contact_.plane[k];
    if (glm::dot(plane.normal, by) < -plane.gap - 1e-12 * glm::length(by) &&
        std::find(contact_.sliding.begin(),
                  contact_.sliding.begin() + static_cast<std::ptrdiff_t>(contact_.sliding_count),
                  contact_.leaf[k]) ==
            contact_.sliding.begin() + static_cast<std::ptrdiff_t>(contact_.sliding_count)) {
      by = contact_.pull;
      break;
    }
  }
  for (int halving = 0; halving < 12; ++halving) {
    if (slideBy(hip, by, true)) return true;
    by *= 0.5;
  }
  // Nothing along the wall comes closer: only settle onto it, where it is not there yet.
  return !isOnWalls() && slideBy(hip, Vec3(0.0), false);
}

/// Moves along the held walls by about `by`, on a path that stays on the free side of them. False if
/// that would not come closer (then nothing moved).
bool ConstraintRenderer::slideBy(const Vec3& hip, const Vec3& by, bool must_improve) noexcept {
  const Contact& c = contact_;
  const Vec3 x = walker_.position();
  const Vec3 ahead = x + by;
  Vec3 landed = ahead;
  bool above = true;
  if (!pullBack(landed, c.walls(), above)) return false;
  if (must_improve) {
    // With friction the aim is not P but the point that lags behind it by what the cone holds.
    const Vec3 aim = hip - c.lag;
    const Vec3 before = x - aim;
    const Vec3 after = landed - aim;
    double sunk = 0.0;  // a proxy beyond the wall, by rounding, looks closer than it may be
    for (std::size_t i = 0; i < c.count; ++i) {
      sunk = std::max(sunk, std::fabs(c.plane[c.index[i]].gap));
    }
    const double limit = glm::dot(before, before) + 4.0 * sunk * glm::length(before);
    if (glm::dot(after, after) > limit * (1.0 + 1e-13)) return false;
  }
  const std::span<const LeafId> sliding(c.sliding.data(), c.sliding_count);
  // The wall that holds the proxy may stand in its way as well, further on.
  bool is_clipped = false;
  const auto go = [&](const Vec3& from, const Vec3& to) {
    double share = 1.0;
    for (const LeafId leaf : sliding) share = std::min(share, walker_.freeShare(leaf, from, to));
    const CellWalker::Stop stop = walker_.move(from + share * (to - from), sliding, true);
    is_clipped = share < 1.0 && stop == CellWalker::Stop::kArrived;
    return stop == CellWalker::Stop::kArrived && !is_clipped;
  };
  if (!must_improve) {
    (void)walker_.move(landed, sliding, true);
    return true;
  }
  // Over a bulge the tangent runs in the open and comes down; in a hollow the chord is the open way.
  if (!above || go(x, ahead)) (void)go(walker_.position(), landed);
  const double moved = glm::length(walker_.position() - x);
  return !is_clipped || moved > kStuck * walker_.leaf(c.leaf[c.index[0]]).feature;
}

double ConstraintRenderer::contentShare() const noexcept {
  if (walker_.mouth() < 0) return 1.0;
  const FieldSample s =
      walker_.leaf(static_cast<LeafId>(walker_.mouth())).field->sample(walker_.position());
  const double slope = s.in_band ? glm::length(s.gradient) : 1.0;
  const double behind = slope > 0.0 ? std::fabs(s.value) / slope : kFadeLength;
  return std::min(1.0, behind / kFadeLength);
}

Vec3 ConstraintRenderer::force(const HipState& hip) const noexcept {
  const Contact& c = contact_;
  Vec3 force(0.0);
  if (c.count > 0) {
    double total = 0.0;
    double stiffness = 0.0;
    double damping = 0.0;
    Vec3 outward(0.0);
    for (std::size_t i = 0; i < c.count; ++i) {
      const Material& wall = wallMaterial(c.facet[c.index[i]]);
      const HeldWall& held = c.held[i];
      const double multiplier = held.multiplier;
      const Vec3& x = walker_.position();
      const Vec3 n = wall.shading > 0.0
                         ? shadedNormal(*held.field, held.side, x, held.normal, wall.shading)
                         : held.normal;
      force += wall.stiffness * (multiplier + textureHeight(wall.texture, x, multiplier)) * n;
      outward += multiplier * held.normal;
      total += multiplier;
      stiffness += wall.stiffness * multiplier;
      damping += wall.damping * multiplier;
    }
    stiffness /= total;
    damping /= total;
    force -= stiffness * c.lag + damping * hip.velocity;
    // A wall never pulls the hand towards itself.
    const Vec3 n = unitOr(outward, Vec3(0.0));
    const double along = glm::dot(force, n);
    if (along < 0.0) force -= along * n;
  }
  const int content = scene_->regions()[walker_.region()].content;
  if (content >= 0) {
    const Material& medium = scene_->materials()[static_cast<std::size_t>(content)];
    if (medium.viscosity > 0.0) {
      force -= contentShare() * medium.viscosity * (hip.velocity - medium.flow);
    }
  }
  return force;
}

}  // namespace palpate
