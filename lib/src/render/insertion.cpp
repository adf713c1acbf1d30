#include "palpate/render/insertion.h"

#include <algorithm>

namespace palpate {
namespace {

/// Who comes back this close [m] to where a tissue was entered comes by the same way: about a needle's
/// radius. Ports that make holes say how wide these are.
constexpr double kSameWay = 0.5e-3;
/// A tip this far [m] before its last entry, in what does not hold it, has come round the tissue.
constexpr double kAround = 0.5e-3;

/// The friction of `material` along a shaft at `p` [m].
ShaftLaw shaftLaw(const Material& material, const Vec3& p) noexcept {
  const ShaftFriction& shaft = material.shaft;
  const auto way = [&](const ShaftFriction::Way& own) {
    return ShaftLaw::Way{own.static_force.at(p), own.kinetic_force.at(p), own.damping.at(p)};
  };
  return {way(shaft.in), way(shaft.out), shaft.stiffness, shaft.stick_speed};
}

}  // namespace

bool Insertion::isOf(std::size_t regions) const noexcept {
  if (count_ > kMaxLayers || cut_count_ > kMaxCuts || next_cut_ >= kMaxCuts) return false;
  return region_ < regions &&
         std::all_of(
             layers_.begin(), layers_.begin() + static_cast<std::ptrdiff_t>(count_),
             [&](const Layer& layer) { return layer.from < regions && layer.region < regions; });
}

Vec3 Insertion::step(const Contents& contents, std::span<const Port> ports,
                     const Tick& tick) noexcept {
  if (!started_) {
    started_ = true;
    tip_ = tick.tip;
    region_ = tick.crossings.empty() ? tick.region : tick.crossings.front().from;
  }
  velocity_ = tick.velocity;
  for (const PortCrossing& crossing : tick.crossings) {
    // What was crossed in between without a port was crossed there or before.
    if (crossing.from != region_) {
      cross(contents, {region_, crossing.from, crossing.point, Vec3(0.0), 0.0});
    }
    cross(contents, {crossing.from, crossing.to, crossing.point, crossing.normal,
                     ports[crossing.port].hole_radius});
  }
  if (tick.region != region_) cross(contents, {region_, tick.region, tip_, Vec3(0.0), 0.0});

  if (count_ == 0 && !is_lost_ && contents.holdsNeedle(region_)) {
    // It began in there, or the content holds needles since it was changed: as if it had just come in.
    push({region_, region_, tick.tip, Vec3(0.0), 0.0});
  }

  if (count_ > 1) {
    const Layer& last = layers_[count_ - 1];
    const Vec3& entry = last.cut.entry();
    const Vec3 along = unitOr(entry - layers_[0].cut.entry(), Vec3(0.0));
    if (!contents.holdsNeedle(last.region) && glm::dot(tick.tip - entry, along) < -kAround) letGo();
  }
  Vec3 force(0.0);
  if (count_ > 0) {
    const Vec3 way = tick.tip - layers_[0].cut.entry();
    const double reach = glm::length(way);
    const Vec3 axis = unitOr(way, Vec3(0.0));
    force = -shaftForce(contents, tick, axis, reach - reach_) * axis;
    reach_ = reach;
    Layer& layer = layers_[count_ - 1];
    const Material* tissue = contents.material(layer.region);
    if (tissue != nullptr && contents.holdsNeedle(layer.region)) {
      force += layer.cut.step(tick.tip, tissue->stiffness.at(layer.cut.end()),
                              contents.cutting(layer.region, tick.tip));
    }
  }
  tip_ = tick.tip;
  return force;
}

/// [N] of all tissues together, against going in.
double Insertion::shaftForce(const Contents& contents, const Tick& tick, const Vec3& axis,
                             double advance) noexcept {
  double sum = 0.0;
  const double speed = glm::dot(tick.velocity, axis);
  for (std::size_t i = 0; i < count_; ++i) {
    const Material* tissue = contents.material(layers_[i].region);
    if (tissue == nullptr || !(tissue->shaft.stiffness > 0.0)) continue;
    const Vec3& begin = layers_[i].cut.entry();
    const Vec3& end = i + 1 < count_ ? layers_[i + 1].cut.entry() : tick.tip;
    // The mean of what varies evenly is what it is in the middle.
    const ShaftLaw law = shaftLaw(*tissue, 0.5 * (begin + end));
    sum += layers_[i].slip.step(law, glm::distance(begin, end), advance, speed);
  }
  return sum;
}

void Insertion::cross(const Contents& contents, const Step& step) noexcept {
  region_ = step.to;
  // Begun inside, it is not known where the shaft came in: out of there it is free.
  if (count_ == 1 && layers_[0].from == layers_[0].region) letGo();
  for (std::size_t i = count_; i > 0; --i) {
    const Layer& layer = layers_[i - 1];
    if (layer.from != step.to || !isBackThrough(layer, step)) continue;
    while (count_ >= i) pop();
    return;
  }
  if (count_ == 0 && !contents.holdsNeedle(step.to)) {
    is_lost_ = false;
    return;
  }
  if (is_lost_) return;
  if (count_ == kMaxLayers) {
    letGo();
    is_lost_ = true;
    return;
  }
  if (count_ > 0 && contents.holdsNeedle(layers_[count_ - 1].region)) {
    layers_[count_ - 1].cut.passTo(step.point);
  }
  push(step);
}

/// Whether going on like this leaves `layer` by the side that it was entered through.
bool Insertion::isBackThrough(const Layer& layer, const Step& step) const noexcept {
  const double turn = glm::dot(layer.normal, step.normal);
  if (turn != 0.0) return turn < 0.0;
  const Vec3& entry = layer.cut.entry();
  const double there = glm::distance(step.point, entry);
  const double deepest = glm::distance(layer.cut.end(), entry);
  return there < std::max(0.5 * deepest, kSameWay) ||
         glm::dot(velocity_, step.point - layers_[0].cut.entry()) < 0.0;
}

void Insertion::push(const Step& step) noexcept {
  if (count_ == 0) reach_ = 0.0;
  Layer& layer = layers_[count_++];
  layer = {step.from, step.to, step.normal, Cut(step.point), {}};
  const Remembered* before = cutNear(step.to, step.point, std::max(step.hole_radius, kSameWay));
  if (before != nullptr) layer.cut = before->cut.enteredAt(step.point);
}

void Insertion::pop() noexcept {
  const Layer& layer = layers_[--count_];
  if (layer.cut.end() == layer.cut.entry()) return;
  Remembered* slot = cutNear(layer.region, layer.cut.entry(), kSameWay);
  if (slot == nullptr && cut_count_ < kMaxCuts) slot = &cuts_[cut_count_++];
  if (slot == nullptr) {
    slot = &cuts_[next_cut_];
    next_cut_ = (next_cut_ + 1) % kMaxCuts;
  }
  *slot = {layer.region, layer.cut};
}

/// The needle is out, though not by the way that it came.
void Insertion::letGo() noexcept {
  while (count_ > 0) pop();
}

/// The remembered cut of `region` that begins nearest to `p` [m], within `radius` [m]; null if none.
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
