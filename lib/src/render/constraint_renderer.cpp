#include "constraint_renderer.h"

#include <algorithm>
#include <cmath>

#include "start_point.h"

namespace palpate {
namespace {

constexpr int kMaxIterations = 24;
/// Creases looked for in a tick.
constexpr int kUnfoldsPerTick = 6;
/// From this iteration on, a normal that turned is reason enough to look for a crease.
constexpr int kPatience = 5;

}  // namespace

ConstraintRenderer::ConstraintRenderer(ScenePtr scene, const RendererSettings& settings)
    : HapticRenderer(*scene, settings.limits),
      scene_(std::move(scene)),
      walker_(*scene_),
      beneath_(*scene_) {}

void ConstraintRenderer::forget() noexcept {
  started_ = false;
  is_first_ = true;
  sticking_ = false;
  has_friction_ = false;
  lean_ = Vec3(0.0);
  walker_.forget();
  contact_ = {};
  piece_count_ = 0;
  branch_ = {};
  insertion_.reset();
}

TickResult ConstraintRenderer::step(const HipState& hip) noexcept {
  TickResult out;
  if (!started_) start(hip.position);
  walker_.beginTick();
  track(hip.position);
  fadeContent(hip.position);
  relax(hip.dt);

  out.proxy = walker_.position();
  out.region = walker_.region();
  out.contact = contact_.count > 0;
  out.event_count = walker_.eventCount();
  out.events = walker_.events();
  out.force = wallForce(hip.velocity) + contentForce(hip);
  return out;
}

void ConstraintRenderer::start(const Vec3& hip) noexcept {
  walker_.place(startPoint(*scene_, walker_, hip));
  started_ = true;
  if (walker_.position() == hip) return;
  // From there the nearest point is found as any other: with all that leads out of the region shut.
  walker_.seal(true);
  walker_.beginTick();
  track(hip);
  walker_.seal(false);
  sticking_ = false;
}

/// Brings the proxy to where |x - P| is smallest in its region, as far as one tick's budget goes.
void ConstraintRenderer::track(const Vec3& hip) noexcept {
  unfolds_left_ = kUnfoldsPerTick;
  bool has_slid = false;
  is_pressed_ = false;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    tick_begins_ = iteration == 0;
    findContact(hip);
    if (contact_.count == 0) {
      sticking_ = false;
      const Vec3 from = walker_.position();
      const CellWalker::Stop stop = walker_.move(hip, {}, false);
      if (stop == CellWalker::Stop::kArrived) return;
      // Blocked where it stands: what is left of the gap is no way to go.
      is_pressed_ = stop == CellWalker::Stop::kBlocked && walker_.position() == from;
      // A long way close to walls takes more than one sweep's budget; the tick's ends it.
      if (stop == CellWalker::Stop::kSpent && walker_.position() == from) break;
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
      if (!rest.is_saddle || !slideBy(hip, length * rest.downhill, true, contact_.walls())) return;
      continue;
    }
    if (has_slid && hasTurned(iteration >= kPatience) && unfold(hip, before_.position)) continue;
    before_.position = walker_.position();
    before_.leaf = contact_.leaf[contact_.index[0]];
    before_.normal = contact_.held[0].normal;
    if (!slide(hip)) {
      if (puncture()) continue;
      break;
    }
    has_slid = true;
  }
  findContact(hip);
}

/// Whether the wall that holds the proxy has turned since the slide before, more than it bends: then
/// that slide passed a crease. If impatient, however it bends.
bool ConstraintRenderer::hasTurned(bool impatient) const noexcept {
  const Contact& c = contact_;
  if (c.count != 1 || c.leaf[c.index[0]] != before_.leaf || c.held[0].probe != Vec3(0.0)) {
    return false;
  }
  const Vec3 turn = c.held[0].normal - before_.normal;
  if (glm::dot(turn, turn) < 1e-6) return false;
  const FieldJet& jet = c.held[0].jet;
  const Vec3 bend = jet.hessian * (walker_.position() - before_.position);
  return impatient || glm::length(turn) > 3.0 * glm::length(bend) / glm::length(jet.gradient);
}

}  // namespace palpate
