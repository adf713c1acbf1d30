#include "palpate/render/insertion.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

/// The friction of `material` along a shaft at `p` [m].
ShaftLaw shaftLaw(const Material& material, const Vec3& p) noexcept {
  const ShaftFriction& shaft = material.shaft;
  const auto way = [&](const ShaftFriction::Way& own) {
    return ShaftLaw::Way{own.static_force.at(p), own.kinetic_force.at(p), own.damping.at(p)};
  };
  return {way(shaft.in), way(shaft.out), shaft.stiffness, shaft.stick_speed};
}

/// The cutting resistance [N] of the content of `region` on a tip at `tip` [m].
Vec3 cutForce(const Contents& contents, RegionId region, Cut& cut, const Vec3& tip) noexcept {
  const Material* tissue = contents.material(region);
  if (tissue == nullptr || !contents.holdsNeedle(region)) return Vec3(0.0);
  return cut.step(tip, tissue->stiffness.at(cut.end()), contents.cutting(region, tip));
}

}  // namespace

bool Insertion::isOf(std::size_t regions) const noexcept {
  if (count_ > kMaxLayers || cut_count_ > kMaxCuts || next_cut_ >= kMaxCuts) return false;
  const auto is_layer = [&](const Layer& layer) {
    return layer.from < regions && layer.region < regions && isFinite(layer.normal) &&
           isFinite(layer.cut.entry()) && isFinite(layer.cut.end()) &&
           std::isfinite(layer.slip.stretch()) && isFinite(layer.channel.direction()) &&
           std::isfinite(layer.channel.moment());
  };
  const auto is_cut = [&](const Remembered& cut) {
    return cut.region < regions && isFinite(cut.cut.entry()) && isFinite(cut.cut.end());
  };
  return region_ < regions && isFinite(tip_) && isFinite(velocity_) && isFinite(felt_) &&
         isFinite(beyond_) && std::isfinite(stored_) && std::isfinite(reach_) &&
         std::all_of(layers_.begin(), layers_.begin() + static_cast<std::ptrdiff_t>(count_),
                     is_layer) &&
         std::all_of(cuts_.begin(), cuts_.begin() + static_cast<std::ptrdiff_t>(cut_count_),
                     is_cut);
}

Insertion::Force Insertion::step(const Contents& contents, const Tick& tick) noexcept {
  if (!started_) {
    started_ = true;
    tip_ = tick.tip;
    region_ = tick.entries.empty() ? tick.region : tick.entries.front().from;
  }
  velocity_ = tick.velocity;
  for (RegionEntry& entry : tick.entries) cross(contents, entry);
  if (tick.region != region_) {
    // There were more entries than a tick has room for.
    RegionEntry rest{.from = region_, .to = tick.region, .point = tip_};
    cross(contents, rest);
  }

  if (count_ == 0 && !is_lost_ && contents.holdsNeedle(region_)) {
    // The needle began inside, or the content was changed and holds needles now: treat it as just
    // entered.
    push({.from = region_, .to = region_, .point = tick.tip}, contents.sameWay());
  }

  if (count_ > 1) {
    const Layer& last = layers_[count_ - 1];
    const Vec3& entry = last.cut.entry();
    const Vec3 along = unitOr(entry - layers_[0].cut.entry(), Vec3(0.0));
    if (!contents.holdsNeedle(last.region) &&
        glm::dot(tick.tip - entry, along) < -contents.sameWay())
      letGo(contents.sameWay());
  }
  tip_ = tick.tip;
  stored_ = 0.0;
  if (count_ == 0) {
    felt_ = Vec3(0.0);
    beyond_ = tick.hand - tick.tip;
    return {};
  }
  const ShaftForce shaft = shaftForce(contents, tick);
  Layer& layer = layers_[count_ - 1];
  layer.cut.restOn(tick.tip, tick.rests_on);
  const Vec3 cut = cutForce(contents, layer.region, layer.cut, tick.tip);
  if (cut != Vec3(0.0)) {
    const double stiffness = contents.material(layer.region)->stiffness.at(layer.cut.end());
    stored_ += 0.5 * glm::dot(cut, cut) / stiffness;
  }
  felt_ = feltBeyond(cut - shaft.against * shaft.axis, tick);
  return {felt_ - shaft.damping * shaft.axis, shaft.lateral};
}

/// The force that the hand feels when `force` [N] acts on the tip. While the tip stays behind by
/// `beyond`, a change of the force by df does the work -beyond df on the hand over the way back.
Vec3 Insertion::feltBeyond(const Vec3& force, const Tick& tick) noexcept {
  const Vec3 beyond = tick.hand - tick.tip;
  const Vec3 before = std::exchange(beyond_, beyond);
  // A change that came while the tip moved with the hand, from wall to wall or through them, was
  // felt at that time.
  if (glm::dot(before, beyond) <= 0.0 || !tick.entries.empty()) return force;
  const double taken = glm::dot(beyond, force - felt_);
  if (taken >= 0.0) return force;
  return force - taken / glm::dot(beyond, beyond) * beyond;
}

/// The sum over all tissues.
Insertion::ShaftForce Insertion::shaftForce(const Contents& contents, const Tick& tick) noexcept {
  const Vec3& fulcrum = layers_[0].cut.entry();
  const double reach = glm::distance(fulcrum, tick.tip);
  const Vec3 axis = unitOr(tick.tip - fulcrum, Vec3(0.0));
  const double advance = reach - reach_;
  const double speed = glm::dot(tick.velocity, axis);
  ShaftForce out;
  out.axis = axis;
  Vec3 turning(0.0);  // [N m] about the fulcrum
  for (std::size_t i = 0; i < count_; ++i) {
    Layer& layer = layers_[i];
    const Material* tissue = contents.material(layer.region);
    if (tissue == nullptr || !(tissue->shaft.stiffness > 0.0)) continue;
    const Vec3& begin = layer.cut.entry();
    const Vec3& end = i + 1 < count_ ? layers_[i + 1].cut.entry() : tick.tip;
    // The mean of a quantity that varies linearly is its value in the middle.
    const ShaftLaw law = shaftLaw(*tissue, 0.5 * (begin + end));
    const double length = glm::distance(begin, end);
    const double all = layer.slip.step(law, length, advance, speed);
    const double sticking = law.stiffness * layer.slip.stretch() * length;
    out.against += sticking;
    stored_ += layer.slip.stored(law.stiffness);
    out.damping += all - sticking;
    const ShaftFriction::Lateral& lateral = tissue->shaft.lateral;
    if (!(lateral.stiffness > 0.0)) continue;
    turning += layer.channel.step({lateral.stiffness, lateral.strength},
                                  glm::distance(fulcrum, begin), glm::distance(fulcrum, end), axis);
    stored_ += layer.channel.stored(lateral.stiffness, axis);
  }
  reach_ = reach;
  if (reach > 0.0) out.lateral = turning / reach;
  return out;
}

void Insertion::cross(const Contents& contents, RegionEntry& step) noexcept {
  region_ = step.to;
  // A needle that began inside has no known entry point: once it leaves, its shaft is free.
  if (count_ == 1 && layers_[0].from == layers_[0].region) letGo(contents.sameWay());
  for (std::size_t i = count_; i > 0; --i) {
    const Layer& layer = layers_[i - 1];
    if (layer.from != step.to || !isBackThrough(layer, step, contents.sameWay())) continue;
    while (count_ >= i) pop(contents.sameWay());
    return;
  }
  if (count_ == 0 && !contents.holdsNeedle(step.to)) {
    is_lost_ = false;
    return;
  }
  if (is_lost_) return;
  if (count_ == kMaxLayers) {
    letGo(contents.sameWay());
    is_lost_ = true;
    return;
  }
  if (count_ > 0 && contents.holdsNeedle(layers_[count_ - 1].region)) {
    Layer& last = layers_[count_ - 1];
    step.cut = glm::length(cutForce(contents, last.region, last.cut, step.point));
    last.cut.passTo(step.point);
  }
  push(step, contents.sameWay());
}

/// Whether the step `step` leaves `layer` through the side by which it was entered.
bool Insertion::isBackThrough(const Layer& layer, const RegionEntry& step,
                              double same_way) const noexcept {
  const double turn = glm::dot(layer.normal, step.normal);
  if (turn != 0.0) return turn < 0.0;
  const Vec3& entry = layer.cut.entry();
  const double there = glm::distance(step.point, entry);
  const double deepest = glm::distance(layer.cut.end(), entry);
  return there < std::max(0.5 * deepest, same_way) ||
         glm::dot(velocity_, step.point - layers_[0].cut.entry()) < 0.0;
}

void Insertion::push(const RegionEntry& step, double same_way) noexcept {
  if (count_ == 0) reach_ = 0.0;
  Layer& layer = layers_[count_++];
  layer = {step.from, step.to, step.normal, Cut(step.point), {}, {}};
  const Remembered* before = cutNear(step.to, step.point, std::max(step.hole_radius, same_way));
  if (before != nullptr) layer.cut = before->cut.enteredAt(step.point);
}

void Insertion::pop(double same_way) noexcept {
  const Layer& layer = layers_[--count_];
  if (layer.cut.end() == layer.cut.entry()) return;
  Remembered* slot = cutNear(layer.region, layer.cut.entry(), same_way);
  if (slot == nullptr && cut_count_ < kMaxCuts) slot = &cuts_[cut_count_++];
  if (slot == nullptr) {
    slot = &cuts_[next_cut_];
    next_cut_ = (next_cut_ + 1) % kMaxCuts;
  }
  *slot = {layer.region, layer.cut};
}

/// The needle is out, though not by the way it came.
void Insertion::letGo(double same_way) noexcept {
  while (count_ > 0) pop(same_way);
}

/// The remembered cut of `region` that begins nearest to `p` [m], within `radius` [m]; null if
/// none.
Insertion::Remembered* Insertion::cutNear(RegionId region, const Vec3& p, double radius) noexcept {
  Remembered* best = nullptr;
  for (std::size_t i = 0; i < cut_count_; ++i) {
    if (cuts_[i].region != region) continue;
    const double away = glm::distance(cuts_[i].cut.entry(), p);
    if (away > radius) continue;
    radius = away;
    best = &cuts_[i];
  }
  return best;
}

}  // namespace palpate
